// Results of a cycle, against what the ticks of that cycle showed, the conservation of mass and energy, and closed
// forms.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/both_reals.hpp"
#include "support/gas_engine.hpp"
#include "support/gas_equations.hpp"
#include "support/gas_reference.hpp"

namespace crankloop::gas_results_test {
namespace {

using support::GasVolume;
using support::MeasuredCylinder;
using support::MeasuredRun;
using tick_test::RealName;

template <class Real>
class GasResults : public ::testing::Test {};
TYPED_TEST_SUITE(GasResults, tick_test::BothReals, RealName);

constexpr double kSwept_m3 = support::kPi / 4 * 0.086 * 0.086 * 0.086;

/// No overlap, and an intake from behind one dead centre to before the next: nothing flows back into it.
[[nodiscard]] EngineDefinition one_without_backflow() {
  EngineDefinition engine = support::one_of_four_2000();
  engine.trains[0].cam.full_lift_deg = 460, engine.trains[0].cam.half_angle_deg = 40;
  engine.trains[0].rocker.base_circle_m = 0.06;  // a narrow lobe that can be ground
  engine.trains[1].cam.full_lift_deg = 228;
  return engine;
}

[[nodiscard]] double volume_m3(double deg) { return support::GasReference(support::four_2000(), 0, 1).volume(deg); }

/// What a cylinder holds, by what it shows.
template <class Real>
[[nodiscard]] GasVolume held(const CylinderGasOutput<Real>& gas) {
  const double m = static_cast<double>(gas.mass_kg), x = static_cast<double>(gas.burned_ratio);
  return {m, m * support::gas_energy(static_cast<double>(gas.temperature_K), x), m * x};
}

/// What the ticks of a cycle showed.
struct Shown {
  double work_J = 0, pumping_J = 0, wall_heat_J = 0, in_kg = 0, out_kg = 0, peak_Pa = 0, peak_deg = 0;
  double least_in_kg = 0;  ///< of a tick
  double back_kg = 0;      ///< through the exhaust; out_kg is less that
  GasVolume begin{}, end{};
  double trapped_kg = 0, trapped_ratio = 0;
};

/// From one dead centre of gas exchange to the next, once the engine has run a cycle and a half.
template <class Real>
[[nodiscard]] Shown run_cycle(MeasuredRun<Real>& run, double per_tick_deg, double tick_s = MeasuredRun<Real>::kTick_s) {
  run.turn(run.deg + 1080 - 360 * std::fmod(run.deg / 360, 1), per_tick_deg);
  Shown sum;
  const auto& gas = run.engine.output().cylinder_gas[0];
  sum.begin = held(gas);
  double before_Pa = static_cast<double>(gas.pressure_Pa), before_m3 = volume_m3(run.deg);
  const double begin_deg = run.deg;
  run.turn(begin_deg + 720, per_tick_deg, [&](const auto&) {
    const double p = static_cast<double>(gas.pressure_Pa), v = volume_m3(run.deg), deg = run.deg - begin_deg - 360;
    const double work_J = (p + before_Pa) / 2 * (v - before_m3);
    sum.work_J += work_J;
    if (deg <= -180 || deg > 180) sum.pumping_J += work_J;
    sum.wall_heat_J += static_cast<double>(gas.wall_heat_W) * tick_s;
    const double in_kg = static_cast<double>(gas.flow_kg_s[kIntake]) * tick_s;
    sum.in_kg += in_kg, sum.least_in_kg = std::fmin(sum.least_in_kg, in_kg);
    const double out_kg = -static_cast<double>(gas.flow_kg_s[kExhaust]) * tick_s;
    sum.out_kg += out_kg, sum.back_kg += std::fmax(-out_kg, 0);
    if (p > sum.peak_Pa) sum.peak_Pa = p, sum.peak_deg = deg;
    before_Pa = p, before_m3 = v;
    if (deg < -95) {  // behind the intake, before the fuel
      sum.trapped_kg = static_cast<double>(gas.mass_kg), sum.trapped_ratio = static_cast<double>(gas.burned_ratio);
    }
  });
  sum.end = held(gas);
  return sum;
}

// ---- what a cycle says is what its ticks showed ---------------------------------------------------------------------

struct Running {
  double per_tick_deg, tick_s, fuel_kg;
  double work_J;  ///< by how much the trapezoids of the ticks' pressures may be off
};

TYPED_TEST(GasResults, AreWhatTheTicksShowed) {
  using Real = TypeParam;
  // 417, 1000 and 3000 rpm: the last in ticks of four steps, whose pressures are too far apart for an integral.
  for (const Running& how :
       {Running{0.25, 100e-6, 30e-6, 0.05}, Running{0.6, 100e-6, 0, 0.1}, Running{18, 1e-3, 20e-6, 1e9}}) {
    const auto give = [&how](auto& in) { in.intake_Pa = Real{150e3}, in.fuel_kg[0] = static_cast<Real>(how.fuel_kg); };
    MeasuredRun<Real> run(one_without_backflow(), 0, give, how.tick_s);
    const Shown shown = run_cycle(run, how.per_tick_deg, how.tick_s);
    const bool one_step = how.per_tick_deg < 5;
    const GasCycle<Real>& cycle = run.engine.output().gas_cycle[0];
    const auto near = [&](Real x, double wanted, double within, const char* name) {
      EXPECT_NEAR(static_cast<double>(x), wanted, within) << name << ", " << how.per_tick_deg << " deg a tick";
    };
    near(cycle.net_mep_Pa, shown.work_J / kSwept_m3, how.work_J / kSwept_m3, "net_mep_Pa");
    near(cycle.pumping_mep_Pa, shown.pumping_J / kSwept_m3, how.work_J / kSwept_m3, "pumping_mep_Pa");
    if (one_step) {
      near(cycle.peak_Pa, shown.peak_Pa, 0, "peak_Pa");
      near(cycle.peak_deg, shown.peak_deg, 1e-4, "peak_deg");
    }
    near(cycle.trapped_kg, shown.trapped_kg, 1e-6 * shown.trapped_kg, "trapped_kg");
    near(cycle.residual_ratio, shown.trapped_ratio, 1e-6, "residual_ratio");
    near(cycle.trapped_air_kg, shown.trapped_kg * (1 - shown.trapped_ratio), 1e-6 * shown.trapped_kg, "trapped_air_kg");
    const double full_kg = 100e3 * kSwept_m3 / (support::kGasR * 298.15);
    near(cycle.volumetric_efficiency, shown.in_kg / full_kg, 1e-6 * shown.in_kg / full_kg, "volumetric_efficiency");
    near(cycle.fuel_kg, how.fuel_kg, 1e-6 * how.fuel_kg, "fuel_kg");
    near(cycle.heat_J, how.fuel_kg * 0.97 * 43e6, 2e-6 * 1250, "heat_J");
    near(cycle.wall_heat_J, shown.wall_heat_J, 5e-6 * std::fabs(shown.wall_heat_J), "wall_heat_J");  // 2880 sums
    near(cycle.energy_defect_J, 0, sizeof(Real) == 4 ? 1e-5 : 1e-12, "energy_defect_J");
  }
}

TYPED_TEST(GasResults, BookEveryTicksFlow) {  // forwards, backwards, standing; one step a tick or eight
  using Real = TypeParam;
  EngineDefinition definition = support::one_of_four_2000();
  definition.gas.fuel_kg = 0;
  MeasuredRun<Real> run(definition, 100, [](auto& in) { in.intake_Pa = Real{70e3}; });
  double before_kg = run.mass_kg(), flowed_kg = 0;
  const auto books = [&](const auto& out) {
    const auto& gas = out.cylinder_gas[0];
    const double flow_kg =
        static_cast<double>(gas.flow_kg_s[kIntake] + gas.flow_kg_s[kExhaust]) * MeasuredRun<Real>::kTick_s;
    ASSERT_NEAR(run.mass_kg() - before_kg, flow_kg, 2e-10) << run.deg;
    before_kg = run.mass_kg(), flowed_kg += std::fabs(flow_kg);
  };
  run.turn(1200, 0.7, books), run.turn(300, 0.7, books), run.turn(1800, 37.5, books), run.turn(900, 12, books);
  EXPECT_GT(flowed_kg, 1e-3);
}

/// Gas that flows back into the intake takes burned gas along, which was no charge: its air alone is less.
TYPED_TEST(GasResults, CountTheAirThroughTheIntake) {
  using Real = TypeParam;
  MeasuredRun<Real> run(support::one_of_four_2000(), 0, [](auto& in) {
    in.intake_Pa = Real{50e3}, in.exhaust_Pa = Real{120e3}, in.fuel_kg[0] = static_cast<Real>(10e-6);
  });
  run.turn(1080);
  double air_kg = 0, back_kg = 0;
  double ratio = static_cast<double>(run.engine.output().cylinder_gas[0].burned_ratio);
  run.turn(1800, 0.5, [&](const auto& out) {
    const double in_kg = static_cast<double>(out.cylinder_gas[0].flow_kg_s[kIntake]) * MeasuredRun<Real>::kTick_s;
    const double now = static_cast<double>(out.cylinder_gas[0].burned_ratio);
    air_kg += in_kg > 0 ? in_kg : in_kg * (1 - (ratio + now) / 2);
    back_kg -= std::fmin(in_kg, 0);
    ratio = now;
  });
  EXPECT_GT(back_kg, 0.05 * air_kg);
  const double wanted = air_kg / (100e3 * kSwept_m3 / (support::kGasR * 298.15));
  EXPECT_NEAR(static_cast<double>(run.engine.output().gas_cycle[0].volumetric_efficiency), wanted, 2e-3 * wanted);
}

TYPED_TEST(GasResults, AreThoseOfWholeCycles) {
  using Real = TypeParam;
  MeasuredRun<Real> run(support::one_of_four_2000(), 10);
  const GasCycle<Real>& cycle = run.engine.output().gas_cycle[0];
  run.turn(1070);
  EXPECT_EQ(cycle.peak_Pa, Real{0}) << "entered behind its begin";
  run.turn(1090);
  const Real first_Pa = cycle.peak_Pa;
  EXPECT_GT(first_Pa, Real{0});
  run.turn(1450);
  (void)run.to(1450 + 280);  // a leap
  run.in.fuel_kg[0] = 0;
  run.turn(1810);
  EXPECT_EQ(cycle.peak_Pa, first_Pa) << "the cycle with the leap is none";
  run.turn(2510);
  EXPECT_EQ(cycle.peak_Pa, first_Pa);
  run.turn(2530);
  EXPECT_LT(cycle.peak_Pa, first_Pa / 2) << "motored";
  run.turn(2510);  // back over the cycle's end: what ends there had no peak
  EXPECT_LT(cycle.peak_Pa, Real{3e5});
}

// ---- conservation ---------------------------------------------------------------------------------------------------

TYPED_TEST(GasResults, HaveTheExhaustTemperatureThatTheFirstLawLeaves) {
  using Real = TypeParam;
  for (const double fuel_kg : {0.0, 10e-6, 30e-6}) {
    const EngineDefinition definition = one_without_backflow();
    MeasuredRun<Real> run(definition, 0, [&](auto& in) {
      in.intake_Pa = Real{150e3}, in.intake_K = Real{310}, in.fuel_kg[0] = static_cast<Real>(fuel_kg);
    });
    const Shown shown = run_cycle(run, 1.0);
    ASSERT_GE(shown.least_in_kg, 0) << "flows back into the intake";
    const GasCycle<Real>& cycle = run.engine.output().gas_cycle[0];
    const double burned_kg = (1 + definition.gas.air_fuel_ratio) * fuel_kg;
    // What flowed out, and with it what had flowed back in: burned gas of exhaust_K.
    const GasVolume net{shown.begin.m - shown.end.m + shown.in_kg + fuel_kg,
                        shown.begin.u - shown.end.u + shown.in_kg * support::gas_enthalpy(310, 0) +
                            fuel_kg * support::fuel_energy_J_kg(definition.gas) -
                            static_cast<double>(cycle.wall_heat_J) - static_cast<double>(cycle.net_mep_Pa) * kSwept_m3,
                        shown.begin.b - shown.end.b + burned_kg};
    EXPECT_NEAR(shown.out_kg, net.m, 1e-6 * net.m);
    const GasVolume out{net.m + shown.back_kg,
                        net.u + shown.back_kg * support::gas_enthalpy(definition.gas.exhaust_K, 1),
                        net.b + shown.back_kg};
    EXPECT_GT(shown.back_kg, fuel_kg > 20e-6 ? 0 : 1e-6);
    const double wanted_K = support::gas_temperature_of_enthalpy(out.u / out.m, out.b / out.m);
    EXPECT_NEAR(static_cast<double>(cycle.exhaust_K), wanted_K, 0.02) << fuel_kg;
    EXPECT_GT(wanted_K, fuel_kg > 20e-6 ? 800 : 290);
  }
}

TYPED_TEST(GasResults, TellWhatTheFirstLawLacks) {  // of a joule that comes from nowhere
  using Real = TypeParam;
  MeasuredRun<Real> run(support::sealed(support::one_of_four_2000()), 200);
  run.turn(600);
  auto state = run.engine.state();
  state.cylinder_gas.energy_J[0] += Real{1};
  ASSERT_TRUE(accepted(run.engine.restore(state)));
  run.turn(1090);
  EXPECT_NEAR(static_cast<double>(run.engine.output().gas_cycle[0].energy_defect_J), 1, 1e-3);
  run.turn(1810);
  EXPECT_NEAR(static_cast<double>(run.engine.output().gas_cycle[0].energy_defect_J), 0, 1e-3);
}

// ---- closed forms ---------------------------------------------------------------------------------------------------

/// What an intake stroke so slow that nothing is lost in the valve leaves: U - U0 = m h - p (V - V0), p V = (m0 + m) R
/// T.
[[nodiscard]] double slow_charge_kg(const GasVolume& before, double pressure_Pa, double temperature_K, double from_m3,
                                    double to_m3) {
  double least = 0, most = 1;
  while (most - least > 1e-12) {
    const double m = (least + most) / 2;
    const double u = before.u + m * support::gas_enthalpy(temperature_K, 0) - pressure_Pa * (to_m3 - from_m3);
    const double t = support::gas_temperature(u / (before.m + m), before.b / (before.m + m));
    ((before.m + m) * support::kGasR * t / to_m3 < pressure_Pa ? least : most) = m;
  }
  return least;
}

TYPED_TEST(GasResults, HaveTheVolumetricEfficiencyOfASlowStroke) {
  using Real = TypeParam;
  EngineDefinition definition = one_without_backflow();
  definition.gas.wall_heat_ratio = 0;
  struct Case {
    double intake_Pa, intake_K, exhaust_Pa;
  };
  for (const Case& one : {Case{100e3, 298.15, 90e3}, Case{60e3, 310, 55e3}, Case{150e3, 350, 140e3}}) {
    constexpr double kTick_s = 2e-3;  // 17 rpm
    MeasuredRun<Real> run(
        definition, 0,
        [&](auto& in) {
          in.intake_Pa = static_cast<Real>(one.intake_Pa), in.intake_K = static_cast<Real>(one.intake_K);
          in.exhaust_Pa = static_cast<Real>(one.exhaust_Pa), in.exhaust_K = static_cast<Real>(one.intake_K);
          in.fuel_kg[0] = 0;
        },
        kTick_s);
    run.turn(1101, 0.2);  // the intake opens from here on
    const GasVolume before = held(run.engine.output().cylinder_gas[0]);
    const double wanted_kg = slow_charge_kg(before, one.intake_Pa, one.intake_K, volume_m3(381), volume_m3(538));
    run.turn(1810, 0.2);
    const double full_kg = 100e3 * kSwept_m3 / (support::kGasR * 298.15);
    const double wanted = wanted_kg / full_kg;
    EXPECT_NEAR(static_cast<double>(run.engine.output().gas_cycle[0].volumetric_efficiency), wanted, 3e-3 * wanted)
        << one.intake_Pa;
  }
}

}  // namespace
}  // namespace crankloop::gas_results_test
