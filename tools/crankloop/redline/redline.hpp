// What `redline` found, for its text, CSV and page.
#pragma once

#include <string>
#include <vector>

#include "redline_search.hpp"
#include "../report/page.hpp"

namespace crankloop::program {

struct Redline {
  const LoneValve& valve;
  SpeedRange range;
  const Influence* influence;  ///< null: nothing is varied
  std::vector<Sweep> sweeps;   ///< by factor; without an influence one, of factor 1
  std::string command_line;

  [[nodiscard]] const Sweep& as_given() const noexcept {
    for (const Sweep& sweep : sweeps) {
      if (sweep.factor == 1) return sweep;
    }
    return sweeps.front();
  }

  /// The speed of the sweeps at which they are compared: the first above the onset of separation as given, where the motion still repeats
  /// itself; far above it what a factor does is chance. The highest where there is no onset.
  [[nodiscard]] std::size_t compared_at() const {
    const std::vector<SpeedResult>& at = as_given().at;
    std::size_t i = 0;
    while (i + 1 < at.size() && !(as_given().separation.found && at[i].speed_rpm > as_given().separation.speed_rpm)) ++i;
    return i;
  }
};

/// "8513 rpm", "at or below 500 rpm", "none up to 15000 rpm".
[[nodiscard]] std::string text_of(const Onset& onset, const SpeedRange& range);

[[nodiscard]] report::Page redline_page(const Redline& redline);

}  // namespace crankloop::program
