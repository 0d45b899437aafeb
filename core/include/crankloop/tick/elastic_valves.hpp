// The elastic valves of an engine over one tick.
//
// What belongs here: which valves move, the round over them, who may spend the budget. What does not: one valve's step
// (valve.hpp), a step in which contacts change (valve_changes.hpp), the same abreast (valves_abreast.hpp).
//
//     wake those whose cams come near -> plain step of each that moves, its guards asked -> a look at those whose guards fail, by turns
//
// A valve that moves takes one step in its contact regime, whatever that is: its record of constants has the
// difference. Where the guards say that no contact can have changed meanwhile, that is its tick. One at rest whose cam
// is away is not visited at all.
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/tick/cam_ticks.hpp>
#include <crankloop/tick/io.hpp>
#include <crankloop/tick/tables.hpp>
#include <crankloop/tick/valve_changes.hpp>
#include <crankloop/tick/valve_outputs.hpp>
#include <crankloop/tick/valves_abreast.hpp>

namespace crankloop::detail {

/// From tick to tick the damper's force may change by as much of the cam's speed as this without a look at the
/// contacts.
inline constexpr double kSpeedJump = 0.02;

template <class Real, class S>
class ElasticValves {
  using Gas = std::conditional_t<S::valve_gas, GasForce<Real>, NoGasForce<Real>>;
  using Record = std::conditional_t<S::valve_results, ValveRecord<Real>, NoRecord<Real>>;
  using Before = BeforeStep<Real, ValvesState<Real, S>::kLanes>;
  using Bits = ValveBits<S>;
  static constexpr bool kAbreast = CRANKLOOP_ABREAST != 0 && kMayGoAbreast<Real, S>;
  static constexpr std::uint32_t kPerTrain = S::cylinders.capacity;
  static constexpr std::uint32_t kMostValves = S::trains.capacity * kPerTrain;

 public:
  /// Pressures are those of each cylinder, where the scene has valve_gas; none at the start.
  ElasticValves(const Tables<Real, S>& tables, State<Real, S>& state, ValvesWork<Real, S>& work, Output<Real, S>& out,
                const Real* pressure_Pa = nullptr) noexcept
      : tables_{tables}, state_{state}, work_{work}, out_{out}, pressure_Pa_{pressure_Pa} {}

  /// Puts every valve where its cam stands, at rest. The gas comes with the first tick.
  void start() noexcept {
    find_cams();
    for_each([&](std::uint32_t v) {
      const std::uint64_t since_opening = cam_phase(state_, train(v)) - curve(v).opens[cylinder(v)];
      const Placed<Real> placed =
          in_equilibrium(motion(v), curve(v).read(curve(v).cell(since_opening)).lift_m, gas_now_N(v));
      state_.valve_lift_m[v] = placed.state.lift_m;
      state_.valve_velocity_m_s[v] = placed.state.velocity_m_s;
      set_regime(v, placed.regime);
      if constexpr (S::valve_gas) state_.valve_gas_N[v] = gas_now_N(v);
    });
    remember();
  }

  /// Works out anew what a tick remembers beside the state.
  void remember() noexcept {
    find_cams();
    work_.moving = 0;
    work_.leap_deg = work_.far_deg = Real{kDegreesPerTurn + 1};
    for_each([&](std::uint32_t v) {
      set_cam(v, curve(v).read(curve(v).cell(cam_phase(state_, train(v)) - curve(v).opens[cylinder(v)])));
      work_.moving |= Bits{1} << v;
      set_regime(v, state_.valve_regime[v]);
      if (curve(v).leap_deg < work_.leap_deg) work_.leap_deg = curve(v).leap_deg;
      if (motion(v).widest_step_deg < work_.far_deg) work_.far_deg = motion(v).widest_step_deg;
    });
    if (work_.leap_deg < work_.far_deg) work_.far_deg = work_.leap_deg;
    for (std::uint32_t g = 0; g < kCamGroups<S>; ++g) work_.clear[g] = work_.no_end[g] = {};
  }

  /// Answers fault bits.
  [[nodiscard]] std::uint32_t run(const CamTicks<Real, S>& cams, bool jumped) noexcept {
    if (jumped) start();
    for (std::uint32_t g = 0; g < cam_groups(); ++g) begin(cams, g);
    Before before;
    const Bits doubtful = kAbreast ? step_abreast(cams, before) : step_those(work_.moving, cams, before);
    ChangeBudget budget{tables_.valve_motions[0].most_changes, false};
    if (doubtful != 0) look_by_turns(doubtful, cams, before, budget);
    if constexpr (S::valve_results) {
      for (std::uint32_t g = 0; g < cam_groups(); ++g) end_cycles(cams, g);
    }
    return budget.exceeded ? std::uint32_t{kFaultEventBudget} : 0;
  }

