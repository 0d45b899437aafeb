// Measured pressure in the tick: a diesel's trace given at 0.1 deg, coarse and uneven tables, steps. Right to 0.05 bar,
// no overshoot between given points, and the indicated work of the ticks right to 1e-4.
//
// Two references, apart from the library: the smooth function the rows were read off, and the straight line between
// given rows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <crankloop/tabulate/indicator_diagram.hpp>

#include "support/engines.hpp"
#include "support/pressure_traces.hpp"
#include "support/random.hpp"
#include "support/running.hpp"
#include "support/status.hpp"

namespace crankloop::tick_pressure_test {
namespace {

using namespace tick_test;
using support::Random;

constexpr double kPromise_Pa = 0.05 * kBar;
constexpr double kImepPromise = 1e-4;
constexpr int kUsualSegments = 4096;  // of TableStorage

using Pressures = Asking<kForces | kTorque | kMeanTorque, PressureGiven::by_table, false, CrankGiven::phase, 1>;
using PressuresByLoad = Asking<kForces | kTorque | kMeanTorque, PressureGiven::by_table, true, CrankGiven::phase, 1>;

EngineDefinition engine_with(const std::vector<DiagramPoint>& rows) {
  EngineDefinition engine = single_495();
  engine.pressure.source = PressureSource::angle_table;
  engine.pressure.points = rows.data();
  engine.pressure.point_count = static_cast<int>(rows.size());
  return engine;
}

/// Work of a pressure over the cycle, Pa m^3 per m^2 of piston: the integral of p dx by Simpson's rule over 0.02 deg.
template <class Function>
double work_per_area(const Function& pressure_Pa) {
  const Crank crank = single_495().crank;
  const auto integrand = [&](int i) {
    const double deg = i * 0.01;
    return pressure_Pa(deg) * static_cast<double>(oracle_pose_at_deg(crank, deg).slope_m);
  };
  double sum = 0;
  for (int i = 0; i < 36'000; ++i) sum += integrand(2 * i) + 4 * integrand(2 * i + 1) + integrand(2 * i + 2);
  return sum * 0.02 / 6 * kPi / 180;
}

/// The tick's pressure all around the cycle, at angles that are on no grid, and at every 0.05 deg with a unit to either
/// side.
template <class Real, class S, class Visit>
void visit_pressures(const FullTables<Real>& tables, const Visit& visit) {
  Running<Real, S> run(tables);
  typename Engine<Real, S>::Input in;
  const auto at = [&](Phase phase) {
    in.crank = phase;
    run.engine.step(in);
    visit(static_cast<double>(deg_of(phase)), static_cast<double>(run.engine.output().cylinder[0].pressure_Pa));
  };
  for (int i = 0; i < 62'207; ++i) at(phase_at_deg(720.0L * i / 62'207));
  for (int i = 0; i < 14'400; ++i) {
    for (const std::uint64_t off :
         {~std::uint64_t{0} << 32, ~std::uint64_t{0}, std::uint64_t{0}, std::uint64_t{1} << 32}) {
      at(phase_at_deg(i / 20.0L) + Phase{off});
    }
  }
}

/// Indicated work over a cycle from the mean torque of 720 ticks, per area like work_per_area.
template <class Real, class S>
double tick_work_per_area(const FullTables<Real>& tables, int ticks) {
  Running<Real, S> run(tables);
  typename Engine<Real, S>::Input in;
  in.crank = phase_at_deg(123.4L);
  run.engine.step(in);  // the first measured angle has no tick behind it
  long double work_J = 0;
  for (int i = 1; i <= ticks; ++i) {
    const Phase before = run.engine.state().phase;
    in.crank = phase_at_deg(123.4L) + phase_at_deg(720.0L * i / ticks);
    work_J += static_cast<long double>(run.engine.step(in).mean_torque_Nm) * turned_rad(before, in.crank);
  }
  return static_cast<double>(work_J / (kWidePi / 4 * 0.095L * 0.095L));
}

template <class Real>
class TickPressure : public ::testing::Test {};
TYPED_TEST_SUITE(TickPressure, BothReals, RealName);

// ---- a measured trace -----------------------------------------------------------------------------------------------

struct Trace {
  const char* name;
  double noise_Pa;
  double ringing_Pa;
};
constexpr Trace kTraces[] = {
    {"smooth", 0, 0},
    {"with 0.01 bar of noise", 0.01 * kBar, 0},
    {"with 2 bar of 6 kHz ringing", 0, 2 * kBar},
    {"with ringing and noise", 0.01 * kBar, 2 * kBar},
};

TEST(MeasuredTrace, OfTheseTestsRisesAtElevenPointSixBarPerDegree) {
  const SmoothTrace trace;
  double steepest = 0;
  for (double deg = -30; deg < 30; deg += 0.01)
    steepest = std::max(steepest, (trace(deg + 0.005) - trace(deg - 0.005)) / 0.01);
  EXPECT_NEAR(steepest, 11.6 * kBar, 0.1 * kBar);
}

TYPED_TEST(TickPressure, OfATraceGivenAtATenthOfADegreeIsWithinATwentiethOfABarEverywhere) {
  using Real = TypeParam;
  for (const Trace& trace : kTraces) {
    SmoothTrace smooth;
    smooth.ringing_Pa = trace.ringing_Pa;
    const std::vector<DiagramPoint> rows = rows_of(smooth, evenly_deg(7200), trace.noise_Pa);
    const double want = work_per_area(smooth);
    for (const int capacity : {kUsualSegments, kFinestGrid}) {
      if (trace.noise_Pa <= 0 && capacity == kFinestGrid) continue;  // a smooth trace needs some 1000 segments
      FullTables<Real> tables;
      ASSERT_TRUE(accepted(tables.build(engine_with(rows), 100e-6, capacity)));
      double from_smooth = 0;
      double from_linear = 0;
      double overshoot = 0;
      visit_pressures<Real, Pressures>(tables, [&](double deg, double pressure) {
        from_smooth = std::max(from_smooth, std::fabs(pressure - smooth(deg)));
        const Neighbours rows_around = neighbours_of(rows, deg);
        from_linear = std::max(from_linear, std::fabs(pressure - rows_around.linear_Pa(deg)));
        overshoot = std::max({overshoot, pressure - rows_around.highest_Pa(), rows_around.lowest_Pa() - pressure});
      });
      EXPECT_LE(from_smooth, kPromise_Pa + trace.noise_Pa) << trace.name << ", room for " << capacity;
      EXPECT_LE(from_linear, kPromise_Pa) << trace.name << ", room for " << capacity;
      // No overshoot but for the tables' stated error, which is at most 1e-5 of the peak where there is room, and
      // rounding of a float's pressure.
      const double rounding_Pa = sizeof(Real) == 4 ? 4 * 6e-8 * 90 * kBar : 1e-6;
      EXPECT_LE(overshoot, 1.1 * tables.report().pressure_error_Pa + rounding_Pa)
          << trace.name << ", room for " << capacity;
      if (trace.noise_Pa <= 0 || capacity == kFinestGrid) {
        EXPECT_LE(overshoot, 1.1e-5 * 90 * kBar + rounding_Pa) << trace.name;
      }
      if (trace.noise_Pa <= 0) {
        EXPECT_LE(tables.report().pressure_error_Pa, 1e-5 * 92 * kBar) << trace.name;
      }
      const double got = tick_work_per_area<Real, Pressures>(tables, 720);
      EXPECT_NEAR(got / want, 1, kImepPromise) << trace.name << ", room for " << capacity;
      std::printf(
          "[ measured ] %s, %s, room for %d: %d segments, from smooth %.2g bar, from straight lines %.2g bar, "
          "overshoot %.2g bar, IMEP %.2g\n",
          sizeof(Real) == 4 ? "float" : "double", trace.name, capacity, tables.report().gas_segments,
          from_smooth / kBar, from_linear / kBar, overshoot / kBar, got / want - 1);
    }
  }
}

TYPED_TEST(TickPressure, TheReportedErrorIsTheErrorThereIs) {
  using Real = TypeParam;
  SmoothTrace smooth;
  smooth.ringing_Pa = 2 * kBar;
  const std::vector<DiagramPoint> rows = rows_of(smooth, evenly_deg(7200), 0.01 * kBar);
  const EngineDefinition engine = engine_with(rows);
  IndicatorDiagram diagram;
  ASSERT_TRUE(accepted(diagram.init(engine.crank, engine.pressure)));
  for (const int capacity : {720, 1500, kFinestGrid}) {
    FullTables<Real> tables;
    ASSERT_TRUE(accepted(tables.build(engine, 100e-6, capacity)));
    EXPECT_LE(tables.report().gas_segments, capacity);
    double worst = 0;
    visit_pressures<Real, Pressures>(tables, [&](double deg, double pressure) {
      worst = std::max(worst, std::fabs(pressure - diagram.full_Pa(deg)));
    });
    // Ten points in a segment find a polynomial's largest error to a few hundredths where the segment is 0.1 deg or
    // less; a whole degree of the trace holds ten rows, and a maximum between two of ten points may be a third larger.
    const double missed = capacity == kFinestGrid ? 1.1 : 1.35;
    EXPECT_LE(worst, missed * tables.report().pressure_error_Pa + 4 * 6e-8 * 90 * kBar) << "room for " << capacity;
    // It speaks for the motored and the heat's pressure too, which are rougher.
    EXPECT_GE(worst, 0.2 * tables.report().pressure_error_Pa) << "room for " << capacity;
  }
}

TYPED_TEST(TickPressure, AtFullLoadOfASceneWithLoadIsTheSameTrace) {
  using Real = TypeParam;
  SmoothTrace smooth;
  smooth.ringing_Pa = 2 * kBar;
  const std::vector<DiagramPoint> rows = rows_of(smooth, evenly_deg(7200), 0.01 * kBar);
  for (const int capacity : {kUsualSegments, kFinestGrid}) {
    FullTables<Real> tables;
    ASSERT_TRUE(accepted(tables.build(engine_with(rows), 100e-6, capacity)));
    double from_linear = 0;
    visit_pressures<Real, PressuresByLoad>(tables, [&](double deg, double pressure) {
      const Neighbours rows_around = neighbours_of(rows, deg);
      from_linear = std::max(from_linear, std::fabs(pressure - rows_around.linear_Pa(deg)));
    });
    EXPECT_LE(from_linear, kPromise_Pa) << "room for " << capacity;
    EXPECT_NEAR((tick_work_per_area<Real, PressuresByLoad>(tables, 720)) / work_per_area(smooth), 1, kImepPromise)
        << "room for " << capacity;
  }
}

TYPED_TEST(TickPressure, OfRowsThatBeginAnywhereAndCloseTheirPeriodIsTheSame) {
  using Real = TypeParam;
  const SmoothTrace smooth;
  // -360 to 360 with a closing row, as many indicating systems write it; and one that begins beside the degrees.
  std::vector<double> closing = evenly_deg(7200, -360);
  closing.push_back(360);
  for (const std::vector<double>& angles : {closing, evenly_deg(7200, -359.97), evenly_deg(7200, 1000.03)}) {
    const std::vector<DiagramPoint> rows = rows_of(smooth, angles);
    FullTables<Real> tables;
    ASSERT_TRUE(accepted(tables.build(engine_with(rows), 100e-6)));
    double worst = 0;
    visit_pressures<Real, Pressures>(
        tables, [&](double deg, double pressure) { worst = std::max(worst, std::fabs(pressure - smooth(deg))); });
    EXPECT_LE(worst, kPromise_Pa) << "first row at " << angles.front();
    EXPECT_NEAR((tick_work_per_area<Real, Pressures>(tables, 720)) / work_per_area(smooth), 1, kImepPromise)
        << "first row at " << angles.front();
  }
}

// ---- other tables ---------------------------------------------------------------------------------------------------

/// Every value between the two rows around it, but for `allowed_Pa`; every row met to the same.
template <class Real>
void expect_between_rows(const std::vector<DiagramPoint>& rows, double allowed_Pa, const std::string& what) {
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(engine_with(rows), 100e-6))) << what;
  double overshoot = 0;
  double where = 0;
  visit_pressures<Real, Pressures>(tables, [&](double deg, double pressure) {
    const Neighbours around = neighbours_of(rows, deg);
    const double over = std::max(pressure - around.highest_Pa(), around.lowest_Pa() - pressure);
    if (over > overshoot) overshoot = over, where = deg;
  });
  EXPECT_LE(overshoot, allowed_Pa) << what << ", at " << where << " deg; stated error "
                                   << tables.report().pressure_error_Pa << " Pa";
  Running<Real, Pressures> run(tables);
  typename Engine<Real, Pressures>::Input in;
  for (const DiagramPoint& row : rows) {
    in.crank =
        phase_at_deg(static_cast<long double>(row.at) - 720 * std::floor(static_cast<long double>(row.at) / 720));
    const auto pressure = static_cast<double>(run.engine.step(in).cylinder[0].pressure_Pa);
    ASSERT_NEAR(pressure, row.pressure_Pa, allowed_Pa) << what << ", row at " << row.at;
  }
}

