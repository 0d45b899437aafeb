#include "stability_map.hpp"

#include <cmath>
#include <complex>

#include <crankloop/tabulate/valve_motion.hpp>

namespace crankloop::program {
namespace {

/// A free valve on its spring: 1 rad/s, damped by the guide.
detail::ValveBody<double> oscillator(double damping_ratio) {
  detail::ValveBody<double> body{};
  body.mass_kg = body.per_mass = body.spring_N_m = 1;
  body.guide_Ns_m = 2 * damping_ratio;
  return body;
}

/// The longest step up to which `stable` holds, searched upward; `high` is not stable.
template <class Stable>
double limit(double low, double high, const Stable& stable) {
  for (double at = low; at < high; at += 0.02) {  // the first change, if there are several
    if (!stable(at)) {
      high = at;
      break;
    }
    low = at;
  }
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

/// Whether 2000 steps from lift 1 and from velocity 1 do not grow.
bool stays_bounded(double damping_ratio, double step_s) {
  const detail::ValveBody<double> body = oscillator(damping_ratio);
  const detail::ValveState<double> starts[] = {{1, 0}, {0, 1}};
  for (detail::ValveState<double> state : starts) {
    for (int i = 0; i < 2'000; ++i) {
      state = runge_kutta(body, 0, step_s, 1, state, {});
      if (!(std::hypot(state.lift_m, state.velocity_m_s) < 1e6)) return false;
    }
    if (std::hypot(state.lift_m, state.velocity_m_s) > 2) return false;
  }
  return true;
}

bool theory_is_stable(double damping_ratio, double step_s) {
  const std::complex<double> root = std::sqrt(std::complex<double>(damping_ratio * damping_ratio - 1, 0));
  for (const double sign : {1.0, -1.0}) {
    const std::complex<double> z = step_s * (-damping_ratio + sign * root);
    if (std::abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)))) > 1 + 1e-12) return false;
  }
  return true;
}

/// Frequency times fine step of a valve on its seat in the coarsest class.
double longest_used(double damping_ratio) {
  detail::ValveBody<double> body{};
  body.mass_kg = body.per_mass = body.seat_N_m = 1;
  body.train_N_m = 1e-9;
  body.seat_Ns_m = 2 * damping_ratio;
  detail::ValveMotion<double> motion{};
  constexpr double kTick_s = 50;
  return motion_of(body, kTick_s, {Integrator::rk4, 10e-6}, motion).ok() ? motion.fine_step_s : 0;
}

}  // namespace

std::vector<StabilityPoint> stability_map() {
  std::vector<StabilityPoint> map;
  for (int i = 0; i <= 40; ++i) {
    const double zeta = i * 0.05;
    // An undamped step shrinks by 1 - (w d)^6 / 144 only: below 0.5 growth would not be detected.
    map.push_back({zeta, limit(0.5, 4, [&](double d) { return stays_bounded(zeta, d); }),
                   limit(0.5, 4, [&](double d) { return theory_is_stable(zeta, d); }), longest_used(zeta)});
  }
  return map;
}

}  // namespace crankloop::program