 private:
  [[nodiscard]] static constexpr std::uint32_t train(std::uint32_t v) noexcept { return v / kPerTrain; }
  [[nodiscard]] static constexpr std::uint32_t cylinder(std::uint32_t v) noexcept { return v % kPerTrain; }
  [[nodiscard]] const ValveMotion<Real>& motion(std::uint32_t v) const noexcept {
    return tables_.valve_motions[train(v)];
  }
  [[nodiscard]] const LiftCurve<Real>& curve(std::uint32_t v) const noexcept {
    if constexpr (kMayGoAbreast<Real, S>)
      return tables_.lift_curves[train(v)];
    else
      return *work_.valve[v].curve;
  }
  /// Where a valve's cam stands.
  [[nodiscard]] Cell cell(std::uint32_t v, std::uint64_t phase) const noexcept {
    if constexpr (kMayGoAbreast<Real, S> || sizeof(Real) != 4) {
      return curve(v).cell(phase, cylinder(v));
    } else {
      return LiftCurve<Real>::cell(units_from<Real>(phase, std::uint64_t{work_.valve[v].opens} << 32));
    }
  }
  [[nodiscard]] std::uint32_t trains() const noexcept {
    return S::trains.exact ? S::trains.capacity : tables_.drive->trains;
  }
  [[nodiscard]] std::uint32_t cam_groups() const noexcept { return S::cam_phasing ? trains() : 1; }

  /// Valves of all trains.
  template <class Call>
  void for_each(const Call& call) const noexcept {
    for (std::uint32_t t = 0; t < trains(); ++t) {
      for (std::uint32_t k = 0; k < count<S>(tables_.drive->cylinders); ++k) call(t * kPerTrain + k);
    }
  }
  /// Those whose cams turn alike.
  template <class Call>
  void for_each_of(std::uint32_t group, const Call& call) const noexcept {
    for_each([&](std::uint32_t v) {
      if (!S::cam_phasing || train(v) == group) call(v);
    });
  }

  [[nodiscard]] Lift<Real> cam(std::uint32_t v) const noexcept {
    if constexpr (kMayGoAbreast<Real, S>) {
      return {work_.cam_lift_m[v], work_.cam_per_deg_m[v]};
    } else {
      return {work_.valve[v].cam_lift_m, work_.valve[v].cam_per_deg_m};
    }
  }
  void set_cam(std::uint32_t v, const Lift<Real>& lift) noexcept {
    if constexpr (kMayGoAbreast<Real, S>) {
      work_.cam_lift_m[v] = lift.lift_m, work_.cam_per_deg_m[v] = lift.per_deg_m;
    } else {
      work_.valve[v].cam_lift_m = lift.lift_m, work_.valve[v].cam_per_deg_m = lift.per_deg_m;
    }
  }
  void set_regime(std::uint32_t v, std::uint32_t regime) noexcept {
    state_.valve_regime[v] = regime;
    if constexpr (!kMayGoAbreast<Real, S>) work_.valve[v].regime = &motion(v).whole[regime];
#if CRANKLOOP_ABREAST
    if constexpr (kAbreast) set_lane(work_, v, motion(v).whole[regime]);
#endif
  }
  [[nodiscard]] const RegimeStep<Real>& regime_of(std::uint32_t v) const noexcept {
    if constexpr (kMayGoAbreast<Real, S>)
      return motion(v).whole[state_.valve_regime[v]];
    else
      return *work_.valve[v].regime;
  }

  [[nodiscard]] Real gas_now_N(std::uint32_t v) const noexcept {
    if constexpr (S::valve_gas) {
      if (pressure_Pa_ != nullptr)
        return (pressure_Pa_[cylinder(v)] - tables_.body->crankcase_Pa) * motion(v).body.head_area_m2;
    }
    (void)v;
    return Real{0};
  }
  [[nodiscard]] Gas gas_on(std::uint32_t v) const noexcept {
    if constexpr (S::valve_gas) return {state_.valve_gas_N[v], gas_now_N(v)};
    (void)v;
    return {};
  }

