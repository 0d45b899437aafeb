// The plain step of each elastic valve that moves, its guards asked: most ticks of most valves are no more.
//
// What belongs here: the round over the valves, one by one and abreast, and what keeps a valve out of it. What does
// not: the step's arithmetic (valve.hpp, valves_abreast.hpp), those whose guards fail (valve_changes.hpp).
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/tick/valve/lane_blocks.hpp>
#include <crankloop/tick/valve/movers.hpp>
#include <crankloop/tick/valve/valves_at_hand.hpp>

namespace crankloop::detail {

/// Valves that are left alone once the tick is over.
template <class Bits>
struct LeavingLanes {
  Bits leaving = 0;
};

template <class Real, class S>
class ValveRound : If<ValvesAtHand<Real, S>::kMoversFirst, LeavingLanes<ValveBits<S>>> {
  using Valves = ValvesAtHand<Real, S>;
  using Gas = typename Valves::Gas;
  using Bits = typename Valves::Bits;

 public:
  using Before = BeforeStep<Real, group::ValvesState<Real, S>::kLanes>;

  explicit ValveRound(Valves& valves) noexcept : valves_{valves} {}

  /// Steps all that move. Answers which of them have guards that fail; what was before them is in `before`.
  [[nodiscard, gnu::always_inline]] Bits run(const CamTicks<Real, S>& cams, Before& before) noexcept {
    if constexpr (Valves::kAbreast) return valves_.wide ? step_wide(cams, before) : step_abreast<false>(cams, before);
    return step_those(valves_.work.moving, cams, before);
  }

  /// Valves at rest with their cams away are left alone from the next tick on: their lanes are others' then, so not
  /// before the round's last word on any.
  void leave() noexcept {
    if constexpr (Valves::kMoversFirst) {
      if (this->leaving != 0) leave_alone(valves_, this->leaving);
    }
  }

 private:
  /// Those of some valves; answers which of them have guards that fail.
  [[nodiscard]] Bits step_those(Bits which, const CamTicks<Real, S>& cams, Before& before) noexcept {
    Bits doubtful = 0;
    for (Bits left = which; left != 0; left &= left - 1) {
      const std::uint32_t v = trailing_zeros(left);
      if (!is_sure_after_step(v, cams[valves_.train(v)], before)) doubtful |= Bits{1} << v;
    }
    return doubtful;
  }

  /// False where its guards fail: then it is looked at, from what was before.
  [[nodiscard, gnu::always_inline]] bool is_sure_after_step(std::uint32_t v, const CamTick<Real>& tick,
                                                            Before& before) noexcept {
    const Cell cell = valves_.cell(v, tick.phase);
    const Gas gas = valves_.gas_on(v);
    const RegimeStep<Real>& regime = valves_.regime_of(v);
    const ValveState<Real> start = valves_.state_of(v);
    if (cell.degree >= valves_.curve(v).segments && swings_alone(v, start, regime, tick, gas))
      return swing(v, start, regime, cell, gas, before);
    const Lift<Real> from = valves_.cam(v);
    const Lift<Real> to = valves_.curve(v).read(cell);
    Stepped<Real> step = stepped(regime, start, from, to, tick.cam.deg, gas);
    if (valves_.wide) step = valves_.with_middle_of_tick(v, tick, step, to);
    ValveState<Real> end = step.state;
    Real compression_m = to.lift_m - end.lift_m;
    Real compression_speed_m_s = tick.cam.deg_per_s * to.per_deg_m - end.velocity_m_s;
    const bool sure = holds(regime.train, compression_m, compression_speed_m_s) &&
                      holds(regime.seat, end.lift_m, end.velocity_m_s) && !(valves_.far && is_far(v, tick));
    const bool still = put_to_rest(v, regime, gas, end);
    if (S::valve_forces && still) {  // as it is shown
      compression_m = to.lift_m - end.lift_m;
      compression_speed_m_s = tick.cam.deg_per_s * to.per_deg_m - end.velocity_m_s;
    }
    valves_.set_state(v, end);
    valves_.set_cam(v, to);
    if (!sure) {
      before.keep(valves_.lane_of(v), start, step.increment_m, from);
      return false;
    }
    const Real acceleration_m_s2 = acceleration(regime.acceleration, end, compression_m, compression_speed_m_s, gas);
    if constexpr (S::valve_results) {
      valves_.note(v, start, end, from, to, tick, gas, acceleration_m_s2);
      valves_.set_known(v);
    }
    if (still) may_leave(v, cell);
    valves_.show(v, end, cell, {to.lift_m, compression_m, compression_speed_m_s, acceleration_m_s2}, gas);
    return true;
  }