/// 1e-5 of the peak, measured at ten points of a segment, and rounding.
double stated_error_Pa(double peak_Pa) { return 1.15e-5 * peak_Pa; }

TYPED_TEST(TickPressure, OfACoarseTableStaysBetweenItsRows) {
  using Real = TypeParam;
  const SmoothTrace smooth;
  expect_between_rows<Real>(rows_of(smooth, evenly_deg(720)), stated_error_Pa(90 * kBar), "1 deg");
  expect_between_rows<Real>(rows_of(smooth, evenly_deg(360, 0.5)), stated_error_Pa(90 * kBar),
                            "2 deg, beside the degrees");
  std::vector<double> twenty;  // 38 deg apart, the last one closes the period
  for (int i = 0; i < 20; ++i) twenty.push_back(720.0 * i / 19);
  expect_between_rows<Real>(rows_of(smooth, twenty), stated_error_Pa(90 * kBar), "20 rows");
  std::vector<double> few = {-360, -180, -120, -60, -20, 0, 8, 20, 45, 90, 140, 180, 340};
  expect_between_rows<Real>(rows_of(smooth, few), stated_error_Pa(90 * kBar), "13 rows of widely uneven spacing");
}

TYPED_TEST(TickPressure, OfUnevenRowsOnNoGridStaysBetweenThem) {
  using Real = TypeParam;
  const SmoothTrace smooth;
  Random random;
  for (int draw = 0; draw < 3; ++draw) {
    std::vector<double> angles;
    for (double at = random.between(-400, -300); angles.empty() || at < angles.front() + 719;
         at += random.between(0.3, 3))
      angles.push_back(at);
    expect_between_rows<Real>(rows_of(smooth, angles), 2 * stated_error_Pa(90 * kBar), random.trace(draw));
  }
}

