// A cubic over a step: values, extremum, root.
#pragma once

#include <crankloop/assert.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop::detail {

/// A cubic by the part of a step. Where one has no slope its places are infinite or no numbers, as IEEE has it, and end
/// as 1: testing first would cost a kilobyte of code on a Cortex-M4F, so the sanitizer is told to expect it.
template <class Real>
struct Cubic {
  Real c[4];

  /// Through values and slopes at both ends.
  constexpr Cubic(Real from, Real from_slope, Real to, Real to_slope) noexcept
      : c{from, from_slope, 3 * (to - from) - 2 * from_slope - to_slope, from_slope + to_slope - 2 * (to - from)} {}

  struct At {
    Real value, slope;
  };
  [[nodiscard]] constexpr At at(Real x) const noexcept {
    Real slope = c[3];
    Real value = c[2] + x * c[3];
    slope = value + x * slope;
    value = c[1] + x * value;
    slope = value + x * slope;
    value = c[0] + x * value;
    return {value, slope};
  }

  /// Moves the origin by x.
  constexpr void shift(Real x) noexcept {
    const At now = at(x);
    c[2] += 3 * x * c[3];
    c[1] = now.slope;
    c[0] = now.value;
  }

  /// Where its slope passes 0 within 0 to 1: by the slopes at both ends, and one step of Newton's method. 1 where it
  /// does not.
  [[nodiscard]] __attribute__((no_sanitize("float-divide-by-zero"))) constexpr Real extremum() const noexcept {
    const Real x = c[1] / (c[1] - (c[1] + 2 * c[2] + 3 * c[3]));
    if (!(x > 0 && x < 1)) return 1;
    const Real better = x - at(x).slope / (2 * c[2] + 6 * x * c[3]);
    return better > 0 && better < 1 ? better : x;
  }

  /// The piece from 0 to x, by the part of it.
  constexpr void shrink(Real x) noexcept {
    CRANKLOOP_ASSERT(x > 0 && x <= 1);
    c[1] *= x;
    c[2] *= x * x;
    c[3] *= x * x * x;
  }

  /// Where it reaches 0 within 0 to 1, its value at 1 given; `again`: it starts at 0, and the root is where it comes
  /// back. The root of the quadratic through both values and the first slope, in the form that does not cancel, and one
  /// step of Newton's method.
  [[nodiscard]] __attribute__((no_sanitize("float-divide-by-zero"))) Real root(bool again, Real to) const noexcept {
    const Real sum = c[1] + 2 * c[0];
    const Real square = square_root(sum * sum - 4 * c[0] * to);
    Real x = again ? c[1] / (c[1] - to) : 2 * c[0] / ((c[0] < 0 ? -square : square) - c[1]);
    if (!(x >= 0 && x <= 1)) x = 1;
    const At now = at(x);
    x -= now.value / now.slope;
    return x < 1 ? (x > 0 ? x : Real{0}) : Real{1};  // NaN ends as 1
  }
};

}  // namespace crankloop::detail
