// Manifolds as small as individual throttle bodies have them: against the differential equations, and refused where no
// tick can follow them.
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "support/both_reals.hpp"
#include "support/gas_bench.hpp"
#include "support/gas_engine.hpp"
#include "support/gas_reference.hpp"
#include "support/gas_vessels.hpp"

namespace crankloop::gas_manifold_test {
namespace {

using support::Breathing;
using support::BreathingFour;
using support::four_2000;
using support::GasReference;
using support::refuses;
using tick_test::RealName;

constexpr double kPi = 3.14159265358979323846;
constexpr double kSwept_m3 = kPi / 4 * 0.086 * 0.086 * 0.086;
constexpr double kFull_kg = 1e5 * kSwept_m3 / (287.1 * 298.15);

[[nodiscard]] EngineDefinition with_manifolds(double volume_m3) {
  EngineDefinition definition = four_2000();
  definition.gas.intake_m3 = definition.gas.exhaust_m3 = volume_m3;
  return definition;
}

template <class Real>
class GasManifold : public ::testing::Test {};
TYPED_TEST_SUITE(GasManifold, tick_test::BothReals, RealName);

/// Charge and mean pressure of the fourth cycle from rest, at ticks from 50 us to 1 ms.
TYPED_TEST(GasManifold, FollowsItsDifferentialEquationsHoweverSmall) {
  using Real = TypeParam;
  struct Asked {
    double volume_m3, rpm;
    long tick_us;
    double charge, net_mep_Pa;  ///< relative, absolute
  };
  constexpr Asked kAsked[] = {
      {200e-6, 3000, 100, 5e-3, 1e3},  {100e-6, 6000, 100, 5e-3, 2e3},  {100e-6, 800, 1000, 5e-3, 1e3},
      {50e-6, 6000, 100, 6e-3, 2e3},   {50e-6, 3000, 250, 5e-3, 1e3},   {50e-6, 800, 1000, 5e-3, 1e3},
      {1000e-6, 6000, 100, 5e-3, 2e3}, {3000e-6, 6000, 100, 5e-3, 2e3}, {25e-6, 3000, 100, 5e-3, 1e3}};
  for (const Asked& asked : kAsked) {
    const EngineDefinition definition = with_manifolds(asked.volume_m3);
    Breathing<Real, BreathingFour> run(definition, static_cast<double>(asked.tick_us) * 1e-6);
    run.in.speed_rad_s = static_cast<Real>(asked.rpm * kPi / 30);
    const double step_s = asked.volume_m3 < 60e-6 ? 1e-6 : 2e-6;
    GasReference reference(definition, static_cast<double>(run.in.speed_rad_s), definition.gas.throttle_m2);
    double before_J = 0, before_kg = 0, cycle_J = 0, cycle_kg = 0, before_deg = 0, time_s = 0;
    const double until_s = 4 * 120 / asked.rpm + 2 * static_cast<double>(asked.tick_us) * 1e-6;
    for (; time_s < until_s; time_s += step_s) {
      reference.step(step_s);
      const double deg = reference.own_deg(0);
      if (before_deg > 0 && deg < 0) {
        cycle_J = reference.work_J() - before_J, before_J = reference.work_J();
        cycle_kg = reference.air_kg() - before_kg, before_kg = reference.air_kg();
      }
      before_deg = deg;
    }
    for (long tick = std::lround(until_s * 1e6) / asked.tick_us; tick > 0; --tick) {
      ASSERT_EQ(run.step().faults, 0u);
    }
    const auto& cycle = run.engine.output().gas_cycle[0];
    const double charge = cycle_kg / kFull_kg;
    EXPECT_NEAR(static_cast<double>(cycle.volumetric_efficiency), charge, charge * asked.charge)
        << asked.volume_m3 << " m3, " << asked.rpm << " rpm, " << asked.tick_us << " us";
    EXPECT_NEAR(static_cast<double>(cycle.net_mep_Pa), cycle_J / kSwept_m3, asked.net_mep_Pa)
        << asked.volume_m3 << " m3, " << asked.rpm << " rpm, " << asked.tick_us << " us";
  }
}

TYPED_TEST(GasManifold, IsRefusedWhereTheTickIsFarTooLongForIt) {
  using Real = TypeParam;
  const auto storage = std::make_unique<TableStorage<Real, BreathingFour>>();
  EXPECT_TRUE(refuses(storage->build(with_manifolds(1e-6), {100e-6, {}}), Reason::inconsistent, "gas.intake_m3"));
  EXPECT_TRUE(accepted(storage->build(with_manifolds(1e-6), {10e-6, {}})));
  EXPECT_TRUE(accepted(storage->build(with_manifolds(10e-6), {100e-6, {}})));
  EngineDefinition definition = four_2000();
  definition.gas.exhaust_m3 = 1e-6;
  EXPECT_TRUE(refuses(storage->build(definition, {100e-6, {}}), Reason::inconsistent, "gas.exhaust_m3"));
}

struct WithBoundaries : BreathingFour {
  static constexpr bool boundaries = true;
};

/// 1 bar and 2500 K in an exhaust manifold that a tick could exchange 4 to 79 times, within the limit of 80: a tick
/// takes it most of the way to the pressure behind it, and never beyond.
TYPED_TEST(GasManifold, EmptiesToWhateverIsBehindAWideOutlet) {
  using Real = TypeParam;
  const auto real = [](double x) { return static_cast<Real>(x); };
  for (const double volumes : {4.0, 6.0, 10.0, 20.0, 79.0}) {
    EngineDefinition definition = support::sealed(four_2000());
    definition.gas.exhaust_m3 = definition.gas.outlet_m2 * 1000 * 100e-6 / volumes;
    Breathing<Real, WithBoundaries> run(definition, 100e-6);
    auto state = run.engine.state();
    const auto gas = support::gas_filled(1e5, 2500, 0.5, definition.gas.exhaust_m3);
    state.manifold[kExhaust].contents = {real(gas.m), 0, real(gas.u), 0, real(gas.b), 0};
    state.manifold[kExhaust].point = {real(1e5), Real{2500}, real(0.5),
                                      real(support::kGasR / (support::gas_a(0.5) + support::kGasB * 2500))};
    for (double back_Pa = 2050; back_Pa < 9e4; back_Pa *= 1.0007) {
      ASSERT_TRUE(accepted(run.engine.restore(state)));
      run.in.back_Pa = real(back_Pa);
      double before_Pa = 1e5;
      for (int tick = 0; tick < 30; ++tick) {
        ASSERT_EQ(run.step().faults, 0u) << back_Pa << ", tick " << tick;
        const auto after_Pa = static_cast<double>(run.engine.output().manifold[kExhaust].pressure_Pa);
        ASSERT_GT(after_Pa, back_Pa * 0.9999) << volumes << ", tick " << tick;
        ASSERT_LT(after_Pa - back_Pa, (before_Pa - back_Pa) * 0.6 + 1)
            << back_Pa << ", " << volumes << ", tick " << tick;
        before_Pa = after_Pa;
      }
      ASSERT_NEAR(before_Pa, back_Pa, 1) << volumes;
    }
  }
}

TEST(GasManifolds, SeeEachCylinderAlikeWhateverItsNumber) {
  const EngineDefinition definition = with_manifolds(200e-6);
  EngineDefinition renumbered = definition;
  for (std::size_t k = 0; k < 4; ++k) renumbered.layout.firing_deg[k] = definition.layout.firing_deg[(k + 1) % 4];
  Breathing<double, BreathingFour> run(definition, 100e-6), other(renumbered, 100e-6);
  run.in.speed_rad_s = other.in.speed_rad_s = support::rad_s(3000);
  for (int tick = 0; tick < 2000; ++tick) {
    const auto &a = run.step(), &b = other.step();
    for (std::size_t k = 0; k < 4; ++k) {
      const auto &x = a.cylinder_gas[(k + 1) % 4], &y = b.cylinder_gas[k];
      ASSERT_NEAR(x.pressure_Pa, y.pressure_Pa, 1e-9 * y.pressure_Pa) << "tick " << tick << ", cylinder " << k + 1;
      ASSERT_NEAR(x.mass_kg, y.mass_kg, 1e-9 * y.mass_kg) << "tick " << tick << ", cylinder " << k + 1;
    }
  }
}

// ---- two vessels ----------------------------------------------------------------------------------------------------

/// A cylinder that stands still, of 50 or 400 cm3 and 3 bar, beside a manifold of the other and 1 bar, through 3 cm2
/// for 200 us: both pressures move in the step.
TYPED_TEST(GasManifold, MeetsACylinderOfItsOwnSizeInBothPressures) {
  constexpr double kArea_m2 = 3e-4, kTime_s = 200e-6;
  struct Asked {
    double near_m3, step_s, error_Pa;
  };
  constexpr Asked kAsked[] = {{50e-6, 100e-6, 650}, {50e-6, 20e-6, 36}, {400e-6, 100e-6, 490}};
  for (const Asked& asked : kAsked) {
    support::GasVessels v{};
    v.cylinder = {3e5, 600, 0}, v.manifold[0] = {1e5, 600, 0}, v.manifold[1] = {1e5, 300, 1};
    v.from_m3 = v.to_m3 = asked.near_m3, v.manifold_m3[0] = 450e-6 - asked.near_m3;
    v.from_m2[0] = v.to_m2[0] = kArea_m2, v.time_s = kTime_s;
    const support::GasSeen exact = support::ExactVessels(v).cylinder();
    support::GasBench<TypeParam> bench(v.cylinder.p, v.cylinder.t, v.cylinder.x, asked.near_m3);
    bench.gas.area_m2[0] = static_cast<TypeParam>(kArea_m2);
    support::GasVolume manifold = support::gas_filled(v.manifold[0].p, v.manifold[0].t, 0, v.manifold_m3[0]);
    double took_kg = 0;
    for (long i = std::lround(kTime_s / asked.step_s); i > 0; --i) {
      bench.manifold(0, support::gas_seen(manifold, v.manifold_m3[0]), v.manifold_m3[0], took_kg);
      (void)bench.step(asked.step_s, asked.near_m3, kArea_m2);
      const detail::PortStep<TypeParam>& flow = bench.through[0];
      took_kg = static_cast<double>(flow.mass_kg);
      manifold.m -= took_kg, manifold.u -= static_cast<double>(flow.enthalpy_J);
    }
    EXPECT_NEAR(bench.pressure_Pa(), exact.p, asked.error_Pa) << asked.near_m3 << " m3, " << asked.step_s << " s";
  }
}

}  // namespace
}  // namespace crankloop::gas_manifold_test
