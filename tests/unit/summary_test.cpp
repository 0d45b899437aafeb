// What a definition amounts to at one speed, where it is at its limits: refused ones, and an engine that takes work.
#include <crankloop/tabulate/summary.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include <crankloop/tabulate/mechanism.hpp>

#include "support/engines.hpp"
#include "support/status.hpp"
#include "support/units.hpp"

namespace crankloop::summary_test {
namespace {

using support::diesel_495;
using support::refuses;
using support::single_495;

TEST(ExactEngine, RefusesWhatItsDefinitionAndItsDiagramRefuse) {
  ExactEngine exact;
  EngineDefinition engine = single_495();
  engine.crank.bore_m = 0;
  EXPECT_TRUE(refuses(exact.init(engine), Reason::not_positive, "crank.bore_m"));
  engine = single_495();
  engine.pressure.wiebe.net_mep_Pa = -50e3;  // a motored cylinder loses less
  EXPECT_TRUE(refuses(exact.init(engine), Reason::no_solution, "pressure.wiebe.net_mep_Pa"));
}

TEST(CycleSummary, OfAnEngineThatPumpsHasANegativeMeanAndFluctuatesByIt) {
  EngineDefinition engine = single_495();
  engine.pressure.wiebe.heat_given = true;
  engine.pressure.wiebe.heat_J = 0;
  engine.pressure.wiebe.exhaust_Pa = 300e3;
  ExactEngine exact;
  ASSERT_TRUE(accepted(exact.init(engine)));
  const CycleSummary s = summarise(exact, 200);
  EXPECT_LT(s.mean_torque_Nm, -5);
  EXPECT_DOUBLE_EQ(s.fluctuation_ratio, (s.largest_torque_Nm - s.smallest_torque_Nm) / s.mean_torque_Nm);
}

TEST(CycleSummary, OfAFiringEngineIsThatOfItsTorquesAndOfItsLoop) {
  const double speed_rad_s = 150;
  const double load_ratio = 0.6;
  ExactEngine exact;
  ASSERT_TRUE(accepted(exact.init(diesel_495())));
  const CycleSummary s = summarise(exact, speed_rad_s, load_ratio);
  constexpr int kSamples = 7200;
  double sum_Nm = 0;
  double largest_Nm = -1e9, largest_deg = -1, smallest_Nm = 1e9, smallest_deg = -1;
  double cosine_Nm[kHarmonics] = {};
  double sine_Nm[kHarmonics] = {};
  for (int i = 0; i < kSamples; ++i) {
    const double deg = 720.0 * i / kSamples;
    const double torque_Nm = exact.torque_Nm(deg, speed_rad_s, load_ratio);
    sum_Nm += torque_Nm;
    if (torque_Nm > largest_Nm) largest_Nm = torque_Nm, largest_deg = deg;
    if (torque_Nm < smallest_Nm) smallest_Nm = torque_Nm, smallest_deg = deg;
    for (int h = 0; h < kHarmonics; ++h) {
      const double order_rad = 0.5 * (h + 1) * deg * support::kRadPerDeg;
      cosine_Nm[h] += torque_Nm * std::cos(order_rad) * 2 / kSamples;
      sine_Nm[h] += torque_Nm * std::sin(order_rad) * 2 / kSamples;
    }
  }
  // Of four equal cylinders it may be any.
  EXPECT_NEAR(s.largest_torque_Nm, largest_Nm, 1e-9);
  EXPECT_NEAR(std::remainder(s.largest_torque_deg - largest_deg, 180), 0, 1e-9);
  EXPECT_NEAR(s.smallest_torque_Nm, smallest_Nm, 1e-9);
  EXPECT_NEAR(std::remainder(s.smallest_torque_deg - smallest_deg, 180), 0, 1e-9);
  const double mean_Nm = sum_Nm / kSamples;
  EXPECT_NEAR(s.mean_torque_Nm, mean_Nm, 1e-5 * mean_Nm) << "masses and forces of a cycle do no work";
  EXPECT_NEAR(s.power_W, mean_Nm * speed_rad_s, 1e-5 * s.power_W);
  EXPECT_NEAR(s.brake.torque_Nm, s.mean_torque_Nm, 1e-9) << "without friction";
  EXPECT_NEAR(s.fluctuation_ratio, (largest_Nm - smallest_Nm) / mean_Nm, 1e-4);
  for (int h = 0; h < kHarmonics; ++h) {
    const Harmonic& harmonic = s.harmonics[h];
    EXPECT_EQ(harmonic.order, 0.5 * (h + 1));
    EXPECT_NEAR(harmonic.cosine_Nm, cosine_Nm[h], 1e-9 * largest_Nm) << h;
    EXPECT_NEAR(harmonic.sine_Nm, sine_Nm[h], 1e-9 * largest_Nm) << h;
    EXPECT_NEAR(harmonic.amplitude_Nm, std::hypot(cosine_Nm[h], sine_Nm[h]), 1e-9 * largest_Nm) << h;
  }
  // Work of p dV by trapezoids over the volume, over the two strokes about firing and over the two others.
  const auto work_J = [&](double from_deg) {
    double done_J = 0;
    const auto at = [&](double deg) {
      const double volume_m3 = bore_area_m2(exact.definition().crank) *
                               exact_pose(exact.definition().crank, deg * support::kRadPerDeg).displacement_m;
      return std::pair(volume_m3, exact.diagram().motored_Pa(deg) + load_ratio * exact.diagram().heat_Pa(deg));
    };
    for (int i = 0; i < 3600; ++i) {
      const auto [volume_m3, pressure_Pa] = at(from_deg + 0.1 * i);
      const auto [next_m3, next_Pa] = at(from_deg + 0.1 * (i + 1));
      done_J += (pressure_Pa + next_Pa) / 2 * (next_m3 - volume_m3);
    }
    return done_J;
  };
  const double swept_m3 = support::kPi / 4 * 0.095 * 0.095 * 0.115;
  EXPECT_NEAR(s.gross_mep_Pa, work_J(-180) / swept_m3, 1e-4 * s.gross_mep_Pa);
  EXPECT_NEAR(s.net_mep_Pa, (work_J(-180) + work_J(180)) / swept_m3, 1e-4 * s.net_mep_Pa);
  EXPECT_LT(s.net_mep_Pa, s.gross_mep_Pa - 1e3) << "the other two pump";
}

TEST(CycleSummary, OfATorqueWithoutMeanFluctuatesByNothing) {
  // 10 Nm once a turn, largest 30 deg after dead centre.
  const TorqueAt torque_Nm = [](const void*, double deg) { return 10 * std::cos((deg - 30) * support::kRadPerDeg); };
  for (const double mean_Nm : {0.0, 1e-15, -1e-15, 2.0, -2.0}) {
    CycleSummary s{};
    s.mean_torque_Nm = mean_Nm;
    add_torques(s, 720, torque_Nm, nullptr);
    EXPECT_NEAR(s.fluctuation_ratio, std::fabs(mean_Nm) > 1 ? 20 / mean_Nm : 0, 1e-12) << mean_Nm;
    EXPECT_EQ(s.largest_torque_deg, 30);
    EXPECT_EQ(s.smallest_torque_deg, 210);
    EXPECT_NEAR(s.harmonics[1].amplitude_Nm, 10, 1e-12);
    EXPECT_NEAR(s.harmonics[1].phase_deg, 30, 1e-12);
    EXPECT_NEAR(s.harmonics[0].amplitude_Nm, 0, 1e-12);
    EXPECT_NEAR(s.harmonics[2].amplitude_Nm, 0, 1e-12);
  }
}

TEST(InertiaOrders, AreTheFirstTwoTermsOfTheLongRodSeries) {
  EngineDefinition engine = single_495();
  engine.crank.rod_length_m = 100 * engine.crank.crank_radius_m;
  engine.crank.pin_offset_m = 0.3 * engine.crank.crank_radius_m;
  const double w = 300;
  const double unit_N = engine.masses.reciprocating_kg() * engine.crank.crank_radius_m * w * w;
  for (double deg = 0; deg < 360; deg += 7.5) {
    const double rad = deg * support::kRadPerDeg;
    const InertiaOrders orders = inertia_orders(engine, rad, w);
    // A long rod leaves terms of the order of its ratio squared.
    const double exact_N = -engine.masses.reciprocating_kg() * w * w * exact_pose(engine.crank, rad).acceleration_m;
    EXPECT_NEAR(orders.first_N + orders.second_N, exact_N, 2e-4 * unit_N) << deg;
    EXPECT_NEAR(orders.first_N, -unit_N * std::sqrt(1 + 9e-6) * std::cos(rad - std::atan(0.003)), 1e-9 * unit_N) << deg;
    EXPECT_NEAR(orders.second_N, -unit_N / 100 * std::cos(2 * rad), 1e-9 * unit_N) << deg;
  }
}

TEST(BrakeFigures, AreTheIndicatedOnesLessWhatFrictionTakesOverTheCycle) {
  // 100 kPa, 200 Pa s/rad and 1 Pa s^2/rad^2 are 130 kPa at 100 rad/s either way round; over a cycle of 4 pi they take
  // that times the swept volume.
  EngineDefinition engine = diesel_495();
  engine.friction = {100e3, 200, 1};
  const double swept_m3 = 4 * (support::kPi / 4 * 0.095 * 0.095 * 0.115);
  const double friction_Nm = 130e3 * swept_m3 / (4 * support::kPi);
  const BrakeFigures forward = brake_figures(engine, 200, 100);
  EXPECT_NEAR(forward.friction_mep_Pa, 130e3, 1e-9);
  EXPECT_NEAR(forward.torque_Nm, 200 - friction_Nm, 1e-9);
  EXPECT_NEAR(forward.power_W, 100 * (200 - friction_Nm), 1e-7);
  EXPECT_NEAR(forward.efficiency_ratio, 1 - friction_Nm / 200, 1e-12);
  const BrakeFigures backward = brake_figures(engine, -200, -100);
  EXPECT_NEAR(backward.friction_mep_Pa, 130e3, 1e-9);
  EXPECT_NEAR(backward.torque_Nm, -forward.torque_Nm, 1e-9);
  EXPECT_NEAR(backward.power_W, forward.power_W, 1e-7);
  EXPECT_EQ(brake_figures(engine, -50, 100).efficiency_ratio, 0) << "an engine that is turned";
}

}  // namespace
}  // namespace crankloop::summary_test
