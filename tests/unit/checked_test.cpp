// Whether a number is taken: asked of its bits in the tick, and here by plain comparison.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "support/engines.hpp"
#include "support/running.hpp"
#include "support/status.hpp"

namespace crankloop::checked_test {
namespace {

using namespace tick_test;

template <class Real>
using BitsOf = decltype(detail::bits_of(Real{}));

template <class Real>
Real from_bits(BitsOf<Real> bits) {
  Real x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

/// Both zeros, denormals, every power of two with its neighbours, infinities, numbers that are none; and around each of
/// `limits`.
template <class Real>
std::vector<Real> edges(const std::vector<Real>& limits) {
  constexpr int kMantissaBits = std::numeric_limits<Real>::digits - 1;
  constexpr auto kOne = BitsOf<Real>{1};
  constexpr auto kMantissa = static_cast<BitsOf<Real>>((kOne << kMantissaBits) - 1);
  constexpr auto kSign = static_cast<BitsOf<Real>>(kOne << (sizeof(Real) * 8 - 1));
  std::vector<Real> all;
  const auto add = [&](BitsOf<Real> bits) {
    all.push_back(from_bits<Real>(bits));
    all.push_back(from_bits<Real>(bits | kSign));
  };
  for (BitsOf<Real> exponent = 0; exponent < kSign >> kMantissaBits; ++exponent) {
    for (const BitsOf<Real> mantissa :
         {BitsOf<Real>{0}, BitsOf<Real>{1}, kMantissa / 2, kMantissa / 2 + 1, kMantissa}) {
      add(static_cast<BitsOf<Real>>(exponent << kMantissaBits) | mantissa);
    }
  }
  for (const Real limit : limits) {
    for (BitsOf<Real> i = 0; i < 5; ++i) add(static_cast<BitsOf<Real>>(detail::bits_of(limit) - 2 + i));
  }
  return all;
}

template <class Real>
class InputCheck : public ::testing::Test {};
TYPED_TEST_SUITE(InputCheck, BothReals, RealName);

TYPED_TEST(InputCheck, SaysOfEveryNumberWhatComparisonSays) {
  using Real = TypeParam;
  const std::vector<Real> limits = {static_cast<Real>(kMaxPressure_Pa), Real{2}, std::numeric_limits<Real>::min(),
                                    std::numeric_limits<Real>::max()};
  for (const Real most : limits) {
    for (const Real x : edges(limits)) {
      const bool good = x >= Real{0} && x <= most;
      ASSERT_EQ(detail::within_positive(x, most), good) << x << " up to " << most;
      ASSERT_EQ(detail::within_magnitude(x, most), x >= -most && x <= most) << x << " up to " << most;
      for (std::uint32_t place = 0; place < 4; ++place) {
        Real four[4] = {Real{0}, most, most / 2, Real{1} < most ? Real{1} : most};
        four[place] = x;
        // -0 is as good as 0, but is left to the check of one number.
        ASSERT_EQ(detail::all_within_positive(four, 4, most), good && !std::signbit(x))
            << x << " up to " << most << " at " << place;
      }
    }
  }
}

TYPED_TEST(InputCheck, ABadPressureOfFourLeavesItsCylinderTheLastGoodOneAndTheOthersTheirOwn) {
  using Real = TypeParam;
  using FourPressures = Asking<kTorque | kMeanTorque, PressureGiven::by_input, false, CrankGiven::speed, 4>;
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(diesel_495(), 100e-6)));
  const Real most = static_cast<Real>(kMaxPressure_Pa);
  for (const Real x : edges<Real>({most})) {
    const bool good = x >= Real{0} && x <= most;
    for (std::size_t cylinder = 0; cylinder < 4; ++cylinder) {
      Running<Real, FourPressures> run(tables);
      typename Engine<Real, FourPressures>::Input in;
      in.speed_rad_s = Real{100};
      for (std::size_t k = 0; k < 4; ++k) in.pressure_Pa[k] = static_cast<Real>(1e5) * static_cast<Real>(k + 1);
      run.engine.step(in);
      for (std::size_t k = 0; k < 4; ++k) in.pressure_Pa[k] *= Real{2};
      const Real before = run.engine.state().pressure_Pa[cylinder];
      in.pressure_Pa[cylinder] = x;
      ASSERT_EQ(run.engine.step(in).faults, good ? 0u : std::uint32_t{kFaultPressure}) << x;
      for (std::size_t k = 0; k < 4; ++k) {
        ASSERT_EQ(run.engine.state().pressure_Pa[k], k == cylinder && !good ? before : in.pressure_Pa[k])
            << x << ", cylinder " << k;
      }
    }
  }
}

}  // namespace
}  // namespace crankloop::checked_test
