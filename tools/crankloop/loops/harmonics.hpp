// Amplitudes of a periodic signal's Fourier series.
#pragma once

#include <cmath>
#include <vector>

#include "../files/units.hpp"

namespace crankloop::program {

/// Of harmonics 1 to count. The samples lie at equal spacing over one period, the last a spacing before its end; more
/// than two per period of the highest harmonic.
[[nodiscard]] inline std::vector<double> harmonic_amplitudes(const std::vector<double>& samples, int count) {
  std::vector<double> amplitudes;
  const double spacing_rad = 2 * kPi / static_cast<double>(samples.size());
  for (int n = 1; n <= count; ++n) {
    double cosine = 0, sine = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      cosine += samples[i] * std::cos(n * spacing_rad * static_cast<double>(i));
      sine += samples[i] * std::sin(n * spacing_rad * static_cast<double>(i));
    }
    amplitudes.push_back(2 * std::hypot(cosine, sine) / static_cast<double>(samples.size()));
  }
  return amplitudes;
}

}  // namespace crankloop::program
