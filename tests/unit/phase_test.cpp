// The crank phase: counted without drift, turned to numbers and to places in a per-degree table without ever being off
// by one.
//
// Oracle: integer arithmetic on 2^64 units, and the binary digits of the numbers that go in.
#include <crankloop/phase.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "support/both_reals.hpp"
#include "support/random.hpp"

namespace crankloop::phase_test {

using namespace detail;
namespace {

using support::Random;
using tick_test::BothReals;
using tick_test::RealName;

constexpr std::uint64_t kHalfCycle = std::uint64_t{1} << 63;
constexpr std::uint64_t kLastUnit = ~std::uint64_t{0};
constexpr int kDraws = 1'000'000;

/// floor(2^64 k / n): the unit in which part k of n parts of a cycle begins, or the one before it where it begins
/// between two.
std::uint64_t units_of_part(std::uint64_t k, std::uint64_t n) {
  const std::uint64_t quotient = kLastUnit / n;  // 2^64 = quotient n + rest
  const std::uint64_t rest = kLastUnit % n + 1;
  return k * quotient + k * rest / n;
}

/// The first unit that lies in part k of n.
std::uint64_t first_unit_of_part(std::uint64_t k, std::uint64_t n) {
  const std::uint64_t rest = kLastUnit % n + 1;
  return units_of_part(k, n) + (k * rest % n != 0 ? 1 : 0);
}

/// cycles * 2^64, cut toward zero, from the number's own binary digits.
template <class Real>
std::uint64_t units_by_digits(Real cycles) {
  int exponent = 0;
  const Real digits = std::frexp(cycles < 0 ? -cycles : cycles, &exponent);  // in [0.5, 1)
  constexpr int kDigits = std::numeric_limits<Real>::digits;
  const auto whole = static_cast<std::uint64_t>(std::ldexp(digits, kDigits));
  const int shift = 64 + exponent - kDigits;
  const std::uint64_t units = shift >= 0 ? whole << shift : (shift > -64 ? whole >> -shift : 0);
  return cycles < 0 ? 0 - units : units;
}

/// What from_cycles keeps: 2^-62 of a cycle, so a number whose last digit is worth that or more comes through whole.
constexpr std::uint64_t kUnitsCutOff = 3;
template <class Real>
const Real kLeastExact = std::ldexp(Real{1}, std::numeric_limits<Real>::digits - 1 - 62);

// ---- counting -------------------------------------------------------------------------------------------------------

TEST(Phase, ReturnsToTdcAfterAThousandCyclesOfTicksThatDivideNothingEvenly) {
  const Phase step{kLastUnit / 36'007 + 1};  // rounded up: gains 36007 * at most 1 unit a cycle
  Phase phase;
  for (int tick = 0; tick < 36'007 * 1'000; ++tick) phase += step;
  EXPECT_LE(phase.units(), 36'007'000u);  // one unit a tick at most: 2e-12 of a cycle in a thousand cycles
}

TEST(Phase, TurnsBackwardsThroughTheSameAngles) {
  Random random;
  Phase phase{random.bits()};
  const Phase start = phase;
  const Phase step = Phase::from_cycles(0.001234567);
  const Phase back = Phase::from_cycles(-0.001234567);
  for (int tick = 0; tick < 10'000; ++tick) phase += step;
  for (int tick = 0; tick < 10'000; ++tick) phase += back;
  EXPECT_EQ(phase.units(), start.units());
}

TEST(Phase, WrapsAtBothEndsOfTheCycle) {
  EXPECT_EQ((Phase{kLastUnit} + Phase{1}).units(), 0u);
  EXPECT_EQ((Phase{0} - Phase{1}).units(), kLastUnit);
  EXPECT_EQ((Phase{kHalfCycle} + Phase{kHalfCycle}).units(), 0u);
}

// ---- from and to numbers --------------------------------------------------------------------------------------------

template <class Real>
class PhaseOf : public ::testing::Test {};
TYPED_TEST_SUITE(PhaseOf, BothReals, RealName);

TYPED_TEST(PhaseOf, NumbersKnownByHand) {
  using Real = TypeParam;
  EXPECT_EQ(Phase::from_cycles(Real{0}).units(), 0u);
  EXPECT_EQ(Phase::from_cycles(-Real{0}).units(), 0u);
  EXPECT_EQ(Phase::from_cycles(Real{0.25}).units(), std::uint64_t{1} << 62);
  EXPECT_EQ(Phase::from_cycles(Real{-0.25}).units(), std::uint64_t{3} << 62);
  EXPECT_EQ(Phase::from_cycles(Real{0.5}).units(), kHalfCycle);
  EXPECT_EQ(Phase::from_cycles(Real{-0.5}).units(), kHalfCycle);
  const Real below_half = std::nextafter(Real{0.5}, Real{0});
  EXPECT_EQ(Phase::from_cycles(below_half).units(), units_by_digits(below_half));
  EXPECT_EQ(Phase::from_cycles(-below_half).units(), units_by_digits(-below_half));
  const Real below_one = std::nextafter(Real{1}, Real{0});
  EXPECT_EQ(Phase::from_cycles(below_one).units(), units_by_digits(below_one));
  EXPECT_EQ(Phase::from_cycles(-below_one).units(), units_by_digits(-below_one));
  EXPECT_EQ(Phase::from_cycles(std::numeric_limits<Real>::denorm_min()).units(), 0u);
  EXPECT_EQ(Phase::from_cycles(-std::numeric_limits<Real>::min()).units(), 0u);
}

TYPED_TEST(PhaseOf, ANumberIsExactAsFarAsItsDigitsAreWorth2ToMinus62OfACycle) {
  using Real = TypeParam;
  Random random;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto x = static_cast<Real>(random.between(-1, 1));
    if (x <= Real{-1} || x >= Real{1} || std::fabs(x) < kLeastExact<Real>) continue;
    ASSERT_EQ(Phase::from_cycles(x).units(), units_by_digits(x)) << random.trace(draw) << ", cycles " << x;
  }
}

TYPED_TEST(PhaseOf, ASmallNumberLosesAtMostThreeUnitsTowardZeroTheSameInBothDirections) {
  using Real = TypeParam;
  Random random;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto x = static_cast<Real>(std::ldexp(random.between(0.5, 1), -random.whole(0, 70)));
    if (x >= Real{1}) continue;
    const std::uint64_t exact = units_by_digits(x);
    const std::uint64_t got = Phase::from_cycles(x).units();
    ASSERT_LE(got, exact) << random.trace(draw) << ", cycles " << x;
    ASSERT_LE(exact - got, kUnitsCutOff) << random.trace(draw) << ", cycles " << x;
    ASSERT_EQ(Phase::from_cycles(-x).units(), 0 - got) << random.trace(draw) << ", cycles " << x;
  }
}

TYPED_TEST(PhaseOf, SignedCyclesUndoesFromCycles) {
  using Real = TypeParam;
  Random random;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto x = static_cast<Real>(random.between(-0.5, 0.5));
    if (x >= Real{0.5} || std::fabs(x) < kLeastExact<Real>) continue;
    ASSERT_EQ(Phase::from_cycles(x).template signed_cycles<Real>(), x) << random.trace(draw);
  }
}

TYPED_TEST(PhaseOf, SignedCyclesOfAnyPhaseIsRightToRounding) {
  using Real = TypeParam;
  // The phase's two words are rounded, and so is their sum: three roundings, the first two in units of 2^-32 cycle when
  // they cancel.
  const long double relative = 2 * static_cast<long double>(std::numeric_limits<Real>::epsilon());
  const long double absolute = 0x1p-32L * static_cast<long double>(std::numeric_limits<Real>::epsilon()) + 0x1p-63L;
  Random random;
  const std::uint64_t corners[] = {0,
                                   1,
                                   2,
                                   kLastUnit,
                                   kLastUnit - 1,
                                   kHalfCycle,
                                   kHalfCycle - 1,
                                   kHalfCycle + 1,
                                   std::uint64_t{1} << 32,
                                   (std::uint64_t{1} << 32) - 1,
                                   0 - (std::uint64_t{1} << 32)};
  const int corner_count = static_cast<int>(sizeof corners / sizeof corners[0]);
  for (int draw = 0; draw < kDraws; ++draw) {
    const std::uint64_t units = draw < corner_count ? corners[draw] : random.bits() >> random.whole(0, 63);
    const long double exact = static_cast<long double>(static_cast<std::int64_t>(units)) * 0x1p-64L;
    const Real got = Phase{units}.template signed_cycles<Real>();
    ASSERT_GE(got, Real{-0.5});
    ASSERT_LE(got, Real{0.5});
    ASSERT_LE(std::fabs(static_cast<long double>(got) - exact), relative * std::fabs(exact) + absolute)
        << random.trace(draw) << ", units " << units;
  }
}

// ---- places in a per-degree table -----------------------------------------------------------------------------------

TYPED_TEST(PhaseOf, LastUnitOfTheCycleLiesInItsLastDegreeAndBelowItsEnd) {
  using Real = TypeParam;
  const Cell cell = Phase{kLastUnit}.template cell<Real>();
  EXPECT_EQ(cell.degree, 719u);
  EXPECT_LT(fraction<Real>(cell), Real{1});
  EXPECT_GT(fraction<Real>(cell), static_cast<Real>(0.9999));
}

TYPED_TEST(PhaseOf, EveryDegreeBeginsWhereItShouldAndTheUnitBeforeIsStillTheLastOfTheDegreeBefore) {
  using Real = TypeParam;
  // float reads the top word only: a border counts from the next 2^32 units on, which is at most 1.7e-7 deg late and
  // never early.
  const std::uint64_t late = sizeof(Real) == 4 ? 0xFFFF'FFFFu : 0;
  for (std::uint32_t degree = 0; degree < 720; ++degree) {
    const std::uint64_t first = (first_unit_of_part(degree, 720) + late) & ~late;
    const Cell at = Phase{first}.template cell<Real>();
    const Cell after = Phase{first + 1}.template cell<Real>();
    const Cell before = Phase{first - 1}.template cell<Real>();
    ASSERT_EQ(at.degree, degree);
    ASSERT_EQ(after.degree, degree);
    ASSERT_EQ(before.degree, (degree + 719) % 720);
    ASSERT_LT(fraction<Real>(at), static_cast<Real>(720 * 0x1p-32));
    ASSERT_GT(fraction<Real>(before), static_cast<Real>(0.9999));
    ASSERT_LT(fraction<Real>(before), Real{1});
  }
}

TYPED_TEST(PhaseOf, AnyPhaseFindsItsPlaceToTheLastDigitTheScalarCanUse) {
  using Real = TypeParam;
  Random random;
  const std::uint64_t kept = sizeof(Real) == 4 ? ~std::uint64_t{0xFFFF'FFFF} : ~std::uint64_t{0};
  for (int draw = 0; draw < kDraws; ++draw) {
    const std::uint64_t units = random.bits();
    const Cell got = Phase{units}.template cell<Real>();
    ASSERT_LT(got.degree, 720u);
    ASSERT_GE(units & kept, first_unit_of_part(got.degree, 720) & kept) << random.trace(draw);
    if (got.degree < 719) {
      ASSERT_LT(units & kept, first_unit_of_part(got.degree + 1, 720)) << random.trace(draw);
    }
    // `into` and `rest` are the way from the border in 2^-64 deg: 720 of them to a unit, and the border lies up to one
    // unit before the first.
    const auto since_border = static_cast<long double>((units & kept) - units_of_part(got.degree, 720)) * 720;
    const auto way = static_cast<long double>((std::uint64_t{got.into} << 32) + got.rest);
    ASSERT_LE(std::fabs(since_border - way), 720.0L) << random.trace(draw);
    if (sizeof(Real) == 4) {
      ASSERT_EQ(got.rest, 0u);
    }
  }
}

TYPED_TEST(PhaseOf, AWholeCircleMayBeDividedOtherwise) {
  using Real = TypeParam;
  // A camshaft's turn is 2^64 units too, in 360 deg of its own.
  EXPECT_EQ(cell_of<Real>(0, 360).degree, 0u);
  EXPECT_EQ(cell_of<Real>(kHalfCycle, 360).degree, 180u);
  EXPECT_EQ(cell_of<Real>(kHalfCycle - 1, 360).degree, 179u);
  EXPECT_EQ(cell_of<Real>(kLastUnit, 360).degree, 359u);
  EXPECT_LT(fraction<Real>(cell_of<Real>(kLastUnit, 360)), Real{1});
  EXPECT_EQ(fraction<Real>(cell_of<Real>(std::uint64_t{1} << 61, 4)), Real{0.5});
}

TYPED_TEST(PhaseOf, FractionRisesFromZeroAndStaysBelowOne) {
  using Real = TypeParam;
  EXPECT_EQ(fraction<Real>({0, 0, 0}), Real{0});
  EXPECT_EQ(fraction<Real>({719, 0x8000'0000u, 0}), Real{0.5});
  EXPECT_EQ(fraction<Real>({0, 0x4000'0000u, 0}), Real{0.25});
  EXPECT_LT(fraction<Real>({0, 0xFFFF'FFFFu, 0xFFFF'FFFFu}), Real{1});
  // What is dropped is at most the digits that do not fit: 2^-24 of a degree in float, 2^-53 in double.
  const long double dropped = sizeof(Real) == 4 ? 0x1p-24L : 0x1p-53L;
  Random random;
  Real last{0};
  std::uint64_t way = 0;
  for (int draw = 0; way < kLastUnit - (kLastUnit >> 14);
       way += random.bits() >> 14, ++draw) {  // 2^-15 of a degree at a time
    const Real got = fraction<Real>({0, static_cast<std::uint32_t>(way >> 32), static_cast<std::uint32_t>(way)});
    const long double exact = static_cast<long double>(way) * 0x1p-64L;
    ASSERT_GE(got, last) << random.trace(draw);
    ASSERT_LE(static_cast<long double>(got), exact) << random.trace(draw);
    ASSERT_LT(exact - static_cast<long double>(got), dropped) << random.trace(draw);
    last = got;
  }
}

}  // namespace
}  // namespace crankloop::phase_test
