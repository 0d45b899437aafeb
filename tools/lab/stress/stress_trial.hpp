// One case of the stress test put through the library: refused, or run and judged.
//
// What belongs here: the run, its bounds, the comparison with the reference. What does not: what is drawn
// (stress_case.hpp), counting (stress.cpp).
//
// The rules, which can all be broken:
//
//   refused    at set-up, and rightly: the tick needs more fine steps than the contract allows, or the cam cannot be
//              ground, both worked out here by formulas of their own.
//   bounded    20 cycles, or kMaxTicks: every output finite, no fault but an exceeded event budget, and at the end of
//              each cycle sqrt(2 E / M) at most twice what the train can have put in: its share at rest, every change
//              of the cam's speed so far, and twice its largest speed for every contact change.
//   accurate   for kReferenceCycles, or as far as kReferenceSteps go: at every tick the lift is off by at most
//              kMagnified times this: the accuracy asked for, and the most that kCopies copies of the reference have
//              got off it since the valve last rested. Each copy is knocked up or down where the cam starts under it
//              and in every tick in which its contact changes: by the accuracy asked for, with Runge-Kutta times as
//              much as its vibration is wider than kClassAmplitude_m. In float rounding shakes the copies in every
//              tick. So a motion that magnifies errors excuses an error, by as much as it magnifies, and nothing else
//              does but an exceeded event budget. What is beyond that is judged again with kMoreCopies before it counts
//              as inaccurate. (stress_comparison.hpp)
#pragma once

#include <memory>
#include <string>

#include <crankloop/status.hpp>

#include "stress_case.hpp"

namespace crankloop::program {

inline constexpr int kStressCycles = 20;
inline constexpr int kMaxTicks = 40'000;
inline constexpr double kReferenceCycles = 1.5;
inline constexpr double kReferenceSteps = 2500;

enum class Verdict { refused, ran, wrongly_refused, diverged, inaccurate };

struct TrialResult {
  Verdict verdict = Verdict::ran;
  Status refusal{};
  std::string trouble;  ///< what failed; empty where nothing did
  int ticks = 0;
  bool all_cycles = false;   ///< reached kStressCycles
  bool over_budget = false;  ///< more contact changes in a tick than are located
  bool compared = false;
  bool landed = false;        ///< while it was compared
  bool judged_again = false;  ///< with kMoreCopies
  double of_class = 0;        ///< largest error over the accuracy asked for
  double of_allowed = 0;      ///< largest error over what the rule allows
};

class StressTrials {
 public:
  StressTrials();
  ~StressTrials();

  [[nodiscard]] TrialResult run(const StressCase& drawn, bool compare);

 private:
  struct Engines;
  std::unique_ptr<Engines> engines_;
};

}  // namespace crankloop::program
