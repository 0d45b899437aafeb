// One case of the stress test: refused by the library, or run and checked.
//
// What belongs here: the run, its bounds, the comparison with the reference. What does not: random values
// (stress_case.hpp), counting (stress_tally.hpp).
//
// The rules; a defect of the library can break each of them:
//
//   refused    at set-up for a valid reason: the tick needs more fine steps than the contract allows, or the cam cannot
//              be ground. Both are computed here, independently of the library.
//   bounded    for 20 cycles, or kStressTicks: every output is finite, there is no fault but an exceeded event budget,
//              and at the end of each cycle sqrt(2 E / M) is at most twice what the train can have supplied: its share
//              at rest, every change of the cam's speed so far, and twice its largest speed for every contact change.
//   accurate   for kReferenceCycles, or up to kReferenceSteps: in every tick the error of the lift is at most
//              kMagnified times the sum of the requested accuracy and the largest deviation of kCopies copies from the
//              reference since the valve last rested. Each copy is disturbed, up or down, when the cam starts under it
//              and in every tick in which its contact changes: by the requested accuracy, with Runge-Kutta scaled up
//              for vibrations wider than kClassAmplitude_m. In float, rounding disturbs the copies in every tick. So an
//              error may be as large as the motion amplifies errors; only an exceeded event budget permits a larger
//              one. A larger error is compared again with kMoreCopies before it counts as inaccurate.
//              (stress_comparison.hpp)
#pragma once

#include <memory>
#include <string>

#include <crankloop/status.hpp>

#include "stress_case.hpp"

namespace crankloop::program {

inline constexpr int kStressCycles = 20;
inline constexpr int kStressTicks = 40'000;
inline constexpr double kReferenceCycles = 1.5;
inline constexpr double kReferenceSteps = 2500;

enum class Verdict { refused, ran, wrongly_refused, diverged, inaccurate };

struct TrialResult {
  Verdict verdict = Verdict::ran;
  Status refusal{};
  std::string trouble;  ///< what failed; empty if nothing did
  int ticks = 0;
  bool all_cycles = false;   ///< reached kStressCycles
  bool over_budget = false;  ///< a tick had more contact changes than it locates
  bool compared = false;
  bool landed = false;        ///< during the comparison
  bool judged_again = false;  ///< compared a second time, with kMoreCopies
  double of_class = 0;        ///< largest error / requested accuracy
  double of_allowed = 0;      ///< largest error / permitted error
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
