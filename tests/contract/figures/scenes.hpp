// Variants of the example scenes whose cost the README states beside theirs.
//
// What belongs here: what one more question costs. What does not: one scene per kind of use (../scenes/scenes.hpp), the
// ready-made ones (scenes.hpp).
#pragma once

#include <crankloop/scene.hpp>

#include "../scenes/scenes.hpp"

/// The torque model with the throttle: torque at the tick and over it, at any load.
struct TorqueByLoad : TorqueOnly {
  static constexpr bool load_ratio = true;
  static constexpr bool torque = true;
};

/// A torque sensor: measured pressures in, torque out.
struct TorqueSensor : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto crank = crankloop::CrankGiven::phase;
  static constexpr auto pressure = crankloop::PressureGiven::by_input;
  static constexpr bool mean_torque = true;
};

/// All groups that are not of valves.
struct Everything : ForcesAndTorque {
  static constexpr bool load_ratio = true;
  static constexpr bool rod_inertia = true;
  static constexpr bool rod_motion = true;
  static constexpr bool bearing_loads = true;
  static constexpr bool free_forces = true;
};

/// The same for any number of cylinders: what exact counts save.
struct EverythingUpTo16 : Everything {
  static constexpr auto cylinders = crankloop::up_to<16>;
};

/// An engine that breathes through its valves: throttle, fuel and burn in, torque out.
struct Breathing : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto trains = crankloop::exactly<2>;
  static constexpr auto pressure = crankloop::PressureGiven::by_gas;
  static constexpr auto manifold = crankloop::Manifold::throttle;
  static constexpr auto combustion = crankloop::Combustion::by_input;
  static constexpr auto valves = crankloop::ValveModel::following;
  static constexpr bool torque = true;
};