  /// Where each valve's cam is in the tables.
  void find_cams() noexcept {
    for_each([&](std::uint32_t v) {
      const LiftCurve<Real>& curve = tables_.lift_curves[train(v)];
      const auto opens = static_cast<std::uint32_t>(curve.opens[cylinder(v)] >> 32);
      if constexpr (!kMayGoAbreast<Real, S>) work_.valve[v].curve = &curve, work_.valve[v].opens = opens;
#if CRANKLOOP_ABREAST
      if constexpr (kAbreast) set_cam_of_lane(work_, v, curve, opens);
#endif
      (void)opens;
    });
  }

  // ---- before the steps -------------------------------------------------------------------------------------------

  void begin(const CamTicks<Real, S>& cams, std::uint32_t group) noexcept {
    const CamTick<Real>& tick = cams[group];
    far_ = far_ || magnitude(tick.cam.deg) >= work_.far_deg;
    if (magnitude(tick.cam.deg) >= work_.leap_deg || !work_.clear[group].holds(angle_of_cams(tick))) wake(tick, group);
    Real& before_deg = state_.cam_turned_deg[group];
    if (tick.cam.deg == before_deg) return;
    const bool jumps = magnitude(tick.cam.deg - before_deg) > static_cast<Real>(kSpeedJump) * magnitude(tick.cam.deg);
    before_deg = tick.cam.deg;
    if (jumps) ask_all(tick, group);
  }

  [[nodiscard]] static constexpr std::uint32_t angle_of_cams(const CamTick<Real>& tick) noexcept {
    return static_cast<std::uint32_t>(tick.phase >> 32);
  }

  /// Where the train may touch a closed valve; for scenes that show the gap, where it changes.
  [[nodiscard]] static CamWindow near_window(const LiftCurve<Real>& curve, std::uint32_t opens) noexcept {
    constexpr std::uint32_t kUnitsPerDegree = 0xFFFF'FFFFu / kDegreesPerTurn;
    if (S::valve_forces && curve.touch_degrees < curve.segments) return {opens, curve.segments * kUnitsPerDegree};
    return {opens + curve.touch_from * kUnitsPerDegree, curve.touch_degrees * kUnitsPerDegree};
  }

  /// Valves at rest whose cams have come near move again, from where their cams stood before the tick; and the part of
  /// the turn is found in which the others may be left alone.
  [[gnu::noinline]] void wake(const CamTick<Real>& tick, std::uint32_t group) noexcept {
    const std::uint32_t angle = angle_of_cams(tick);
    const bool leaps = magnitude(tick.cam.deg) >= work_.leap_deg;
    CamClearance clear;
    for_each_of(group, [&](std::uint32_t v) {
      if ((work_.moving >> v & 1) != 0) return;
      const std::uint64_t opens = curve(v).opens[cylinder(v)];
      const CamWindow near = near_window(curve(v), static_cast<std::uint32_t>(opens >> 32));
      if (leaps || near.holds(angle)) {
        set_cam(v, curve(v).read(curve(v).cell(tick.phase_before() - opens)));
        work_.moving |= Bits{1} << v;
      } else {
        clear.keep_off(near, angle);
      }
    });
    work_.clear[group] = clear.about(angle);
  }

  /// The cams' speed has jumped, and with it the dampers' forces.
  [[gnu::noinline]] void ask_all(const CamTick<Real>& tick, std::uint32_t group) noexcept {
    for_each_of(group, [&](std::uint32_t v) {
      if ((work_.moving >> v & 1) == 0) return;
      const ValveState<Real> s{state_.valve_lift_m[v], state_.valve_velocity_m_s[v]};
      const std::uint32_t before = contacts_of(state_.valve_regime[v]);
      const std::uint32_t regime = asked(motion(v), s, cam(v), tick.cam.deg_per_s);
      if (regime == before) return;
      set_regime(v, regime);
      if constexpr (S::valve_results) {
        const Real deg = curve(v).degrees(tick.phase_before() - curve(v).opens[cylinder(v)]);
        state_.record[train(v)][cylinder(v)].change(before, regime, s.velocity_m_s, deg);
      }
    });
  }

  // ---- plain steps ------------------------------------------------------------------------------------------------

  /// Those of some valves; answers which of them have guards that fail.
  [[nodiscard]] Bits step_those(Bits which, const CamTicks<Real, S>& cams, Before& before) noexcept {
    Bits doubtful = 0;
    for (Bits left = which; left != 0; left &= left - 1) {
      const std::uint32_t v = trailing_zeros(left);
      if (!is_sure_after_step(v, cams[train(v)], before)) doubtful |= Bits{1} << v;
    }
    return doubtful;
  }

