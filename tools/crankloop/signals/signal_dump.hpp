// Writes the signals of an engine's trigger wheels tick by tick to a file for logic signal viewers.
//
// What belongs here: wheels, edges and times. What does not: the file's format (vcd.hpp), the run (run_signals.hpp,
// free_run.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "../engine_file/engine_file.hpp"
#include "../files/output_file.hpp"
#include "vcd.hpp"

namespace crankloop::program {

[[nodiscard]] inline std::vector<std::string> names_of_triggers(const EngineFile& engine) {
  std::vector<std::string> names;
  for (const TriggerOfFile& trigger : engine.triggers()) names.push_back(trigger.name);
  return names;
}

/// The edges of a signal that the scene had room for.
template <class Signal>
[[nodiscard]] constexpr std::uint32_t listed_edges(const Signal& signal) noexcept {
  constexpr std::uint32_t kRoom = sizeof signal.edge / sizeof signal.edge[0];
  return signal.edge_count < kRoom ? signal.edge_count : kRoom;
}

/// The level at the start of the tick: every edge has inverted it.
template <class Signal>
[[nodiscard]] constexpr bool level_before(const Signal& signal) noexcept {
  return ((signal.level ^ signal.edge_count) & 1u) != 0;
}

class SignalDump {
 public:
  /// Throws InputError for a file without wheels.
  SignalDump(const EngineFile& engine, Output& out, const std::vector<std::string>& numbers);

  /// Writes the edges of a tick that ends at `end_s`; before the first tick, the initial levels.
  template <class Output>
  void tick(double end_s, double tick_s, const Output& out) {
    const double begin_s = end_s - tick_s;
    for (std::size_t w = 0; w < wheels_; ++w) {
      const auto& signal = out.trigger[w];
      if (!begun_) vcd_.level(w, begin_s, level_before(signal));
      for (std::uint32_t e = 0; e < listed_edges(signal); ++e) {
        vcd_.level(w, begin_s + static_cast<double>(signal.edge[e].time_s), signal.edge[e].level != 0);
      }
      vcd_.level(w, end_s, signal.level != 0);  // has an effect only if edges were lost
    }
    begun_ = true;
    vcd_.write_until(end_s);
  }

  /// Call it before the tick that starts at this time is written.
  void number(std::size_t which, double time_s, double value) { vcd_.number(which, time_s, value); }
  void finish(double end_s) { vcd_.finish(end_s); }

 private:
  std::size_t wheels_;
  bool begun_ = false;
  VcdFile vcd_;
};

}  // namespace crankloop::program