TYPED_TEST(TickPressure, OfRandomRowsOnTheGridStaysBetweenThem) {
  using Real = TypeParam;
  // Nothing smooth about it: every row anything from 0 to 100 bar.
  Random random;
  const auto anything = [&random](double) { return random.between(0, 100 * kBar); };
  // A cubic over 0.1 or 1 deg, as 20 parabolas in a degree: what the grid can do is its limit, and the table says so.
  for (const int n : {720, 7200}) {
    const std::vector<DiagramPoint> rows = rows_of(anything, evenly_deg(n));
    expect_between_rows<Real>(rows, n == 720 ? 2e-4 * 100 * kBar : 0.02 * 100 * kBar,
                              std::to_string(n) + " random rows, " + random.trace(n));
  }
}

TYPED_TEST(TickPressure, StepsOfFiftyBarStayBetweenTheirRows) {
  using Real = TypeParam;
  const auto step = [](double deg) { return deg < 60.05 || deg > 200 ? 10 * kBar : 60 * kBar; };
  // Rows 0.1 deg apart: the step takes two parabolas, whose middle meets the cubic's.
  expect_between_rows<Real>(rows_of(step, evenly_deg(7200)), 0.0125 * 50 * kBar, "50 bar in 0.1 deg");
  expect_between_rows<Real>(rows_of(step, evenly_deg(720)), 2e-4 * 50 * kBar, "50 bar in 1 deg");
}

