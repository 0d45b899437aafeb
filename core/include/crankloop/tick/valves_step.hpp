// All elastic or cam-following valves of an engine over one tick.
//
// What belongs here: cam phases, the round over trains and cylinders, gas, outputs. What does not: one valve's step (valve.hpp), a tick in which
// contacts change (valve_changes.hpp).
//
// A valve that moves takes one step in its contact regime, whatever that is: its record of constants has the difference. Where the guards
// say that no contact can have changed meanwhile, that is its tick. One at rest whose cam is away is not visited at all.
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/faults.hpp>
#include <crankloop/tick/io.hpp>
#include <crankloop/tick/tables.hpp>
#include <crankloop/tick/valve_changes.hpp>
#include <crankloop/tick/valves_abreast.hpp>

namespace crankloop::detail {

/// From tick to tick the damper's force may change by as much of the cam's speed as this without a look at the contacts.
inline constexpr double kSpeedJump = 0.02;

template <class Real, class S>
class ValvesStep {
  using N = Needs<S>;
  using Work = If<N::elastic_valves, ValvesWork<Real, S>>;
  using Gas = std::conditional_t<S::valve_gas, GasForce<Real>, NoGasForce<Real>>;
  using Record = std::conditional_t<S::valve_results, ValveRecord<Real>, NoRecord<Real>>;
  static constexpr bool kAbreast = CRANKLOOP_ABREAST != 0 && N::elastic_valves && kMayGoAbreast<Real, S>;

 public:
  /// Between ticks: to start, or to go on from a state.
  ValvesStep(const Tables<Real, S>& tables, State<Real, S>& state, Work& work, Output<Real, S>& out) noexcept
      : ValvesStep(tables, state, work, out, state.phase, false, nullptr) {}

  /// A tick: the engine's phase was `before` at its start; `jumped` tells that a measured one jumped, and that valves start anew where the cam
  /// stands; pressures are those of each cylinder, where the scene has valve_gas.
  ValvesStep(const Tables<Real, S>& tables, State<Real, S>& state, Work& work, Output<Real, S>& out, Phase before, bool jumped,
             const Real* pressure_Pa) noexcept
      : tables_{tables}, state_{state}, work_{work}, out_{out}, before_{before}, jumped_{jumped}, pressure_Pa_{pressure_Pa} {}

  /// Puts every valve where its cam stands, at rest: the start, before the first tick. The gas comes with the first tick.
  void start() noexcept {
    if constexpr (N::elastic_valves) {
      for (std::uint32_t t = 0; t < trains(); ++t) {
        for (std::uint32_t k = 0; k < cylinders(); ++k) place(t, k, lobe_phase(t, k), Real{0});
      }
      remember();
    }
  }

  /// Works out anew what a tick remembers.
  void remember() noexcept {
    if constexpr (N::elastic_valves) {
      for (std::uint32_t t = 0; t < trains(); ++t) {
        for (std::uint32_t k = 0; k < cylinders(); ++k) {
          set_cam(lane(t, k), read(t, lobe_phase(t, k)));
          if constexpr (kAbreast) {
            work_.degree[lane(t, k)] = ~std::uint32_t{0};
            work_.sink_m[lane(t, k)] = tables_.valve_motions[t].body.seat_sink_m;
            set_regime(lane(t, k), tables_.valve_motions[t], state_.valve_regime[lane(t, k)]);
          }
        }
        work_.moving[t] = (std::uint32_t{1} << cylinders()) - 1;
        work_.clear[t] = {};
      }
    }
  }

  /// Moves the cams toward their targets, then every valve.
  [[nodiscard]] std::uint32_t run(const Input<Real, S>& input) noexcept {
    std::uint32_t faults = 0;
    (void)input;
    if constexpr (S::cam_phasing) {
      for (std::uint32_t t = 0; t < trains(); ++t) cam_phase_before_[t] = state_.cam_phase[t], move_cam(t, input.cam_phase_deg[t], faults);
    }
    if (trains() == 0) return faults;
    if constexpr (N::elastic_valves) {
      ChangeBudget budget{tables_.valve_motions[0].most_changes, false};
      if constexpr (kAbreast) {
        run_abreast(budget);
      } else {
        by_turns(trains(), [&](std::uint32_t t) {
          const TrainTick tick = tick_of(t);
          begin(tick);
          move_all(tick, work_.moving[t], budget);
          finish(tick);
        });
      }
      if (budget.exceeded) faults |= kFaultEventBudget;
    } else {
      for (std::uint32_t t = 0; t < trains(); ++t) {
        const CamTurn<Real> cam = cam_turn(turned(t));
        for (std::uint32_t k = 0; k < cylinders(); ++k) follow(t, k, lobe_phase(t, k), cam);
      }
    }
    return faults;
  }

