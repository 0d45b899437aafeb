// What flows back into an exhaust is what flowed out of it last.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "support/both_reals.hpp"
#include "support/gas_engine.hpp"
#include "support/gas_reference.hpp"

namespace crankloop::gas_outlet_test {
namespace {

using support::Breathing;
using support::BreathingFour;
using support::four_2000;
using tick_test::RealName;

constexpr double kTick_s = 100e-6;
constexpr int kCycle = 600;  // ticks, at 2000 rpm
const double kSpeed_rad_s = 2000 * std::acos(-1.0) / 30;

template <class Real>
class GasOutlet : public ::testing::Test {};
TYPED_TEST_SUITE(GasOutlet, tick_test::BothReals, RealName);

TYPED_TEST(GasOutlet, GivesAMotoredEngineBehindAClosedThrottleAirAndNothingElse) {
  using Real = TypeParam;
  Breathing<Real, BreathingFour> run(four_2000(), kTick_s);
  run.in.speed_rad_s = static_cast<Real>(kSpeed_rad_s);
  run.in.throttle_ratio = Real{0};
  for (Real& fuel : run.in.fuel_kg) fuel = Real{0};
  bool flows_back = false;
  for (int tick = 0; tick < 8 * kCycle; ++tick) {
    const auto& out = run.step();
    flows_back = flows_back || out.outlet_kg_s < 0;
    for (const auto& gas : out.cylinder_gas) ASSERT_EQ(gas.burned_ratio, Real{0}) << tick;
  }
  EXPECT_TRUE(flows_back);
  EXPECT_EQ(run.engine.output().gas_cycle[0].residual_ratio, Real{0});
}

/// The exhaust between two firings: what comes back is as hot and as burned as what went out.
TYPED_TEST(GasOutlet, GivesBackWhatItTook) {
  using Real = TypeParam;
  const EngineDefinition definition = four_2000();
  Breathing<Real, BreathingFour> run(definition, kTick_s);
  run.in.speed_rad_s = static_cast<Real>(kSpeed_rad_s);
  run.in.throttle_ratio = Real{0};
  support::GasReference reference(definition, static_cast<double>(run.in.speed_rad_s),
                                  definition.gas.throttle_closed_m2);
  double worst_K = 0, worst_ratio = 0, back_kg = 0;
  for (int tick = 0; tick < 6 * kCycle; ++tick) {
    const auto& out = run.step();
    for (int i = 0; i < 50; ++i) reference.step(kTick_s / 50);
    back_kg -= std::fmin(0, static_cast<double>(out.outlet_kg_s)) * kTick_s;
    worst_K = std::fmax(
        worst_K, std::fabs(static_cast<double>(out.manifold[kExhaust].temperature_K) - reference.exhaust_gas().t));
    worst_ratio = std::fmax(
        worst_ratio, std::fabs(static_cast<double>(out.manifold[kExhaust].burned_ratio) - reference.exhaust_gas().x));
  }
  EXPECT_GT(back_kg, 1e-4);
  EXPECT_LT(worst_K, 5);
  EXPECT_LT(worst_ratio, 6e-3);
}

/// Of a cylinder whose fuel is cut no burned gas is left, soon.
TYPED_TEST(GasOutlet, IsCleanSoonAfterFuelIsCut) {
  using Real = TypeParam;
  Breathing<Real, BreathingFour> run(four_2000(), kTick_s);
  run.in.speed_rad_s = static_cast<Real>(kSpeed_rad_s);
  run.in.throttle_ratio = static_cast<Real>(0.1);
  for (int tick = 0; tick < 6 * kCycle; ++tick) run.step();
  EXPECT_GT(run.engine.output().gas_cycle[0].residual_ratio, static_cast<Real>(0.05));
  for (Real& fuel : run.in.fuel_kg) fuel = Real{0};
  for (int tick = 0; tick < 40 * kCycle; ++tick) run.step();
  EXPECT_LT(run.engine.output().gas_cycle[0].residual_ratio, static_cast<Real>(0.001));
}

/// Boosted and throttled behind: 150 kPa before the throttle, 130 kPa behind the outlet.
TYPED_TEST(GasOutlet, HasAPressureOfItsOwnBehindIt) {
  using Real = TypeParam;
  EngineDefinition definition = four_2000();
  definition.gas.ambient_Pa = 150e3, definition.gas.back_Pa = 130e3;
  Breathing<Real, BreathingFour> run(definition, 50e-6);
  run.in.speed_rad_s = static_cast<Real>(kSpeed_rad_s);
  support::GasReference reference(definition, static_cast<double>(run.in.speed_rad_s), definition.gas.throttle_m2);
  double worst_Pa = 0, peak_Pa = 0, lowest_Pa = 1e9;
  for (int tick = 0; tick < 3 * 1200; ++tick) {
    const auto& out = run.step();
    for (int i = 0; i < 25; ++i) reference.step(2e-6);
    worst_Pa =
        std::fmax(worst_Pa, std::fabs(static_cast<double>(out.cylinder_gas[0].pressure_Pa) - reference.pressure(0)));
    peak_Pa = std::fmax(peak_Pa, reference.pressure(0));
    lowest_Pa = std::fmin(lowest_Pa, static_cast<double>(out.manifold[kExhaust].pressure_Pa));
  }
  EXPECT_LT(worst_Pa / peak_Pa, 2e-4);
  EXPECT_GT(lowest_Pa, 125e3);
  definition.gas.back_Pa = 900;
  const auto storage = std::make_unique<TableStorage<Real, BreathingFour>>();
  EXPECT_TRUE(support::refuses(storage->build(definition, {50e-6, {}}), Reason::out_of_range, "gas.back_Pa"));
}

}  // namespace
}  // namespace crankloop::gas_outlet_test
