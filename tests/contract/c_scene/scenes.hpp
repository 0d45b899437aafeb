// Scenes of a product: everything, little, measured inputs, and an engine that breathes.
#pragma once

#include <crankloop/scene.hpp>

struct AllOfIt : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
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
  static constexpr auto valves = crankloop::ValveModel::elastic;
  static constexpr auto trains = crankloop::exactly<2>;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
  static constexpr bool valve_gas = true;
  static constexpr bool cam_phasing = true;
  static constexpr bool bad_input_count = true;
  static constexpr auto triggers = crankloop::exactly<2>;
  static constexpr std::uint32_t trigger_edges = 3;
};

struct TorqueOnly : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto pressure = crankloop::PressureGiven::by_table;
  static constexpr bool torque = true;
};

struct Turned : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto crank = crankloop::CrankGiven::torque;
  static constexpr auto pressure = crankloop::PressureGiven::by_table;
  static constexpr bool load_ratio = true;
  static constexpr bool torque = true;
  static constexpr bool starter = true;
  static constexpr bool cylinder_cut = true;
};

struct Sensor : crankloop::Scene {
  static constexpr auto cylinders = crankloop::up_to<6>;
  static constexpr auto crank = crankloop::CrankGiven::phase;
  static constexpr auto pressure = crankloop::PressureGiven::by_input;
  static constexpr bool mean_torque = true;
};

struct Breathes : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto crank = crankloop::CrankGiven::torque;
  static constexpr auto pressure = crankloop::PressureGiven::by_gas;
  static constexpr auto manifold = crankloop::Manifold::throttle;
  static constexpr auto combustion = crankloop::Combustion::by_input;
  static constexpr bool gas_results = true;
  static constexpr auto valves = crankloop::ValveModel::elastic;
  static constexpr auto trains = crankloop::exactly<2>;
  static constexpr bool valve_gas = true;
  static constexpr bool torque = true;
  static constexpr bool starter = true;
};
