// The loop of one valve train at constant speed, and the valves of a whole engine in its loop.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <crankloop/tabulate/indicator_diagram.hpp>

#include "crankloop/loops/run_loop.hpp"
#include "crankloop/loops/run_trace.hpp"
#include "support/both_reals.hpp"
#include "support/status.hpp"
#include "support/units.hpp"
#include "support/valve_runs.hpp"

namespace crankloop::program::valve_loop_test {
namespace {

constexpr const char* kDiesel = CRANKLOOP_SOURCE_DIR "/tools/engines/diesel_495.ini";
constexpr double kAccuracy_m = 0.1e-6;  // what the sub-steps are asked for by default
constexpr ValveMethod kExponential{{Integrator::exponential, kAccuracy_m}, false};
constexpr ValveMethod kTextbook{{}, true};

template <class Real>
class ValveLoopIn : public testing::Test {};
TYPED_TEST_SUITE(ValveLoopIn, tick_test::BothReals, tick_test::RealName);

TYPED_TEST(ValveLoopIn, At7000RpmThe125LiftsItsValveAsPublished) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  EXPECT_NEAR(valve.lift().largest_lift_m(), 7.815e-3, 0.0005e-3);
  for (const ValveMethod& method : {kRk4, kExponential, kTextbook}) {
    const ValveCycle<TypeParam> cycle = run<TypeParam>(valve, 7000, method).results;
    EXPECT_NEAR(static_cast<double>(cycle.largest_lift_m), 7.785e-3, 0.001e-3);
    EXPECT_NEAR(static_cast<double>(cycle.seating_speed_m_s), 0.65, 0.01);
    EXPECT_NEAR(static_cast<double>(cycle.bounce_height_m), 0.018e-3, 0.0005e-3);
    EXPECT_EQ(cycle.separations, 0u);
    EXPECT_EQ(cycle.bounces, 3u);
    EXPECT_EQ(cycle.off_seat_at_end, 0u);
  }
}

TYPED_TEST(ValveLoopIn, ForcesOfEveryTickAddUpToMassTimesAcceleration) {
  using Real = TypeParam;
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  const Valve& v = valve.valve();
  const double lever_m = valve.lift().lever_m();
  const double mass_kg = v.valve_kg + v.spring_kg / 3 + v.rocker_inertia_kg_m2 / (lever_m * lever_m);
  const double guide_Ns_m = 2 * v.guide_damping_ratio * std::sqrt(v.train_N_m * mass_kg);
  const double eps = static_cast<double>(std::numeric_limits<Real>::epsilon());
  for (const ValveMethod& method : {kRk4, kTextbook}) {
    for (const auto& out : run<Real>(valve, 9000, method).ticks) {
      const auto lift_m = static_cast<double>(out.motion.lift_m);
      const double forces_N = static_cast<double>(out.forces.train_N) + static_cast<double>(out.forces.seat_N) -
                              v.spring_N_m * lift_m - v.spring_preload_N -
                              guide_Ns_m * static_cast<double>(out.motion.velocity_m_s);
      const double scale_N = 1e4;  // no force here is larger
      EXPECT_NEAR(mass_kg * static_cast<double>(out.motion.acceleration_m_s2), forces_N, 8 * eps * scale_N)
          << out.cam_deg;
      const bool train_on = (out.forces.regime & kTrainOn) != 0;
      EXPECT_EQ(train_on, out.forces.train_N > 0) << out.cam_deg;
      EXPECT_EQ((out.forces.regime & kSeatOn) != 0, out.forces.seat_N > 0) << out.cam_deg;
      const double ratio = valve.lift().at(out.cam_deg * support::kPi / 180).rocker_ratio;
      EXPECT_NEAR(static_cast<double>(out.forces.cam_N), ratio * static_cast<double>(out.forces.train_N),
                  1e-6 * scale_N)
          << out.cam_deg;
    }
  }
}

TYPED_TEST(ValveLoopIn, TheLastCycleGoesOnceRoundWithFullLiftInItsMiddle) {
  using Real = TypeParam;
  const EngineFile file = read_engine_file(kDiesel, {});
  const LoneValve valve(file, "exhaust");
  for (const double rpm : {2000.0, -2000.0, 1777.0, 6000.0}) {
    SCOPED_TRACE(rpm);
    const double sense = rpm < 0 ? -1 : 1;
    const LastCycle<Real> last = run<Real>(valve, rpm, kRk4, 50e-6);
    const double deg_per_tick = std::abs(rpm) * 3 * 50e-6;
    EXPECT_EQ(last.ticks.front().cam_deg, -180 * sense);
    EXPECT_LE(last.ticks.back().cam_deg * sense, 180 + 1e-3);
    EXPECT_GT(last.ticks.back().cam_deg * sense, 180 - deg_per_tick - 1e-3);
    for (const auto& out : last.ticks) {
      const double theory_m = std::max(0.0, valve.lift().at(out.cam_deg * support::kPi / 180).lift_m);
      EXPECT_NEAR(static_cast<double>(out.motion.theoretical_lift_m), theory_m, 0.02e-6) << out.cam_deg;
    }
  }
}

TYPED_TEST(ValveLoopIn, BackwardsASymmetricTrainDoesTheSameMirrored) {
  using Real = TypeParam;
  const EngineFile file = read_engine_file(kDiesel, {});
  const LoneValve valve(file, "intake");
  const LastCycle<Real> forwards = run<Real>(valve, 2400);
  const LastCycle<Real> backwards = run<Real>(valve, -2400);
  ASSERT_EQ(forwards.ticks.size(), backwards.ticks.size());
  for (std::size_t i = 0; i < forwards.ticks.size(); ++i) {
    EXPECT_NEAR(forwards.ticks[i].cam_deg, -backwards.ticks[i].cam_deg, 1e-9);
    EXPECT_NEAR(static_cast<double>(forwards.ticks[i].motion.lift_m),
                static_cast<double>(backwards.ticks[i].motion.lift_m), 2 * kAccuracy_m);
  }
  EXPECT_EQ(forwards.results.bounces, backwards.results.bounces);
  EXPECT_NEAR(static_cast<double>(forwards.results.opening_delay_deg),
              static_cast<double>(backwards.results.opening_delay_deg), 1e-3);
}

TYPED_TEST(ValveLoopIn, WhatAValveDoesDoesNotDependOnTheTick) {
  using Real = TypeParam;
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  const ValveCycle<Real> fine = run<Real>(valve, 7000, kExponential, 5e-6).results;
  for (const double tick_s : {20e-6, 100e-6, 500e-6, 2e-3}) {
    SCOPED_TRACE(tick_s);
    const ValveCycle<Real> cycle = run<Real>(valve, 7000, kRk4, tick_s).results;
    EXPECT_NEAR(static_cast<double>(cycle.largest_lift_m), static_cast<double>(fine.largest_lift_m), 2 * kAccuracy_m);
    EXPECT_NEAR(static_cast<double>(cycle.bounce_height_m), static_cast<double>(fine.bounce_height_m), 2 * kAccuracy_m);
    EXPECT_NEAR(static_cast<double>(cycle.seating_speed_m_s), static_cast<double>(fine.seating_speed_m_s), 1e-4);
    EXPECT_EQ(cycle.bounces, fine.bounces);
    // A touch of 1.4 us, 0.03 deg of the cam, may be seen or not: two changes.
    EXPECT_NEAR(cycle.contact_changes, fine.contact_changes, 2);
  }
}

TEST(Textbook, ComesToTheSameWithShortSteps) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  const ValveCycle<double> reference = run<double>(valve, 7000, kExponential, 1e-6).results;
  const auto textbook = [&](double tick_s) { return run<double>(valve, 7000, kTextbook, tick_s).results; };
  const auto off_m_s = [&](const ValveCycle<double>& cycle) {
    return std::abs(cycle.seating_speed_m_s - reference.seating_speed_m_s);
  };
  EXPECT_NEAR(textbook(1e-6).bounce_height_m, reference.bounce_height_m, 0.3e-6);
  EXPECT_NEAR(textbook(1e-6).largest_lift_m, reference.largest_lift_m,
              0.001e-6);  // between contact changes it is of fourth order
  // Contact changes it finds late, by up to a step in which the seat brakes already: the seating speed is off by up to
  // 10 %.
  EXPECT_GT(off_m_s(textbook(6e-6)), 5 * off_m_s(textbook(1e-6)));
  EXPECT_LT(off_m_s(textbook(6e-6)), 0.1 * reference.seating_speed_m_s);
}

