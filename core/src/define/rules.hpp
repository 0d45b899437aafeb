// The rules that single numbers of a definition keep.
#pragma once

#include <cstddef>

#include <crankloop/status.hpp>

namespace crankloop::detail {

inline constexpr double kLargest = 1.7976931348623157e308;

[[nodiscard]] inline bool finite(double x) noexcept { return x >= -kLargest && x <= kLargest; }

/// Least of what must be greater than zero, in SI units: its reciprocal, and products of several, stay numbers in float
/// too. A seat of 5e-312 N/m, which no file means, would be pressed in by an infinity.
inline constexpr double kLeastPositive = 1e-9;

[[nodiscard]] inline Status positive(double x, const char* field, double most) noexcept {
  if (!finite(x)) return refuse(field, Reason::not_finite);
  if (x <= 0) return refuse(field, Reason::not_positive);
  if (x < kLeastPositive || x > most) return refuse(field, Reason::out_of_range);
  return {};
}

[[nodiscard]] inline Status between(double x, const char* field, double least, double most, int index = -1) noexcept {
  if (!finite(x)) return refuse(field, Reason::not_finite, index);
  if (x < least || x > most) return refuse(field, Reason::out_of_range, index);
  return {};
}

[[nodiscard]] inline Status not_negative(double x, const char* field, double most) noexcept {
  if (!finite(x)) return refuse(field, Reason::not_finite);
  if (x < 0) return refuse(field, Reason::negative);
  if (x > most) return refuse(field, Reason::out_of_range);
  return {};
}

/// 0, which leaves something out, or what is greater than zero.
[[nodiscard]] inline Status none_or_positive(double x, const char* field, double most) noexcept {
  return x == 0 ? Status{} : positive(x, field, most);
}

/// The first of several answers that is not ok.
template <std::size_t N>
[[nodiscard]] Status first_refusal(const Status (&answers)[N]) noexcept {
  for (const Status& answer : answers) {
    if (!answer.ok()) return answer;
  }
  return {};
}

}  // namespace crankloop::detail
