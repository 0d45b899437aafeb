// What an elastic valve's tick reads, made at set-up: one record of constants for each contact regime.
//
// What belongs here: the constants and what they stand for. What does not: how they are made
// (tabulate/valve_motion.hpp), how a step uses them (valve.hpp), the lift (lift_curve.hpp).
//
//         cam, rocker                 M y'' = F_train + F_seat - k_s y - P_s0 - c y' - F_gas
//             |  Y(t)                 gap g = Y - y:          F_train = k g + b g'     while both g and it are positive
//            k, b                     seat's compression s = delta_0 - y: F_seat = k_z s - b_z y' while both are
//            positive
//             |                                               (else 0)
//           [ M ]  y                  Each of the four regimes (train on or off, seat on or off) is linear: a step
//           /   \                     adds to (y, y') a constant matrix times what drives it, whatever its length.
//     spring     seat k_z, b_z
#pragma once

#include <cstdint>

namespace crankloop {

/// Bits of a contact regime.
inline constexpr std::uint32_t kTrainOn = 1;
inline constexpr std::uint32_t kSeatOn = 2;

namespace detail {

/// On the seat, oscillating by less than could leave it or reach the train: a regime of its own, which needs no fine
/// steps however stiff the seat.
inline constexpr std::uint32_t kQuiet = 4;
inline constexpr int kRegimes = 5;

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

/// What a step adds to the lift, or to the velocity, is this times what drives it: increments, because in float a
/// matrix near one would lose the stiffness of a short step to rounding; and by the gap and the cam's rise instead of
/// the cam's lift, because a lift times the train's stiffness is a large number that the valve's own nearly cancels.
/// The cam's lift over a step is the cubic through its ends.
template <class Number>
struct StepRow {
  Number rest;            ///< of the spring's preload, where the seat does not carry it
  Number gas, gas_rise;   ///< of each N of gas force at the step's start, and of each N that it rises evenly to the end
  Number gap;             ///< of the gap at the start
  Number rise, from, to;  ///< of the cam's rise, and of its slopes at start and end by the part of the step, 0 to 1
  Number lift, velocity;  ///< of the valve's state at the start
};

/// The acceleration at one moment is this times (1, gas force, lift, velocity, gap, gap's speed).
template <class Number>
struct ForceRow {
  Number rest, gas, lift, velocity, gap, gap_speed;
};

/// A contact's guard passes where, at the step's end, sign * place - lag_s |place's speed| > least_m: then the contact
/// has stayed as it is all through the step. The place is the gap, or the lift: how far the preload presses the seat in
/// is part of least_m. The lag is a third of the step, which bounds the cubic within it (the inner Bezier ordinates lie
/// a third of the slope from the ends; the other end is that of the step before), for a contact that is on and b / k
/// more, which makes the force's sign that of the depth. A guard that fails costs time, never correctness: event
/// location checks the contacts then.
template <class Number>
struct ContactGuard {
  Number sign, lag_s, least_m;
};

/// What a step with the train's contact closed throughout adds for each m by which the cam's lift in the middle of the
/// step lies above the cubic through its ends: in a wide step the lift is the quartic through both ends and the middle.
/// 0 where the contact is open.
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
      rest_m_s;  ///< nearer to its rest, and slower, the valve is put there; 0 where a contact may change meanwhile
  MiddleStep<Number> middle;
  Number decoupled_m;  ///< with its cam on the base circle, a valve that oscillates by less passes its guards; 0
                       ///< where none does
};

/// The same regime's equation of motion by the part of a fine step: y'' = rest + lift Y + lift_speed Y' - stiffness y -
/// damping y' + gas F.
template <class Real>
struct RegimeSeries {
  Real rest, gas, stiffness, damping, lift, lift_speed;
};

/// All that one valve train's motion reads.
template <class Real>
struct ValveMotion {
  ValveBody<Real> body;
  Real tick_s;
  Real fine_step_s, per_fine_step_s;
  Real per_parts;       ///< 1 / parts
  std::uint32_t parts;  ///< fine steps of a tick whose guards fail: so short that an event in them can be located
  std::uint32_t per_parts_32;  ///< 2^32 / parts; unused for 1
  std::uint32_t event_budget;  ///< events that a tick locates over all valves: 4 and the most parts of any train
  Real cubic_deg;              ///< cam degrees up to which the cubic through the ends of a step will do for the lift,
  Real widest_step_deg;        ///< and those up to which a tick may be one step, with the lift in its middle
  Real train_lag_s,
      seat_lag_s;     ///< b / k, b_z / k_z: a contact's force over its stiffness is depth + lag times the depth's speed
  Real per_seat_N_m;  ///< 1 / (k_z + k_s): how far each N of gas force presses a closed valve into its seat
  Real quiet_m;       ///< an oscillation on the seat of less than this changes no contact
  Real per_seat_rate_s;              ///< 1 / rate on the seat: times the velocity, what that adds to the amplitude
  RegimeStep<Real> whole[kRegimes];  ///< over a tick
  RegimeStep<Real> fine[kRegimes];   ///< over a fine step
  RegimeSeries<Real> series[kSeatOn + kTrainOn + 1];
};

}  // namespace detail
}  // namespace crankloop
