// Range checks of single numbers of a definition.
#pragma once

#include <cstddef>

#include <crankloop/status.hpp>

namespace crankloop::detail {

inline constexpr double kLargest = 1.7976931348623157e308;

[[nodiscard]] inline bool finite(double x) noexcept { return x >= -kLargest && x <= kLargest; }

/// Smallest permitted value of a positive quantity, in SI units: its reciprocal, and products of several, stay finite
/// in float too. A seat stiffness of 5e-312 N/m, for example, would give an infinite compression.
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

/// Accepts 0 (left out) and positive numbers.
[[nodiscard]] inline Status none_or_positive(double x, const char* field, double most) noexcept {
  return x == 0 ? Status{} : positive(x, field, most);
}

/// The first status that is not ok.
template <std::size_t N>
[[nodiscard]] Status first_refusal(const Status (&answers)[N]) noexcept {
  for (const Status& answer : answers) {
    if (!answer.ok()) return answer;
  }
  return {};
}

}  // namespace crankloop::detail
