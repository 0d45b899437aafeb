// From a valve train to the constants and step matrices of its motion.
//
// What belongs here: masses, stiffnesses, step lengths, matrices. What does not: the lift (tabulate/valve_lift.hpp).
#pragma once

#include <cstdint>

#include <crankloop/define/valve_train.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tick/valve_tables.hpp>

namespace crankloop {

/// How a step is taken. Both have the same form, so the tick is the same code.
enum class Integrator : std::uint8_t {
  rk4,          ///< classical Runge-Kutta of fourth order, its four stages multiplied out
  exponential,  ///< the exact solution for the polynomial that the lift is over a step
};

/// How finely a valve is stepped.
struct ValveStepping {
  Integrator integrator = Integrator::rk4;
  double accuracy_m = 0.1e-6;  ///< class of lift error asked for, 0.01e-6 to 10e-6: sets the fine step by the stiffest mode
};

/// Most fine steps in a tick; a tick that would need more is refused.
inline constexpr int kMostFineSteps = 512;

/// Constants of the single-mass model (docs/model.md "Valve"), with the lever l_v of the rocker (1 where its inertia is 0).
[[nodiscard]] ValveBody<double> valve_body(const Valve& valve, double lever_m) noexcept;

/// Frequencies of the undamped valve in rad/s: open with the train in contact, and seated with both in contact.
[[nodiscard]] double open_frequency_rad_s(const ValveBody<double>& body) noexcept;
[[nodiscard]] double seated_frequency_rad_s(const ValveBody<double>& body) noexcept;

/// Longest tick for which motion_of() answers, in s.
[[nodiscard]] double longest_tick_s(const ValveBody<double>& body, const ValveStepping& stepping) noexcept;

/// Steps and matrices for a tick. Refuses a tick that needs more than kMostFineSteps ("tick.tick": see longest_tick_s), an accuracy out of
/// range ("tick.accuracy"), a number that names no integrator ("tick.integrator"), a mass beyond 1e9 kg, which a lever of nearly nothing
/// makes ("valve.rocker_inertia"). O(steps).
Status motion_of(const ValveBody<double>& body, double tick_s, const ValveStepping& stepping, ValveMotion<double>& motion) noexcept;

/// The same in the tick's own scalar.
[[nodiscard]] ValveMotion<float> rounded(const ValveMotion<double>& motion) noexcept;

/// Classical RK4 on (y, v) in one regime, n equal steps over d seconds, with the lift's polynomial for mid-step values [Li 2017, 4.9-4.13].
/// `force_N` is the constant force. What the matrices are made of, and what tests compare them with.
[[nodiscard]] ValveState<double> runge_kutta(const ValveBody<double>& body, std::uint32_t regime, double d_s, int n, ValveState<double> state,
                                             const LiftWithin<double>& lift, double force_N) noexcept;

}  // namespace crankloop
