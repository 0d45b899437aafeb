// The plain step of each active valve, with its guards: in most ticks a valve does no more.
//
// What belongs here: the loop over the valves, in lanes and one by one, and what deactivates a valve. What does not:
// the step's arithmetic (valve.hpp, lane_blocks.hpp), what follows where guards fail (event_location.hpp).
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/tick/valve/lane_blocks.hpp>
#include <crankloop/tick/valve/valve_access.hpp>

namespace crankloop::detail {

template <class Real, class S>
class PlainSteps {
  using Valves = ValveAccess<Real, S>;
  using Gas = typename Valves::Gas;
  using Bits = typename Valves::Bits;

 public:
  using Before = BeforeStep<Real, group::ValvesState<Real, S>::kLanes>;

  explicit PlainSteps(Valves& valves) noexcept : valves_{valves} {}

  /// Steps all active valves. Returns those whose guards fail; `before` has where their steps started.
  [[nodiscard, gnu::always_inline]] Bits run(const CamTicks<Real, S>& cams, Before& before) noexcept {
    if (valves_.wide) {
      const AfterSteps wide = step_wide(valves_.apart(), cams.apart(), before);
      resting_ = wide.resting;
      return wide.failed;
    }
    return step_all<false>(cams, before);
  }

  /// Deactivates valves at rest whose cams are away. At the end of the tick: it hands their lanes to others.
  void deactivate_resting() noexcept {
    if constexpr (Needs<S>::valves_rest) {
      if (resting_ != 0) deactivate_apart(valves_.apart(), resting_ & ~valves_.work.near);
    }
  }

 private:
  using Apart = typename Valves::Apart;
  struct AfterSteps {
    Bits failed, resting;
  };

  [[gnu::noinline]] static void deactivate_apart(Apart valves, Bits which) noexcept { deactivate(valves, which); }

  template <bool Wide>
  [[nodiscard, gnu::always_inline]] Bits step_all(const CamTicks<Real, S>& cams, Before& before) noexcept {
    if constexpr (Valves::kInLanes) return step_in_lanes<Wide>(cams, before);
    return step_scalar<Wide>(valves_.work.active, cams, before);
  }
  [[nodiscard, gnu::noinline]] static AfterSteps step_wide(Apart valves, typename CamTicks<Real, S>::Apart cams,
                                                           Before& before) noexcept {
    PlainSteps steps(valves);
    const Bits failed = steps.template step_all<true>(cams, before);
    return {failed, steps.resting_};
  }

  /// Steps some valves one by one. Returns those whose guards fail.
  template <bool Wide>
  [[nodiscard, gnu::always_inline]] Bits step_scalar(Bits which, const CamTicks<Real, S>& cams,
                                                     Before& before) noexcept {
    Bits failed = 0;
    for (Bits left = which; left != 0; left &= left - 1) {
      const std::uint32_t v = trailing_zeros(left);
      const CamTick<Real>* tick = &cams[valves_.train(v)];
      if constexpr (S::cam_phasing) tick = address(tick);
      if (!step_and_check<Wide>(v, *tick, before)) failed |= Bits{1} << v;
    }
    return failed;
  }

  /// False where a guard fails: event location then starts again from `before`.
  template <bool Wide>
  [[nodiscard, gnu::always_inline]] bool step_and_check(std::uint32_t v, const CamTick<Real>& tick,
                                                        Before& before) noexcept {
    const Cell cell = valves_.cell(v, tick.phase);
    const Gas gas = valves_.gas_on(v);
    const RegimeStep<Real>& regime = valves_.regime_of(v);
    const ValveState<Real> start = valves_.state_of(v);
    if (cell.degree >= valves_.curve(v).segments && is_decoupled<Wide>(v, start, regime, tick, gas))
      return step_seated(v, start, regime, cell, gas, before);
    const Lift<Real> from = valves_.cam(v);
    const Lift<Real> to = valves_.curve(v).read(cell);
    Stepped<Real> step = stepped(regime, start, from, to, tick.cam.deg, gas);
    if constexpr (Wide) step = valves_.with_middle_of_tick(v, tick, step, to);
    ValveState<Real> end = step.state;
    Real compression_m = to.lift_m - end.lift_m;
    Real compression_speed_m_s = tick.cam.deg_per_s * to.per_deg_m - end.velocity_m_s;
    const bool pass = passes(regime.train, compression_m, compression_speed_m_s) &&
                      passes(regime.seat, end.lift_m, end.velocity_m_s) &&
                      !(Wide && valves_.beyond_guards && is_beyond_guards(v, tick));
    const bool at_rest = snap_to_rest(v, regime, gas, end);
    if (S::valve_forces && at_rest) {  // as the output has it
      compression_m = to.lift_m - end.lift_m;
      compression_speed_m_s = tick.cam.deg_per_s * to.per_deg_m - end.velocity_m_s;
    }
    valves_.set_state(v, end);
    valves_.set_cam(v, to);
    if (!pass) {
      before.keep(valves_.lane_of(v), start, step.increment_m, from);
      return false;
    }
    const Real acceleration_m_s2 = acceleration(regime.acceleration, end, compression_m, compression_speed_m_s, gas);
    if constexpr (S::valve_results) {
      valves_.record(v, start, end, from, to, tick, gas, acceleration_m_s2);
      valves_.load_record(v);
    }
    if (at_rest) resting_ |= Bits{1} << v;
    valves_.write_output(v, end, cell, {to.lift_m, compression_m, compression_speed_m_s, acceleration_m_s2}, gas);
    return true;
  }

