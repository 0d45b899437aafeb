// How far each way of counting the crank angle is off after 1e9 ticks of 10 us at 2000.123 rpm
// (docs/decisions/0002-phase.md).
#include <cmath>
#include <cstdint>
#include <cstdio>

#include <crankloop/phase.hpp>

namespace {

constexpr long kTicks = 1000000000;
constexpr long double kDegPerTick = 2000.123L * 6 * 10e-6L;

/// What is left of an angle's error after whole cycles, in degrees.
double off_deg(long double counted_deg) {
  const long double apart = counted_deg - kDegPerTick * kTicks;
  return static_cast<double>(apart - 720 * std::floor(apart / 720 + 0.5L));
}

template <class Real>
double wrapped_deg() {
  const auto step = static_cast<Real>(kDegPerTick);
  Real angle = 0;
  for (long i = 0; i < kTicks; ++i) {
    angle += step;
    if (angle >= 720) angle -= 720;
  }
  return off_deg(static_cast<long double>(angle));
}

long tick_at_which_float_stalls() {
  const auto step = static_cast<float>(kDegPerTick);
  float angle = 0;
  for (long i = 0; i < kTicks; ++i) {
    const float next = angle + step;
    if (next == angle) return i;
    angle = next;
  }
  return kTicks;
}

double in_32_bits_deg() {
  const auto step = static_cast<std::uint32_t>(kDegPerTick / 720 * 4294967296.0L + 0.5L);
  std::uint32_t phase = 0;
  for (long i = 0; i < kTicks; ++i) phase += step;
  return off_deg(static_cast<long double>(phase) * (720 / 4294967296.0L));
}

template <class Real>
double by_phase_deg() {
  const crankloop::Phase step = crankloop::Phase::from_cycles(static_cast<Real>(kDegPerTick / 720));
  crankloop::Phase phase;
  for (long i = 0; i < kTicks; ++i) phase += step;
  return off_deg(static_cast<long double>(phase.units()) * (720 / 18446744073709551616.0L));
}

}  // namespace

int main() {
  std::printf("float, never wrapped: stands still from tick %ld on, after %.0f s\n", tick_at_which_float_stalls(),
              static_cast<double>(tick_at_which_float_stalls()) * 10e-6);
  std::printf("float, wrapped at 720: %.2g deg off\n", wrapped_deg<float>());
  std::printf("double, wrapped at 720: %.2g deg off\n", wrapped_deg<double>());
  std::printf("32-bit phase: %.2g deg off\n", in_32_bits_deg());
  std::printf("crankloop::Phase, increment from double: %.2g deg off\n", by_phase_deg<double>());
  std::printf("crankloop::Phase, increment from float: %.2g deg off, all of it the rounding of the speed\n",
              by_phase_deg<float>());
  return 0;
}
