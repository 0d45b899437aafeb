// Forces and moments of one cylinder from its pose: docs/model.md "Forces".
//
// What belongs here: the algebra, once, for float and double, for tables and for exact kinematics. No table, no state.
#pragma once

#include <type_traits>

#include <crankloop/output.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop {

/// What geometry says of a mechanism at a crank angle a; derivatives are by a.
template <class Real>
struct Pose {
  Real displacement_m;  ///< x
  Real slope_m;         ///< dx/da
  Real acceleration_m;  ///< d2x/da2
  Real rod_angle_rad;   ///< b
  Real rod_slope;       ///< db/da
  Real rod_curvature;   ///< d2b/da2
  Real rod_tilt;        ///< tan b
  Real radial;          ///< cos(a + b) / cos b
};

namespace detail {

/// How the crank turns where its speed changes.
template <class Real>
struct CrankRate {
  Real speed_rad_s;
  Real acceleration_rad_s2;
};

/// Forces of the cylinders of one mechanism at a speed w, constant or with its rate: what their pressures do not change
/// is worked out once. With RodInertia the couple dM = dI d2b/dt2 is in every force, as in docs/model.md.
///
/// (radial, slope / r) is the vector (1, tan b) turned by a, so sin a and cos a need no table of their own:
/// cos a = (radial + tan b slope / r) cos^2 b, sin a = (slope / r - tan b radial) cos^2 b.
template <bool RodInertia, class Real>
class MechanismForces {
 public:
  template <class Speed>
  [[gnu::always_inline]] MechanismForces(const Body<Real>& body, const Pose<Real>& pose, const Speed& speed) noexcept
      : rod_tilt_{pose.rod_tilt},
        radial_{pose.radial},
        crankcase_Pa_{body.crankcase_Pa},
        bore_area_m2_{body.bore_area_m2},
        crank_radius_m_{body.crank_radius_m},
        pin_offset_m_{body.pin_offset_m} {
    constexpr bool kAccelerates = std::is_same_v<Speed, CrankRate<Real>>;
    Real speed_rad_s;
    if constexpr (kAccelerates) {
      speed_rad_s = speed.speed_rad_s;
    } else {
      speed_rad_s = speed;
    }
    const Real speed_squared = speed_rad_s * speed_rad_s;
    tangential_ = pose.slope_m * body.per_crank_radius;
    secant_ = square_root(Real{1} + rod_tilt_ * rod_tilt_);
    height_m_ = body.height_at_tdc_m - pose.displacement_m;
    inertia_force_N_ = -(body.reciprocating_kg * pose.acceleration_m) * speed_squared;
    if constexpr (kAccelerates) inertia_force_N_ -= body.reciprocating_kg * pose.slope_m * speed.acceleration_rad_s2;
    if constexpr (RodInertia) {
      const Real cosine_like = radial_ + rod_tilt_ * tangential_;  // cos a / cos^2 b
      Real couple_Nm = body.rod_inertia_correction_kg_m2 * pose.rod_curvature * speed_squared;
      if constexpr (kAccelerates) {  // db/da = (r / l) cos a / cos b
        const Real rod_slope = body.crank_radius_m * body.per_rod_length * cosine_like / secant_;
        couple_Nm += body.rod_inertia_correction_kg_m2 * rod_slope * speed.acceleration_rad_s2;
      }
      const Real couple_per_l_N = couple_Nm * body.per_rod_length;
      const Real couple_at_pin_N = couple_per_l_N / secant_;  // dM cos b / l; times 1/cos^2 b in the sine and cosine
      couple_side_N_ = couple_per_l_N * secant_;
      couple_radial_N_ = couple_at_pin_N * (tangential_ - rod_tilt_ * radial_);
      couple_tangential_N_ = couple_at_pin_N * cosine_like;
    }
  }

  [[nodiscard, gnu::always_inline]] CylinderForces<Real> at(Real pressure_Pa) const noexcept {
    CylinderForces<Real> f;
    f.pressure_Pa = pressure_Pa;
    f.gas_force_N = (pressure_Pa - crankcase_Pa_) * bore_area_m2_;
    f.inertia_force_N = inertia_force_N_;
    f.total_force_N = f.gas_force_N + f.inertia_force_N;
    f.side_force_N = f.total_force_N * rod_tilt_;
    f.rod_force_N = f.total_force_N * secant_;
    f.radial_force_N = f.total_force_N * radial_;
    f.tangential_force_N = f.total_force_N * tangential_;
    if constexpr (RodInertia) {
      f.side_force_N -= couple_side_N_;
      f.radial_force_N += couple_radial_N_;
      f.tangential_force_N -= couple_tangential_N_;
    }
    f.torque_Nm = f.tangential_force_N * crank_radius_m_;
    f.tilting_moment_Nm = -(f.side_force_N * height_m_ + f.gas_force_N * pin_offset_m_);
    return f;
  }

 private:
  Real rod_tilt_, radial_, crankcase_Pa_, bore_area_m2_, crank_radius_m_, pin_offset_m_;
  Real tangential_, secant_, height_m_, inertia_force_N_;
  Real couple_side_N_{}, couple_radial_N_{}, couple_tangential_N_{};
};

/// All forces of one cylinder.
template <bool RodInertia, class Real, class Speed>
[[nodiscard]] inline CylinderForces<Real> cylinder_forces(const Body<Real>& body, const Pose<Real>& pose,
                                                          Real pressure_Pa, const Speed& speed) noexcept {
  return MechanismForces<RodInertia, Real>(body, pose, speed).at(pressure_Pa);
}

}  // namespace detail
}  // namespace crankloop
