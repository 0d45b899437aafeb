// One valve over one tick: whole steps where no contact changes, fine steps where one may, the change itself located.
//
// What belongs here: the order of a valve's tick. What does not: the steps themselves (valve_steps.hpp), their physics (valve.hpp),
// which valves an engine has (valves_step.hpp).
//
//     tick  |-----------------------|-----------------------|    whole steps, one matrix and one cam look-up each (wide: two);
//                                   |-----|-----|-----|-----|    where a gap may close or a force may end: fine ones;
//                                               |--x--|          where one does: a power series up to x, the new regime from there
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/tick/io.hpp>
#include <crankloop/tick/valve_between.hpp>
#include <crankloop/tick/valve_results.hpp>
#include <crankloop/tick/valve_series.hpp>
#include <crankloop/tick/valve_steps.hpp>

namespace crankloop {

/// Contact changes that may still be located in this tick, over all valves. What exceeds it is taken at the end of its fine step.
struct EventBudget {
  std::uint32_t left;
  bool exceeded;
};

/// One tick of the valves of a train: made once per tick, used for each of them. A valve costs O(fine steps + events): bounded by the tables
/// and the budget.
template <class Real>
class ValveTick : ValveSteps<Real> {
 public:
  constexpr ValveTick(const ValveMotion<Real>& motion, const LiftCurve<Real>& curve, const CamTurn<Real>& cam, EventBudget& budget) noexcept
      : ValveSteps<Real>(motion, curve, cam), budget_{budget} {}

  /// The train cannot touch a closed valve at the end of this tick, nor could it have on the way.
  template <class Gas>
  [[nodiscard]] constexpr bool rests_at(Cell end, const Gas& gas) const noexcept {
    return !curve_.may_touch(end) && !leaps_ && gas.leaves_closed(motion_.body);
  }

  /// The commonest tick of a valve that moves: one whole step in which the train carries it from beginning to end. False, and nothing done,
  /// where that is not sure.
  template <class Gas>
  [[nodiscard]] constexpr bool carry(ValveCondition<Real>& valve, std::uint64_t to, Cell end, const Gas& gas,
                                     ValveMotionOutput<Real>& shown) const noexcept {
    if (valve.regime != kTrainOn || !one_step_) return false;
    const Lift<Real> lift = curve_.read(end);
    const LiftStep<Real> step = between(valve.train, lift, whole_.deg);
    const ValveState<Real> after = carried(valve.state, whole_, step, to - static_cast<std::uint64_t>(cam_.turned), to, gas);
    const detail::Between<Real> motion{valve.state, after, step, motion_.whole.step_s};
    if (!detail::stays_on_train(motion_, motion_.whole.force_lag, motion)) return false;
    const Real acceleration = detail::carried_acceleration(motion_, after, motion, gas.force_N());
    // Number by number: GCC copies a pair by way of the stack.
    valve.state.lift_m = shown.lift_m = after.lift_m;
    valve.state.velocity_m_s = shown.velocity_m_s = after.velocity_m_s;
    valve.train.lift_m = shown.theoretical_lift_m = lift.lift_m;  // above the valve's
    valve.train.per_deg_m = lift.per_deg_m;
    shown.acceleration_m_s2 = acceleration;
    return true;
  }

  /// A tick of one whole step of a valve that settles, and goes on settling. False, and nothing done, where it comes to rest.
  template <class Gas>
  [[nodiscard]] constexpr bool settle(ValveCondition<Real>& valve, const Gas& gas, ValveMotionOutput<Real>& shown) const noexcept {
    if (motion_.whole.parts != 1) return false;
    const ValveState<Real> after = stepped(motion_.whole.matrix[kSeatOn], valve.state, gas);
    if (at_rest(after, gas)) return false;
    const ValveBody<Real>& b = motion_.body;
    const Real force_N = (b.seat_N_m + b.spring_N_m) * after.lift_m + (b.seat_Ns_m + b.guide_Ns_m) * after.velocity_m_s + gas.force_N();
    valve.state.lift_m = shown.lift_m = after.lift_m;
    valve.state.velocity_m_s = shown.velocity_m_s = after.velocity_m_s;
    shown.acceleration_m_s2 = -force_N * b.per_mass;
    return true;
  }

  /// Any tick of any valve, to the phase `to`; keeps its record.
  template <class Gas, class Record>
  void run(ValveCondition<Real>& valve, std::uint64_t to, const Gas& gas, Record& record) const noexcept {
    Progress progress;
    while (!advance(valve, progress, to, gas, record)) change_contacts(valve, progress, to, gas, record);
  }

  /// The motion at the end of the tick.
  template <class Gas>
  constexpr void show(const ValveCondition<Real>& valve, const Gas& gas, ValveMotionOutput<Real>& shown) const noexcept {
    if (valve.sleep == kAsleep) {
      shown = {};
      return;
    }
    shown.theoretical_lift_m = valve.train.lift_m > 0 ? valve.train.lift_m : Real{0};
    shown.lift_m = valve.state.lift_m;
    shown.velocity_m_s = valve.state.velocity_m_s;
    shown.acceleration_m_s2 =
        acceleration(motion_.body, valve.regime, valve.state, valve.train.lift_m, valve.train.per_deg_m * cam_.deg_per_s, gas.force_N());
  }