TYPED_TEST(ValveLoopIn, CyclesAtModerateSpeedAgreeAndTellsWhenTheyDoNot) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  EXPECT_LT(largest_change_of_lift_m<TypeParam>(valve, 7000, kTick_s, kRk4, 4), 0.01e-6);
  EXPECT_GT(largest_change_of_lift_m<TypeParam>(valve, 20000, kTick_s, kRk4, 4),
            100e-6);  // the valve floats into the next lobe
}

TYPED_TEST(ValveLoopIn, TheGasHoldsAValveWithAHeadAreaOnItsSeat) {
  using Real = TypeParam;
  const ChangedFile changed(kOhc125, "head_area_mm2", "head_area_mm2 = 500");
  const EngineFile file = read_engine_file(changed.path(), {});
  const LoneValve valve(file, "intake");
  const Valve& v = valve.valve();
  IndicatorDiagram diagram;
  ASSERT_TRUE(accepted(diagram.init(file.definition().crank, file.definition().pressure)));
  for (const ValveMethod& method : {kRk4, kTextbook}) {
    const LastCycle<Real> last = run<Real>(valve, 3000, method);
    for (const auto& out : last.ticks) {
      if (std::abs(out.cam_deg) < 120) continue;
      double crank_deg = valve.definition().trains[0].cam.full_lift_deg + 2 * out.cam_deg;
      if (crank_deg < 0) crank_deg += 720;
      if (crank_deg >= 720) crank_deg -= 720;
      const double gas_N = (diagram.full_Pa(crank_deg) - file.definition().pressure.crankcase_Pa) * v.head_area_m2;
      // Pressed onto the stiff seat the valve follows the gas at once, but for the seat's own vibration, which each
      // tick's step of it excites.
      EXPECT_NEAR(static_cast<double>(out.forces.seat_N), v.spring_preload_N + gas_N,
                  0.05 * (v.spring_preload_N + gas_N))
          << out.cam_deg;
    }
  }
}

