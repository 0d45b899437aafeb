// Crank phase: where in its 720 deg cycle the engine is.
//
// What belongs here: counting angle without drift, and turning it into a table position.
// What does not: speed limits, time, or any table's contents.
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>

namespace crankloop {

inline constexpr int kDegreesPerTurn = 360;
inline constexpr int kDegreesPerCycle = 720;

namespace detail {

inline constexpr double kRadPerDegree = 0x1.1df46a2529d39p-6;

/// Position in a per-degree table: `degree` 0 to 719 (of a cam 0 to 359), and how far into it: `into` in units of 2^-32
/// deg, `rest` in units of 2^-64 deg.
struct Cell {
  std::uint32_t degree;
  std::uint32_t into;
  std::uint32_t rest;  ///< only double has bits for it; 0 in float
};

/// The part of the degree as a number, 0 <= result < 1.
///
/// 2^32 - 1 times 2^-32 rounds up to 1 in float: the bits that the type cannot hold are dropped first. By way of signed
/// 32-bit integers, whose conversion every FPU has.
template <class Real>
[[nodiscard]] constexpr Real fraction(Cell cell) noexcept {
  if constexpr (sizeof(Real) == 4) {
    return static_cast<Real>(static_cast<std::int32_t>(cell.into >> 8)) * static_cast<Real>(0x1p-24);
  } else {
    const auto high = static_cast<std::int32_t>(cell.into >> 1);                           // 31 bits
    const auto low = static_cast<std::int32_t>((cell.into & 1u) << 21 | cell.rest >> 11);  // the next 22
    return static_cast<Real>(high) * static_cast<Real>(0x1p-31) + static_cast<Real>(low) * static_cast<Real>(0x1p-53);
  }
}

/// x as a number that the compiler does not know, so that multiplying by it is one multiplication: for a known 360
/// GCC's 32-bit targets shift and add 64-bit numbers thirteen times.
[[nodiscard]] inline std::uint32_t opaque(std::uint32_t x) noexcept {
#if !defined(__x86_64__) && !defined(__aarch64__)
  asm("" : "+r"(x));
#endif
  return x;
}

/// The cell of `units` (2^64 = the whole circle) among `degrees` equal parts of it.
template <class Real>
[[nodiscard]] constexpr Cell cell_of(std::uint64_t units, std::uint32_t degrees) noexcept {
  std::uint64_t parts = degrees;
  if (!__builtin_is_constant_evaluated()) parts = opaque(degrees);
  const std::uint64_t high = std::uint64_t{static_cast<std::uint32_t>(units >> 32)} * parts;
  CRANKLOOP_ASSERT(high >> 32 < degrees);
  if constexpr (sizeof(Real) == 4) {
    return {static_cast<std::uint32_t>(high >> 32), static_cast<std::uint32_t>(high), 0};
  } else {
    const std::uint64_t low = (units & 0xFFFF'FFFFu) * parts;
    const std::uint64_t sum = high + (low >> 32);
    CRANKLOOP_ASSERT(sum >> 32 < degrees);
    return {static_cast<std::uint32_t>(sum >> 32), static_cast<std::uint32_t>(sum), static_cast<std::uint32_t>(low)};
  }
}

}  // namespace detail

/// An angle that wraps by itself: 2^64 units are one four-stroke cycle (4 pi rad of crank).
///
/// Adding n equal increments gives the same phase as adding their sum: no drift after any number of ticks
/// (docs/decisions/0002-phase.md: a float angle stalls, a 32-bit phase loses 16 deg in 1e9 ticks).
class Phase {
 public:
  constexpr Phase() = default;
  constexpr explicit Phase(std::uint64_t units) : units_{units} {}

  /// From cycles (1 = 720 deg), |cycles| < 1: by way of 32-bit integers, because the direct conversion calls
  /// soft-double helpers on single-precision FPUs. Bits of `cycles` below 2^-62 are dropped.
  template <class Real>
  [[nodiscard]] static constexpr Phase from_cycles(Real cycles) noexcept {
    CRANKLOOP_ASSERT(cycles > -1 && cycles < 1);
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

  /// The phase's degree among the 720 of a cycle: one multiply, no branch. double adds what the low word contributes;
  /// to float it is nothing.
  ///
  ///     phase         |   top word   |   low word   |
  ///     times 720  =  |    degree    |     into     |     rest     |
  template <class Real>
  [[nodiscard]] constexpr detail::Cell cell() const noexcept {
    return detail::cell_of<Real>(units_, kDegreesPerCycle);
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
