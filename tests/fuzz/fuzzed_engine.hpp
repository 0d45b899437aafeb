// An engine to be fuzzed: two cylinders with elastic valves and everything else there is, in both scalars.
//
// What belongs here: its scene and its definition. What does not: what comes at it (saved_state.cpp, step_input.cpp).
#pragma once

#include <memory>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/step.hpp>

#include "fuzz.hpp"
#include "target/bits.hpp"
#include "target/output_numbers.hpp"

namespace crankloop::fuzz {

struct Everything : Scene {
  static constexpr Count cylinders = exactly<2>;
  static constexpr PressureGiven pressure = PressureGiven::by_table;
  static constexpr bool load_ratio = true;
  static constexpr bool rod_inertia = true;
  static constexpr bool kinematics = true;
  static constexpr bool rod_motion = true;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
  static constexpr bool forces = true;
  static constexpr bool bearing_loads = true;
  static constexpr bool free_forces = true;
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
  static constexpr bool valve_gas = true;
  static constexpr bool cam_phasing = true;
};
struct EverythingMeasured : Everything {
  static constexpr CrankGiven crank = CrankGiven::phase;
  static constexpr PressureGiven pressure = PressureGiven::by_input;
  static constexpr bool load_ratio = false;
};

/// A bucket tappet over a plain seat; every number is a usual one.
inline ValveTrain some_train() {
  ValveTrain train;
  train.cam.max_lift_m = 6.3e-3;
  train.cam.half_angle_deg = 74;
  for (const double p : {2.0, 10.0, 18.0, 26.0}) train.cam.exponents[train.cam.exponent_count++] = p;
  train.cam.full_lift_deg = 450;
  train.cam.phase_rate_deg_s = 300;
  train.rocker.kind = RockerKind::ratio;
  train.rocker.base_circle_m = 15e-3;
  train.rocker.clearance_m = 0.05e-3;
  train.rocker.ratio = 1.2;
  train.valve.valve_kg = 0.05;
  train.valve.spring_kg = 0.06;
  train.valve.spring_N_m = 40e3;
  train.valve.spring_preload_N = 200;
  train.valve.train_N_m = 1e7;
  train.valve.train_damping_ratio = 0.1;
  train.valve.guide_damping_ratio = 0.003;
  train.valve.seat_N_m = 1e8;
  train.valve.seat_damping_ratio = 0.1;
  train.valve.head_area_m2 = 5e-4;
  return train;
}

inline EngineDefinition some_engine() {
  EngineDefinition engine;
  engine.crank.bore_m = 0.095;
  engine.crank.crank_radius_m = 0.0575;
  engine.crank.rod_length_m = 0.21;
  engine.crank.compression_ratio = 19;
  engine.masses.piston_kg = 0.81;
  engine.masses.rod_small_end_kg = 0.505;
  engine.masses.rod_big_end_kg = 1.382;
  engine.layout.cylinders = 2;
  engine.layout.firing_deg[1] = 360;
  engine.pressure.source = PressureSource::wiebe;
  engine.pressure.wiebe.net_mep_Pa = 809.7e3;
  engine.train_count = 1;
  engine.trains[0] = some_train();
  return engine;
}

/// An engine on tables of its own; built once, for building takes long.
template <class Real, class S>
struct Rig {
  std::unique_ptr<TableStorage<Real, S>> tables = std::make_unique<TableStorage<Real, S>>();
  Engine<Real, S> engine;

  explicit Rig(const EngineDefinition& definition = some_engine(), const TickOptions& options = {100e-6, {}}) {
    must(tables->build(definition, options).ok() && engine.init(tables->tables()).ok(), "a usual engine is accepted");
  }
};

template <class Real, class S>
void must_be_finite(const Output<Real, S>& out) {
  target_check::FiniteCheck check;
  target_check::each_number(check, out);
  must(check.finite(), "every output is finite");
}

}  // namespace crankloop::fuzz
