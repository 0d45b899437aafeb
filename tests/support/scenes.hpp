// The scenes that tests run, by what they are about. Not here: those that a project is built with
// (contract/*/scenes.hpp, target/scenes.hpp), as a user writes them.
//
// What belongs here: scenes. What does not: tables and engines of them (running.hpp,
// kept_engines.hpp, test_valves.hpp), definitions (engines.hpp).
#pragma once

#include <cstdint>

#include <crankloop/scene.hpp>

namespace crankloop::tick_test {

// ---- any outputs ----------------------------------------------------------------------------------------------------

struct Nothing : Scene {};

/// Output groups as bits, so that tests can walk all subsets.
enum Group : unsigned {
  kKinematics = 1,
  kRodMotion = 2,
  kTorque = 4,
  kMeanTorque = 8,
  kForces = 16,
  kBearingLoads = 32,
  kFreeForces = 64,
  kAllGroups = 127
};

/// A scene that asks for the groups in `Groups`; up to 16 cylinders unless `Exactly` says how many.
template <unsigned Groups, PressureGiven Source = PressureGiven::by_table, bool ByLoad = false,
          CrankGiven Given = CrankGiven::speed, std::uint32_t Exactly = 0>
struct Asking : Scene {
  static constexpr Count cylinders = Exactly != 0 ? Count{Exactly, true} : Count{kMaxCylinders, false};
  static constexpr CrankGiven crank = Given;
  static constexpr PressureGiven pressure = Source;
  static constexpr bool load_ratio = ByLoad;
  static constexpr bool rod_inertia = true;
  static constexpr bool kinematics = (Groups & kKinematics) != 0;
  static constexpr bool rod_motion = (Groups & kRodMotion) != 0;
  static constexpr bool torque = (Groups & kTorque) != 0;
  static constexpr bool mean_torque = (Groups & kMeanTorque) != 0;
  static constexpr bool forces = (Groups & kForces) != 0;
  static constexpr bool bearing_loads = (Groups & kBearingLoads) != 0;
  static constexpr bool free_forces = (Groups & kFreeForces) != 0;
};

// ---- any numbers of cylinders and valves ----------------------------------------------------------------------------

template <std::uint32_t Cylinders, std::uint32_t Trains>
struct Sized : Scene {
  static constexpr Count cylinders = exactly<Cylinders>;
  static constexpr Count trains = exactly<Trains>;
};
template <std::uint32_t Cylinders, std::uint32_t Trains>
struct ExactForcesAndTorque : Sized<Cylinders, Trains> {
  static constexpr PressureGiven pressure = PressureGiven::by_table;
  static constexpr bool kinematics = true;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
  static constexpr bool forces = true;
  static constexpr bool bearing_loads = true;
};
template <std::uint32_t Cylinders, std::uint32_t Trains>
struct ExactValveKinematics : Sized<Cylinders, Trains> {
  static constexpr CrankGiven crank = CrankGiven::phase;
  static constexpr ValveModel valves = ValveModel::following;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool cam_phasing = true;
};
template <std::uint32_t Cylinders, std::uint32_t Trains>
struct ExactValveDynamics : Sized<Cylinders, Trains> {
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
};
/// Elastic valves, which may have a phaser, and their results.
template <std::uint32_t Cylinders, std::uint32_t Trains, bool Phasing = false, bool Results = false>
struct Elastic : Sized<Cylinders, Trains> {
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr bool valve_results = Results;
  static constexpr bool cam_phasing = Phasing;
};
/// All that makes a state larger; the parts of a state with them.
template <std::uint32_t Cylinders, std::uint32_t Trains, bool ByInput>
struct LargeState : Elastic<Cylinders, Trains, true, true> {
  static constexpr PressureGiven pressure = ByInput ? PressureGiven::by_input : PressureGiven::by_table;
  static constexpr bool load_ratio = !ByInput;
  static constexpr bool mean_torque = true;
};
template <class S>
struct WithoutResults : S {
  static constexpr bool valve_results = false;
};
template <class S>
struct WithoutValves : S {
  static constexpr ValveModel valves = ValveModel::none;
  static constexpr bool valve_results = false;
  static constexpr bool cam_phasing = false;
};
template <std::uint32_t Cylinders, bool Exact>
struct Pistons : Scene {
  static constexpr Count cylinders{Cylinders, Exact};
  static constexpr bool kinematics = true;
  static constexpr bool torque = true;
  static constexpr bool rod_inertia = true;
};
struct ForcesWithoutRodInertia : Scene {
  static constexpr auto cylinders = up_to<16>;
  static constexpr bool forces = true;
};

// ---- the crank turned by forces, cylinders cut ----------------------------------------------------------------------

/// A scene whose crank is turned by forces; with all its groups, unless told otherwise.
template <PressureGiven Source = PressureGiven::by_table, std::uint32_t Cylinders = 0>
struct TurnedByForces : Scene {
  static constexpr Count cylinders = Cylinders != 0 ? Count{Cylinders, true} : Count{kMaxCylinders, false};
  static constexpr CrankGiven crank = CrankGiven::torque;
  static constexpr PressureGiven pressure = Source;
  static constexpr bool load_ratio = Source == PressureGiven::by_table;
  static constexpr bool rod_inertia = true;
  static constexpr bool kinematics = true;
  static constexpr bool rod_motion = true;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
  static constexpr bool forces = true;
  static constexpr bool starter = true;
  static constexpr bool cylinder_cut = load_ratio;
};
struct TurnedWithBearings : TurnedByForces<> {
  static constexpr bool bearing_loads = true;
};
struct CutAtSpeed : Scene {
  static constexpr Count cylinders = exactly<4>;
  static constexpr PressureGiven pressure = PressureGiven::by_table;
  static constexpr bool load_ratio = true;
  static constexpr bool rod_inertia = true;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
  static constexpr bool cylinder_cut = true;
};
struct CutAtSpeedWithForces : CutAtSpeed {
  static constexpr bool forces = true;
};

// ---- a diesel with eight elastic valves -----------------------------------------------------------------------------

/// Given the speed.
struct FourWithValves : Elastic<4, 2, true, true> {
  static constexpr PressureGiven pressure = PressureGiven::by_table;
  static constexpr bool load_ratio = true;
  static constexpr bool rod_inertia = true;
  static constexpr bool kinematics = true;
  static constexpr bool torque = true;
  static constexpr bool mean_torque = true;
  static constexpr bool forces = true;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
};
/// Given the angle, and the pressures.
struct MeasuredFourWithValves : FourWithValves {
  static constexpr CrankGiven crank = CrankGiven::phase;
  static constexpr PressureGiven pressure = PressureGiven::by_input;
  static constexpr bool load_ratio = false;
  static constexpr bool valve_gas = true;
};
struct CountingFour : FourWithValves {
  static constexpr bool bad_input_count = true;
};
struct CountingMeasuredFour : MeasuredFourWithValves {
  static constexpr bool bad_input_count = true;
};
/// Its tables read at any angle, by starting there: valves at rest where their cams stand, so that every output is a
/// function of the angle alone.
struct FourAtAnAngle : FourWithValves {
  static constexpr CrankGiven crank = CrankGiven::phase;
};
struct Airless : MeasuredFourWithValves {
  static constexpr PressureGiven pressure = PressureGiven::by_table;
  static constexpr bool valve_gas = false;
};
template <class Base, bool Forces, bool Results, bool TheoreticalLift = false, bool Acceleration = false>
struct Asked : Base {
  static constexpr bool theoretical_lift = TheoreticalLift;
  static constexpr bool valve_acceleration = Acceleration;
  static constexpr bool valve_forces = Forces;
  static constexpr bool valve_results = Results;
};

// ---- one or two valves ----------------------------------------------------------------------------------------------

/// One valve, all that can be told of it.
struct OneValve : Scene {
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
};
/// What its cam bears, beside all the rest.
template <class Base = OneValve>
struct WithCamLoads : Base {
  static constexpr bool cam_contact = true;
  static constexpr bool cam_torque = true;
};
/// That alone: forces come from the valve's state.
template <class Base>
struct CamLoadsAlone : WithCamLoads<Base> {
  static constexpr bool theoretical_lift = false;
  static constexpr bool valve_acceleration = false;
  static constexpr bool valve_forces = false;
  static constexpr bool valve_results = false;
};
struct OneValveWithPhaser : OneValve {
  static constexpr bool cam_phasing = true;
};
struct OneValveOnMeasuredCrank : OneValve {
  static constexpr CrankGiven crank = CrankGiven::phase;
};
struct OneValveWithGas : OneValve {
  static constexpr PressureGiven pressure = PressureGiven::by_input;
  static constexpr bool valve_gas = true;
};
struct CamFollowing : Scene {
  static constexpr ValveModel valves = ValveModel::following;
};
struct TwoValves : Scene {
  static constexpr PressureGiven pressure = PressureGiven::by_table;
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr Count trains = exactly<2>;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
  static constexpr bool valve_gas = true;
  static constexpr bool cam_phasing = true;
};
/// All that a state may hold, of one cylinder (an odd number: arrays have a spare place): measured crank and pressures,
/// phaser.
struct MeasuredWithValves : Scene {
  static constexpr Count cylinders = exactly<1>;
  static constexpr CrankGiven crank = CrankGiven::phase;
  static constexpr PressureGiven pressure = PressureGiven::by_input;
  static constexpr bool rod_inertia = true;
  static constexpr bool mean_torque = true;
  static constexpr bool forces = true;
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
  static constexpr bool valve_gas = true;
  static constexpr bool cam_phasing = true;
  static constexpr bool bad_input_count = true;
};
struct MeasuredWithSprings : MeasuredWithValves {
  static constexpr std::uint32_t spring_modes = 3;
};
/// `Unit` makes the scene's type, and with it all that is compiled for it, the translation unit's own.
template <class Unit, std::uint32_t Cylinders, std::uint32_t Trains, bool Exact, bool Phasing>
struct Lanes : Scene {
  static constexpr Count cylinders{Cylinders, Exact};
  static constexpr Count trains{Trains, Exact};
  static constexpr CrankGiven crank = CrankGiven::phase;
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr bool cam_phasing = Phasing;
};
/// With forces and results, and with or without gas on the valves' heads.
template <class Base, bool Gas>
struct ToldLanes : Base {
  static constexpr PressureGiven pressure = Gas ? PressureGiven::by_input : PressureGiven::by_table;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
  static constexpr bool valve_gas = Gas;
};
/// With springs that surge.
template <class Base, std::uint32_t Modes>
struct SurgingLanes : Base {
  static constexpr std::uint32_t spring_modes = Modes;
};

// ---- trigger wheels -------------------------------------------------------------------------------------------------

struct OneWheel : Scene {
  static constexpr Count cylinders = exactly<4>;
  static constexpr Count triggers = exactly<1>;
};
/// Wheels at an angle that the test gives.
struct MeasuredWheels : Scene {
  static constexpr Count cylinders = exactly<4>;
  static constexpr CrankGiven crank = CrankGiven::phase;
  static constexpr Count triggers = up_to<kMaxTriggerWheels>;
  static constexpr std::uint32_t trigger_edges = 2 * kMaxTriggerEdges;
};
/// Wheels at a given speed, with little room.
struct DrivenWheels : Scene {
  static constexpr Count cylinders = exactly<4>;
  static constexpr Count triggers = up_to<kMaxTriggerWheels>;
  static constexpr std::uint32_t trigger_edges = 3;
};
struct TwoWheels : Scene {
  static constexpr Count triggers = exactly<2>;
};
/// Beside a cam with a phaser.
struct PhasedWheels : Scene {
  static constexpr Count cylinders = exactly<1>;
  static constexpr ValveModel valves = ValveModel::following;
  static constexpr Count trains = exactly<1>;
  static constexpr bool cam_phasing = true;
  static constexpr Count triggers = exactly<2>;
};
struct FinelyPhasedWheel : PhasedWheels {
  static constexpr std::uint32_t trigger_edges = 720;
  static constexpr Count triggers = exactly<1>;
};
/// The speed may change within a tick, as where it is integrated.
struct BentSpeed : Scene {
  static constexpr Count cylinders = exactly<1>;
  static constexpr CrankGiven crank = CrankGiven::torque;
  static constexpr ValveModel valves = ValveModel::following;
  static constexpr Count trains = exactly<1>;
  static constexpr bool cam_phasing = true;
  static constexpr Count triggers = exactly<kMaxTriggerWheels>;
  static constexpr std::uint32_t trigger_edges = 2 * kMaxTriggerEdges;
};

// ---- states that mean something else --------------------------------------------------------------------------------

/// Scenes that differ from a plain one, and from one another, in what their states mean.
namespace otherwise {
struct Plain : Scene {};
struct Burning : Plain {
  static constexpr PressureGiven pressure = PressureGiven::by_gas;
  static constexpr Manifold manifold = Manifold::throttle;
  static constexpr Combustion combustion = Combustion::by_input;
};
#define OTHERWISE_THAN(Base, Name, type, answer, other) \
  struct Name : Base {                                  \
    static constexpr type answer = other;               \
  }
#define OTHERWISE(Name, type, answer, other) OTHERWISE_THAN(Plain, Name, type, answer, other)
OTHERWISE(TwoCylinders, Count, cylinders, exactly<2>);
OTHERWISE(TwoTrains, Count, trains, exactly<2>);
OTHERWISE(ByPhase, CrankGiven, crank, CrankGiven::phase);
OTHERWISE(ByLoad, CrankGiven, crank, CrankGiven::torque);
OTHERWISE(TablePressure, PressureGiven, pressure, PressureGiven::by_table);
OTHERWISE(InputPressure, PressureGiven, pressure, PressureGiven::by_input);
OTHERWISE(Following, ValveModel, valves, ValveModel::following);
OTHERWISE(Elastic, ValveModel, valves, ValveModel::elastic);
OTHERWISE(WithLoadRatio, bool, load_ratio, true);
OTHERWISE(WithRodInertia, bool, rod_inertia, true);
OTHERWISE(WithTorque, bool, torque, true);
OTHERWISE(WithMeanTorque, bool, mean_torque, true);
OTHERWISE(WithForces, bool, forces, true);
OTHERWISE(WithValveResults, bool, valve_results, true);
OTHERWISE(WithValveGas, bool, valve_gas, true);
OTHERWISE(WithCamContact, bool, cam_contact, true);
OTHERWISE(WithCamDrag, bool, cam_drag, true);
OTHERWISE(WithSpringModes, std::uint32_t, spring_modes, 1);
OTHERWISE(WithCamPhasing, bool, cam_phasing, true);
OTHERWISE(WithBadInputCount, bool, bad_input_count, true);
OTHERWISE(WithStarter, bool, starter, true);
OTHERWISE(WithCylinderCut, bool, cylinder_cut, true);
OTHERWISE(WithWheelFaults, std::uint32_t, wheel_faults, 1);
OTHERWISE_THAN(Burning, BetweenGivenManifolds, Manifold, manifold, Manifold::given);
OTHERWISE_THAN(Burning, WithoutCombustion, Combustion, combustion, Combustion::none);
OTHERWISE_THAN(Burning, WithGasResults, bool, gas_results, true);
OTHERWISE_THAN(Burning, WithBoundaries, bool, boundaries, true);
OTHERWISE_THAN(Burning, WithCrevice, bool, crevice, true);
OTHERWISE_THAN(Burning, WithRunners, bool, runners, true);
OTHERWISE_THAN(Burning, WithWalls, bool, walls, true);
OTHERWISE_THAN(Burning, WithChargeBurn, bool, charge_burn, true);
OTHERWISE_THAN(Burning, WithKnock, bool, knock, true);
OTHERWISE_THAN(Burning, WithSensorFaults, bool, sensor_faults, true);
OTHERWISE_THAN(Burning, WithLambda, std::uint32_t, lambda_parcels, 8);
OTHERWISE_THAN(Burning, WithMoreParcels, std::uint32_t, lambda_parcels, 16);
OTHERWISE_THAN(Burning, WithMisfire, bool, misfire, true);
#undef OTHERWISE
#undef OTHERWISE_THAN
}  // namespace otherwise

}  // namespace crankloop::tick_test
