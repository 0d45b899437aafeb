// The plain step of each elastic valve that moves, its guards asked: most ticks of most valves are no more.
//
// What belongs here: the round over the valves, one by one and abreast, and what keeps a valve out of it. What does
// not: the step's arithmetic (valve.hpp, valves_abreast.hpp), those whose guards fail (valve_changes.hpp).
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/tick/valve/lane_blocks.hpp>
#include <crankloop/tick/valve/valves_at_hand.hpp>

namespace crankloop::detail {

template <class Real, class S>
class ValveRound {
  using Valves = ValvesAtHand<Real, S>;
  using Gas = typename Valves::Gas;
  using Bits = typename Valves::Bits;

 public:
  using Before = BeforeStep<Real, group::ValvesState<Real, S>::kLanes>;

  explicit ValveRound(Valves& valves) noexcept : valves_{valves} {}

  /// Steps all that move. Answers which of them have guards that fail; what was before them is in `before`.
  [[nodiscard, gnu::always_inline]] Bits run(const CamTicks<Real, S>& cams, Before& before) noexcept {
    return Valves::kAbreast ? step_abreast(cams, before) : step_those(valves_.work.moving, cams, before);
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
    const ValveState<Real> start{valves_.state.valve_lift_m[v], valves_.state.valve_velocity_m_s[v]};
    if (cell.degree >= valves_.curve(v).segments && swings_alone(v, start, regime, tick, gas))
      return swing(v, start, regime, cell, gas, before);
    const Lift<Real> from = valves_.cam(v);
    const Lift<Real> to = valves_.curve(v).read(cell);
    const Stepped<Real> step = stepped(regime, start, from, to, tick.cam.deg, gas);
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
    valves_.state.valve_lift_m[v] = end.lift_m;
    valves_.state.valve_velocity_m_s[v] = end.velocity_m_s;
    valves_.set_cam(v, to);
    if (!sure) {
      before.keep(v, start, step.increment_m, from);
      return false;
    }
    const Real acceleration_m_s2 = acceleration(regime.acceleration, end, compression_m, compression_speed_m_s, gas);
    if constexpr (S::valve_results) {
      valves_.note(v, start, end, from, to, tick, gas, acceleration_m_s2);
      valves_.set_known(v);
    }
    if (still) leave_alone(v, cell);
    valves_.show(v, end, cell, {to.lift_m, compression_m, compression_speed_m_s, acceleration_m_s2}, gas);
    return true;
  }

  /// Too far for the guards: the tick may pass over a lobe, or hold more of the lift than a cubic.
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
        before.keep(v, start, increment_m, valves_.cam(v));
        valves_.set_cam(v, {outside_m, Real{0}});
        valves_.state.valve_lift_m[v] = end.lift_m;
        valves_.state.valve_velocity_m_s[v] = end.velocity_m_s;
        return false;
      }
      if (put_to_rest(v, regime, gas, end)) leave_alone(v, cell);
    }
    valves_.state.valve_lift_m[v] = end.lift_m;
    valves_.state.valve_velocity_m_s[v] = end.velocity_m_s;
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

  /// With its cam away a valve at rest is left alone from the next tick on.
  void leave_alone(std::uint32_t v, Cell cell) noexcept {
    if constexpr (!S::valve_gas && !Valves::kAbreast) {
      if (valves_.curve(v).may_touch(cell) || (S::valve_forces && cell.degree < valves_.curve(v).segments)) return;
      valves_.work.moving &= ~(Bits{1} << v);
      for (CamWindow& clear : valves_.work.clear) clear = {};  // found anew with the next tick
    }
    (void)v, (void)cell;
  }

  /// Into a lane's record, what it did in its block.
  void note(std::uint32_t v, const CamTick<Real>& tick, const Before& before) noexcept {
    const Gas gas = valves_.gas_on(v);
    const ValveState<Real> start{before.lift_m[v], before.velocity_m_s[v]};
    const ValveState<Real> end{valves_.state.valve_lift_m[v], valves_.state.valve_velocity_m_s[v]};
    const Real acceleration_m_s2 = (&valves_.out.valve[0][0])[v].acceleration_m_s2;
    if (valves_.cell(v, tick.phase).degree >= valves_.curve(v).segments &&
        swings_alone(v, start, valves_.regime_of(v), tick, gas)) {
      valves_.state.record[valves_.train(v)][valves_.cylinder(v)].rest(end, acceleration_m_s2);
    } else {
      valves_.note(v, start, end, {before.cam_lift_m[v], before.cam_per_deg_m[v]}, valves_.cam(v), tick, gas,
                   acceleration_m_s2);
    }
    if constexpr (Needs<S>::valve_gas_held) valves_.state.valve_gas_N[v] = gas.to_N;
    valves_.set_known(v);
  }

  /// Plain steps in blocks of lanes, each a valve by its number; what fills no block one by one. Answers which have
  /// guards that fail.
  [[nodiscard]] Bits step_abreast([[maybe_unused]] const CamTicks<Real, S>& cams,
                                  [[maybe_unused]] Before& before) noexcept {
    Bits doubtful = 0;
#if CRANKLOOP_ABREAST
    if constexpr (Valves::kAbreast) {
      Bits far = 0;
      if (valves_.far) {
        valves_.for_each([&](std::uint32_t v) { far |= Bits{is_far(v, cams[valves_.train(v)])} << v; });
      }
      LaneBlocks<S> blocks(valves_, cams, far, before);
      const bool in_a_row =
          count<S>(valves_.tables.drive->cylinders) == Valves::kPerTrain;  // then the lanes of all trains are
      const std::uint32_t row =
          in_a_row ? valves_.trains() * Valves::kPerTrain : count<S>(valves_.tables.drive->cylinders);
      for (std::uint32_t first = 0; first < valves_.trains() * Valves::kPerTrain;
           first += in_a_row ? row : Valves::kPerTrain) {
        const std::uint32_t done = blocks.step(first, row);
        const Bits rest = done < row ? ((Bits{1} << (row - done)) - 1) << (first + done) : 0;
        if (rest != 0) doubtful |= step_those(rest, cams, before);
      }
      doubtful |= blocks.doubtful();
      if constexpr (S::valve_results) {
        for (Bits left = blocks.enlarged() & ~(blocks.eventful() | doubtful); left != 0; left &= left - 1)
          valves_.keep_largest(trailing_zeros(left));
        for (Bits left = blocks.eventful() & ~doubtful; left != 0; left &= left - 1) {
          const std::uint32_t v = trailing_zeros(left);
          note(v, cams[valves_.train(v)], before);
        }
      }
    }
#endif
    return doubtful;
  }

  Valves& valves_;
};

}  // namespace crankloop::detail
