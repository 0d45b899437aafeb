// Between lanes and memory: rows of numbers for each lane, maxima.
#pragma once

#include <cstring>

#include <crankloop/tick/lanes.hpp>

#if CRANKLOOP_ABREAST
namespace crankloop::detail {

template <class Lanes>
[[nodiscard, gnu::always_inline]] inline Lanes larger(const Lanes& a, const Lanes& b) noexcept {
  return a > b ? a : b;
}
/// Raises each lane's number to x, and returns in which lanes that changed it.
template <class Lanes>
[[nodiscard, gnu::always_inline]] inline auto raise(float* number, const Lanes& x) noexcept {
  const Lanes before = load<Lanes>(number);
  const auto more = x > before;
  store<Lanes>(number, more ? x : before);
  return more;
}

/// Two numbers of each lane, those of lane i at place i.
[[gnu::always_inline]] inline void store_lanes(const Four& a, const Four& b, float* const (&to)[4]) noexcept {
#if defined(__clang__) || __GNUC__ >= 12
  using Two = double __attribute__((vector_size(16)));
  const Two low = reinterpret_cast<Two>(__builtin_shufflevector(a, b, 0, 4, 1, 5)),
            high = reinterpret_cast<Two>(__builtin_shufflevector(a, b, 2, 6, 3, 7));
  const double pairs[4] = {low[0], low[1], high[0], high[1]};
  for (int i = 0; i < 4; ++i) std::memcpy(to[i], &pairs[i], sizeof pairs[i]);
#else
  for (int i = 0; i < 4; ++i) to[i][0] = a[i], to[i][1] = b[i];
#endif
}
[[gnu::always_inline]] inline void load_lanes(const float* const (&from)[4], Four& a, Four& b) noexcept {
#if defined(__clang__) || __GNUC__ >= 12
  using Two = double __attribute__((vector_size(16)));
  double pairs[4];
  for (int i = 0; i < 4; ++i) std::memcpy(&pairs[i], from[i], sizeof pairs[i]);
  const Four low = reinterpret_cast<Four>(Two{pairs[0], pairs[1]}),
             high = reinterpret_cast<Four>(Two{pairs[2], pairs[3]});
  a = __builtin_shufflevector(low, high, 0, 2, 4, 6), b = __builtin_shufflevector(low, high, 1, 3, 5, 7);
#else
  a = Four{from[0][0], from[1][0], from[2][0], from[3][0]}, b = Four{from[0][1], from[1][1], from[2][1], from[3][1]};
#endif
}
/// Four.
[[gnu::always_inline]] inline void store_lanes(const Four& a, const Four& b, const Four& c, const Four& d,
                                               float* const (&to)[4]) noexcept {
#if defined(__clang__) || __GNUC__ >= 12
  const Four ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5), ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Four cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5), cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  store<Four>(to[0], __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5));
  store<Four>(to[1], __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7));
  store<Four>(to[2], __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5));
  store<Four>(to[3], __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7));
#else
  for (int i = 0; i < 4; ++i) to[i][0] = a[i], to[i][1] = b[i], to[i][2] = c[i], to[i][3] = d[i];
#endif
}
/// Six.
[[gnu::always_inline]] inline void store_lanes(const Four (&x)[6], float* const (&to)[4]) noexcept {
  store_lanes(x[0], x[1], x[2], x[3], to);
  store_lanes(x[4], x[5], {to[0] + 4, to[1] + 4, to[2] + 4, to[3] + 4});
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
#else
  for (int i = 0; i < 4; ++i) x[i] = Four{from[0][i], from[1][i], from[2][i], from[3][i]};
#endif
  load_lanes({from[0] + 4, from[1] + 4, from[2] + 4, from[3] + 4}, x[4], x[5]);
}
#if defined(__AVX__)
[[nodiscard, gnu::always_inline]] inline Eight joined(const Four& low, const Four& high) noexcept {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
[[nodiscard, gnu::always_inline]] inline Four half(const Eight& x, int which) noexcept {
  Four f;
  std::memcpy(&f, reinterpret_cast<const char*>(&x) + which * 16, sizeof f);
  return f;
}
[[gnu::always_inline]] inline void load_lanes(const float* const (&from)[8], Eight (&x)[6]) noexcept {
  Four low[6], high[6];
  load_lanes({from[0], from[1], from[2], from[3]}, low);
  load_lanes({from[4], from[5], from[6], from[7]}, high);
  for (int i = 0; i < 6; ++i) x[i] = joined(low[i], high[i]);
}
[[gnu::always_inline]] inline void store_lanes(const Eight& a, const Eight& b, float* const (&to)[8]) noexcept {
  store_lanes(half(a, 0), half(b, 0), {to[0], to[1], to[2], to[3]});
  store_lanes(half(a, 1), half(b, 1), {to[4], to[5], to[6], to[7]});
}
[[gnu::always_inline]] inline void store_lanes(const Eight& a, const Eight& b, const Eight& c, const Eight& d,
                                               float* const (&to)[8]) noexcept {
  store_lanes(half(a, 0), half(b, 0), half(c, 0), half(d, 0), {to[0], to[1], to[2], to[3]});
  store_lanes(half(a, 1), half(b, 1), half(c, 1), half(d, 1), {to[4], to[5], to[6], to[7]});
}
[[gnu::always_inline]] inline void store_lanes(const Eight (&x)[6], float* const (&to)[8]) noexcept {
  store_lanes(x[0], x[1], x[2], x[3], to);
  store_lanes(x[4], x[5], {to[0] + 4, to[1] + 4, to[2] + 4, to[3] + 4, to[4] + 4, to[5] + 4, to[6] + 4, to[7] + 4});
}
#endif

}  // namespace crankloop::detail
#endif
