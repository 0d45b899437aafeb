// The angle of a crank mechanism in its cycle, and integrals evaluated at it.
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/phase.hpp>
#include <crankloop/tables/curve.hpp>

namespace crankloop::detail {

/// Angle of a mechanism in its own 720 deg cycle.
template <class Real>
struct Angle {
  Cell cell;
  Real u;  ///< fraction of the degree

  /// The degree within the crank turn, 0 to 359.
  [[nodiscard]] constexpr std::uint32_t turn_degree() const noexcept {
    CRANKLOOP_ASSERT(cell.degree < std::uint32_t{kDegreesPerCycle});
    return cell.degree >= std::uint32_t{kDegreesPerTurn} ? cell.degree - std::uint32_t{kDegreesPerTurn} : cell.degree;
  }
  /// The cell of a cylinder that fires `turns` (0 or 1) crank turns after the mechanism's phase.
  [[nodiscard]] constexpr Cell delayed(std::uint32_t turns) const noexcept {
    CRANKLOOP_ASSERT(turns <= 1);
    CRANKLOOP_ASSERT(cell.degree < std::uint32_t{kDegreesPerCycle});
    const std::uint32_t degree = cell.degree + turns * std::uint32_t{kDegreesPerTurn};
    return {degree >= std::uint32_t{kDegreesPerCycle} ? degree - std::uint32_t{kDegreesPerCycle} : degree, cell.into,
            cell.rest};
  }
};

/// Phase since `start`, where a cylinder fires or its lobe opens. float takes only the top 32 bits: the start phases in
/// its tables (Drive::firing_phase, LiftCurve::opens) have no lower ones.
template <class Real>
[[nodiscard]] constexpr std::uint64_t units_from(std::uint64_t phase, std::uint64_t start) noexcept {
  if constexpr (sizeof(Real) == 4) {
    return std::uint64_t{static_cast<std::uint32_t>(phase >> 32) - static_cast<std::uint32_t>(start >> 32)} << 32;
  } else {
    return phase - start;
  }
}

template <class Real>
[[nodiscard]] constexpr Angle<Real> angle_of(std::uint64_t phase, std::uint64_t firing_phase) noexcept {
  const Cell cell = Phase{units_from<Real>(phase, firing_phase)}.cell<Real>();
  return {cell, fraction<Real>(cell)};
}

/// Angle of a mechanism in its crank turn, for curves that repeat every turn.
template <class Real>
struct TurnAngle {
  std::uint32_t degree;
  Real u;

  [[nodiscard]] constexpr std::uint32_t turn_degree() const noexcept { return degree; }
};

template <class Real>
[[nodiscard]] constexpr TurnAngle<Real> turn_angle_of(std::uint64_t phase, std::uint64_t firing_phase) noexcept {
  const Cell cell = cell_of<Real>(units_from<Real>(phase, firing_phase) << 1, std::uint32_t{kDegreesPerTurn});
  return {cell.degree, fraction<Real>(cell)};
}

template <class Real>
[[nodiscard]] constexpr Integral<Real> integral_at(const IntegratedSegment<Real>& s, Real u, Real mean) noexcept {
  return {s.base, integral(s.slope, u, mean)};
}

template <class Real>
[[nodiscard]] constexpr Real total(const Integral<Real>& sum, Real quantum) noexcept {
  return signed_value<Real>(sum.base) * quantum + sum.part;
}

}  // namespace crankloop::detail
