// Fourier coefficients by plain summation: the second way to every series and harmonic.
#pragma once

#include <cmath>

#include "support/units.hpp"

namespace crankloop::support {

struct FourierTerm {
  double cosine;
  double sine;
};

/// Coefficients of cos(order t) and sin(order t) of f over one period 2 pi, from `samples` equal steps; order 0 gives
/// the mean. The trapezoidal rule: for a smooth periodic function exact but for orders above samples - order.
template <class Function>
[[nodiscard]] FourierTerm fourier_term(const Function& f, int order, int samples) {
  long double cosine = 0;
  long double sine = 0;
  for (int i = 0; i < samples; ++i) {
    const long double t = 2 * kWidePi * i / samples;
    const auto value = static_cast<long double>(f(static_cast<double>(t)));
    cosine += value * std::cos(order * t);
    sine += value * std::sin(order * t);
  }
  const long double share = (order == 0 ? 1.0L : 2.0L) / samples;
  return {static_cast<double>(cosine * share), static_cast<double>(sine * share)};
}

}  // namespace crankloop::support