 private:
  [[nodiscard]] std::uint32_t trains() const noexcept { return S::trains.exact ? S::trains.capacity : tables_.drive->trains; }
  [[nodiscard]] std::uint32_t cylinders() const noexcept { return count<S>(tables_.drive->cylinders); }
  [[nodiscard]] static constexpr std::uint32_t lane(std::uint32_t t, std::uint32_t k) noexcept { return t * S::cylinders.capacity + k; }

  // ---- cams ------------------------------------------------------------------------------------------------------------------

  /// Phase units by which a train's cams turn in this tick, 2^64 = 360 cam degrees.
  [[nodiscard]] std::int64_t turned(std::uint32_t t) const noexcept {
    if (jumped_) return 0;
    std::uint64_t units = (state_.phase - before_).units();
    if constexpr (S::cam_phasing) units -= state_.cam_phase[t] - cam_phase_before_[t];
    (void)t;
    return static_cast<std::int64_t>(units);
  }

  [[nodiscard]] CamTurn<Real> cam_turn(std::int64_t turned) const noexcept {
    const Real deg = Phase{static_cast<std::uint64_t>(turned)}.template signed_cycles<Real>() * Real{kDegreesPerTurn};
    return {deg, deg * tables_.drive->per_tick_s};
  }

  /// Where a train's cams stand, before each cylinder's own lag.
  [[nodiscard]] std::uint64_t train_phase(std::uint32_t t) const noexcept {
    std::uint64_t phase = state_.phase.units();
    if constexpr (S::cam_phasing) phase -= state_.cam_phase[t];
    (void)t;
    return phase;
  }

  /// Phase units since the lobe of a cylinder's train started.
  [[nodiscard]] std::uint64_t lobe_phase(std::uint32_t t, std::uint32_t k) const noexcept { return train_phase(t) - tables_.lift_curves[t].opens[k]; }

  [[nodiscard]] Lift<Real> read(std::uint32_t t, std::uint64_t at) const noexcept { return tables_.lift_curves[t].read(LiftCurve<Real>::cell(at)); }

  void move_cam(std::uint32_t t, Real target_deg, std::uint32_t& faults) noexcept {
    const Real target = checked(target_deg, within_magnitude(target_deg, Real{180}), state_.cam_phase_target_deg[t], kFaultCamPhase, faults);
    const auto wanted = static_cast<std::int64_t>(Phase::from_cycles(target * static_cast<Real>(1.0 / kDegreesPerCycle)).units());
    const auto most = static_cast<std::int64_t>(tables_.lift_curves[t].most_phase_per_tick);
    std::int64_t move = wanted - static_cast<std::int64_t>(state_.cam_phase[t]);
    if (move > most) move = most;
    if (move < -most) move = -most;
    state_.cam_phase[t] += static_cast<std::uint64_t>(move);
  }

  // ---- valves that follow their cams -----------------------------------------------------------------------------------------

  void follow(std::uint32_t t, std::uint32_t k, std::uint64_t at, const CamTurn<Real>& cam) noexcept {
    const LiftCurve<Real>& curve = tables_.lift_curves[t];
    const Cell cell = LiftCurve<Real>::cell(at);
    const Lift<Real> lift = curve.read(cell);
    const bool open = lift.lift_m > 0;
    ValveMotionOutput<Real>& valve = out_.valve[t][k];
    valve.theoretical_lift_m = open ? lift.lift_m : Real{0};
    valve.lift_m = valve.theoretical_lift_m;
    valve.velocity_m_s = open ? lift.per_deg_m * cam.deg_per_s : Real{0};
    valve.acceleration_m_s2 = open ? curve.curvature(cell) * (cam.deg_per_s * cam.deg_per_s) : Real{0};
  }

