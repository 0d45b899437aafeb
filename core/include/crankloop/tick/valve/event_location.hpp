// Event location: a valve's tick in which a contact may change. Each event is located, and the step split there.
//
// What belongs here: the path of a valve whose guards fail. What does not: the step itself (valve.hpp), which valves
// there are and who may spend the event budget (elastic_valves.hpp).
//
//     tick   |-------------------------------|    one step; its guards fail:
//            |-------|-------|-------|-------|    fine steps, so short that cubics locate an event
//                                                  (the tick itself where it is short enough)
//                         x                       there: the state by the quintic through both ends,
//                         |--|                    on from it by a Taylor series in the new regime
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/assert.hpp>
#include <crankloop/tick/valve/smooth_segment.hpp>
#include <crankloop/tick/valve/valve.hpp>
#include <crankloop/tick/valve/valve_results.hpp>

namespace crankloop::detail {

/// What event location may still spend in this tick, over all valves, in units: a fine step is one (a tick that is not
/// divided counts as one, and kUnitsOfLook more if it has no event), an event located in it kUnitsOfEvent more. An
/// event beyond it counts at the end of its step.
struct EventBudget {
  std::uint32_t left;
  bool exceeded;

  [[nodiscard]] bool spend(std::uint32_t units) noexcept {
    if (left < units) return false;
    left -= units;
    return true;
  }
  /// Of what is sure to be left.
  void take(std::uint32_t units) noexcept {
    CRANKLOOP_ASSERT(left >= units);
    left -= units;
  }
};

/// No valve gets so far; nor is one that is no number anywhere.
template <class Real>
[[nodiscard]] inline bool is_too_far(const ValveState<Real>& s) noexcept {
  return !(magnitude(s.lift_m) < static_cast<Real>(kMaxLift_m));
}

/// A tick in one step, for want of budget: contacts change at its end. One that begins is as deep as after a fine step:
/// deeper in a stiff seat the valve would gain energy that it never had.
template <class Real>
[[nodiscard]] inline ValveInRegime<Real> beyond_budget(const ValveMotion<Real>& m, std::uint32_t before,
                                                       ValveState<Real> s, const Lift<Real>& cam,
                                                       Real deg_per_s) noexcept {
  const std::uint32_t now = required_contacts(m, s, cam, deg_per_s);
  const std::uint32_t begin = now & ~contacts_of(before);
  if (begin != 0) {
    const Real contact_m = (begin & kSeatOn) != 0 ? m.body.seat_compression_m : cam.lift_m;
    s.lift_m = contact_m + (s.lift_m - contact_m) * m.per_parts;
  }
  return {s, now};
}

/// Whether a valve is at rest and stays so, its cam away all through the tick.
template <class Real, class Gas>
[[nodiscard]] inline bool rests(const ValveInRegime<Real>& valve, const LiftCurve<Real>& curve, Real from_m, Real to_m,
                                Real deg, const Gas& gas) noexcept {
  const bool open = from_m > 0 || to_m > 0;
  const bool may_skip = magnitude(deg) >= curve.skip_deg;
  return contacts_of(valve.regime) == kSeatOn && !open && !may_skip && valve.state.lift_m == 0 &&
         valve.state.velocity_m_s == 0 && gas.from_N == 0 && gas.to_N == 0;
}

template <class Real, class Gas, class Record>
class EventLocator {
 public:
  EventLocator(const ValveMotion<Real>& motion, const LiftCurve<Real>& curve, EventBudget& budget,
               Record& record) noexcept
      : motion_{motion}, curve_{curve}, budget_{budget}, record_{record} {}

