// Scenes that between them run every line of the tick.
#pragma once

#include <crankloop/scene.hpp>

struct Everything : crankloop::Scene {
  static constexpr auto cylinders = crankloop::up_to<16>;
  static constexpr auto pressure = crankloop::PressureGiven::by_table;
  static constexpr bool load_ratio = true;
  static constexpr bool rod_inertia = true;
  static constexpr bool kinematics = true;
  static constexpr bool rod_motion = true;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
  static constexpr bool forces = true;
  static constexpr bool bearing_loads = true;
  static constexpr bool free_forces = true;
};

struct TorqueOnly : crankloop::Scene {
  static constexpr auto cylinders = crankloop::up_to<16>;
  static constexpr auto pressure = crankloop::PressureGiven::by_table;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
};

struct MeasuredPhaseAndPressure : crankloop::Scene {
  static constexpr auto cylinders = crankloop::up_to<16>;
  static constexpr auto crank = crankloop::CrankGiven::phase;
  static constexpr auto pressure = crankloop::PressureGiven::by_input;
  static constexpr bool rod_inertia = true;
  static constexpr bool mean_torque = true;
  static constexpr bool forces = true;
};

/// Valves that float and bounce, move with a phaser, and feel the gas on their heads.
struct ElasticValves : crankloop::Scene {
  static constexpr auto cylinders = crankloop::up_to<16>;
  static constexpr auto pressure = crankloop::PressureGiven::by_table;
  static constexpr bool load_ratio = true;
  static constexpr auto valves = crankloop::ValveModel::elastic;
  static constexpr auto trains = crankloop::up_to<crankloop::kMaxTrains>;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
  static constexpr bool valve_gas = true;
  static constexpr bool cam_phasing = true;
};
