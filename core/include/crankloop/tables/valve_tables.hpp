// Tables of elastic valves, filled at set-up: one record of constants for each contact regime.
//
// What belongs here: the constants and their meaning. What does not: how they are computed (tabulate/valve_motion.hpp),
// how a step uses them (valve.hpp), the lift (lift_curve.hpp).
//
//         cam, rocker                 M y'' = F_train + F_seat - k_s y - P_s0 - c y' - F_gas
//             |  Y(t)                 train: gap g = Y - y,                  F_train = k g + b g'
//            k, b                     seat: compression s = delta_0 - y,     F_seat = k_z s - b_z y'
//             |                       each force acts while it and its g or s are positive, and is 0 otherwise
//           [ M ]  y                  Each of the four regimes (train on or off, seat on or off) is linear: a step
//           /   \                     of any length adds to (y, y') a constant matrix times its inputs.
//     spring     seat k_z, b_z
#pragma once

#include <cstdint>

#include <crankloop/limits.hpp>

namespace crankloop {

/// Bits of a contact regime.
inline constexpr std::uint32_t kTrainOn = 1;
inline constexpr std::uint32_t kSeatOn = 2;

namespace detail {

/// On the seat, with an oscillation too small to leave it or to reach the train: a separate regime, which needs no fine
/// steps however stiff the seat is.
inline constexpr std::uint32_t kQuiet = 4;
inline constexpr int kRegimes = 5;

/// Units of the event budget that an event takes, and one more where both contacts change, one only grazes or has
/// changed before the tick; a fine step takes one, and a tick that is not divided one more where it has no event.
inline constexpr std::uint32_t kUnitsOfLook = 1;
inline constexpr std::uint32_t kUnitsOfEvent = 2;
inline constexpr std::uint32_t kUnitsOfSearch = 1;

[[nodiscard]] constexpr std::uint32_t contacts_of(std::uint32_t regime) noexcept {
  return regime == kQuiet ? kSeatOn : regime;
}

/// The valve's constants.
template <class Real>
struct ValveBody {
  Real mass_kg;             ///< M
  Real train_N_m;           ///< k
  Real train_Ns_m;          ///< b
  Real seat_N_m;            ///< k_z
  Real seat_Ns_m;           ///< b_z
  Real spring_N_m;          ///< k_s
  Real guide_Ns_m;          ///< c
  Real preload_N;           ///< P_s0
  Real seat_compression_m;  ///< delta_0 = P_s0 / k_z
  Real head_area_m2;
  Real rocker_mass_kg;  ///< I_rocker / l_v^2
  Real per_mass;        ///< 1 / M
};

/// Row of a step's matrix: the step adds this row times its inputs to the lift or to the velocity. It is an increment,
/// because in float a matrix near identity would lose the stiffness of a short step to rounding. Its inputs are the gap
/// and the cam's rise instead of the cam's lift, because the cam's lift times the train's stiffness is a large number
/// that the valve's lift nearly cancels. The cam's lift over a step is the cubic through its ends.
template <class Number>
struct StepRow {
  Number rest;            ///< spring preload, unless the seat carries it
  Number gas, gas_rise;   ///< per N of gas force at the start, and per N of its linear rise to the end
  Number gap;             ///< per m of gap at the start
  Number rise, from, to;  ///< per m of the cam's rise, and of its slopes at start and end over the step (0 to 1)
  Number lift, velocity;  ///< factors of the valve's state at the start
};

/// The acceleration is this row times (1, gas force, lift, velocity, gap, gap's speed).
template <class Number>
struct ForceRow {
  Number rest, gas, lift, velocity, gap, gap_speed;
};

/// A contact's guard passes if sign * x - lag_s |x'| > least_m at the step's end: the contact has then not changed
/// during the step. x is the gap (train) or the lift (seat; least_m includes the seat's compression by the preload).
/// The lag is a third of the step, which bounds the cubic within the step (its inner Bezier ordinates lie a third of
/// the slope from the ends; the guard of the step before checked the start). For a closed contact the lag is longer by
/// b / k, so that the force is positive too. A failed guard costs time, never correctness: event location then checks
/// the contacts.
template <class Number>
struct ContactGuard {
  Number sign, lag_s, least_m;
};

/// What a step in contact with the train adds per m by which the cam's lift in the middle of the step exceeds the cubic
/// through its ends: in a wide step the lift is the quartic through both ends and the middle. 0 without contact.
template <class Number>
struct MiddleStep {
  Number lift, velocity;
};

/// A step in a contact regime.
template <class Number>
struct RegimeStep {
  StepRow<Number> lift, velocity;
  ForceRow<Number> acceleration;
  ContactGuard<Number> train, seat;
  Number rest_m,
      rest_m_s;  ///< a valve closer to its rest position and slower than this is set to rest; 0 in regimes without rest
  MiddleStep<Number> middle;
  Number decoupled_m;  ///< a valve that oscillates by less passes its guards while its cam is on the base circle; 0 if
                       ///< the guards always fail
};

/// Equation of motion in a regime, time in fine steps: y'' = rest + lift Y + lift_speed Y' - stiffness y - damping y' +
/// gas F.
template <class Real>
struct RegimeSeries {
  Real rest, gas, stiffness, damping, lift, lift_speed;
};

/// Constants of one valve train's motion.
template <class Real>
struct ValveMotion {
  ValveBody<Real> body;
  Real tick_s;
  Real fine_step_s, per_fine_step_s;
  Real per_parts;              ///< 1 / parts
  std::uint32_t parts;         ///< fine steps of a tick in which a guard fails, short enough to locate an event
  std::uint32_t per_parts_32;  ///< 2^32 / parts; unused for 1
  std::uint32_t event_budget;  ///< units that a tick may spend on events over all valves (EventBudget)
  Real cubic_deg;        ///< largest step in cam degrees over which the cubic through its ends represents the lift
  Real widest_step_deg;  ///< largest tick in cam degrees that may be one step, with the lift in its middle
  Real train_lag_s,
      seat_lag_s;                    ///< b / k, b_z / k_z: contact force / stiffness = depth + lag * speed of the depth
  Real per_seat_N_m;                 ///< 1 / (k_z + k_s): compression of the seat per N of gas force on a closed valve
  Real quiet_m;                      ///< an oscillation on the seat of smaller amplitude changes no contact
  Real per_seat_rate_s;              ///< 1 / angular frequency on the seat: converts a velocity to an amplitude
  RegimeStep<Real> whole[kRegimes];  ///< over a tick
  RegimeStep<Real> fine[kRegimes];   ///< over a fine step
  RegimeSeries<Real> series[kSeatOn + kTrainOn + 1];
};

/// What a tick adds to a mode's place or to its speed: this row times its place q, its speed q' and the valve's mean
/// acceleration in the tick.
template <class Number>
struct ModeRow {
  Number q, v, drive;
};

/// A mode of a valve spring over a tick (tabulate/spring_surge.hpp).
template <class Number>
struct ModeStep {
  ModeRow<Number> of_q, of_v;
  Number valve_N_m;  ///< per m of q: force on the valve, toward its seat
};

/// The springs of one valve train.
template <class Real>
struct ValveSprings {
  std::uint32_t modes;  ///< of all its springs, at most kMaxValveModes
  ModeStep<Real> mode[kMaxValveModes];
};

}  // namespace detail
}  // namespace crankloop