 private:
  using Steps = ValveSteps<Real>;
  using typename Steps::FineStep;
  using typename Steps::Reach;
  using typename Steps::Span;
  using typename Steps::Stride;
  using typename Steps::Width;
  using Steps::at_rest;
  using Steps::between;
  using Steps::cam_;
  using Steps::carried;
  using Steps::curve_;
  using Steps::fine_step;
  using Steps::kLeastLash_m;
  using Steps::leaps_;
  using Steps::motion_;
  using Steps::one_step_;
  using Steps::quiet;
  using Steps::reach_of;
  using Steps::resting;
  using Steps::trembles;
  using Steps::whole_;

  /// How far a valve has come in its tick: whole steps, and fine ones of the next.
  struct Progress {
    std::uint32_t whole = 0;
    std::uint32_t fine = 0;
  };

  /// Goes on with a tick. True when it is done; false when a contact changes in the fine step after `progress`: that one is for
  /// change_contacts(). Calls of their own and one after the other, for the stack, and for the registers of the commonest ticks.
  template <class Gas, class Record>
  [[nodiscard, gnu::noinline]] bool advance(ValveCondition<Real>& valve, Progress& progress, std::uint64_t to, const Gas& gas, Record& record) const noexcept {
    const Cell end = LiftCurve<Real>::cell(to);
    if (valve.sleep != kAwake) {
      if (rests_at(end, gas)) {
        sleep_on(valve, end, gas);
        return true;
      }
      wake(valve, to - static_cast<std::uint64_t>(cam_.turned), gas);
    }
    for (; progress.whole < motion_.whole.parts; ++progress.whole, progress.fine = 0) {
      const Reach reach = reach_of(progress.whole, to);
      const Lift<Real> lift = curve_.read(LiftCurve<Real>::cell(reach.to));
      if (progress.fine > 0 || !sure_step(valve, whole_, reach, lift, gas, record)) {
        if (kUnrecorded<Record>) bounce(valve, progress.fine, reach, lift, gas);
        fine_steps(valve, progress.fine, reach, gas, record);
        if (progress.fine < motion_.fine.parts) return false;
      }
      valve.train = lift;
    }
    fall_asleep(valve, end, gas);
    return true;
  }

  /// The fine step after `progress`, in which a contact changes: by the series up to the change, on in the new regime, until the step's end.
  template <class Gas, class Record>
  [[gnu::noinline]] void change_contacts(ValveCondition<Real>& valve, Progress& progress, std::uint64_t to, const Gas& gas, Record& record) const noexcept {
    const FineStep s = fine_step(valve.train, progress.fine, reach_of(progress.whole, to));
    const Span& span = s.span;
    StepSeries<Real> series(motion_.body, s.wide ? LiftWithin<Real>(s.lift, s.middle) : LiftWithin<Real>(s.lift), span.s, span.per_s);
    valve.train = s.end;
    ++progress.fine;
    bool found = false;
    for (Real at = 0; at < 1;) {
      series.expand(at, valve.state, valve.regime, gas.force_N());
      std::uint32_t changed = 0;
      const Real next = budget_.left > 0 ? series.first_change(valve.regime, changed) : Real{1};
      const ValveState<Real> after = series.state(next);
      note_part(record, series, valve, after, at, next, gas, span);
      valve.state = after;
      at = next;
      if (changed == 0) {
        if (budget_.left > 0) {
          if (!found) --budget_.left;  // a search in vain takes as long as one that finds
          return;
        }
        const LiftNow<Real> end = series.lift(1);
        const std::uint32_t asked = contacts(motion_.body, after, end.lift_m, end.speed_m_s).regime();
        if (asked != valve.regime) take_unlocated(valve, asked, record, span);
        return;
      }
      found = true;
      --budget_.left;
      if constexpr (!kUnrecorded<Record>) {
        record.change(valve.regime, valve.regime ^ changed, after.velocity_m_s, curve_.degrees(span.from) + next * span.deg);
      }
      valve.regime ^= changed;
      note_part(record, series, valve, after, next, next, gas, span);  // the force of a damper begins with a jump
    }
  }

  template <class Gas>
  constexpr void sleep_on(ValveCondition<Real>& valve, Cell end, const Gas& gas) const noexcept {
    if (valve.sleep == kAsleep) return;
    for (std::uint32_t i = 0; i < motion_.whole.parts; ++i) valve.state = stepped(motion_.whole.matrix[kSeatOn], valve.state, gas);
    fall_asleep(valve, end, gas);
  }

  /// Wakes a closed valve: from sleep, where the gas holds it on its seat.
  template <class Gas>
  void wake(ValveCondition<Real>& valve, std::uint64_t from, const Gas& gas) const noexcept {
    if (valve.sleep == kAsleep) valve.state = resting(gas);
    valve.train = curve_.read(LiftCurve<Real>::cell(from));
    valve.sleep = kAwake;
  }

