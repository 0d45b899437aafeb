// A valve's tick in which a contact may change: the change is located, and the step split there.
//
// What belongs here: the path of a valve whose guards fail. What does not: the step itself (valve.hpp), which valves
// there are and what they may spend (elastic_valves.hpp).
//
//     tick   |-------------------------------|    one step; its guards fail:
//            |-------|-------|-------|-------|    fine steps, so short that cubics tell where a contact changes (one, where the tick is)
//                         x                       there: the state by the quintic through both ends,
//                         |--|                    on from it by a Taylor series in the new regime
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/tick/valve.hpp>
#include <crankloop/tick/valve_results.hpp>

namespace crankloop::detail {

/// Contact changes that may still be located in this tick, over all valves. One more is taken at the end of its fine
/// step.
struct ChangeBudget {
  std::uint32_t left;
  bool exceeded;
};

/// A cubic by the part of a step. Where one has no slope its places are infinite or no numbers, as IEEE has it, and end
/// as 1: asking first would cost a kilobyte of code on a Cortex-M4F, so the sanitizer is told that this is meant.
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
  [[nodiscard]] __attribute__((no_sanitize("float-divide-by-zero"))) constexpr Real turn() const noexcept {
    const Real x = c[1] / (c[1] - (c[1] + 2 * c[2] + 3 * c[3]));
    if (!(x > 0 && x < 1)) return 1;
    const Real better = x - at(x).slope / (2 * c[2] + 6 * x * c[3]);
    return better > 0 && better < 1 ? better : x;
  }

  /// The piece from 0 to x, by the part of it.
  constexpr void shrink(Real x) noexcept {
    c[1] *= x;
    c[2] *= x * x;
    c[3] *= x * x * x;
  }

