// Third derivative of the theoretical lift, for pictures.
//
// What belongs here: a difference. What does not: the lift and its exact derivatives (tabulate/valve_lift.hpp).
#pragma once

#include <crankloop/tabulate/valve_lift.hpp>

namespace crankloop::program {

/// d3Y/dphi_r3 by a central difference of d2Y/dphi_r2 over 0.01 deg, of the train's unclipped lift.
[[nodiscard]] inline double lift_jerk_m(const ValveLift& lift, double cam_rad) noexcept {
  constexpr double kStep_rad = 1.7453292519943295e-4;
  return (lift.at(cam_rad + kStep_rad).per_rad2_m - lift.at(cam_rad - kStep_rad).per_rad2_m) / (2 * kStep_rad);
}

}  // namespace crankloop::program
