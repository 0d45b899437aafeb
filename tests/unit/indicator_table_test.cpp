// Cylinder pressure from tables over the angle or the volume: they give back what they were made of, and their motored
// part.
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/mechanism.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/indicator_diagrams.hpp"
#include "support/random.hpp"
#include "tabulate/monotone_cubic.hpp"

namespace crankloop::indicator_table_test {

using namespace detail;
namespace {

using namespace support;

// An angle of up to 1440 deg goes through two additions before it is looked up.
constexpr double kAngleRounding_deg = 4 * kEps * 1440;

TEST(NoDiagram, IsCrankcasePressureAtAllTimes) {
  Pressure pressure;
  pressure.crankcase_Pa = 97e3;
  const IndicatorDiagram diagram = diagram_of(support::diesel_495_crank(), pressure);
  for (const double deg : {-1000.0, 0.0, 359.9, 720.0, 1e6}) {
    EXPECT_EQ(diagram.full_Pa(deg), 97e3);
    EXPECT_EQ(diagram.motored_Pa(deg), 97e3);
    EXPECT_EQ(diagram.heat_Pa(deg), 0);
  }
}

// ---- angle tables ---------------------------------------------------------------------------------------------------

/// A rough table: uneven rows, pressures without any law. Some start before 0, some have a closing row.
Rows rough_rows(Random& random) {
  Rows rows;
  const double start = random.between(-720, 720);
  for (double at = start; at < start + 715; at += random.between(0.05, 20))
    rows.push_back({at, random.between(0, 100e5)});
  if (random.coin()) rows.push_back({start + 720, rows.front().pressure_Pa});
  return rows;
}

TEST(AngleTable, GivesEveryGivenPointBackInEveryCycle) {
  Random random;
  for (int draw = 0; draw < 50; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Rows rows = rough_rows(random);
    const IndicatorDiagram diagram = diagram_of_rows(rows, PressureSource::angle_table);
    for (const DiagramPoint& row : rows) {
      for (const int cycle : {-2, -1, 0, 1}) {
        // The steepest that such a table gets: 100 bar in 0.05 deg, times 3 at most inside a monotone cubic
        // (Fritsch-Butland slopes).
        const double tolerance = 3 * 100e5 / 0.05 * kAngleRounding_deg;
        EXPECT_NEAR(diagram.full_Pa(row.at + 720 * cycle), row.pressure_Pa, tolerance) << row.at;
      }
      EXPECT_EQ(diagram_of_rows(rows, PressureSource::angle_table).full_Pa(rows.front().at), rows.front().pressure_Pa);
    }
    if (HasFailure()) return;
  }
}

TEST(AngleTable, StaysBetweenNeighbouringPointsEverywhereAcrossTheSeamToo) {
  Random random;
  for (int draw = 0; draw < 50; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Rows given = rough_rows(random);
    const IndicatorDiagram diagram = diagram_of_rows(given, PressureSource::angle_table);
    Rows rows = given;
    if (rows.back().at < rows.front().at + 720) rows.push_back({rows.front().at + 720, rows.front().pressure_Pa});
    for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
      const double low = std::min(rows[i].pressure_Pa, rows[i + 1].pressure_Pa);
      const double high = std::max(rows[i].pressure_Pa, rows[i + 1].pressure_Pa);
      double before = rows[i].pressure_Pa;
      for (int step = 1; step < 20; ++step) {
        const double p = diagram.full_Pa(rows[i].at + (rows[i + 1].at - rows[i].at) * step / 20);
        const double rounding = 16 * kEps * 100e5;
        EXPECT_GE(p, low - rounding);
        EXPECT_LE(p, high + rounding);
        // and runs from one to the other without turning round
        if (rows[i + 1].pressure_Pa > rows[i].pressure_Pa) {
          EXPECT_GE(p, before - rounding);
        } else {
          EXPECT_LE(p, before + rounding);
        }
        before = p;
      }
    }
    if (HasFailure()) return;
  }
}

TEST(AngleTable, HasNoStepAndNoCornerAtAnyPoint) {
  Random random;
  for (int draw = 0; draw < 20; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const Rows rows = rough_rows(random);
    const IndicatorDiagram diagram = diagram_of_rows(rows, PressureSource::angle_table);
    for (const DiagramPoint& row : rows) {
      // One-sided slopes over d: a cubic's slope changes by at most d/2 times its bend, which is at most 12
      // rises/width^2 (widths >= 0.05).
      const double d = 1e-5;
      const double left = (diagram.full_Pa(row.at) - diagram.full_Pa(row.at - d)) / d;
      const double right = (diagram.full_Pa(row.at + d) - diagram.full_Pa(row.at)) / d;
      const double bend = 12 * 100e5 / (0.05 * 0.05);
      const double angle_rounding = 2 * kAngleRounding_deg / d * 3 * 100e5 / 0.05;
      EXPECT_NEAR(left, right, d * bend + angle_rounding) << row.at;
    }
    if (HasFailure()) return;
  }
}

TEST(AngleTable, HasTheSlopesOfFritschAndButlandAtUnevenlySpacedPoints) {
  // G = S1 S2/(alpha S2 + (1 - alpha) S1), alpha = (1 + h2/(h1 + h2))/3, S the secants and h the widths to the left and
  // right of a point [Fritsch and Butland 1984, formula of Brodlie]; zero where the secants differ in sign.
  Random random;
  const Rows rows = rough_rows(random);
  const IndicatorDiagram diagram = diagram_of_rows(rows, PressureSource::angle_table);
  for (std::size_t i = 1; i + 2 < rows.size(); ++i) {
    const double h1 = rows[i].at - rows[i - 1].at;
    const double h2 = rows[i + 1].at - rows[i].at;
    const double s1 = (rows[i].pressure_Pa - rows[i - 1].pressure_Pa) / h1;
    const double s2 = (rows[i + 1].pressure_Pa - rows[i].pressure_Pa) / h2;
    const double alpha = (1 + h2 / (h1 + h2)) / 3;
    const double want = s1 * s2 > 0 ? s1 * s2 / (alpha * s2 + (1 - alpha) * s1) : 0;
    // One-sided difference over d: off by d/2 of the cubic's bend, at most 12 rises/width^2, and by the angles'
    // rounding.
    const double d = 1e-4 * h2;
    const double got = (diagram.full_Pa(rows[i].at + d) - diagram.full_Pa(rows[i].at)) / d;
    EXPECT_NEAR(got, want, std::fabs(s2) * (12 * d / h2 / 2 + 6 * kAngleRounding_deg / d))
        << random.trace(0) << ", row " << i;
  }
}

TEST(MonotoneSlope, IsInTheUnitsOfItsPointsHoweverSmall) {
  const auto slope = [](double unit) {
    return detail::monotone_slope({0, 0}, {1, 2 * unit}, {3, 5 * unit});  // secants 2 and 1.5, widths 1 and 2
  };
  EXPECT_NEAR(slope(1), 9 / (5 / 2.0 + 4 / 1.5), 1e-15);
  for (const double unit : {1e-3, 1e-9, 1e9, -1e-6})
    EXPECT_NEAR(slope(unit), unit * slope(1), 1e-15 * std::fabs(unit)) << unit;
  EXPECT_EQ(detail::monotone_slope({0, 0}, {1, 1e-9}, {2, 0}), 0) << "a peak";
  EXPECT_EQ(detail::monotone_slope({0, 0}, {1, 0}, {2, 1}), 0) << "the end of a level";
}

TEST(AngleTable, OfASmoothCurveIsThatCurveToTheSquareOfItsSpacing) {
  // Beside a peak a monotone cubic forces the slope of a point to zero or near it: off by at most h^2/4 of the bend.
  for (const int per_degree : {1, 2, 10}) {
    const Rows rows = support::angle_rows(smooth_pressure_Pa, per_degree, -180);
    const IndicatorDiagram diagram = diagram_of_rows(rows, PressureSource::angle_table);
    const double h = 1.0 / per_degree;
    for (double deg = -360; deg < 720; deg += 0.0371) {
      EXPECT_NEAR(diagram.full_Pa(deg), smooth_pressure_Pa(deg), h * h / 4 * kMaxBent_Pa_deg2) << deg;
    }
  }
}

TEST(AngleTable, OfASteepDieselTraceGivenEveryTenthOfADegreeIsWithin005Bar) {
  // A rise of 11.6 bar/deg: 25 bar of premixed burning as tanh, on top of the smooth cycle.
  const auto trace = [](double deg) {
    const double into = deg - 720 * std::floor((deg + 360) / 720);
    return smooth_pressure_Pa(deg) + 12.5e5 * (std::tanh((into + 4) / 1.24) + 1) * std::exp(-into * into / 800);
  };
  double steepest = 0;
  for (double deg = -20; deg < 20; deg += 0.01)
    steepest = std::max(steepest, (trace(deg + 0.005) - trace(deg - 0.005)) / 0.01);
  EXPECT_NEAR(steepest, 11.6e5, 0.1e5) << "the trace is as steep as the one that was measured";
  const Rows rows = support::angle_rows(trace, 10);
  const IndicatorDiagram diagram = diagram_of_rows(rows, PressureSource::angle_table);
  for (double deg = -40; deg < 60; deg += 0.0013) EXPECT_NEAR(diagram.full_Pa(deg), trace(deg), 0.05e5) << deg;
}

TEST(AngleTable, MotoredRetracesTheCompressionVolumeForVolumeLessTheLoss) {
  for (const double offset_ratio : {-0.2, 0.0, 0.2}) {
    const Crank crank = crank_with_offset(offset_ratio);
    const Rows rows = support::angle_rows(smooth_pressure_Pa, 10);
    const IndicatorDiagram diagram = diagram_of_rows(rows, PressureSource::angle_table, crank);
    const DeadCentres centres = dead_centres(crank);
    const double top = centres.tdc_rad / kRadPerDeg;
    const double bottom = centres.bdc_rad / kRadPerDeg;
    for (double deg = top + 0.01; deg < bottom; deg += 0.97) {
      const double up = same_height_going_up(crank, deg, bottom, top);
      // Near the dead centres the angle hangs on the root of the height's rounding, 1e-16 -> 1e-7 rad.
      const double left = std::pow(support::volume_m3(crank, deg) / support::volume_m3(crank, top), -0.03);
      EXPECT_NEAR(diagram.motored_Pa(deg), diagram.full_Pa(up) * left, kSteepest_Pa_deg * 1e-7 / kRadPerDeg)
          << deg << ", offset " << offset_ratio;
    }
  }
}

TEST(AngleTable, MotoredHasNoHeatInCompressionAndIntakeAndNoBlowDown) {
  const Crank crank = crank_with_offset(0.1);
  // An exhaust stroke with a blow-down and a level that the motored engine keeps.
  const auto trace = [](double deg) {
    const double into = deg - 720 * std::floor(deg / 720);
    return into > 180 && into < 360 ? 1.1e5 + 4e5 * std::exp(-(into - 180) / 12) : smooth_pressure_Pa(deg);
  };
  const Rows rows = support::angle_rows(trace, 2);
  const IndicatorDiagram diagram = diagram_of_rows(rows, PressureSource::angle_table, crank);
  const double top = dead_centres(crank).tdc_rad / kRadPerDeg;
  const double bottom = dead_centres(crank).bdc_rad / kRadPerDeg;
  for (double deg = top + 360.001; deg < top + 720; deg += 0.7) EXPECT_EQ(diagram.heat_Pa(deg), 0) << deg;
  for (double deg = bottom + 10; deg < top + 360; deg += 0.7) {
    EXPECT_LT(diagram.motored_Pa(deg), 1.12e5) << deg;
    EXPECT_GE(diagram.heat_Pa(deg), 0) << deg;
  }
}

TEST(AngleTable, MotoredGoesFromCompressionToExhaustPressureInAStraightLineOfTenDegrees) {
  // One pressure from well before bottom dead centre of the compression, another in all of the exhaust stroke and some
  // way beyond.
  constexpr double kCompression_Pa = 0.9e5, kExhaust_Pa = 1.5e5;
  const auto trace = [](double deg) { return deg >= 90 && deg <= 400 ? kExhaust_Pa : kCompression_Pa; };
  const Rows rows = support::angle_rows(trace, 2);
  for (const double offset_ratio : {-0.2, 0.0, 0.2}) {
    const Crank crank = crank_with_offset(offset_ratio);
    const IndicatorDiagram diagram = diagram_of_rows(rows, PressureSource::angle_table, crank);
    const double bottom = dead_centres(crank).bdc_rad / kRadPerDeg;
    const double bottom_Pa =
        kCompression_Pa * std::pow(crank.compression_ratio, -0.03);  // less what it has lost on its way up and down
    for (double beyond_deg = 0.5; beyond_deg < 15; ++beyond_deg) {
      const double line_Pa = bottom_Pa + (kExhaust_Pa - bottom_Pa) * std::min(beyond_deg / 10, 1.0);
      EXPECT_NEAR(diagram.motored_Pa(bottom + beyond_deg), line_Pa, 1e-9 * kExhaust_Pa)
          << beyond_deg << ", offset " << offset_ratio;
    }
  }
}

TEST(AngleTable, HasNoStepAtDeadCentresMotoredOrFired) {
  const Rows rows = support::angle_rows(smooth_pressure_Pa, 2);
  for (const double offset_ratio : {-0.2, 0.0, 0.2}) {
    const IndicatorDiagram diagram =
        diagram_of_rows(rows, PressureSource::angle_table, crank_with_offset(offset_ratio));
    // The heat may change as fast as both of its parts; the motored ramp after bottom dead centre takes 10 deg for less
    // than 1 bar.
    expect_no_step(diagram, 2.2 * kSteepest_Pa_deg, "offset " + std::to_string(offset_ratio));
  }
}

TEST(Diagram, FullIsMotoredPlusHeatAndRepeatsEvery720Degrees) {
  const Crank crank = crank_with_offset(0.1);
  const Rows rows = support::angle_rows(smooth_pressure_Pa, 2);
  Pressure wiebe;
  wiebe.source = PressureSource::wiebe;
  wiebe.wiebe.net_mep_Pa = 8e5;
  for (const Pressure& pressure : {support::table_pressure(PressureSource::angle_table, rows), wiebe}) {
    const IndicatorDiagram diagram = diagram_of(crank, pressure);
    for (double deg = 0; deg < 720; deg += 1.3) {
      const double p = diagram.full_Pa(deg);
      EXPECT_NEAR(diagram.motored_Pa(deg) + diagram.heat_Pa(deg), p, 2 * kEps * p) << deg;
      // 1e6 cycles on, the angle itself has lost nine digits.
      EXPECT_NEAR(diagram.full_Pa(deg + 720), p, 100e5 * kAngleRounding_deg) << deg;
      EXPECT_NEAR(diagram.full_Pa(deg - 7200), p, 10 * 100e5 * kAngleRounding_deg) << deg;
      EXPECT_NEAR(diagram.full_Pa(deg + 720e6), p, 100e5 * kEps * 720e6) << deg;
    }
  }
}

TEST(Diagram, AnswersAFinitePressureForAnyAngleAtAll) {
  const Rows rows = support::angle_rows(smooth_pressure_Pa, 1);
  const IndicatorDiagram diagram = diagram_of_rows(rows, PressureSource::angle_table);
  for (const double deg :
       {1e9, -1e9, 1e18, -1e300, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_GE(diagram.full_Pa(deg), 0.5e5) << deg;
    EXPECT_LE(diagram.full_Pa(deg), 70e5) << deg;
  }
}

// ---- volume tables --------------------------------------------------------------------------------------------------

TEST(VolumeTable, MadeFromAKnownPressureOverTheAngleGivesItBack) {
  struct Case {
    double offset_ratio, step_deg;  // of 0.25 deg there are too many rows for the diagram to keep their angles
  };
  for (const auto [offset_ratio, step_deg] : {Case{-0.2, 0.5}, Case{0.0, 0.5}, Case{0.2, 0.5}, Case{0.2, 0.25}}) {
    for (const bool with_dead_centres : {true, false}) {
      SCOPED_TRACE("offset " + std::to_string(offset_ratio) + (with_dead_centres ? ", dead centres given" : ""));
      const Crank crank = crank_with_offset(offset_ratio);
      const VolumeLoop loop = volume_loop(crank, smooth_pressure_Pa, step_deg, with_dead_centres);
      const IndicatorDiagram diagram = diagram_of_rows(loop.rows, PressureSource::volume_table, crank);
      const double x_rounding = 8 * kEps * (crank.crank_radius_m + crank.rod_length_m);
      for (std::size_t i = 0; i < loop.rows.size(); ++i) {
        // An angle read from a volume is off by dx/(dx/da), at a dead centre by sqrt(2 dx/x''), x'' about r.
        const Pose<double> pose = exact_pose(crank, loop.angles_deg[i] * kRadPerDeg);
        const double least_slope = std::sqrt(x_rounding * crank.crank_radius_m) / 2;
        const double angle_deg = x_rounding / std::max(std::fabs(pose.slope_m), least_slope) / kRadPerDeg;
        EXPECT_NEAR(diagram.full_Pa(loop.angles_deg[i]), loop.rows[i].pressure_Pa,
                    2 * kSteepest_Pa_deg * (angle_deg + kAngleRounding_deg))
            << loop.angles_deg[i];
      }
      // Between the points: as an angle table, with the wider gap across a dead centre that was not given.
      const double h = with_dead_centres ? step_deg : 1.5 * step_deg;
      for (double deg = 0; deg < 720; deg += 0.0937) {
        EXPECT_NEAR(diagram.full_Pa(deg), smooth_pressure_Pa(deg), h * h / 4 * kMaxBent_Pa_deg2 * 1.1) << deg;
      }
    }
  }
}

TEST(VolumeTable, EnclosesTheAreaOfItsPolygon) {
  const Crank crank = crank_with_offset(0.1);
  const VolumeLoop loop = volume_loop(crank, smooth_pressure_Pa, 0.5, true);
  const IndicatorDiagram diagram = diagram_of_rows(loop.rows, PressureSource::volume_table, crank);
  Wide polygon = 0;
  for (std::size_t i = 0; i < loop.rows.size(); ++i) {
    const DiagramPoint& here = loop.rows[i];
    const DiagramPoint& next = loop.rows[(i + 1) % loop.rows.size()];
    polygon += wide((here.pressure_Pa + next.pressure_Pa) / 2) * wide(next.at - here.at);
  }
  Wide loop_integral = 0;
  constexpr int kSteps = 72'000;
  for (int i = 0; i < kSteps; ++i) {
    const double a = 720.0 * i / kSteps;
    const double b = 720.0 * (i + 1) / kSteps;
    loop_integral +=
        wide(diagram.full_Pa((a + b) / 2)) * wide(support::volume_m3(crank, b) - support::volume_m3(crank, a));
  }
  // The polygon's own error: h^2/6 integral of p' V'', h = 0.5 deg, both humps rising and falling: 4 * 60 bar * V_d/2
  // at most.
  const double h = 0.5 * kRadPerDeg;
  EXPECT_NEAR(static_cast<double>(loop_integral), static_cast<double>(polygon),
              h * h / 6 * 4 * 60e5 * support::swept_m3(crank) / 2);
}

TEST(VolumeTable, MayHaveAClosingRow) {
  const Crank crank = support::diesel_495_crank();
  VolumeLoop loop = volume_loop(crank, smooth_pressure_Pa, 2, true);
  const IndicatorDiagram open = diagram_of_rows(loop.rows, PressureSource::volume_table, crank);
  Rows closed_rows = loop.rows;
  closed_rows.push_back(loop.rows.front());
  const IndicatorDiagram closed = diagram_of_rows(closed_rows, PressureSource::volume_table, crank);
  for (double deg = 0; deg < 720; deg += 3.7) EXPECT_EQ(closed.full_Pa(deg), open.full_Pa(deg)) << deg;
}

TEST(VolumeTable, StaysBetweenNeighbouringPoints) {
  Random random;
  const Crank crank = crank_with_offset(0.15);
  VolumeLoop loop = volume_loop(
      crank, [&](double) { return random.between(0, 50e5); }, 4, true);
  const IndicatorDiagram diagram = diagram_of_rows(loop.rows, PressureSource::volume_table, crank);
  for (std::size_t i = 0; i + 1 < loop.rows.size(); ++i) {
    const double low = std::min(loop.rows[i].pressure_Pa, loop.rows[i + 1].pressure_Pa);
    const double high = std::max(loop.rows[i].pressure_Pa, loop.rows[i + 1].pressure_Pa);
    // At 1 % from a dead centre the angle's own uncertainty (2e-8 rad) is 1e-6 of the interval.
    for (int step = 1; step < 100; ++step) {
      const double p = diagram.full_Pa(loop.angles_deg[i] + (loop.angles_deg[i + 1] - loop.angles_deg[i]) * step / 100);
      EXPECT_GE(p, low - 1e-5 * 50e5) << random.trace(0) << ", row " << i;
      EXPECT_LE(p, high + 1e-5 * 50e5) << random.trace(0) << ", row " << i;
    }
  }
}

TEST(VolumeTable, RefusesVolumesThatTheCylinderDoesNotHave) {
  const Crank crank = support::diesel_495_crank();
  for (const std::size_t row : {std::size_t{0}, std::size_t{40}, std::size_t{200}}) {
    for (const double bad : {0.0, 1.0}) {  // no cylinder is empty, none holds a cubic metre
      VolumeLoop loop = volume_loop(crank, smooth_pressure_Pa, 2, true);
      loop.rows[row].at = bad;
      IndicatorDiagram diagram;
      EXPECT_TRUE(refuses(diagram.init(crank, support::table_pressure(PressureSource::volume_table, loop.rows)),
                          Reason::out_of_range, "pressure.points", static_cast<int>(row)));
    }
  }
}

TEST(VolumeTable, RefusesLoopsThatAreNoFourStrokes) {
  const Crank crank = support::diesel_495_crank();
  const VolumeLoop loop = volume_loop(crank, smooth_pressure_Pa, 2, true);  // 90 rows in every stroke
  const auto answer = [&](const Rows& rows) {
    IndicatorDiagram diagram;
    return diagram.init(crank, support::table_pressure(PressureSource::volume_table, rows));
  };
  ASSERT_EQ(loop.rows.size(), 360u);
  const auto part = [&](int from, int to) { return Rows(loop.rows.begin() + from, loop.rows.begin() + to); };
  EXPECT_EQ(answer(part(0, 180)).reason, Reason::not_a_cycle) << "a two-stroke loop";
  EXPECT_EQ(answer(part(0, 270)).reason, Reason::not_a_cycle) << "three strokes";
  EXPECT_EQ(answer(part(90, 360)).reason, Reason::not_a_cycle) << "begins at bottom dead centre";

  Rows rotated = part(45, 360);
  const Rows head = part(0, 45);
  rotated.insert(rotated.end(), head.begin(), head.end());
  EXPECT_EQ(answer(rotated).reason, Reason::not_a_cycle) << "begins in mid-stroke";

  Rows shaking = loop.rows;
  std::swap(shaking[30], shaking[31]);
  EXPECT_TRUE(refuses(answer(shaking), Reason::not_a_cycle, "pressure.points", 31)) << "turns back in mid-stroke";

  Rows standing = loop.rows;
  standing[30].at = standing[29].at;
  EXPECT_TRUE(refuses(answer(standing), Reason::not_a_cycle, "pressure.points", 30)) << "stands still";

  Rows short_stroke = part(0, 60);  // turns at 120 deg, then from there back up
  for (int i = 120; i < 360; ++i) short_stroke.push_back(loop.rows[static_cast<std::size_t>(i)]);
  EXPECT_EQ(answer(short_stroke).reason, Reason::not_a_cycle) << "turns before bottom dead centre";

  Rows short_compression = part(0, 150);  // turns at 300 deg, then from there back down
  for (int i = 210; i < 360; ++i) short_compression.push_back(loop.rows[static_cast<std::size_t>(i)]);
  EXPECT_EQ(answer(short_compression).reason, Reason::not_a_cycle) << "turns before top dead centre";

  // Rows just beyond a dead centre stand at its angle: two of them are no rows that rise.
  Rows beyond_bottom = loop.rows;
  const double swept_m3 = loop.rows[90].at - loop.rows[0].at;
  beyond_bottom[89].at = loop.rows[90].at + 0.002 * swept_m3;
  beyond_bottom[90].at = loop.rows[90].at + 0.004 * swept_m3;
  EXPECT_EQ(answer(beyond_bottom).reason, Reason::not_a_cycle) << "two rows beyond bottom dead centre";
  Rows beyond_ends = loop.rows;
  beyond_ends[0].at -= 0.004 * swept_m3;
  beyond_ends[359].at = beyond_ends[0].at + 0.002 * swept_m3;
  EXPECT_EQ(answer(beyond_ends).reason, Reason::not_a_cycle) << "first and last row beyond top dead centre";
}

TEST(VolumeTable, MayTurnTwoHundredthsOfTheSweptVolumeFromADeadCentreAndNoMore) {
  // A measured loop whose volumes are a little off: a row at a dead centre stands 1.9 or 2.1 % of the swept volume from
  // it. Inside the stroke its neighbours, which would be beyond it, are left out; outside no second row is.
  const Crank crank = support::diesel_495_crank();
  const VolumeLoop loop = volume_loop(crank, smooth_pressure_Pa, 2, true);
  const double top_m3 = loop.rows[0].at;
  const double swept_m3 = loop.rows[90].at - top_m3;
  const auto answer_with = [&](std::size_t turn, double into_stroke) {
    const double sign = turn % 180 == 90 ? -1 : 1;
    const double at_m3 = loop.rows[turn].at + sign * into_stroke * swept_m3;
    Rows rows;
    for (std::size_t i = 0; i < loop.rows.size(); ++i) {
      if (i == turn) {
        rows.push_back({at_m3, loop.rows[i].pressure_Pa});
      } else if (sign * (loop.rows[i].at - at_m3) > 0 ||
                 std::min((i + 360 - turn) % 360, (turn + 360 - i) % 360) > 90) {
        rows.push_back(loop.rows[i]);
      }
    }
    IndicatorDiagram diagram;
    return diagram.init(crank, support::table_pressure(PressureSource::volume_table, rows)).reason;
  };
  for (const std::size_t turn : {std::size_t{0}, std::size_t{90}, std::size_t{180}, std::size_t{270}}) {
    SCOPED_TRACE("turns at row " + std::to_string(turn));
    EXPECT_EQ(answer_with(turn, 0.019), Reason::ok);
    EXPECT_EQ(answer_with(turn, 0.021), Reason::not_a_cycle);
    EXPECT_EQ(answer_with(turn, -0.019), Reason::ok);
    EXPECT_EQ(answer_with(turn, -0.021), Reason::out_of_range);
  }
}

TEST(VolumeTable, IsMotoredPlusHeat) {
  const Crank crank = crank_with_offset(0.1);
  const VolumeLoop loop = volume_loop(crank, smooth_pressure_Pa, 2, true);
  const IndicatorDiagram diagram = diagram_of_rows(loop.rows, PressureSource::volume_table, crank);
  double most_heat_Pa = 0;
  for (double deg = 0; deg < 720; deg += 1.3) {
    const double p = diagram.full_Pa(deg);
    EXPECT_NEAR(diagram.motored_Pa(deg) + diagram.heat_Pa(deg), p, 2 * kEps * p) << deg;
    most_heat_Pa = std::max(most_heat_Pa, diagram.heat_Pa(deg));
  }
  EXPECT_GT(most_heat_Pa, 1e5) << "or nothing was split";
}

}  // namespace
}  // namespace crankloop::indicator_table_test