TYPED_TEST(TickPressure, AStepNarrowerThanTheGridStaysWithinItsRange) {
  using Real = TypeParam;
  for (const double width : {0.04, 0.01, 0.001, 1e-6}) {
    std::vector<DiagramPoint> rows;
    for (int i = 0; i < 720; ++i) {
      rows.push_back({static_cast<double>(i), i <= 100 || i > 200 ? 10 * kBar : 60 * kBar});
      if (i == 100) {
        rows.push_back({100.52, 10 * kBar});
        rows.push_back({100.52 + width, 60 * kBar});
      }
    }
    FullTables<Real> tables;
    ASSERT_TRUE(accepted(tables.build(engine_with(rows), 100e-6)));
    visit_pressures<Real, Pressures>(tables, [&](double deg, double pressure) {
      ASSERT_GE(pressure, 10 * kBar - 0.001 * kBar) << "at " << deg << ", width " << width;
      ASSERT_LE(pressure, 60 * kBar + 0.001 * kBar) << "at " << deg << ", width " << width;
      if (deg < 100.45 || deg > 201.1) {
        ASSERT_NEAR(pressure, 10 * kBar, 0.001 * kBar) << "at " << deg;
      }
      if (deg > 100.6 && deg < 199.9) {
        ASSERT_NEAR(pressure, 60 * kBar, 0.001 * kBar) << "at " << deg;
      }
    });
  }
}

