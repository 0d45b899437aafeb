// Set-up of a spring's surge: its modes between a fixed end and one that moves with the valve, over a tick.
//
// What belongs here: frequencies, the step of each mode, what the modes take out of the moving mass. What does not: the
// valve's own step (tabulate/valve_motion.hpp).
//
//     u(x, t) = y x / l + sum q_n sin(n pi x / l)
//     q_n'' + 2 z w_n q_n' + w_n^2 q_n = 2 (-1)^n / (n pi) y'',      w_n = n pi sqrt(k_s / m_s)
//     force on the valve, toward its seat, beyond k_s y + P_0:       F_q = k_s sum n pi (-1)^n q_n
#pragma once

#include <crankloop/limits.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tables/valve_tables.hpp>

namespace crankloop {

/// A helical spring with one end fixed.
struct SurgingSpring {
  double rate_N_m = 0;       ///< k_s, above 0
  double active_kg = 0;      ///< m_s, above 0: mass of the active coils
  double damping_ratio = 0;  ///< z, 0 to less than 1, of every mode
  int modes = 0;             ///< 0 to kMaxSpringModes
};

/// A mode of a spring over a tick. Its step is exact for an acceleration of the valve that stays the same over the
/// tick. Increments, as those of the valve's step.
struct SpringMode {
  double rate_rad_s;              ///< w_n
  double moving_kg;               ///< 2 m_s / (pi n)^2: what the mode takes out of the moving mass m_s / 3
  detail::ModeStep<double> step;  ///< over the tick
};

/// All modes of a spring.
struct SpringSurge {
  int modes = 0;
  SpringMode mode[kMaxSpringModes] = {};
  double moving_kg = 0;  ///< what all its modes take out of the moving mass
};

/// Refuses a number of modes out of range ("spring.modes"), with modes also a rate or a mass that is not positive and
/// finite ("spring.rate_N_m", "spring.active_kg"), a damping ratio out of range ("spring.damping_ratio"), a tick that
/// is not positive or longer than a radian of the fastest mode ("tick_s").
Status surge_of(const SurgingSpring& spring, double tick_s, SpringSurge& surge) noexcept;

/// First natural frequency of the spring between its ends held fast, w_1 = pi sqrt(k_s / m_s), rad/s.
[[nodiscard]] double surge_frequency_rad_s(const SurgingSpring& spring) noexcept;

}  // namespace crankloop
