// Stability limit of the valve's step: rate times step over the damping ratio, measured and from theory.
//
// What belongs here: both limits. What does not: the library's own steps (tabulate/valve_motion.hpp), which are far
// shorter.
#pragma once

#include <vector>

namespace crankloop::program {

/// Limits of w d, frequency times step, of one free regime with damping ratio zeta.
struct StabilityPoint {
  double damping_ratio;
  double measured;   ///< longest step at which the library's Runge-Kutta step does not grow
  double theory;     ///< |1 + z + z^2/2 + z^3/6 + z^4/24| = 1 with z = w d (-zeta +- sqrt(zeta^2 - 1))
  double used_most;  ///< longest step that the library uses, at the coarsest accuracy class

  [[nodiscard]] double error() const { return measured / theory - 1; }
};

/// Damping ratios from 0 to 2.
[[nodiscard]] std::vector<StabilityPoint> stability_map();

}  // namespace crankloop::program