  /// Whether the tick is beyond the guards' range: the cam may pass over a lobe, or turn further than the lift at the
  /// tick's ends and in its middle can follow.
  [[nodiscard]] bool is_beyond_guards(std::uint32_t v, const CamTick<Real>& tick) const noexcept {
    const Real deg = magnitude(tick.cam.deg);
    return deg >= valves_.curve(v).skip_deg ||
           (deg > valves_.motion(v).widest_step_deg && contacts_of(valves_.state.valve_regime[v]) != kSeatOn);
  }

  /// Whether a valve oscillates on its seat by so little that its cam, on the base circle, cannot matter. Gas moves the
  /// place about which it oscillates.
  template <bool Wide>
  [[nodiscard]] bool is_decoupled(std::uint32_t v, const ValveState<Real>& s, const RegimeStep<Real>& regime,
                                  const CamTick<Real>& tick, const Gas& gas) const noexcept {
    if (Wide && valves_.beyond_guards && magnitude(tick.cam.deg) >= valves_.work.skip_deg) return false;
    const ValveMotion<Real>& m = valves_.motion(v);
    if constexpr (Needs<S>::valve_push) {
      const Real was_m = gas.rested_m(m.per_seat_N_m);
      const Real is_m = gas.resting_m(m.per_seat_N_m);
      const Real higher_m = was_m > is_m ? was_m : is_m;
      const Real drift_m_s = magnitude(is_m - was_m) * valves_.tables.drive->per_tick_s;
      const Real amplitude_m =
          magnitude(s.lift_m - was_m) + (magnitude(s.velocity_m_s) + drift_m_s) * m.per_seat_rate_s;
      return (higher_m > 0 ? higher_m : Real{0}) + amplitude_m < regime.decoupled_m;
    } else {
      return seated_amplitude_m(m, s, Real{0}) < regime.decoupled_m;
    }
  }

  /// The plain step of a decoupled valve: all its cam's factors are 0. False where gas presses it so far into its seat
  /// that the train may touch it.
  [[nodiscard, gnu::always_inline]] bool step_seated(std::uint32_t v, const ValveState<Real>& start,
                                                     const RegimeStep<Real>& regime, const Cell& cell, const Gas& gas,
                                                     Before& before) noexcept {
    const Real outside_m = valves_.curve(v).outside_m;
    ValveState<Real> end{gas.resting_m(valves_.motion(v).per_seat_N_m), Real{0}};
    if (!stays_at_rest(v, start, regime, gas)) {
      const auto more = [&](const StepRow<Real>& r) {
        return gas.drive(r) + (r.lift * start.lift_m + r.velocity * start.velocity_m_s);
      };
      const Real increment_m = more(regime.lift);
      end = {start.lift_m + increment_m, start.velocity_m_s + more(regime.velocity)};
      if (Needs<S>::valve_push && !passes(regime.train, outside_m - end.lift_m, end.velocity_m_s)) {
        before.keep(valves_.lane_of(v), start, increment_m, valves_.cam(v));
        valves_.set_cam(v, {outside_m, Real{0}});
        valves_.set_state(v, end);
        return false;
      }
      if (snap_to_rest(v, regime, gas, end)) resting_ |= Bits{1} << v;
    }
    valves_.set_state(v, end);
    valves_.set_cam(v, {outside_m, Real{0}});
    const ForceRow<Real>& f = regime.acceleration;
    const Real acceleration_m_s2 = gas.rest(f) + f.lift * end.lift_m + f.velocity * end.velocity_m_s;
    if constexpr (S::valve_results) {
      valves_.state.record[valves_.train(v)][valves_.cylinder(v)].rest(end, acceleration_m_s2);
      valves_.load_record(v);
    }
    CRANKLOOP_ASSERT(contacts_of(valves_.state.valve_regime[v]) == kSeatOn);
    valves_.template write_output<true>(v, end, cell,
                                        {outside_m, outside_m - end.lift_m, -end.velocity_m_s, acceleration_m_s2}, gas);
    return true;
  }