  /// False where its guards fail: then it is looked at, from what was before.
  [[nodiscard, gnu::always_inline]] bool is_sure_after_step(std::uint32_t v, const CamTick<Real>& tick,
                                                            Before& before) noexcept {
    const Cell cell = this->cell(v, tick.phase);
    const Gas gas = gas_on(v);
    const RegimeStep<Real>& regime = regime_of(v);
    const ValveState<Real> start{state_.valve_lift_m[v], state_.valve_velocity_m_s[v]};
    if (cell.degree >= curve(v).segments && swings_alone(v, start, regime, tick, gas)) {
      swing(v, start, regime, cell, gas);
      return true;
    }
    const Lift<Real> from = cam(v);
    const Lift<Real> to = curve(v).read(cell);
    const Stepped<Real> step = stepped(regime, start, from, to, tick.cam.deg, gas);
    ValveState<Real> end = step.state;
    const Real gap_m = to.lift_m - end.lift_m;
    const Real gap_speed_m_s = tick.cam.deg_per_s * to.per_deg_m - end.velocity_m_s;
    const bool sure = holds(regime.train, gap_m, gap_speed_m_s) && holds(regime.seat, end.lift_m, end.velocity_m_s) &&
                      !(far_ && is_far(v, tick));
    const bool still = put_to_rest(v, regime, gas, end);
    state_.valve_lift_m[v] = end.lift_m;
    state_.valve_velocity_m_s[v] = end.velocity_m_s;
    set_cam(v, to);
    if (!sure) {
      before.keep(v, start, step.rise_m, from);
      return false;
    }
    if constexpr (S::valve_results) {
      ChangeBudget none{};
      changes(v, none).note({start, state_.valve_regime[v]}, end, span(v, tick, from, to, gas), motion(v).tick_s);
    }
    if (still) leave_alone(v, cell);
    show(v, end, cell,
         {to.lift_m, gap_m, gap_speed_m_s, acceleration(regime.acceleration, end, gap_m, gap_speed_m_s, gas)}, gas);
    return true;
  }

  /// Too far for the guards: the tick may pass over a lobe, or hold more of the lift than a cubic.
  [[nodiscard]] bool is_far(std::uint32_t v, const CamTick<Real>& tick) const noexcept {
    const Real deg = magnitude(tick.cam.deg);
    return deg >= curve(v).leap_deg ||
           (deg > motion(v).widest_step_deg && contacts_of(state_.valve_regime[v]) != kSeatOn);
  }

  /// Whether a valve swings on its seat by so little that its cam, on the base circle, cannot matter. Gas moves the
  /// place that it swings about.
  [[nodiscard]] bool swings_alone(std::uint32_t v, const ValveState<Real>& s, const RegimeStep<Real>& regime,
                                  const CamTick<Real>& tick, const Gas& gas) const noexcept {
    if (far_ && magnitude(tick.cam.deg) >= work_.leap_deg) return false;
    const ValveMotion<Real>& m = motion(v);
    if constexpr (S::valve_gas) {
      const Real was_m = gas.rested_m(m.per_seat_N_m);
      const Real is_m = gas.resting_m(m.per_seat_N_m);
      const Real higher_m = was_m > is_m ? was_m : is_m;
      const Real drift_m_s = magnitude(is_m - was_m) * tables_.drive->per_tick_s;
      const Real swing_m = magnitude(s.lift_m - was_m) + (magnitude(s.velocity_m_s) + drift_m_s) * m.per_seat_rate_s;
      return (higher_m > 0 ? higher_m : Real{0}) + swing_m < regime.calm_m;
    } else {
      return swing_m(m, s, Real{0}) < regime.calm_m;
    }
  }

  /// The plain step of such a valve: all its cam's factors are 0.
  [[gnu::always_inline]] void swing(std::uint32_t v, const ValveState<Real>& start, const RegimeStep<Real>& regime,
                                    Cell cell, const Gas& gas) noexcept {
    const auto more = [&](const StepRow<Real>& r) {
      return gas.drive(r) + (r.lift * start.lift_m + r.velocity * start.velocity_m_s);
    };
    ValveState<Real> end{start.lift_m + more(regime.lift), start.velocity_m_s + more(regime.velocity)};
    if (put_to_rest(v, regime, gas, end)) leave_alone(v, cell);
    state_.valve_lift_m[v] = end.lift_m;
    state_.valve_velocity_m_s[v] = end.velocity_m_s;
    const Real outside_m = curve(v).outside_m;
    set_cam(v, {outside_m, Real{0}});
    const ForceRow<Real>& f = regime.acceleration;
    const Real acceleration_m_s2 = gas.rest(f) + f.lift * end.lift_m + f.velocity * end.velocity_m_s;
    if constexpr (S::valve_results) state_.record[train(v)][cylinder(v)].rest(end, acceleration_m_s2);
    show(v, end, cell, {outside_m, outside_m - end.lift_m, -end.velocity_m_s, acceleration_m_s2}, gas);
  }

