// Bits of numbers: their hash, whether they are finite, and numbers made of random bits. Without a C library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace target_check {

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
template <class Real>
[[nodiscard]] Real from_bits(std::uint64_t random) noexcept {
  Real x;
  static_assert(sizeof x <= sizeof random);
  if constexpr (sizeof x == 4) {
    const auto half = static_cast<std::uint32_t>(random >> 32);
    std::memcpy(&x, &half, sizeof x);
  } else {
    std::memcpy(&x, &random, sizeof x);
  }
  return x;
}

/// FNV-1a over the bytes of numbers, least significant first, so that no byte order counts.
class Hash {
 public:
  void add(float x) noexcept { mix(bits_of(x), 4); }
  void add(double x) noexcept { mix(bits_of(x), 8); }
  void add(std::uint32_t x) noexcept { mix(x, 4); }
  void add(std::uint64_t x) noexcept { mix(x, 8); }
  [[nodiscard]] std::uint64_t value() const noexcept { return hash_; }

 private:
  void mix(std::uint64_t x, int bytes) noexcept {
    for (; bytes > 0; --bytes, x >>= 8) hash_ = (hash_ ^ (x & 0xFFu)) * 0x100000001B3u;
  }
  std::uint64_t hash_ = 0xCBF29CE484222325u;
};

/// Looks for numbers that are not finite.
class FiniteCheck {
 public:
  void add(float x) noexcept { finite_ = finite_ && (bits_of(x) & 0x7F800000u) != 0x7F800000u; }
  void add(double x) noexcept { finite_ = finite_ && (bits_of(x) & 0x7FF0000000000000u) != 0x7FF0000000000000u; }
  void add(std::uint32_t) noexcept {}
  [[nodiscard]] bool finite() const noexcept { return finite_; }

 private:
  bool finite_ = true;
};

/// Random bits by splitmix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) noexcept : state_{seed} {}
  std::uint64_t next() noexcept {
    state_ += 0x9E37'79B9'7F4A'7C15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58'476D'1CE4'E5B9u;
    z = (z ^ (z >> 27)) * 0x94D0'49BB'1331'11EBu;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

}  // namespace target_check