  /// Too far for the guards: the tick may pass over a lobe, or hold more of the lift than its ends and its middle tell.
  [[nodiscard]] bool is_far(std::uint32_t v, const CamTick<Real>& tick) const noexcept {
    const Real deg = magnitude(tick.cam.deg);
    return deg >= valves_.curve(v).skip_deg ||
           (deg > valves_.motion(v).widest_step_deg && contacts_of(valves_.state.valve_regime[v]) != kSeatOn);
  }

  /// Whether a valve swings on its seat by so little that its cam, on the base circle, cannot matter. Gas moves the
  /// place that it swings about.
  [[nodiscard]] bool swings_alone(std::uint32_t v, const ValveState<Real>& s, const RegimeStep<Real>& regime,
                                  const CamTick<Real>& tick, const Gas& gas) const noexcept {
    if (valves_.far && magnitude(tick.cam.deg) >= valves_.work.skip_deg) return false;
    const ValveMotion<Real>& m = valves_.motion(v);
    if constexpr (S::valve_gas) {
      const Real was_m = gas.rested_m(m.per_seat_N_m);
      const Real is_m = gas.resting_m(m.per_seat_N_m);
      const Real higher_m = was_m > is_m ? was_m : is_m;
      const Real drift_m_s = magnitude(is_m - was_m) * valves_.tables.drive->per_tick_s;
      const Real swing_m = magnitude(s.lift_m - was_m) + (magnitude(s.velocity_m_s) + drift_m_s) * m.per_seat_rate_s;
      return (higher_m > 0 ? higher_m : Real{0}) + swing_m < regime.calm_m;
    } else {
      return swing_m(m, s, Real{0}) < regime.calm_m;
    }
  }

  /// The plain step of such a valve: all its cam's factors are 0. False where gas presses it so far into its seat that
  /// the train may touch it: then it is looked at.
  [[nodiscard, gnu::always_inline]] bool swing(std::uint32_t v, const ValveState<Real>& start,
                                               const RegimeStep<Real>& regime, Cell cell, const Gas& gas,
                                               Before& before) noexcept {
    const Real outside_m = valves_.curve(v).outside_m;
    ValveState<Real> end{gas.resting_m(valves_.motion(v).per_seat_N_m), Real{0}};
    if (!stays_at_rest(v, start, regime, gas)) {
      const auto more = [&](const StepRow<Real>& r) {
        return gas.drive(r) + (r.lift * start.lift_m + r.velocity * start.velocity_m_s);
      };
      const Real increment_m = more(regime.lift);
      end = {start.lift_m + increment_m, start.velocity_m_s + more(regime.velocity)};
      if (S::valve_gas && !holds(regime.train, outside_m - end.lift_m, end.velocity_m_s)) {
        before.keep(valves_.lane_of(v), start, increment_m, valves_.cam(v));
        valves_.set_cam(v, {outside_m, Real{0}});
        valves_.set_state(v, end);
        return false;
      }
      if (put_to_rest(v, regime, gas, end)) may_leave(v, cell);
    }
    valves_.set_state(v, end);
    valves_.set_cam(v, {outside_m, Real{0}});
    const ForceRow<Real>& f = regime.acceleration;
    const Real acceleration_m_s2 = gas.rest(f) + f.lift * end.lift_m + f.velocity * end.velocity_m_s;
    if constexpr (S::valve_results) {
      valves_.state.record[valves_.train(v)][valves_.cylinder(v)].rest(end, acceleration_m_s2);
      valves_.set_known(v);
    }
    valves_.show(v, end, cell, {outside_m, outside_m - end.lift_m, -end.velocity_m_s, acceleration_m_s2}, gas);
    return true;
  }

  /// Whether a valve that gas holds at rest is sure to be put to rest again, where the gas holds it by the tick's end:
  /// on the way its velocity differs by at most twice that of its place, its lift by as much over the rate on the seat.
  /// Its guards hold then, but for that of the train.
  [[nodiscard, gnu::always_inline]] bool stays_at_rest([[maybe_unused]] std::uint32_t v,
                                                       [[maybe_unused]] const ValveState<Real>& s,
                                                       [[maybe_unused]] const RegimeStep<Real>& regime,
                                                       [[maybe_unused]] const Gas& gas) const noexcept {
    if constexpr (S::valve_gas) {
      const Real per_seat_N_m = valves_.motion(v).per_seat_N_m;
      const Real was_m = gas.rested_m(per_seat_N_m);
      const Real drift_m_s = magnitude(gas.resting_m(per_seat_N_m) - was_m) * valves_.tables.drive->per_tick_s;
      const Real lash_m = regime.train.sign * (valves_.curve(v).outside_m - gas.resting_m(per_seat_N_m));
      return s.velocity_m_s == 0 && s.lift_m == was_m && 4 * drift_m_s < regime.rest_m_s &&
             lash_m > regime.train.least_m + (2 * regime.rest_m + regime.train.lag_s * regime.rest_m_s);
    }
    return false;
  }

