// Integration of smooth functions at set-up time.
#pragma once

#include <crankloop/assert.hpp>

namespace crankloop::detail {

/// Integral of f over [low, high] by five-point Gauss-Legendre: exact for polynomials of degree 9.
template <class Function>
[[nodiscard]] double gauss5(double low, double high, const Function& f) noexcept {
  constexpr double kInner = 0.53846931010568309;  // sqrt(5 - 2 sqrt(10/7)) / 3
  constexpr double kOuter = 0.90617984593866399;  // sqrt(5 + 2 sqrt(10/7)) / 3
  constexpr double kWeightMiddle = 128.0 / 225.0;
  constexpr double kWeightInner = 0.47862867049936647;  // (322 + 13 sqrt 70) / 900
  constexpr double kWeightOuter = 0.23692688505618909;  // (322 - 13 sqrt 70) / 900
  const double middle = (low + high) / 2;
  const double half = (high - low) / 2;
  return half * (kWeightMiddle * f(middle) + kWeightInner * (f(middle - kInner * half) + f(middle + kInner * half)) +
                 kWeightOuter * (f(middle - kOuter * half) + f(middle + kOuter * half)));
}

/// Integral over [low, high], by gauss5() in equal panels.
template <class Function>
[[nodiscard]] double integrate(double low, double high, int panels, const Function& f) noexcept {
  CRANKLOOP_ASSERT(panels >= 1);
  double sum = 0;
  for (int i = 0; i < panels; ++i) {
    sum += gauss5(low + (high - low) * i / panels, low + (high - low) * (i + 1) / panels, f);
  }
  return sum;
}

}  // namespace crankloop::detail
