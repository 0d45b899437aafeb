// Degrees as phase units.
#pragma once

#include <cstdint>

namespace crankloop::detail {

/// An angle in degrees, in [0, 720), as phase units, to the last bit of its division by 720.
[[nodiscard]] inline std::uint64_t phase_units(double deg) noexcept {
  constexpr double kTwoTo32 = 4294967296.0;
  const double words = deg / 720 * kTwoTo32;
  const auto high = static_cast<std::uint32_t>(words);
  const auto low = static_cast<std::uint32_t>((words - high) * kTwoTo32);
  return (std::uint64_t{high} << 32) | low;
}

}  // namespace crankloop::detail