// ---- torque and work of steep pressures -----------------------------------------------------------------------------

/// Ticks of a quarter degree from `from_deg` on: each one's mean torque is the average of the torque at 200 places
/// inside it.
template <class Real>
void expect_mean_torque_within_ticks(const std::vector<DiagramPoint>& rows, long double from_deg, int ticks,
                                     double peak_Pa) {
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(engine_with(rows), 100e-6)));
  using BySpeed = Asking<kTorque | kMeanTorque, PressureGiven::by_table, false, CrankGiven::speed, 1>;
  using ByPhase = Asking<kTorque, PressureGiven::by_table, false, CrankGiven::phase, 1>;
  Running<Real, BySpeed> run(tables, phase_at_deg(from_deg));
  Running<Real, ByPhase> probe(tables, phase_at_deg(from_deg));
  typename Engine<Real, BySpeed>::Input in;
  in.speed_rad_s = Real{43};  // 0.25 deg a tick; the masses' torque is below 10 Nm
  const double scale = peak_Pa * kPi / 4 * 0.095 * 0.095 * 0.0575;
  run.engine.step(in);
  for (int tick = 0; tick < ticks; ++tick) {
    const Phase from = run.engine.state().phase;
    const auto mean = static_cast<double>(run.engine.step(in).mean_torque_Nm);
    const std::uint64_t turned = (run.engine.state().phase - from).units();
    double sum = 0;
    typename Engine<Real, ByPhase>::Input at;
    for (std::uint64_t i = 0; i < 200; ++i) {
      at.crank = from + Phase{turned / 400 * (2 * i + 1)};
      sum += static_cast<double>(probe.engine.step(at).torque_Nm);
    }
    // 200 places see a parabola of 0.05 deg at 40: the sum is right to 1e-3 of its range.
    ASSERT_NEAR(mean, sum / 200, 0.002 * scale)
        << "from " << static_cast<double>(deg_of(from)) << " deg, tick " << tick;
  }
}

