// A smooth segment of a valve's motion, all in one regime: where in it an event lies, the state there, and how the
// motion goes on.
//
// What belongs here: one segment by itself. What does not: which segments a tick has, and what it may spend on them
// (event_location.hpp).
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/tick/one_instruction.hpp>
#include <crankloop/tick/valve/valve.hpp>

namespace crankloop::detail {

/// A cubic by the part of a step. Where one has no slope its places are infinite or no numbers, as IEEE has it, and end
/// as 1: testing first would cost a kilobyte of code on a Cortex-M4F, so the sanitizer is told to expect it.
template <class Real>
struct Cubic {
  Real c[4];

  /// Through values and slopes at both ends.
  constexpr Cubic(Real from, Real from_slope, Real to, Real to_slope) noexcept
      : c{from, from_slope, 3 * (to - from) - 2 * from_slope - to_slope, from_slope + to_slope - 2 * (to - from)} {}

  struct At {
    Real value, slope;
  };
  [[nodiscard]] constexpr At at(Real x) const noexcept {
    Real slope = c[3];
    Real value = c[2] + x * c[3];
    slope = value + x * slope;
    value = c[1] + x * value;
    slope = value + x * slope;
    value = c[0] + x * value;
    return {value, slope};
  }

  /// Moves the origin by x.
  constexpr void shift(Real x) noexcept {
    const At now = at(x);
    c[2] += 3 * x * c[3];
    c[1] = now.slope;
    c[0] = now.value;
  }

  /// Where its slope passes 0 within 0 to 1: by the slopes at both ends, and one step of Newton's method. 1 where it
  /// does not.
  [[nodiscard]] __attribute__((no_sanitize("float-divide-by-zero"))) constexpr Real extremum() const noexcept {
    const Real x = c[1] / (c[1] - (c[1] + 2 * c[2] + 3 * c[3]));
    if (!(x > 0 && x < 1)) return 1;
    const Real better = x - at(x).slope / (2 * c[2] + 6 * x * c[3]);
    return better > 0 && better < 1 ? better : x;
  }

  /// The piece from 0 to x, by the part of it.
  constexpr void shrink(Real x) noexcept {
    CRANKLOOP_ASSERT(x > 0 && x <= 1);
    c[1] *= x;
    c[2] *= x * x;
    c[3] *= x * x * x;
  }

  /// Where it reaches 0 within 0 to 1, its value at 1 given; `again`: it starts at 0, and the root is where it comes
  /// back. The root of the quadratic through both values and the first slope, in the form that does not cancel, and one
  /// step of Newton's method.
  [[nodiscard]] __attribute__((no_sanitize("float-divide-by-zero"))) Real root(bool again, Real to) const noexcept {
    const Real sum = c[1] + 2 * c[0];
    const Real square = square_root(sum * sum - 4 * c[0] * to);
    Real x = again ? c[1] / (c[1] - to) : 2 * c[0] / ((c[0] < 0 ? -square : square) - c[1]);
    if (!(x >= 0 && x <= 1)) x = 1;
    const At now = at(x);
    x -= now.value / now.slope;
    return x < 1 ? (x > 0 ? x : Real{0}) : Real{1};  // NaN ends as 1
  }
};

/// A tick, or a fine step of it.
template <class Real, class Gas>
struct Span {
  Lift<Real> from, to;
  CamTurn<Real> cam;
  Gas gas;
  std::uint64_t since_opening;  ///< phase units, at the tick's start
  Real later_deg;               ///< cam degrees that have passed since
};

/// A contact's depth, its speed and its acceleration at both ends of a segment.
template <class Real>
struct Contact {
  Real depth_m[2], speed_m_s[2], rate_m_s2[2];
};

/// Part of a fine step between two states of one regime.
template <class Real>
struct SmoothSegment {
  Real d_s;
  ValveState<Real> from, to;
  Real increment_m;
  Real acceleration[2];