  /// Where it reaches 0 within 0 to 1, its value at 1 given; `again`: where it comes back to 0 after having left it.
  /// The root of the quadratic through both values and the first slope, in the form that does not cancel, and one step
  /// of Newton's method.
  [[nodiscard]] __attribute__((no_sanitize("float-divide-by-zero"))) Real root(bool again, Real to) const noexcept {
    const Real sum = c[1] + 2 * c[0];
    const Real square = square_root(sum * sum - 4 * c[0] * to);
    Real x = again ? c[1] / (c[1] - to) : 2 * c[0] / ((c[0] < 0 ? -square : square) - c[1]);
    if (!(x >= 0 && x <= 1)) x = 1;
    const At now = at(x);
    x -= now.value / now.slope;
    return x < 1 ? (x > 0 ? x : Real{0}) : Real{1};  // what is not a number ends as 1
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

template <class Real, class Gas, class Record>
class ValveChanges {
 public:
  ValveChanges(const ValveMotion<Real>& motion, const LiftCurve<Real>& curve, ChangeBudget& budget,
               Record& record) noexcept
      : motion_{motion}, curve_{curve}, budget_{budget}, record_{record} {}

  /// A tick of a valve whose guards fail; `end` is where its regime's step led. The cam's speed may have changed the
  /// damper's force since the tick before, so the contacts are asked at its start too. The cam stands at `to`, `turned`
  /// units on. O(parts + changes).
  [[nodiscard]] Placed<Real> run(const Placed<Real>& start, Stepped<Real> end, const Span<Real, Gas>& tick,
                                 std::uint64_t to, std::int64_t turned) const noexcept {
    if (motion_.parts > 1 || magnitude(tick.cam.deg) > motion_.widest_step_deg)
      return by_fine_steps(start, tick, to, turned);
    const std::uint32_t regime = asked_at_start(start, tick);
    if (regime != start.regime)
      end = stepped(motion_.fine[regime], start.state, tick.from, tick.to, tick.cam.deg, tick.gas);
    return checked({start.state, regime}, end, tick);
  }

  /// A step in which no contact changed.
  void note(const Placed<Real>& from, const ValveState<Real>& to, const Span<Real, Gas>& span,
            Real step_s) const noexcept {
    if constexpr (kRecorded) {
      note_part(from.regime, from.state, to, {span.from.lift_m, span.cam.deg_per_s * span.from.per_deg_m},
                {span.to.lift_m, span.cam.deg_per_s * span.to.per_deg_m}, span, 0, 1, step_s);
    }
  }

 private:
  static constexpr bool kRecorded = !std::is_same_v<Record, NoRecord<Real>>;

  [[nodiscard]] std::uint32_t asked_at_start(const Placed<Real>& start, const Span<Real, Gas>& tick) const noexcept {
    const std::uint32_t regime = asked(motion_, start.state, tick.from, tick.cam.deg_per_s);
    note_change(contacts_of(start.regime), regime, start.state, tick, 0);
    return regime;
  }

  /// Fine steps all through the tick.
  [[nodiscard, gnu::noinline]] Placed<Real> by_fine_steps(Placed<Real> valve, const Span<Real, Gas>& tick,
                                                          std::uint64_t to, std::int64_t turned) const noexcept {
    const bool open = tick.from.lift_m > 0 || tick.to.lift_m > 0;
    const bool leaps = magnitude(tick.cam.deg) >= curve_.leap_deg;
    const bool seated = valve.regime == kSeatOn || valve.regime == kQuiet;
    if (seated && !open && !leaps && valve.state.lift_m == 0 && valve.state.velocity_m_s == 0 && tick.gas.from_N == 0 &&
        tick.gas.to_N == 0) {
      return valve;  // at rest, the cam away at both ends
    }
    valve.regime = asked_at_start(valve, tick);
    const std::uint64_t part =
        motion_.parts > 1 ? part_of(turned, motion_.per_parts_32) : static_cast<std::uint64_t>(turned);
    std::uint64_t at = to - static_cast<std::uint64_t>(turned);
    Span<Real, Gas> step{tick.from,          tick.to, {tick.cam.deg * motion_.per_parts, tick.cam.deg_per_s}, tick.gas,
                         tick.since_opening, Real{0}};
    const bool narrow = magnitude(step.cam.deg) <= motion_.widest_step_deg;
    bool was_sure = narrow && sure(valve.regime, valve.state, step.from, step.cam);
    for (std::uint32_t i = 1; i <= motion_.parts; ++i) {
      at += part;
      step.to = i == motion_.parts ? tick.to : curve_.read(LiftCurve<Real>::cell(at));
      step.gas =
          tick.gas.between(static_cast<Real>(i - 1) * motion_.per_parts, static_cast<Real>(i) * motion_.per_parts);
      Stepped<Real> end = stepped(motion_.fine[valve.regime], valve.state, step.from, step.to, step.cam.deg, step.gas);
      const bool is_sure = sure(valve.regime, end.state, step.to, step.cam);
      if (is_sure && was_sure) {
        note(valve, end.state, step, motion_.fine_step_s);
        valve.state = end.state;
      } else {
        if (!narrow)
          add_middle(valve.regime, step, at - static_cast<std::uint64_t>(static_cast<std::int64_t>(part) / 2), end);
        valve = checked(valve, end, step);
      }
      was_sure = narrow && is_sure;
      step.from = step.to;
      step.later_deg += step.cam.deg;
    }
    const Real resting_m = tick.gas.resting_m(motion_.per_seat_N_m);
    const Real up_m = resting_m > 0 ? resting_m : Real{0};
    if (valve.regime == kSeatOn && up_m + swing_m(motion_, valve.state, resting_m) < motion_.quiet_m) {
      valve.regime = kQuiet;
      const RegimeStep<Real>& quiet = motion_.whole[kQuiet];
      if (magnitude(valve.state.lift_m - resting_m) < quiet.rest_m &&
          magnitude(valve.state.velocity_m_s) < quiet.rest_m_s) {
        valve.state = {resting_m, Real{0}};
      }
    }
    return valve;
  }

  /// What the cam's lift in the middle of a wide fine step, over which the cubic through its ends does not do, adds to
  /// it.
  [[gnu::noinline]] void add_middle(std::uint32_t regime, const Span<Real, Gas>& step, std::uint64_t middle,
                                    Stepped<Real>& end) const noexcept {
    if ((regime & kTrainOn) == 0) return;
    const MiddleStep<Real>& by = motion_.middle[regime >> 1];
    const Lift<Real> lift = curve_.read(LiftCurve<Real>::cell(middle));
    const Real from_slope = step.cam.deg * step.from.per_deg_m;
    const Real to_slope = step.cam.deg * step.to.per_deg_m;
    const Real rise = step.to.lift_m - step.from.lift_m;
    const Real more_m = lift.lift_m - step.from.lift_m - (rise / 2 + (from_slope - to_slope) / 8);
    const Real more_slope_m = step.cam.deg * lift.per_deg_m - (6 * rise - (from_slope + to_slope)) / 4;
    const Real higher_m = by.lift_by_lift * more_m + by.lift_by_slope * more_slope_m;
    end.state.lift_m += higher_m;
    end.state.velocity_m_s += by.velocity_by_lift * more_m + by.velocity_by_slope * more_slope_m;
    end.rise_m += higher_m;
  }

  /// Whether a fine step's guards hold at one of its ends.
  [[nodiscard]] bool sure(std::uint32_t regime, const ValveState<Real>& s, const Lift<Real>& cam,
                          const CamTurn<Real>& turn) const noexcept {
    const RegimeStep<Real>& r = motion_.fine[regime];
    return holds(r.train, cam.lift_m - s.lift_m, turn.deg_per_s * cam.per_deg_m - s.velocity_m_s) &&
           holds(r.seat, s.lift_m, s.velocity_m_s);
  }

  /// A fine step: most often no contact changes in it.
  [[nodiscard]] Placed<Real> checked(const Placed<Real>& start, const Stepped<Real>& end,
                                     const Span<Real, Gas>& step) const noexcept {
    if (!(magnitude(end.state.lift_m) < static_cast<Real>(kFarthest_m))) {  // nor is it a number
      budget_.exceeded = true;
      return in_equilibrium(motion_, step.to.lift_m, static_cast<Real>(step.gas.to_N));
    }
    std::uint32_t now = asked(motion_, end.state, step.to, step.cam.deg_per_s);
    const Cubic<Real> lift(step.from.lift_m, step.cam.deg * step.from.per_deg_m, step.to.lift_m,
                           step.cam.deg * step.to.per_deg_m);
    if (now == start.regime) now ^= passing_change(stretch_of(start, end, lift, 1, step), now);
    if (now != start.regime && budget_.left != 0) return through_changes(start, end, now, lift, step);
    note(start, end.state, step, motion_.fine_step_s);
    if (now != start.regime) {
      budget_.exceeded = true;
      note_change(start.regime, now, end.state, step, 1);
    }
    return {end.state, now};
  }

  /// A contact's depth, with its speed and the rate of that, at both ends of a stretch.
  struct Contact {
    Real depth_m[2], speed_m_s[2], rate_m_s2[2];
  };

  /// Part of a fine step between two states of one regime.
  struct Stretch {
    Real d_s;
    ValveState<Real> from, to;
    Real rise_m;
    Real acceleration[2];
    Contact train, seat;

    /// What changes its sign where a contact does, by the part of the stretch. One that is on ends where its force
    /// does. One that is off begins where its depth becomes positive; or, there already, where its force does.
    [[nodiscard]] Cubic<Real> switching(const Contact& c, bool is_on, Real lag_s) const noexcept {
      const Real lag = !is_on && c.depth_m[0] <= 0 ? Real{0} : lag_s;
      return Cubic<Real>(c.depth_m[0] + lag * c.speed_m_s[0], d_s * (c.speed_m_s[0] + lag * c.rate_m_s2[0]),
                         c.depth_m[1] + lag * c.speed_m_s[1], d_s * (c.speed_m_s[1] + lag * c.rate_m_s2[1]));
    }

    /// The state at a part of it: the quintic through states and accelerations at both ends.
    [[nodiscard]] ValveState<Real> at(Real x) const noexcept {
      const Real v0 = from.velocity_m_s * d_s;
      const Real half = d_s * d_s / 2;
      const Real a0 = acceleration[0] * half;
      const Real rise = rise_m - v0 - a0;
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
  [[nodiscard]] Stretch stretch_of(const Placed<Real>& valve, const Stepped<Real>& end, const Cubic<Real>& lift,
                                   Real left, const Span<Real, Gas>& step) const noexcept {
    const Real per_s = motion_.per_fine_step_s;
    const ForceRow<Real>& force = motion_.fine[valve.regime].acceleration;
    const Gas gas = step.gas.between(1 - left, 1);
    Stretch s;
    s.d_s = left * motion_.fine_step_s;
    s.from = valve.state, s.to = end.state, s.rise_m = end.rise_m;
    Contact& train = s.train;
    train.depth_m[0] = lift.c[0] - s.from.lift_m, train.depth_m[1] = step.to.lift_m - s.to.lift_m;
    train.speed_m_s[0] = lift.c[1] * per_s - s.from.velocity_m_s;
    train.speed_m_s[1] = step.cam.deg_per_s * step.to.per_deg_m - s.to.velocity_m_s;
    s.acceleration[0] = acceleration(force, s.from, train.depth_m[0], train.speed_m_s[0], gas.between(0, 0));
    s.acceleration[1] = acceleration(force, s.to, train.depth_m[1], train.speed_m_s[1], gas);
    train.rate_m_s2[0] = 2 * lift.c[2] * (per_s * per_s) - s.acceleration[0];
    train.rate_m_s2[1] = (2 * lift.c[2] + 6 * left * lift.c[3]) * (per_s * per_s) - s.acceleration[1];
    Contact& seat = s.seat;
    seat.depth_m[0] = motion_.body.seat_sink_m - s.from.lift_m,
    seat.depth_m[1] = motion_.body.seat_sink_m - s.to.lift_m;
    seat.speed_m_s[0] = -s.from.velocity_m_s, seat.speed_m_s[1] = -s.to.velocity_m_s;
    seat.rate_m_s2[0] = -s.acceleration[0], seat.rate_m_s2[1] = -s.acceleration[1];
    return s;
  }

  /// A contact that changes and changes back within a stretch: what tells of it turns round beyond zero.
  [[nodiscard]] std::uint32_t passing_change(const Stretch& s, std::uint32_t regime) const noexcept {
    const auto passes = [&](const Contact& c, bool is_on, Real lag_s) {
      const Cubic<Real> f = s.switching(c, is_on, lag_s);
      const Real sign = is_on ? Real{1} : Real{-1};
      return sign * f.c[1] < 0 && sign * (f.c[1] + 2 * f.c[2] + 3 * f.c[3]) > 0 && sign * f.at(f.turn()).value < 0;
    };
    if (passes(s.train, (regime & kTrainOn) != 0, motion_.train_lag_s)) return kTrainOn;
    return passes(s.seat, (regime & kSeatOn) != 0, motion_.seat_lag_s) ? kSeatOn : 0u;
  }

  /// The part of a stretch after which a contact changes; `again`: it has changed at the stretch's start.
  [[nodiscard]] static Real place_of(const Stretch& s, const Contact& c, bool is_on, bool again, Real lag_s) noexcept {
    Cubic<Real> f = s.switching(c, is_on, lag_s);
    const Real last = f.c[0] + f.c[1] + f.c[2] + f.c[3];
    if (again || (f.c[0] > 0) != (last > 0)) return f.root(again, last);
    const Real turn = f.turn();  // it changes back before the end
    f.shrink(turn);
    return turn * f.root(false, f.at(1).value);
  }

  /// A fine step in which a contact changes: from change to change. Each round takes one of the budget, of which some
  /// is left.
  [[nodiscard, gnu::noinline]] Placed<Real> through_changes(Placed<Real> valve, Stepped<Real> end, std::uint32_t now,
                                                            Cubic<Real> lift,
                                                            const Span<Real, Gas>& step) const noexcept {
    Real left = 1;
    std::uint32_t last = 0;
    do {
      --budget_.left;
      const std::uint32_t ended = now ^ valve.regime;
      const Stretch s = stretch_of(valve, end, lift, left, step);
      Real x = 1;
      std::uint32_t changed = 0;
      if ((ended & kTrainOn) != 0) {
        x = place_of(s, s.train, (valve.regime & kTrainOn) != 0, last == kTrainOn, motion_.train_lag_s);
        changed = kTrainOn;
      }
      if ((ended & kSeatOn) != 0) {
        const Real at = place_of(s, s.seat, (valve.regime & kSeatOn) != 0, last == kSeatOn, motion_.seat_lag_s);
        if (changed == 0 || at < x) x = at, changed = kSeatOn;
      }
      const ValveState<Real> there = s.at(x);
      const Real passed = x * left;
      note_stretch(valve, there, lift, 1 - left, passed, step);
      lift.shift(passed);
      left -= passed;
      note_change(valve.regime, valve.regime ^ changed, there, step, 1 - left);
      valve = {there, valve.regime ^ changed};
      last = changed;
      end = by_series(motion_.series[valve.regime], valve.state, lift, left, step.gas.between(1 - left, 2 - left));
      now = asked(motion_, end.state, step.to, step.cam.deg_per_s);
    } while (budget_.left != 0 && now != valve.regime && left > 0);
    if (now != valve.regime && left > 0) budget_.exceeded = true;
    note_stretch(valve, end.state, lift, 1 - left, left, step);
    note_change(valve.regime, now, end.state, step, 1);
    return {end.state, now};
  }

  /// The motion from the origin of the lift's piece on, over the part x of a fine step: derivatives by the equation of
  /// motion, order 8, so exact to (rate step)^9 / 9!. The gas force is linear: `gas` over a whole fine step from there.
  [[nodiscard]] Stepped<Real> by_series(const RegimeSeries<Real>& k, const ValveState<Real>& s, const Cubic<Real>& lift,
                                        Real x, const Gas& gas) const noexcept {
    const Real l1 = lift.c[1];
    const Real l2 = 2 * lift.c[2];
    const Real l3 = 6 * lift.c[3];
    const auto next = [&k](Real drive, Real y, Real v) { return drive - k.stiffness * y - k.damping * v; };
    const Real y0 = s.lift_m;
    const Real y1 = s.velocity_m_s * motion_.fine_step_s;
    const Real y2 = next(k.rest + gas.at_start(k.gas) + k.lift * lift.c[0] + k.lift_speed * l1, y0, y1);
    const Real y3 = next(gas.risen(k.gas) + k.lift * l1 + k.lift_speed * l2, y1, y2);
    const Real y4 = next(k.lift * l2 + k.lift_speed * l3, y2, y3);
    const Real y5 = next(k.lift * l3, y3, y4);
    const Real y6 = next(0, y4, y5);
    const Real y7 = next(0, y5, y6);
    const Real y8 = next(0, y6, y7);
    const auto over = [x](int n) { return x * (Real{1} / static_cast<Real>(n)); };
    const Real rise =
        x *
        (y1 +
         over(2) *
             (y2 + over(3) * (y3 + over(4) * (y4 + over(5) * (y5 + over(6) * (y6 + over(7) * (y7 + over(8) * y8)))))));
    const Real slope =
        y1 +
        x * (y2 + over(2) * (y3 + over(3) * (y4 + over(4) * (y5 + over(5) * (y6 + over(6) * (y7 + over(7) * y8))))));
    return {{y0 + rise, slope * motion_.per_fine_step_s}, rise};
  }

  // ---- the record of a cycle --------------------------------------------------------------------------------------

  /// Cam degrees since the start of the lobe at a part of a span.
  [[nodiscard]] Real deg_at(const Span<Real, Gas>& span, Real part) const noexcept {
    return curve_.degrees(span.since_opening) + span.later_deg + part * span.cam.deg;
  }

  /// A cam's lift and its speed at one moment.
  struct Theory {
    Real lift_m, speed_m_s;
  };

  void note_part(std::uint32_t regime, const ValveState<Real>& from, const ValveState<Real>& to,
                 const Theory& theory_from, const Theory& theory_to, const Span<Real, Gas>& span, Real from_part,
                 Real to_part, Real step_s) const noexcept {
    const ForceRow<Real>& force = motion_.fine[regime].acceleration;
    const Gas gas = span.gas.between(from_part, to_part);
    const auto accelerates = [&](const ValveState<Real>& s, const Theory& at, const Gas& by) {
      return acceleration(force, s, at.lift_m - s.lift_m, at.speed_m_s - s.velocity_m_s, by);
    };
    record_.step({from, to, theory_from.lift_m, theory_to.lift_m, theory_from.speed_m_s, theory_to.speed_m_s,
                  accelerates(from, theory_from, gas.between(0, 0)), accelerates(to, theory_to, gas), step_s,
                  contacts_of(regime)},
                 motion_.body.seat_sink_m,
                 [&](Real part) { return deg_at(span, from_part + part * (to_part - from_part)); });
  }

  /// From the origin of `lift`, which is at `from_part` of the step, over `part` of it.
  void note_stretch(const Placed<Real>& from, const ValveState<Real>& to, const Cubic<Real>& lift, Real from_part,
                    Real part, const Span<Real, Gas>& step) const noexcept {
    if constexpr (kRecorded) {
      const auto theory = [&](Real x) {
        const typename Cubic<Real>::At at = lift.at(x);
        return Theory{at.value, at.slope * motion_.per_fine_step_s};
      };
      note_part(from.regime, from.state, to, theory(0), theory(part), step, from_part, from_part + part,
                part * motion_.fine_step_s);
    }
  }

  void note_change(std::uint32_t before, std::uint32_t after, const ValveState<Real>& s, const Span<Real, Gas>& span,
                   Real part) const noexcept {
    if constexpr (kRecorded) {
      if (before != after) record_.change(before, after, s.velocity_m_s, deg_at(span, part));
    }
  }

  const ValveMotion<Real>& motion_;
  const LiftCurve<Real>& curve_;
  ChangeBudget& budget_;
  Record& record_;
};

}  // namespace crankloop::detail
