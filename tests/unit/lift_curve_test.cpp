// The tick's table of valve lift against the geometry that it stands for, over the whole turn of the cam.
#include <crankloop/tables/lift_curve.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "crankloop/engine_file/engine_file.hpp"
#include "support/both_reals.hpp"
#include "support/random.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"

namespace crankloop::lift_curve_test {

using namespace detail;
namespace {

using tick_test::BothReals;
using tick_test::RealName;
using valve_test::kPi;
using valve_test::kRadPerDeg;

// What the table may be off by in double, of a cam with smooth lift.
constexpr double kLift_m = 0.005e-6;
constexpr double kSpeedOfPeak = 1e-5;

/// Float adds, in units of its largest value's rounding: the coefficients', and that of some ten operations, which grow
/// towards the value.
constexpr double kRoundings = 4;

constexpr int kRandomPhases = 100'000;

/// Some random cams end more sharply than any that is ground: of 100 the worst is off by 1.04e-5 in speed.
constexpr double kSharpEnds = 1.5;

struct NamedTrain {
  std::string name;
  double sharpness;  ///< times kSpeedOfPeak
  ValveTrain train;
};

/// The trains of the sample engines, and some of cars and motorcycles that do not exist.
std::vector<NamedTrain> named_trains() {
  std::vector<NamedTrain> trains;
  for (const char* name : {"ohc_125", "diesel_495"}) {
    const std::string path = std::string(CRANKLOOP_SOURCE_DIR) + "/tools/engines/" + name + ".ini";
    const EngineDefinition engine = program::read_engine_file(path, {}).definition();
    for (int t = 0; t < engine.train_count; ++t)
      trains.push_back({std::string(name) + ", train " + std::to_string(t), 1, engine.trains[t]});
  }
  support::Random random;
  for (int draw = 0; trains.size() < 8; ++draw) {
    ValveTrain train = valve_test::ohc_125_train();
    train.cam = support::random_cam(random);
    train.cam.exponents[0] = 2;  // else the nose's curvature has a cusp, which no table with knots elsewhere can follow
    train.rocker = support::random_rocker(random);
    ValveLift lift;
    if (lift.init(train.cam, train.rocker).ok()) trains.push_back({random.trace(draw), kSharpEnds, train});
  }
  return trains;
}

/// A train's table by itself: all that this test knows of how a curve is stored.
template <class Real>
class LiftTable {
 public:
  explicit LiftTable(const ValveTrain& train) {
    EXPECT_TRUE(accepted(storage_->build(valve_test::engine_with(train), {100e-6})));
  }
  [[nodiscard]] Lift<Real> at(std::uint64_t since_opening) const {
    return storage_->tables().lift_curves[0].read(LiftCurve<Real>::cell(since_opening));
  }

 private:
  using Storage = TableStorage<Real, tick_test::CamFollowing>;
  std::unique_ptr<Storage> storage_ = std::make_unique<Storage>();
};

/// Phases all over the turn, and on either side of every border between two segments of a degree.
std::vector<std::uint64_t> phases() {
  std::vector<std::uint64_t> all;
  support::Random random;
  for (int i = 0; i < kRandomPhases; ++i) all.push_back(random.bits());
  for (int degree = 0; degree < 360; ++degree) {
    const auto border = static_cast<std::uint64_t>(std::ceil(static_cast<long double>(degree) * (0x1p64L / 360)));
    for (const std::uint64_t unit : {border - 1, border, border + 1}) all.push_back(unit);
  }
  return all;
}

template <class Real>
class LiftCurveIn : public testing::Test {};
TYPED_TEST_SUITE(LiftCurveIn, BothReals, RealName);

TYPED_TEST(LiftCurveIn, IsTheGeometryOverTheWholeTurn) {
  using Real = TypeParam;
  const double rounding =
      sizeof(Real) == 4 ? kRoundings * static_cast<double>(std::numeric_limits<Real>::epsilon()) : 0;
  const std::vector<std::uint64_t> everywhere = phases();
  double worst_lift_m = 0;
  double worst_speed = 0;
  for (const NamedTrain& named : named_trains()) {
    SCOPED_TRACE(named.name);
    const ValveLift exact = valve_test::lift_of(named.train);
    const LiftTable<Real> table(named.train);
    double peak_m_per_deg = 0;
    for (int tenth = 0; tenth < 3600; ++tenth)
      peak_m_per_deg = std::max(peak_m_per_deg, std::abs(exact.at(tenth * 0.1 * kRadPerDeg).per_rad_m) * kRadPerDeg);
    double lift_off_m = 0;
    double speed_off = 0;  // of the peak
    double lift_at_deg = 0;
    double speed_at_deg = 0;
    for (const std::uint64_t phase : everywhere) {
      const double cam_rad = exact.opens_rad() + static_cast<double>(phase) * (2 * kPi / 0x1p64);
      const LiftPose pose = exact.at(cam_rad);
      const Lift<Real> read = table.at(phase);
      const double lift = std::abs(static_cast<double>(read.lift_m) - pose.lift_m);
      const double speed = std::abs(static_cast<double>(read.per_deg_m) - pose.per_rad_m * kRadPerDeg) / peak_m_per_deg;
      if (lift > lift_off_m) lift_off_m = lift, lift_at_deg = cam_rad / kRadPerDeg;
      if (speed > speed_off) speed_off = speed, speed_at_deg = cam_rad / kRadPerDeg;
    }
    EXPECT_LE(lift_off_m, kLift_m + rounding * exact.largest_lift_m()) << lift_at_deg << " deg of the cam";
    EXPECT_LE(speed_off, named.sharpness * kSpeedOfPeak + rounding) << speed_at_deg << " deg of the cam";
    worst_lift_m = std::max(worst_lift_m, lift_off_m);
    worst_speed = std::max(worst_speed, speed_off);
    std::printf("%-32s lift off by %.2g um at %.2f deg, speed by %.2g of its peak at %.2f deg\n", named.name.c_str(),
                lift_off_m * 1e6, lift_at_deg, speed_off, speed_at_deg);
  }
  this->RecordProperty("largest_lift_error_um", std::to_string(worst_lift_m * 1e6));
  this->RecordProperty("largest_speed_error_of_peak_1e_6", std::to_string(worst_speed * 1e6));
}

TYPED_TEST(LiftCurveIn, IsTheClearanceExactlyWhereTheLobeIsNot) {
  using Real = TypeParam;
  for (const NamedTrain& named : named_trains()) {
    SCOPED_TRACE(named.name);
    const ValveLift exact = valve_test::lift_of(named.train);
    const LiftTable<Real> table(named.train);
    const double lobe_deg = (exact.closes_rad() - exact.opens_rad()) / kRadPerDeg;
    for (double deg = std::ceil(lobe_deg) + 0.01; deg < 360; deg += 0.37) {
      const Lift<Real> read = table.at(static_cast<std::uint64_t>(deg * (0x1p64 / 360)));
      EXPECT_EQ(read.lift_m, static_cast<Real>(-named.train.rocker.clearance_m)) << deg;
      EXPECT_EQ(read.per_deg_m, Real{0}) << deg;
    }
  }
}

}  // namespace
}  // namespace crankloop::lift_curve_test
