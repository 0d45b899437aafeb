// A cylinder of gas between two manifolds, by Runge-Kutta: shares no code with the library.
#pragma once

#include <cmath>
#include <cstddef>

#include "support/gas_equations.hpp"

namespace crankloop::support {

/// A cylinder between two manifolds: of a volume, or of 0, which nothing changes. No heat.
struct GasVessels {
  const char* what;
  GasSeen cylinder, manifold[2];
  double manifold_m3[2];
  double from_m3, to_m3;                   ///< the cylinder's volume, in a straight line
  double from_m2[2], to_m2[2];             ///< areas, likewise
  double time_s;                           ///< of all that
  double pressure, temperature_K, charge;  ///< what it may be off in 25 steps: of the pressure, in K, of what flows
  double order;                            ///< of convergence, at least

  [[nodiscard]] double volume_m3(double s) const { return from_m3 + (to_m3 - from_m3) * s / time_s; }
  [[nodiscard]] double area_m2(std::size_t port, double s) const {
    return from_m2[port] + (to_m2[port] - from_m2[port]) * s / time_s;
  }
};

/// Textbook Runge-Kutta.
class ExactVessels {
 public:
  explicit ExactVessels(const GasVessels& v) : v_{v} {
    y_[0] = gas_filled(v.cylinder.p, v.cylinder.t, v.cylinder.x, v.from_m3);
    for (std::size_t i = 0; i < 2; ++i) {
      if (v.manifold_m3[i] > 0)
        y_[i + 1] = gas_filled(v.manifold[i].p, v.manifold[i].t, v.manifold[i].x, v.manifold_m3[i]);
    }
    constexpr int kSteps = 4000;
    const double h = v.time_s / kSteps;
    for (int n = 0; n < kSteps; ++n) step(n * h, h);
  }
  [[nodiscard]] GasSeen cylinder() const { return gas_seen(y_[0], v_.to_m3); }
  [[nodiscard]] double mass_kg() const { return y_[0].m; }
  [[nodiscard]] double through_kg() const { return through_kg_; }  ///< all that flowed

 private:
  void slopes(double s, const GasVolume (&y)[3], GasVolume (&dy)[3]) const {
    for (GasVolume& d : dy) d = {0, 0, 0};
    const double volume = v_.volume_m3(s);
    const GasSeen in = gas_seen(y[0], volume);
    for (std::size_t i = 0; i < 2; ++i) {
      const GasSeen far = v_.manifold_m3[i] > 0 ? gas_seen(y[i + 1], v_.manifold_m3[i]) : v_.manifold[i];
      (void)support::gas_flow(support::OrificeLaw::ellipse, v_.area_m2(i, s), far, in, dy[i + 1], dy[0]);
    }
    dy[0].u -= in.p * (v_.to_m3 - v_.from_m3) / v_.time_s;
  }
  void step(double s, double h) {
    GasVolume k[4][3], at[3];
    const double part[] = {0, 0.5, 0.5, 1};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t n = 0; n < 3; ++n) {
        at[n] = y_[n];
        if (i > 0) {
          at[n].m += part[i] * h * k[i - 1][n].m, at[n].u += part[i] * h * k[i - 1][n].u;
          at[n].b += part[i] * h * k[i - 1][n].b;
        }
      }
      slopes(s + part[i] * h, at, k[i]);
    }
    const auto mean = [&](double GasVolume::*of, std::size_t n) {
      return h / 6 * (k[0][n].*of + 2 * (k[1][n].*of) + 2 * (k[2][n].*of) + k[3][n].*of);
    };
    through_kg_ += std::fabs(mean(&GasVolume::m, 1)) + std::fabs(mean(&GasVolume::m, 2));
    for (std::size_t n = 0; n < 3; ++n) {
      y_[n].m += mean(&GasVolume::m, n), y_[n].u += mean(&GasVolume::u, n), y_[n].b += mean(&GasVolume::b, n);
    }
  }

  GasVessels v_;
  GasVolume y_[3]{};
  double through_kg_ = 0;
};

}  // namespace crankloop::support