  // ---- elastic valves --------------------------------------------------------------------------------------------------------

  /// A train in this tick.
  struct TrainTick {
    std::uint32_t t;
    const ValveMotion<Real>& motion;
    const LiftCurve<Real>& curve;
    std::uint64_t phase;   ///< at the tick's end
    std::int64_t turned;
    CamTurn<Real> cam;
    bool leaps;            ///< may pass over all of the lobe where the train touches a closed valve
    bool wide;             ///< too far for a whole step where the cam counts
  };

  [[nodiscard]] TrainTick tick_of(std::uint32_t t) const noexcept {
    const ValveMotion<Real>& motion = tables_.valve_motions[t];
    const LiftCurve<Real>& curve = tables_.lift_curves[t];
    const std::int64_t units = turned(t);
    const CamTurn<Real> cam = cam_turn(units);
    const Real turns = magnitude(cam.deg);
    return {t, motion, curve, train_phase(t), units, cam, turns >= curve.leap_deg, motion.parts > 1 && turns > motion.widest_step_deg};
  }

  /// What comes before a train's steps.
  void begin(const TrainTick& tick) noexcept {
    const auto angle = static_cast<std::uint32_t>(tick.phase >> 32);
    if (jumped_) {
      for (std::uint32_t k = 0; k < cylinders(); ++k) place(tick.t, k, lobe_phase(tick.t, k), gas_now_N(tick.t, k));
      remember();
    } else if (tick.leaps || !work_.clear[tick.t].holds(angle)) {
      wake(tick, angle);
    }
    Real& before_deg = state_.cam_turned_deg[tick.t];
    if (tick.cam.deg != before_deg) {
      const bool jump = magnitude(tick.cam.deg - before_deg) > static_cast<Real>(kSpeedJump) * magnitude(tick.cam.deg);
      before_deg = tick.cam.deg;
      if (jump) ask_all(tick);
    }
  }

  /// Calls for each of `count`, another one first in every tick: who comes first may spend the budget.
  template <class Call>
  void by_turns(std::uint32_t count, const Call& call) const noexcept {
    const std::uint32_t first = static_cast<std::uint32_t>(state_.ticks) % count;
    for (std::uint32_t i = first; i < count; ++i) call(i);
    for (std::uint32_t i = 0; i < first; ++i) call(i);
  }

  /// Valves of a train, bit k: cylinder k.
  void move_all(const TrainTick& tick, std::uint32_t which, ChangeBudget& budget) noexcept {
    const std::uint32_t first = static_cast<std::uint32_t>(state_.ticks) % cylinders();
    const std::uint32_t ahead = which >> first;
    for (std::uint32_t left = ahead; left != 0; left &= left - 1) move(tick, first + trailing_zeros(left), budget);
    for (std::uint32_t left = which ^ (ahead << first); left != 0; left &= left - 1) move(tick, trailing_zeros(left), budget);
  }

  /// What comes after them.
  void finish(const TrainTick& tick) noexcept {
    (void)tick;
    if constexpr (S::valve_forces) {
      for (std::uint32_t k = 0; k < cylinders(); ++k) {
        if ((work_.moving[tick.t] >> k & 1) == 0) out_.valve_forces[tick.t][k].gap_m = read(tick.t, tick.phase - tick.curve.opens[k]).lift_m;
      }
    }
    if constexpr (S::valve_results) {
      for (std::uint32_t k = 0; k < cylinders(); ++k) end_cycle(tick, k);
    }
  }

  [[nodiscard]] Lift<Real> cam(std::uint32_t lane) const noexcept { return {work_.cam_lift_m[lane], work_.cam_per_deg_m[lane]}; }
  void set_cam(std::uint32_t lane, const Lift<Real>& lift) noexcept {
    work_.cam_lift_m[lane] = lift.lift_m;
    work_.cam_per_deg_m[lane] = lift.per_deg_m;
  }
  void set_regime(std::uint32_t lane, const ValveMotion<Real>& motion, std::uint32_t regime) noexcept {
    state_.valve_regime[lane] = regime;
#if CRANKLOOP_ABREAST
    if constexpr (kAbreast) detail::set_regime(work_, lane, motion.whole[regime]);
#endif
    (void)motion;
  }

