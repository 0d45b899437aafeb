// Friction of the engine and of the machine that it drives, against the crank's motion: a constant part, one by the
// speed and one by its square.
//
// What belongs here: torque at a speed, what it meets at standstill, its impulse where the crank turns round. What does
// not: the crank's integration (tick/crank/crank_step.hpp).
#pragma once

#include <cstdint>

#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop::detail {

enum Sense : std::uint8_t { kForward, kBackward };
template <class Real>
[[nodiscard]] inline Sense sense_of(Real motion) noexcept {
  return motion < 0 ? kBackward : kForward;
}
[[nodiscard]] inline Sense other(Sense sense) noexcept { return sense == kForward ? kBackward : kForward; }

template <class Real>
struct CrankFriction {
  Real constant_Nm[2];  ///< by Sense: backwards also what the gas's loop would give, twice

  /// At a speed without its sign.
  [[nodiscard]] Real torque_Nm(const CrankDynamics<Real>& crank, Sense sense, Real speed_rad_s) const noexcept {
    return constant_Nm[sense] + speed_rad_s * (crank.drag_Nm_s + speed_rad_s * crank.drag_Nm_s2);
  }
  /// At standstill friction meets any push up to its constant part.
  [[nodiscard]] bool meets(Real push_Nm) const noexcept { return magnitude(push_Nm) <= constant_Nm[sense_of(push_Nm)]; }

  /// In a tick in which the crank turns round, friction turns with it: it has acted for half of the tick in the old
  /// sense, and is due in the new one for as much, less twice the time by which the crank stood still after the middle
  /// of the tick. The speeds at both ends have that friction, but no other, so they tell this time too long, by what
  /// friction adds to the forces that turn the crank round. Positive along `then`, the sense before.
  [[nodiscard]] Real impulse_of_turning_Nms(Sense then, Real from_rad_s, Real to_rad_s, Real per_inertia,
                                            Real tick_s) const noexcept {
    const Real sense = then == kForward ? Real{1} : Real{-1};
    const Real more_Nm = constant_Nm[other(then)] - constant_Nm[then];
    const Real by_forces_rad_s = magnitude(from_rad_s - to_rad_s);
    const Real by_friction_rad_s = tick_s * constant_Nm[then] * per_inertia;
    const Real turned_rad_s = by_forces_rad_s + by_friction_rad_s;  // 0 where a friction of next to nothing underflows
    const Real late = turned_rad_s > 0 ? sense * (from_rad_s + to_rad_s) / turned_rad_s : Real{0};
    const Real twice_late = late > 1 ? Real{1} : late < -1 ? Real{-1} : late;
    const Real time_s = tick_s * (static_cast<Real>(0.5) - twice_late);
    return time_s * constant_Nm[then] + more_Nm * (tick_s / 2) * (Real{1} - twice_late);
  }
};

}  // namespace crankloop::detail
