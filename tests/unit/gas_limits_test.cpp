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

/// Each is told of by a fault, whichever comes last; what is off by rounding alone is none.
TYPED_TEST(GasLimits, PutRightOneManifoldBesideOneThatIsOffByRounding) {
  using Real = TypeParam;
  const auto real = [](double x) { return static_cast<Real>(x); };
  for (const bool intake_is_well : {false, true}) {
    support::Breathing<Real, BreathingFour> run(support::sealed(support::four_2000()), 50e-6);
    auto state = run.engine.state();
    auto& burned = state.manifold[kExhaust].contents;
    burned.burned_kg = burned.mass_kg * real(1 + 4e-6);
    burned.energy_J = burned.mass_kg * real(gas_energy(298.15, 1));
    if (!intake_is_well) state.manifold[kIntake].contents.energy_J *= 100;
    ASSERT_TRUE(accepted(run.engine.restore(state)));
    EXPECT_EQ(run.step().faults, intake_is_well ? 0u : std::uint32_t{kFaultGas});
    EXPECT_EQ(run.engine.output().manifold[kExhaust].burned_ratio, Real{1});
  }
}

/// A cylinder whose energy is no number: it is put right, and neither its record nor a manifold nor the crank notices.
TYPED_TEST(GasLimits, KeepNoWorkHeatAndFlowThatAreNoNumbers) {
  using Real = TypeParam;
  support::Breathing<Real, BreathingFour> run(support::four_2000(), 50e-6), well(support::four_2000(), 50e-6);
  run.in.speed_rad_s = well.in.speed_rad_s = Real{300};
  for (int tick = 0; tick < 1200; ++tick) (void)run.step(), (void)well.step();
  std::size_t k = 0;
  while (run.engine.state().cylinder_gas.area_m2[kExhaust][k] == 0) ++k;
  ASSERT_LT(k, 4u);
  auto state = run.engine.state();
  state.cylinder_gas.energy_J[k] = std::numeric_limits<Real>::quiet_NaN();
  ASSERT_TRUE(accepted(run.engine.restore(state)));
  EXPECT_EQ(run.step().faults, std::uint32_t{kFaultGas});
  EXPECT_EQ(well.step().faults, 0u);
  const auto &now = run.engine.state(), &of_well = well.engine.state();
  EXPECT_NEAR(static_cast<double>(now.cylinder_gas.temperature_K[k]), 100, 1e-3);
  EXPECT_EQ(now.gas_record[k].work_J, state.gas_record[k].work_J);
  EXPECT_EQ(now.gas_record[k].wall_heat_J, state.gas_record[k].wall_heat_J);
  for (std::size_t other = 0; other < 4; ++other) {
    if (other == k) continue;
    EXPECT_EQ(now.cylinder_gas.energy_J[other], of_well.cylinder_gas.energy_J[other]);
    EXPECT_EQ(now.gas_record[other].work_J, of_well.gas_record[other].work_J);
  }
  // As if nothing had flowed through its port, which is little of the manifold.
  EXPECT_NEAR(
      static_cast<double>(now.manifold[kExhaust].contents.energy_J / of_well.manifold[kExhaust].contents.energy_J), 1,
      0.05);
  for (int tick = 0; tick < 400; ++tick) {  // more than a cycle's end
    const auto& out = run.step();
    EXPECT_EQ(out.faults, 0u);
    ASSERT_TRUE(std::isfinite(out.torque_Nm) && std::isfinite(out.gas_cycle[k].net_mep_Pa)) << tick;
    ASSERT_TRUE(std::isfinite(out.gas_cycle[k].exhaust_K) && std::isfinite(out.gas_cycle[k].wall_heat_J)) << tick;
  }
}

struct WallsFour : BreathingFour {
  static constexpr bool walls = true;
};

/// Heat that no engine's walls get, waiting in a saved state: one cylinder's are put back, the others warm as usual.
TYPED_TEST(GasLimits, PutRightWallsThatNoCylinderHas) {
  using Real = TypeParam;
  EngineDefinition definition = support::sealed(support::four_2000());
  definition.gas.walls.capacity_J_K = 1500, definition.gas.walls.to_coolant_W_K = 20;
  struct Heat {
    double heat_J, then_K;
  };
  for (const Heat& heat : {Heat{1e9, 6000}, Heat{-1e9, 100}, Heat{std::numeric_limits<double>::quiet_NaN(), 100}}) {
    support::Breathing<Real, WallsFour> run(definition, 100e-6), well(definition, 100e-6);
    auto state = run.engine.state();
    state.wall_heat_J[2] = static_cast<Real>(heat.heat_J);
    ASSERT_TRUE(accepted(run.engine.restore(state)));
    int faults = 0;
    for (int tick = 0; tick < 3000; ++tick) {
      EXPECT_EQ(well.step().faults, 0u);
      const auto& out = run.step();
      if (out.faults == 0) continue;
      ++faults;
      EXPECT_EQ(out.faults, std::uint32_t{kFaultGas}) << heat.heat_J;
      EXPECT_EQ(out.wall_K[2], static_cast<Real>(heat.then_K)) << heat.heat_J;
      EXPECT_EQ(run.engine.state().wall_heat_J[2], Real{0}) << heat.heat_J;
    }
    EXPECT_EQ(faults, 1) << heat.heat_J;
    for (const std::size_t k : {0u, 1u, 3u}) EXPECT_EQ(run.engine.output().wall_K[k], well.engine.output().wall_K[k]);
  }
}

struct RunnersFour : BreathingFour {
  static constexpr bool runners = true;
};