  /// Takes a step if no contact can change in it.
  template <class Gas, class Record>
  [[nodiscard]] bool sure_step(ValveCondition<Real>& valve, const Stride& stride, const Reach& reach, const Lift<Real>& lift, const Gas& gas,
                               Record& record) const noexcept {
    if (stride.width == Width::too_wide) return false;
    const StepLevel<Real>& level = stride.level;
    const std::uint32_t regime = valve.regime;
    const LiftStep<Real> step = between(valve.train, lift, stride.deg);
    ValveState<Real> after;
    if ((regime & kSeatOn) != 0) {
      if (!quiet(valve, lift, gas)) return false;
      after = stepped(level.matrix[kSeatOn], valve.state, gas);
    } else {
      after = regime == 0 ? stepped(level.matrix[0], valve.state, gas) : carried(valve.state, stride, step, reach.from, reach.to, gas);
      if (!detail::far_from_change(motion_, level.force_lag, regime, {valve.state, after, step, level.step_s})) return false;
    }
    note(record, valve.state, after, step, regime, gas, Span{reach.from, stride.deg, level.step_s, level.per_step_s});
    valve.state = after;
    return true;
  }

  /// Fine steps, from that after `taken`, of a valve above its train, which leaves the lash open at both ends of the whole step: only the seat
  /// can take or leave it, and no lift is read. Stops before the first that is not so simple.
  template <class Gas>
  constexpr void bounce(ValveCondition<Real>& valve, std::uint32_t& taken, const Reach& reach, const Lift<Real>& at_to, const Gas& gas) const noexcept {
    const Real highest_train_m = valve.train.lift_m > at_to.lift_m ? valve.train.lift_m : at_to.lift_m;
    if ((valve.regime & kTrainOn) != 0 || valve.state.lift_m <= highest_train_m || leaps_) return;
    if (curve_.may_touch(LiftCurve<Real>::cell(reach.from)) || curve_.may_touch(LiftCurve<Real>::cell(reach.to))) return;
    const StepMatrix<Real>& matrix = motion_.fine.matrix[valve.regime];
    const std::uint32_t before = taken;
    while (taken < motion_.fine.parts) {
      const ValveState<Real> after = stepped(matrix, valve.state, gas);
      if (after.lift_m <= highest_train_m || seat_acts(motion_.body, after) != (valve.regime == kSeatOn)) break;
      valve.state = after;
      ++taken;
    }
    if (taken != before && taken < motion_.fine.parts) valve.train = curve_.read(LiftCurve<Real>::cell(reach.from + taken * typename Steps::Parts(motion_.fine, reach).part));
  }

  /// Fine steps, from that after `taken`, as long as no contact changes; all of them once the budget is spent.
  template <class Gas, class Record>
  void fine_steps(ValveCondition<Real>& valve, std::uint32_t& taken, const Reach& reach, const Gas& gas, Record& record) const noexcept {
    for (; taken < motion_.fine.parts; ++taken) {
      const FineStep s = fine_step(valve.train, taken, reach);
      const StepMatrix<Real>& matrix = motion_.fine.matrix[valve.regime];
      const ValveState<Real> after = (valve.regime & kTrainOn) == 0 ? stepped(matrix, valve.state, gas)
                                     : s.wide                       ? stepped(matrix, valve.state, gas, s.lift, s.middle)
                                                                    : stepped(matrix, valve.state, gas, s.lift);
      const std::uint32_t asked = contacts(motion_.body, after, s.end.lift_m, s.lift.to_slope_m * s.span.per_s).regime();
      if (asked != valve.regime && budget_.left > 0) return;
      note(record, valve.state, after, s.lift, valve.regime, gas, s.span);
      valve.state = after;
      valve.train = s.end;
      if (asked != valve.regime) take_unlocated(valve, asked, record, s.span);
    }
  }

  /// A change that the budget no longer covers: at the end of its fine step, where the contacts ask for another regime.
  template <class Record>
  void take_unlocated(ValveCondition<Real>& valve, std::uint32_t asked, Record& record, const Span& span) const noexcept {
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

  /// A closed valve that the train cannot reach settles; once it has come to rest it is put exactly at rest: it costs nothing, and no
  /// denormal numbers. Where the train stands near it stays awake, at rest.
  template <class Gas>
  constexpr void fall_asleep(ValveCondition<Real>& valve, Cell end, const Gas& gas) const noexcept {
    if (valve.regime != kSeatOn) return;
    const bool still = at_rest(valve.state, gas);
    if (!rests_at(end, gas)) {
      if (still) valve.state = resting(gas);
    } else if (still) {
      valve = {};
    } else if (curve_.outside_m < -kLeastLash_m && trembles(valve.state, kLeastLash_m)) {
      valve.sleep = kSettling;
      valve.train = {};
    }
  }

  EventBudget& budget_;
};

}  // namespace crankloop
