// Indicator diagrams under test, and what they are held against: bounds of the smooth pressure, the same height on the
// other stroke.
//
// What belongs here: what the tests of tables and of synthesised diagrams share. What does not: pressures made of
// formulas (diagrams.hpp).
#pragma once

#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/mechanism.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/diagrams.hpp"
#include "support/engines.hpp"
#include "support/status.hpp"
#include "support/vector_geometry.hpp"

namespace crankloop::support {

inline IndicatorDiagram diagram_of(const Crank& crank, const Pressure& pressure) {
  IndicatorDiagram diagram;
  EXPECT_TRUE(accepted(diagram.init(crank, pressure)));
  return diagram;
}

using Rows = std::vector<DiagramPoint>;

/// The rows must outlive the diagram: not for temporaries.
inline IndicatorDiagram diagram_of_rows(const Rows& rows, PressureSource source,
                                        const Crank& crank = diesel_495_crank()) {
  return diagram_of(crank, table_pressure(source, rows));
}
inline IndicatorDiagram diagram_of_rows(Rows&&, PressureSource, const Crank& = diesel_495_crank()) = delete;

inline Crank crank_with_offset(double offset_ratio) {
  Crank crank = diesel_495_crank();
  crank.pin_offset_m = offset_ratio * crank.crank_radius_m;
  return crank;
}

/// Largest jump between neighbours of a fine sweep, less what the steepest slope explains; and where.
inline void expect_no_step(const IndicatorDiagram& diagram, double steepest_Pa_deg, const std::string& what) {
  constexpr double kStep_deg = 0.01;
  for (const auto curve : {&IndicatorDiagram::full_Pa, &IndicatorDiagram::motored_Pa, &IndicatorDiagram::heat_Pa}) {
    double before = (diagram.*curve)(-0.5);
    for (int i = 1; i <= 72'100; ++i) {
      const double deg = -0.5 + kStep_deg * i;
      const double p = (diagram.*curve)(deg);
      EXPECT_NEAR(p, before, steepest_Pa_deg * kStep_deg) << "at " << deg << ", " << what;
      if (testing::Test::HasFailure()) return;
      before = p;
    }
  }
}

/// The crank angle on the way up (360 to 720 deg) at which the piston is as high as at `deg` on the way down: bisection
/// on the geometry.
inline double same_height_going_up(const Crank& crank, double deg, double bottom_deg, double top_deg) {
  const Wide want = piston_height(crank, wide(deg) * kWidePi / 180);
  double low = bottom_deg + 360;
  double high = top_deg + 720;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (piston_height(crank, wide(middle) * kWidePi / 180) < want ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Steepest slope and curvature of smooth_pressure_Pa per degree: 60e5 exp(30 (cos u - 1)), u = deg/2, rises by at most
/// 60e5 sqrt(30/e) per rad of u and bends by at most 60e5 * 30 per rad^2.
inline const double kSteepest_Pa_deg = 60e5 * std::sqrt(30 / std::exp(1.0)) * kRadPerDeg / 2;
inline constexpr double kMaxBent_Pa_deg2 = 60e5 * 30 * (kRadPerDeg / 2) * (kRadPerDeg / 2);

/// The p-V loop of p(a), in the order of time from firing top dead centre; rows[i] belongs to angles[i]. Without a row
/// at a dead centre the row before it must be the nearer one: where the volume turns round is all that the file tells.
struct VolumeLoop {
  std::vector<double> angles_deg;
  Rows rows;
};
template <class Function>
VolumeLoop volume_loop(const Crank& crank, const Function& f, double step_deg, bool with_dead_centres) {
  VolumeLoop loop;
  const double top = dead_centres(crank).tdc_rad / kRadPerDeg;
  const double bottom = dead_centres(crank).bdc_rad / kRadPerDeg;
  const double turns[] = {top, bottom, top + 360, bottom + 360, top + 720};
  const auto add = [&](double deg) {
    loop.angles_deg.push_back(deg);
    loop.rows.push_back({volume_m3(crank, deg), f(deg)});
  };
  for (int stroke = 0; stroke < 4; ++stroke) {
    if (with_dead_centres) add(turns[stroke]);
    for (double deg = turns[stroke] + step_deg; deg < turns[stroke + 1] - step_deg / 2; deg += step_deg) add(deg);
    if (!with_dead_centres) add(turns[stroke + 1] - step_deg / 4);
  }
  return loop;
}

}  // namespace crankloop::support
