// What comes out of a step: only the groups that the scene asked for; reading another does not compile.
//
// What belongs here: what outputs mean. What does not: how they come about (tick/step.hpp). Edges of trigger wheels:
// tick/trigger/trigger_output.hpp; results of valves: tick/valve/valve_results.hpp; of cams:
// tick/valve/contact_results.hpp.
#pragma once

#include <cstdint>

#include <crankloop/phase.hpp>
#include <crankloop/scene.hpp>
#include <crankloop/tables/gas_tables.hpp>
#include <crankloop/tick/gas/gas_results.hpp>
#include <crankloop/tick/trigger/trigger_output.hpp>
#include <crankloop/tick/valve/contact_results.hpp>
#include <crankloop/tick/valve/valve_results.hpp>

namespace crankloop {

/// Forces of one cylinder: docs/model.md "Forces".
template <class Real>
struct CylinderForces {
  Real pressure_Pa;         ///< absolute
  Real gas_force_N;         ///< P_g, positive toward the crankshaft
  Real inertia_force_N;     ///< P_j, reciprocating masses
  Real total_force_N;       ///< P = P_g + P_j
  Real side_force_N;        ///< N, on the cylinder wall
  Real rod_force_N;         ///< S = P / cos b, along the rod; a rod's couple has no part in it
  Real radial_force_N;      ///< K, at the crank pin, positive toward the crank centre
  Real tangential_force_N;  ///< T, at the crank pin, positive with the rotation
  Real torque_Nm;           ///< M = T r
  Real tilting_moment_Nm;   ///< on the engine block about the crank axis
};

/// One free force and its moment about the middle of the crankshaft. Up is bank angle 0, lateral a quarter turn on in
/// the sense of rotation.
template <class Real>
struct FreeForce {
  Real up_N;
  Real lateral_N;
  Real pitch_Nm;  ///< sum of position times force up
  Real yaw_Nm;    ///< sum of position times force lateral
};

namespace group {

template <class Real>
struct TheoreticalLift {
  Real theoretical_lift_m;  ///< of the cam, not below 0
};
template <class Real>
struct LiftAndVelocity {
  Real lift_m;  ///< from the closed, preloaded valve
  Real velocity_m_s;
};
template <class Real>
struct ValveAcceleration {
  Real acceleration_m_s2;
};

}  // namespace group

/// Motion of one valve (of all that are alike in a cylinder and train).
template <class Real, class S>
struct ValveMotionOutput : detail::If<S::theoretical_lift, group::TheoreticalLift<Real>>,
                           group::LiftAndVelocity<Real>,
                           detail::If<S::valve_acceleration, group::ValveAcceleration<Real>> {};

/// Forces of one elastic valve.
template <class Real>
struct ValveForcesOutput {
  Real train_N;  ///< between train and valve, pushing
  Real seat_N;
  Real tip_N;  ///< at the stem: the train's less the rocker's inertia; negative = the single mass would pull
  Real cam_N;  ///< between cam and pad: rocker ratio times the train's
  Real train_compression_m;  ///< train lift less valve lift; negative: clearance
  std::uint32_t regime;      ///< 0 free, 1 train, 2 seat, 3 both
};

/// Forces of a valve's springs together, where they surge.
template <class Real>
struct ValveSpringOutput {
  Real surge_N;   ///< on the valve, toward its seat, beyond preload and rate
  Real moving_N;  ///< on the valve, toward its seat: preload, rate and surge
  Real fixed_N;   ///< on the head, where the springs are fixed
};

// The groups of outputs, each a base of Output where the scene asks for it.
/// The gas of one cylinder at the end of the tick; flows and heat are means over it.
template <class Real>
struct CylinderGasOutput {
  Real pressure_Pa;  ///< absolute
  Real temperature_K;
  Real mass_kg;
  Real burned_ratio;
  Real flow_kg_s[kPorts];  ///< into the cylinder, through kIntake and kExhaust
  Real wall_heat_W;        ///< to the walls
};
/// Crevices of one cylinder.
template <class Real>
struct CreviceOutput {
  Real mass_kg;       ///< in them, at the end of the tick
  Real blow_by_kg_s;  ///< into the crankcase, mean over the tick; negative: back
};
/// Runners of one cylinder at the end of the tick. Of a port without one: the manifold's pressure at the begin of the
/// last step, and 0.
template <class Real>
struct RunnerOutput {
  Real port_pressure_Pa[kPorts];
  Real flow_kg_s[kPorts];  ///< toward the cylinder, from kIntake's and kExhaust's manifold
};
/// The burn of a cycle, as the charge had it; zero where nothing burned.
template <class Real>
struct ChargeBurnOutput {
  Real start_deg;
  Real duration_deg;
};
template <class Real>
struct ManifoldOutput {
  Real pressure_Pa;
  Real temperature_K;
  Real burned_ratio;
};

namespace group {

/// Motion of each piston, positive toward the crankshaft, counted from top dead centre.
template <class Real, class S>
struct Kinematics {
  Real displacement_m[S::cylinders.capacity];
  Real velocity_m_s[S::cylinders.capacity];
  Real acceleration_m_s2[S::cylinders.capacity];
};

/// Motion of each rod about its piston pin.
template <class Real, class S>
struct RodMotion {
  Real rod_angle_rad[S::cylinders.capacity];
  Real rod_speed_rad_s[S::cylinders.capacity];
  Real rod_acceleration_rad_s2[S::cylinders.capacity];
};

/// How the crank moves where the speed is not given. At the end of the tick, with this tick's inputs:
///
///     J_eff acceleration = torque_Nm + starter_Nm - friction_Nm - external_torque_Nm,    torque_Nm as below
///
/// With cam_drag less half of camshaft_Nm, as it was at the end of the tick before.
template <class Real>
struct CrankMotion {
  Phase crank;       ///< 0 = cylinder 1's firing top dead centre
  Real speed_rad_s;  ///< negative = backwards
  Real acceleration_rad_s2;
  Real friction_Nm;  ///< friction and brake, positive against forward rotation; at standstill what they hold against
};
template <class Real>
struct StarterTorque {
  Real starter_Nm;
};

/// At the end of the tick, of gas and masses at the crank speed w then: P dx/da - dM db/da with the masses' parts that
/// go with w^2. Where forces make the speed, what masses take to be accelerated with the crank is in J_eff, not here,
/// but it is in CylinderForces::torque_Nm.
template <class Real>
struct Torque {
  Real torque_Nm;  ///< on the crankshaft, all cylinders
};
template <class Real>
struct MeanTorque {
  Real mean_torque_Nm;  ///< averaged over the angle turned in the tick: the work done divided by it
};

template <class Real, class S>
struct Forces {
  CylinderForces<Real> cylinder[S::cylinders.capacity];
};

/// Loads of crank pins and main journals in the frame that turns with the crankshaft.
template <class Real, class S>
struct BearingLoads {
  Real pin_radial_N[S::cylinders.capacity];          ///< toward the crank centre
  Real pin_tangential_N[S::cylinders.capacity];      ///< with the rotation
  Real pin_load_N[S::cylinders.capacity];            ///< magnitude
  Real journal_along_N[S::cylinders.capacity + 1];   ///< along the throw of pin 0, outward
  Real journal_across_N[S::cylinders.capacity + 1];  ///< a quarter turn further in the sense of rotation
  Real journal_load_N[S::cylinders.capacity + 1];
};

template <class Real>
struct FreeForces {
  FreeForce<Real> first;     ///< of the reciprocating masses, first order
  FreeForce<Real> second;    ///< of the reciprocating masses, second order
  FreeForce<Real> rotating;  ///< centrifugal
};

/// [train][cylinder]
template <class Real, class S>
struct Valves {
  ValveMotionOutput<Real, S> valve[S::trains.capacity][S::cylinders.capacity];
};

template <class Real, class S>
struct ValveForces {
  ValveForcesOutput<Real> valve_forces[S::trains.capacity][S::cylinders.capacity];
};

template <class Real, class S>
struct ValveSpringForces {
  ValveSpringOutput<Real> valve_spring[S::trains.capacity][S::cylinders.capacity];
};

template <class Real, class S>
struct CylinderGases {
  CylinderGasOutput<Real> cylinder_gas[S::cylinders.capacity];
};
template <class Real, class S>
struct Crevices {
  CreviceOutput<Real> crevice[S::cylinders.capacity];
};
template <class Real, class S>
struct Runners {
  RunnerOutput<Real> runner[S::cylinders.capacity];
};
template <class Real, class S>
struct WarmWalls {
  Real wall_K[S::cylinders.capacity];  ///< of each cylinder's walls, at the end of the tick
  Real port_heat_W[kPorts];            ///< of the gas to the walls of manifolds, or of all runners; mean over the tick
};
template <class Real>
struct Manifolds {
  ManifoldOutput<Real> manifold[kPorts];  ///< kIntake, kExhaust
  Real throttle_kg_s;                     ///< into the intake manifold, mean over the tick
  Real outlet_kg_s;                       ///< out of the exhaust manifold
};
/// Results of each cylinder's last whole cycle; zero until there is one.
template <class Real, class S>
struct GasResults {
  GasCycle<Real> gas_cycle[S::cylinders.capacity];
};

/// Result of each cylinder's last whole cycle, as GasResults.
template <class Real, class S>
struct BlowByResults {
  Real cycle_blow_by_kg[S::cylinders.capacity];
};
/// Of each cylinder's last whole cycle with an octane number; zero until there is one, and where nothing burned.
template <class Real, class S>
struct KnockResults {
  Real knock_integral[S::cylinders.capacity];  ///< 1 and above: the unburned gas ignites by itself
  Real knock_deg[S::cylinders.capacity];       ///< where it passed 1; 0: it did not
};
template <class Real, class S>
struct ChargeBurnResults {
  ChargeBurnOutput<Real> cycle_burn[S::cylinders.capacity];
};

struct SensorFaultsOn {
  std::uint32_t sensor_faults_on;  ///< bit i: fault i of the definition's sensors is on
};
/// What a controller reads of its sensors: MAP in Pa, IAT in K, TPS, lambda, CLT in K.
template <class Real>
struct FaultySensors {
  Real faulty_sensor[kControllerSensors];  ///< the healthy values where no fault is on
};
/// Lambda as the definition's sensor has it; 0 without one. Air has kMaxExcessAir_ratio.
template <class Real>
struct ExhaustLambda {
  Real exhaust_excess_air_ratio;  ///< of the exhaust manifold: air, free and bound, over what its fuel wants, burned or
                                  ///< not
  Real sensor_excess_air_ratio;   ///< shown by the sensor
};
/// Of the gas that left each cylinder in its last whole cycle.
template <class Real, class S>
struct OutflowLambda {
  Real outflow_excess_air_ratio[S::cylinders.capacity];
};

/// Constant. A step does not write it.
template <class Real>
struct Coolant {
  Real coolant_K;  ///< that the cylinders' walls give heat to; 0: the engine has none
};

}  // namespace group

template <class Real, class S>
struct Output : detail::If<detail::Needs<S>::crank_dynamics, group::CrankMotion<Real>>,
                detail::If<S::starter, group::StarterTorque<Real>>,
                detail::If<S::kinematics, group::Kinematics<Real, S>>,
                detail::If<S::rod_motion, group::RodMotion<Real, S>>,
                detail::If<S::torque, group::Torque<Real>>,
                detail::If<S::mean_torque, group::MeanTorque<Real>>,
                detail::If<S::forces, group::Forces<Real, S>>,
                detail::If<S::bearing_loads, group::BearingLoads<Real, S>>,
                detail::If<S::free_forces, group::FreeForces<Real>>,
                detail::If<detail::Needs<S>::gas, group::CylinderGases<Real, S>>,
                detail::If<S::crevice, group::Crevices<Real, S>>,
                detail::If<S::runners, group::Runners<Real, S>>,
                detail::If<S::walls, group::WarmWalls<Real, S>>,
                detail::If<detail::Needs<S>::manifolds, group::Manifolds<Real>>,
                detail::If<S::gas_results, group::GasResults<Real, S>>,
                detail::If<S::crevice && S::gas_results, group::BlowByResults<Real, S>>,
                detail::If<detail::Needs<S>::charge_burn && S::gas_results, group::ChargeBurnResults<Real, S>>,
                detail::If<detail::Needs<S>::knock, group::KnockResults<Real, S>>,
                detail::If<detail::Needs<S>::lambda, group::ExhaustLambda<Real>>,
                detail::If<detail::Needs<S>::lambda && S::gas_results, group::OutflowLambda<Real, S>>,
                detail::If<detail::Needs<S>::any_valves, group::Valves<Real, S>>,
                detail::If<S::valve_forces, group::ValveForces<Real, S>>,
                detail::If<detail::Needs<S>::spring_forces, group::ValveSpringForces<Real, S>>,
                detail::If<S::valve_results, group::ValveResults<Real, S>>,
                detail::If<S::cam_contact, group::CamContacts<Real, S>>,
                detail::If<S::cam_torque, group::CamTorques<Real, S>>,
                detail::If<S::sensor_faults, group::SensorFaultsOn>,
                detail::If<S::sensor_faults, group::FaultySensors<Real>>,
                detail::If<detail::Needs<S>::faulty_wheels, group::WheelFaultsOn>,
                detail::If<detail::Needs<S>::any_triggers, group::Triggers<Real, S>>,
                detail::If<detail::Needs<S>::faulty_wheels, group::FaultyTriggers<Real, S>>,
                detail::If<detail::Needs<S>::reluctor, group::ReluctorSignal<Real, S>>,
                detail::If<S::controller_names && S::walls, group::Coolant<Real>> {
  std::uint32_t faults;  ///< Fault bits of this tick
};

}  // namespace crankloop
