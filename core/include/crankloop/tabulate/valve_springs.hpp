// Set-up of the springs of a valve that surge: the modes of one spring, or of two nested, beside the valve's own step.
//
// What belongs here: which springs a valve has, what moves with the valve and what by itself, whether both together
// stay bounded. What does not: the modes of one spring (tabulate/spring_surge.hpp), their tick
// (tick/valve/spring_step.hpp).
#pragma once

#include <crankloop/define/valve_train.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tables/valve_tables.hpp>
#include <crankloop/tabulate/spring_surge.hpp>

namespace crankloop {

/// The springs of a valve that has passed validate(), the outer first. Answers how many: 1 or 2.
int springs_of(const Valve& valve, SurgingSpring (&springs)[2]) noexcept;

/// What surges of a valve's springs.
struct SurgeOfValve {
  detail::ValveSprings<double> springs{};
  double moving_kg = 0;      ///< what the modes take out of the moving mass M
  double highest_rad_s = 0;  ///< natural frequency of the highest mode
};

/// The modes of a valve that has passed validate(); without surge_modes none. Refuses a tick in which the highest mode
/// turns by more than a radian ("valve.surge_modes", unstable).
Status surge_of(const Valve& valve, double tick_s, SurgeOfValve& surge) noexcept;

/// The valve beside the modes of its springs: dampers, stiffnesses and preload as they are, without the mass that the
/// modes move.
[[nodiscard]] detail::ValveBody<double> beside_modes(detail::ValveBody<double> body,
                                                     const SurgeOfValve& surge) noexcept;

/// Largest ratio, less 1, by which valve and modes together grow in a tick of any contact regime: the spectral radius
/// of the step of all, to 1e-12. The tick couples them one after the other, so that stiff seats and short dampers can
/// feed a mode.
template <class Real>
[[nodiscard]] double surge_growth(const detail::ValveMotion<Real>& motion,
                                  const detail::ValveSprings<Real>& springs) noexcept;

/// Growth in a tick from which on a valve is refused: 1e9 ticks of it are a factor of e.
inline constexpr double kMostSurgeGrowth = 1e-9;

/// The share of a spring's surge force by which it may be wrong for the tick's length, where its modes ring: force and
/// acceleration are straight lines over a tick. Of second order: (w h)^2 / 4 with the highest mode. Where float and
/// bounce amplify any error, more.
[[nodiscard]] double surge_error_ratio(const SurgeOfValve& surge, double tick_s) noexcept;

}  // namespace crankloop
