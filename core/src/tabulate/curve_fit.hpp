// Fits the segments of a curve to a function of the crank angle.
//
// What belongs here: interpolation, rounding, integer bases. What does not: which function (tabulate.cpp,
// gas_curves.cpp).
#pragma once

#include <cstddef>
#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/tables/curve.hpp>

namespace crankloop::detail {

inline constexpr double kRadPerCycle = 0x1.921fb54442d18p+3;

/// Coefficients of a polynomial of degree N - 1 in u.
template <std::size_t N>
struct Polynomial {
  double c[N] = {};
};

/// The polynomial through N points (Newton's divided differences, multiplied out).
template <std::size_t N>
[[nodiscard]] Polynomial<N> through(const double (&u)[N], const double (&y)[N]) noexcept {
  for (std::size_t i = 1; i < N; ++i) CRANKLOOP_ASSERT(u[i] > u[i - 1]);
  double divided[N];
  for (std::size_t i = 0; i < N; ++i) divided[i] = y[i];
  for (std::size_t order = 1; order < N; ++order) {
    for (std::size_t i = N - 1; i >= order; --i) divided[i] = (divided[i] - divided[i - 1]) / (u[i] - u[i - order]);
  }
  Polynomial<N> p;
  for (std::size_t i = N; i-- > 0;) {  // p = p * (u - u_i) + divided_i
    for (std::size_t j = N - 1; j > 0; --j) p.c[j] = p.c[j - 1] - u[i] * p.c[j];
    p.c[0] = divided[i] - u[i] * p.c[0];
  }
  return p;
}

/// Nodes of a segment's interpolation, as fractions of its half width from its middle.
///
/// Cubic: Chebyshev's nodes; the error is equal at both ends, so that neighbours meet. Quadratic: Chebyshev's +-0.866
/// would give errors of opposite sign at the ends, and a step of twice the error from degree to degree; with +-0.922
/// the inner error is a fifth larger and the step three fifths of that (docs/decisions/0003-curves.md).
template <class Real>
struct Nodes;
template <>
struct Nodes<float> {
  static constexpr double at[3] = {-0.922, 0, 0.922};
};
template <>
struct Nodes<double> {
  static constexpr double at[4] = {-0.92387953251128674, -0.38268343236508978, 0.38268343236508978,
                                   0.92387953251128674};
};

template <class Real>
inline constexpr std::size_t kCoefficients = kCurveDegree<Real> + 1;

template <class Real>
[[nodiscard]] Segment<Real> rounded(const Polynomial<kCoefficients<Real>>& p) noexcept {
  Segment<Real> s;
  for (std::size_t i = 0; i < kCoefficients<Real>; ++i) s.c[i] = static_cast<Real>(p.c[i]);
  return s;
}

/// Node i of the interpolation on [from, to], fractions of a degree.
template <class Real>
[[nodiscard]] double node(std::size_t i, double from, double to) noexcept {
  return (from + to) / 2 + (to - from) / 2 * Nodes<Real>::at[i];
}

/// Fits f(u) on [from, to], fractions of a degree.
template <class Real, class Function>
[[nodiscard]] Polynomial<kCoefficients<Real>> fitted(double from, double to, const Function& f) noexcept {
  double u[kCoefficients<Real>];
  double y[kCoefficients<Real>];
  for (std::size_t i = 0; i < kCoefficients<Real>; ++i) {
    u[i] = node<Real>(i, from, to);
    y[i] = f(u[i]);
  }
  return through(u, y);
}

/// Fits f(angle in rad) within a degree.
template <class Real, class Function>
[[nodiscard]] Polynomial<kCoefficients<Real>> fitted_at(int degree, const Function& f) noexcept {
  return fitted<Real>(0, 1, [&](double u) { return f((degree + u) * kRadPerDegree); });
}

/// Fills a curve from f(angle in rad) over a turn; `part` is the member of the record that holds the segment.
template <class Record, class Real, class Function>
void fill(Revolution<Record>& curve, Segment<Real> Record::*part, const Function& f) noexcept {
  for (int degree = 0; degree < kDegreesPerTurn; ++degree)
    curve.at[degree].*part = rounded<Real>(fitted_at<Real>(degree, f));
}
template <class Real, class Function>
void fill(Curve<Real>& curve, const Function& f) noexcept {
  for (int degree = 0; degree < kDegreesPerTurn; ++degree) curve.at[degree] = rounded<Real>(fitted_at<Real>(degree, f));
}

/// Fills the curve of f and that of its known antiderivative F(angle).
template <class Record, class Real, class Function, class Antiderivative>
void fill(Revolution<Record>& curve, IntegralSegment<Real> Record::*integral, Segment<Real> Record::*part,
          const Function& f, const Antiderivative& F) noexcept {
  for (int degree = 0; degree < kDegreesPerTurn; ++degree) {
    const auto p = fitted_at<Real>(degree, f);
    curve.at[degree].*part = rounded<Real>(p);
    auto& c = (curve.at[degree].*integral).c;
    c[0] = static_cast<Real>(F(degree * kRadPerDegree));
    for (std::size_t i = 0; i < kCoefficients<Real>; ++i)
      c[i + 1] = static_cast<Real>(p.c[i] * kRadPerDegree / static_cast<double>(i + 1));
  }
}

/// The unit of integrals up to `range` as signed 32-bit counts in float: a power of two, so that a product with it is
/// exact. double stores the integral itself.
template <class Real>
[[nodiscard]] double quantum_for(double range) noexcept {
  if (sizeof(Real) > 4) return 1;
  double quantum = 1.0 / 1073741824.0;
  while (quantum * 1073741824.0 < range) quantum *= 2;
  while (quantum * 536870912.0 > range && quantum > 1e-30) quantum /= 2;
  return quantum;
}

template <class Real>
[[nodiscard]] IntegralBase<Real> base_of(double integral, double quantum) noexcept {
  if constexpr (sizeof(Real) == 4) {
    const double units = integral / quantum;
    CRANKLOOP_ASSERT(units > -0x1p31 && units < 0x1p31 - 1);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(units < 0 ? units - 0.5 : units + 0.5));
  } else {
    return integral;
  }
}

/// Fills a curve and its integral from f(angle) and its known antiderivative F(angle).
template <class Real, class Function, class Antiderivative>
void fill(IntegratedCurve<Real>& curve, const Function& f, const Antiderivative& F) noexcept {
  double largest = 0;
  for (int degree = 0; degree < kDegreesPerTurn; ++degree) {
    const double size = F(degree * kRadPerDegree);
    if (size > largest) largest = size;
    if (-size > largest) largest = -size;
  }
  const double quantum = quantum_for<Real>(largest * 1.01);
  curve.quantum = static_cast<Real>(quantum);
  for (int degree = 0; degree < kDegreesPerTurn; ++degree) {
    curve.at[degree].base = base_of<Real>(F(degree * kRadPerDegree), quantum);
    curve.at[degree].slope = rounded<Real>(fitted_at<Real>(degree, f));
  }
}

}  // namespace crankloop::detail
