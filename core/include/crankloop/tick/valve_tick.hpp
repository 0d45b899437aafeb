// One valve over one tick: whole steps where no contact changes, fine steps where one may, the change itself located.
//
// What belongs here: the order of a valve's tick. What does not: the physics of a step (valve.hpp), which valves an engine has
// (valves_step.hpp).
//
//     tick  |-----------------|-----------------|      `steps` whole steps, one matrix and one cam look-up each (wide: two);
//                              |--|--|--|--|--|        where a gap may close or a force may end: `fine_per_step` fine ones;
//                                    |-x--|            where one does: a power series up to x, the new regime from there
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/tick/valve_between.hpp>
#include <crankloop/tick/valve_results.hpp>
#include <crankloop/tick/valve_series.hpp>
#include <crankloop/tick/valve_tables.hpp>

namespace crankloop {

/// How a train's cams move during a tick, the same for all cylinders.
template <class Real>
struct CamTurn {
  std::int64_t turned;   ///< phase units, 2^64 = 360 cam deg
  Real turned_deg;       ///< cam degrees, with sign
};

/// Contact changes that may still be located in this tick, over all valves. What exceeds it is taken at the end of its fine step.
struct EventBudget {
  std::uint32_t left;
  bool exceeded;
};

/// One of n equal parts of a phase difference; per_n_32 = 2^32 / n, rounded. By 32-bit multiplications.
[[nodiscard]] constexpr std::uint64_t part_of(std::int64_t units, std::uint32_t per_n_32) noexcept {
  const auto bits = static_cast<std::uint64_t>(units);
  const std::int64_t high = static_cast<std::int32_t>(static_cast<std::uint32_t>(bits >> 32));
  const std::uint64_t low = (bits & 0xFFFF'FFFFu) * per_n_32 >> 32;
  return static_cast<std::uint64_t>(high * static_cast<std::int64_t>(std::uint64_t{per_n_32})) + low;
}

/// One tick of the valves of a train: made once per tick, advance() for each of them. Each costs O(steps * fine_per_step + events): bounded
/// by the tables and the budget.
template <class Real>
class ValveTick {
 public:
  constexpr ValveTick(const ValveMotion<Real>& motion, const LiftCurve<Real>& curve, const CamTurn<Real>& cam, EventBudget& budget) noexcept
      : motion_{motion},
        curve_{curve},
        cam_{cam},
        step_deg_{cam.turned_deg * motion.per_steps},
        leaps_{curve.touch_degrees != 0 &&
               magnitude(cam.turned_deg) >= static_cast<Real>(static_cast<std::int32_t>(curve.touch_degrees))},
        width_{width_of(motion, step_deg_)},
        budget_{budget} {}

  /// Whether a sleeping valve sleeps on through a tick that ends here.
  template <class Gas>
  [[nodiscard]] constexpr bool sleeps_on(const ValveCondition<Real>& valve, Cell end, const Gas& gas) const noexcept {
    return valve.asleep != 0 && rests_at(end, gas);
  }

  /// Advances a valve to the phase `to`, in cell `end`, and keeps its record.
  template <class Gas, class Record>
  void advance(ValveCondition<Real>& valve, std::uint64_t to, Cell end, const Gas& gas, Record& record) const noexcept {
    const std::uint64_t from = to - static_cast<std::uint64_t>(cam_.turned);
    if (valve.asleep != 0) wake(valve, from, gas);
    std::uint64_t at = from;
    if (motion_.steps > 1) {
      const std::uint64_t step = part_of(cam_.turned, motion_.per_steps_32);
      for (std::uint32_t i = 1; i < motion_.steps; ++i, at += step) step_to(valve, at, at + step, LiftCurve<Real>::cell(at + step), gas, record);
    }
    step_to(valve, at, to, end, gas, record);
    fall_asleep(valve, end, gas);
  }

 private:
  static constexpr Real kLeastLash_m = static_cast<Real>(kLeastLash);  ///< with more of it a closed valve is left alone

  /// Where a step begins, its length in cam degrees and in seconds.
  struct Span {
    std::uint64_t from;
    Real deg;
    Real s;
    Real per_s;
  };

  enum class Width : std::uint32_t { cubic, through_middle, too_wide };
  [[nodiscard]] static constexpr Width width_of(const ValveMotion<Real>& motion, Real step_deg) noexcept {
    const Real deg = magnitude(step_deg);
    if (deg <= motion.short_step_deg) return Width::cubic;
    return deg <= motion.widest_step_deg ? Width::through_middle : Width::too_wide;
  }

  /// The train cannot touch a closed valve there, nor could it have on the way.
  template <class Gas>
  [[nodiscard]] constexpr bool rests_at(Cell end, const Gas& gas) const noexcept {
    return !curve_.may_touch(end) && !leaps_ && gas.leaves_closed(motion_.body);
  }

  /// Wakes a valve where the gas holds it on its seat.
  template <class Gas>
  constexpr void wake(ValveCondition<Real>& valve, std::uint64_t from, const Gas& gas) const noexcept {
    valve.state = {-gas.force_N() * motion_.per_seat_N_m, Real{0}};
    valve.train = curve_.read(LiftCurve<Real>::cell(from));
    valve.asleep = 0;
  }

  /// A valve that only trembles on its seat, by less than the lash that is open: its vibration dies away and reaches no contact. (On a soft
  /// seat it may swing up into it by more than the lash, and meets its train there.)
  template <class Gas>
  [[nodiscard]] constexpr bool quiet(const ValveCondition<Real>& valve, const Lift<Real>& to, const Gas& gas) const noexcept {
    const Real swing_m = magnitude(valve.state.lift_m) + magnitude(valve.state.velocity_m_s) * motion_.per_seat_rate_s;
    return valve.regime == kSeatOn && valve.train.lift_m < -kLeastLash_m && to.lift_m < -kLeastLash_m && gas.leaves_closed(motion_.body) &&
           swing_m < motion_.quiet_m && swing_m < -valve.train.lift_m && swing_m < -to.lift_m;
  }

  [[nodiscard]] constexpr LiftStep<Real> between(const Lift<Real>& from, const Lift<Real>& to, Real deg) const noexcept {
    return {from.lift_m, to.lift_m, deg * from.per_deg_m, deg * to.per_deg_m};
  }

  [[nodiscard]] constexpr LiftMiddle<Real> middle(std::uint64_t from, std::uint64_t to, Real deg) const noexcept {
    const std::uint64_t half = static_cast<std::uint64_t>(static_cast<std::int64_t>(to - from) / 2);
    const Lift<Real> lift = curve_.read(LiftCurve<Real>::cell(from + half));
    return {lift.lift_m, deg * lift.per_deg_m};
  }

  template <class Gas, class Record>
  void step_to(ValveCondition<Real>& valve, std::uint64_t from, std::uint64_t to, Cell end, const Gas& gas, Record& record) const noexcept {
    const Lift<Real> lift = curve_.read(end);
    if (!whole_step(valve, from, to, lift, gas, record)) fine_steps(valve, from, to, gas, record);
    valve.train = lift;
  }

  /// Takes a whole step if no contact can change in it.
  template <class Gas, class Record>
  constexpr bool whole_step(ValveCondition<Real>& valve, std::uint64_t from, std::uint64_t to, const Lift<Real>& lift, const Gas& gas,
                            Record& record) const noexcept {
    if (width_ == Width::too_wide) return false;
    const std::uint32_t regime = valve.regime;
    const StepMatrix<Real>& matrix = motion_.whole[regime];
    const LiftStep<Real> step = between(valve.train, lift, step_deg_);
    ValveState<Real> after;
    if ((regime & kSeatOn) != 0) {
      if (!quiet(valve, lift, gas)) return false;
      after = stepped(matrix, valve.state, gas);
    } else {
      if ((regime & kTrainOn) == 0) {
        after = stepped(matrix, valve.state, gas);
      } else if (width_ == Width::cubic) {
        after = stepped(matrix, valve.state, gas, step);
      } else {
        after = stepped(matrix, valve.state, gas, step, middle(from, to, step_deg_));
      }
      if (!detail::far_from_change(motion_, regime, {valve.state, after, step, motion_.step_s})) return false;
    }
    note(record, valve.state, after, step, regime, gas, Span{from, step_deg_, motion_.step_s, motion_.per_step_s});
    valve.state = after;
    return true;
  }

  /// Where a contact may change. A call of its own, so that its registers and its stack are not the whole steps'.
  template <class Gas, class Record>
  [[gnu::noinline]] void fine_steps(ValveCondition<Real>& valve, std::uint64_t from, std::uint64_t to, const Gas& gas,
                                    Record& record) const noexcept {
    const std::uint32_t count = motion_.fine_per_step;
    const std::uint64_t part = count == 1 ? 0 : part_of(static_cast<std::int64_t>(to - from), motion_.per_fine_32);
    const Real fine_deg = step_deg_ * motion_.per_fine;
    const bool wide = magnitude(fine_deg) > motion_.short_step_deg;
    std::uint64_t at = from;
    for (std::uint32_t i = 1; i <= count; ++i) {
      const std::uint64_t next = i == count ? to : at + part;
      const Lift<Real> lift = curve_.read(LiftCurve<Real>::cell(next));
      const LiftStep<Real> step = between(valve.train, lift, fine_deg);
      const LiftMiddle<Real> mid = wide ? middle(at, next, fine_deg) : LiftMiddle<Real>{};
      const StepMatrix<Real>& matrix = motion_.fine[valve.regime];
      const ValveState<Real> after = (valve.regime & kTrainOn) == 0 ? stepped(matrix, valve.state, gas)
                                     : wide                         ? stepped(matrix, valve.state, gas, step, mid)
                                                                    : stepped(matrix, valve.state, gas, step);
      const std::uint32_t asked = contacts(motion_.body, after, lift.lift_m, step.to_slope_m * motion_.per_fine_s).regime();
      const Span span{at, fine_deg, motion_.fine_s, motion_.per_fine_s};
      if (asked == valve.regime) {
        note(record, valve.state, after, step, valve.regime, gas, span);
        valve.state = after;
      } else if (budget_.left == 0) {
        budget_.exceeded = true;
        note(record, valve.state, after, step, valve.regime, gas, span);
        if constexpr (!kUnrecorded<Record>) record.change(valve.regime, asked, after.velocity_m_s, curve_.degrees(at) + fine_deg);
        valve.state = after;
        valve.regime = asked;
      } else {
        change_contacts(valve, wide ? LiftWithin<Real>(step, mid) : LiftWithin<Real>(step), gas, record, span);
      }
      valve.train = lift;
      at = next;
    }
  }

  /// The step in which a contact changes: by the series up to the change, on in the new regime, until the step's end.
  template <class Gas, class Record>
  void change_contacts(ValveCondition<Real>& valve, const LiftWithin<Real>& lift, const Gas& gas, Record& record,
                                         const Span& span) const noexcept {
    StepSeries<Real> series(motion_.body, lift, motion_.fine_s);
    for (Real at = 0; at < 1;) {
      series.expand(at, valve.state, valve.regime, gas.force_N());
      std::uint32_t changed = 0;
      const Real next = budget_.left > 0 ? series.first_change(valve.regime, changed) : Real{1};
      const ValveState<Real> after = series.state(next);
      note_part(record, series, valve, after, at, next, gas, span);
      valve.state = after;
      at = next;
      if (changed == 0) {
        if (budget_.left == 0) take_unlocated(valve, series, record, span);
        return;
      }
      --budget_.left;
      if constexpr (!kUnrecorded<Record>) {
        record.change(valve.regime, valve.regime ^ changed, after.velocity_m_s, curve_.degrees(span.from) + next * span.deg);
      }
      valve.regime ^= changed;
      note_part(record, series, valve, after, next, next, gas, span);  // the force of a damper begins with a jump
    }
  }

  /// At the end of a step whose changes the budget no longer covered: the regime that the contacts ask for there.
  template <class Record>
  void take_unlocated(ValveCondition<Real>& valve, const StepSeries<Real>& series, Record& record, const Span& span) const noexcept {
    const LiftNow<Real> lift = series.lift(1);
    const std::uint32_t asked = contacts(motion_.body, valve.state, lift.lift_m, lift.speed_m_s).regime();
    if (asked == valve.regime) return;
    budget_.exceeded = true;
    if constexpr (!kUnrecorded<Record>) record.change(valve.regime, asked, valve.state.velocity_m_s, curve_.degrees(span.from) + span.deg);
    valve.regime = asked;
  }

  template <class Record>
  static constexpr bool kUnrecorded = std::is_same_v<Record, NoRecord<Real>>;

  template <class Gas, class Record>
  constexpr void note(Record& record, ValveState<Real> before, ValveState<Real> after, const LiftStep<Real>& step, std::uint32_t regime,
                      const Gas& gas, const Span& span) const noexcept {
    if constexpr (!kUnrecorded<Record>) {
      const Real from_deg = curve_.degrees(span.from);
      const Real speed = step.to_slope_m * span.per_s;
      record.step({before, after, step.from_m, step.to_m, step.from_slope_m * span.per_s, speed,
                   acceleration(motion_.body, regime, after, step.to_m, speed, gas.force_N()), from_deg, from_deg + span.deg, span.s, regime},
                  motion_.body.seat_sink_m);
    }
  }

  template <class Gas, class Record>
  constexpr void note_part(Record& record, const StepSeries<Real>& series, const ValveCondition<Real>& valve, ValveState<Real> after, Real at,
                           Real next, const Gas& gas, const Span& span) const noexcept {
    if constexpr (!kUnrecorded<Record>) {
      const LiftNow<Real> begin = series.lift(at);
      const LiftNow<Real> end = series.lift(next);
      const Real from_deg = curve_.degrees(span.from);
      record.step({valve.state, after, begin.lift_m, end.lift_m, begin.speed_m_s, end.speed_m_s,
                   acceleration(motion_.body, valve.regime, after, end.lift_m, end.speed_m_s, gas.force_N()), from_deg + at * span.deg,
                   from_deg + next * span.deg, (next - at) * span.s, valve.regime},
                  motion_.body.seat_sink_m);
    }
  }

  /// A closed valve that has come to rest is put exactly at rest: it costs nothing, and no denormal numbers.
  template <class Gas>
  constexpr void fall_asleep(ValveCondition<Real>& valve, Cell end, const Gas& gas) const noexcept {
    if (valve.regime != kSeatOn || !rests_at(end, gas)) return;
    const Real off_m = valve.state.lift_m + gas.force_N() * motion_.per_seat_N_m;
    const Real speed_m_s = valve.state.velocity_m_s;
    if (magnitude(off_m) >= motion_.rest_m || magnitude(speed_m_s) >= motion_.rest_m_s) return;
    valve.state = {Real{0}, Real{0}};
    valve.train = {};
    valve.asleep = 1;
  }

  const ValveMotion<Real>& motion_;
  const LiftCurve<Real>& curve_;
  CamTurn<Real> cam_;
  Real step_deg_;
  bool leaps_;
  Width width_;
  EventBudget& budget_;
};

}  // namespace crankloop
