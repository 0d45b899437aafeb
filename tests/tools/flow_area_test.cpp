// Flow area of a valve: against the frustum between seat and head found by search, the gas's own tables, and integrals
// in closed form; and the keys of the engine file that it takes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <crankloop/scenes.hpp>
#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/gas/gas_places.hpp>

#include "crankloop/loops/flow_area.hpp"
#include "support/engine_files.hpp"
#include "support/engines.hpp"
#include "support/random.hpp"
#include "support/status.hpp"
#include "support/units.hpp"
#include "support/valve_trains.hpp"

namespace crankloop::program::flow_area_test {
namespace {

using support::kPi;
using support::kRadPerDeg;

/// A valve of 33 mm, seat 1.5 mm at 45 deg, in a port of 29 mm with a stem of 6 mm.
PortGeometry valve_33() {
  PortGeometry g;
  g.head_m = 33e-3, g.seat_m = 30e-3, g.seat_width_m = 1.5e-3, g.seat_angle_deg = 45;
  g.port_m = 29e-3, g.stem_m = 6e-3;
  return g;
}

PortGeometry any_valve(support::Random& random) {
  PortGeometry g;
  g.seat_m = random.between(0.01, 0.1);
  g.seat_width_m = g.seat_m * random.between(0.02, 0.08);
  g.head_m = g.seat_m + 2 * g.seat_width_m;
  g.seat_angle_deg = random.between(20, 60);
  g.port_m = g.seat_m * random.between(0.8, 1.2);
  g.stem_m = g.seat_m * random.between(0, 0.3);
  return g;
}

double port_area_m2(const PortGeometry& g) { return kPi / 4 * (g.port_m * g.port_m - g.stem_m * g.stem_m); }

struct Point {
  double r_m;
  double z_m;
};

/// On the cone of the seat, or of the head that has moved away by the lift: share 0 at the inner edge, 1 at the outer.
Point on_cone(const PortGeometry& g, double lift_m, double share) {
  return {g.seat_m / 2 + share * g.seat_width_m,
          -lift_m - share * g.seat_width_m * std::tan(g.seat_angle_deg * kRadPerDeg)};
}

double frustum_m2(const Point& a, const Point& b) {
  return kPi * (a.r_m + b.r_m) * std::hypot(a.r_m - b.r_m, a.z_m - b.z_m);
}

/// The smallest of a function of a share, by ever finer steps.
template <class Of>
double smallest(const Of& of, double* at = nullptr) {
  double from = 0, to = 1, best = 0;
  for (int round = 0; round < 8; ++round) {
    const double step = (to - from) / 20;
    for (int i = 0; i <= 20; ++i) {
      if (of(from + i * step) < of(best)) best = from + i * step;
    }
    from = std::max(0.0, best - step), to = std::min(1.0, best + step);
  }
  if (at != nullptr) *at = best;
  return of(best);
}

/// The frustum by the shortest way from the head's inner edge to the seat.
double by_shortest_way_m2(const PortGeometry& g, double lift_m) {
  const Point edge = on_cone(g, lift_m, 0);
  double share = 0;
  smallest(
      [&](double s) {
        const Point seat = on_cone(g, 0, s);
        return std::hypot(edge.r_m - seat.r_m, edge.z_m - seat.z_m);
      },
      &share);
  return frustum_m2(edge, on_cone(g, 0, share));
}

/// The least frustum of all whose generator goes from head to seat.
double least_frustum_m2(const PortGeometry& g, double lift_m) {
  return smallest([&](double on_head) {
    return smallest([&](double on_seat) { return frustum_m2(on_cone(g, lift_m, on_head), on_cone(g, 0, on_seat)); });
  });
}

TEST(FlowArea, IsThatOfTheWorkedValve) {
  const FlowArea area(valve_33(), {});
  EXPECT_NEAR(area.end_of_low_lift_m() * 1e3, 3, 1e-12);
  EXPECT_NEAR(area.geometric_m2(1e-3) * 1e6, 67.754, 0.0005);
  EXPECT_NEAR(area.geometric_m2(2e-3) * 1e6, 137.729, 0.0005);
  EXPECT_NEAR(area.geometric_m2(5e-3) * 1e6, 376.829, 0.0005);
  EXPECT_NEAR(area.geometric_m2(9.5e-3) * 1e6, 632.246, 0.0005);
  EXPECT_LT(area.geometric_m2(7.7102e-3), port_area_m2(valve_33()));
  EXPECT_EQ(area.geometric_m2(7.7104e-3), area.geometric_m2(1));
  EXPECT_EQ(area.geometric_m2(0), 0);
  EXPECT_EQ(area.geometric_m2(-1e-4), 0);
}

TEST(FlowArea, IsTheFrustumByTheShortestWayFromTheHeadsInnerEdgeToTheSeat) {
  support::Random random(20);
  for (int i = 0; i < 40; ++i) {
    const PortGeometry g = any_valve(random);
    const FlowArea area(g, {});
    for (const double of_seat : {0.01, 0.05, 0.1, 0.15, 0.2, 0.3}) {
      const double lift_m = of_seat * g.seat_m;
      const double expected = std::min(by_shortest_way_m2(g, lift_m), port_area_m2(g));
      EXPECT_NEAR(area.geometric_m2(lift_m), expected, 1e-7 * expected) << i << ", lift " << of_seat << " D";
    }
  }
}

/// The shortest way is not quite the least area: a way that leans inward is longer, but on a smaller radius. To second
/// order the difference is (L cos^2 b / D)^2 / 2, and less beyond L1.
TEST(FlowArea, IsHardlyAboveTheLeastFrustumOfAll) {
  support::Random random(21);
  for (int i = 0; i < 10; ++i) {
    PortGeometry g = any_valve(random);
    g.port_m = 10 * g.seat_m;  // bounds nothing
    const FlowArea area(g, {});
    const double cos = std::cos(g.seat_angle_deg * kRadPerDeg);
    for (const double of_seat : {0.01, 0.05, 0.1, 0.2, 0.3}) {
      const double lift_m = of_seat * g.seat_m;
      const double lean = std::min(lift_m, area.end_of_low_lift_m()) * cos * cos / g.seat_m;
      const double excess = area.geometric_m2(lift_m) / least_frustum_m2(g, lift_m) - 1;
      EXPECT_GT(excess, -1e-9) << i << ", lift " << of_seat << " D";
      EXPECT_LT(excess, lean * lean / 2 + 1e-9) << i << ", lift " << of_seat << " D";
    }
  }
  PortGeometry wide = valve_33();
  wide.port_m = 1;
  EXPECT_NEAR(FlowArea(wide, {}).geometric_m2(3e-3) / least_frustum_m2(wide, 3e-3) - 1, 0.00125, 0.00015);
}

TEST(FlowArea, IsContinuousAndNeverFalls) {
  support::Random random(22);
  for (int i = 0; i < 200; ++i) {
    const PortGeometry g = any_valve(random);
    const FlowArea area(g, {});
    const double low_m = area.end_of_low_lift_m();
    const double hair = 1e-12;
    EXPECT_NEAR(area.geometric_m2(low_m * (1 + hair)), area.geometric_m2(low_m * (1 - hair)), 1e-11 * port_area_m2(g));
    double last = 0;
    for (int step = 1; step <= 400; ++step) {
      const double here = area.geometric_m2(step * g.seat_m / 1000);
      EXPECT_GE(here, last);
      EXPECT_LE(here - last, kPi * g.head_m * g.seat_m / 1000) << "faster than the curtain";
      last = here;
    }
  }
}

TEST(FlowArea, EffectiveIsThatOfTheGas) {
  const EngineFile file = read_engine_file(CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini", {});
  const auto tables = std::make_unique<TableStorage<double, scenes::BreathingFree>>();
  ASSERT_TRUE(accepted(tables->build(file.definition(), {100e-6})));
  const TrainOfFile& train = file.train("intake");
  const FlowArea area(*train.geometry, train.port);
  for (int i = 1; i <= 200; ++i) {
    const double lift_m = i * 1e-4;
    const double of_gas = detail::port_area_m2(tables->tables().gas_ports[0], lift_m);
    EXPECT_NEAR(train.definition.valve.per_cylinder * area.effective_m2(lift_m), of_gas, 1e-12 * of_gas) << lift_m;
  }
  EXPECT_EQ(area.effective_m2(-1e-3), 0);
}

// ---- over the angle ----

/// y = y_max (1 + sum C_i u^p_i) has integrals in closed form, of y and of its square; below L1 the area is
/// pi cos b (D y + sin b cos b y^2).
TEST(FlowIntegrals, OfTheoryAreThoseOfThePolynomialCam) {
  const std::vector<double> p = {2, 10, 18};
  const Cam cam = support::polynomial_cam(2e-3, 60, {2, 10, 18});
  Rocker rocker;
  rocker.kind = RockerKind::ratio, rocker.base_circle_m = 18e-3;
  ValveLift lift;
  ASSERT_TRUE(accepted(lift.init(cam, rocker)));
  const std::vector<double> exponents = {0, 2, 10, 18};
  std::vector<double> terms = {1};
  for (std::size_t i = 0; i < p.size(); ++i) {
    double c = -1;
    for (std::size_t j = 0; j < p.size(); ++j) c *= i == j ? 1 : p[j] / (p[j] - p[i]);
    terms.push_back(c);
  }
  double of_lift = 0;
  double of_square = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    of_lift += terms[i] / (exponents[i] + 1);
    for (std::size_t j = 0; j < terms.size(); ++j) of_square += terms[i] * terms[j] / (exponents[i] + exponents[j] + 1);
  }
  const double open_deg = 2 * 2 * 60;  // of the crank
  const double mean_m2 = kPi * std::sqrt(0.5) * (30e-3 * 2e-3 * of_lift + 0.5 * 4e-6 * of_square);

  PortOfTrain port;  // 0.3 of pi/4 D^2 at a lift of 0.1 D, and in proportion below
  port.seat_diameter_m = 30e-3;
  port.flow_count = 2;
  port.flow_lift_ratio[1] = 0.1, port.flow_ratio[1] = 0.3;
  const FlowIntegrals flow = theoretical_flow(FlowArea(valve_33(), port), lift);
  EXPECT_NEAR(flow.open_deg, open_deg, 1e-9 * open_deg);
  EXPECT_NEAR(flow.geometric_m2_deg, mean_m2 * open_deg, 1e-7 * mean_m2 * open_deg);
  EXPECT_NEAR(flow.mean_geometric_m2(), mean_m2, 1e-7 * mean_m2);
  const double effective_m2 = kPi / 4 * 30e-3 * 30e-3 * 3 * (2e-3 * of_lift / 30e-3);
  EXPECT_NEAR(flow.mean_effective_m2(), effective_m2, 1e-7 * effective_m2);
}

TEST(FlowIntegrals, ALobeThatItsClearanceSwallowsOpensNothing) {
  const Cam cam = support::polynomial_cam(2e-3, 60, {2, 10, 18});
  Rocker rocker;
  rocker.kind = RockerKind::ratio, rocker.base_circle_m = 18e-3, rocker.clearance_m = 3e-3;
  ValveLift lift;
  ASSERT_TRUE(accepted(lift.init(cam, rocker)));
  const FlowIntegrals flow = theoretical_flow(FlowArea(valve_33(), {}), lift);
  EXPECT_EQ(flow.open_deg, 0);
  EXPECT_EQ(flow.geometric_m2_deg, 0);
  EXPECT_EQ(flow.mean_geometric_m2(), 0);
}

/// With 1 mm up and 3 mm down, closed below 0.2 mm: open from a fifth of the first step to 2.8/3 of the last. The
/// bounce behind it is no part of the opening, nor the one before.
TEST(FlowIntegrals, OfTicksAreThoseOfTheLargestOpeningWithPartsOfATickAtBothEnds) {
  const FlowArea area(valve_33(), {});
  FlowSum sum(area, 0.2e-3, 2);
  for (const double lift_mm : {0.0, 0.4, 0.0, 1.0, 2.0, 3.0, 0.0, 0.5, 0.0, 0.0}) sum.add(lift_mm * 1e-3);
  EXPECT_NEAR(sum.largest().open_deg, 2 * (0.8 + 1 + 1 + 2.8 / 3), 1e-12);
  const double areas = area.geometric_m2(1e-3) + area.geometric_m2(2e-3) + area.geometric_m2(3e-3);
  EXPECT_NEAR(sum.largest().geometric_m2_deg, 2 * areas, 1e-15);
  const double effective = area.effective_m2(1e-3) + area.effective_m2(2e-3) + area.effective_m2(3e-3);
  EXPECT_NEAR(sum.largest().effective_m2_deg, 2 * effective, 1e-15);
}

/// Taylor's form, with the mean coefficient of pi/4 D^2, and the others by hand for two valves in a cylinder.
TEST(FlowFigures, AreTheTextbooks) {
  EngineDefinition engine = support::four_2000();
  engine.gas.ambient_K = 300;
  FlowIntegrals flow;
  flow.open_deg = 250;
  flow.geometric_m2_deg = 250 * 400e-6;
  flow.effective_m2_deg = 250 * 250e-6;
  const double rad_s = 6000 * kPi / 30;
  PortArea area;
  area.add(flow, 2);
  const FlowFigures figures = flow_figures(area, engine, rad_s);
  const double piston_m_s = 2 * 0.086 * 6000 / 60;
  const double displacement_m3 = kPi / 4 * 0.086 * 0.086 * 0.086;
  EXPECT_NEAR(figures.area_per_displacement_per_m, 2 * 400e-6 / displacement_m3, 1e-9);
  EXPECT_NEAR(figures.gas_speed_m_s, kPi / 4 * 0.086 * 0.086 * piston_m_s / 800e-6, 1e-9);
  const double seat_m = 0.033;
  const double coefficient = 250e-6 / (kPi / 4 * seat_m * seat_m);
  const double sound_m_s = std::sqrt(1.4 * 287.1 * 300);
  EXPECT_NEAR(figures.mach_index, 0.086 * 0.086 / (2 * seat_m * seat_m) * piston_m_s / (coefficient * sound_m_s),
              1e-12);
  EXPECT_EQ(flow_figures(area, engine, -rad_s).gas_speed_m_s, figures.gas_speed_m_s);
}

// ---- keys ----

class PortKeys : public EngineFileTest {
 protected:
  /// The intake train of the breathing sample with these lines for its seat.
  std::string with(const std::string& lines) const {
    return replaced(
        replaced(contents(CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini"), "source = gas", "source = none"),
        "seat_diameter_mm = 33\n", lines);
  }
  PortGeometry geometry(const std::string& lines) const { return *read(with(lines)).train("intake").geometry; }
};

TEST_F(PortKeys, GiveTheGeometry) {
  const PortGeometry g = geometry(
      "head_diameter_mm = 33\nseat_width_mm = 1.5\nseat_angle_deg = 30\nport_diameter_mm = 29\nstem_diameter_mm = 6\n");
  EXPECT_EQ(g.head_m, 0.033);
  EXPECT_DOUBLE_EQ(g.seat_m, 0.030);
  EXPECT_EQ(g.seat_width_m, 0.0015);
  EXPECT_EQ(g.seat_angle_deg, 30);
  EXPECT_EQ(g.port_m, 0.029);
  EXPECT_EQ(g.stem_m, 0.006);
  EXPECT_EQ(g.assumed, "");
}

TEST_F(PortKeys, WhatIsNotGivenIsAssumedAndTold) {
  const PortGeometry g = geometry("seat_diameter_mm = 30\n");
  EXPECT_DOUBLE_EQ(g.seat_width_m, 0.0012);
  EXPECT_DOUBLE_EQ(g.head_m, 0.0324);
  EXPECT_EQ(g.assumed, "seat_width_mm = 1.2, seat_angle_deg = 45, port_diameter_mm = 30, stem_diameter_mm = 6");
  const PortGeometry by_head = geometry("head_diameter_mm = 32.4\nstem_diameter_mm = 7\nport_diameter_mm = 28\n");
  EXPECT_DOUBLE_EQ(by_head.seat_m, 0.030);
  EXPECT_EQ(by_head.assumed, "seat_width_mm = 1.2, seat_angle_deg = 45");
  const PortGeometry by_both = geometry("head_diameter_mm = 33\nseat_diameter_mm = 30\n");
  EXPECT_NEAR(by_both.seat_width_m, 0.0015, 1e-15);
  EXPECT_EQ(by_both.assumed, "seat_angle_deg = 45, port_diameter_mm = 30, stem_diameter_mm = 6");
  EXPECT_FALSE(read(with("")).train("intake").geometry);
}

TEST_F(PortKeys, AreRefusedWhereTheyContradictEachOther) {
  const struct {
    const char* lines;
    const char* says;
  } cases[] = {
      {"seat_width_mm = 1\n", "seat_width_mm: needs head_diameter_mm or seat_diameter_mm beside it"},
      {"stem_diameter_mm = 6\n", "stem_diameter_mm: needs head_diameter_mm or seat_diameter_mm beside it"},
      {"head_diameter_mm = 30\nseat_diameter_mm = 30\n",
       "head_diameter_mm: 30 must be more than seat_diameter_mm = 30, the seat's inner diameter"},
      {"head_diameter_mm = 30\nseat_width_mm = 15\n",
       "seat_width_mm: 15 must be less than half of head_diameter_mm = 30"},
      {"seat_diameter_mm = 30\nstem_diameter_mm = 30\n",
       "stem_diameter_mm: the stem of 30 mm must be thinner than the port of 30 mm"},
      {"seat_diameter_mm = 30\nport_diameter_mm = 5\n",
       "port_diameter_mm: the stem of 6 mm must be thinner than the port of 5 mm"},
      {"seat_diameter_mm = 30\nseat_angle_deg = 0\n", "seat_angle_deg: 0 is out of range; allowed: 1 to 89 deg"},
  };
  for (const auto& one : cases)
    EXPECT_NE(refusal(with(one.lines)).find(one.says), std::string::npos) << refusal(with(one.lines));
}

/// The flow area is for the designer: the engine that the tick computes is the same.
TEST_F(PortKeys, ChangeNothingOfTheDefinition) {
  const std::string text = contents(CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini");
  const EngineFile plain = read(text);
  const EngineFile given = read(replaced(text, "seat_diameter_mm = 33\n",
                                         "seat_diameter_mm = 33\nhead_diameter_mm = 36\nport_diameter_mm = 30\n"));
  ExpectSame{}({1, ""}, given.definition().gas, plain.definition().gas);
  ExpectSame{}({1, ""}, given.definition().trains[0], plain.definition().trains[0]);
}

}  // namespace
}  // namespace crankloop::program::flow_area_test
