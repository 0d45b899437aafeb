// The implementation of Engine: include it in the one translation unit that instantiates a scene, nowhere else.
//
// What belongs here: the order of one tick, and what an engine starts from. What does not: its parts, each in a header
// of its own.
//
//     input -> checked -> crank: angle, torque, forces (mechanisms_step.hpp) -> valves -> trigger wheels -> output
//
// Where gas makes the pressure: angle -> valves -> gas (gas/gas_step.hpp) -> torque, forces -> trigger wheels.
#pragma once

#include <crankloop/assert.hpp>
#include <crankloop/engine.hpp>
#include <crankloop/tables/scene_fits.hpp>
#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/crank/crank_turn.hpp>
#include <crankloop/tick/crank/mechanisms_step.hpp>
#include <crankloop/tick/gas/gas_step.hpp>
#include <crankloop/tick/sensor_faults.hpp>
#include <crankloop/tick/trigger/triggers_step.hpp>
#include <crankloop/tick/valve/valves_step.hpp>

namespace crankloop {

template <class Real, class S>
[[gnu::cold]] Status Engine<Real, S>::init(const Tables& tables, Phase start) noexcept {
  tables_ = nullptr;
  state_ = State{};
  output_ = Output{};
  if (build_contracts<Real>()) return refuse("build", Reason::contracting_build);
  if (!complete(tables)) return refuse("tables", Reason::missing_table);
  if (const Status refused = detail::scene_fits(tables); !refused.ok()) return refused;
  tables_ = &tables;
  state_.fingerprint = tables.drive->fingerprint;
  state_.phase = start;
  if constexpr (detail::Needs<S>::input_pressure) {
    for (Real& pressure : state_.pressure_Pa) pressure = tables.body->crankcase_Pa;
  }
  if constexpr (S::misfire) detail::start_misfires(tables, state_);
  if constexpr (detail::Needs<S>::faulty_wheels) {
    for (std::uint32_t i = 0; i < tables.wheel_faults->count; ++i)
      state_.noise_random[i] = tables.wheel_faults->fault[i].noise_seed;
  }
  if constexpr (S::sensor_faults) {
    for (auto& sensor : state_.sensor) sensor.fault = detail::kNoSensorFault;
  }
  if constexpr (detail::Needs<S>::gas) detail::start_gas(tables, state_);
  if constexpr (detail::Needs<S>::work) {  // the first tick's work counts from here
    if constexpr (detail::Needs<S>::crank_dynamics) {
      Real mean_pressure_Pa[S::cylinders.capacity] = {};
      detail::TorqueStep<Real, S> step(tables, state_, output_);
      step.read_torque(detail::cut_cylinders_of(state_, 0));
      step.read_given_pressures(mean_pressure_Pa);
      step.start_crank();
      step.remember_work();
    } else {
      detail::CrankTurn<Real, S> crank{};
      crank.jumped = true;
      if constexpr (detail::Needs<S>::lack) crank.cut_cylinders = detail::cut_cylinders_of(state_, 0);
      detail::run_mechanisms_apart(tables, state_, output_, crank);
    }
    output_ = Output{};
  }
  if constexpr (detail::Needs<S>::elastic_valves)
    detail::ElasticValves<Real, S>(tables, state_, *this, output_).start();
  if constexpr (S::controller_names && S::walls) output_.coolant_K = tables.gas_walls->coolant_K;
  return {};
}

namespace detail {

/// Valves and the gas that flows through them, once the crank has turned. Answers fault bits.
template <class Real, class S>
[[nodiscard, gnu::always_inline]] inline std::uint32_t breathe(const Tables<Real, S>& tables, State<Real, S>& state,
                                                               ValvesWorkOf<Real, S>& work, Output<Real, S>& out,
                                                               const Input<Real, S>& input,
                                                               CrankTurn<Real, S>& crank) noexcept {
  push_heads<Real, S>(tables, state, crank.head_pressure_Pa);
  std::uint32_t faults =
      run_valves(tables, state, work, out, input, crank.turned, crank.has_jumped(), crank.head_pressure_Pa);
  Real work_J;
  faults |= GasStep<Real, S>(tables, state, out).run(input, crank.turned, crank.has_jumped(), work_J);
  if constexpr (Needs<S>::gas_work) crank.gas_work_J = work_J;
  return faults;
}

/// Crank, valves and gas to the tick's end, in the order in which each needs the others. Answers fault bits.
template <class Real, class S>
[[nodiscard, gnu::always_inline]] inline std::uint32_t move_parts(const Tables<Real, S>& tables, State<Real, S>& state,
                                                                  ValvesWorkOf<Real, S>& work, Output<Real, S>& out,
                                                                  const Input<Real, S>& input,
                                                                  CrankTurn<Real, S>& crank) noexcept {
  using N = Needs<S>;
  std::uint32_t faults = 0;
  if constexpr (N::misfire_of_table && !N::crank_dynamics) {
    if (crank.has_jumped()) {
      note_cycles(tables, state);
    } else {
      pass_cycles(tables, state, crank.turned);
    }
  }
  if constexpr (N::gas && N::crank_dynamics) {
    const auto once_turned = [&] { faults |= breathe(tables, state, work, out, input, crank); };
    faults |= turn_by_forces(tables, state, out, crank, input, once_turned);
  } else if constexpr (N::gas) {
    faults = breathe(tables, state, work, out, input, crank);
    run_mechanisms_apart(tables, state, out, crank);
  } else {
    if constexpr (N::crank_dynamics)
      faults = run_turned_by_forces(tables, state, out, crank, input);
    else if constexpr (N::elastic_valves && !kHasLanes)
      run_mechanisms_apart(tables, state, out, crank);
    else
      run_mechanisms(tables, state, out, crank);
    if constexpr (N::any_valves)
      faults |= run_valves(tables, state, work, out, input, crank.turned, crank.has_jumped(), crank.head_pressure_Pa);
  }
  (void)work, (void)input;
  return faults;
}

template <class Real, class S>
inline void count_bad_input(State<Real, S>& state, std::uint32_t faults) noexcept {
  const std::uint32_t bad = faults & kInputFaults;
  if (bad == 0) return;
  state.bad_input_kinds |= bad;
  if (state.bad_input_ticks != ~std::uint32_t{0}) ++state.bad_input_ticks;
}

}  // namespace detail

template <class Real, class S>
const typename Engine<Real, S>::Output& Engine<Real, S>::step(const Input& input) noexcept {
  if (tables_ == nullptr) {
    output_.faults = kFaultNotReady;
    return output_;
  }
  const Tables& tables = *tables_;
  [[maybe_unused]] detail::BeforeTick<Real, S> before;
  if constexpr (detail::Needs<S>::any_triggers) before.keep(state_);
  detail::CrankTurn<Real, S> crank;
  std::uint32_t faults = detail::take_crank_inputs(*tables.drive, state_, input, crank);
  faults |= detail::move_parts(tables, state_, *this, output_, input, crank);
  if constexpr (detail::Needs<S>::any_triggers) faults |= detail::read_triggers(tables, state_, output_, before, crank);
  if constexpr (detail::Needs<S>::faulty_wheels)
    faults |= detail::read_faulty_triggers(tables, state_, output_, input.wheel_faults, before, crank);
  if constexpr (detail::Needs<S>::reluctor) faults |= detail::sample_reluctor(tables, state_, output_, before, crank);
  if constexpr (S::sensor_faults) detail::read_faulty_sensors(tables, state_, output_, input.sensor_faults);
  if constexpr (S::bad_input_count) detail::count_bad_input(state_, faults);
  CRANKLOOP_ASSERT(detail::within_magnitude(state_.speed_rad_s, tables.drive->speed_limit_rad_s));
  output_.faults = faults;
  return output_;
}

template <class Real, class S>
[[gnu::cold]] Status Engine<Real, S>::restore(const State& state) noexcept {
  if (tables_ == nullptr) return refuse("tables", Reason::missing_table);
  if (state.fingerprint != state_.fingerprint) return refuse("state.fingerprint", Reason::other_tables);
  if constexpr (detail::Needs<S>::elastic_valves) {
    for (const std::uint32_t of_valve : state.valve_regime)
      if (of_valve >= std::uint32_t{detail::kRegimes}) return refuse("state.valve", Reason::out_of_range);
  }
  if constexpr (detail::Needs<S>::reluctor) {
    if (state.late_edges > S::reluctor_samples) return refuse("state.comparator", Reason::out_of_range);
  }
  if constexpr (detail::Needs<S>::lambda) {
    if (state.oldest_parcel >= S::lambda_parcels) return refuse("state.lambda", Reason::out_of_range);
  }
  if constexpr (S::sensor_faults) {
    for (const auto& sensor : state.sensor)
      if (sensor.oldest >= detail::kDelayedSamples) return refuse("state.sensor", Reason::out_of_range);
  }
  if constexpr (S::crank == CrankGiven::speed) {  // a bad input's tick turns by it
    if (!detail::within_magnitude(state.speed_rad_s, tables_->drive->speed_limit_rad_s))
      return refuse("state.speed_rad_s", Reason::out_of_range);
  }
  state_ = state;
  if constexpr (detail::Needs<S>::misfire_of_table) detail::note_cycles(*tables_, state_);
  if constexpr (detail::Needs<S>::elastic_valves) {
    detail::ElasticValves<Real, S> valves(*tables_, state_, *this, output_);
    valves.remember();
    if constexpr (detail::Needs<S>::crank_dynamics) valves.start_turning();
  }
  return {};
}

}  // namespace crankloop