  /// A valve that has all but come to rest is put there.
  [[nodiscard, gnu::always_inline]] bool put_to_rest(std::uint32_t v, const RegimeStep<Real>& regime, const Gas& gas,
                                                     ValveState<Real>& s) const noexcept {
    const Real resting_m = gas.resting_m(motion(v).per_seat_N_m);
    if (!(magnitude(s.lift_m - resting_m) < regime.rest_m && magnitude(s.velocity_m_s) < regime.rest_m_s)) return false;
    s = {resting_m, Real{0}};
    return true;
  }

  /// With its cam away a valve at rest is left alone from the next tick on.
  void leave_alone(std::uint32_t v, Cell cell) noexcept {
    if constexpr (!S::valve_gas && !kAbreast) {
      if (curve(v).may_touch(cell) || (S::valve_forces && cell.degree < curve(v).segments)) return;
      work_.moving &= ~(Bits{1} << v);
      for (CamWindow& clear : work_.clear) clear = {};  // found anew with the next tick
    }
    (void)v, (void)cell;
  }

  [[gnu::always_inline]] void show(std::uint32_t v, const ValveState<Real>& end, Cell cell, const Moment<Real>& at,
                                   const Gas& gas) noexcept {
    if constexpr (S::valve_gas) state_.valve_gas_N[v] = gas.to_N;
    show_motion((&out_.valve[0][0])[v], end, at);
    if constexpr (S::valve_forces)
      show_forces((&out_.valve_forces[0][0])[v], motion(v).body, curve(v), {end, state_.valve_regime[v]}, cell, at);
    (void)cell, (void)gas;
  }

  // ---- those whose guards fail ------------------------------------------------------------------------------------

  using Changes = ValveChanges<Real, Gas, Record>;
  [[nodiscard]] Changes changes(std::uint32_t v, ChangeBudget& budget) noexcept {
    if constexpr (S::valve_results) {
      return Changes(motion(v), curve(v), budget, state_.record[train(v)][cylinder(v)]);
    } else {
      return Changes(motion(v), curve(v), budget, no_record_);
    }
  }
  [[nodiscard]] Span<Real, Gas> span(std::uint32_t v, const CamTick<Real>& tick, const Lift<Real>& from,
                                     const Lift<Real>& to, const Gas& gas) const noexcept {
    return {from, to, tick.cam, gas, tick.phase_before() - curve(v).opens[cylinder(v)], Real{0}};
  }

  /// Another valve first in every tick: who comes first may spend the budget.
  [[gnu::noinline]] void look_by_turns(Bits doubtful, const CamTicks<Real, S>& cams, const Before& before,
                                       ChangeBudget& budget) noexcept {
    const std::uint32_t first = static_cast<std::uint32_t>(state_.ticks) % kMostValves;
    constexpr Bits kAll = (Bits{1} << (kMostValves - 1) << 1) - 1;
    const Bits from_first = doubtful >> first | (doubtful << (kMostValves - 1 - first) << 1 & kAll);
    for (Bits left = from_first; left != 0; left &= left - 1) {
      const std::uint32_t v = first + trailing_zeros(left);
      const std::uint32_t valve = v < kMostValves ? v : v - kMostValves;
      look(valve, cams[train(valve)], before, budget);
    }
  }

