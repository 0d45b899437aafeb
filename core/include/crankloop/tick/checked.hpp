// Inputs made good: whatever bits come in, a finite number in range goes on.
#pragma once

#include <cstdint>

#include <crankloop/tick/faults.hpp>
#include <crankloop/tick/scene.hpp>

namespace crankloop::detail {

/// lowest <= x <= highest; false for NaN. Comparisons only: no conversion happens before the range is known.
template <class Real>
[[nodiscard]] constexpr bool within(Real x, Real lowest, Real highest) noexcept {
  return x >= lowest && x <= highest;
}

/// x if it is good, else the last good one and its fault bit.
template <class Real>
[[nodiscard]] constexpr Real checked(Real x, Real lowest, Real highest, Real& last_good, Fault fault, std::uint32_t& faults) noexcept {
  if (within(x, lowest, highest)) {
    last_good = x;
  } else {
    faults |= fault;
  }
  return last_good;
}

/// Cylinders of a scene: known when compiled, or what the tables have.
template <class S>
[[nodiscard]] constexpr std::uint32_t count(std::uint32_t in_tables) noexcept {
  return S::cylinders.exact ? S::cylinders.capacity : in_tables;
}

}  // namespace crankloop::detail
