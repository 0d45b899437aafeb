// All valves of an engine over one tick.
//
// What belongs here: cam phases, the round over trains and cylinders, outputs. What does not: one valve's motion (valve_tick.hpp).
#pragma once

#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/faults.hpp>
#include <crankloop/tick/io.hpp>
#include <crankloop/tick/tables.hpp>
#include <crankloop/tick/valve_tick.hpp>

namespace crankloop::detail {

/// Contact changes that are located in a tick, over all valves; a fine step searched in vain takes one too. It bounds the worst tick.
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
        for (std::uint32_t k = 0; k < cylinders(); ++k) settle(t, k, lobe_phase(t, k, 0), Real{0});
      }
    }
  }

  /// Moves the cams toward their targets, then every valve.
  [[nodiscard]] std::uint32_t run(const Input<Real, S>& input) noexcept {
    std::uint32_t faults = 0;
    EventBudget budget{kEventsPerTick, false};
    const Phase turned{jumped ? 0 : (state.phase - before).units()};
    CamTurn<Real> cam = turn_of(turned);
    for (std::uint32_t t = 0; t < trains(); ++t) {
      if constexpr (S::cam_phasing) {
        const std::uint64_t phase_before = cam_phase(t);
        move_cam(t, input.cam_phase_deg[t], faults);
        cam = turn_of(jumped ? turned : turned - Phase{cam_phase(t) - phase_before});
      }
      const std::uint64_t phase_after = cam_phase(t);
      if constexpr (N::elastic_valves) {
        const ValveTick<Real> tick(tables.valve_motions[t], tables.lift_curves[t], cam, budget);
        run_elastic(t, phase_after, cam, tick);
      } else {
        for (std::uint32_t k = 0; k < cylinders(); ++k) follow(t, k, lobe_phase(t, k, phase_after), cam);
      }
    }
    (void)input;
    return budget.exceeded ? faults | kFaultEventBudget : faults;
  }

 private:
  [[nodiscard]] CamTurn<Real> turn_of(Phase turned) const noexcept {
    const Real turned_deg = turned.template signed_cycles<Real>() * Real{kDegreesPerTurn};
    return {static_cast<std::int64_t>(turned.units()), turned_deg, turned_deg * tables.drive->per_tick_s};
  }

  [[nodiscard]] std::uint32_t trains() const noexcept { return S::trains.exact ? S::trains.capacity : tables.drive->trains; }

  [[nodiscard]] std::uint32_t cylinders() const noexcept { return count<S>(tables.drive->cylinders); }

  /// Phase units since the lobe of a cylinder's train started.
  [[nodiscard]] std::uint64_t lobe_phase(std::uint32_t t, std::uint32_t k, std::uint64_t cam_phase) const noexcept {
    return state.phase.units() - cam_phase - tables.lift_curves[t].opens[k];
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
    const Real target = checked(target_deg, within_magnitude(target_deg, Real{180}), state.cam_phase_target_deg[t], kFaultCamPhase, faults);
    const auto wanted = static_cast<std::int64_t>(Phase::from_cycles(target * static_cast<Real>(1.0 / kDegreesPerCycle)).units());
    const auto most = static_cast<std::int64_t>(tables.lift_curves[t].most_phase_per_tick);
    std::int64_t move = wanted - static_cast<std::int64_t>(state.cam_phase[t]);
    if (move > most) move = most;
    if (move < -most) move = -most;
    state.cam_phase[t] += static_cast<std::uint64_t>(move);
  }

  /// A valve whose lift is its cam's.
  void follow(std::uint32_t t, std::uint32_t k, std::uint64_t at, const CamTurn<Real>& cam) noexcept {
    const LiftCurve<Real>& curve = tables.lift_curves[t];
    const Cell cell = LiftCurve<Real>::cell(at);
    const Lift<Real> lift = curve.read(cell);
    const Real speed_deg_s = cam.deg_per_s;
    const bool open = lift.lift_m > 0;
    ValveMotionOutput<Real>& valve = out.valve[t][k];
    valve.theoretical_lift_m = open ? lift.lift_m : Real{0};
    valve.lift_m = valve.theoretical_lift_m;
    valve.velocity_m_s = open ? lift.per_deg_m * speed_deg_s : Real{0};
    valve.acceleration_m_s2 = open ? curve.curvature(cell) * (speed_deg_s * speed_deg_s) : Real{0};
  }

  /// The valves of a train.
  void run_elastic(std::uint32_t t, std::uint64_t cam_phase, const CamTurn<Real>& cam, const ValveTick<Real>& tick) noexcept {
    const std::uint64_t train_phase = state.phase.units() - cam_phase;
    const std::uint64_t* opens = tables.lift_curves[t].opens;
    ValveCondition<Real>* valve = state.valve[t];
    ValveMotionOutput<Real>* shown = out.valve[t];
    for (std::uint32_t k = 0; k < cylinders(); ++k, ++opens, ++valve, ++shown) {
      const std::uint64_t at = train_phase - *opens;
      const auto gas = gas_on(t, k);
      if (jumped) settle(t, k, at, gas.force_N());
      if constexpr (S::valve_results || S::valve_forces) {
        run_watched(t, k, at, cam, tick, gas);
      } else {
        if (jumped || !run_easily(*valve, at, gas, tick, *shown)) run_carefully(*valve, at, gas, tick, *shown);
      }
    }
  }

  /// A valve at rest, or carried by its train, or settling on its seat: most of them.
  template <class Gas>
  [[nodiscard]] static bool run_easily(ValveCondition<Real>& valve, std::uint64_t at, const Gas& gas, const ValveTick<Real>& tick,
                                       ValveMotionOutput<Real>& shown) noexcept {
    const Cell end = LiftCurve<Real>::cell(at);
    if (valve.sleep == kAwake) return tick.carry(valve, at, end, gas, shown);
    if (!tick.rests_at(end, gas)) return false;
    return valve.sleep == kAsleep || tick.settle(valve, gas, shown);  // asleep, its output is zero since it fell asleep
  }

  /// A call of its own, so that its registers are not those of the easy ones.
  template <class Gas>
  [[gnu::noinline]] static void run_carefully(ValveCondition<Real>& valve, std::uint64_t at, const Gas& gas, const ValveTick<Real>& tick,
                                              ValveMotionOutput<Real>& shown) noexcept {
    NoRecord<Real> none;
    tick.run(valve, at, gas, none);
    tick.show(valve, gas, shown);
  }

  /// A valve whose forces or record are asked for.
  template <class Gas>
  void run_watched(std::uint32_t t, std::uint32_t k, std::uint64_t at, const CamTurn<Real>& cam, const ValveTick<Real>& tick, const Gas& gas) noexcept {
    ValveCondition<Real>& valve = state.valve[t][k];
    const Cell end = LiftCurve<Real>::cell(at);
    if constexpr (S::valve_results) {
      ValveRecord<Real>& record = state.record[t][k];
      tick.run(valve, at, gas, record);
      const LiftCurve<Real>& curve = tables.lift_curves[t];
      if (curve.passes_base_circle(at - static_cast<std::uint64_t>(cam.turned), at)) out.valve_cycle[t][k] = record.finish(cycle_end_deg(curve, cam), valve.regime);
    } else {
      NoRecord<Real> none;
      tick.run(valve, at, gas, none);
    }
    tick.show(valve, gas, out.valve[t][k]);
    if constexpr (S::valve_forces) show_forces(t, k, valve, end, cam.deg_per_s, gas.force_N());
  }

  [[nodiscard]] auto gas_on(std::uint32_t t, std::uint32_t k) const noexcept {
    if constexpr (S::valve_gas) {
      return GasForce<Real>{(pressure_Pa[k] - tables.body->crankcase_Pa) * tables.valve_motions[t].body.head_area_m2};
    } else {
      (void)t, (void)k;
      return NoGasForce<Real>{};
    }
  }

  /// A valve at rest where its cam stands.
  void settle(std::uint32_t t, std::uint32_t k, std::uint64_t at, Real gas_N) noexcept {
    const Lift<Real> lift = tables.lift_curves[t].read(LiftCurve<Real>::cell(at));
    state.valve[t][k] = in_equilibrium(tables.valve_motions[t].body, lift, gas_N);
  }

  [[nodiscard]] static ValveCondition<Real> in_equilibrium(const ValveBody<Real>& b, const Lift<Real>& lift, Real gas_N) noexcept {
    const Real open_m = (b.train_N_m * lift.lift_m - b.preload_N - gas_N) / (b.train_N_m + b.spring_N_m);
    if (open_m > b.seat_sink_m) return {{open_m, Real{0}}, lift, kTrainOn, 0};
    const Real pushed_m = (b.train_N_m * lift.lift_m - gas_N) / (b.train_N_m + b.seat_N_m + b.spring_N_m);
    if (lift.lift_m > pushed_m) return {{pushed_m, Real{0}}, lift, kTrainOn | kSeatOn, 0};
    return {};
  }

  /// The middle of the base circle in cam degrees since the start of the lobe: after it, or before it when turning backwards.
  [[nodiscard]] static Real cycle_end_deg(const LiftCurve<Real>& curve, const CamTurn<Real>& cam) noexcept {
    const auto lobe_deg = static_cast<Real>(static_cast<std::int32_t>(curve.segments));
    return (cam.turned_deg < 0 ? lobe_deg - Real{kDegreesPerTurn} : lobe_deg + Real{kDegreesPerTurn}) / 2;
  }

  void show_forces(std::uint32_t t, std::uint32_t k, const ValveCondition<Real>& valve, Cell cell, Real cam_deg_s, Real gas_N) noexcept {
    const ValveBody<Real>& body = tables.valve_motions[t].body;
    // A closed valve that sleeps keeps no lift; at rest its spring alone presses it into its seat.
    const Lift<Real> lift = valve.sleep == kAwake ? valve.train : tables.lift_curves[t].read(cell);
    const Contacts<Real> c = contacts(body, valve.state, lift.lift_m, lift.per_deg_m * cam_deg_s);
    ValveForcesOutput<Real>& force = out.valve_forces[t][k];
    force.train_N = train_force_N(valve.regime, c);
    force.seat_N = valve.sleep == kAsleep ? body.preload_N + gas_N : seat_force_N(valve.regime, c);
    force.tip_N = force.train_N - body.rocker_mass_kg * out.valve[t][k].acceleration_m_s2;
    force.cam_N = force.train_N * rocker_ratio(t, cell);
    force.gap_m = c.gap_m;
    force.regime = valve.regime;
  }

  /// Read where the train touches; outside the lobe there is no force to multiply.
  [[nodiscard]] Real rocker_ratio(std::uint32_t t, Cell cell) const noexcept {
    const LiftCurve<Real>& curve = tables.lift_curves[t];
    return cell.degree < curve.segments ? value(curve.rocker_ratio[cell.degree], fraction<Real>(cell)) : Real{0};
  }
};

}  // namespace crankloop::detail
