#include <crankloop/tabulate/spring_surge.hpp>

#include <limits>

#include <crankloop/assert.hpp>
#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop {

using namespace detail;
namespace {

constexpr double kPi = 3.14159265358979323846;

[[nodiscard]] bool is_positive(double x) noexcept { return x > 0 && x <= std::numeric_limits<double>::max(); }

/// q and q' after a tick from (q, q') without drive.
struct Motion {
  double q, v;
};

/// Free motion of a mode: exp(-z w h) times a turn by its damped frequency.
[[nodiscard]] Motion decayed(Motion from, double rate_rad_s, double damping_ratio, double tick_s) noexcept {
  const double decay_per_s = damping_ratio * rate_rad_s;
  const double damped_rad_s = rate_rad_s * square_root(1 - damping_ratio * damping_ratio);
  const double scale = elementary::exp(-decay_per_s * tick_s);
  const double cosine = elementary::cos(damped_rad_s * tick_s);
  const double sine_s = elementary::sin(damped_rad_s * tick_s) / damped_rad_s;
  return {scale * (from.q * (cosine + decay_per_s * sine_s) + from.v * sine_s),
          scale * (from.v * (cosine - decay_per_s * sine_s) - from.q * rate_rad_s * rate_rad_s * sine_s)};
}

[[nodiscard]] SpringMode mode_of(const SurgingSpring& spring, int n, double tick_s) noexcept {
  CRANKLOOP_ASSERT(n >= 1 && n <= kMaxSpringModes);
  const double sign = n % 2 == 0 ? 1 : -1;
  SpringMode mode{};
  mode.rate_rad_s = n * surge_frequency_rad_s(spring);
  const Motion by_q = decayed({1, 0}, mode.rate_rad_s, spring.damping_ratio, tick_s);
  const Motion by_v = decayed({0, 1}, mode.rate_rad_s, spring.damping_ratio, tick_s);
  // A constant acceleration moves the place about which the mode turns by this, per m/s^2.
  const double moved_s2 = 2 * sign / (n * kPi) / (mode.rate_rad_s * mode.rate_rad_s);
  mode.step.of_q = {by_q.q - 1, by_v.q, (1 - by_q.q) * moved_s2};
  mode.step.of_v = {by_q.v, by_v.v - 1, -by_q.v * moved_s2};
  mode.step.valve_N_m = spring.rate_N_m * n * kPi * sign;
  mode.moving_kg = 2 * spring.active_kg / (kPi * kPi * n * n);
  return mode;
}

}  // namespace

double surge_frequency_rad_s(const SurgingSpring& spring) noexcept {
  return kPi * square_root(spring.rate_N_m / spring.active_kg);
}

Status surge_of(const SurgingSpring& spring, double tick_s, SpringSurge& surge) noexcept {
  if (spring.modes < 0 || spring.modes > kMaxSpringModes) return refuse("spring.modes", Reason::out_of_range);
  if (!is_positive(tick_s)) return refuse("tick_s", Reason::out_of_range);
  if (spring.modes == 0) {
    surge = {};
    return {};
  }
  if (!is_positive(spring.rate_N_m)) return refuse("spring.rate_N_m", Reason::not_positive);
  if (!is_positive(spring.active_kg)) return refuse("spring.active_kg", Reason::not_positive);
  if (!(spring.damping_ratio >= 0 && spring.damping_ratio < 1))
    return refuse("spring.damping_ratio", Reason::out_of_range);
  const double turned = spring.modes * surge_frequency_rad_s(spring) * tick_s;
  if (!(turned > 0 && turned <= 1)) return refuse("tick_s", Reason::out_of_range);
  surge = {};
  surge.modes = spring.modes;
  for (int n = 1; n <= spring.modes; ++n) {
    surge.mode[n - 1] = mode_of(spring, n, tick_s);
    surge.moving_kg += surge.mode[n - 1].moving_kg;
  }
  return {};
}

}  // namespace crankloop
