// What goes into a step and what comes out: only what the scene asked for; asking for more does not compile.
//
// What belongs here: input, output groups, state. What does not: how they come about (tick/step.hpp).
#pragma once

#include <cstddef>
#include <cstdint>

#include <crankloop/tables/curve.hpp>
#include <crankloop/scene.hpp>
#include <crankloop/tick/trigger/trigger_output.hpp>
#include <crankloop/tick/valve/valve_results.hpp>

namespace crankloop {

// ---- input -----------------------------------------------------------------------------------------------------------------

template <class Real>
struct SpeedInput {
  Real speed_rad_s = 0;  ///< crank speed; negative = backwards
};
struct PhaseInput {
  Phase crank{};  ///< absolute: 0 = cylinder 1's firing top dead centre
};
inline constexpr double kMostLoad_Nm = 1e8;
template <class Real>
struct LoadTorqueInput {
  Real load_Nm = 0;  ///< on the crankshaft this tick, beside the definition's brake: positive against forward rotation; may drive; +-1e8
};
struct StarterInput {
  std::uint32_t starter = 0;  ///< 0 = off; else the starter turns the crank forward this tick
};
struct CylinderCutInput {
  std::uint32_t cut_cylinders = 0;  ///< bit k: cylinder k does not fire this tick, its pressure is the motored one
};
template <class Real>
struct LoadInput {
  Real load_ratio = 1;  ///< 0 = motored, 1 = the diagram as given; 0 to 2
};
template <class Real, class S>
struct PressureInput {
  Real pressure_Pa[S::cylinders.capacity] = {};  ///< absolute, at the end of this tick; 0 to kMostPressure_Pa
};

template <class Real, class S>
struct CamPhaseInput {
  Real cam_phase_deg[S::trains.capacity] = {};  ///< target, crank degrees later than defined; -180 to 180; moved at the train's limited rate
};

template <class Real, class S>
using CrankInput = std::conditional_t<S::crank == CrankGiven::speed, SpeedInput<Real>,
                                      std::conditional_t<S::crank == CrankGiven::phase, PhaseInput, LoadTorqueInput<Real>>>;

template <class Real, class S>
struct Input : CrankInput<Real, S>,
               If<Needs<S>::load, LoadInput<Real>>,
               If<Needs<S>::input_pressure, PressureInput<Real, S>>,
               If<S::cam_phasing, CamPhaseInput<Real, S>>,
               If<S::starter, StarterInput>,
               If<Needs<S>::cut, CylinderCutInput> {};

/// How the crank turns where its speed changes.
template <class Real>
struct CrankRate {
  Real speed_rad_s;
  Real acceleration_rad_s2;
};

// ---- output ----------------------------------------------------------------------------------------------------------------

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
///     J_eff acceleration = torque_Nm + starter_Nm - friction_Nm - load_Nm,    torque_Nm as in Torque
template <class Real>
struct CrankMotion {
  Phase crank;                ///< 0 = cylinder 1's firing top dead centre
  Real speed_rad_s;           ///< negative = backwards
  Real acceleration_rad_s2;
  Real friction_Nm;           ///< friction and brake, positive against forward rotation; at standstill what they hold against
};
template <class Real>
struct StarterTorque {
  Real starter_Nm;
};

/// At the end of the tick, of gas and masses at the crank speed w then: P dx/da - dM db/da with the masses' parts that go with w^2. Where
/// forces make the speed, what masses take to be accelerated with the crank is in J_eff, not here, but it is in CylinderForces::torque_Nm.
template <class Real>
struct Torque {
  Real torque_Nm;  ///< on the crankshaft, all cylinders
};
template <class Real>
struct MeanTorque {
  Real mean_torque_Nm;  ///< averaged over the angle turned in the tick: the work done divided by it
};

/// Forces of one cylinder: docs/model.md "Forces".
template <class Real>
struct CylinderForces {
  Real pressure_Pa;          ///< absolute
  Real gas_force_N;          ///< P_g, positive toward the crankshaft
  Real inertia_force_N;      ///< P_j, reciprocating masses
  Real total_force_N;        ///< P = P_g + P_j
  Real side_force_N;         ///< N, on the cylinder wall
  Real rod_force_N;          ///< S = P / cos b, along the rod; a rod's couple has no part in it
  Real radial_force_N;       ///< K, at the crank pin, positive toward the crank centre
  Real tangential_force_N;   ///< T, at the crank pin, positive with the rotation
  Real torque_Nm;            ///< M = T r
  Real tilting_moment_Nm;    ///< on the engine block about the crank axis
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

/// One free force and its moment about the middle of the crankshaft. Up is bank angle 0, lateral a quarter turn on in the sense of rotation.
template <class Real>
struct FreeForce {
  Real up_N;
  Real lateral_N;
  Real pitch_Nm;  ///< sum of position times force up
  Real yaw_Nm;    ///< sum of position times force lateral
};
template <class Real>
struct FreeForces {
  FreeForce<Real> first;     ///< of the reciprocating masses, first order
  FreeForce<Real> second;    ///< of the reciprocating masses, second order
  FreeForce<Real> rotating;  ///< centrifugal
};

/// Motion of one valve (of all that are alike in a cylinder and train).
template <class Real>
struct ValveMotionOutput {
  Real theoretical_lift_m;   ///< of the cam, not below 0
  Real lift_m;               ///< from the closed, preloaded valve
  Real velocity_m_s;
  Real acceleration_m_s2;
};
/// [train][cylinder]
template <class Real, class S>
struct Valves {
  ValveMotionOutput<Real> valve[S::trains.capacity][S::cylinders.capacity];
};

/// Forces of one elastic valve.
template <class Real>
struct ValveForcesOutput {
  Real train_N;      ///< between train and valve, pushing
  Real seat_N;
  Real tip_N;        ///< at the stem: the train's less the rocker's inertia; negative = the single mass would pull
  Real cam_N;        ///< between cam and pad: rocker ratio times the train's
  Real gap_m;        ///< train lift less valve lift; negative = lash or separation
  std::uint32_t regime;  ///< 0 free, 1 train, 2 seat, 3 both
};
template <class Real, class S>
struct ValveForces {
  ValveForcesOutput<Real> valve_forces[S::trains.capacity][S::cylinders.capacity];
};

template <class Real, class S>
struct Output : If<Needs<S>::crank_dynamics, CrankMotion<Real>>,
                If<S::starter, StarterTorque<Real>>,
                If<S::kinematics, Kinematics<Real, S>>,
                If<S::rod_motion, RodMotion<Real, S>>,
                If<S::torque, Torque<Real>>,
                If<S::mean_torque, MeanTorque<Real>>,
                If<S::forces, Forces<Real, S>>,
                If<S::bearing_loads, BearingLoads<Real, S>>,
                If<S::free_forces, FreeForces<Real>>,
                If<Needs<S>::any_valves, Valves<Real, S>>,
                If<S::valve_forces, ValveForces<Real, S>>,
                If<S::valve_results, ValveResults<Real, S>>,
                If<Needs<S>::any_triggers, Triggers<Real, S>> {
  std::uint32_t faults;  ///< Fault bits of this tick
};

// ---- state -----------------------------------------------------------------------------------------------------------------

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

namespace detail {

/// Part of a cam's turn; 2^32 = 360 cam degrees.
struct CamWindow {
  std::uint32_t from = 0;
  std::uint32_t width = 0;
  [[nodiscard]] constexpr bool holds(std::uint32_t angle) const noexcept { return angle - from < width; }
  /// All of the way to an angle, `turned` on from where it began: a whole turn is 2^64 there.
  [[nodiscard]] constexpr bool holds_all_of(std::uint32_t to, std::int64_t turned) const noexcept {
    const std::int64_t end = to - from;  // no less than 0
    const std::int64_t begin = end - (turned >> 32);
    return end < width && begin > 1 && begin + 1 < width;  // of the low words' rounding
  }
};

/// The widest window about an angle that keeps off others.
struct CamClearance {
  std::uint32_t ahead = 0x7FFF'FFFF;
  std::uint32_t behind = 0x7FFF'FFFF;

