// Where the gas of a cylinder or manifold is put right, and the bounds of a step that no engine reaches: both hold
// whatever comes.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/both_reals.hpp"
#include "support/gas_bench.hpp"
#include "support/gas_engine.hpp"

namespace crankloop::gas_limits_test {
namespace {

using support::BreathingFour;
using support::gas_energy;
using support::GasBench;
using support::kGasR;
using support::MeasuredRun;
using tick_test::RealName;

template <class Real>
class GasLimits : public ::testing::Test {};
TYPED_TEST_SUITE(GasLimits, tick_test::BothReals, RealName);

// ---- put right ------------------------------------------------------------------------------------------------------

/// Contents that a saved state may bring, and what a step makes of them.
struct Odd {
  const char* what;
  double kg_to_good, temperature_K, burned_ratio;  ///< mass by that at 1 bar and 300 K
  bool fault;
  double then_kg_to_good, then_K, then_ratio;
};

constexpr double kVolume_m3 = support::kPi / 4 * 0.086 * 0.086 * 0.086 / 9.5;  // at firing dead centre
constexpr double kGood_kg = 1e5 * kVolume_m3 / (kGasR * 300);

TYPED_TEST(GasLimits, PutRightWhatNoCylinderHolds) {
  using Real = TypeParam;
  const auto real = [](double x) { return static_cast<Real>(x); };
  const Odd all[] = {{"hot", 1, 7000, 0.5, true, 1, 6000, 0.5},
                     {"just not too hot", 1, 5990, 0.5, false, 1, 5990, 0.5},
                     {"cold", 1, 50, 0.5, true, 1, 100, 0.5},
                     {"just not too cold", 1, 101, 0, false, 1, 101, 0},
                     {"empty", 5e-4, 300, 0, true, 1e-3, 300, 0},
                     {"almost empty", 1.1e-3, 300, 0, false, 1.1e-3, 300, 0},
                     {"more burned than there is", 1, 900, 1.5, true, 1, 0, 1},
                     {"less than none burned", 1, 900, -0.5, true, 1, 0, 0},
                     {"all burned, but for rounding", 1, 900, 1 + 4e-6, false, 1, 900, 1},
                     {"none burned, but for rounding", 1, 900, -4e-6, false, 1, 900, 0}};
  for (const Odd& odd : all) {
    MeasuredRun<Real> run(support::sealed(support::one_of_four_2000()), 0);
    auto state = run.engine.state();
    auto& gas = state.cylinder_gas;
    const double kg = odd.kg_to_good * kGood_kg;
    gas.mass_kg[0] = real(kg), gas.burned_kg[0] = real(kg * odd.burned_ratio);
    gas.energy_J[0] = real(kg * gas_energy(odd.temperature_K, odd.burned_ratio));
    gas.temperature_K[0] = real(odd.temperature_K), gas.burned_ratio[0] = real(odd.burned_ratio);
    ASSERT_TRUE(accepted(run.engine.restore(state)));
    EXPECT_EQ(run.to(0).faults, odd.fault ? std::uint32_t{kFaultGas} : 0u) << odd.what;
    const auto& now = run.engine.output().cylinder_gas[0];
    EXPECT_NEAR(static_cast<double>(now.mass_kg), odd.then_kg_to_good * kGood_kg, 1e-6 * kGood_kg) << odd.what;
    const double then_K = odd.then_K > 0 ? odd.then_K : static_cast<double>(now.temperature_K);
    EXPECT_NEAR(static_cast<double>(now.temperature_K), then_K, 2e-6 * then_K) << odd.what;
    EXPECT_EQ(static_cast<double>(now.burned_ratio), odd.then_ratio) << odd.what;
    const double pressure_Pa = odd.then_kg_to_good * kGood_kg * kGasR * then_K / kVolume_m3;
    EXPECT_NEAR(static_cast<double>(now.pressure_Pa), pressure_Pa, 4e-6 * pressure_Pa) << odd.what;
    EXPECT_EQ(run.to(0).faults, 0u) << odd.what << ": once";
    EXPECT_NEAR(static_cast<double>(now.pressure_Pa), pressure_Pa, 4e-6 * pressure_Pa) << odd.what;
  }
}

TYPED_TEST(GasLimits, PutRightTheOneCylinderOfFour) {
  using Real = TypeParam;
  support::Breathing<Real, BreathingFour> run(support::sealed(support::four_2000()), 50e-6),
      well(support::sealed(support::four_2000()), 50e-6);
  auto state = run.engine.state();
  state.cylinder_gas.energy_J[2] *= 100;
  ASSERT_TRUE(accepted(run.engine.restore(state)));
  EXPECT_EQ(run.step().faults, std::uint32_t{kFaultGas});
  EXPECT_EQ(well.step().faults, 0u);
  for (std::size_t k = 0; k < 4; ++k) {
    const Real now_K = run.engine.output().cylinder_gas[k].temperature_K;
    if (k == 2)
      EXPECT_NEAR(static_cast<double>(now_K), 6000, 0.02);
    else
      EXPECT_EQ(now_K, well.engine.output().cylinder_gas[k].temperature_K);
  }
}

TYPED_TEST(GasLimits, PutRightWhatNoManifoldHolds) {
  using Real = TypeParam;
  for (int port = 0; port < kPorts; ++port) {
    for (const double times : {100.0, 0.01}) {
      support::Breathing<Real, BreathingFour> run(support::sealed(support::four_2000()), 50e-6);
      EXPECT_EQ(run.step().faults, 0u);
      auto state = run.engine.state();
      state.manifold[port].contents.energy_J *= static_cast<Real>(times);
      ASSERT_TRUE(accepted(run.engine.restore(state)));
      EXPECT_EQ(run.step().faults, std::uint32_t{kFaultGas}) << port << " " << times;
      const double wanted_K = times > 1 ? 6000 : 100;
      EXPECT_NEAR(static_cast<double>(run.engine.output().manifold[port].temperature_K), wanted_K, 1e-4 * wanted_K);
      EXPECT_EQ(run.engine.output().manifold[1 - port].temperature_K,
                run.engine.state().manifold[1 - port].point.temperature_K);
      EXPECT_NEAR(static_cast<double>(run.engine.output().manifold[1 - port].temperature_K), 298.15, 0.01);
    }
  }
}

// ---- bounds of a step -----------------------------------------------------------------------------------------------

TYPED_TEST(GasLimits, TakesNoMoreThanAQuarterOfItsEnergyThroughWalls) {
  using Real = TypeParam;
  const auto real = [](double x) { return static_cast<Real>(x); };
  for (const double wall_K : {300.0, 2000.0}) {
    GasBench<Real> bench(20e5, 1000, 0.3, 100e-6);
    bench.walls = {real(1e6), real(0.0116), real(46.5), real(wall_K), real(0.027)};
    const double before_J = static_cast<double>(bench.gas.contents.energy_J);
    const auto done = bench.step(1e-3, 100e-6);
    const double sign = wall_K < 1000 ? 1 : -1;
    EXPECT_NEAR(static_cast<double>(done.closed.wall_heat_J) / before_J, 0.25 * sign, 1e-6);
    EXPECT_NEAR(static_cast<double>(bench.gas.contents.energy_J) / before_J, 1 - 0.25 * sign, 1e-6);
  }
}

/// A piston that rushes up, a port wide open to 500 bar: what flows in works on it with a quarter of the energy that is
/// there, no more, and that much is missing afterwards: 0.25 / 1.25 of the energy left.
TYPED_TEST(GasLimits, LetsFlowWorkWithAQuarterOfTheEnergy) {
  GasBench<TypeParam> bench(1e5, 400, 0, 500e-6);
  bench.given(0, 500e5, 300, 0);
  const auto done = bench.step(1e-3, 50e-6, 1e-2);
  const double flow_J = static_cast<double>(done.work_J - done.closed.work_J);
  EXPECT_NEAR(flow_J / static_cast<double>(bench.gas.contents.energy_J), -0.2, 1e-5);
}

}  // namespace
}  // namespace crankloop::gas_limits_test
