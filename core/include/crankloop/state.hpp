// What an engine remembers from tick to tick: all that a run needs to go on. For bytes: tick/state/saved_state.hpp.
#pragma once

#include <cstddef>
#include <cstdint>

#include <crankloop/misfire_record.hpp>
#include <crankloop/phase.hpp>
#include <crankloop/scene.hpp>
#include <crankloop/tables/curve.hpp>
#include <crankloop/tables/sensor_tables.hpp>
#include <crankloop/tick/gas/gas_results.hpp>
#include <crankloop/tick/gas/gas_state.hpp>
#include <crankloop/tick/valve/contact_results.hpp>
#include <crankloop/tick/valve/valve_results.hpp>

namespace crankloop {

namespace detail {

/// Cams that turn alike: all of an engine, or those of each train where phasers turn them.
template <class S>
inline constexpr std::uint32_t kCamGroups = S::cam_phasing ? S::trains.capacity : 1;

}  // namespace detail

namespace detail {

/// What a fault of a sensor remembers of its value.
template <class Real>
struct SensorState {
  Real held;  ///< when it came
  Real late, lagged, lagged_rest;
  Real sample[kDelayedSamples];
  std::uint32_t oldest;
  std::uint32_t ticks_left;  ///< to the next sample
  std::uint32_t random;
  std::uint32_t fault;  ///< that is on; kMaxSensorFaults: none
};

}  // namespace detail

// The groups of the state, each a base of State where the scene needs it.
namespace group {

/// What a tick's work is counted from: of the tick before, the work done so far and the torque then, for each part that
/// may be scaled by itself.
template <class Real, class S>
struct WorkState {
  static constexpr bool by_load = detail::Needs<S>::load;
  static constexpr bool by_input = detail::Needs<S>::input_pressure;
  detail::Integral<Real> inertia;               ///< per w^2, sum over cylinders
  detail::Integral<Real> gas[by_load ? 2 : 1];  ///< full, or motored and heat; sum over cylinders
  detail::Integral<Real> stroke[by_input ? S::cylinders.capacity : 1];  ///< per mechanism
  Real torque_Nm;
  Real spare;  ///< keeps the size a multiple of eight: no padding
};

/// Everything a run needs to go on: no pointer, no padding. Copying it is a snapshot.
template <class Real>
struct StateCore {
  std::uint64_t fingerprint = 0;  ///< of the tables it belongs to
  Phase phase{};
  std::uint64_t ticks = 0;
  Real speed_rad_s = 0;  ///< last good
  Real load_ratio = 1;   ///< last good
};
/// What a crank that is turned by forces remembers: docs/model.md "Crank dynamics".
template <class Real>
struct CrankState {
  Real reduced_speed = 0;        ///< u = w sqrt(J_eff), a quantity whose square is twice the kinetic energy; sqrt(J)
  Real reduced_rest = 0;         ///< what rounding left out of it
  Real per_root_inertia = 1;     ///< 1 / sqrt(J_eff) where the crank stands
  Real inertia_slope_kg_m2 = 0;  ///< torque of masses per w^2 there
  Real gas_Nm[2] = {};           ///< gas torque there: as in WorkState::gas, of pressures given in [0]
  Real lag_rad_s = 0;            ///< by how much the last tick should have turned faster
  Real external_torque_Nm = 0;   ///< last good
};
template <class Real, class S>
struct LastPressure {
  Real pressure_Pa[(S::cylinders.capacity + 1) / 2 * 2];  ///< last good, per cylinder
};

/// Elastic valves, train by train: that of train t and cylinder k is number t * (capacity of cylinders) + k.
template <class Real, class S>
struct ValvesState {
  static constexpr std::size_t kLanes =
      (std::size_t{S::trains.capacity} * S::cylinders.capacity + 1) / 2 * 2;  ///< even: no padding
  Real valve_lift_m[kLanes] = {};
  Real valve_velocity_m_s[kLanes] = {};
  std::uint32_t valve_regime[kLanes] = {};                        ///< kTrainOn, kSeatOn, or kQuiet
  Real cam_turned_deg[(detail::kCamGroups<S> + 1) / 2 * 2] = {};  ///< of cams that turn alike, in the last tick
};
template <class Real, class S>
struct ValveGasState {
  Real valve_gas_N[ValvesState<Real, S>::kLanes] = {};  ///< at the end of the last tick
};
/// Springs that surge, by mode and valve.
template <class Real, class S>
struct SpringState {
  static constexpr std::size_t kLanes = ValvesState<Real, S>::kLanes;
  Real spring_mode_m[S::spring_modes][kLanes] = {};  ///< q
  Real spring_mode_m_s[S::spring_modes][kLanes] = {};
  Real valve_mean_m_s2[kLanes] = {};  ///< each valve's mean acceleration in the last tick
};
template <class Real, class S>
struct CamPhaseState {
  std::uint64_t cam_phase[S::trains.capacity] = {};                  ///< phase units later than defined
  Real cam_phase_target_deg[(S::trains.capacity + 1) / 2 * 2] = {};  ///< last good
};
template <class Real, class S>
struct CylinderGasState {
  detail::CylinderGases<Real, S::cylinders.capacity> cylinder_gas;
};
template <class Real>
struct ManifoldState {
  detail::ManifoldGas<Real> manifold[kPorts];  ///< kIntake, kExhaust
  Real taken_kg_s[kPorts];                     ///< by the cylinders, in the last step
  detail::OutletGas<Real> outlet;              ///< what flows back
  Real throttle_ratio;                         ///< last good
  Real spare_of_manifolds;
};
template <class Real>
struct GivenGasState {
  detail::GivenGas<Real> given_gas[kPorts];  ///< beyond the ports, or beyond throttle and outlet: last good
};
template <class Real, class S>
struct BurnState {
  detail::CylinderBurn<Real> burn[S::cylinders.capacity];
};
template <class Real, class S>
struct ChargeBurnState {
  detail::BurnStart<Real> charge_burn[S::cylinders.capacity];
};
template <class Real, class S>
struct WallState {
  Real wall_K[(S::cylinders.capacity + 1) / 2 * 2];  ///< of each cylinder's walls
  Real wall_heat_J[(S::cylinders.capacity + 1) / 2 * 2];  ///< that they have and wall_K does not show yet
};
template <class Real, class S>
struct KnockRecords {
  detail::KnockRecord<Real> knock[S::cylinders.capacity];
  std::uint32_t knock_due;      ///< a bit of each cylinder whose burn, with an octane number, is yet to begin
  std::uint32_t knock_in_burn;  ///< one of each whose integral grows
};
template <class Real, class S>
struct GasRecords {
  detail::GasRecord<Real> gas_record[S::cylinders.capacity];
};
template <class Real, class S>
struct CreviceState {
  detail::CreviceGases<Real, (S::cylinders.capacity + 1) / 2 * 2> crevice_gas;
};
template <class Real, class S>
struct BlowByRecords {
  Real cycle_blow_by_kg[(S::cylinders.capacity + 1) / 2 * 2];  ///< of the cycle in progress
};
template <class Real, class S>
struct RunnerState {
  detail::RunnerGas<Real> runner[kPorts][S::cylinders.capacity];
};
/// Fuel that lacked air, wherever the gas carried it, the pipe to the lambda sensor, and the sensor.
template <class Real, class S>
struct LambdaState {
  static constexpr std::uint32_t kEven = (S::cylinders.capacity + 1) / 2 * 2;
  Real unburned_kg[kEven] = {};  ///< in each cylinder and its crevices
  Real manifold_unburned_kg[kPorts] = {};
  Real pipe_ratio[S::lambda_parcels] = {};  ///< 1 / lambda of each parcel; 0: air
  Real filled_ratio = 0;                    ///< of the parcel that fills
  Real filling_ratio = 0;                   ///< 1 / lambda of what is in it, times filled_ratio
  Real owed_ratio = 0;                      ///< parcels that flowed back, and come again
  Real outlet_unburned_ratio = 0;           ///< of the gas that last flowed out
  Real sensor_ratio = 0;                    ///< 1 / lambda that the sensor shows
  Real sensor_rest_ratio = 0;
  std::uint32_t oldest_parcel = 0;
  std::uint32_t any_unburned = 0;  ///< 1: some of what stands above is not 0
};
template <class Real, class S>
struct RunnerLambdaState {
  Real runner_unburned_kg[kPorts][LambdaState<Real, S>::kEven] = {};
};
template <class Real, class S>
struct OutflowRecords {
  Real outflow_unburned_kg[LambdaState<Real, S>::kEven] = {};  ///< out of each exhaust valve, in the cycle in progress
};
/// Cycles of each cylinder that misfired.
template <class S>
struct MisfireRecords {
  MisfireRecord misfire[S::cylinders.capacity] = {};
};
template <class Real, class S>
struct BurningState {
  Real burning_ratio[(S::cylinders.capacity + 1) / 2 * 2] = {};  ///< share of its heat that each cylinder's cycle has
  // Follow from the shares and the phase, so that a tick need not ask each cylinder: misfire_step.hpp.
  std::uint64_t cycles_go_on_from = 0;  ///< no cycle begins or ends in a part of the turn about the phase, from here
  std::uint64_t cycles_go_on = 0;       ///< on for so many units
  std::uint32_t lacking_heat = 0;       ///< bit k: the share of cylinder k is below 1
  std::uint32_t spare_of_burning = 0;
};
/// Wires of faulty wheels.
template <class S>
struct WireState {
  std::uint32_t wires_differ = 0;  ///< bit w: after the last tick wheel w's faulty signal was not at its healthy level
  std::uint32_t noise_random[S::wheel_faults | 1] = {};  ///< of xorshift32, per fault; odd: no padding
};
/// A sensor's comparator.
template <class Real, class S>
struct ComparatorState {
  Real sensor_V = 0;            ///< the last sample
  Real sensor_peak_V = 0;       ///< since the last edge at a tooth's centre
  Real sensor_last_peak_V = 0;  ///< before it
  Real spare_of_sensor = 0;
  Real late_edge_s[S::reluctor_samples] = {};  ///< of edges that are due in the next tick, from its start
  std::uint32_t comparator_level = 0;
  std::uint32_t comparator_armed = 0;
  std::uint32_t comparator_quiet_ticks = 0;  ///< since that edge; stays at its largest value
  std::uint32_t late_edges = 0;
};
/// A controller's sensors.
template <class Real>
struct SensorStates {
  detail::SensorState<Real> sensor[kControllerSensors] = {};
};
/// Bad inputs since `init`.
struct BadInputsState {
  std::uint32_t bad_input_ticks = 0;  ///< ticks with a bad input; stays at its largest value
  std::uint32_t bad_input_kinds = 0;  ///< their Fault bits, or-ed
};

}  // namespace group

template <class Real, class S>
struct State : group::StateCore<Real>,
               detail::If<detail::Needs<S>::input_pressure, group::LastPressure<Real, S>>,
               detail::If<detail::Needs<S>::work, group::WorkState<Real, S>>,
               detail::If<detail::Needs<S>::crank_dynamics, group::CrankState<Real>>,
               detail::If<detail::Needs<S>::elastic_valves, group::ValvesState<Real, S>>,
               detail::If<detail::Needs<S>::valve_gas_held, group::ValveGasState<Real, S>>,
               detail::If<detail::Needs<S>::surge, group::SpringState<Real, S>>,
               detail::If<S::cam_phasing, group::CamPhaseState<Real, S>>,
               detail::If<S::valve_results, group::ValveRecords<Real, S>>,
               detail::If<S::cam_contact, group::CamContactRecords<Real, S>>,
               detail::If<S::cam_drag, group::CamDragState<Real>>,
               detail::If<detail::Needs<S>::gas, group::CylinderGasState<Real, S>>,
               detail::If<detail::Needs<S>::manifolds, group::ManifoldState<Real>>,
               detail::If<detail::Needs<S>::given_gas, group::GivenGasState<Real>>,
               detail::If<detail::Needs<S>::burn, group::BurnState<Real, S>>,
               detail::If<detail::Needs<S>::charge_burn, group::ChargeBurnState<Real, S>>,
               detail::If<detail::Needs<S>::knock, group::KnockRecords<Real, S>>,
               detail::If<S::gas_results, group::GasRecords<Real, S>>,
               detail::If<S::crevice, group::CreviceState<Real, S>>,
               detail::If<S::crevice && S::gas_results, group::BlowByRecords<Real, S>>,
               detail::If<S::runners, group::RunnerState<Real, S>>,
               detail::If<S::walls, group::WallState<Real, S>>,
               detail::If<detail::Needs<S>::lambda, group::LambdaState<Real, S>>,
               detail::If<detail::Needs<S>::lambda && S::runners, group::RunnerLambdaState<Real, S>>,
               detail::If<detail::Needs<S>::lambda && S::gas_results, group::OutflowRecords<Real, S>>,
               detail::If<S::misfire, group::MisfireRecords<S>>,
               detail::If<detail::Needs<S>::misfire_of_table, group::BurningState<Real, S>>,
               detail::If<detail::Needs<S>::faulty_wheels, group::WireState<S>>,
               detail::If<detail::Needs<S>::reluctor, group::ComparatorState<Real, S>>,
               detail::If<S::sensor_faults, group::SensorStates<Real>>,
               detail::If<S::bad_input_count, group::BadInputsState> {};

/// The same state turning at another speed, for Engine::restore: a run that does not start at rest.
template <class Real, class S>
[[nodiscard]] constexpr State<Real, S> turning_at(State<Real, S> state, Real speed_rad_s) noexcept {
  static_assert(detail::Needs<S>::crank_dynamics, "where the speed is an input, give it there");
  state.speed_rad_s = speed_rad_s;
  state.reduced_speed = speed_rad_s / state.per_root_inertia;
  state.reduced_rest = state.lag_rad_s = Real{0};
  return state;
}

}  // namespace crankloop