  /// A tick of a valve whose guards fail, its fine steps paid for; `end` is where its regime's step led. The cam's
  /// speed may have changed the damper's force since the tick before, so the contacts are checked at the start too. The
  /// cam stands at `to`, `turned` units on. O(parts + events).
  [[nodiscard]] ValveInRegime<Real> run(const ValveInRegime<Real>& start, Stepped<Real> end,
                                        const Span<Real, Gas>& tick, std::uint64_t to,
                                        std::int64_t turned) const noexcept {
    CRANKLOOP_ASSERT(start.regime < std::uint32_t{kRegimes});
    CRANKLOOP_ASSERT(is_finite(start.state.lift_m) && is_finite(start.state.velocity_m_s));
    CRANKLOOP_ASSERT(motion_.parts >= 1);
    if (motion_.parts > 1 || magnitude(tick.cam.deg) > motion_.cubic_deg) return by_fine_steps(start, tick, to, turned);
    std::uint32_t regime = required_contacts(motion_, start.state, tick.from, tick.cam.deg_per_s);
    const std::uint32_t before = contacts_of(start.regime);  // whose step is that of a quiet valve too
    if (regime != before) {
      if (budget_.left > kUnitsOfSearch) {
        budget_.take(kUnitsOfSearch);
        end = stepped(motion_.fine[regime], start.state, tick.from, tick.to, tick.cam.deg, tick.gas);
      } else {
        budget_.exceeded = true;
        regime = before;
      }
    }
    record_event(before, regime, start.state, tick, 0);
    return finish_step<kUnitsOfLook>({start.state, regime}, end, tick);
  }

  /// Records a tick in one step, for want of budget.
  void record_unlocated(const ValveInRegime<Real>& start, const ValveInRegime<Real>& end,
                        const Span<Real, Gas>& tick) const noexcept {
    record_step(start, end.state, tick, motion_.tick_s);
    record_event(contacts_of(start.regime), end.regime, end.state, tick, 1);
  }

  /// Records a step without an event.
  void record_step(const ValveInRegime<Real>& from, const ValveState<Real>& to, const Span<Real, Gas>& span,
                   Real step_s) const noexcept {
    if constexpr (kRecorded) {
      record_part(from.regime, from.state, to, {span.from.lift_m, span.cam.deg_per_s * span.from.per_deg_m},
                  {span.to.lift_m, span.cam.deg_per_s * span.to.per_deg_m}, span, 0, 1, step_s);
    }
  }

 private:
  static constexpr bool kRecorded = !std::is_same_v<Record, NoRecord<Real>>;

  [[nodiscard]] std::uint32_t contacts_at_start(const ValveInRegime<Real>& start,
                                                const Span<Real, Gas>& tick) const noexcept {
    const std::uint32_t regime = required_contacts(motion_, start.state, tick.from, tick.cam.deg_per_s);
    record_event(contacts_of(start.regime), regime, start.state, tick, 0);
    return regime;
  }

  /// Fine steps all through the tick.
  [[nodiscard, gnu::noinline]] ValveInRegime<Real> by_fine_steps(ValveInRegime<Real> valve, const Span<Real, Gas>& tick,
                                                                 std::uint64_t to, std::int64_t turned) const noexcept {
    valve.regime = contacts_at_start(valve, tick);
    const std::uint64_t part =
        motion_.parts > 1 ? part_of(turned, motion_.per_parts_32) : static_cast<std::uint64_t>(turned);
    std::uint64_t at = to - static_cast<std::uint64_t>(turned);
    Span<Real, Gas> step{tick.from,          tick.to, {tick.cam.deg * motion_.per_parts, tick.cam.deg_per_s}, tick.gas,
                         tick.since_opening, Real{0}};
    const bool narrow = magnitude(step.cam.deg) <= motion_.cubic_deg;
    bool passed = narrow && guards_pass(valve.regime, valve.state, step.from, step.cam);
    for (std::uint32_t i = 1; i <= motion_.parts; ++i) {
      CRANKLOOP_ASSERT(valve.regime < kQuiet);
      at += part;
      step.to = i == motion_.parts ? tick.to : curve_.read(LiftCurve<Real>::cell(at));
      step.gas =
          tick.gas.between(static_cast<Real>(i - 1) * motion_.per_parts, static_cast<Real>(i) * motion_.per_parts);
      Stepped<Real> end = stepped(motion_.fine[valve.regime], valve.state, step.from, step.to, step.cam.deg, step.gas);
      const bool pass = guards_pass(valve.regime, end.state, step.to, step.cam);
      if (pass && passed) {
        record_step(valve, end.state, step, motion_.fine_step_s);
        valve.state = end.state;
      } else {
        if (!narrow)
          end = with_middle_of(motion_.fine[valve.regime], curve_, step,
                               at - static_cast<std::uint64_t>(static_cast<std::int64_t>(part) / 2), end);
        valve = finish_step<0>(valve, end, step);
      }
      passed = narrow && pass;
      step.from = step.to;
      step.later_deg += step.cam.deg;
    }
    constexpr std::uint64_t kRounding = std::uint64_t{1} << 44;  // up to 2^31 in each of up to 4096 parts
    CRANKLOOP_ASSERT(to - at + kRounding <= 2 * kRounding);
    const Real resting_m = tick.gas.resting_m(motion_.per_seat_N_m);
    const Real up_m = resting_m > 0 ? resting_m : Real{0};
    if (valve.regime == kSeatOn && up_m + seated_amplitude_m(motion_, valve.state, resting_m) < motion_.quiet_m) {
      valve.regime = kQuiet;
      const RegimeStep<Real>& quiet = motion_.whole[kQuiet];
      if (magnitude(valve.state.lift_m - resting_m) < quiet.rest_m &&
          magnitude(valve.state.velocity_m_s) < quiet.rest_m_s) {
        valve.state = {resting_m, Real{0}};
      }
    }
    return valve;
  }

