// An adaptive integrator of ordinary differential equations, to compare with: Dormand and Prince's pair of orders 5 and
// 4 (J. Comput. Appl. Math. 6, 1980), in double.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace crankloop::support {

template <std::size_t N>
class Adaptive {
 public:
  using Vector = std::array<double, N>;

  /// An error of a step counts relative to `relative` of what a component is and that of `scale`.
  Adaptive(double relative, const Vector& scale) : relative_{relative}, scale_{scale} {}

  /// From t to `end`; slopes(t, y, dy).
  template <class Slopes>
  void run(const Slopes& slopes, double& t, double end, Vector& y) {
    while (t < end) {
      const bool last = t + h_ >= end * (1 - 1e-15);
      const double h = last ? end - t : h_;
      Vector next;
      const double error = step(slopes, t, h, y, next);
      if (error <= 1) y = next, t = last ? end : t + h;
      const double by = error > 0 ? 0.9 * std::pow(error, -0.2) : 5;
      if (error > 1 || !last) h_ = h * std::fmin(5, std::fmax(0.1, by));
    }
  }

 private:
  template <class Slopes>
  double step(const Slopes& slopes, double t, double h, const Vector& y, Vector& next) const {
    static constexpr double kC[7] = {0, 0.2, 0.3, 0.8, 8.0 / 9, 1, 1};
    static constexpr double kA[7][6] = {{},
                                        {0.2},
                                        {3.0 / 40, 9.0 / 40},
                                        {44.0 / 45, -56.0 / 15, 32.0 / 9},
                                        {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                                        {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                                        {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
    static constexpr double kE[7] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                     -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    std::array<Vector, 7> k;
    for (std::size_t s = 0; s < 7; ++s) {
      next = y;
      for (std::size_t j = 0; j < s; ++j) {
        for (std::size_t i = 0; i < N; ++i) next[i] += h * kA[s][j] * k[j][i];
      }
      slopes(t + kC[s] * h, next, k[s]);
    }
    double worst = 0;
    for (std::size_t i = 0; i < N; ++i) {
      double error = 0;
      for (std::size_t s = 0; s < 7; ++s) error += h * kE[s] * k[s][i];
      worst = std::fmax(worst, std::fabs(error) / (relative_ * (std::fabs(y[i]) + scale_[i])));
    }
    return worst;
  }

  double relative_;
  Vector scale_;
  double h_ = 1e-7;
};

}  // namespace crankloop::support
