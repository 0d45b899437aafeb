// Inputs and outputs by a controller's names: the spark that is a burn start, sensors that other names show already.
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/variables.hpp>

#include "support/both_reals.hpp"
#include "support/gas_engine.hpp"
#include "support/output_fields.hpp"

namespace crankloop::controller_names_test {
namespace {

using support::rad_s;
using tick_test::RealName;

struct Named : support::BreathingFour {
  static constexpr bool controller_names = true;
  static constexpr bool charge_burn = true;
  static constexpr bool walls = true;
};

[[nodiscard]] EngineDefinition four(bool by_charge) {
  EngineDefinition engine = support::four_2000();
  engine.gas.fuel_kg = 20e-6;
  engine.gas.charge_burn.in_use = by_charge;
  engine.gas.charge_burn.spark_to_start_deg = by_charge ? 8 : 0;
  engine.gas.walls.capacity_J_K = 600, engine.gas.walls.coolant_K = 361;
  return engine;
}

template <class Real>
[[nodiscard]] std::unique_ptr<support::Breathing<Real, Named>> turning(const EngineDefinition& engine) {
  auto run = std::make_unique<support::Breathing<Real, Named>>(engine, 100e-6);
  run->in.speed_rad_s = static_cast<Real>(rad_s(3000));
  run->in.throttle_ratio = static_cast<Real>(0.4);
  return run;
}

/// Without what pads a struct, which may be anything.
template <class Real>
[[nodiscard]] std::vector<double> numbers_of(const Output<Real, Named>& out) {
  std::vector<double> numbers;
  support::each_output(out, support::Used{4, 4, 2}, [&numbers](const char*, std::size_t, auto value) {
    numbers.push_back(static_cast<double>(value));
  });
  return numbers;
}

template <class Real>
class ControllerNames : public ::testing::Test {};
TYPED_TEST_SUITE(ControllerNames, tick_test::BothReals, RealName);

TYPED_TEST(ControllerNames, ASparkAdvanceIsTheBurnStartBeforeDeadCentreBitByBit) {
  using Real = TypeParam;
  for (const bool by_charge : {false, true}) {
    const auto by_start = turning<Real>(four(by_charge)), by_spark = turning<Real>(four(by_charge));
    by_spark->in.by_spark_advance = 1;
    for (int tick = 0; tick < 2000; ++tick) {
      for (int k = 0; k < 4; ++k) {
        const double advance_deg = 12 + 5 * k + 8 * std::sin(tick * 0.003);
        by_start->in.burn_start_deg[k] = static_cast<Real>(-advance_deg);
        by_spark->in.spark_advance_deg[k] = static_cast<Real>(advance_deg);
        by_spark->in.burn_start_deg[k] = Real{40};  // counts for nothing
      }
      const auto &one = by_start->step(), &other = by_spark->step();
      ASSERT_EQ(one.faults, 0u);
      const std::vector<double> left = numbers_of(one), right = numbers_of(other);
      ASSERT_EQ(std::memcmp(left.data(), right.data(), left.size() * sizeof(double)), 0) << tick;
    }
    EXPECT_GT(by_start->engine.output().gas_cycle[0].heat_J, 100);
    if (by_charge) {  // the delay of the burn by charge: the burn begins later than its spark
      EXPECT_GT(by_spark->engine.output().cycle_burn[0].start_deg, -by_spark->in.spark_advance_deg[0] + 3);
    }
  }
}

TYPED_TEST(ControllerNames, AnAdvanceOutOfRangeIsToldAndTheLastGoodOneUsed) {
  using Real = TypeParam;
  const auto run = turning<Real>(four(false));
  run->in.by_spark_advance = 1;
  for (Real& advance : run->in.spark_advance_deg) advance = Real{25};
  for (int tick = 0; tick < 1000; ++tick) ASSERT_EQ(run->step().faults, 0u);
  std::uint32_t faults = 0;
  for (Real& advance : run->in.spark_advance_deg) advance = Real{91};
  for (int tick = 0; tick < 400; ++tick) faults |= run->step().faults;
  EXPECT_EQ(faults, std::uint32_t{kFaultBurn});
  for (const auto& burn : run->engine.state().burn) EXPECT_EQ(burn.start_deg, Real{-25});
}

TYPED_TEST(ControllerNames, SensorsAreWhatTheOtherNamesShow) {
  using Real = TypeParam;
  const auto run = turning<Real>(four(false));
  for (int tick = 0; tick < 2000; ++tick) run->step();
  std::map<std::string, double> shown;
  const auto& out = run->engine.output();
  detail::each_output<Named>(
      [&shown](const detail::Variable& variable, const auto& value) {
        if constexpr (!std::is_same_v<decltype(value), const Phase&>) {
          if (variable.first < 1) shown[variable.name] = static_cast<double>(value);
        }
      },
      run->engine.state(), out, detail::shape_of<Real, Named>(run->storage.tables()));
  EXPECT_EQ(shown.at("map_Pa"), static_cast<double>(out.manifold[kIntake].pressure_Pa));
  EXPECT_EQ(shown.at("intake_air_K"), static_cast<double>(out.manifold[kIntake].temperature_K));
  EXPECT_EQ(shown.at("tps_ratio"), static_cast<double>(static_cast<Real>(0.4)));
  EXPECT_EQ(shown.at("lambda[#]"), static_cast<double>(out.gas_cycle[0].excess_air_ratio));
  EXPECT_EQ(shown.at("coolant_K"), 361);
  EXPECT_LT(shown.at("map_Pa"), 95e3);
  EXPECT_GT(shown.at("lambda[#]"), 0.5);
  run->in.throttle_ratio = Real{7};  // refused: the sensor shows what the tick took
  EXPECT_EQ(run->step().faults, std::uint32_t{kFaultManifold});
  EXPECT_EQ(run->engine.state().throttle_ratio, static_cast<Real>(0.4));
}

}  // namespace
}  // namespace crankloop::controller_names_test
