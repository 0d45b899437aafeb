// Trigger edges of an engine that turns itself, from start to standstill: each at the exact motion's crossing, none
// lost, none twice.
//
// The exact motion is that of the same engine in ticks of 1 us, 20 to 100 times shorter. What a tick's edges are, given
// its motion, is tested in trigger_edges_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <crankloop/scenes.hpp>

#include "support/running.hpp"
#include "support/trigger_wheels.hpp"
#include "support/work_oracle.hpp"

namespace crankloop::free_running_edges_test {
namespace {

using namespace tick_test;
using Free = Turned<double, scenes::FreeRunning>;

/// A run of the 495.
struct Course {
  const char* name;
  double seconds;
  double from_rad_s;
  Free::Input input;
  bool friction;
  double brake_Nm;
  bool one_cylinder = false;  ///< from 200 deg on; else four from 0
};

Free::Input input(double load_ratio, bool starter) {
  Free::Input in;
  in.load_ratio = load_ratio;
  in.starter = starter ? 1 : 0;
  return in;
}

/// 60-2 on the crankshaft, half a moon on a camshaft.
EngineDefinition engine_of(const Course& course) {
  const std::vector<DrawnWheel> wheels = drawn_wheels();
  EngineDefinition engine =
      with_wheels(course.one_cylinder ? single_495() : diesel_495(), {wheels.at(0), wheels.at(5)});
  engine.masses.crank_inertia_kg_m2 = 0.5;
  if (course.friction) engine.friction = {90e3, 248, 0.46};
  engine.machine.constant_Nm = course.brake_Nm;
  engine.starter = {420, 40};
  return engine;
}

struct Edge {
  double time_s;
  std::uint32_t level;
  double speed_rad_s;  ///< at the end of its tick
};
struct Signal {
  std::vector<Edge> edges;
  std::uint32_t level = 0;  ///< at the end
};
struct Motion {
  Signal wheel[2];
  double turned_rev = 0;
  int reversals = 0;
  double end_rad_s = 0;
};

Motion motion_of(const Course& course, double tick_s) {
  Free engine(engine_of(course), tick_s, course.from_rad_s, course.one_cylinder ? phase_at_deg(200) : Phase{});
  Motion motion;
  std::uint32_t faults = 0;
  double last_rad_s = course.from_rad_s;
  const auto ticks = static_cast<long>(course.seconds / tick_s + 0.5);
  for (long i = 0; i < ticks; ++i) {
    const auto& out = engine.step(course.input);
    faults |= out.faults;
    for (std::size_t w = 0; w < 2; ++w) {
      const auto& signal = out.trigger[w];
      for (std::uint32_t e = 0; e < signal.edge_count; ++e) {
        motion.wheel[w].edges.push_back(
            {static_cast<double>(i) * tick_s + signal.edge[e].time_s, signal.edge[e].level, out.speed_rad_s});
      }
      motion.wheel[w].level = signal.level;
    }
    if (out.speed_rad_s * last_rad_s < 0) ++motion.reversals;
    if (out.speed_rad_s != 0) last_rad_s = out.speed_rad_s;
  }
  EXPECT_EQ(faults, 0u) << course.name;
  motion.turned_rev = static_cast<double>(engine.angle_rad) / (2 * kPi);
  motion.end_rad_s = engine.engine.output().speed_rad_s;
  return motion;
}

/// Largest distance in turns of the crank between the edges of both, which must be the same ones.
double apart_rev(const Course& course, const Motion& found, const Motion& exact) {
  double largest = 0;
  for (std::size_t w = 0; w < 2; ++w) {
    const std::vector<Edge>& here = found.wheel[w].edges;
    const std::vector<Edge>& there = exact.wheel[w].edges;
    EXPECT_EQ(here.size(), there.size()) << course.name;
    EXPECT_EQ(found.wheel[w].level, exact.wheel[w].level) << course.name;
    for (std::size_t i = 0; i < std::min(here.size(), there.size()); ++i) {
      EXPECT_EQ(here[i].level, there[i].level) << course.name << ", edge " << i;
      if (i > 0) {
        EXPECT_NE(here[i].level, here[i - 1].level) << course.name << ", edge " << i;
        EXPECT_GE(here[i].time_s, here[i - 1].time_s) << course.name << ", edge " << i;
      }
      largest =
          std::max(largest, std::fabs(here[i].time_s - there[i].time_s) * std::fabs(there[i].speed_rad_s) / (2 * kPi));
    }
  }
  return largest;
}

/// Edges of a 60-2 wheel, whose first tooth is at 246 deg, in a number of turns from 0 deg on.
long teeth_edges_in(double turns) {
  long count = 0;
  const double end_deg = turns * 360;
  for (double turn_deg = 246 - 360; turn_deg < end_deg; turn_deg += 360) {
    for (int tooth = 0; tooth < 58; ++tooth) {
      for (const double edge_deg : {turn_deg + 6 * tooth, turn_deg + 6 * tooth + 3})
        count += edge_deg > 0 && edge_deg <= end_deg ? 1 : 0;
    }
  }
  return count;
}

constexpr double kWithin_rev = 1e-6;
constexpr double kExactTick_s = 1e-6;  ///< the shortest there is

TEST(FreeRunningEdges, OfAStartIdlingAndABrakedStopAreThoseOfTheExactMotion) {
  for (const auto& [course, tick_s] : {std::pair<Course, double>{{"start", 0.5, 0, input(0.5, true), true, 0}, 100e-6},
                                       {{"idle", 0.5, 84, input(0.3, false), true, 0}, 100e-6},
                                       {{"2000 rpm", 0.3, 210, input(0.6, false), true, 60}, 100e-6},
                                       {{"stop", 0.3, 84, input(0, false), true, 900}, 100e-6}}) {
    const Motion found = motion_of(course, tick_s);
    const double apart = apart_rev(course, found, motion_of(course, kExactTick_s));
    std::printf("%s: %zu edges in %.2f turns, tick %.0f us: within %.1e turns\n", course.name,
                found.wheel[0].edges.size(), found.turned_rev, tick_s * 1e6, apart);
    EXPECT_LT(apart, kWithin_rev) << course.name;
    EXPECT_EQ(found.reversals, 0) << course.name;
    EXPECT_EQ(static_cast<long>(found.wheel[0].edges.size()), teeth_edges_in(found.turned_rev)) << course.name;
    EXPECT_GT(found.wheel[0].edges.size(), 40u) << course.name;
    if (course.brake_Nm > 500) {
      EXPECT_EQ(found.end_rad_s, 0) << course.name;
    }
  }
}

TEST(FreeRunningEdges, AreLostByNoReversalAgainstCompression) {
  const Course frictionless{"thrown back and forth",
                            4,
                            15,
                            input(0.1, false),
                            false,
                            0,
                            true};  // with a little heat no friction comes from the gas
  const Motion found = motion_of(frictionless, 100e-6);
  const double apart = apart_rev(frictionless, found, motion_of(frictionless, kExactTick_s));
  std::printf("%s: %d reversals, %zu edges: within %.1e turns\n", frictionless.name, found.reversals,
              found.wheel[0].edges.size(), apart);
  EXPECT_GT(found.reversals, 4);
  EXPECT_LT(apart, kWithin_rev);
}

TEST(FreeRunningEdges, OfAStallAreThoseOfTheExactMotionThoughFrictionTurnsRoundAtEachReversal) {
  const Course stall{"stall", 4, 20, input(0, false), true, 0};
  const Motion exact = motion_of(stall, kExactTick_s);
  // Ticks that differ by little meet the reversals at other instants: at some of them a half of the friction stops the
  // crank.
  for (const double tick_s : {200e-6, 150e-6, 120e-6, 100e-6, 90e-6, 80e-6, 60e-6, 50e-6, 40e-6, 20e-6}) {
    const Motion found = motion_of(stall, tick_s);
    const double apart = apart_rev(stall, found, exact);
    std::printf("%s: %d reversals, %zu edges, tick %.0f us: within %.1e turns\n", stall.name, found.reversals,
                found.wheel[0].edges.size(), tick_s * 1e6, apart);
    EXPECT_GT(found.reversals, 2);
    EXPECT_LT(apart, kWithin_rev);
    EXPECT_EQ(found.end_rad_s, 0);
  }
}

}  // namespace
}  // namespace crankloop::free_running_edges_test