  /// The state at a fraction of it: the quintic through states and accelerations at both ends.
  [[nodiscard]] ValveState<Real> at(Real x) const noexcept {
    CRANKLOOP_ASSERT(x >= 0 && x <= 1);
    CRANKLOOP_ASSERT(d_s > 0);
    const Real v0 = from.velocity_m_s * d_s;
    const Real half = d_s * d_s / 2;
    const Real a0 = acceleration[0] * half;
    const Real rise = increment_m - v0 - a0;
    const Real slope = to.velocity_m_s * d_s - v0 - 2 * a0;
    const Real bend = acceleration[1] * half - a0;
    const Real c[] = {from.lift_m,
                      v0,
                      a0,
                      10 * rise - 4 * slope + bend,
                      -15 * rise + 7 * slope - 2 * bend,
                      6 * rise - 3 * slope + bend};
    Real value = c[5];
    Real by_part = 0;
    for (int i = 4; i >= 0; --i) {
      by_part = value + x * by_part;
      value = c[i] + x * value;
    }
    return {value, by_part / d_s};
  }
};

/// The rest of a fine step, `left` of it, from the origin of `lift`.
template <class Real, class Gas>
[[nodiscard]] inline SmoothSegment<Real> segment_of(const ValveMotion<Real>& motion, const ValveInRegime<Real>& valve,
                                                    const Stepped<Real>& end, const Cubic<Real>& lift, Real left,
                                                    const Span<Real, Gas>& step) noexcept {
  CRANKLOOP_ASSERT(left > 0 && left <= 1);
  CRANKLOOP_ASSERT(valve.regime < std::uint32_t{kRegimes});
  const Real per_s = motion.per_fine_step_s;
  const ForceRow<Real>& force = motion.fine[valve.regime].acceleration;
  const Gas gas = step.gas.between(1 - left, 1);
  SmoothSegment<Real> s;
  s.d_s = left * motion.fine_step_s;
  s.from = valve.state, s.to = end.state, s.increment_m = end.increment_m;
  const Real depth_m[] = {lift.c[0] - s.from.lift_m, step.to.lift_m - s.to.lift_m};
  const Real speed_m_s[] = {lift.c[1] * per_s - s.from.velocity_m_s,
                            step.cam.deg_per_s * step.to.per_deg_m - s.to.velocity_m_s};
  s.acceleration[0] = acceleration(force, s.from, depth_m[0], speed_m_s[0], gas.between(0, 0));
  s.acceleration[1] = acceleration(force, s.to, depth_m[1], speed_m_s[1], gas);
  return s;
}

/// The train's contact over it.
template <class Real, class Gas>
[[nodiscard]] inline Contact<Real> train_over(const ValveMotion<Real>& motion, const SmoothSegment<Real>& s,
                                              const Cubic<Real>& lift, Real left,
                                              const Span<Real, Gas>& step) noexcept {
  const Real per_s = motion.per_fine_step_s;
  return {{lift.c[0] - s.from.lift_m, step.to.lift_m - s.to.lift_m},
          {lift.c[1] * per_s - s.from.velocity_m_s, step.cam.deg_per_s * step.to.per_deg_m - s.to.velocity_m_s},
          {2 * lift.c[2] * (per_s * per_s) - s.acceleration[0],
           (2 * lift.c[2] + 6 * left * lift.c[3]) * (per_s * per_s) - s.acceleration[1]}};
}

/// The seat's.
template <class Real>
[[nodiscard]] inline Contact<Real> seat_over(const ValveMotion<Real>& motion, const SmoothSegment<Real>& s) noexcept {
  const Real contact_m = motion.body.seat_compression_m;
  return {{contact_m - s.from.lift_m, contact_m - s.to.lift_m},
          {-s.from.velocity_m_s, -s.to.velocity_m_s},
          {-s.acceleration[0], -s.acceleration[1]}};
}

/// The event function of a contact over a segment of `d_s`, 0 to 1: it changes sign where the contact does. A contact
/// that is on ends where its force does. One that is off begins where its depth becomes positive or, if it is already,
/// where its force does.
template <class Real>
[[nodiscard]] inline Cubic<Real> event_function(const Contact<Real>& c, bool is_on, Real lag_s, Real d_s) noexcept {
  const Real lag = !is_on && c.depth_m[0] <= 0 ? Real{0} : lag_s;
  return Cubic<Real>(c.depth_m[0] + lag * c.speed_m_s[0], d_s * (c.speed_m_s[0] + lag * c.rate_m_s2[0]),
                     c.depth_m[1] + lag * c.speed_m_s[1], d_s * (c.speed_m_s[1] + lag * c.rate_m_s2[1]));
}

/// A wide fine step with what the cam's lift in its middle adds.
template <class Real, class Gas>
[[nodiscard, gnu::cold, gnu::noinline]] Stepped<Real> with_middle_of(const RegimeStep<Real>& regime,
                                                                     const LiftCurve<Real>& curve,
                                                                     const Span<Real, Gas>& step, std::uint64_t middle,
                                                                     const Stepped<Real>& end) noexcept {
  return with_middle(end, regime.middle, step.from, curve.read(LiftCurve<Real>::cell(middle)).lift_m, step.to,
                     step.cam.deg);
}

/// Whether an event of the train's contact may as well count at the step's end: the gap there is less than the distance
/// at which a valve is taken to be at rest. Without lash a closed valve's train touches and leaves by less than that.
template <class Real>
[[nodiscard]] constexpr bool is_negligible(const ValveMotion<Real>& motion, std::uint32_t contact,
                                           const ValveState<Real>& end, const Lift<Real>& cam) noexcept {
  return contact == kTrainOn && magnitude(cam.lift_m - end.lift_m) < motion.fine[kSeatOn].rest_m;
}

/// Whether a contact changes and changes back within a segment: its event function has an extremum beyond zero.
template <class Real>
[[nodiscard]] inline bool grazes(const Cubic<Real>& f, bool is_on) noexcept {
  const Real sign = is_on ? Real{1} : Real{-1};
  return sign * f.c[1] < 0 && sign * (f.c[1] + 2 * f.c[2] + 3 * f.c[3]) > 0 && sign * f.at(f.extremum()).value < 0;
}

/// Where an event function that has the same sign at both ends first changes it: before its extremum.
template <class Real>
[[nodiscard]] inline Real grazing_fraction(Cubic<Real> f) noexcept {
  const Real extremum = f.extremum();
  f.shrink(extremum);
  return extremum * f.root(false, f.at(1).value);
}

/// The motion from the origin of the lift's cubic on, over the part x of a fine step: derivatives by the equation of
/// motion, order 8, so exact to (rate step)^9 / 9!. The gas force is linear: `gas` over a whole fine step from there.
template <class Real, class Gas>
[[nodiscard]] inline Stepped<Real> by_series(const ValveMotion<Real>& motion, std::uint32_t regime,
                                             const ValveState<Real>& s, const Cubic<Real>& lift, Real x,
                                             const Gas& gas) noexcept {
  CRANKLOOP_ASSERT(regime < kQuiet);
  CRANKLOOP_ASSERT(x >= 0 && x <= 1);
  const RegimeSeries<Real>& k = motion.series[regime];
  const Real l1 = lift.c[1];
  const Real l2 = 2 * lift.c[2];
  const Real l3 = 6 * lift.c[3];
  const auto next = [&k](Real drive, Real y, Real v) { return drive - k.stiffness * y - k.damping * v; };
  const Real y0 = s.lift_m;
  const Real y1 = s.velocity_m_s * motion.fine_step_s;
  const Real y2 = next(k.rest + gas.at_start(k.gas) + k.lift * lift.c[0] + k.lift_speed * l1, y0, y1);
  const Real y3 = next(gas.risen(k.gas) + k.lift * l1 + k.lift_speed * l2, y1, y2);
  const Real y4 = next(k.lift * l2 + k.lift_speed * l3, y2, y3);
  const Real y5 = next(k.lift * l3, y3, y4);
  const Real y6 = next(0, y4, y5);
  const Real y7 = next(0, y5, y6);
  const Real y8 = next(0, y6, y7);
  const auto over = [x](int n) { return x * (Real{1} / static_cast<Real>(n)); };
  const Real rise =
      x * (y1 + over(2) *
                    (y2 + over(3) *
                              (y3 + over(4) * (y4 + over(5) * (y5 + over(6) * (y6 + over(7) * (y7 + over(8) * y8)))))));
  const Real slope =
      y1 + x * (y2 + over(2) * (y3 + over(3) * (y4 + over(4) * (y5 + over(5) * (y6 + over(6) * (y7 + over(7) * y8))))));
  return {{y0 + rise, slope * motion.per_fine_step_s}, rise};
}

}  // namespace crankloop::detail
