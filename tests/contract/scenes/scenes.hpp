// Seven scenes of a four-cylinder engine with two valve trains and two trigger wheels, from the smallest to the whole:
// examples of what a scene says, what the contract tests audit, and, but for the wheels, what
// docs/measurements/host.md measures.
//
// What belongs here: one scene per kind of use. What does not: variants of them (figures/scenes.hpp), the ready-made
// ones (scenes.hpp).
#pragma once

#include <crankloop/scene.hpp>

/// Kinematics only: where the pistons are, how fast, and their acceleration.
struct PistonMotion : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr bool kinematics = true;
};

/// Torque only: the README's torque model, averaged over the tick.
struct TorqueOnly : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto pressure = crankloop::PressureGiven::by_table;
  static constexpr bool mean_torque = true;
};

/// Motion, every force and the torque of each cylinder.
struct ForcesAndTorque : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto pressure = crankloop::PressureGiven::by_table;
  static constexpr bool kinematics = true;
  static constexpr bool forces = true;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
};

/// Valve kinematics: eight valves that follow their cams.
struct ValveLift : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto valves = crankloop::ValveModel::following;
  static constexpr auto trains = crankloop::exactly<2>;
};

/// Valve dynamics: eight elastic valves that may float and bounce.
struct ValveDynamics : ValveLift {
  static constexpr auto valves = crankloop::ValveModel::elastic;
};

/// Crank and cam signals: what a controller in the loop decodes.
struct TriggerSignals : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto triggers = crankloop::exactly<2>;
  static constexpr std::uint32_t trigger_edges = 4;
};

/// The whole engine: all groups there are but wheels.
struct WholeEngine : ForcesAndTorque {
  static constexpr bool load_ratio = true;
  static constexpr bool rod_inertia = true;
  static constexpr bool rod_motion = true;
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
};
