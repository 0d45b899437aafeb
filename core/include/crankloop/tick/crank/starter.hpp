// The starter: its torque falls as the crank speeds up, from its stall torque to none at its no-load speed. It never
// brakes.
//
// What belongs here: torque at a speed, and what a tick makes of it. What does not: the crank's integration
// (tick/crank/crank_step.hpp).
#pragma once

#include <crankloop/assert.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop::detail {

template <class Real>
struct Starter {
  Real stall_Nm{};
  Real slope_Nm_s{};  ///< what it gives less per rad/s
  bool on = false;    ///< asked first everywhere: an engine that runs pays for no more

  /// No more than the stall torque, however fast the crank turns back.
  [[nodiscard]] Real torque_Nm(Real speed_rad_s) const noexcept {
    if (!on) return Real{0};
    CRANKLOOP_ASSERT(stall_Nm >= 0 && slope_Nm_s >= 0);
    if (speed_rad_s <= 0) return stall_Nm;
    const Real torque = stall_Nm - slope_Nm_s * speed_rad_s;
    return torque > 0 ? torque : Real{0};
  }

  /// Half of what the acceleration at a tick's start would add to the speed is too much for its mean, where torque
  /// fades on the way: this share of it is right to third order, and holds however steeply torque fades.
  [[nodiscard]] Real share_of_gain(Real from_rad_s, Real tick_s, Real per_inertia) const noexcept {
    const bool fades = on && from_rad_s >= 0 && slope_Nm_s * from_rad_s < stall_Nm;
    return fades ? Real{1} / (Real{1} + slope_Nm_s * tick_s * per_inertia * static_cast<Real>(1.0 / 3)) : Real{1};
  }

  /// Work in a tick of this mean speed. Torque falls where speed rises, so the mean of their product is less than the
  /// product of their means, by slope gain^2 / 12; where the torque ends inside the tick, its mean is that of the part
  /// that is left.
  [[nodiscard]] Real work_J(Real from_rad_s, Real gain_rad_s, Real mean_rad_s, Real tick_s) const noexcept {
    if (!on) return Real{0};
    const bool turns_back = from_rad_s < 0 || from_rad_s + gain_rad_s < 0;
    if (turns_back) return torque_Nm(mean_rad_s) * mean_rad_s * tick_s;
    const Real first_Nm = stall_Nm - slope_Nm_s * from_rad_s;
    const Real fall_Nm = slope_Nm_s * gain_rad_s;
    const Real last_Nm = first_Nm - fall_Nm;
    if (first_Nm > 0 && last_Nm > 0)
      return (torque_Nm(mean_rad_s) * mean_rad_s - fall_Nm * gain_rad_s * static_cast<Real>(1.0 / 12)) * tick_s;
    if (!(first_Nm > 0 || last_Nm > 0)) return Real{0};
    const Real largest_Nm = first_Nm > 0 ? first_Nm : last_Nm;
    return largest_Nm * largest_Nm / (2 * magnitude(fall_Nm)) * mean_rad_s * tick_s;
  }
};

}  // namespace crankloop::detail
