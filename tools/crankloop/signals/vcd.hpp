// Signals over time as a value change dump (IEEE 1364, clause 18): the format of GTKWave, PulseView and logic
// analysers.
//
//     VcdFile vcd(out, "crankloop", {{"crank"}, {"cam"}}, {{"speed_rpm"}});
//     vcd.level(0, time_s, true);       // in any order within a tick
//     vcd.number(0, time_s, 812.5);
//     vcd.write_until(tick_end_s);      // sorted
//     vcd.finish(end_s);
//
// What belongs here: the format. What does not: which signals an engine has.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "../files/output_file.hpp"

namespace crankloop::program {

/// Times are rounded to whole nanoseconds. A value that does not change is not written. Values are unknown (x) until
/// their first change.
class VcdFile {
 public:
  /// Names of wires (one bit) and of real variables; other characters than letters, digits and underscores become
  /// underscores.
  VcdFile(Output& out, const std::string& module, const std::vector<std::string>& wires,
          const std::vector<std::string>& numbers);

  /// Records a change, at or after the time written last.
  void level(std::size_t wire, double time_s, bool high) { note({nanoseconds(time_s), wire, high ? 1.0 : 0.0}); }
  void number(std::size_t which, double time_s, double value) { note({nanoseconds(time_s), wires_ + which, value}); }

  /// Writes the changes recorded up to this time in order of time, changes of equal time in the order of recording.
  void write_until(double time_s);

  /// Writes the rest, and the end of the recording. The caller finishes the Output.
  void finish(double time_s);

 private:
  struct Change {
    std::int64_t time_ns;
    std::size_t variable;
    double value;
  };
  struct Variable {
    std::string code;
    double value = 0;
    bool known = false;
  };

  [[nodiscard]] static std::int64_t nanoseconds(double time_s);
  void note(Change change);
  void write(const Change& change);
  void write_time(std::int64_t time_ns);

  Output& out_;
  std::size_t wires_;
  std::vector<Variable> variables_;
  std::vector<Change> noted_;
  std::int64_t written_ns_ = -1;  ///< the last time in the file
};

}  // namespace crankloop::program
