// What a tick uses of <cmath>: functions that are one instruction each, with the same bits everywhere.
#pragma once

#include <cstdint>

namespace crankloop::detail {

/// sqrt: IEEE has it correctly rounded.
[[nodiscard]] inline float square_root(float x) noexcept { return __builtin_sqrtf(x); }
[[nodiscard]] inline double square_root(double x) noexcept { return __builtin_sqrt(x); }

/// p as an address that the compiler does not know, on processors of 32 bits: it works it out once and reaches members
/// by their offsets. Of what it knows how to work out GCC works each member's address out anew.
template <class T>
[[nodiscard, gnu::always_inline]] inline T* address(T* p) noexcept {
#if !defined(__x86_64__) && !defined(__aarch64__)
  asm("" : "+r"(p));
#endif
  return p;
}

/// |x|
[[nodiscard]] constexpr float magnitude(float x) noexcept { return __builtin_fabsf(x); }
[[nodiscard]] constexpr double magnitude(double x) noexcept { return __builtin_fabs(x); }

/// Zeros below the lowest bit that is set; x is not 0. A few instructions where the processor has none for it: there
/// the compiler would call a function, which an image for real time need not have.
[[nodiscard]] constexpr std::uint32_t trailing_zeros(std::uint32_t x) noexcept {
#if defined(__riscv) && !defined(__riscv_zbb)
  const std::uint32_t lowest = x & (~x + 1);
  std::uint32_t zeros = 0;
  if ((lowest & 0xFFFF'0000u) != 0) zeros += 16;
  if ((lowest & 0xFF00'FF00u) != 0) zeros += 8;
  if ((lowest & 0xF0F0'F0F0u) != 0) zeros += 4;
  if ((lowest & 0xCCCC'CCCCu) != 0) zeros += 2;
  if ((lowest & 0xAAAA'AAAAu) != 0) zeros += 1;
  return zeros;
#else
  return static_cast<std::uint32_t>(__builtin_ctz(x));
#endif
}

[[nodiscard]] constexpr std::uint32_t trailing_zeros(std::uint64_t x) noexcept {
  const auto low = static_cast<std::uint32_t>(x);
  return low != 0 ? trailing_zeros(low) : 32 + trailing_zeros(static_cast<std::uint32_t>(x >> 32));
}

}  // namespace crankloop::detail