// ---- the valves of a whole engine ----

TYPED_TEST(ValveLoopIn, InAWholeEngineEveryCylinderHasTheSameValves) {
  using Real = TypeParam;
  const EngineFile file = read_engine_file(kDiesel, {});
  const EngineDefinition& definition = file.definition();
  const Operation operation{2400, 50e-6, 1};  // no whole number of ticks lies between two firings
  FixedStepLoop<Real> loop(definition, operation);
  const RunFigures figures = run_cycles<Real>(loop, definition, operation, 2);
  ASSERT_EQ(figures.valves.size(), 2u);
  EXPECT_EQ(names_of_trains(file), (std::vector<std::string>{"intake", "exhaust"}));
  for (std::size_t t = 0; t < 2; ++t) {
    const LoneValve valve(file, names_of_trains(file)[t]);
    const ValveCycle<Real> alone = run<Real>(valve, operation.speed_rpm, kRk4, operation.tick_s).results;
    const ValveCycle<double>& together = figures.valves[t].last_cycle;
    const auto expect_same = [](double a, Real b, double within) { EXPECT_NEAR(a, static_cast<double>(b), within); };
    expect_same(together.largest_lift_m, alone.largest_lift_m, 2 * kAccuracy_m);
    expect_same(together.bounce_height_m, alone.bounce_height_m, 2 * kAccuracy_m);
    expect_same(together.separation_clearance_m, alone.separation_clearance_m, 2 * kAccuracy_m);
    expect_same(together.seating_speed_m_s, alone.seating_speed_m_s, 1e-3);
    EXPECT_EQ(together.bounces, alone.bounces);
    EXPECT_EQ(together.separations, alone.separations);
    // The full lift of every cylinder stands at its own angle; a tick is 0.72 deg.
    const Peak& lift = figures.valves[t].of[index_of(ValveQuantity::theoretical_lift)].largest;
    EXPECT_NEAR(lift.at_deg, definition.trains[t].cam.full_lift_deg, 0.4);
    EXPECT_NEAR(lift.value, valve.lift().largest_lift_m(), 0.3e-6);
  }
}

TYPED_TEST(ValveLoopIn, ATraceHoldsTheValvesOfCylinderOneAndTheResultsOfItsLobe) {
  using Real = TypeParam;
  const EngineFile file = read_engine_file(kOhc125, {});
  const Operation operation{7000, 100e-6, 1};
  const Trace trace = record_trace<Real>(file.definition(), operation);
  ASSERT_EQ(trace.valves.size(), 1u);
  const ValveTrace& valve = trace.valves[0];
  ASSERT_EQ(valve.regime.size(), trace.crank_deg.size());
  for (const std::vector<double>& values : valve.of) ASSERT_EQ(values.size(), trace.crank_deg.size());
  const std::vector<double>& theory = valve[ValveQuantity::theoretical_lift];
  const auto top = static_cast<std::size_t>(std::max_element(theory.begin(), theory.end()) - theory.begin());
  EXPECT_EQ(trace.crank_deg[top], file.definition().trains[0].cam.full_lift_deg);
  EXPECT_EQ(valve.cycle.bounces, 3u);
  EXPECT_NEAR(valve.cycle.largest_lift_m, 7.785e-3, 0.001e-3);
}

TEST(Cycles, AreComparedResultByResult) {
  ValveCycle<double> a{};
  ValveCycle<double> b{};
  a.largest_lift_m = 2, b.largest_lift_m = 1;
  a.bounces = 1, b.bounces = 3;
  a.separation_clearance_m = 1, a.separation_start_deg = 10, a.separation_duration_deg = 2;
  b.separation_clearance_m = 2, b.separation_start_deg = 5, b.separation_duration_deg = 1;
  for (const ValveCycle<double>& worse : {worse_of(a, b), worse_of(b, a)}) {
    EXPECT_EQ(worse.largest_lift_m, 2);
    EXPECT_EQ(worse.bounces, 3u);
    EXPECT_EQ(worse.separation_clearance_m, 2);
    EXPECT_EQ(worse.separation_start_deg, 5);  // of the larger separation, not the larger angle
    EXPECT_EQ(worse.separation_duration_deg, 1);
  }
}

}  // namespace
}  // namespace crankloop::program::valve_loop_test