  [[nodiscard]] Placed<Real> placed(std::uint32_t lane) const noexcept {
    return {{state_.valve_lift_m[lane], state_.valve_velocity_m_s[lane]}, state_.valve_regime[lane]};
  }
  void put(std::uint32_t lane, const Placed<Real>& valve) noexcept {
    state_.valve_lift_m[lane] = valve.state.lift_m;
    state_.valve_velocity_m_s[lane] = valve.state.velocity_m_s;
    state_.valve_regime[lane] = valve.regime;
  }

  /// At rest where the cam stands.
  void place(std::uint32_t t, std::uint32_t k, std::uint64_t at, Real gas_N) noexcept {
    put(lane(t, k), in_equilibrium(tables_.valve_motions[t], read(t, at).lift_m, gas_N));
    if constexpr (S::valve_gas) state_.valve_gas_N[lane(t, k)] = gas_N;
  }

  /// Valves at rest whose cams have come near move again, from where their cams stood before the tick; and the part of the turn is found in
  /// which the others may be left alone.
  [[gnu::noinline]] void wake(const TrainTick& tick, std::uint32_t angle) noexcept {
    constexpr std::uint32_t kUnitsPerDegree = 0xFFFF'FFFFu / kDegreesPerTurn;
    const std::uint64_t begin = tick.phase - static_cast<std::uint64_t>(tick.turned);
    std::uint32_t ahead = 0x7FFF'FFFF;
    std::uint32_t behind = 0x7FFF'FFFF;
    for (std::uint32_t k = 0; k < cylinders(); ++k) {
      if ((work_.moving[tick.t] >> k & 1) != 0) continue;
      const auto opens = static_cast<std::uint32_t>(tick.curve.opens[k] >> 32);
      const CamWindow near{opens + tick.curve.touch_from * kUnitsPerDegree, tick.curve.touch_degrees * kUnitsPerDegree};
      if (tick.leaps || near.holds(angle)) {
        set_cam(lane(tick.t, k), read(tick.t, begin - tick.curve.opens[k]));
        work_.moving[tick.t] |= std::uint32_t{1} << k;
        continue;
      }
      const std::uint32_t to = near.from - angle;
      const std::uint32_t since = angle - (near.from + near.width);
      ahead = to < ahead ? to : ahead;
      behind = since < behind ? since : behind;
    }
    work_.clear[tick.t] = {angle - behind, behind + ahead};
  }

  /// The cams' speed has jumped, and with it the dampers' forces.
  [[gnu::noinline]] void ask_all(const TrainTick& tick) noexcept {
    for (std::uint32_t k = 0; k < cylinders(); ++k) {
      if ((work_.moving[tick.t] >> k & 1) == 0) continue;
      const std::uint32_t l = lane(tick.t, k);
      const Placed<Real> valve = placed(l);
      const std::uint32_t regime = asked(tick.motion, valve.state, cam(l), tick.cam.deg_per_s);
      if (regime == contacts_of(valve.regime)) continue;
      set_regime(l, tick.motion, regime);
      if constexpr (S::valve_results) {
        const Real deg = tick.curve.degrees(tick.phase - static_cast<std::uint64_t>(tick.turned) - tick.curve.opens[k]);
        state_.record[tick.t][k].change(contacts_of(valve.regime), regime, valve.state.velocity_m_s, deg);
      }
    }
  }

