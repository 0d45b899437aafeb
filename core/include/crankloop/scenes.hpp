// The scenes that are compiled into the library, so that they link without a translation unit of your own.
//
// What belongs here: common needs with any number of cylinders. What does not: one product's scene (crankloop_add_scene
// makes it a library of its own, smaller and faster because its counts are exact).
#pragma once

#include <crankloop/engine.hpp>

namespace crankloop::scenes {

/// Everything there is but trigger wheels: the program and comparisons use it.
struct Whole : Scene {
  static constexpr Count cylinders = up_to<kMaxCylinders>;
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
  static constexpr Count trains = up_to<kMaxTrains>;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
  static constexpr bool valve_gas = true;
  static constexpr bool cam_phasing = true;
  static constexpr bool bad_input_count = true;
};

/// Where the pistons are, at an angle that the caller measured.
struct MeasuredMotion : Scene {
  static constexpr Count cylinders = up_to<kMaxCylinders>;
  static constexpr CrankGiven crank = CrankGiven::phase;
  static constexpr bool kinematics = true;
  static constexpr bool rod_motion = true;
};

/// Torque from the definition's diagram and a load ratio: a torque model.
struct TorqueByTable : Scene {
  static constexpr Count cylinders = up_to<kMaxCylinders>;
  static constexpr PressureGiven pressure = PressureGiven::by_table;
  static constexpr bool load_ratio = true;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
};

/// Torque from measured pressures: a torque sensor.
struct TorqueByPressure : Scene {
  static constexpr Count cylinders = up_to<kMaxCylinders>;
  static constexpr PressureGiven pressure = PressureGiven::by_input;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
};

/// The crank turned by gas, friction, load and starter: the engine in a loop with its controller.
struct FreeRunning : Scene {
  static constexpr Count cylinders = up_to<kMaxCylinders>;
  static constexpr CrankGiven crank = CrankGiven::torque;
  static constexpr PressureGiven pressure = PressureGiven::by_table;
  static constexpr bool load_ratio = true;
  static constexpr bool rod_inertia = true;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
  static constexpr bool starter = true;
  static constexpr bool cylinder_cut = true;
  static constexpr bool misfire = true;
  static constexpr Count triggers = up_to<kMaxTriggerWheels>;
  static constexpr std::uint32_t wheel_faults = 8;
  static constexpr std::uint32_t trigger_edges = 32;
};

/// All of Whole where the cylinders breathe: behind a throttle, with the fuel that each is given.
struct Breathing : Whole {
  static constexpr PressureGiven pressure = PressureGiven::by_gas;
  static constexpr Manifold manifold = Manifold::throttle;
  static constexpr bool boundaries = true;
  static constexpr bool crevice = true;
  static constexpr bool runners = true;
  static constexpr bool walls = true;
  static constexpr bool charge_burn = true;
  static constexpr bool knock = true;
  static constexpr std::uint32_t lambda_parcels = 32;
  static constexpr Combustion combustion = Combustion::by_input;
  static constexpr bool gas_results = true;
  static constexpr bool load_ratio = false;
};

/// FreeRunning of an engine with gas exchange: its controller sets throttle, fuel and spark.
struct BreathingFree : FreeRunning {
  static constexpr PressureGiven pressure = PressureGiven::by_gas;
  static constexpr Manifold manifold = Manifold::throttle;
  static constexpr bool controller_names = true;
  static constexpr bool sensor_faults = true;
  static constexpr bool boundaries = true;
  static constexpr bool crevice = true;
  static constexpr bool runners = true;
  static constexpr bool walls = true;
  static constexpr bool charge_burn = true;
  static constexpr bool knock = true;
  static constexpr std::uint32_t lambda_parcels = 32;
  static constexpr Combustion combustion = Combustion::by_input;
  static constexpr bool gas_results = true;
  static constexpr bool load_ratio = false;
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr Count trains = up_to<kMaxTrains>;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_gas = true;
};

}  // namespace crankloop::scenes

namespace crankloop {

extern template class Engine<float, scenes::Whole>;
extern template class Engine<double, scenes::Whole>;
extern template class Engine<float, scenes::MeasuredMotion>;
extern template class Engine<double, scenes::MeasuredMotion>;
extern template class Engine<float, scenes::TorqueByTable>;
extern template class Engine<double, scenes::TorqueByTable>;
extern template class Engine<float, scenes::TorqueByPressure>;
extern template class Engine<double, scenes::TorqueByPressure>;
extern template class Engine<float, scenes::FreeRunning>;
extern template class Engine<double, scenes::FreeRunning>;
extern template class Engine<float, scenes::Breathing>;
extern template class Engine<double, scenes::Breathing>;
extern template class Engine<float, scenes::BreathingFree>;
extern template class Engine<double, scenes::BreathingFree>;

}  // namespace crankloop
