// The scenes whose cost the README states.
//
// What belongs here: one scene per typical use, for four cylinders. What does not: the ready-made ones (tick/scenes.hpp).
#pragma once

#include <crankloop/tick/scene.hpp>

/// The README's own: a torque model that a controller asks for the torque of the last tick.
struct MeanTorque : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto pressure = crankloop::PressureGiven::by_table;
  static constexpr bool mean_torque = true;
};

/// The same with the throttle: torque at the tick and over it, at any load.
struct TorqueByLoad : MeanTorque {
  static constexpr bool load_ratio = true;
  static constexpr bool torque = true;
};

/// Where the pistons are.
struct Motion : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr bool kinematics = true;
};

/// A torque sensor: measured pressures in, torque out.
struct TorqueSensor : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto crank = crankloop::CrankGiven::phase;
  static constexpr auto pressure = crankloop::PressureGiven::by_input;
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

/// All groups there are.
struct Everything : ForcesAndTorque {
  static constexpr bool load_ratio = true;
  static constexpr bool rod_inertia = true;
  static constexpr bool rod_motion = true;
  static constexpr bool bearing_loads = true;
  static constexpr bool free_forces = true;
};

/// All groups there are, for any number of cylinders: what exact counts save.
struct EverythingUpTo16 : Everything {
  static constexpr auto cylinders = crankloop::up_to<16>;
};
