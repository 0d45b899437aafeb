// The six basis functions of a uniform quintic B-spline on one segment between knots.
#pragma once

namespace crankloop::detail {

inline constexpr int kBasis = 6;

/// Values, and derivatives by the fraction of the segment; first the function that ends with this segment.
struct QuinticBasis {
  double value[kBasis];
  double slope[kBasis];
  double curvature[kBasis];
};

[[nodiscard]] inline QuinticBasis quintic_basis(double f) noexcept {
  constexpr double k = 1.0 / 120;
  const double g = 1 - f;
  return {{k * g * g * g * g * g, k * (26 + f * (-50 + f * (20 + f * (20 + f * (-20 + f * 5))))),
           k * (66 + f * f * (-60 + f * f * (30 - f * 10))),
           k * (26 + f * (50 + f * (20 + f * (-20 + f * (-20 + f * 10))))),
           k * (1 + f * (5 + f * (10 + f * (10 + f * (5 - f * 5))))), k * f * f * f * f * f},
          {-k * 5 * g * g * g * g, k * (-50 + f * (40 + f * (60 + f * (-80 + f * 25)))),
           k * f * (-120 + f * f * (120 - f * 50)), k * (50 + f * (40 + f * (-60 + f * (-80 + f * 50)))),
           k * (5 + f * (20 + f * (30 + f * (20 - f * 25)))), k * 5 * f * f * f * f},
          {k * 20 * g * g * g, k * (40 + f * (120 + f * (-240 + f * 100))), k * (-120 + f * f * (360 - f * 200)),
           k * (40 + f * (-120 + f * (-240 + f * 200))), k * (20 + f * (60 + f * (60 - f * 100))), k * 20 * f * f * f}};
}

}  // namespace crankloop::detail
