// Forces and moments of one cylinder from its pose: docs/model.md "Forces".
//
// What belongs here: the algebra, once, for float and double, for tables and for exact kinematics. No table, no state.
#pragma once

#include <type_traits>

#include <crankloop/tick/io.hpp>
#include <crankloop/tick/one_instruction.hpp>
#include <crankloop/tick/tables.hpp>

namespace crankloop {

/// What geometry says of a mechanism at a crank angle a; derivatives are by a.
template <class Real>
struct Pose {
  Real displacement_m;     ///< x
  Real slope_m;            ///< dx/da
  Real acceleration_m;     ///< d2x/da2
  Real rod_angle_rad;      ///< b
  Real rod_slope;          ///< db/da
  Real rod_curvature;      ///< d2b/da2
  Real rod_tilt;           ///< tan b
  Real radial;             ///< cos(a + b) / cos b
};

/// All forces of a cylinder at a speed w, constant or with its rate. With RodInertia the couple dM = dI d2b/dt2 is in every force, as in docs/model.md.
///
/// (radial, slope / r) is the vector (1, tan b) turned by a, so sin a and cos a need no table of their own:
/// cos a = (radial + tan b slope / r) cos^2 b, sin a = (slope / r - tan b radial) cos^2 b.
template <bool RodInertia, class Real, class Speed>
[[nodiscard]] inline CylinderForces<Real> cylinder_forces(const Body<Real>& body, const Pose<Real>& pose, Real pressure_Pa,
                                                          const Speed& speed) noexcept {
  constexpr bool kAccelerates = std::is_same_v<Speed, CrankRate<Real>>;
  Real speed_rad_s;
  if constexpr (kAccelerates) {
    speed_rad_s = speed.speed_rad_s;
  } else {
    speed_rad_s = speed;
  }
  const Real speed_squared = speed_rad_s * speed_rad_s;
  const Real tangential = pose.slope_m * body.per_crank_radius;
  const Real secant_squared = Real{1} + pose.rod_tilt * pose.rod_tilt;
  const Real secant = square_root(secant_squared);

  CylinderForces<Real> f;
  f.pressure_Pa = pressure_Pa;
  f.gas_force_N = (pressure_Pa - body.crankcase_Pa) * body.bore_area_m2;
  f.inertia_force_N = -(body.reciprocating_kg * pose.acceleration_m) * speed_squared;
  if constexpr (kAccelerates) f.inertia_force_N -= body.reciprocating_kg * pose.slope_m * speed.acceleration_rad_s2;
  f.total_force_N = f.gas_force_N + f.inertia_force_N;
  f.side_force_N = f.total_force_N * pose.rod_tilt;
  f.rod_force_N = f.total_force_N * secant;
  f.radial_force_N = f.total_force_N * pose.radial;
  f.tangential_force_N = f.total_force_N * tangential;
  if constexpr (RodInertia) {
    Real couple_Nm = body.rod_inertia_correction_kg_m2 * pose.rod_curvature * speed_squared;
    if constexpr (kAccelerates) {  // db/da = (r / l) cos a / cos b
      const Real rod_slope = body.crank_radius_m * body.per_rod_length * (pose.radial + pose.rod_tilt * tangential) / secant;
      couple_Nm += body.rod_inertia_correction_kg_m2 * rod_slope * speed.acceleration_rad_s2;
    }
    const Real couple_per_l_N = couple_Nm * body.per_rod_length;
    const Real couple_at_pin_N = couple_per_l_N / secant;  // dM cos b / l; times 1/cos^2 b in the sine and cosine below
    f.side_force_N -= couple_per_l_N * secant;
    f.radial_force_N += couple_at_pin_N * (tangential - pose.rod_tilt * pose.radial);
    f.tangential_force_N -= couple_at_pin_N * (pose.radial + pose.rod_tilt * tangential);
  }
  f.torque_Nm = f.tangential_force_N * body.crank_radius_m;
  const Real height_m = body.height_at_tdc_m - pose.displacement_m;
  f.tilting_moment_Nm = -(f.side_force_N * height_m + f.gas_force_N * body.pin_offset_m);
  return f;
}

}  // namespace crankloop