/// A runner of a saved state that has a number which is none. What it holds then is the least that a runner may, or
/// what it had; what it moves is nothing, so its manifold and the other cylinders stay well.
TYPED_TEST(GasLimits, PutRightTheOneRunnerOfFour) {
  using Real = TypeParam;
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  EngineDefinition definition = support::four_2000();
  definition.gas.intake_runner = {0.35, 0.038, 0.8}, definition.gas.exhaust_runner = {0.5, 0.036, 0.8};
  enum class Bad { mass, no_mass, energy, ratio, flow };
  for (const Bad bad : {Bad::mass, Bad::no_mass, Bad::energy, Bad::ratio, Bad::flow}) {
    for (int port = 0; port < kPorts; ++port) {
      SCOPED_TRACE(static_cast<int>(bad) * kPorts + port);
      support::Breathing<Real, RunnersFour> run(definition, 50e-6), well(definition, 50e-6);
      run.in.speed_rad_s = well.in.speed_rad_s = Real{300};
      for (int tick = 0; tick < 1000; ++tick) (void)run.step(), (void)well.step();
      auto state = run.engine.state();
      auto& runner = state.runner[port][2];
      if (bad == Bad::mass) runner.contents.mass_kg = nan;
      if (bad == Bad::no_mass) runner.contents.mass_kg = -1000 * runner.contents.mass_kg;
      if (bad == Bad::energy) runner.contents.energy_J = nan;
      if (bad == Bad::ratio) runner.point.burned_ratio = nan, runner.flow_kg_s = static_cast<Real>(-0.05);
      if (bad == Bad::flow) runner.flow_kg_s = nan;
      ASSERT_TRUE(accepted(run.engine.restore(state)));
      EXPECT_EQ(run.step().faults, std::uint32_t{kFaultGas});
      EXPECT_EQ(well.step().faults, 0u);
      const auto &now = run.engine.state(), &of_well = well.engine.state();
      EXPECT_GE(now.manifold[port].point.burned_ratio, Real{0});
      EXPECT_LE(now.manifold[port].point.burned_ratio, Real{1});
      if (bad == Bad::flow) {
        EXPECT_EQ(now.runner[port][2].flow_kg_s, Real{0});
      }
      if (bad == Bad::energy) {
        EXPECT_NEAR(static_cast<double>(now.runner[port][2].point.temperature_K), 100, 1e-3);
      }
      for (const std::size_t k : {0u, 1u, 3u}) {
        EXPECT_EQ(now.runner[port][k].contents.energy_J, of_well.runner[port][k].contents.energy_J);
        EXPECT_EQ(now.cylinder_gas.energy_J[k], of_well.cylinder_gas.energy_J[k]);
      }
      for (int tick = 0; tick < 400; ++tick) {
        const auto& out = run.step();
        for (const auto& manifold : out.manifold) {
          ASSERT_TRUE(manifold.pressure_Pa > Real{1e3} && manifold.pressure_Pa < Real{1e6}) << tick;
          ASSERT_TRUE(manifold.temperature_K > Real{150} && manifold.temperature_K < Real{3000}) << tick;
        }
        ASSERT_TRUE(std::isfinite(out.runner[2].port_pressure_Pa[port]) && std::isfinite(out.torque_Nm)) << tick;
      }
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

/// Fuel that takes heat, eight tenths of m cv T: half of it before the compression, of which there is none, leaves 0.6
/// T. Flow sees no less than half of that, though 0.2 T is left; the heat is all gone.
TYPED_TEST(GasLimits, ShowsFlowNoLessThanHalfOfTheTemperatureThatHeatLeaves) {
  GasBench<TypeParam> bench(1e5, 1000, 0, 500e-6);
  const double before_J = static_cast<double>(bench.gas.contents.energy_J);
  const double taken_J =
      0.8 * static_cast<double>(bench.gas.contents.mass_kg) * (support::gas_a(0) + support::kGasB * 1000) * 1000;
  bench.fuel_J_kg = -taken_J / 1e-20;
  const auto done = bench.step(1e-4, 500e-6, 0, 0, 1e-20);
  EXPECT_NEAR(static_cast<double>(done.closed.temperature_K), 300, 1e-3);
  EXPECT_NEAR(static_cast<double>(bench.gas.contents.energy_J), before_J - taken_J, 1e-6 * before_J);
}

/// h = (a + R) T + b T^2 / 2 has a least value, at -(a + R) / b: above it the answer is T, below something less.
TYPED_TEST(GasLimits, KnowATemperatureOfAnyEnthalpy) {
  using Real = TypeParam;
  for (const double ratio : {0.0, 1.0}) {
    const double a = support::gas_a(ratio) + kGasR, b = support::kGasB, least_K = -a / b;
    const auto answer_K = [ratio](double enthalpy_J_kg) {
      return static_cast<double>(
          detail::temperature_of_enthalpy_K(static_cast<Real>(enthalpy_J_kg), static_cast<Real>(ratio)));
    };
    for (const double kelvin : {-4000.0, -300.0, 300.0, 1200.0, 6000.0})
      EXPECT_NEAR(answer_K(a * kelvin + b / 2 * kelvin * kelvin), kelvin, 1e-5 * std::fabs(kelvin) + 1e-2);
    double before_K = least_K;
    for (const double times : {1.001, 2.0, 10.0}) {
      const double kelvin = answer_K(-times * a * a / (2 * b));
      EXPECT_NEAR(kelvin, times * least_K, 1e-5 * times * std::fabs(least_K));
      EXPECT_LT(kelvin, before_K);
      before_K = kelvin;
    }
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
