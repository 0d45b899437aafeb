// What a cycle is reported to have been - opening, float, seating, bounce - against the reference's own trajectory,
// judged by other code.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "support/test_valves.hpp"

namespace crankloop::valve_record_test {
namespace {

using namespace valve_test;
using support::Random;

constexpr double kUm = 1e-6;

/// A cycle of the reference from rest in the middle of the base circle to the next, and what the library told of it.
struct Told {
  ValveCycle<double> by_library{};
  ReferenceCycle by_reference;
  double opens_deg = 0;  ///< cam angle at which the lobe opens: the library counts from there
};

template <class Real = double>
Told one_cycle(const ValveTrain& train, double rpm, const TickOptions& options) {
  // The middle of the base circle, half a turn from the lobe's middle; begin just beyond it, in the sense of rotation.
  const ValveLift lift = lift_of(train);
  const double opens_deg = lift.opens_rad() / kRadPerDeg;
  const double middle_deg = (opens_deg + lift.closes_rad() / kRadPerDeg) / 2 + 180;
  double start_deg = train.cam.full_lift_deg + 2 * middle_deg + (rpm > 0 ? 1 : -1);
  while (start_deg >= 720) start_deg -= 720;
  SideBySide<Real> both(train, options, start_deg);
  both.reference.keep_moments = true;
  const double speed = rad_s_of_rpm(rpm);
  for (int i = 0; i < both.rig.ticks_per_cycle(speed) + 2; ++i) {
    both.step(speed);
    const auto& told = both.rig.engine().output().valve_cycle[0][0];
    if (told.largest_lift_m == 0) continue;
    Told all;
    ValveCycle<double>& t = all.by_library;
    t.largest_lift_m = static_cast<double>(told.largest_lift_m);
    t.largest_speed_m_s = static_cast<double>(told.largest_speed_m_s);
    t.largest_acceleration_m_s2 = static_cast<double>(told.largest_acceleration_m_s2);
    t.opening_delay_deg = static_cast<double>(told.opening_delay_deg);
    t.separation_clearance_m = static_cast<double>(told.separation_clearance_m);
    t.separation_start_deg = static_cast<double>(told.separation_start_deg);
    t.separation_duration_deg = static_cast<double>(told.separation_duration_deg);
    t.seating_speed_m_s = static_cast<double>(told.seating_speed_m_s);
    t.bounce_height_m = static_cast<double>(told.bounce_height_m);
    t.separations = told.separations;
    t.bounces = told.bounces;
    t.contact_changes = told.contact_changes;
    t.off_seat_at_end = told.off_seat_at_end;
    all.by_reference = cycle_of(both.reference.moments, both.reference.mass());
    all.opens_deg = opens_deg;
    return all;
  }
  ADD_FAILURE() << "no cycle was told";
  return {};
}

double wrapped(double deg) { return deg - 360 * std::floor(deg / 360 + 0.5); }

struct Tolerance {
  double lift_m, angle_deg, speed_m_s;
};

void expect_same(const Told& told, const Tolerance& within) {
  const ValveCycle<double>& ours = told.by_library;
  const ReferenceCycle& truth = told.by_reference;
  EXPECT_NEAR(ours.largest_lift_m, truth.largest_lift_m, within.lift_m);
  EXPECT_NEAR(ours.opening_delay_deg, truth.opening_delay_deg, within.angle_deg);
  EXPECT_NEAR(ours.seating_speed_m_s, truth.seating_speed_m_s, within.speed_m_s);
  // Largest speed and acceleration are those at the ends of steps: between them a contact's swing goes on by up to (w
  // d)^2 / 8 of itself.
  EXPECT_NEAR(ours.largest_speed_m_s, truth.largest_speed_m_s, 0.02 * truth.largest_speed_m_s);
  EXPECT_NEAR(ours.largest_acceleration_m_s2, truth.largest_acceleration_m_s2, 0.1 * truth.largest_acceleration_m_s2);
  if (truth.nearest_to_threshold_m < within.lift_m) return;  // the errors of both may decide whether it counts
  EXPECT_EQ(static_cast<int>(ours.separations), truth.separations);
  EXPECT_EQ(static_cast<int>(ours.bounces), truth.bounces);
  EXPECT_NEAR(ours.separation_clearance_m, truth.separation_clearance_m, within.lift_m);
  EXPECT_NEAR(ours.bounce_height_m, truth.bounce_height_m, within.lift_m);
  if (truth.separations > 0) {
    EXPECT_NEAR(wrapped(ours.separation_start_deg - (truth.separation_start_deg - told.opens_deg)), 0,
                within.angle_deg);
    EXPECT_NEAR(ours.separation_duration_deg, truth.separation_duration_deg, 2 * within.angle_deg);
  }
}

void print(double rpm, double tick_us, const Told& told) {
  const ValveCycle<double>& a = told.by_library;
  const ReferenceCycle& b = told.by_reference;
  std::printf(
      "[ figures  ] %6.0f rpm, %4.0f us: delay %.4f (reference %.4f) deg, float %u (%d) to %.3f (%.3f) um for %.3f "
      "(%.3f) deg from %.3f (%.3f), "
      "seating at %.5f (%.5f) m/s, bounces %u (%d) to %.3f (%.3f) um, speed %.3f (%.3f), acceleration %.0f (%.0f)\n",
      rpm, tick_us, a.opening_delay_deg, b.opening_delay_deg, a.separations, b.separations,
      a.separation_clearance_m / kUm, b.separation_clearance_m / kUm, a.separation_duration_deg,
      b.separation_duration_deg, a.separation_start_deg, b.separation_start_deg - told.opens_deg, a.seating_speed_m_s,
      b.seating_speed_m_s, a.bounces, b.bounces, a.bounce_height_m / kUm, b.bounce_height_m / kUm, a.largest_speed_m_s,
      b.largest_speed_m_s, a.largest_acceleration_m_s2, b.largest_acceleration_m_s2);
}

// 1 um of lift at 12000 rpm is 0.003 deg where the valve moves at 8 m/s and 0.03 deg near the ends of a gap, 1e-4 of
// the seating speed.
constexpr Tolerance kClose{1 * kUm, 0.03, 0.003};

TEST(ValveRecord, TellsWhatTheReferenceSaw) {
  for (const double rpm : {3000.0, 7000.0, 8500.0, 9500.0, 10000.0, 12000.0, 14000.0}) {
    SCOPED_TRACE(rpm);
    const Told told = one_cycle(ohc_125_train(), rpm, {20e-6, {}});
    print(rpm, 20, told);
    expect_same(told, kClose);
  }
}

TEST(ValveRecord, DoesNotDependOnTheTick) {
  for (const double tick_us : {2.0, 10.0, 50.0, 100.0, 250.0, 500.0, 1000.0, 2000.0}) {
    for (const double rpm : {7000.0, 12000.0}) {
      SCOPED_TRACE(testing::Message() << tick_us << " us, " << rpm << " rpm");
      const Told told = one_cycle(ohc_125_train(), rpm, {tick_us * 1e-6, {}});
      print(rpm, tick_us, told);
      expect_same(told, kClose);
    }
  }
}

TEST(ValveRecord, InFloatTellsTheSame) {
  for (const double rpm : {7000.0, 10000.0, 12000.0}) {
    SCOPED_TRACE(rpm);
    const Told told = one_cycle<float>(ohc_125_train(), rpm, {50e-6, {}});
    print(rpm, 50, told);
    expect_same(told, kClose);
  }
}

TEST(ValveRecord, OfReverseRotationSwapsTheRolesOfTheFlanks) {
  for (const double rpm : {-7000.0, -10000.0, -12000.0}) {
    SCOPED_TRACE(rpm);
    const Told told = one_cycle(ohc_125_train(), rpm, {20e-6, {}});
    print(rpm, 20, told);
    expect_same(told, kClose);
  }
}

TEST(ValveRecord, ReportsAValveThatIsStillInTheAirAtTheEndOfItsCycle) {
  // A heavy valve on a weak spring: thrown up at 6000 rpm it does not come back before the cam is round.
  ValveTrain train = ohc_125_train();
  train.valve.valve_kg = 0.5;
  train.valve.spring_preload_N = 20;
  train.valve.spring_N_m = 4e3;
  const ValveLift lift = lift_of(train);
  const double lobe_deg = lift.closes_rad() / kRadPerDeg - lift.opens_rad() / kRadPerDeg;
  for (const bool forward : {true, false}) {
    SCOPED_TRACE(forward ? "forward" : "backward");
    // The middle of the base circle, from the start of the lobe: behind the lobe, or before it when turning backward.
    const double middle_deg = forward ? lobe_deg / 2 + 180 : lobe_deg / 2 - 180;
    Rig<double> rig(train, {20e-6, {}}, 100);
    const double speed = rad_s_of_rpm(forward ? 6000 : -6000);
    int told = 0;
    for (int i = 0; i < 4 * rig.ticks_per_cycle(speed); ++i) {
      const ValveCycle<double> c = rig.step(speed).valve_cycle[0][0];
      if (c.largest_lift_m == 0 || told != 0) continue;
      ++told;
      std::printf("[ figures  ] float from %.2f for %.2f deg, gap %.2f mm; the cycle ends at %.2f\n",
                  c.separation_start_deg, c.separation_duration_deg, c.separation_clearance_m * 1e3, middle_deg);
      EXPECT_EQ(c.off_seat_at_end, 1u);
      EXPECT_GE(c.separations, 1u);
      // Float that goes on when the cycle ends is told up to there, and no further.
      EXPECT_NEAR(c.separation_duration_deg, std::fabs(middle_deg - c.separation_start_deg), 0.5);
      EXPECT_EQ(c.seating_speed_m_s, 0);
    }
    EXPECT_EQ(told, 1);
  }
}

TEST(ValveRecord, NeverTakesCompressionForFloatNorBounceForSeparation) {
  // A soft train compresses by 0.5 mm at full lift; slow, it never leaves the valve.
  ValveTrain train = ohc_125_train();
  train.valve.train_N_m = 1e6;
  for (const double rpm : {300.0, 1500.0}) {
    const Told soft = one_cycle(train, rpm, {100e-6, {}});
    EXPECT_EQ(soft.by_library.separations, 0u) << rpm;
    EXPECT_EQ(soft.by_reference.separations, 0) << rpm;
    EXPECT_LT(soft.by_library.largest_lift_m, 7.5e-3);
  }
  // At 7000 rpm the 125 bounces and does not float.
  const Told bouncing = one_cycle(ohc_125_train(), 7000, {100e-6, {}});
  EXPECT_EQ(bouncing.by_library.bounces, 3u);
  EXPECT_EQ(bouncing.by_library.separations, 0u);
}

TEST(ValveRecord, OfRandomTrainsAgreesWithTheReference) {
  Random random;
  int floats = 0;
  int bounces = 0;
  for (int draw = 0; draw < 25; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    ValveTrain train = ohc_125_train();
    train.valve.valve_kg *= random.between(0.7, 3);
    train.valve.train_N_m *= std::pow(10, random.between(-0.7, 0.3));
    train.valve.seat_N_m *= std::pow(10, random.between(-0.7, 0.2));
    train.valve.train_damping_ratio = random.between(0.05, 0.5);
    train.valve.seat_damping_ratio = random.between(0.05, 0.8);
    train.valve.spring_preload_N *= random.between(0.7, 2);
    train.rocker.clearance_m = random.between(0.02e-3, 0.2e-3);
    const double rpm = random.between(3000, 9000) * (random.coin() ? 1 : -1);
    const double tick_s = 10e-6 * std::pow(10, random.between(0, 2));
    const Told told = one_cycle(train, rpm, {tick_s, {Integrator::exponential, 0.1e-6}});
    floats += told.by_library.separations > 0 ? 1 : 0;
    bounces += told.by_library.bounces > 0 ? 1 : 0;
    expect_same(told, {2 * kUm, 0.05, 0.005});
    if (HasFailure()) print(rpm, tick_s * 1e6, told);
  }
  std::printf("[ figures  ] %d of 25 float, %d bounce\n", floats, bounces);
  EXPECT_GT(floats, 3);
  EXPECT_GT(bounces, 3);
}

TEST(ValveRecord, TakesAFlightThatOutlivesItsCycleForNoBounce) {
  // A train of 0.7 times the stiffness at 13 000 rpm: the valve may still be in the air when its cam opens, touches the
  // seat before the cam's full lift or not at all, and is carried up again. That was told as seating, and the lift
  // after it as a bounce of 8.5 mm.
  ValveTrain train = ohc_125_train();
  train.valve.train_N_m *= 0.7;
  Rig<double> rig(train, {20e-6, {}}, 90);
  const double speed = rad_s_of_rpm(13000);
  double highest_m = 0;
  int in_the_air = 0;
  for (int i = 0; i < 300 * rig.ticks_per_cycle(speed); ++i) {
    const auto& cycle = rig.step(speed).valve_cycle[0][0];
    highest_m = std::max(highest_m, cycle.bounce_height_m);
    in_the_air += cycle.off_seat_at_end != 0 ? 1 : 0;
  }
  std::printf(
      "[ figures  ] 13 000 rpm, soft train: highest bounce %.2f mm, %d ticks behind a cycle that ended in the air\n",
      highest_m * 1e3, in_the_air);
  EXPECT_GT(in_the_air, 0) << "or nothing of the kind happened";
  EXPECT_LT(highest_m, 6e-3) << "a bounce, not the next lift of 7.8 mm and more";
}

TEST(ValveRecord, CountsContactsThatChangeWithTheCamsSpeedToo) {
  // Each change is undone until the valve rests on its seat again, so their number is even: also where the cam's speed
  // jumps between two ticks and the damper lets go of the valve or takes hold of it.
  for (const double tick_us : {20.0, 100.0}) {
    Rig<double> rig(ohc_125_train(), {tick_us * 1e-6, {}}, 90);
    Random random;
    double told_m_s = 0, turned_deg = 0;
    int even = 0, odd = 0, jumps = 0;
    bool was_seated = true;
    while (turned_deg < 200 * 360) {
      const double speed = rad_s_of_rpm(9000 * random.between(0.95, 1.05));
      const std::uint32_t before = detail::contacts_of(rig.regime());
      turned_deg += speed * tick_us * 1e-6 / kRadPerDeg / 2;
      const ValveCycle<double>& c = rig.step(speed).valve_cycle[0][0];
      jumps += before != detail::contacts_of(rig.regime()) ? 1 : 0;
      if (c.largest_speed_m_s == told_m_s) continue;
      told_m_s = c.largest_speed_m_s;
      const bool seated = c.off_seat_at_end == 0;
      if (seated && was_seated) ++(c.contact_changes % 2 == 0 ? even : odd);
      was_seated = seated;
    }
    std::printf("[ figures  ] %.0f us: %d cycles from seat to seat, %d with an odd number of changes; %d in all\n",
                tick_us, even + odd, odd, jumps);
    EXPECT_GT(even, 150) << tick_us;
    EXPECT_EQ(odd, 0) << tick_us;
  }
}

TEST(ValveRecordOf, AStepHasThePeakOfItsParabola) {
  detail::ValveRecord<double> record;
  detail::ObservedStep<double> step{};
  step.from = {1e-3, 1}, step.to = {1e-3, -1}, step.step_s = 1e-3;
  record.step(step, 0, [](double) { return 0.0; });
  EXPECT_NEAR(record.maxima().lift_m, 1.25e-3, 1e-15);  // h + v t / 4
}

TEST(ValveRecordOf, EveryCycleEndsHoweverFarATickTurns) {
  for (const double tick_us : {50.0, 200.0, 500.0}) {
    Rig<double, OneValve> rig(ohc_125_train(), {tick_us * 1e-6, {}}, 90);
    double turned_deg = 0, told_m_s = 0;
    int cycles = 0;
    for (int i = 0; turned_deg < 20 * 360; ++i) {
      const double speed = rad_s_of_rpm(7000) + i * tick_us * 1e-3;  // so that no cycle is like another
      turned_deg += speed * tick_us * 1e-6 / kRadPerDeg / 2;
      const double now_m_s = rig.step(speed).valve_cycle[0][0].largest_speed_m_s;
      if (now_m_s != told_m_s) ++cycles;
      told_m_s = now_m_s;
    }
    EXPECT_NEAR(cycles, 20, 1) << tick_us;
  }
}

}  // namespace
}  // namespace crankloop::valve_record_test