TYPED_TEST(TickPressure, WorkIsCountedWithoutOverflowHoweverSteepTheTorque) {
  using Real = TypeParam;
  // Late in a degree a steep parabola's continuation to the degree's start may be far larger than the cycle's work,
  // which float counts in 32 bits.
  const auto step = [](double deg) { return deg < 75.85 || deg > 140 ? 1 * kBar : 500 * kBar; };
  expect_mean_torque_within_ticks<Real>(rows_of(step, evenly_deg(7200)), 70, 320, 500 * kBar);
  const auto spike = [](double deg) { return std::fabs(deg - 75.9) > 0.01 ? 1 * kBar : 500 * kBar; };
  expect_mean_torque_within_ticks<Real>(rows_of(spike, evenly_deg(7200)), 70, 40, 500 * kBar);
  Random random;
  const auto anything = [&random](double) { return random.between(0, 100 * kBar); };
  expect_mean_torque_within_ticks<Real>(rows_of(anything, evenly_deg(7200)), 0, 2880, 100 * kBar);
}

TYPED_TEST(TickPressure, TorqueFollowsASteepStep) {
  using Real = TypeParam;
  const auto step = [](double deg) { return deg < 75.85 || deg > 140 ? 1 * kBar : 500 * kBar; };
  const std::vector<DiagramPoint> rows = rows_of(step, evenly_deg(7200));
  const EngineDefinition engine = engine_with(rows);
  IndicatorDiagram diagram;
  ASSERT_TRUE(accepted(diagram.init(engine.crank, engine.pressure)));
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(engine, 100e-6)));
  using ByPhase = Asking<kTorque, PressureGiven::by_table, false, CrankGiven::phase, 1>;
  Running<Real, ByPhase> run(tables, phase_at_deg(75));
  const double area = kPi / 4 * 0.095 * 0.095;
  for (int i = 0; i < 2000; ++i) {
    const double deg = 75 + i * 0.001;
    const double torque = static_cast<double>(
        run.engine.step(at_phase<Engine<Real, ByPhase>>(phase_at_deg(static_cast<long double>(deg)))).torque_Nm);
    // p0 is 1 bar; the torque's parabola may miss the cubic between two rows by 0.012 of the step, as the pressure's
    // does, and overshoot as much.
    const double want =
        (diagram.full_Pa(deg) - 1 * kBar) * area * static_cast<double>(oracle_pose_at_deg(engine.crank, deg).slope_m);
    ASSERT_NEAR(torque, want, 0.013 * 499 * kBar * area * 0.0575) << "at " << deg << " deg";
  }
}

TYPED_TEST(TickPressure, OfASynthesisedDiagramFollowsItWithinTheStatedError) {
  using Real = TypeParam;
  const EngineDefinition engine = single_495();
  IndicatorDiagram diagram;
  ASSERT_TRUE(accepted(diagram.init(engine.crank, engine.pressure)));
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(engine, 100e-6, kUsualSegments)));
  double worst = 0;
  double where = 0;
  double peak = 0;
  visit_pressures<Real, Pressures>(tables, [&](double deg, double pressure) {
    peak = std::max(peak, pressure);
    const double error = std::fabs(pressure - diagram.full_Pa(deg));
    if (error > worst) worst = error, where = deg;
  });
  // The exhaust valve opens with a kink, and combustion begins with one: on a border where they are whole degrees.
  EXPECT_LE(worst, 1.2e-5 * peak) << "at " << where << " deg";
  std::printf("[ measured ] %s: synthesised diagram, %d segments, from the diagram %.2g bar of %.3g\n",
              sizeof(Real) == 4 ? "float" : "double", tables.report().gas_segments, worst / kBar, peak / kBar);
}

}  // namespace
}  // namespace crankloop::tick_pressure_test