  /// Whether both guards of a fine step pass at one of its ends.
  [[nodiscard]] bool guards_pass(std::uint32_t regime, const ValveState<Real>& s, const Lift<Real>& cam,
                                 const CamTurn<Real>& turn) const noexcept {
    const RegimeStep<Real>& r = motion_.fine[regime];
    return passes(r.train, cam.lift_m - s.lift_m, turn.deg_per_s * cam.per_deg_m - s.velocity_m_s) &&
           passes(r.seat, s.lift_m, s.velocity_m_s);
  }

  /// Whether a contact may change and change back within a fine step: its event function (SmoothSegment) then has an
  /// extremum there. By its slopes at both ends, which where a contact is on matter only if it fails its guard.
  [[nodiscard, gnu::noinline]] bool may_graze(std::uint32_t regime, const ValveState<Real>& from,
                                              const ValveState<Real>& to, const Span<Real, Gas>& step) const noexcept {
    const Real gap_m[] = {step.from.lift_m - from.lift_m, step.to.lift_m - to.lift_m};
    const Real gap_m_s[] = {step.cam.deg_per_s * step.from.per_deg_m - from.velocity_m_s,
                            step.cam.deg_per_s * step.to.per_deg_m - to.velocity_m_s};
    const RegimeStep<Real>& r = motion_.fine[regime];
    const bool train = (regime & kTrainOn) != 0;
    const bool seat = (regime & kSeatOn) != 0;
    if (!train && (gap_m[0] > 0 || (gap_m_s[0] > 0 && gap_m_s[1] < 0))) return true;
    if (!seat && (from.lift_m < motion_.body.seat_compression_m || (from.velocity_m_s < 0 && to.velocity_m_s > 0)))
      return true;
    const bool train_fails = train && !(passes(r.train, gap_m[0], gap_m_s[0]) && passes(r.train, gap_m[1], gap_m_s[1]));
    const bool seat_fails =
        seat && !(passes(r.seat, from.lift_m, from.velocity_m_s) && passes(r.seat, to.lift_m, to.velocity_m_s));
    if (!train_fails && !seat_fails) return false;
    const Real from_m_s2 = acceleration(r.acceleration, from, gap_m[0], gap_m_s[0], step.gas.between(0, 0));
    const Real to_m_s2 = acceleration(r.acceleration, to, gap_m[1], gap_m_s[1], step.gas);
    if (seat_fails && from.velocity_m_s + motion_.seat_lag_s * from_m_s2 > 0 &&
        to.velocity_m_s + motion_.seat_lag_s * to_m_s2 < 0)
      return true;
    if (!train_fails) return false;
    const Real lag_s = motion_.train_lag_s * motion_.per_fine_step_s * motion_.per_fine_step_s;
    const Real rise_m = step.to.lift_m - step.from.lift_m;
    const Real slope_m[] = {step.cam.deg * step.from.per_deg_m, step.cam.deg * step.to.per_deg_m};
    return gap_m_s[0] + lag_s * (6 * rise_m - 4 * slope_m[0] - 2 * slope_m[1]) < motion_.train_lag_s * from_m_s2 &&
           gap_m_s[1] + lag_s * (2 * slope_m[0] + 4 * slope_m[1] - 6 * rise_m) > motion_.train_lag_s * to_m_s2;
  }

