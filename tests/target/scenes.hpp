// The scenes whose results and costs are watched on every target, from the least to all.
//
// What belongs here: one scene per typical use, for four cylinders with an intake and an exhaust valve each.
#pragma once

#include <crankloop/scene.hpp>

namespace target_scenes {

/// Torque at the tick from pressures that the caller measures.
struct TorqueOfPressures : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto pressure = crankloop::PressureGiven::by_input;
  static constexpr bool torque = true;
};

/// Torque at the tick from the engine file's pressures.
struct TorqueOfTables : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto pressure = crankloop::PressureGiven::by_table;
  static constexpr bool torque = true;
};

/// Torque averaged over the tick: README.md's loop.
struct MeanTorque : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto pressure = crankloop::PressureGiven::by_table;
  static constexpr bool mean_torque = true;
};

/// A torque sensor: measured angle and pressures in, the last tick's torque out.
struct TorqueSensor : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto crank = crankloop::CrankGiven::phase;
  static constexpr auto pressure = crankloop::PressureGiven::by_input;
  static constexpr bool mean_torque = true;
};

/// Motion, every force and the torque of each cylinder.
struct Forces : crankloop::Scene {
  static constexpr auto cylinders = crankloop::exactly<4>;
  static constexpr auto pressure = crankloop::PressureGiven::by_table;
  static constexpr bool kinematics = true;
  static constexpr bool forces = true;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
};

/// Eight valves that do as their cams say.
struct FollowingValves : TorqueOfTables {
  static constexpr auto valves = crankloop::ValveModel::following;
  static constexpr auto trains = crankloop::exactly<2>;
};

/// Eight valves with inertia, float and bounce.
struct ElasticValves : TorqueOfTables {
  static constexpr auto valves = crankloop::ValveModel::elastic;
  static constexpr auto trains = crankloop::exactly<2>;
};

/// The engine that a controller is tested against: gas, friction and load turn the crank, and a crank and a cam wheel
/// tell where it is.
struct ClosedLoop : TorqueOfTables {
  static constexpr auto crank = crankloop::CrankGiven::torque;
  static constexpr bool load_ratio = true;
  static constexpr bool starter = true;
  static constexpr bool cylinder_cut = true;
  static constexpr auto triggers = crankloop::exactly<2>;
};

/// An engine that breathes through elastic valves, behind a throttle, and turns its crank.
struct Breathing : ElasticValves {
  static constexpr auto pressure = crankloop::PressureGiven::by_gas;
  static constexpr auto crank = crankloop::CrankGiven::torque;
  static constexpr auto manifold = crankloop::Manifold::throttle;
  static constexpr auto combustion = crankloop::Combustion::by_input;
  static constexpr bool gas_results = true;
  static constexpr bool valve_gas = true;
  static constexpr bool mean_torque = true;
  static constexpr bool starter = true;
  static constexpr bool cylinder_cut = true;
};

/// The same without dynamics and fuel, between manifolds that are given.
struct Motored : FollowingValves {
  static constexpr auto pressure = crankloop::PressureGiven::by_gas;
};

/// With all that its gas does, at a given speed.
struct Fired : Motored {
  static constexpr auto manifold = crankloop::Manifold::throttle;
  static constexpr auto combustion = crankloop::Combustion::by_input;
  static constexpr bool gas_results = true;
};

/// All there is, for up to four cylinders with up to two trains.
struct Everything : Forces {
  static constexpr auto cylinders = crankloop::up_to<4>;
  static constexpr bool load_ratio = true;
  static constexpr bool rod_inertia = true;
  static constexpr bool rod_motion = true;
  static constexpr bool bearing_loads = true;
  static constexpr bool free_forces = true;
  static constexpr auto valves = crankloop::ValveModel::elastic;
  static constexpr auto trains = crankloop::up_to<2>;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
  static constexpr bool valve_gas = true;
  static constexpr bool cam_phasing = true;
};

// One more group each: what it costs beside the scene without.

struct SurgingValves : ElasticValves {
  static constexpr std::uint32_t spring_modes = 2;
};
struct CamContactValves : ElasticValves {
  static constexpr bool cam_contact = true;
};
struct CamTorqueValves : ElasticValves {
  static constexpr bool cam_torque = true;
};
struct FiredCrevice : Fired {
  static constexpr bool crevice = true;
};
struct FiredRunners : Fired {
  static constexpr bool runners = true;
};
struct FiredWalls : Fired {
  static constexpr bool walls = true;
};
struct FiredKnock : Fired {
  static constexpr bool knock = true;
};
struct FiredChargeBurn : Fired {
  static constexpr bool charge_burn = true;
};
struct FiredLambda : Fired {
  static constexpr std::uint32_t lambda_parcels = 32;
};
struct FiredSensors : Fired {
  static constexpr bool controller_names = true;
  static constexpr bool sensor_faults = true;
};

/// The same scene with all that it can show of its valves' motion.
template <class S>
struct ShowingValves : S {
  static constexpr bool theoretical_lift = S::valves != crankloop::ValveModel::none;
  static constexpr bool valve_acceleration = theoretical_lift;
};

/// The same scene for the 125, which has one cylinder and one train: an exact scene takes no other number.
template <class S>
struct OfTheSingle : S {
  static constexpr auto cylinders = S::cylinders.exact ? crankloop::exactly<1> : S::cylinders;
  static constexpr auto trains = S::trains.exact ? crankloop::exactly<1> : S::trains;
};

}  // namespace target_scenes
