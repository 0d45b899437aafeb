// Random numbers whose state a run carries, so that a restored run repeats them.
#pragma once

#include <cstdint>

namespace crankloop::detail {

/// Marsaglia's xorshift32: any number but 0, once in 2^32 - 1. From 0, which only a forged state has, it goes on as
/// from 1.
[[nodiscard]] constexpr std::uint32_t next_random(std::uint32_t& random) noexcept {
  std::uint32_t x = random == 0 ? 1 : random;
  x ^= x << 13;
  x ^= x >> 17;
  x ^= x << 5;
  return random = x;
}

}  // namespace crankloop::detail