  /// A fine step, checked for events: most often there is none, and then it takes so many units more.
  template <std::uint32_t kWithout>
  [[nodiscard, gnu::always_inline]] ValveInRegime<Real> finish_step(const ValveInRegime<Real>& start,
                                                                    const Stepped<Real>& end,
                                                                    const Span<Real, Gas>& step) const noexcept {
    CRANKLOOP_ASSERT(start.regime < kQuiet);
    if (is_too_far(end.state)) {
      budget_.exceeded = true;
      return put_back(motion_, step.to.lift_m);
    }
    const std::uint32_t now = required_contacts(motion_, end.state, step.to, step.cam.deg_per_s);
    const bool grazes = now == start.regime && may_graze(now, start.state, end.state, step);
    if ((now != start.regime || grazes) && budget_.spend(kUnitsOfEvent))
      return step_through_events(start, end, now, step);
    if constexpr (kWithout != 0) budget_.take(kWithout);
    if (grazes || (now != start.regime && !is_negligible(motion_, start.regime ^ now, end.state, step.to)))
      budget_.exceeded = true;
    record_step(start, end.state, step, motion_.fine_step_s);
    record_event(start.regime, now, end.state, step, 1);
    return {end.state, now};
  }

  /// A fine step from event to event, if there are any. Each is paid for before it is located, the first by the caller.
  [[nodiscard, gnu::noinline]] ValveInRegime<Real> step_through_events(const ValveInRegime<Real>& start,
                                                                       const Stepped<Real>& first_end,
                                                                       std::uint32_t now,
                                                                       const Span<Real, Gas>& step) const noexcept {
    ValveInRegime<Real> valve = start;
    Stepped<Real> end = first_end;
    Cubic<Real> lift(step.from.lift_m, step.cam.deg * step.from.per_deg_m, step.to.lift_m,
                     step.cam.deg * step.to.per_deg_m);
    SmoothSegment<Real> s = segment_of(motion_, valve, end, lift, Real{1}, step);
    Real left = 1;
    std::uint32_t last = 0;
    const auto function_of = [&](std::uint32_t contact) {
      const bool is_on = (valve.regime & contact) != 0;
      return contact == kTrainOn
                 ? event_function(train_over(motion_, s, lift, left, step), is_on, motion_.train_lag_s, s.d_s)
                 : event_function(seat_over(motion_, s), is_on, motion_.seat_lag_s, s.d_s);
    };
    if (now == valve.regime) {
      if (grazes(function_of(kTrainOn), (now & kTrainOn) != 0))
        now ^= kTrainOn;
      else if (grazes(function_of(kSeatOn), (now & kSeatOn) != 0))
        now ^= kSeatOn;
    }
    if (now != valve.regime) do {
        CRANKLOOP_ASSERT(left > 0 && left <= 1);
        if (last != 0) s = segment_of(motion_, valve, end, lift, left, step);
        const std::uint32_t changes = now ^ valve.regime;
        CRANKLOOP_ASSERT(changes != 0 && changes < kQuiet);
        std::uint32_t event = (changes & kTrainOn) != 0 ? kTrainOn : kSeatOn;
        Real x = fraction_of(function_of(event), last == event);
        if (changes == (kTrainOn | kSeatOn)) {
          if (budget_.spend(kUnitsOfSearch)) {
            const Real at = fraction_of(function_of(kSeatOn), last == kSeatOn);
            if (at < x) x = at, event = kSeatOn;
          } else {
            budget_.exceeded = true;
          }
        }
        const ValveState<Real> there = s.at(x);
        CRANKLOOP_ASSERT(event == kTrainOn || event == kSeatOn);
        CRANKLOOP_ASSERT(x >= 0 && x <= 1);
        CRANKLOOP_ASSERT(is_finite(there.lift_m) && is_finite(there.velocity_m_s));
        const Real passed = x * left;
        record_segment(valve, there, lift, 1 - left, passed, step);
        lift.shift(passed);
        left -= passed;
        record_event(valve.regime, valve.regime ^ event, there, step, 1 - left);
        valve = {there, valve.regime ^ event};
        last = event;
        end = by_series(motion_, valve.regime, valve.state, lift, left, step.gas.between(1 - left, 2 - left));
        now = required_contacts(motion_, end.state, step.to, step.cam.deg_per_s);
      } while (now != valve.regime && left > 0 && budget_.spend(kUnitsOfEvent));
    if (now != valve.regime && left > 0 && !is_negligible(motion_, valve.regime ^ now, end.state, step.to))
      budget_.exceeded = true;
    CRANKLOOP_ASSERT(left >= 0 && now < kQuiet);
    CRANKLOOP_ASSERT(is_finite(end.state.lift_m) && is_finite(end.state.velocity_m_s));
    record_segment(valve, end.state, lift, 1 - left, left, step);
    record_event(valve.regime, now, end.state, step, 1);
    return {end.state, now};
  }

