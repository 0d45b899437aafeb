// Set-up of the valve's motion: constants from the definition, fine steps for the tick, one record of constants per
// contact regime.
//
// What belongs here: step lengths and records. What does not: the step itself (tick/valve/valve.hpp), the lift
// (tabulate/valve_lift.hpp).
#pragma once

#include <cstdint>

#include <crankloop/define/valve_train.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tick/valve/valve.hpp>

namespace crankloop {

/// How a step's record is computed; the tick is the same for both.
enum class Integrator : std::uint8_t {
  rk4,          ///< classical fourth-order Runge-Kutta: steps short enough that fastest rate times step is at most 0.1,
                ///< multiplied into one
  exponential,  ///< the limit of such steps: the exact solution for a cubic lift over the step
};

/// Integrator and accuracy of a valve's steps.
struct ValveStepping {
  Integrator integrator = Integrator::rk4;
  double accuracy_m = 0.1e-6;  ///< requested class of lift error, 0.01e-6 to 10e-6: below 0.1e-6 all steps are finer,
                               ///< above it none is coarser
  int event_budget = 0;  ///< units of work for events in a tick, over all valves (docs/contract.md, "Event budget"):
                         ///< a fine step takes 1 or 2, an event 2 or 3. 0: usual_event_budget; else enough for the fine
                         ///< steps of any valve and an event, at most kMaxEventBudget
};

/// Refuses an accuracy or a budget out of range ("options.valves.accuracy_m", "options.valves.event_budget") and an
/// undefined integrator ("options.valves.integrator").
Status validate(const ValveStepping& stepping) noexcept;

/// Maximum number of fine steps of a valve in a tick; a tick that would need more is refused.
inline constexpr int kMaxFineSteps = 512;
/// Event budget unless the options give one: for every valve all its fine steps, two events in each and two more.
[[nodiscard]] constexpr std::uint32_t usual_event_budget(int fine_steps, int valves) noexcept {
  const auto steps = static_cast<std::uint32_t>(fine_steps);
  return steps + 2 * detail::kUnitsOfEvent * (steps + static_cast<std::uint32_t>(valves));
}
/// Largest event budget, beyond the usual one of the largest engine.
inline constexpr int kMaxEventBudget = 32768;
/// Maximum number of fine steps of all valves of an engine in a tick.
inline constexpr int kMaxFineStepsOfEngine = 4096;

/// Constants of the single-mass model (docs/model.md "Valve"), with the lever l_v of the rocker (1 where its inertia is
/// 0).
[[nodiscard]] detail::ValveBody<double> valve_body(const Valve& valve, double lever_m) noexcept;

/// Frequencies of the undamped valve in rad/s: open with the train in contact, and seated with both in contact.
[[nodiscard]] double open_frequency_rad_s(const detail::ValveBody<double>& body) noexcept;
[[nodiscard]] double seated_frequency_rad_s(const detail::ValveBody<double>& body) noexcept;

/// Longest tick that motion_of() accepts, in s.
[[nodiscard]] double longest_tick_s(const detail::ValveBody<double>& body, const ValveStepping& stepping) noexcept;

/// Computes fine steps and records of one train. Refuses a tick that needs more than kMaxFineSteps ("options.tick_s":
/// see longest_tick_s), what validate() refuses of the stepping, and a mass above 1e9 kg, the result of a lever near
/// zero ("valve.rocker_inertia_kg_m2"). O(fine steps).
Status motion_of(const detail::ValveBody<double>& body, double tick_s, const ValveStepping& stepping,
                 detail::ValveMotion<double>& motion) noexcept;

/// Sets decoupled_m: the amplitude on the seat up to which all guards of the whole step pass while the cam is on its
/// base circle with a lash of `lash_m`.
void find_decoupled(detail::ValveMotion<double>& motion, double lash_m) noexcept;

/// Converts the constants to float.
[[nodiscard]] detail::ValveMotion<float> rounded(const detail::ValveMotion<double>& motion) noexcept;

/// Inputs of a step: the cam's lift and a force that rises linearly. The lift is the cubic with a level at the start, a
/// rise, and slopes at both ends over the step, plus middle_m in the middle of the step (tables/valve_tables.hpp,
/// MiddleStep).
struct StepDrive {
  double level_m = 0, rise_m = 0, from_m = 0, to_m = 0;
  double force_N = 0, force_rise_N = 0;
  double middle_m = 0;

  /// The lift's polynomial, expanded about the fraction x of the step.
  struct Piece {
    double c[5];
  };
  [[nodiscard]] constexpr Piece about(double x) const noexcept {
    Piece p{{level_m, from_m, 3 * rise_m - 2 * from_m - to_m + 16 * middle_m,
             from_m + to_m - 2 * rise_m - 32 * middle_m, 16 * middle_m}};
    for (int i = 0; i < 4; ++i) {
      for (int j = 3; j >= i; --j) p.c[j] += x * p.c[j + 1];  // repeated Horner's scheme
    }
    return p;
  }
};

/// Classical RK4 on (y, v) in one regime, n equal steps over d seconds [Li 2017, 4.9-4.13].
[[nodiscard]] detail::ValveState<double> runge_kutta(const detail::ValveBody<double>& body, std::uint32_t regime,
                                                     double d_s, int n, detail::ValveState<double> state,
                                                     const StepDrive& drive) noexcept;

/// The exact solution over d seconds, to rounding: Taylor series of order 20 over parts short enough that the remainder
/// is below rounding.
[[nodiscard]] detail::ValveState<double> exact_motion(const detail::ValveBody<double>& body, std::uint32_t regime,
                                                      double d_s, detail::ValveState<double> state,
                                                      const StepDrive& drive) noexcept;

}  // namespace crankloop
