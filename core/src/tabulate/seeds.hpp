// Random numbers of a tick, as set-up prepares them.
#pragma once

#include <cstdint>

#include <crankloop/limits.hpp>

namespace crankloop::detail {

/// Different numbers for each cylinder or fault with one seed: the finaliser of MurmurHash3, a bijection; 0, where
/// xorshift would stay, becomes 1.
[[nodiscard]] inline std::uint32_t seed_of(int seed, std::uint32_t which) noexcept {
  static_assert(kMaxCylinders == 16 && kMaxWheelFaults == 16);
  std::uint32_t x = static_cast<std::uint32_t>(seed) * 16 + which + 0x9E3779B9u;
  x ^= x >> 16;
  x *= 0x85EBCA6Bu;
  x ^= x >> 13;
  x *= 0xC2B2AE35u;
  x ^= x >> 16;
  return x == 0 ? 1 : x;
}

/// The numbers, of those drawn from 0 to 2^32 - 2, that a probability of 0 to 1 has.
[[nodiscard]] inline std::uint32_t chance_of(double probability) noexcept {
  return static_cast<std::uint32_t>(probability * 4294967295.0 + 0.5);
}

}  // namespace crankloop::detail
