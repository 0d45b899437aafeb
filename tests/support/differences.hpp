// Derivatives by differences, with the error that goes with them.
#pragma once

namespace crankloop::support {

/// Step of five-point differences in radians: a power of two, so that a +- h is exact for moderate a.
inline constexpr double kStep = 1.0 / 1024;

/// First derivative, five points: exact for polynomials of degree 4, off by h^4/30 times the fifth derivative.
template <class Function, class Real>
[[nodiscard]] Real slope_of(const Function& f, Real at, Real h = static_cast<Real>(kStep)) {
  return (8 * (f(at + h) - f(at - h)) - (f(at + 2 * h) - f(at - 2 * h))) / (12 * h);
}

/// What slope_of may be off by for a function analytic in the strip |Im a| <= 1 and bounded by `bound` there, whose
/// values carry `noise`: Cauchy's estimate of the fifth derivative is 5! bound, and the weights of the four values sum
/// to 18/12.
[[nodiscard]] constexpr double slope_tolerance(double bound, double noise, double h = kStep) {
  return h * h * h * h / 30 * 120 * bound + 1.5 * noise / h;
}

}  // namespace crankloop::support
