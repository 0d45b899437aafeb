// Crank phase: where in its 720 deg cycle the engine is.
//
// What belongs here: counting angle without drift, and turning it into a table position.
// What does not: speed limits, time, or any table's contents.
#pragma once

#include <cstdint>

namespace crankloop {

/// Position in a per-degree table: `degree` 0 to 719, and how far into that degree in units of 2^-32 deg.
struct Cell {
  std::uint32_t degree;
  std::uint32_t into;
};

/// Part of a segment as a number, 0 <= result < 1.
///
/// 2^32 - 1 times 2^-32 rounds up to 1 in float: the bits that float cannot hold are dropped first.
template <class Real>
[[nodiscard]] constexpr Real fraction(std::uint32_t into) noexcept {
  constexpr unsigned kept = sizeof(Real) == 4 ? 24 : 31;  // 31: fits a signed integer, whose conversion every FPU has
  return static_cast<Real>(static_cast<std::int32_t>(into >> (32 - kept))) * (Real{1} / static_cast<Real>(std::int32_t{1} << (kept - 1)) / 2);
}

/// An angle that wraps by itself: 2^64 units are one four-stroke cycle (4 pi rad of crank).
///
/// Adding n equal increments gives the same phase as adding their sum: no drift after any number of ticks
/// (docs/decisions/0002-phase.md: a float angle stalls, a 32-bit phase loses 16 deg in 1e9 ticks).
class Phase {
 public:
  constexpr Phase() = default;
  constexpr explicit Phase(std::uint64_t units) : units_{units} {}

  /// From cycles (1 = 720 deg), |cycles| < 1: by way of 32-bit integers, because the direct conversion calls soft-double helpers
  /// on single-precision FPUs. Bits of `cycles` below 2^-62 are dropped.
  template <class Real>
  [[nodiscard]] static constexpr Phase from_cycles(Real cycles) noexcept {
    constexpr Real two_to_31 = static_cast<Real>(2147483648.0);
    const Real scaled = cycles * two_to_31;
    const auto high = static_cast<std::int32_t>(scaled);  // |scaled| < 2^31
    const auto low = static_cast<std::int32_t>((scaled - static_cast<Real>(high)) * two_to_31);
    return Phase{(static_cast<std::uint64_t>(static_cast<std::int64_t>(high)) << 33) +
                 (static_cast<std::uint64_t>(static_cast<std::int64_t>(low)) << 2)};
  }

  [[nodiscard]] constexpr std::uint64_t units() const noexcept { return units_; }

  constexpr Phase& operator+=(Phase step) noexcept {
    units_ += step.units_;
    return *this;
  }
  [[nodiscard]] friend constexpr Phase operator+(Phase a, Phase b) noexcept { return a += b; }
  [[nodiscard]] friend constexpr Phase operator-(Phase a, Phase b) noexcept { return Phase{a.units_ - b.units_}; }

  /// The phase's degree among the 720 of a cycle: one multiply, no branch. double adds what the low word contributes; to float it is nothing.
  ///
  ///     phase         |   top word   |   low word   |
  ///     times 720  =  |    degree    |     into     |
  template <class Real>
  [[nodiscard]] constexpr Cell cell() const noexcept {
    std::uint64_t product = (units_ >> 32) * std::uint64_t{720};
    if constexpr (sizeof(Real) > 4) product += ((units_ & 0xFFFF'FFFFu) * std::uint64_t{720}) >> 32;
    return {static_cast<std::uint32_t>(product >> 32), static_cast<std::uint32_t>(product)};
  }

  /// Cycles as a signed number in [-0.5, 0.5]: the short way round.
  template <class Real>
  [[nodiscard]] constexpr Real signed_cycles() const noexcept {
    const auto high = static_cast<std::int32_t>(static_cast<std::uint32_t>(units_ >> 32));
    const auto low = static_cast<std::int32_t>(static_cast<std::uint32_t>(units_) >> 1);
    constexpr Real two_to_minus_31 = static_cast<Real>(1.0 / 2147483648.0);
    return (static_cast<Real>(high) + static_cast<Real>(low) * two_to_minus_31) * (two_to_minus_31 / 2);
  }

 private:
  std::uint64_t units_{0};
};

}  // namespace crankloop
