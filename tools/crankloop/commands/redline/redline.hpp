// What `redline` found, for its text, CSV and page.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "../../command_line/summary.hpp"
#include "../../files/output_file.hpp"
#include "../../report/page.hpp"
#include "redline_search.hpp"
#include "redline_vary.hpp"

namespace crankloop::program {

struct Redline {
  const LoneValve& valve;
  SpeedRange range;
  const VariedTrains* varied;  ///< null: nothing is
  std::vector<Sweep> sweeps;   ///< of the varied trains in their order, else one
  std::string command_line;
  RedlineLimits limits;
  std::optional<Sweep> following{};  ///< the train as given, but for springs that follow their valve: where they surge

  [[nodiscard]] double rated_rpm() const { return valve.file().rated_rpm(); }

  /// Whether they do, of the one train that is shown.
  [[nodiscard]] bool surges() const noexcept { return varied == nullptr && valve.valve().surge_modes > 0; }

  [[nodiscard]] const Sweep& as_given() const noexcept {
    for (const Sweep& sweep : sweeps) {
      if (sweep.as_given) return sweep;
    }
    return sweeps.front();
  }

  /// Where a curve ends: shortly above the onset of separation; beyond, the motion is chance.
  [[nodiscard]] double shown_to_rpm(const Sweep& sweep) const {
    if (!sweep.separation.found) return range.to_rpm;
    return std::clamp(1.15 * sweep.separation.speed_rpm, range.from_rpm + 1.0, 1.0 * range.to_rpm);
  }

  /// Where plots end.
  [[nodiscard]] double shown_to_rpm() const {
    double last_rpm = range.from_rpm + 1.0;
    for (const Sweep& sweep : sweeps) last_rpm = std::max(last_rpm, shown_to_rpm(sweep));
    if (following) last_rpm = std::max(last_rpm, shown_to_rpm(*following));
    return last_rpm;
  }

  /// Where they begin: of several trains well below the first onset, so that their curves do not crowd.
  [[nodiscard]] double shown_from_rpm() const {
    double onset_rpm = range.to_rpm;
    for (const Sweep& sweep : sweeps) {
      if (sweep.separation.found) onset_rpm = std::min<double>(onset_rpm, sweep.separation.speed_rpm);
    }
    return varied == nullptr ? range.from_rpm : std::max(1.0 * range.from_rpm, std::floor(onset_rpm / 2e3) * 1e3);
  }

  /// The speed of the sweeps at which they are compared: the first above the onset of separation as given, where the
  /// motion still repeats itself; far above it what a factor does is chance. The highest where there is no onset.
  [[nodiscard]] std::size_t compared_at() const {
    const std::vector<SpeedResult>& at = as_given().at;
    std::size_t i = 0;
    while (i + 1 < at.size() && !(as_given().separation.found && at[i].speed_rpm > as_given().separation.speed_rpm))
      ++i;
    return i;
  }
};

/// "left out: 3 of 61 results, from 13000 rpm on, in which the valve flies beyond 11.7 mm: ..."; empty where none is.
[[nodiscard]] std::string masked_in_words(const Redline& redline);

/// "8513 rpm", "at or below 500 rpm", "none up to 15000 rpm".
[[nodiscard]] std::string text_of(const Onset& onset, const SpeedRange& range);

/// "8954 rpm", "none".
[[nodiscard]] std::string text_of(const StaticRedline& rigid);

/// Where the static redline of the train as given stands, beside its onset of separation, and why.
[[nodiscard]] std::string static_in_words(const Redline& redline);

/// Onsets and natural frequencies of the train as given.
[[nodiscard]] Summary summary_of(const Redline& redline);

/// A row per speed, or per factor with a remark above them.
[[nodiscard]] std::string table_of(const Redline& redline);

/// A row per factor and speed.
void write_csv(Output& out, const Redline& redline);

[[nodiscard]] report::Page redline_page(const Redline& redline);

}  // namespace crankloop::program
