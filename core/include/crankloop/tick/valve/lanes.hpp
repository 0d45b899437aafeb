// Floats abreast: several valves in one register, by the vector extension of GCC and Clang. The only place that knows
// of it.
//
// What belongs here: loading, storing, transposing such numbers. What does not: what is computed with them: the same
// inline functions as with one (valve.hpp), + - * and comparisons alone, so a lane has the bits that it has by itself.
#pragma once

#include <cstdint>
#include <cstring>

#include <crankloop/tick/one_instruction.hpp>

/// Whether valves are stepped abreast. Either way gives the same bits: where a processor has no vectors of floats, one
/// by one is faster.
#ifndef CRANKLOOP_ABREAST
#if defined(__SSE2__) || defined(__ARM_NEON)
#define CRANKLOOP_ABREAST 1
#else
#define CRANKLOOP_ABREAST 0
#endif
#endif

#if CRANKLOOP_ABREAST
namespace crankloop {

using Four = float __attribute__((vector_size(16)));
using FourBits = std::int32_t __attribute__((vector_size(16)));
[[nodiscard]] inline Four magnitude(const Four& x) noexcept {
  return reinterpret_cast<Four>(reinterpret_cast<FourBits>(x) & 0x7FFF'FFFF);
}

/// As many as a register holds: the compiler's target, so no layout may depend on it.
#if defined(__AVX__)
using Eight = float __attribute__((vector_size(32)));
using EightBits = std::int32_t __attribute__((vector_size(32)));
[[nodiscard]] inline Eight magnitude(const Eight& x) noexcept {
  return reinterpret_cast<Eight>(reinterpret_cast<EightBits>(x) & 0x7FFF'FFFF);
}
using WidestLanes = Eight;
#else
using WidestLanes = Four;
#endif

namespace detail {

template <class Lanes>
inline constexpr int kLanesOf = sizeof(Lanes) / sizeof(float);

template <class Lanes>
[[nodiscard, gnu::always_inline]] inline Lanes load(const float* from) noexcept {
  Lanes x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
template <class Lanes>
[[gnu::always_inline]] inline void store(float* to, const Lanes& x) noexcept {
  std::memcpy(to, &x, sizeof x);
}

/// The same where every block begins at a register's border: then the compiler may multiply by memory.
template <class Lanes>
[[nodiscard, gnu::always_inline]] inline Lanes load_aligned(const float* from) noexcept {
  return load<Lanes>(static_cast<const float*>(__builtin_assume_aligned(from, 16)));
}

/// As many 32-bit words as lanes.
template <class Lanes>
struct Words;
template <>
struct Words<Four> {
  using Bits = std::uint32_t __attribute__((vector_size(16)));
};
#if defined(__AVX__)
template <>
struct Words<Eight> {
  using Bits = std::uint32_t __attribute__((vector_size(32)));
};
#endif
template <class Lanes>
[[nodiscard, gnu::always_inline]] inline typename Words<Lanes>::Bits load_words(const std::uint32_t* from) noexcept {
  typename Words<Lanes>::Bits x;
  std::memcpy(&x, from, sizeof x);
  return x;
}

/// One bit for each lane in which a comparison holds.
[[nodiscard, gnu::always_inline]] inline std::uint32_t holding(const FourBits& holds) noexcept {
#if defined(__SSE2__)
  return static_cast<std::uint32_t>(__builtin_ia32_movmskps(reinterpret_cast<Four>(holds)));
#else
  std::uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) bits |= static_cast<std::uint32_t>(-holds[i]) << i;
  return bits;
#endif
}
#if defined(__AVX__)
[[nodiscard, gnu::always_inline]] inline std::uint32_t holding(const EightBits& holds) noexcept {
  return static_cast<std::uint32_t>(__builtin_ia32_movmskps256(reinterpret_cast<Eight>(holds)));
}
#endif
/// One for each in which it does not.
template <class Bits>
[[nodiscard, gnu::always_inline]] inline std::uint32_t failing(const Bits& holds) noexcept {
  return holding(holds) ^ ((1u << sizeof holds / 4) - 1);
}

/// Four numbers of each lane, lane by lane.
[[gnu::always_inline]] inline void store_lanes(const Four& a, const Four& b, const Four& c, const Four& d,
                                               float* to) noexcept {
#if defined(__clang__) || __GNUC__ >= 12
  const Four ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5), ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Four cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5), cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  store<Four>(to, __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5));
  store<Four>(to + 4, __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7));
  store<Four>(to + 8, __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5));
  store<Four>(to + 12, __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7));
#else
  for (int i = 0; i < 4; ++i) to[4 * i] = a[i], to[4 * i + 1] = b[i], to[4 * i + 2] = c[i], to[4 * i + 3] = d[i];
#endif
}
/// Six numbers of each of four lanes, of which from[i] are lane i's.
[[gnu::always_inline]] inline void load_lanes(const float* const (&from)[4], Four (&x)[6]) noexcept {
#if defined(__clang__) || __GNUC__ >= 12
  const Four a = load<Four>(from[0]), b = load<Four>(from[1]), c = load<Four>(from[2]), d = load<Four>(from[3]);
  const Four ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5), ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Four cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5), cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  x[0] = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5),
  x[1] = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  x[2] = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5),
  x[3] = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
  using Two = double __attribute__((vector_size(16)));
  double pairs[4];
  for (int i = 0; i < 4; ++i) std::memcpy(&pairs[i], from[i] + 4, sizeof pairs[i]);
  const Four low = reinterpret_cast<Four>(Two{pairs[0], pairs[1]}),
             high = reinterpret_cast<Four>(Two{pairs[2], pairs[3]});
  x[4] = __builtin_shufflevector(low, high, 0, 2, 4, 6), x[5] = __builtin_shufflevector(low, high, 1, 3, 5, 7);
#else
  for (int i = 0; i < 6; ++i) x[i] = Four{from[0][i], from[1][i], from[2][i], from[3][i]};
#endif
}
#if defined(__AVX__)
[[gnu::always_inline]] inline void load_lanes(const float* const (&from)[8], Eight (&x)[6]) noexcept {
  Four low[6], high[6];
  load_lanes({from[0], from[1], from[2], from[3]}, low);
  load_lanes({from[4], from[5], from[6], from[7]}, high);
  for (int i = 0; i < 6; ++i) x[i] = __builtin_shufflevector(low[i], high[i], 0, 1, 2, 3, 4, 5, 6, 7);
}
[[gnu::always_inline]] inline void store_lanes(const Eight& a, const Eight& b, const Eight& c, const Eight& d,
                                               float* to) noexcept {
  const auto half = [](const Eight& x, int which) {
    Four f;
    std::memcpy(&f, reinterpret_cast<const char*>(&x) + which * 16, sizeof f);
    return f;
  };
  for (int i = 0; i < 2; ++i) store_lanes(half(a, i), half(b, i), half(c, i), half(d, i), to + 16 * i);
}
#endif

}  // namespace detail
}  // namespace crankloop
#endif
