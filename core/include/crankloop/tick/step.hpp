// The implementation of Engine: include it in the one translation unit that instantiates a scene, nowhere else.
//
// What belongs here: the order of one tick, and what an engine starts from. What does not: its parts, each in a header of its own.
//
//     input -> checked -> crank: angle, torque, forces (mechanisms_step.hpp) -> valves -> trigger wheels -> output
#pragma once

#include <crankloop/tick/checked.hpp>
#include <crankloop/engine.hpp>
#include <crankloop/tick/crank/mechanisms_step.hpp>
#include <crankloop/tick/trigger/triggers_step.hpp>
#include <crankloop/tick/valve/valves_step.hpp>

namespace crankloop {

template <class Real, class S>
[[gnu::cold]] Status Engine<Real, S>::init(const Tables& tables, Phase start) noexcept {
  tables_ = nullptr;
  state_ = State{};
  output_ = Output{};
  if (build_contracts<Real>()) return {Reason::contracting_build, -1, "build"};
  if (!complete(tables)) return {Reason::missing_table, -1, "tables"};
  const Drive<Real>& drive = *tables.drive;
  const std::uint32_t capacity = S::cylinders.capacity;
  if (drive.cylinders < 1 || drive.cylinders > capacity || (S::cylinders.exact && drive.cylinders != capacity)) {
    return {Reason::out_of_range, -1, "tables.cylinders"};
  }
  if constexpr (Needs<S>::body && !S::rod_inertia) {
    if (tables.body->rod_inertia_correction_kg_m2 != Real{0}) return {Reason::inconsistent, -1, "scene.rod_inertia"};
  }
  if constexpr (Needs<S>::crank_dynamics) {
    const bool enough = tables.crank_dynamics->least_kg_m2 >= static_cast<Real>(kLeastInertia_kg_m2);
    if (!enough) return {Reason::not_positive, -1, "masses.crank_inertia"};
  }
  if constexpr (Needs<S>::any_valves) {
    if (drive.trains > S::trains.capacity || (S::trains.exact && drive.trains != S::trains.capacity)) {
      return {Reason::out_of_range, -1, "tables.trains"};
    }
  }
  if constexpr (Needs<S>::elastic_valves && !S::valve_gas) {
    for (std::uint32_t t = 0; t < drive.trains; ++t) {
      if (tables.valve_motions[t].body.head_area_m2 != Real{0}) return {Reason::inconsistent, static_cast<std::int32_t>(t), "scene.valve_gas"};
    }
  }
  if constexpr (Needs<S>::any_triggers) {
    const std::uint32_t wheels = tables.triggers->count;
    if (wheels > S::triggers.capacity || (S::triggers.exact && wheels != S::triggers.capacity)) {
      return {Reason::out_of_range, -1, "tables.triggers"};
    }
  }
  tables_ = &tables;
  state_.fingerprint = drive.fingerprint;
  state_.phase = start;
  if constexpr (Needs<S>::input_pressure) {
    for (Real& pressure : state_.pressure_Pa) pressure = tables.body->crankcase_Pa;
  }
  if constexpr (Needs<S>::work) {  // the first tick's work counts from here
    if constexpr (Needs<S>::crank_dynamics) {
      Real mean_pressure_Pa[S::cylinders.capacity] = {};
      detail::TorqueStep<Real, S> step(tables, state_, output_);
      step.read_torque(0);
      step.read_given_pressures(mean_pressure_Pa);
      step.start_crank();
      step.remember_work();
    } else {
      Real pressure_Pa[S::cylinders.capacity] = {};
      detail::run_mechanisms_apart(tables, state_, output_, {{}, {}, {}, true, pressure_Pa, pressure_Pa});
    }
    output_ = Output{};
  }
  if constexpr (Needs<S>::elastic_valves) detail::ElasticValves<Real, S>(tables, state_, *this, output_).start();
  return {};
}

template <class Real, class S>
const typename Engine<Real, S>::Output& Engine<Real, S>::step(const Input& input) noexcept {
  if (tables_ == nullptr) {
    output_.faults = kFaultNotReady;
    return output_;
  }
  const Tables& tables = *tables_;
  const Drive<Real>& drive = *tables.drive;
  std::uint32_t faults = 0;

  [[maybe_unused]] const Phase phase_before = state_.phase;
  [[maybe_unused]] const Real speed_before_rad_s = state_.speed_rad_s;
  Phase turned;
  bool jumped = false;
  if constexpr (S::crank == CrankGiven::speed) {
    const Real limit = drive.speed_limit_rad_s;
    const Real speed = detail::checked(input.speed_rad_s, detail::within_magnitude(input.speed_rad_s, limit), state_.speed_rad_s, kFaultSpeed, faults);
    turned = Phase::from_cycles(speed * drive.cycles_per_tick_per_rad_s);
    state_.phase += turned;
  } else if constexpr (S::crank == CrankGiven::phase) {
    turned = input.crank - state_.phase;
    const Real speed = turned.template signed_cycles<Real>() * drive.rad_s_per_cycle_per_tick;
    // The first measured angle says nothing of the speed, nor does one that no crankshaft could have reached.
    const bool possible = detail::within(speed, -drive.speed_limit_rad_s, drive.speed_limit_rad_s);
    jumped = !possible || state_.ticks == 0;
    if (!jumped) state_.speed_rad_s = speed;
    if (!possible && state_.ticks != 0) faults |= kFaultPhaseJump;
    state_.phase = input.crank;
  }
  ++state_.ticks;
  if constexpr (Needs<S>::load) {
    (void)detail::checked(input.load_ratio, detail::within_positive(input.load_ratio, Real{2}), state_.load_ratio, kFaultLoadRatio, faults);
  }
  [[maybe_unused]] Real mean_pressure_Pa[Needs<S>::given_work ? S::cylinders.capacity : 1];
  if constexpr (Needs<S>::input_pressure) {
    constexpr Real kMost_Pa = static_cast<Real>(kMostPressure_Pa);
    const std::uint32_t cylinders = detail::count<S>(drive.cylinders);
    const auto take = [&](std::uint32_t k, Real now_Pa) {
      if constexpr (Needs<S>::given_work) mean_pressure_Pa[k] = (state_.pressure_Pa[k] + now_Pa) / 2;
      state_.pressure_Pa[k] = now_Pa;
    };
    if (detail::all_within_positive(input.pressure_Pa, cylinders, kMost_Pa)) {
      for (std::uint32_t k = 0; k < cylinders; ++k) take(k, input.pressure_Pa[k]);
    } else {
      for (std::uint32_t k = 0; k < cylinders; ++k) {
        const bool good = detail::within_positive(input.pressure_Pa[k], kMost_Pa);
        take(k, good ? input.pressure_Pa[k] : state_.pressure_Pa[k]);
        if (!good) faults |= kFaultPressure;
      }
    }
  }

  [[maybe_unused]] Real head_pressure_Pa[S::valve_gas ? S::cylinders.capacity : 1];
  detail::CrankTurn<Real, S> crank{{}, {}, turned, jumped, mean_pressure_Pa, head_pressure_Pa};
  if constexpr (Needs<S>::cut) crank.cut_cylinders = input.cut_cylinders;
  if constexpr (Needs<S>::crank_dynamics) {
    faults |= detail::run_turned_by_forces(tables, state_, output_, crank, input);
  } else if constexpr (Needs<S>::elastic_valves) {
    detail::run_mechanisms_apart(tables, state_, output_, crank);
  } else {
    detail::run_mechanisms(tables, state_, output_, crank);
  }
  [[maybe_unused]] const detail::CamsBefore<S> cams_before(state_);
  if constexpr (Needs<S>::any_valves) {
    faults |= detail::run_valves(tables, state_, *this, output_, input, state_.phase - phase_before, jumped, head_pressure_Pa);
  }
  if constexpr (Needs<S>::any_triggers) {
    Real bend_cycles{};
    if constexpr (Needs<S>::crank_dynamics) bend_cycles = (state_.speed_rad_s - speed_before_rad_s) * drive.cycles_per_tick_per_rad_s / 2;
    const detail::CrankPath<Real> path{phase_before, crank.turned, jumped, bend_cycles};
    faults |= detail::TriggersStep<Real, S>{tables, state_, output_, path, cams_before}.run();
  }
  if constexpr (S::bad_input_count) {
    if (const std::uint32_t bad = faults & kInputFaults; bad != 0) {
      state_.bad_input_kinds |= bad;
      if (state_.bad_input_ticks != ~std::uint32_t{0}) ++state_.bad_input_ticks;
    }
  }
  output_.faults = faults;
  return output_;
}

template <class Real, class S>
[[gnu::cold]] Status Engine<Real, S>::restore(const State& state) noexcept {
  if (tables_ == nullptr) return {Reason::missing_table, -1, "tables"};
  if (state.fingerprint != state_.fingerprint) return {Reason::other_tables, -1, "state.fingerprint"};
  state_ = state;
  if constexpr (Needs<S>::elastic_valves) detail::ElasticValves<Real, S>(*tables_, state_, *this, output_).remember();
  return {};
}

}  // namespace crankloop
