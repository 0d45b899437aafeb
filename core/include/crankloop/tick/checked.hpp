// Input validation with last-good substitution: whatever bits come in, a finite number in range goes on.
#pragma once

#include <cstdint>
#include <cstring>

#include <crankloop/assert.hpp>
#include <crankloop/faults.hpp>
#include <crankloop/scene.hpp>

namespace crankloop::detail {

/// lowest <= x <= highest; false for NaN. Comparisons only: no conversion happens before the range is known.
template <class Real>
[[nodiscard]] constexpr bool within(Real x, Real lowest, Real highest) noexcept {
  return x >= lowest && x <= highest;
}

/// The bits of a number: as integers, non-negative numbers order as their values do, with infinity and NaN beyond all
/// finite ones. One integer comparison is then a whole range check, where two of floats each move the FPU's status to
/// the processor.
[[nodiscard]] inline std::uint32_t bits_of(float x) noexcept {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
[[nodiscard]] inline std::uint64_t bits_of(double x) noexcept {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

/// -most <= x <= most, as within(); `most` positive and finite.
template <class Real>
[[nodiscard]] inline bool within_magnitude(Real x, Real most) noexcept {
  CRANKLOOP_ASSERT(most >= 0 && is_finite(most));
  const auto bits = bits_of(x);
  return (bits & (static_cast<decltype(bits)>(~decltype(bits){0}) >> 1)) <= bits_of(most);
}

/// 0 <= x <= most, as within(); `most` positive and finite.
template <class Real>
[[nodiscard]] inline bool within_positive(Real x, Real most) noexcept {
  CRANKLOOP_ASSERT(most >= 0 && is_finite(most));
  const auto bits = bits_of(x);
  constexpr auto kNegativeZero = static_cast<decltype(bits_of(x))>(~(~decltype(bits_of(x)){0} >> 1));
  return bits <= bits_of(most) || bits == kNegativeZero;
}

/// Whether all bits are from those of 0 to those of `most`: then every number is within_positive(), of which only -0
/// fails here.
template <class Real>
[[nodiscard]] inline bool all_within_positive(const Real* x, std::uint32_t count, Real most) noexcept {
  for (std::uint32_t i = 0; i < count; ++i) {
    if (bits_of(x[i]) > bits_of(most)) return false;
  }
  return true;
}

/// x if it is good, else the last good one and its fault bit.
template <class Real>
[[nodiscard]] constexpr Real checked(Real x, bool good, Real& last_good, Fault fault, std::uint32_t& faults) noexcept {
  if (good) {
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
