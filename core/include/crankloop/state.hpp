// What an engine remembers from tick to tick: all that a run needs to go on. For bytes: tick/state/saved_state.hpp.
#pragma once

#include <cstddef>
#include <cstdint>

#include <crankloop/phase.hpp>
#include <crankloop/scene.hpp>
#include <crankloop/tables/curve.hpp>
#include <crankloop/tick/valve/valve_results.hpp>

namespace crankloop {

/// What a tick's work is counted from: of the tick before, the work done so far and the torque then, for each part that may be scaled by itself.
template <class Real, class S>
struct WorkState {
  static constexpr bool by_load = Needs<S>::load;
  static constexpr bool by_input = Needs<S>::input_pressure;
  Integral<Real> inertia;                                                  ///< per w^2, sum over cylinders
  Integral<Real> gas[by_load ? 2 : 1];                                     ///< full, or motored and heat; sum over cylinders
  Integral<Real> stroke[by_input ? S::cylinders.capacity : 1];             ///< per mechanism
  Real torque_Nm;
  Real spare;                                                              ///< keeps the size a multiple of eight: no padding
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
  Real reduced_speed = 0;         ///< u = w sqrt(J_eff), a quantity whose square is twice the kinetic energy; sqrt(J)
  Real reduced_rest = 0;          ///< what rounding left out of it
  Real per_root_inertia = 1;      ///< 1 / sqrt(J_eff) where the crank stands
  Real inertia_slope_kg_m2 = 0;   ///< torque of masses per w^2 there
  Real gas_Nm[2] = {};            ///< gas torque there: as in WorkState::gas, of pressures given in [0]
  Real lag_rad_s = 0;             ///< by how much the last tick should have turned faster
  Real load_Nm = 0;               ///< last good
};
template <class Real, class S>
struct LastPressure {
  Real pressure_Pa[(S::cylinders.capacity + 1) / 2 * 2];  ///< last good, per cylinder
};

namespace detail {

/// Cams that turn alike: all of an engine, or those of each train where phasers turn them.
template <class S>
inline constexpr std::uint32_t kCamGroups = S::cam_phasing ? S::trains.capacity : 1;

}  // namespace detail

/// Elastic valves, train by train: that of train t and cylinder k is number t * (capacity of cylinders) + k.
template <class Real, class S>
struct ValvesState {
  static constexpr std::size_t kLanes = (std::size_t{S::trains.capacity} * S::cylinders.capacity + 1) / 2 * 2;  ///< even: no padding
  Real valve_lift_m[kLanes] = {};
  Real valve_velocity_m_s[kLanes] = {};
  std::uint32_t valve_regime[kLanes] = {};                       ///< kTrainOn, kSeatOn, or kQuiet
  Real cam_turned_deg[(detail::kCamGroups<S> + 1) / 2 * 2] = {};  ///< of cams that turn alike, in the last tick
};
template <class Real, class S>
struct ValveGasState {
  Real valve_gas_N[ValvesState<Real, S>::kLanes] = {};  ///< at the end of the last tick
};
template <class Real, class S>
struct CamPhaseState {
  std::uint64_t cam_phase[S::trains.capacity] = {};                 ///< phase units later than defined
  Real cam_phase_target_deg[(S::trains.capacity + 1) / 2 * 2] = {};  ///< last good
};
/// Bad inputs since `init`.
struct BadInputsState {
  std::uint32_t bad_input_ticks = 0;  ///< ticks with a bad input; stays at its largest value
  std::uint32_t bad_input_kinds = 0;  ///< their Fault bits, or-ed
};

template <class Real, class S>
struct State : StateCore<Real>,
               If<Needs<S>::input_pressure, LastPressure<Real, S>>,
               If<Needs<S>::work, WorkState<Real, S>>,
               If<Needs<S>::crank_dynamics, CrankState<Real>>,
               If<Needs<S>::elastic_valves, ValvesState<Real, S>>,
               If<S::valve_gas, ValveGasState<Real, S>>,
               If<S::cam_phasing, CamPhaseState<Real, S>>,
               If<S::valve_results, ValveRecords<Real, S>>,
               If<S::bad_input_count, BadInputsState> {};

/// The same state turning at another speed, for Engine::restore: a run that does not start at rest.
template <class Real, class S>
[[nodiscard]] constexpr State<Real, S> turning_at(State<Real, S> state, Real speed_rad_s) noexcept {
  static_assert(Needs<S>::crank_dynamics, "where the speed is an input, give it there");
  state.speed_rad_s = speed_rad_s;
  state.reduced_speed = speed_rad_s / state.per_root_inertia;
  state.reduced_rest = state.lag_rad_s = Real{0};
  return state;
}

}  // namespace crankloop
