// Where the valve's step turns unstable: rate times step against damping ratio, measured and from theory.
//
// What belongs here: both limits. What does not: how long the library's own steps are (tabulate/valve_motion.hpp),
// which stay far below.
#pragma once

#include <vector>

namespace crankloop::program {

/// Limits of w d, frequency times step, of one free regime with damping ratio zeta.
struct StabilityPoint {
  double damping_ratio;
  double measured;   ///< longest step that does not grow, by running the library's Runge-Kutta step
  double theory;     ///< |1 + z + z^2/2 + z^3/6 + z^4/24| = 1 with z = w d (-zeta +- sqrt(zeta^2 - 1))
  double used_most;  ///< of the coarsest accuracy class, by asking the library for its steps

  [[nodiscard]] double error() const { return measured / theory - 1; }
};

/// Damping ratios from 0 to 2.
[[nodiscard]] std::vector<StabilityPoint> stability_map();

}  // namespace crankloop::program
