// Curves: polynomials in the fraction of a degree, their integrals, and the grid that divides steep degrees.
//
// Oracle: the same polynomials in long double, integrals by Gauss-Legendre, places by integer division.
#include <crankloop/tables/curve.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "support/both_reals.hpp"
#include "support/random.hpp"
#include "support/units.hpp"

namespace crankloop::curve_test {

using namespace detail;
namespace {

using support::Random;
using tick_test::BothReals;
using tick_test::RealName;
using tick_test::wide;

constexpr int kDraws = 100'000;
constexpr long double kRadPerDegree = support::kWidePi / 180;

template <class Real>
Segment<Real> random_segment(Random& random) {
  Segment<Real> s{};
  for (Real& c : s.c) c = static_cast<Real>(random.between(-1, 1) * std::pow(10.0, random.between(-3, 3)));
  return s;
}

template <class Real>
long double exact_value(const Segment<Real>& s, long double u) {
  long double sum = 0;
  long double power = 1;
  for (const Real c : s.c) {
    sum += static_cast<long double>(c) * power;
    power *= u;
  }
  return sum;
}

/// Sum of the sizes of all terms: what roundings are relative to.
template <class Real>
long double size(const Segment<Real>& s) {
  long double sum = 0;
  for (const Real c : s.c) sum += std::fabs(static_cast<long double>(c));
  return sum;
}

/// Two-point Gauss-Legendre is exact for cubics.
template <class Real>
long double exact_integral(const Segment<Real>& s, long double u, long double mean) {
  const long double apart = u / 2 / std::sqrt(3.0L);
  return kRadPerDegree * u / 2 * (exact_value(s, u / 2 - apart) + exact_value(s, u / 2 + apart) - 2 * mean);
}

template <class Real>
class CurveOf : public ::testing::Test {};
TYPED_TEST_SUITE(CurveOf, BothReals, RealName);

TYPED_TEST(CurveOf, ValueIsThePolynomialToRounding) {
  using Real = TypeParam;
  // Horner's rule rounds twice per degree, relative to terms no larger than the sum of sizes.
  const long double roundings =
      2 * kCurveDegree<Real> * static_cast<long double>(std::numeric_limits<Real>::epsilon()) / 2 * 1.01L;
  Random random;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto s = random_segment<Real>(random);
    const auto u = static_cast<Real>(random.between(0, 0.999));
    ASSERT_LE(std::fabs(wide(value(s, u)) - exact_value(s, wide(u))), roundings * size(s)) << random.trace(draw);
  }
}

TYPED_TEST(CurveOf, BeginsWithItsFirstCoefficientExactlyAndNothingIntegrated) {
  using Real = TypeParam;
  Random random;
  for (int draw = 0; draw < 1000; ++draw) {
    const auto s = random_segment<Real>(random);
    ASSERT_EQ(value(s, Real{0}), s.c[0]);
    ASSERT_EQ(integral(s, Real{0}, Real{0}), Real{0});
  }
}

TYPED_TEST(CurveOf, IntegralIsThatOfThePolynomialLessItsMeanInRadians) {
  using Real = TypeParam;
  const long double roundings =
      (2 * kCurveDegree<Real> + 6) * static_cast<long double>(std::numeric_limits<Real>::epsilon()) / 2;
  Random random;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto s = random_segment<Real>(random);
    const auto u = static_cast<Real>(random.between(0, 0.999));
    const auto mean = static_cast<Real>(random.between(-10, 10));
    const long double scale = kRadPerDegree * wide(u) * (size(s) + std::fabs(wide(mean)));
    ASSERT_LE(std::fabs(wide(integral(s, u, mean)) - exact_integral(s, wide(u), wide(mean))), roundings * scale)
        << random.trace(draw);
  }
}

TYPED_TEST(CurveOf, DifferenceOfIntegralsKeepsATinyWorkBetweenTwoLargeOnes) {
  using Real = TypeParam;
  // A joule in 1e9 of quanta of 2^-20 J each: a float of the integrals themselves would keep 64 quanta of it.
  const Real quantum = sizeof(Real) == 4 ? static_cast<Real>(0x1p-20) : Real{1};
  const auto base = [](double joules) {
    if constexpr (sizeof(Real) == 4) {
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(joules * 0x1p20));
    } else {
      return joules;
    }
  };
  const Integral<Real> from{base(-1000), static_cast<Real>(0.25)};
  const Integral<Real> to{base(-1000 + 0x1p-20), static_cast<Real>(0.5)};
  EXPECT_EQ(difference(from, to, quantum), static_cast<Real>(0x1p-20) + static_cast<Real>(0.25));
  EXPECT_EQ(difference(to, from, quantum), -(static_cast<Real>(0x1p-20) + static_cast<Real>(0.25)));
  EXPECT_EQ(difference(from, from, quantum), Real{0});
}

TEST(IntegralInFloat, CountsMayWrapWhenManyCylindersAddUp) {
  // Sixteen cylinders at +1e9 quanta each wrap 2^32 three times; the tick's difference does not notice.
  Integral<float> before{};
  Integral<float> after{};
  for (int cylinder = 0; cylinder < 16; ++cylinder) {
    before += Integral<float>{1'000'000'000u, 0.0F};
    after += Integral<float>{1'000'000'000u - 7u, 0.0F};
  }
  EXPECT_EQ(difference(before, after, 1.0F), -112.0F);
  EXPECT_EQ(difference(after, before, 1.0F), 112.0F);
}

// ---- the grid -------------------------------------------------------------------------------------------------------

TEST(GasGrid, EveryDivisionOfADegreeBeginsOnTimeAndItsLastUnitIsStillInside) {
  static GasGrid grid;
  const std::uint32_t divisions[] = {1, 2, 5, 10, 20};
  std::uint32_t next = 0;
  for (std::uint32_t degree = 0; degree < 720; ++degree) {
    grid.first[degree] = static_cast<std::uint16_t>(next);
    next += divisions[degree % 5];
  }
  grid.first[720] = static_cast<std::uint16_t>(next);
  for (std::uint32_t degree = 0; degree < 720; ++degree) {
    const std::uint64_t n = divisions[degree % 5];
    EXPECT_EQ(grid.segment({degree, 0, 0}), grid.first[degree]);
    EXPECT_EQ(grid.segment({degree, 0xFFFF'FFFFu, 0}), grid.first[degree] + n - 1u);
    for (std::uint64_t i = 1; i < n; ++i) {
      const std::uint64_t first = ((i << 32) + n - 1) / n;  // the first unit not before i/n of the degree
      EXPECT_EQ(grid.segment({degree, static_cast<std::uint32_t>(first), 0}), grid.first[degree] + i);
      EXPECT_EQ(grid.segment({degree, static_cast<std::uint32_t>(first - 1), 0}), grid.first[degree] + i - 1);
    }
  }
}

TEST(GasGrid, TheFinestGridOfAllStillCounts) {
  static GasGrid grid;  // 14400 segments, 20 in every degree
  for (std::uint32_t degree = 0; degree <= 720; ++degree) grid.first[degree] = static_cast<std::uint16_t>(20 * degree);
  EXPECT_EQ(grid.segment({719, 0xFFFF'FFFFu, 0}), 14'399u);
  EXPECT_EQ(grid.segment({0, 0, 0}), 0u);
}

}  // namespace
}  // namespace crankloop::curve_test
