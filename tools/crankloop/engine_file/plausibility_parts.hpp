// What warnings_about() looks at, by subject, and the list it writes to.
//
// What belongs here: what the subjects share. What does not: what a command asks for (plausibility.hpp).
#pragma once

#include <string>
#include <vector>

#include "../files/words.hpp"
#include "engine_file.hpp"
#include "usual_ranges.hpp"

namespace crankloop::program {

[[nodiscard]] inline bool within(Interval usual, double value) { return value >= usual.least && value <= usual.most; }

/// The lines so far, each with the file's name.
class Warnings {
 public:
  explicit Warnings(const EngineFile& engine) : engine_{engine} {}

  /// Line 0: for the whole file.
  void add(int line, const std::string& text) {
    lines_.push_back(engine_.path() + (line > 0 ? ":" + std::to_string(line) : "") + ": warning: " + text);
  }

  void add_if_any(int line, const std::string& text) {
    if (!text.empty()) add(line, text);
  }

  /// Whether it is usual.
  bool add_unless(Interval usual, double value, int line, const std::string& what, const char* unit,
                  const std::string& remark = "") {
    if (within(usual, value)) return true;
    add(line, what + " = " + brief(value) + " is unusual; usual: " + brief(usual.least) + " to " + brief(usual.most) +
                  unit + remark);
    return false;
  }

  [[nodiscard]] const std::vector<std::string>& lines() const noexcept { return lines_; }

 private:
  const EngineFile& engine_;
  std::vector<std::string> lines_;
};

/// Bore, stroke and rod a thousand times too small.
[[nodiscard]] bool lengths_look_like_metres(const SectionValues& crank);

/// Warns about unusual sizes, and returns the others.
EngineSize look_at_crank(const EngineFile& engine, Warnings& warnings);

void look_at_piston(const EngineFile& engine, Warnings& warnings);
void look_at_spacing(const EngineFile& engine, const EngineSize& size, Warnings& warnings);
void look_at_diagram(const EngineFile& engine, Warnings& warnings);

/// Cams, analytic and measured, and what the springs do to the trains.
void look_at_trains(const EngineFile& engine, const EngineSize& size, Warnings& warnings);

/// Mixture, runners and the burn; nothing without gas exchange.
void look_at_gas(const EngineFile& engine, const EngineSize& size, Warnings& warnings);

/// Trigger wheels and their faults.
void look_at_signals(const EngineFile& engine, Warnings& warnings);

}  // namespace crankloop::program
