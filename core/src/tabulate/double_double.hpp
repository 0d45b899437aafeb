// Numbers in two doubles, with twice the precision of one.
//
// What belongs here: sums, products, quotients and roots of such pairs. What does not: functions (elementary.cpp).
//
// Every operation is + - * / or sqrt, as in elementary.cpp.
#pragma once

#include <cmath>

namespace crankloop::elementary {

/// The unevaluated sum hi + lo, where hi is that sum rounded to double. Operations on pairs are accurate to about
/// 2^-102.
struct Pair {
  double hi;
  double lo;
};

/// a + b exactly, for |a| >= |b| or a == 0 (Dekker).
[[nodiscard, gnu::always_inline]] inline Pair quick_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

/// a + b exactly (Knuth).
[[nodiscard, gnu::always_inline]] inline Pair sum(double a, double b) {
  const double s = a + b;
  const double b_in_s = s - a;
  return {s, (a - (s - b_in_s)) + (b - b_in_s)};
}

/// a b exactly, from halves of 26 bits (Dekker, Veltkamp): for |a|, |b| < 2^990 and the last bit of a b above
/// 2^-1074.
[[nodiscard, gnu::always_inline]] inline Pair product(double a, double b) {
  constexpr double kSplitter = 134217729.0;  // 2^27 + 1
  const double a_high = kSplitter * a - (kSplitter * a - a);
  const double b_high = kSplitter * b - (kSplitter * b - b);
  const double a_low = a - a_high;
  const double b_low = b - b_high;
  const double p = a * b;
  return {p, ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

[[nodiscard, gnu::always_inline]] inline Pair add(Pair a, Pair b) {
  const Pair high = sum(a.hi, b.hi);
  const Pair low = sum(a.lo, b.lo);
  const Pair s = quick_sum(high.hi, high.lo + low.hi);
  return quick_sum(s.hi, s.lo + low.lo);
}

[[nodiscard, gnu::always_inline]] inline Pair subtract(Pair a, Pair b) { return add(a, {-b.hi, -b.lo}); }

[[nodiscard, gnu::always_inline]] inline Pair multiply(Pair a, Pair b) {
  const Pair p = product(a.hi, b.hi);
  return quick_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

[[nodiscard, gnu::always_inline]] inline Pair divide(Pair a, Pair b) {
  const double q = a.hi / b.hi;
  const Pair p = product(q, b.hi);
  const double rest = ((a.hi - p.hi) - p.lo) + (a.lo - q * b.lo);
  return quick_sum(q, rest / b.hi);
}

[[nodiscard]] inline Pair square_root(Pair a) {
  if (!(a.hi > 0.0)) return {0.0, 0.0};
  const double root = std::sqrt(a.hi);
  const Pair square = product(root, root);
  return quick_sum(root, (((a.hi - square.hi) - square.lo) + a.lo) / (root + root));
}

}  // namespace crankloop::elementary