  /// Where in a segment an event lies, by its event function; `again`: one of the same contact is at its start.
  [[nodiscard, gnu::noinline]] Real fraction_of(Cubic<Real> f, bool again) const noexcept {
    const Real end = f.c[0] + f.c[1] + f.c[2] + f.c[3];
    if (again || (f.c[0] > 0) != (end > 0)) return f.root(again, end);
    if (budget_.spend(kUnitsOfSearch)) return grazing_fraction(f);
    budget_.exceeded = true;
    return 1;
  }

  // ---- the record of a cycle --------------------------------------------------------------------------------------

  /// Cam degrees since the start of the lobe at a fraction of a span.
  [[nodiscard]] Real deg_at(const Span<Real, Gas>& span, Real fraction) const noexcept {
    return curve_.degrees(span.since_opening) + span.later_deg + fraction * span.cam.deg;
  }

  /// A cam's lift and its speed at one moment.
  struct Theory {
    Real lift_m, speed_m_s;
  };

  [[gnu::noinline]] void record_part(std::uint32_t regime, const ValveState<Real>& from, const ValveState<Real>& to,
                                     const Theory& theory_from, const Theory& theory_to, const Span<Real, Gas>& span,
                                     Real from_fraction, Real to_fraction, Real step_s) const noexcept {
    const ForceRow<Real>& force = motion_.fine[regime].acceleration;
    const Gas gas = span.gas.between(from_fraction, to_fraction);
    const auto accelerates = [&](const ValveState<Real>& s, const Theory& at, const Gas& by) {
      return acceleration(force, s, at.lift_m - s.lift_m, at.speed_m_s - s.velocity_m_s, by);
    };
    record_.step({from, to, theory_from.lift_m, theory_to.lift_m, theory_from.speed_m_s, theory_to.speed_m_s,
                  accelerates(from, theory_from, gas.between(0, 0)), accelerates(to, theory_to, gas), step_s,
                  contacts_of(regime)},
                 motion_.body.seat_compression_m,
                 [&](Real part) { return deg_at(span, from_fraction + part * (to_fraction - from_fraction)); });
  }

  /// From the origin of `lift`, which is at `from_fraction` of the step, over `fraction` of it.
  void record_segment(const ValveInRegime<Real>& from, const ValveState<Real>& to, const Cubic<Real>& lift,
                      Real from_fraction, Real fraction, const Span<Real, Gas>& step) const noexcept {
    if constexpr (kRecorded) {
      const auto theory = [&](Real x) {
        const typename Cubic<Real>::At at = lift.at(x);
        return Theory{at.value, at.slope * motion_.per_fine_step_s};
      };
      record_part(from.regime, from.state, to, theory(0), theory(fraction), step, from_fraction,
                  from_fraction + fraction, fraction * motion_.fine_step_s);
    }
  }

  void record_event(std::uint32_t before, std::uint32_t after, const ValveState<Real>& s, const Span<Real, Gas>& span,
                    Real fraction) const noexcept {
    if constexpr (kRecorded) {
      if (before != after) record_.event(before, after, s.velocity_m_s, deg_at(span, fraction));
    }
  }

  const ValveMotion<Real>& motion_;
  const LiftCurve<Real>& curve_;
  EventBudget& budget_;
  Record& record_;
};

}  // namespace crankloop::detail