  /// A valve that has all but come to rest is put there.
  [[nodiscard, gnu::always_inline]] bool put_to_rest(std::uint32_t v, const RegimeStep<Real>& regime, const Gas& gas,
                                                     ValveState<Real>& s) const noexcept {
    const Real resting_m = gas.resting_m(valves_.motion(v).per_seat_N_m);
    if (!(magnitude(s.lift_m - resting_m) < regime.rest_m && magnitude(s.velocity_m_s) < regime.rest_m_s)) return false;
    s = {resting_m, Real{0}};
    return true;
  }

  /// One at rest: is its cam away?
  void may_leave([[maybe_unused]] std::uint32_t v, [[maybe_unused]] Cell cell) noexcept {
    if constexpr (!S::valve_gas) {
      if (valves_.curve(v).may_touch(cell) || (S::valve_forces && cell.degree < valves_.curve(v).segments)) return;
      if constexpr (Valves::kMoversFirst) {
        this->leaving |= Bits{1} << v;
      } else {
        leave_alone(valves_, Bits{1} << v);
      }
    }
  }

  /// Into a lane's record, what it did in its block.
  void note(std::uint32_t v, const CamTick<Real>& tick, const Before& before) noexcept {
    const Gas gas = valves_.gas_on(v);
    const std::uint32_t lane = valves_.lane_of(v);
    const ValveState<Real> start{before.lift_m[lane], before.velocity_m_s[lane]};
    const ValveState<Real> end = valves_.state_of(v);
    const Real acceleration_m_s2 = (&valves_.out.valve[0][0])[v].acceleration_m_s2;
    if (valves_.cell(v, tick.phase).degree >= valves_.curve(v).segments &&
        swings_alone(v, start, valves_.regime_of(v), tick, gas)) {
      valves_.state.record[valves_.train(v)][valves_.cylinder(v)].rest(end, acceleration_m_s2);
    } else {
      valves_.note(v, start, end, {before.cam_lift_m[lane], before.cam_per_deg_m[lane]}, valves_.cam(v), tick, gas,
                   acceleration_m_s2);
    }
    if constexpr (Needs<S>::valve_gas_held) valves_.state.valve_gas_N[v] = gas.to_N;
    valves_.set_known(v);
  }

  /// Plain steps in blocks of lanes; what fills no block one by one. Answers which have guards that fail.
  template <bool Wide>
  [[nodiscard, gnu::always_inline]] Bits step_abreast([[maybe_unused]] const CamTicks<Real, S>& cams,
                                                      [[maybe_unused]] Before& before) noexcept {
    Bits doubtful = 0;
#if CRANKLOOP_ABREAST
    if constexpr (Valves::kAbreast) {
      Bits far = 0;
      for (Bits left = valves_.far ? valves_.work.moving : 0; left != 0; left &= left - 1) {
        const std::uint32_t v = trailing_zeros(left);
        far |= Bits{is_far(v, cams[valves_.train(v)])} << valves_.lane_of(v);
      }
      LaneBlocks<S, Wide> blocks(valves_, cams, far, before);
      const std::uint32_t cylinders = count<S>(valves_.tables.drive->cylinders);
      const auto step_row = [&](std::uint32_t first, std::uint32_t lanes, std::uint32_t room)
          __attribute__((always_inline)) {
        const std::uint32_t done = blocks.step(first, lanes, room);
        const Bits rest = done < lanes ? ((Bits{1} << (lanes - done)) - 1) << (first + done) : 0;
        if (rest != 0) doubtful |= step_those(valves_.valves_in(rest), cams, before);
      };
      if constexpr (Valves::kMoversFirst) {
        step_row(0, valves_.work.movers, valves_.trains() * cylinders);
      } else if (cylinders == Valves::kPerTrain) {  // then the lanes of all trains are in a row
        step_row(0, valves_.trains() * cylinders, valves_.trains() * cylinders);
      } else {
        for (std::uint32_t t = 0; t < valves_.trains(); ++t) step_row(t * Valves::kPerTrain, cylinders, cylinders);
      }
      doubtful |= valves_.valves_in(blocks.doubtful());
      if constexpr (S::valve_results) {
        valves_.for_movers(blocks.enlarged() & ~(blocks.eventful() | blocks.doubtful()),
                           [&](std::uint32_t v) { valves_.keep_largest(v); });
        valves_.for_movers(blocks.eventful() & ~blocks.doubtful(),
                           [&](std::uint32_t v) { note(v, cams[valves_.train(v)], before); });
      }
      valves_.for_movers(blocks.still() & ~blocks.doubtful(),
                         [&](std::uint32_t v) { may_leave(v, valves_.cell(v, cams[valves_.train(v)].phase)); });
    }
#endif
    return doubtful;
  }

  [[nodiscard, gnu::noinline]] Bits step_wide(const CamTicks<Real, S>& cams, Before& before) noexcept {
    return step_abreast<true>(cams, before);
  }

  Valves& valves_;
};

}  // namespace crankloop::detail
