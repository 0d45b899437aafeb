// The valve's motion at set-up: constants from the definition, fine steps for the tick, one record of constants per
// contact regime.
//
// What belongs here: everything about the step's length and the records. What does not: the step itself
// (tick/valve/valve.hpp), the lift (tabulate/valve_lift.hpp).
#pragma once

#include <cstdint>

#include <crankloop/define/valve_train.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tick/valve/valve.hpp>

namespace crankloop {

/// How a step's record is computed. The tick is the same.
enum class Integrator : std::uint8_t {
  rk4,  ///< classical Runge-Kutta of fourth order: so many of its steps that fastest rate times step is at most 0.1,
        ///< multiplied out
  exponential,  ///< their limit: the exact solution for the cubic that the lift is over a step
};

/// How finely a valve is stepped.
struct ValveStepping {
  Integrator integrator = Integrator::rk4;
  double accuracy_m = 0.1e-6;  ///< class of lift error requested, 0.01e-6 to 10e-6: below 0.1e-6 all steps are finer,
                               ///< above nothing is gained
};

/// Refuses an accuracy out of range ("options.valves.accuracy_m") and a number that names no integrator
/// ("options.valves.integrator").
Status validate(const ValveStepping& stepping) noexcept;

/// Most fine steps of a valve in a tick; a tick that would need more is refused.
inline constexpr int kMaxFineSteps = 512;
/// Contact changes that a tick locates over all valves: these and one for each fine step of a valve.
inline constexpr std::uint32_t kEventsBesideParts = 4;
/// And of all valves of an engine together.
inline constexpr int kMaxFineStepsOfEngine = 4096;

/// Constants of the single-mass model (docs/model.md "Valve"), with the lever l_v of the rocker (1 where its inertia is
/// 0).
[[nodiscard]] detail::ValveBody<double> valve_body(const Valve& valve, double lever_m) noexcept;

/// Frequencies of the undamped valve in rad/s: open with the train in contact, and seated with both in contact.
[[nodiscard]] double open_frequency_rad_s(const detail::ValveBody<double>& body) noexcept;
[[nodiscard]] double seated_frequency_rad_s(const detail::ValveBody<double>& body) noexcept;

/// Longest tick for which motion_of() answers, in s.
[[nodiscard]] double longest_tick_s(const detail::ValveBody<double>& body, const ValveStepping& stepping) noexcept;

/// Fine steps and records for a tick of one train alone. Refuses a tick that needs more than kMaxFineSteps
/// ("options.tick_s": see longest_tick_s), what validate() refuses of the stepping, and a mass beyond 1e9 kg, which a
/// lever of nearly nothing makes ("valve.rocker_inertia_kg_m2"). O(fine steps).
Status motion_of(const detail::ValveBody<double>& body, double tick_s, const ValveStepping& stepping,
                 detail::ValveMotion<double>& motion) noexcept;

/// Sets decoupled_m: by how much a valve may oscillate on its seat while its cam, which leaves `lash_m` open there, is
/// on its base circle, without a guard of its whole step that fails.
void find_decoupled(detail::ValveMotion<double>& motion, double lash_m) noexcept;

/// The same in the tick's own scalar.
[[nodiscard]] detail::ValveMotion<float> rounded(const detail::ValveMotion<double>& motion) noexcept;

/// What drives a step: the cam's lift as the cubic with this level at the start, this rise and these slopes by the part
/// of the step, and in its middle so much more of lift as tables/valve_tables.hpp, MiddleStep, has it; and a force that
/// rises evenly.
struct StepDrive {
  double level_m = 0, rise_m = 0, from_m = 0, to_m = 0;
  double force_N = 0, force_rise_N = 0;
  double middle_m = 0;

  /// The lift's polynomial about the part x of the step.
  struct Piece {
    double c[5];
  };
  [[nodiscard]] constexpr Piece about(double x) const noexcept {
    Piece p{{level_m, from_m, 3 * rise_m - 2 * from_m - to_m + 16 * middle_m,
             from_m + to_m - 2 * rise_m - 32 * middle_m, 16 * middle_m}};
    for (int i = 0; i < 4; ++i) {
      for (int j = 3; j >= i; --j) p.c[j] += x * p.c[j + 1];  // Horner's scheme, again and again
    }
    return p;
  }
};

/// Classical RK4 on (y, v) in one regime, n equal steps over d seconds [Li 2017, 4.9-4.13].
[[nodiscard]] detail::ValveState<double> runge_kutta(const detail::ValveBody<double>& body, std::uint32_t regime,
                                                     double d_s, int n, detail::ValveState<double> state,
                                                     const StepDrive& drive) noexcept;

/// The exact solution over d seconds, to rounding: Taylor series of order 20 over parts so short that nothing is left.
[[nodiscard]] detail::ValveState<double> exact_motion(const detail::ValveBody<double>& body, std::uint32_t regime,
                                                      double d_s, detail::ValveState<double> state,
                                                      const StepDrive& drive) noexcept;

}  // namespace crankloop
