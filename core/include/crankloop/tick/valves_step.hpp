// All valves of an engine over one tick.
//
// What belongs here: cam phases, the round over trains and cylinders, outputs. What does not: one valve's motion (valve_tick.hpp).
#pragma once

#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/faults.hpp>
#include <crankloop/tick/io.hpp>
#include <crankloop/tick/tables.hpp>

namespace crankloop::detail {

/// Contact changes that are located in a tick, over all valves: it bounds the worst tick.
inline constexpr std::uint32_t kEventsPerTick = 16;

template <class Real, class S>
struct ValvesStep {
  using N = Needs<S>;

  const Tables<Real, S>& tables;
  State<Real, S>& state;
  Output<Real, S>& out;
  Phase before;                ///< engine phase at the tick's start; state has that at its end
  bool jumped;                 ///< a measured phase jumped: valves start anew where the cam stands
  const Real* pressure_Pa;     ///< per cylinder, where the scene has valve_gas

  /// Puts every valve where its cam stands, at rest: the start, before the first tick.
  void settle() noexcept {
    if constexpr (N::elastic_valves) {
      for (std::uint32_t t = 0; t < trains(); ++t) {
        const LiftCurve<Real>& curve = tables.lift_curves[t];
        for (std::uint32_t k = 0; k < count<S>(tables.drive->cylinders); ++k) {
          const std::uint64_t at = state.phase.units() - zero_phase(t, k);
          state.valve[t][k] = in_equilibrium(tables.valve_motions[t].body, curve.read(LiftCurve<Real>::cell(at)).lift_m, Real{0});
        }
      }
    }
  }

  /// Moves the cams toward their targets, then every valve.
  [[nodiscard]] std::uint32_t run(const Input<Real, S>& input) noexcept {
    std::uint32_t faults = 0;
    EventBudget budget{kEventsPerTick, false};
    for (std::uint32_t t = 0; t < trains(); ++t) {
      const std::uint64_t phase_before = cam_phase(t);
      if constexpr (S::cam_phasing) move_cam(t, input.cam_phase_deg[t], faults);
      const std::uint64_t phase_after = cam_phase(t);
      for (std::uint32_t k = 0; k < count<S>(tables.drive->cylinders); ++k) run_valve(t, k, phase_before, phase_after, budget);
    }
    (void)input;
    return budget.exceeded ? faults | kFaultEventBudget : faults;
  }

 private:
  [[nodiscard]] std::uint32_t trains() const noexcept { return S::trains.exact ? S::trains.capacity : tables.drive->trains; }

  /// Engine phase at which the lobe of a cylinder's train opens.
  [[nodiscard]] std::uint64_t zero_phase(std::uint32_t t, std::uint32_t k) const noexcept {
    const Drive<Real>& drive = *tables.drive;
    return drive.firing_phase[drive.mechanism_of[k]] + (std::uint64_t{drive.turn_of[k]} << 63) + tables.lift_curves[t].opens;
  }

  [[nodiscard]] std::uint64_t cam_phase(std::uint32_t t) const noexcept {
    if constexpr (S::cam_phasing) {
      return state.cam_phase[t];
    } else {
      (void)t;
      return 0;
    }
  }

  void move_cam(std::uint32_t t, Real target_deg, std::uint32_t& faults) noexcept {
    const Real target = checked(target_deg, Real{-180}, Real{180}, state.cam_phase_target_deg[t], kFaultCamPhase, faults);
    const auto wanted = static_cast<std::int64_t>(Phase::from_cycles(target * static_cast<Real>(1.0 / kDegreesPerCycle)).units());
    const auto most = static_cast<std::int64_t>(tables.lift_curves[t].most_phase_per_tick);
    std::int64_t move = wanted - static_cast<std::int64_t>(state.cam_phase[t]);
    if (move > most) move = most;
    if (move < -most) move = -most;
    state.cam_phase[t] += static_cast<std::uint64_t>(move);
  }

  void run_valve(std::uint32_t t, std::uint32_t k, std::uint64_t phase_before, std::uint64_t phase_after, EventBudget& budget) noexcept {
    const Drive<Real>& drive = *tables.drive;
    const LiftCurve<Real>& curve = tables.lift_curves[t];
    const std::uint64_t zero = zero_phase(t, k);
    CamTurn<Real> cam;
    cam.from = before.units() - zero - phase_before;
    cam.to = state.phase.units() - zero - phase_after;
    cam.turned_deg = Phase{cam.to - cam.from}.template signed_cycles<Real>() * Real{kDegreesPerTurn};
    if constexpr (N::elastic_valves) {
      run_elastic(t, k, cam, budget);
    } else {
      const Lift<Real> lift = curve.read(LiftCurve<Real>::cell(cam.to));
      ValveMotionOutput<Real>& valve = out.valve[t][k];
      const Real speed_deg_s = cam.turned_deg * drive.per_tick_s;
      const bool open = lift.lift_m > 0;
      valve.theoretical_lift_m = open ? lift.lift_m : Real{0};
      valve.lift_m = valve.theoretical_lift_m;
      valve.velocity_m_s = open ? lift.per_deg_m * speed_deg_s : Real{0};
      valve.acceleration_m_s2 = open ? lift.per_deg2_m * (speed_deg_s * speed_deg_s) : Real{0};
    }
  }

