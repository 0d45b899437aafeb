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

/// True when no contact can change in a whole step with the seat off, as far as the cubics through its ends tell, with a margin: gaps keep
/// their side, the train's force its sign. (On the seat nothing could be told: its own vibration is faster than a whole step.)
template <class Real>
[[nodiscard]] constexpr bool far_from_change(const ValveMotion<Real>& motion, std::uint32_t regime, const Between<Real>& m) noexcept {
  constexpr Real kMargin_m = static_cast<Real>(2e-6);
  if (!above(m.y, motion.body.seat_sink_m + kMargin_m + slopes(m.y_slope) * kThird<Real>)) return false;
  const Real gap_slopes = slopes(m.gap_slope);
  const Real bound = kMargin_m + gap_slopes * kThird<Real>;
  if ((regime & kTrainOn) == 0) return m.gap[0] < -bound && m.gap[1] < -bound;
  // No ordinate of the gap's slope is larger than this.
  const Real steepest = gap_slopes + 2 * magnitude(m.gap[1] - m.gap[0]);
  if (above(m.gap, bound + motion.force_lag * steepest)) return true;  // by far: most steps
  return above(m.gap, bound) && pushes(m, motion.force_lag, kMargin_m);
}

}  // namespace crankloop::detail