  void look(std::uint32_t v, const CamTick<Real>& tick, const Before& before, ChangeBudget& budget) noexcept {
    const Gas gas = gas_on(v);
    const Lift<Real> from{before.cam_lift_m[v], before.cam_per_deg_m[v]};
    const Lift<Real> to = cam(v);
    const Placed<Real> start{{before.lift_m[v], before.velocity_m_s[v]}, state_.valve_regime[v]};
    const Stepped<Real> step{{state_.valve_lift_m[v], state_.valve_velocity_m_s[v]}, before.rise_m[v]};
    const std::uint64_t at = tick.phase - curve(v).opens[cylinder(v)];
    const Placed<Real> end = changes(v, budget).run(start, step, span(v, tick, from, to, gas), at, tick.turned);
    state_.valve_lift_m[v] = end.state.lift_m;
    state_.valve_velocity_m_s[v] = end.state.velocity_m_s;
    if (end.regime != start.regime) set_regime(v, end.regime);
    const Real gap_m = to.lift_m - end.state.lift_m;
    const Real gap_speed_m_s = tick.cam.deg_per_s * to.per_deg_m - end.state.velocity_m_s;
    const ForceRow<Real>& force = motion(v).whole[end.regime].acceleration;
    show(v, end.state, cell(v, tick.phase),
         {to.lift_m, gap_m, gap_speed_m_s, acceleration(force, end.state, gap_m, gap_speed_m_s, gas)}, gas);
  }

  // ---- after the steps --------------------------------------------------------------------------------------------

  /// A valve's cycle ends where its cam passes the middle of the base circle.
  void end_cycles(const CamTicks<Real, S>& cams, std::uint32_t group) noexcept {
    const CamTick<Real>& tick = cams[group];
    if (work_.no_end[group].holds_all_of(angle_of_cams(tick), tick.turned)) return;
    CamClearance clear;
    for_each_of(group, [&](std::uint32_t v) {
      const LiftCurve<Real>& lift = curve(v);
      const std::uint64_t opens = lift.opens[cylinder(v)];
      clear.keep_off({static_cast<std::uint32_t>((opens + lift.base_middle()) >> 32), 0}, angle_of_cams(tick));
      if (!lift.passes_base_circle(tick.phase_before() - opens, tick.phase - opens)) return;
      // In cam degrees since the start of the lobe: after it, or before it when turning backwards.
      const auto lobe_deg = static_cast<Real>(static_cast<std::int32_t>(lift.segments));
      const Real end_deg = (tick.cam.deg < 0 ? lobe_deg - Real{kDegreesPerTurn} : lobe_deg + Real{kDegreesPerTurn}) / 2;
      out_.valve_cycle[train(v)][cylinder(v)] =
          state_.record[train(v)][cylinder(v)].finish(end_deg, contacts_of(state_.valve_regime[v]));
    });
    work_.no_end[group] = clear.about(angle_of_cams(tick));
  }

  // ---- abreast ----------------------------------------------------------------------------------------------------

  /// Plain steps in blocks of lanes, each a valve by its number; what fills no block one by one. Answers which have
  /// guards that fail.
  [[nodiscard]] Bits step_abreast([[maybe_unused]] const CamTicks<Real, S>& cams,
                                  [[maybe_unused]] Before& before) noexcept {
    Bits doubtful = 0;
#if CRANKLOOP_ABREAST
    if constexpr (kAbreast) {
      LanesTick<S> tick;
      if constexpr (S::cam_phasing) {
        for_each([&](std::uint32_t v) { tick.set(v, cams[train(v)]); });
      } else {
        tick.set(0, cams[0]);
      }
      if (far_) {
        for_each([&](std::uint32_t v) { doubtful |= Bits{is_far(v, cams[train(v)])} << v; });
      }
      const bool in_a_row = count<S>(tables_.drive->cylinders) == kPerTrain;  // then the lanes of all trains are
      const std::uint32_t row = in_a_row ? trains() * kPerTrain : count<S>(tables_.drive->cylinders);
      for (std::uint32_t first = 0; first < trains() * kPerTrain; first += in_a_row ? row : kPerTrain) {
        std::uint32_t done = 0;
        float* const shown = &out_.valve[0][0].theoretical_lift_m;
        doubtful |= step_blocks<WidestLanes>(work_, state_, tick, first, row, doubtful, before, shown, done);
        if constexpr (!std::is_same_v<WidestLanes, Four>)
          doubtful |= step_blocks<Four>(work_, state_, tick, first, row, doubtful, before, shown, done);
        const Bits rest = done < row ? ((Bits{1} << (row - done)) - 1) << (first + done) : 0;
        if (rest != 0) doubtful |= step_those(rest, cams, before);
      }
    }
#endif
    return doubtful;
  }

  const Tables<Real, S>& tables_;
  State<Real, S>& state_;
  ValvesWork<Real, S>& work_;
  Output<Real, S>& out_;
  const Real* pressure_Pa_;
  bool far_ = false;  ///< the cams have turned so far that some valve's guards may not tell
  NoRecord<Real> no_record_{};
};

}  // namespace crankloop::detail
