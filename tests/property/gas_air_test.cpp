// Fuel burns by the air that is there: in the step in which it burns, whatever was there when the cycle took it.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/both_reals.hpp"
#include "support/gas_engine.hpp"

namespace crankloop::gas_air_test {
namespace {

using support::Breathing;
using support::BreathingFour;
using support::four_2000;
using tick_test::RealName;

constexpr double kPi = 3.14159265358979323846;

template <class Real>
class GasAir : public ::testing::Test {};
TYPED_TEST_SUITE(GasAir, tick_test::BothReals, RealName);

/// Taken at bottom dead centre: at 700 rpm the piston pushes a part of the charge out again, after its fuel was taken.
TYPED_TEST(GasAir, IsEnoughForWhatBurnsWhereAPartOfTheChargeIsPushedOutAgain) {
  using Real = TypeParam;
  EngineDefinition definition = four_2000();
  definition.gas.latch_deg = -180;
  Breathing<Real, BreathingFour> run(definition, 50e-6);
  run.in.speed_rad_s = static_cast<Real>(700 * kPi / 30);
  for (Real& fuel : run.in.fuel_kg) fuel = static_cast<Real>(60e-6);
  double air_kg[4] = {};  // what the intake shut in, after the fuel was taken
  bool shut[4] = {};
  Real before_Pa[4] = {};
  int compared = 0;
  for (int tick = 0; tick < 5 * 3429; ++tick) {
    const auto& out = run.step();
    ASSERT_EQ(out.faults, 0u) << tick;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& gas = out.cylinder_gas[k];
      ASSERT_LE(gas.burned_ratio, Real{1}) << tick;
      const bool was_shut = shut[k];
      shut[k] = gas.flow_kg_s[kIntake] == 0 && gas.flow_kg_s[kExhaust] == 0;
      if (shut[k] && !was_shut)
        air_kg[k] = static_cast<double>(gas.mass_kg) * (1 - static_cast<double>(gas.burned_ratio));
      const auto& cycle = out.gas_cycle[k];
      if (cycle.net_mep_Pa == before_Pa[k]) continue;
      before_Pa[k] = cycle.net_mep_Pa;
      if (tick < 2 * 3429) continue;
      const double burning_kg = static_cast<double>(cycle.fuel_kg * cycle.excess_air_ratio);  // a rich cycle
      EXPECT_LT(static_cast<double>(cycle.excess_air_ratio), 0.9);
      EXPECT_NEAR(burning_kg * definition.gas.air_fuel_ratio / air_kg[k], 1, 1e-5) << "all air, and no more";
      EXPECT_LT(std::fabs(static_cast<double>(cycle.energy_defect_J)), 3e-6 * static_cast<double>(cycle.heat_J));
      EXPECT_NEAR(static_cast<double>(cycle.trapped_air_kg) / air_kg[k], 1, 1e-6);
      ++compared;
    }
  }
  EXPECT_GE(compared, 8);
}

/// Air that a burn found missing it may find later: what is due burns then.
TYPED_TEST(GasAir, IsWaitedForByFuelThatIsDue) {
  using Real = TypeParam;
  detail::BurnTable<Real> table{};
  for (int i = 0; i <= detail::kBurnSteps; ++i) table.burnt[i] = static_cast<Real>(i) / detail::kBurnSteps;
  table.per_air_fuel_ratio = static_cast<Real>(1 / 14.6);
  detail::CylinderBurn<Real> burn{};
  burn.fuel_kg = Real{1}, burn.per_deg = static_cast<Real>(1.0 / 64), burn.taken = 1;
  burn.excess_air_ratio = Real{2};
  const auto at = [](int deg) {
    return detail::CycleWay{static_cast<std::uint64_t>(deg) * (~std::uint64_t{0} / 720 + 1), 1};
  };
  const auto left = [](double air_kg) {
    return static_cast<Real>(100 - air_kg);  // burned, of 100 kg
  };
  const auto burnt_kg = [&](Real burned_kg, const detail::CycleWay& way) {
    return static_cast<double>(detail::burnt_fuel(burn, table, Real{100}, burned_kg, way).mass_kg);
  };
  EXPECT_NEAR(burnt_kg(left(50), at(16)), 0.25, 1e-6);
  EXPECT_NEAR(burnt_kg(left(1.46), at(32)), 0.1, 1e-5);
  EXPECT_EQ(burnt_kg(left(0), at(40)), 0);
  EXPECT_NEAR(burnt_kg(left(50), at(48)), 0.4, 1e-5) << "0.75 in all";
  EXPECT_NEAR(burnt_kg(left(50), at(64)), 0.25, 1e-6);
  EXPECT_EQ(burnt_kg(left(50), at(80)), 0);
}

}  // namespace
}  // namespace crankloop::gas_air_test
