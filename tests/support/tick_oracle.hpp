// What the tick's kinematics must come to, worked out apart from the library: vector loop and its derivatives, in long
// double with the C library's functions. What does not belong here: tables, forces.
#pragma once

#include <cmath>

#include <crankloop/define/crank.hpp>

#include "support/units.hpp"

namespace crankloop::tick_test {

using support::kPi;
using support::kWidePi;

/// Motion of one mechanism and its derivatives by the crank angle.
struct OraclePose {
  long double displacement_m, slope_m, acceleration_m;
  long double rod_angle_rad, rod_slope, rod_curvature;
  long double rod_tilt, radial;
};

/// x from the closure of the vector loop; speed and acceleration by the derivative of sin b = (r sin a - e) / l.
[[nodiscard]] inline OraclePose oracle_pose(const Crank& crank, long double crank_rad) {
  const auto r = static_cast<long double>(crank.crank_radius_m);
  const auto l = static_cast<long double>(crank.rod_length_m);
  const auto e = static_cast<long double>(crank.pin_offset_m);
  const long double sin_a = std::sin(crank_rad);
  const long double cos_a = std::cos(crank_rad);
  const long double across = r * sin_a - e;                          // of the rod, square to the cylinder axis
  const long double along = std::sqrt((l - across) * (l + across));  // of the rod, along the axis
  const long double across_1 = r * cos_a;
  const long double along_1 = -across * across_1 / along;
  const long double across_2 = -r * sin_a;
  const long double along_2 = -(across_1 * across_1 + across * across_2 + along_1 * along_1) / along;
  OraclePose p{};
  p.displacement_m = std::sqrt((r + l - e) * (r + l + e)) - r * cos_a - along;
  p.slope_m = r * sin_a - along_1;
  p.acceleration_m = r * cos_a - along_2;
  p.rod_angle_rad = std::atan2(across, along);
  p.rod_slope = across_1 / along;  // db/da cos b = across' / l
  p.rod_curvature = across_2 / along - across_1 * along_1 / (along * along);
  p.rod_tilt = across / along;
  p.radial = cos_a - sin_a * p.rod_tilt;
  return p;
}
[[nodiscard]] inline OraclePose oracle_pose_at_deg(const Crank& crank, double crank_deg) {
  return oracle_pose(crank, static_cast<long double>(crank_deg) * kWidePi / 180);
}

}  // namespace crankloop::tick_test
