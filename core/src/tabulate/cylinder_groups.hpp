// Cylinders in the groups that a tick computes together.
#pragma once

#include <cstdint>

#include <crankloop/tables/tables.hpp>

namespace crankloop::detail {

/// Sorts cylinders by `group_of`, whose values are less than `groups`.
[[nodiscard]] inline CylinderGroups grouped(const std::uint8_t (&group_of)[kMaxCylinders], std::uint32_t cylinders,
                                            std::uint32_t groups) noexcept {
  CylinderGroups by{};
  std::uint8_t n = 0;
  for (std::uint32_t g = 0; g < groups; ++g) {
    for (std::uint32_t k = 0; k < cylinders; ++k) {
      if (group_of[k] == g) by.cylinder[n++] = static_cast<std::uint8_t>(k);
    }
    by.end[g] = n;
  }
  return by;
}

}  // namespace crankloop::detail