  /// Whether a valve that gas holds at rest will certainly snap to rest again where the gas holds it at the tick's end:
  /// its velocity differs by at most twice that of the resting place, its lift by as much over the rate on the seat.
  /// Then its guards pass, except that of the train, which is tested here.
  [[nodiscard, gnu::always_inline]] bool stays_at_rest([[maybe_unused]] std::uint32_t v,
                                                       [[maybe_unused]] const ValveState<Real>& s,
                                                       [[maybe_unused]] const RegimeStep<Real>& regime,
                                                       [[maybe_unused]] const Gas& gas) const noexcept {
    if constexpr (Needs<S>::valve_push) {
      const Real per_seat_N_m = valves_.motion(v).per_seat_N_m;
      const Real was_m = gas.rested_m(per_seat_N_m);
      const Real drift_m_s = magnitude(gas.resting_m(per_seat_N_m) - was_m) * valves_.tables.drive->per_tick_s;
      const Real lash_m = regime.train.sign * (valves_.curve(v).outside_m - gas.resting_m(per_seat_N_m));
      return s.velocity_m_s == 0 && s.lift_m == was_m && 4 * drift_m_s < regime.rest_m_s &&
             lash_m > regime.train.least_m + (2 * regime.rest_m + regime.train.lag_s * regime.rest_m_s);
    }
    return false;
  }

  /// Puts a valve that has all but come to rest there.
  [[nodiscard, gnu::always_inline]] bool snap_to_rest(std::uint32_t v, const RegimeStep<Real>& regime, const Gas& gas,
                                                      ValveState<Real>& s) const noexcept {
    const Real resting_m = gas.resting_m(valves_.motion(v).per_seat_N_m);
    if (!(magnitude(s.lift_m - resting_m) < regime.rest_m && magnitude(s.velocity_m_s) < regime.rest_m_s)) return false;
    s = {resting_m, Real{0}};
    return true;
  }

  /// Records what a lane's valve did in its block.
  void record(std::uint32_t v, const CamTick<Real>& tick, const Before& before) noexcept {
    const Gas gas = valves_.gas_on(v);
    const std::uint32_t lane = valves_.lane_of(v);
    const ValveState<Real> start = before.state(lane);
    const ValveState<Real> end = valves_.state_of(v);
    const Lift<Real> to = valves_.cam(v);
    const Real acceleration_m_s2 = acceleration(valves_.regime_of(v).acceleration, end, to.lift_m - end.lift_m,
                                                tick.cam.deg_per_s * to.per_deg_m - end.velocity_m_s, gas);
    if (valves_.cell(v, tick.phase).degree >= valves_.curve(v).segments &&
        is_decoupled<true>(v, start, valves_.regime_of(v), tick, gas)) {
      valves_.state.record[valves_.train(v)][valves_.cylinder(v)].rest(end, acceleration_m_s2);
    } else {
      valves_.record(v, start, end, before.cam(lane), to, tick, gas, acceleration_m_s2);
    }
    if constexpr (Valves::kKeepsGas) valves_.state.valve_gas_N[v] = gas.to_N;
    valves_.load_record(v);
  }

  /// Plain steps in blocks of lanes, and one by one for those that fill no block. Returns those whose guards fail.
  template <bool Wide>
  [[nodiscard, gnu::always_inline]] Bits step_in_lanes([[maybe_unused]] const CamTicks<Real, S>& cams,
                                                       [[maybe_unused]] Before& before) noexcept {
    Bits failed = 0;
#if CRANKLOOP_ABREAST
    if constexpr (Valves::kInLanes) {
      Bits beyond_guards = 0;
      for (Bits left = valves_.beyond_guards ? valves_.work.active : 0; left != 0; left &= left - 1) {
        const std::uint32_t v = trailing_zeros(left);
        beyond_guards |= Bits{is_beyond_guards(v, cams[valves_.train(v)])} << valves_.lane_of(v);
      }
      LaneBlocks<S, Wide> blocks(valves_, cams, beyond_guards, before);
      const std::uint32_t cylinders = count<S>(valves_.tables.drive->cylinders);
      const auto step_row = [&](std::uint32_t first, std::uint32_t lanes, std::uint32_t room)
          __attribute__((always_inline)) {
        const std::uint32_t done = blocks.step(first, lanes, room);
        const Bits rest = done < lanes ? ((Bits{1} << (lanes - done)) - 1) << (first + done) : 0;
        if (rest != 0) failed |= step_scalar<Wide>(valves_.valves_in(rest), cams, before);
      };
      if constexpr (Valves::kActiveFirst) {
        step_row(0, valves_.work.active_lanes, valves_.trains() * cylinders);
      } else if (cylinders == Valves::kPerTrain) {  // then the lanes of all trains are in a row
        step_row(0, valves_.trains() * cylinders, valves_.trains() * cylinders);
      } else {
        for (std::uint32_t t = 0; t < valves_.trains(); ++t) step_row(t * Valves::kPerTrain, cylinders, cylinders);
      }
      failed |= valves_.valves_in(blocks.failed());
      if constexpr (S::valve_results) {
        valves_.for_active(blocks.raised() & ~(blocks.to_record() | blocks.failed()),
                           [&](std::uint32_t v) { valves_.store_maxima(v); });
        valves_.for_active(blocks.to_record() & ~blocks.failed(),
                           [&](std::uint32_t v) { record(v, cams[valves_.train(v)], before); });
      }
      valves_.for_active(blocks.at_rest() & ~blocks.failed(), [&](std::uint32_t v) { resting_ |= Bits{1} << v; });
    }
#endif
    return failed;
  }

  Valves& valves_;
  Bits resting_ = 0;  ///< valves that the tick has left at rest
};

}  // namespace crankloop::detail
