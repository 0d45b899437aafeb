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
};

/// "8513 rpm", "at or below 500 rpm", "none up to 15000 rpm".
[[nodiscard]] std::string text_of(const Onset& onset, const SpeedRange& range);

[[nodiscard]] report::Page redline_page(const Redline& redline);

}  // namespace crankloop::program
