// What the ends of a whole step tell of the motion between them: whether a contact may change there.
//
// What belongs here: bounds by Bezier ordinates. What does not: the step itself (valve.hpp), what is done where one may (valve_tick.hpp).
#pragma once

#include <cstdint>

#include <crankloop/tick/valve_tables.hpp>

namespace crankloop::detail {

/// What a whole step's ends say of the motion between them, as far as cubics do.
template <class Real>
struct Between {
  Real y[2], y_slope[2];      ///< the valve; slopes by the part of the step
  Real gap[2], gap_slope[2];  ///< Y - y

  constexpr Between(ValveState<Real> a, ValveState<Real> b, const LiftStep<Real>& lift, Real step_s) noexcept
      : y{a.lift_m, b.lift_m},
        y_slope{a.velocity_m_s * step_s, b.velocity_m_s * step_s},
        gap{lift.from_m - y[0], lift.to_m - y[1]},
        gap_slope{lift.from_slope_m - y_slope[0], lift.to_slope_m - y_slope[1]} {}
};

/// A cubic between two values stays within a third of this sum of their range: its inner Bezier ordinates are that far from its ends.
template <class Real>
[[nodiscard]] constexpr Real slopes(const Real (&slope)[2]) noexcept {
  return magnitude(slope[0]) + magnitude(slope[1]);
}
template <class Real>
inline constexpr Real kThird = static_cast<Real>(1.0 / 3);

template <class Real>
[[nodiscard]] constexpr bool above(const Real (&x)[2], Real bound) noexcept {
  return x[0] > bound && x[1] > bound;
}

/// The train's force over k, gap + lag gap', stays above `bound`, by the Bezier ordinates of its cubic.
template <class Real>
[[nodiscard]] constexpr bool pushes(const Between<Real>& m, Real lag, Real bound) noexcept {
  const Real(&g)[2] = m.gap;
  const Real(&s)[2] = m.gap_slope;
  const Real middle = 3 * (g[1] - g[0]) - s[0] - s[1];
  return g[0] + lag * s[0] > bound && g[1] + lag * s[1] > bound &&
         g[0] + s[0] * kThird<Real> + lag * ((s[0] + 2 * middle) * kThird<Real>) > bound &&
         g[1] - s[1] * kThird<Real> + lag * ((2 * middle + s[1]) * kThird<Real>) > bound;
}

/// Distances and forces over stiffness that count as sure, m.
template <class Real>
inline constexpr Real kMargin_m = static_cast<Real>(2e-6);

/// The valve stays above its seat.
template <class Real>
[[nodiscard]] constexpr bool stays_off_seat(const ValveMotion<Real>& motion, const Between<Real>& m) noexcept {
  return above(m.y, motion.clear_m + slopes(m.y_slope) * kThird<Real>);
}

/// True when the train carries the valve all through a step, as far as the cubics through its ends tell, with a margin: it stays above its
/// seat, its gap and its force positive.
template <class Real>
[[nodiscard]] constexpr bool stays_on_train(const ValveMotion<Real>& motion, Real force_lag, const Between<Real>& m) noexcept {
  if (!stays_off_seat(motion, m)) return false;
  const Real gap_slopes = slopes(m.gap_slope);
  const Real apart = magnitude(m.gap[1] - m.gap[0]);
  const Real bound = kMargin_m<Real> + gap_slopes * kThird<Real>;
  const Real lower = (m.gap[0] + m.gap[1] - apart) / 2;
  // No ordinate of the gap's slope is larger than the bracket. By far: most steps.
  if (lower > bound + force_lag * (gap_slopes + 2 * apart)) return true;
  return above(m.gap, bound) && pushes(m, force_lag, kMargin_m<Real>);
}

/// True when no contact can change in a step with the seat off, likewise. (On the seat nothing could be told: its own vibration is faster than
/// a whole step.)
template <class Real>
[[nodiscard]] constexpr bool far_from_change(const ValveMotion<Real>& motion, Real force_lag, std::uint32_t regime, const Between<Real>& m) noexcept {
  if ((regime & kTrainOn) != 0) return stays_on_train(motion, force_lag, m);
  const Real bound = kMargin_m<Real> + slopes(m.gap_slope) * kThird<Real>;
  return stays_off_seat(motion, m) && m.gap[0] < -bound && m.gap[1] < -bound;
}

/// y'' at the end of a whole step that the train carried.
template <class Real>
[[nodiscard]] constexpr Real carried_acceleration(const ValveMotion<Real>& motion, ValveState<Real> s, const Between<Real>& m, Real gas_N) noexcept {
  const ValveBody<Real>& b = motion.body;
  const Real train_N = b.train_N_m * (m.gap[1] + motion.whole.force_lag * m.gap_slope[1]);
  return (train_N - b.spring_N_m * s.lift_m - b.preload_N - b.guide_Ns_m * s.velocity_m_s - gas_N) * b.per_mass;
}

}  // namespace crankloop::detail
