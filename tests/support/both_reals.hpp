// Typed tests for both scalars of the tick.
#pragma once

#include <string>

#include <gtest/gtest.h>

namespace crankloop::tick_test {

/// float or double in a test's name.
struct RealName {
  template <class Real>
  static std::string GetName(int) {
    return sizeof(Real) == 4 ? "Float" : "Double";
  }
};
/// To long double, said aloud.
template <class Real>
[[nodiscard]] constexpr long double wide(Real x) {
  return static_cast<long double>(x);
}

using BothReals = ::testing::Types<float, double>;

}  // namespace crankloop::tick_test