  void run_elastic(std::uint32_t t, std::uint32_t k, const CamTurn<Real>& cam, EventBudget& budget) noexcept {
    const ValveMotion<Real>& motion = tables.valve_motions[t];
    const LiftCurve<Real>& curve = tables.lift_curves[t];
    ValveCondition<Real>& valve = state.valve[t][k];
    Real gas_N{};
    if constexpr (S::valve_gas) gas_N = (pressure_Pa[k] - tables.body->crankcase_Pa) * motion.body.head_area_m2;
    const Real per_tick_s = tables.drive->per_tick_s;
    if (jumped) valve = in_equilibrium(motion.body, curve.read(LiftCurve<Real>::cell(cam.to)).lift_m, gas_N);
    const CamTurn<Real> turn = jumped ? CamTurn<Real>{cam.to, cam.to, Real{0}} : cam;
    Lift<Real> lift;
    if constexpr (S::valve_results) {
      ValveRecord<Real>& record = state.record[t][k];
      lift = advance(motion, curve, gas_N, budget, record, valve, turn);
      if (passes_base_circle(curve, turn)) out.valve_cycle[t][k] = record.finish(cycle_end_deg(curve, turn), valve.regime);
    } else {
      NoRecord<Real> none;
      lift = advance(motion, curve, gas_N, budget, none, valve, turn);
    }
    show(t, k, valve, lift, turn.turned_deg * per_tick_s, gas_N);
  }

  template <class Record>
  [[nodiscard]] static Lift<Real> advance(const ValveMotion<Real>& motion, const LiftCurve<Real>& curve, Real gas_N, EventBudget& budget,
                                          Record& record, ValveCondition<Real>& valve, const CamTurn<Real>& cam) noexcept {
    ValveTick<Real, Record> tick(motion, curve, gas_N, budget, record);
    tick.advance(valve, cam);
    return tick.lift();
  }

  /// A valve at rest where the cam stands: what a phase jump leaves.
  [[nodiscard]] static ValveCondition<Real> in_equilibrium(const ValveBody<Real>& b, Real lift_m, Real gas_N) noexcept {
    const Real open_m = (b.train_N_m * lift_m - b.preload_N - gas_N) / (b.train_N_m + b.spring_N_m);
    if (open_m > b.seat_sink_m) return {{open_m, Real{0}}, kTrainOn, 0};
    const Real pushed_m = (b.train_N_m * lift_m - gas_N) / (b.train_N_m + b.seat_N_m + b.spring_N_m);
    if (lift_m > pushed_m) return {{pushed_m, Real{0}}, kTrainOn | kSeatOn, 0};
    return {};
  }

  /// Whether the cam passes the middle of its base circle in this tick: there a cycle ends.
  [[nodiscard]] static bool passes_base_circle(const LiftCurve<Real>& curve, const CamTurn<Real>& cam) noexcept {
    const std::uint64_t half_degrees = std::uint64_t{curve.segments} + kDegreesPerTurn;
    const std::uint64_t middle = half_degrees * (~std::uint64_t{0} / (2 * kDegreesPerTurn));
    const auto from = static_cast<std::int64_t>(cam.from - middle);
    const auto to = static_cast<std::int64_t>(cam.to - middle);
    constexpr std::int64_t kNear = std::int64_t{1} << 62;  // crossing zero there, not half a turn away
    return (from < 0) != (to < 0) && to < kNear && to > -kNear;
  }

  /// The middle of the base circle in cam degrees since the start of the lobe: after it, or before it when turning backwards.
  [[nodiscard]] static Real cycle_end_deg(const LiftCurve<Real>& curve, const CamTurn<Real>& cam) noexcept {
    const auto lobe_deg = static_cast<Real>(static_cast<std::int32_t>(curve.segments));
    return (cam.turned_deg < 0 ? lobe_deg - Real{kDegreesPerTurn} : lobe_deg + Real{kDegreesPerTurn}) / 2;
  }

  void show(std::uint32_t t, std::uint32_t k, const ValveCondition<Real>& valve, const Lift<Real>& lift, Real cam_deg_s, Real gas_N) noexcept {
    const ValveBody<Real>& body = tables.valve_motions[t].body;
    const Real lift_speed = lift.per_deg_m * cam_deg_s;
    ValveMotionOutput<Real>& shown = out.valve[t][k];
    shown.theoretical_lift_m = lift.lift_m > 0 ? lift.lift_m : Real{0};
    shown.lift_m = valve.state.lift_m;
    shown.velocity_m_s = valve.state.velocity_m_s;
    shown.acceleration_m_s2 = valve.asleep != 0 ? Real{0} : acceleration(body, valve.regime, valve.state, lift.lift_m, lift_speed, gas_N);
    if constexpr (S::valve_forces) {
      const Contacts<Real> c = contacts(body, valve.state, lift.lift_m, lift_speed);
      ValveForcesOutput<Real>& force = out.valve_forces[t][k];
      force.train_N = train_force_N(valve.regime, c);
      force.seat_N = valve.asleep != 0 ? body.preload_N + gas_N : seat_force_N(valve.regime, c);
      force.tip_N = force.train_N - body.rocker_mass_kg * shown.acceleration_m_s2;
      force.cam_N = force.train_N * rocker_ratio(t, k);
      force.gap_m = c.gap_m;
      force.regime = valve.regime;
    }
  }

  /// Read where the train touches; outside the lobe there is no force to multiply.
  [[nodiscard]] Real rocker_ratio(std::uint32_t t, std::uint32_t k) const noexcept {
    const LiftCurve<Real>& curve = tables.lift_curves[t];
    const Cell cell = LiftCurve<Real>::cell(state.phase.units() - zero_phase(t, k) - cam_phase(t));
    return cell.degree < curve.segments ? value(curve.rocker_ratio[cell.degree], fraction<Real>(cell)) : Real{0};
  }
};

}  // namespace crankloop::detail
