// What a number may be.
#pragma once

#include <limits>

namespace crankloop {

/// Built as it reads: above(0).up_to(2), from(0).below(720). Range{}: any number.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool without_least = false;
  bool without_most = false;

  [[nodiscard]] constexpr Range up_to(double limit) const noexcept { return {least, limit, without_least, false}; }
  [[nodiscard]] constexpr Range below(double limit) const noexcept { return {least, limit, without_least, true}; }
  [[nodiscard]] constexpr bool contains(double value) const noexcept {
    return (without_least ? value > least : value >= least) && (without_most ? value < most : value <= most);
  }
};

[[nodiscard]] constexpr Range above(double limit) noexcept {
  return {limit, std::numeric_limits<double>::infinity(), true, false};
}
[[nodiscard]] constexpr Range from(double limit) noexcept {
  return {limit, std::numeric_limits<double>::infinity(), false, false};
}

}  // namespace crankloop
