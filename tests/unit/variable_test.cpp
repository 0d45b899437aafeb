// Variables by name and value: the unit that a name ends in, and what of a number each kind of value keeps.
#include <crankloop/variable.hpp>
#include <crankloop/variable_values.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace crankloop::variable_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(UnitOfName, IsTheOneInWhichItEndsItsIndexLeftAside) {
  const auto written = [](const char* name) { return std::string(detail::unit_of(name).written); };
  EXPECT_EQ(written("speed_rad_s"), "rad/s");
  EXPECT_EQ(written("valve[2,1].lift_m"), "m");
  EXPECT_EQ(written("pressure_Pa[3]"), "Pa");
  EXPECT_EQ(written("reluctor_V[12]"), "V");
  for (const char* none : {"load_ratio", "level[1]", "", "]", "_", "m"}) EXPECT_EQ(written(none), "1") << none;
}

TEST(PhaseOfDegrees, IsThatOfTheirCycleWhereverTheyAre) {
  for (const double deg : {0.0, 90.0, 719.5, -90.0, 720.0, 7290.0, -7290.0, 720e6 + 45}) {
    const double in_cycle = deg - 720 * std::floor(deg / 720);
    EXPECT_NEAR(detail::degrees_of(detail::phase_of(deg)), in_cycle, std::fabs(deg) * 1e-15 + 1e-12) << deg;
  }
}

TEST(PhaseOfDegrees, IsZeroOfWhatIsNoAngle) {
  for (const double deg : {kNaN, kInfinite, -kInfinite, 720.1e9, -720.1e9, 1e300})
    EXPECT_EQ(detail::phase_of(deg).units(), 0u) << deg;
  EXPECT_NE(detail::phase_of(719.9e9 + 90).units(), 0u) << "just below 10^9 cycles";
}

/// What a number becomes where it is kept, and as which number it is read again.
double kept(detail::Storage storage, double number) {
  union {
    double real;
    float single;
    std::uint64_t phase;
    std::uint32_t word;
  } room{};
  double read = 0;
  detail::with_value(storage, &room, [number](auto& value) { detail::assign(value, number); });
  detail::with_value(storage, &room, [&read](const auto& value) { read = detail::as_number(value); });
  return read;
}

TEST(ValueOfAVariable, IsReadAsItWasKept) {
  using detail::Storage;
  EXPECT_EQ(kept(Storage::real, 0.1), 0.1);
  EXPECT_EQ(kept(Storage::single_real, 0.1), static_cast<double>(0.1F));
  EXPECT_EQ(kept(Storage::phase, 90), 90);
  EXPECT_EQ(kept(Storage::phase, -90), 630);
  EXPECT_EQ(kept(Storage::word, 4294967295.0), 4294967295.0);
  EXPECT_EQ(kept(Storage::word, 2.9), 2);
}

TEST(ValueOfAVariable, IsNeverWhatItsKindCannotHold) {
  using detail::Storage;
  EXPECT_TRUE(std::isnan(kept(Storage::single_real, 1e39)));
  EXPECT_TRUE(std::isnan(kept(Storage::single_real, -1e39)));
  EXPECT_TRUE(std::isnan(kept(Storage::real, kNaN)));
  for (const double bad : {-1.0, 4294967296.0, kNaN, kInfinite}) EXPECT_EQ(kept(Storage::word, bad), 0) << bad;
  for (const double bad : {kNaN, kInfinite, 1e300}) EXPECT_EQ(kept(Storage::phase, bad), 0) << bad;
}

}  // namespace
}  // namespace crankloop::variable_test