  /// One valve's tick.
  void move(const TrainTick& tick, std::uint32_t k, ChangeBudget& budget) noexcept {
    const ValveMotion<Real>& motion = tick.motion;
    const std::uint32_t l = lane(tick.t, k);
    const Cell cell = LiftCurve<Real>::cell(tick.phase - tick.curve.opens[k]);
    const Lift<Real> to = tick.curve.read(cell);
    const Gas gas = gas_on(tick.t, k);
    const std::uint32_t before = state_.valve_regime[l];
    const RegimeStep<Real>* regime = &motion.whole[before];
    const ValveState<Real> start{state_.valve_lift_m[l], state_.valve_velocity_m_s[l]};
    Stepped<Real> step = stepped(*regime, start, cam(l), to, tick.cam.deg, gas);
    ValveState<Real>& end = step.state;
    Real gap = to.lift_m - end.lift_m;
    Real gap_speed = tick.cam.deg_per_s * to.per_deg_m - end.velocity_m_s;
    const bool sure = holds(regime->train, gap, gap_speed) && holds(regime->seat, motion.body.seat_sink_m - end.lift_m, end.velocity_m_s) &&
                      !tick.leaps && !(tick.wide && before != kQuiet);
    const Real resting_m = gas.resting_m(motion.per_seat_N_m);
    const bool still = magnitude(end.lift_m - resting_m) < regime->rest_m && magnitude(end.velocity_m_s) < regime->rest_m_s;
    if (still) end = {resting_m, Real{0}};
    if (!sure) {
      const Placed<Real> found = look(tick, k, {start, before}, step, cam(l), to, gas, budget);
      end = found.state;
      if (found.regime != before) set_regime(l, motion, found.regime);
      regime = &motion.whole[found.regime];
      gap = to.lift_m - end.lift_m;
      gap_speed = tick.cam.deg_per_s * to.per_deg_m - end.velocity_m_s;
    } else if constexpr (S::valve_results) {
      ChangeBudget none{0, false};
      changes(tick, k, none).note({start, before}, end, span(tick, k, cam(l), to, gas), motion.tick_s);
    }
    state_.valve_lift_m[l] = end.lift_m;
    state_.valve_velocity_m_s[l] = end.velocity_m_s;
    set_cam(l, to);
    ValveMotionOutput<Real>& shown = out_.valve[tick.t][k];
    shown.theoretical_lift_m = to.lift_m > 0 ? to.lift_m : Real{0};
    shown.lift_m = end.lift_m;
    shown.velocity_m_s = end.velocity_m_s;
    shown.acceleration_m_s2 = acceleration(regime->acceleration, end, gap, gap_speed, gas);
    if constexpr (S::valve_forces) show_forces(tick, k, {end, state_.valve_regime[l]}, cell, gap, gap_speed);
    if constexpr (!S::valve_gas) {
      if (still) rest(tick, k, {end, state_.valve_regime[l]}, cell);
    }
  }

  using Changes = ValveChanges<Real, Gas, Record>;
  [[nodiscard]] Changes changes(const TrainTick& tick, std::uint32_t k, ChangeBudget& budget) noexcept {
    return Changes(tick.motion, tick.curve, budget, record_of(tick.t, k));
  }
  [[nodiscard]] Span<Real, Gas> span(const TrainTick& tick, std::uint32_t k, const Lift<Real>& from, const Lift<Real>& to,
                                     const Gas& gas) const noexcept {
    Real from_deg{};
    if constexpr (S::valve_results) from_deg = tick.curve.degrees(tick.phase - tick.curve.opens[k] - static_cast<std::uint64_t>(tick.turned));
    return {from, to, tick.cam, gas, from_deg};
  }

  /// A tick whose guards fail. A call of its own: most ticks need none of its registers.
  [[nodiscard, gnu::noinline]] Placed<Real> look(const TrainTick& tick, std::uint32_t k, const Placed<Real>& start, const Stepped<Real>& end,
                                                 const Lift<Real>& from, const Lift<Real>& to, const Gas& gas, ChangeBudget& budget) noexcept {
    return changes(tick, k, budget).run(start, end, span(tick, k, from, to, gas), tick.phase - tick.curve.opens[k], tick.turned);
  }

  /// A valve that has come to rest with its cam away is left alone from the next tick on.
  void rest(const TrainTick& tick, std::uint32_t k, const Placed<Real>& valve, Cell cell) noexcept {
    const bool at_rest = valve.state.lift_m == 0 && valve.state.velocity_m_s == 0 && (valve.regime == kSeatOn || valve.regime == kQuiet);
    if (!at_rest || tick.curve.may_touch(cell)) return;
    work_.moving[tick.t] &= ~(std::uint32_t{1} << k);
    work_.clear[tick.t] = {};  // found anew with the next tick
  }

