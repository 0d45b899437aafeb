// The rules that single numbers of a definition keep: the ranges that each_field() lists.
#pragma once

#include <array>
#include <cstddef>

#include <crankloop/define/field.hpp>
#include <crankloop/status.hpp>

namespace crankloop::detail {

inline constexpr double kLargest = 1.7976931348623157e308;

[[nodiscard]] inline bool finite(double x) noexcept { return x >= -kLargest && x <= kLargest; }

/// Smallest permitted value of a positive quantity, in SI units: its reciprocal, and products of several, stay finite
/// in float too. A seat stiffness of 5e-312 N/m, for example, would give an infinite compression.
inline constexpr double kLeastPositive = 1e-9;

[[nodiscard]] inline Status in_range(double x, const char* field, const Range& range, int index = -1) noexcept {
  const bool positive = range.least == 0 && range.without_least;
  if (!finite(x)) return refuse(field, Reason::not_finite, index);
  if (positive && x <= 0) return refuse(field, Reason::not_positive, index);
  if (range.least == 0 && x < 0) return refuse(field, Reason::negative, index);
  if (!range.contains(x) || (positive && x < kLeastPositive)) return refuse(field, Reason::out_of_range, index);
  return {};
}

/// 0, which leaves something out, or what is greater than zero.
[[nodiscard]] inline Status none_or_positive(double x, const char* field) noexcept {
  return x == 0 ? Status{} : in_range(x, field, above(0));
}

/// Finds the first number of a struct that is read and out of its range. Its parts are for themselves.
struct FindOutOfRange {
  Status status{};

  void operator()(const ListedField& listed, const double& x) noexcept {
    if (status.ok() && listed.read > 0) status = in_range(x, listed.name, listed.range);
  }
  void operator()(const ListedField& listed, const int& x) noexcept { (*this)(listed, static_cast<double>(x)); }
  template <std::size_t N>
  void operator()(const ListedField& listed, const std::array<double, N>& list) noexcept {
    entries(listed, list.data(), static_cast<int>(N));
  }
  template <std::size_t N>
  void operator()(const ListedField& listed, const double (&list)[N]) noexcept {
    entries(listed, list, static_cast<int>(N));
  }
  template <class Other>
  void operator()(const ListedField&, const Other&) noexcept {}

 private:
  void entries(const ListedField& listed, const double* list, int room) noexcept {
    for (int i = 0; i < listed.read && i < room && status.ok(); ++i)
      status = in_range(list[i], listed.name, listed.range, i);
  }
};
template <class Struct>
[[nodiscard]] Status out_of_range(const Struct& part) noexcept {
  FindOutOfRange find;
  Struct::each_field(find, part);
  return find.status;
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