  constexpr void keep_off(const CamWindow& other, std::uint32_t angle) noexcept {
    const std::uint32_t to = other.from - angle;
    const std::uint32_t since = angle - (other.from + other.width);
    ahead = to < ahead ? to : ahead;
    behind = since < behind ? since : behind;
  }
  [[nodiscard]] constexpr CamWindow about(std::uint32_t angle) const noexcept { return {angle - behind, behind + ahead}; }
};

/// Whether a scene's valves may be stepped abreast. By processor, not by the compiler's flags: a layout depends on it.
#if defined(__x86_64__) || defined(__aarch64__)
inline constexpr bool kHasLanes = true;
#else
inline constexpr bool kHasLanes = false;
#endif
template <class Real, class S>
inline constexpr bool kMayGoAbreast = kHasLanes && sizeof(Real) == 4 && !S::valve_gas && !S::valve_forces && !S::valve_results;

/// What lanes need side by side (tick/valve/valves_abreast.hpp).
template <class S>
struct alignas(16) AbreastWork {
  static constexpr std::size_t kRoom = (ValvesState<float, S>::kLanes + 7) / 8 * 8;
  static constexpr bool kBlocksAligned = S::cylinders.exact || S::cylinders.capacity % 8 == 0;
  float regime[32][kRoom] = {};            ///< numbers of each lane's RegimeStep, up to calm_m
  const LiftSegment<float>* curve[kRoom] = {};  ///< of its cam's lift, one for each degree of the lobe and one outside
  std::int32_t degrees[kRoom] = {};        ///< of its lobe
  std::int32_t opens_degree[kRoom] = {};   ///< of the train's cams: where its lobe begins,
  std::uint32_t opens_into[kRoom] = {};    ///< and where in that degree, 2^32 = all of it
  float cam_lift_m[kRoom] = {};            ///< at the tick's end,
  float cam_per_deg_m[kRoom] = {};         ///< and its slope
};

/// What a valve that goes by itself has at hand.
template <class Real>
struct ValveWork {
  const LiftCurve<Real>* curve;
  const RegimeStep<Real>* regime;  ///< of its tick
  std::uint32_t opens;             ///< where its lobe begins, high word
  Real cam_lift_m, cam_per_deg_m;  ///< at the tick's end, if it moves: its cam's lift and the slope of it
};
template <class Real, class S>
struct OneByOneWork {
  ValveWork<Real> valve[ValvesState<Real, S>::kLanes] = {};
};

/// A bit for each valve of an engine, by its number.
template <class S>
using ValveBits = std::conditional_t<(S::trains.capacity * S::cylinders.capacity > 32), std::uint64_t, std::uint32_t>;

/// What a tick of elastic valves remembers beside the state, all of it worked out from that.
template <class Real, class S>
struct ValvesWork : std::conditional_t<kMayGoAbreast<Real, S>, AbreastWork<S>, OneByOneWork<Real, S>> {
  Real leap_deg = 0;                                      ///< a tick that turns some cam so far may pass over all of its lobe that counts;
  Real far_deg = 0;                                       ///< over more than the cubic through its ends tells
  ValveBits<S> moving = 0;                                ///< those that are not at rest with their cams away
  CamWindow clear[kCamGroups<S>] = {};                    ///< of these cams' turn: none of a valve at rest comes near there,
  CamWindow no_end[kCamGroups<S>] = {};                   ///< and none of any valve ends its cycle
};

template <class Real, class S>
using ValvesWorkOf = If<Needs<S>::elastic_valves, ValvesWork<Real, S>>;

}  // namespace detail

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
