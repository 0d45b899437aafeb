// Floats abreast: several valves, or cylinders, in one register, by the vector extension of GCC and Clang. The only
// place that knows of it.
//
// What belongs here: loading, storing, transposing, choosing such numbers. What does not: records of them
// (valve/valve_lanes.hpp), what is computed with them: the same inline functions as with one (valve.hpp,
// gas/cylinder_gas.hpp), of + - * / sqrt and comparisons alone, so a lane has the bits that it has by itself.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

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

namespace crankloop::detail {

/// Of T, a number or lanes of them: how many, the number, unsigned words of its size, one of them by itself.
template <class T>
inline constexpr int kLanesIn = 1;
template <class T>
struct LaneTypes {
  using Number = T;
  using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
};
template <class T>
using NumberOf = typename LaneTypes<T>::Number;
template <class T>
using BitsOf = typename LaneTypes<T>::Bits;
template <class T>
[[nodiscard, gnu::always_inline]] inline NumberOf<T> lane(const T& x, int i) noexcept {
  if constexpr (kLanesIn<T> == 1) {
    return static_cast<void>(i), x;
  } else {
    return x[i];
  }
}
template <class T>
[[gnu::always_inline]] inline void put_lane(T& x, int i, NumberOf<T> number) noexcept {
  if constexpr (kLanesIn<T> == 1) {
    static_cast<void>(i), x = number;
  } else {
    x[i] = number;
  }
}
template <class T>
[[nodiscard, gnu::always_inline]] inline T load(const NumberOf<T>* from) noexcept {
  T x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
template <class T>
[[gnu::always_inline]] inline void store(NumberOf<T>* to, const T& x) noexcept {
  std::memcpy(to, &x, sizeof x);
}
/// One number in all lanes.
template <class T>
[[nodiscard, gnu::always_inline]] inline T spread(NumberOf<T> x) noexcept {
  if constexpr (kLanesIn<T> == 1) {
    return x;
  } else if constexpr (kLanesIn<T> == 4) {
    return T{x, x, x, x};
  } else {
    return T{x, x, x, x, x, x, x, x};
  }
}

/// Of a comparison. Of lanes, below, that is a mask.
[[nodiscard]] constexpr bool any(bool holds) noexcept { return holds; }
[[nodiscard]] constexpr bool all(bool holds) noexcept { return holds; }
[[nodiscard]] constexpr bool none_of(bool holds) noexcept { return !holds; }
[[nodiscard]] constexpr bool both_hold(bool a, bool b) noexcept { return a && b; }
/// One bit for each lane.
[[nodiscard]] constexpr std::uint32_t holding(bool holds) noexcept { return holds ? 1 : 0; }

/// One of two. Of lanes each its own: the other is never seen, be it no number.
template <class T, class Holds>
[[nodiscard, gnu::always_inline]] inline T pick(const Holds& holds, const T& then, const T& otherwise) noexcept {
  if constexpr (kLanesIn<T> == 1) {
    return holds ? then : otherwise;
  } else {
    return reinterpret_cast<T>((reinterpret_cast<Holds>(then) & holds) | (reinterpret_cast<Holds>(otherwise) & ~holds));
  }
}
/// The same of what is still to be computed: of one number only what is picked.
template <class T, class Holds, class Then, class Else>
[[nodiscard, gnu::always_inline]] inline T either(const Holds& holds, const Then& then,
                                                  const Else& otherwise) noexcept {
  if constexpr (kLanesIn<T> == 1) {
    return holds ? then() : otherwise();
  } else {
    return pick<T>(holds, then(), otherwise());
  }
}
/// Else +0.
template <class T, class Holds>
[[nodiscard, gnu::always_inline]] inline T where(const Holds& holds, const T& then) noexcept {
  if constexpr (kLanesIn<T> == 1) {
    return holds ? then : T{};
  } else {
    return reinterpret_cast<T>(reinterpret_cast<Holds>(then) & holds);
  }
}
/// A short cut for one number: lanes go the long way, which leads to the same.
template <class T, class Holds, class Short, class Long>
[[nodiscard, gnu::always_inline]] inline T short_cut(const Holds& holds, const Short& by_short,
                                                     const Long& by_long) noexcept {
  if constexpr (kLanesIn<T> == 1) {
    if (holds) return by_short();
  }
  return by_long();
}
/// What depends on one comparison throughout: of one number a branch with a constant in each arm.
template <class T, class Holds, class Work>
[[nodiscard, gnu::always_inline]] inline auto branch(const Holds& holds, const Work& work) noexcept {
  if constexpr (kLanesIn<T> == 1) {
    return holds ? work(std::true_type{}) : work(std::false_type{});
  } else {
    return work(holds);
  }
}
/// -x where it holds.
template <class T, class Holds>
[[nodiscard, gnu::always_inline]] inline T negative_where(const Holds& holds, const T& x) noexcept {
  if constexpr (kLanesIn<T> == 1) {
    return holds ? -x : x;
  } else {
    constexpr std::int32_t kSign = std::numeric_limits<std::int32_t>::min();
    return reinterpret_cast<T>(reinterpret_cast<Holds>(x) ^ (holds & kSign));
  }
}

}  // namespace crankloop::detail

#if CRANKLOOP_ABREAST
namespace crankloop::detail {

using Four = float __attribute__((vector_size(16)));
using FourBits = std::int32_t __attribute__((vector_size(16)));
[[nodiscard]] inline Four magnitude(const Four& x) noexcept {
  return reinterpret_cast<Four>(reinterpret_cast<FourBits>(x) & 0x7FFF'FFFF);
}

template <>
inline constexpr int kLanesIn<Four> = 4;
template <>
struct LaneTypes<Four> {
  using Number = float;
  using Bits = std::uint32_t __attribute__((vector_size(16)));
  using Halves = std::int16_t __attribute__((vector_size(16)));
};
[[nodiscard, gnu::always_inline]] inline Four square_root(const Four& x) noexcept {
#if defined(__SSE2__)
  return __builtin_ia32_sqrtps(x);
#else
  return Four{square_root(x[0]), square_root(x[1]), square_root(x[2]), square_root(x[3])};
#endif
}
/// Some lanes of two registers in a row.
template <int... I>
[[nodiscard, gnu::always_inline]] inline Four shuffled(const Four& a, const Four& b) noexcept {
#if defined(__clang__) || __GNUC__ >= 12
  return __builtin_shufflevector(a, b, I...);
#else
  return __builtin_shuffle(a, b, FourBits{I...});
#endif
}
[[gnu::always_inline]] inline void transpose(Four (&x)[4]) noexcept {
  const Four low[2] = {shuffled<0, 4, 1, 5>(x[0], x[1]), shuffled<0, 4, 1, 5>(x[2], x[3])};
  const Four high[2] = {shuffled<2, 6, 3, 7>(x[0], x[1]), shuffled<2, 6, 3, 7>(x[2], x[3])};
  x[0] = shuffled<0, 1, 4, 5>(low[0], low[1]), x[1] = shuffled<2, 3, 6, 7>(low[0], low[1]);
  x[2] = shuffled<0, 1, 4, 5>(high[0], high[1]), x[3] = shuffled<2, 3, 6, 7>(high[0], high[1]);
}

/// As many as a register holds: the compiler's target, so no layout may depend on it.
#if defined(__AVX__)
using Eight = float __attribute__((vector_size(32)));
using EightBits = std::int32_t __attribute__((vector_size(32)));
[[nodiscard]] inline Eight magnitude(const Eight& x) noexcept {
  return reinterpret_cast<Eight>(reinterpret_cast<EightBits>(x) & 0x7FFF'FFFF);
}
template <>
inline constexpr int kLanesIn<Eight> = 8;
template <>
struct LaneTypes<Eight> {
  using Number = float;
  using Bits = std::uint32_t __attribute__((vector_size(32)));
  using Halves = std::int16_t __attribute__((vector_size(32)));
};
using WidestLanes = Eight;
#else
using WidestLanes = Four;
#endif

template <class Lanes>
inline constexpr int kLanesOf = sizeof(Lanes) / sizeof(float);

/// The same where every block begins at a register's border: then the compiler may multiply by memory.
template <class Lanes>
[[nodiscard, gnu::always_inline]] inline Lanes load_aligned(const float* from) noexcept {
  return load<Lanes>(static_cast<const float*>(__builtin_assume_aligned(from, 16)));
}

template <class Lanes, bool Aligned = false>
[[nodiscard, gnu::always_inline]] inline BitsOf<Lanes> load_words(const std::uint32_t* from) noexcept {
  BitsOf<Lanes> x;
  std::memcpy(&x, Aligned ? __builtin_assume_aligned(from, 16) : from, sizeof x);
  return x;
}
/// The smaller of two words each, no less than -2^15 and less than 2^15: of halves, which every processor compares.
template <class Lanes, class Bits>
[[nodiscard, gnu::always_inline]] inline Bits smaller(const Bits& a, const Bits& b) noexcept {
  using Halves = typename LaneTypes<Lanes>::Halves;
  const auto x = reinterpret_cast<Halves>(a), y = reinterpret_cast<Halves>(b);
  return reinterpret_cast<Bits>(x < y ? x : y);
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
[[nodiscard, gnu::always_inline]] inline bool any(const FourBits& holds) noexcept { return holding(holds) != 0; }
[[nodiscard, gnu::always_inline]] inline bool all(const FourBits& holds) noexcept { return holding(holds) == 15; }
[[nodiscard, gnu::always_inline]] inline FourBits none_of(const FourBits& holds) noexcept { return ~holds; }
[[nodiscard, gnu::always_inline]] inline FourBits both_hold(const FourBits& a, const FourBits& b) noexcept {
  return a & b;
}
/// One for each in which it does not.
template <class Bits>
[[nodiscard, gnu::always_inline]] inline std::uint32_t failing(const Bits& holds) noexcept {
  return holding(holds) ^ ((1u << sizeof holds / 4) - 1);
}

}  // namespace crankloop::detail
#endif
