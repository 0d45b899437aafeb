// Results of a stress test.
//
// What belongs here: counts, quantiles, their report. What does not: single trials (stress_trial.hpp).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "crankloop/report/page.hpp"
#include "stability_map.hpp"
#include "stress_trial.hpp"

namespace crankloop::program {

struct StressFailure {
  int number;
  std::string what;  ///< verdict and trouble
  std::string drawn;
};

struct StressTally {
  int seed = 0;
  int cases = 0;
  int compare_every = 1;
  std::map<std::string, int> refused;  ///< by field and reason
  int ran = 0;
  int all_cycles = 0;
  int over_budget = 0;
  int compared = 0;
  int landed = 0;  ///< of those compared
  int judged_again = 0;
  int wrongly_refused = 0;
  int diverged = 0;
  int inaccurate = 0;
  std::int64_t ticks = 0;
  std::vector<double> of_class;  ///< of every comparison
  std::vector<double> of_class_landed;
  std::vector<double> of_allowed;  ///< of every comparison within the event budget
  std::vector<StressFailure> failures;

  void add(int number, const StressCase& drawn, const TrialResult& result);

  /// What was counted, as one line of text, and added to what is counted here: of cases in their order, so that parts
  /// in that order give the tally of all.
  [[nodiscard]] std::string part() const;
  void add_part(const std::string& text);
  [[nodiscard]] int refusals() const;
};

/// How many errors exceed the requested accuracy.
[[nodiscard]] int beyond_class(const std::vector<double>& of_class);

/// The value that the fraction `part` of them (0 to 1) does not exceed; 0 without values.
[[nodiscard]] double quantile(std::vector<double> values, double part);

/// "refused but could run".
[[nodiscard]] const char* name_of(Verdict verdict);

inline constexpr double kLargestStabilityError = 0.01;  ///< of the theoretical limit
[[nodiscard]] double worst_error(const std::vector<StabilityPoint>& map);

/// What `crankloop stress` prints.
[[nodiscard]] std::string text_of(const StressTally& tally, const std::vector<StabilityPoint>& map);

[[nodiscard]] report::Page stress_page(const StressTally& tally, const std::vector<StabilityPoint>& map,
                                       const std::string& command_line);

}  // namespace crankloop::program
