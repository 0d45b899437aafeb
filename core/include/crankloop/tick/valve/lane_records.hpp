// Lanes to records and back: numbers that stand lane by lane in memory.
#pragma once

#include <cstring>

#include <crankloop/tick/lanes.hpp>

#if CRANKLOOP_ABREAST
namespace crankloop::detail {

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
/// Six.
[[gnu::always_inline]] inline void store_lanes(const Four (&x)[6], float* to) noexcept {
  Four first[4] = {x[0], x[1], x[2], x[3]};
  transpose(first);
  for (int i = 0; i < 4; ++i) store<Four>(to + 6 * i, first[i]);
#if defined(__clang__) || __GNUC__ >= 12
  using Two = double __attribute__((vector_size(16)));
  const Two low = reinterpret_cast<Two>(__builtin_shufflevector(x[4], x[5], 0, 4, 1, 5)),
            high = reinterpret_cast<Two>(__builtin_shufflevector(x[4], x[5], 2, 6, 3, 7));
  const double pairs[4] = {low[0], low[1], high[0], high[1]};
  for (int i = 0; i < 4; ++i) std::memcpy(to + 6 * i + 4, &pairs[i], sizeof pairs[i]);
#else
  for (int i = 0; i < 4; ++i) to[6 * i + 4] = x[4][i], to[6 * i + 5] = x[5][i];
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
[[gnu::always_inline]] inline void store_lanes(const Eight (&x)[6], float* to) noexcept {
  for (int half = 0; half < 2; ++half) {
    Four part[6];
    for (int i = 0; i < 6; ++i) std::memcpy(&part[i], reinterpret_cast<const char*>(&x[i]) + half * 16, sizeof part[i]);
    store_lanes(part, to + 24 * half);
  }
}
#endif

}  // namespace crankloop::detail
#endif