  /// All plain steps in blocks of lanes; then, by turns, the valves that are not sure, and those that fill no block.
  void run_abreast([[maybe_unused]] ChangeBudget& budget) noexcept {
#if CRANKLOOP_ABREAST
    constexpr std::size_t kRoom = AbreastWork<S>::kRoom;
    std::int32_t into[kRoom];
    CamTurn<Real> cams{};                      // the same for all trains,
    float deg[kRoom];                          // or not
    float deg_per_s[kRoom];
    BeforeStep<kRoom> before;
    std::uint64_t unsure = 0;  // bit l: lane l
    std::uint64_t alone = 0;   // those that fill no block
    const bool in_a_row = cylinders() == S::cylinders.capacity;  // then the lanes of all trains are
    const std::uint32_t rows = in_a_row ? 1 : trains();
    const std::uint32_t row = in_a_row ? trains() * cylinders() : cylinders();
    for (std::uint32_t t = 0; t < trains(); ++t) {
      const TrainTick tick = tick_of(t);
      begin(tick);
      cams = tick.cam;
      for (std::uint32_t k = 0; k < cylinders(); ++k) {
        into[lane(t, k)] = enter(work_, lane(t, k), tick.curve, tick.phase - tick.curve.opens[k]);
        if constexpr (S::cam_phasing) deg[lane(t, k)] = tick.cam.deg, deg_per_s[lane(t, k)] = tick.cam.deg_per_s;
      }
      if (tick.leaps || tick.wide) {
        for (std::uint32_t k = 0; k < cylinders(); ++k) {
          if (tick.leaps || state_.valve_regime[lane(t, k)] != kQuiet) unsure |= std::uint64_t{1} << lane(t, k);
        }
      }
    }
    float* const shown = &out_.valve[0][0].theoretical_lift_m;
    const auto blocks = [&](auto lanes, std::uint32_t from, std::uint32_t to) {
      using Lanes = decltype(lanes);
      constexpr auto kWidth = static_cast<std::uint32_t>(kLanesOf<Lanes>);
      for (std::uint32_t left = (to - from) / kWidth; left != 0; --left, from += kWidth) {
        const bool any = (unsure >> from & ((1u << kWidth) - 1)) != 0;
        Lanes block_deg = Lanes{} + cams.deg;
        Lanes block_deg_per_s = Lanes{} + cams.deg_per_s;
        if constexpr (S::cam_phasing) block_deg = load<Lanes>(deg + from), block_deg_per_s = load<Lanes>(deg_per_s + from);
        unsure |= std::uint64_t{step_block<Lanes>(work_, state_, from, into, block_deg, block_deg_per_s, any, before, shown + 4 * from)} << from;
      }
      return from;
    };
    for (std::uint32_t r = 0; r < rows; ++r) {
      std::uint32_t from = r * S::cylinders.capacity;
      const std::uint32_t end = from + row;
      if constexpr (!std::is_same_v<WidestLanes, Four>) from = blocks(WidestLanes{}, from, end);
      from = blocks(Four{}, from, end);
      for (; from < end; ++from) alone |= std::uint64_t{1} << from;
    }
    if ((unsure | alone) == 0) return;
    by_turns(trains(), [&](std::uint32_t t) {
      const TrainTick tick = tick_of(t);
      by_turns(cylinders(), [&](std::uint32_t k) {
        const std::uint32_t l = lane(t, k);
        if ((alone >> l & 1) != 0) {
          if ((work_.moving[t] >> k & 1) != 0) move(tick, k, budget);
        } else if ((unsure >> l & 1) != 0) {
          const Placed<Real> start{{before.lift_m[l], before.velocity_m_s[l]}, state_.valve_regime[l]};
          const Stepped<Real> step{{state_.valve_lift_m[l], state_.valve_velocity_m_s[l]}, before.rise_m[l]};
          const Lift<Real> to = cam(l);
          const Placed<Real> end = look(tick, k, start, step, {before.cam_lift_m[l], before.cam_per_deg_m[l]}, to, Gas{}, budget);
          state_.valve_lift_m[l] = end.state.lift_m;
          state_.valve_velocity_m_s[l] = end.state.velocity_m_s;
          if (end.regime != start.regime) set_regime(l, tick.motion, end.regime);
          ValveMotionOutput<Real>& moved = out_.valve[t][k];
          moved.lift_m = end.state.lift_m;
          moved.velocity_m_s = end.state.velocity_m_s;
          moved.acceleration_m_s2 = acceleration(tick.motion.whole[end.regime].acceleration, end.state, to.lift_m - end.state.lift_m,
                                                 tick.cam.deg_per_s * to.per_deg_m - end.state.velocity_m_s, Gas{});
        }
      });
    });
#endif
  }

