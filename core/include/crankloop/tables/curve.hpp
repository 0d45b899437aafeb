// Per-degree curves: a function of the crank angle as one small polynomial per degree, alone or together with its
// integral.
//
// What belongs here: how a curve is stored and read. What does not: which curves there are (tables/tables.hpp), how
// they are fitted (core/src/tabulate/curve_fit.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <crankloop/assert.hpp>
#include <crankloop/phase.hpp>

namespace crankloop::detail {

/// Error of the acceleration in units of r w^2: 2.6e-7 for the quadratic in float, twice the rounding of float,
/// and 7.1e-10 for the cubic in double (docs/decisions/0003-curves.md).
template <class Real>
inline constexpr int kCurveDegree = sizeof(Real) == 4 ? 2 : 3;

/// value = c[0] + u (c[1] + u (c[2] + ...)), u = fraction of the whole degree, also where a degree is divided into
/// several segments.
template <class Real>
struct Segment {
  Real c[kCurveDegree<Real> + 1];
};

/// A segment's integral including its value at the degree's start: a polynomial of one degree more, evaluated like any
/// curve.
template <class Real>
struct IntegralSegment {
  Real c[kCurveDegree<Real> + 2];
};
template <class Real, std::size_t N>
[[nodiscard]] constexpr Real polynomial(const Real (&c)[N], Real u) noexcept {
  Real sum = c[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) sum = c[i] + u * sum;
  return sum;
}

template <class Real>
[[nodiscard]] constexpr Real value(const Segment<Real>& s, Real u) noexcept {
  return detail::polynomial(s.c, u);
}
template <class Real>
[[nodiscard]] constexpr Real value(const IntegralSegment<Real>& s, Real u) noexcept {
  return detail::polynomial(s.c, u);
}

/// Integral of (curve - mean) over the angle in radians, from the degree's start to u.
template <class Real>
[[nodiscard]] constexpr Real integral(const Segment<Real>& s, Real u, Real mean) noexcept {
  constexpr Real kPerDegree = static_cast<Real>(kRadPerDegree);
  Real sum = s.c[kCurveDegree<Real>] * (Real{1} / static_cast<Real>(kCurveDegree<Real> + 1));
  for (int i = kCurveDegree<Real> - 1; i > 0; --i) sum = s.c[i] * (Real{1} / static_cast<Real>(i + 1)) + u * sum;
  return kPerDegree * u * ((s.c[0] - mean) + u * sum);
}

/// The integral up to a degree's start. In float an integer count of `quantum`, so that the difference of two large
/// integrals is exact: a tick's work is a hundred-thousandth of a cycle's, and float holds seven digits. Unsigned, so
/// that a sum over cylinders may wrap around.
template <class Real>
using IntegralBase = std::conditional_t<sizeof(Real) == 4, std::uint32_t, double>;

/// Segment of a curve and of its integral: `slope` gives the curve, base * quantum + integral(slope, u, mean) the
/// integral.
template <class Real>
struct IntegratedSegment {
  IntegralBase<Real> base;
  Segment<Real> slope;
};

/// An integral at one angle, or a sum of several.
template <class Real>
struct Integral {
  IntegralBase<Real> base{};
  Real part{};

  constexpr Integral& operator+=(const Integral& other) noexcept {
    base += other.base;
    part += other.part;
    return *this;
  }
};

template <class Real>
[[nodiscard]] constexpr Real signed_value(IntegralBase<Real> base) noexcept {
  if constexpr (sizeof(Real) == 4) {
    return static_cast<Real>(static_cast<std::int32_t>(base));
  } else {
    return base;
  }
}

/// to - from, without cancellation of the large parts.
template <class Real>
[[nodiscard]] constexpr Real difference(const Integral<Real>& from, const Integral<Real>& to, Real quantum) noexcept {
  return signed_value<Real>(static_cast<IntegralBase<Real>>(to.base - from.base)) * quantum + (to.part - from.part);
}

/// One crank revolution of a curve, or of several curves that are read together and therefore stored together.
template <class Record>
struct Revolution {
  Record at[kDegreesPerTurn];
};
template <class Real>
using Curve = Revolution<Segment<Real>>;

/// One crank revolution of a curve with its integral.
template <class Real>
struct IntegratedCurve {
  Real quantum;
  IntegratedSegment<Real> at[kDegreesPerTurn];
};

/// Division of the cycle's degrees into segments: degree i has the segments first[i] to first[i + 1] - 1, of equal
/// width. Only a steep piece of a pressure trace needs more than one (docs/decisions/0004-pressure.md).
struct GasGrid {
  std::uint16_t first[kDegreesPerCycle + 1];

  [[nodiscard]] constexpr std::uint32_t segment(Cell cell) const noexcept {
    CRANKLOOP_ASSERT(cell.degree < std::uint32_t{kDegreesPerCycle});
    const std::uint32_t start = first[cell.degree];
    const std::uint32_t count = first[cell.degree + 1] - start;
    CRANKLOOP_ASSERT(count >= 1 && count <= 0xFFFF);
    return start + static_cast<std::uint32_t>((std::uint64_t{cell.into} * count) >> 32);
  }
};

}  // namespace crankloop::detail
