// Conversion of degrees to phase units.
#pragma once

#include <cstdint>

namespace crankloop::detail {

/// Converts an angle in degrees, in [0, 720), to phase units, exactly but for the rounding of deg / 720.
[[nodiscard]] inline std::uint64_t phase_units(double deg) noexcept {
  constexpr double kTwoTo32 = 4294967296.0;
  const double words = deg / 720 * kTwoTo32;
  const auto high = static_cast<std::uint32_t>(words);
  const auto low = static_cast<std::uint32_t>((words - high) * kTwoTo32);
  return (std::uint64_t{high} << 32) | low;
}

}  // namespace crankloop::detail