  [[nodiscard]] Real gas_now_N(std::uint32_t t, std::uint32_t k) const noexcept {
    if constexpr (S::valve_gas) return (pressure_Pa_[k] - tables_.body->crankcase_Pa) * tables_.valve_motions[t].body.head_area_m2;
    (void)t, (void)k;
    return Real{0};
  }

  [[nodiscard]] Gas gas_on(std::uint32_t t, std::uint32_t k) noexcept {
    if constexpr (S::valve_gas) {
      Real& last_N = state_.valve_gas_N[lane(t, k)];
      const Gas gas{last_N, gas_now_N(t, k)};
      last_N = gas.to_N;
      return gas;
    } else {
      (void)t, (void)k;
      return {};
    }
  }

  [[nodiscard]] Record& record_of(std::uint32_t t, std::uint32_t k) noexcept {
    if constexpr (S::valve_results) {
      return state_.record[t][k];
    } else {
      (void)t, (void)k;
      return no_record_;
    }
  }

  void end_cycle(const TrainTick& tick, std::uint32_t k) noexcept {
    const std::uint64_t at = tick.phase - tick.curve.opens[k];
    if (!tick.curve.passes_base_circle(at - static_cast<std::uint64_t>(tick.turned), at)) return;
    // The middle of the base circle in cam degrees since the start of the lobe: after it, or before it when turning backwards.
    const auto lobe_deg = static_cast<Real>(static_cast<std::int32_t>(tick.curve.segments));
    const Real end_deg = (tick.cam.deg < 0 ? lobe_deg - Real{kDegreesPerTurn} : lobe_deg + Real{kDegreesPerTurn}) / 2;
    out_.valve_cycle[tick.t][k] = state_.record[tick.t][k].finish(end_deg, contacts_of(state_.valve_regime[lane(tick.t, k)]));
  }

  void show_forces(const TrainTick& tick, std::uint32_t k, const Placed<Real>& valve, Cell cell, Real gap_m, Real gap_speed_m_s) noexcept {
    const ValveBody<Real>& b = tick.motion.body;
    const auto pushing = [](bool on, Real force_N) { return on && force_N > 0 ? force_N : Real{0}; };
    const std::uint32_t contacts = contacts_of(valve.regime);
    ValveForcesOutput<Real>& force = out_.valve_forces[tick.t][k];
    force.train_N = pushing((contacts & kTrainOn) != 0, b.train_N_m * gap_m + b.train_Ns_m * gap_speed_m_s);
    force.seat_N = pushing((contacts & kSeatOn) != 0, b.preload_N - (b.seat_N_m * valve.state.lift_m + b.seat_Ns_m * valve.state.velocity_m_s));
    force.tip_N = force.train_N - b.rocker_mass_kg * out_.valve[tick.t][k].acceleration_m_s2;
    // Read where the train touches; outside the lobe there is no force to multiply.
    const bool in_lobe = cell.degree < tick.curve.segments;
    force.cam_N = force.train_N * (in_lobe ? value(tick.curve.rocker_ratio[cell.degree], fraction<Real>(cell)) : Real{0});
    force.gap_m = gap_m;
    force.regime = contacts;
  }

  const Tables<Real, S>& tables_;
  State<Real, S>& state_;
  Work& work_;
  Output<Real, S>& out_;
  Phase before_;
  bool jumped_;
  const Real* pressure_Pa_;
  std::uint64_t cam_phase_before_[S::trains.capacity];  ///< of scenes with cam_phasing
  NoRecord<Real> no_record_{};
};

}  // namespace crankloop::detail
