// Valves at rest, at standstill, woken, moved by a phaser, set anew by a jump of the crank, and pressed by gas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "support/test_valves.hpp"

namespace crankloop::valve_rest_test {

using namespace detail;
namespace {

using namespace valve_test;
using support::Random;
using tick_test::BothReals;
using tick_test::RealName;

constexpr double kUm = 1e-6;

const double kCrankcase_Pa = Pressure{}.crankcase_Pa;

bool long_tests() { return std::getenv("CRANKLOOP_LONG_TESTS") != nullptr; }

// ---- rest, waking, standstill
// ----------------------------------------------------------------------------------------------

template <class Real>
class ValveRest : public ::testing::Test {};
TYPED_TEST_SUITE(ValveRest, BothReals, RealName);

bool subnormal(double x, double least_normal) { return x != 0 && std::fabs(x) < least_normal; }

TYPED_TEST(ValveRest, OnTheBaseCircleIsExact) {
  using Real = TypeParam;
  Rig<Real> rig(ohc_125_train(), {50e-6, {}}, 90);
  int rested = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto& out = rig.step(rad_s_of_rpm(4000));
    const double cam = rig.cam_deg();
    if (std::fabs(cam) < 110) continue;  // 90 deg closed: another 20, 0.8 ms, for the seat's vibration to die away
    ++rested;
    EXPECT_TRUE(rig.at_rest()) << cam;
    EXPECT_EQ(out.valve[0][0].lift_m, 0);
    EXPECT_EQ(out.valve[0][0].velocity_m_s, 0);
    EXPECT_EQ(out.valve[0][0].acceleration_m_s2, 0);
    EXPECT_EQ(out.valve_forces[0][0].seat_N, static_cast<Real>(205.8));
    EXPECT_EQ(out.valve_forces[0][0].train_N, 0);
  }
  EXPECT_GT(rested, 1000);
}

TYPED_TEST(ValveRest, EndsBeforeTheTrainTouches) {
  using Real = TypeParam;
  Random random;
  const ValveLift lift = lift_of(ohc_125_train());
  for (const double tick_s : {1e-6, 20e-6, 100e-6, 1e-3}) {
    Rig<Real> rig(ohc_125_train(), {tick_s, {}}, 90 + random.between(0, 50));
    const double speed = rad_s_of_rpm(random.coin() ? 6000 : -6000);
    const int n = std::min(20'000, 3 * rig.ticks_per_cycle(speed));
    for (int i = 0; i < n; ++i) {
      const double before = rig.cam_deg();
      rig.step(speed);
      // While it slept through a tick the lash was open at both ends, by its exact lift.
      if (rig.at_rest()) {
        EXPECT_LT(lift.at(before * kRadPerDeg).lift_m, 0) << before;
        EXPECT_LT(lift.at(rig.cam_deg() * kRadPerDeg).lift_m, 0) << rig.cam_deg();
      }
    }
  }
}

TYPED_TEST(ValveRest, AtStandstillWithTheValveOpenIsTheEquilibrium) {
  using Real = TypeParam;
  Rig<Real> rig(ohc_125_train(), {100e-6, {}}, 90);
  while (rig.cam_deg() < -30 || rig.cam_deg() > 0) rig.step(rad_s_of_rpm(3000));
  for (int i = 0; i < 200'000; ++i) {  // 20 s
    const auto& valve = rig.step(0).valve[0][0];
    ASSERT_FALSE(
        subnormal(static_cast<double>(valve.velocity_m_s), sizeof(Real) == 4 ? double{1.17549435e-38} : DBL_MIN))
        << "tick " << i;
  }
  const ValveBody<Real>& b = rig.motion().body;
  const double Y = lift_of(rig.train()).at(rig.cam_deg() * kRadPerDeg).lift_m;
  const double rest_m = (static_cast<double>(b.train_N_m) * Y - 205.8) /
                        (static_cast<double>(b.train_N_m) + static_cast<double>(b.spring_N_m));
  EXPECT_NEAR(static_cast<double>(rig.engine().output().valve[0][0].lift_m), rest_m, sizeof(Real) == 4 ? 5e-9 : 1e-12);
  EXPECT_NEAR(static_cast<double>(rig.engine().output().valve[0][0].velocity_m_s), 0, sizeof(Real) == 4 ? 1e-5 : 1e-12);
}

TYPED_TEST(ValveRest, WithoutClearanceComesToRestToo) {
  // A hydraulic lash adjuster: no lash to tell that the cam is away. The valve must not tremble for ever on its seat,
  // spend events or go denormal.
  using Real = TypeParam;
  ValveTrain train = ohc_125_train();
  train.rocker.clearance_m = 0;
  Rig<Real> rig(train, {100e-6, {}}, 90);
  const double least = sizeof(Real) == 4 ? double{1.17549435e-38} : DBL_MIN;
  int not_at_rest = 0;
  for (int i = 0; i < 3 * rig.ticks_per_cycle(rad_s_of_rpm(1000)); ++i) {
    const auto& out = rig.step(rad_s_of_rpm(1000));
    ASSERT_EQ(out.faults, 0u) << "tick " << i;
    ASSERT_FALSE(subnormal(static_cast<double>(rig.valve().lift_m), least))
        << "tick " << i << ", cam " << rig.cam_deg();
    ASSERT_FALSE(subnormal(static_cast<double>(rig.valve().velocity_m_s), least))
        << "tick " << i << ", cam " << rig.cam_deg();
    if (std::fabs(rig.cam_deg()) > 120 && rig.valve().velocity_m_s != 0) ++not_at_rest;
  }
  EXPECT_EQ(not_at_rest, 0) << "ticks on the base circle that still move";
}

TYPED_TEST(ValveRest, LastsThroughLongStandstill) {
  using Real = TypeParam;
  Rig<Real> rig(ohc_125_train(), {100e-6, {}}, 90);
  const long n = long_tests() ? 1'000'000'000 : 10'000'000;
  for (long i = 0; i < n; ++i) rig.step(0);
  EXPECT_TRUE(rig.at_rest());
  EXPECT_EQ(rig.engine().output().valve[0][0].lift_m, 0);
}

TYPED_TEST(ValveRest, IsTheSameAfterManyCyclesAsAfterThousand) {
  // A cycle of exactly 2^10 ticks, so that every cycle sees the same angles: what changes then is the valve's own.
  using Real = TypeParam;
  Rig<Real, OneValveOnMeasuredCrank> rig(ohc_125_train(), {20e-6, {}}, 90);  // 20.48 ms per cycle: 5859 rpm
  const long ticks = long_tests() ? 1'000'000'000 : 10'000'000;
  Real largest_of_1000th = 0;
  Real largest_of_last = 0;
  std::uint64_t phase = phase_at(90).units();
  const double least = sizeof(Real) == 4 ? double{1.17549435e-38} : DBL_MIN;
  bool denormal = false;
  for (long i = 0; i < ticks; ++i) {
    typename Engine<Real, OneValveOnMeasuredCrank>::Input in;
    in.crank = Phase{phase += std::uint64_t{1} << 54};
    const auto& out = rig.engine().step(in);
    const ValveState<Real> s = rig.valve();
    denormal = denormal || subnormal(static_cast<double>(s.lift_m), least) ||
               subnormal(static_cast<double>(s.velocity_m_s), least);
    if (i / 1024 == 1000) largest_of_1000th = std::max(largest_of_1000th, out.valve[0][0].lift_m);
    if (i / 1024 == ticks / 1024 - 1) largest_of_last = std::max(largest_of_last, out.valve[0][0].lift_m);
  }
  EXPECT_FALSE(denormal);
  EXPECT_GT(largest_of_last, static_cast<Real>(0.007));
  EXPECT_EQ(largest_of_last, largest_of_1000th);
}

TEST(ValveOnASoftSeat, MeetsItsTrainWhereItSwingsUpIntoTheSeatByMoreThanTheLash) {
  // Found by crankloop stress: the preload presses 0.8 mm into the seat, the lash is 6 um, and what trembles on the
  // seat after closing comes up against the rocker again and again. Taken for quiet it was off by 23 um.
  ValveTrain train = ohc_125_train();
  train.valve.valve_kg = 0.15;
  train.rocker.clearance_m = 6e-6;
  train.valve.seat_N_m = 1.2e6;
  train.valve.seat_damping_ratio = 0;
  train.valve.guide_damping_ratio = 0;
  train.valve.spring_preload_N = 930;
  SideBySide<double> both(train, {100e-6, {}}, 200);
  const double speed = rad_s_of_rpm(3000);
  const double worst = both.worst_over(both.rig.ticks_per_cycle(speed), speed);
  std::printf("[ figures  ] on a soft seat at 3000 rpm: %.4f um, %d contact changes\n", worst / kUm,
              both.reference.changes);
  EXPECT_GT(both.reference.changes, 10);
  EXPECT_LE(worst, 0.1 * kUm);
}

// ---- cam phase, jumps, gas
// -------------------------------------------------------------------------------------------------

TEST(ValvePhaser, MovesTheLiftWithTheCamAndNeverFasterThanItMay) {
  ValveTrain train = ohc_125_train();
  train.cam.phase_rate_deg_s = 200;
  Rig<double, OneValveWithPhaser> rig(train, {50e-6, {}}, 90);
  const ValveLift lift = lift_of(train);
  Reference reference(SingleMass(train.valve, train.rocker, lift.largest_lift_m()), TurnedCam(lift));
  const double speed = rad_s_of_rpm(6000);
  long double engine_deg = 90;
  double moved_deg = 0;
  const auto cam_deg = [&] {
    return static_cast<double>((engine_deg - 450 - static_cast<long double>(moved_deg)) / 2);
  };
  double before = cam_deg();
  double worst = 0;
  for (int i = 0; i < 3200; ++i) {  // 160 ms: 8 cycles; the phaser needs 50 ms for its 10 deg
    const double target_deg = i < 400 ? 0 : 10;
    Engine<double, OneValveWithPhaser>::Input in;
    in.speed_rad_s = speed;
    in.cam_phase_deg[0] = target_deg;
    const auto& out = rig.engine().step(in);
    ASSERT_EQ(out.faults, 0u);
    engine_deg += 36000.0L * 50e-6L;
    moved_deg += std::min(target_deg - moved_deg, 200 * 50e-6);
    reference.advance(50e-6, before, cam_deg());
    before = cam_deg();
    worst = std::max(worst, std::fabs(out.valve[0][0].lift_m - reference.y));
  }
  std::printf("[ figures  ] cam phase moved by 10 deg at 200 deg/s and 6000 rpm: %.4f um\n", worst / kUm);
  EXPECT_LT(worst, 1 * kUm);
  EXPECT_NEAR(static_cast<double>(rig.engine().state().cam_phase[0]), 10.0 / 720 * 18446744073709551616.0, 1e5);

  // Ends on the curve of a cam that was cut 10 deg later in the first place.
  ValveTrain later = train;
  later.cam.full_lift_deg = 460;
  Rig<double> shifted(later, {50e-6, {}}, 90);
  double apart_m = 0;
  Rig<double, OneValveWithPhaser> again(train, {50e-6, {}}, 90);
  for (int i = 0; i < 4800; ++i) {
    Engine<double, OneValveWithPhaser>::Input in;
    in.speed_rad_s = speed;
    in.cam_phase_deg[0] = 10;
    again.engine().step(in);
    shifted.step(speed);
    if (i > 3000)
      apart_m = std::max(apart_m, std::fabs(again.engine().output().valve[0][0].lift_m -
                                            shifted.engine().output().valve[0][0].lift_m));
  }
  EXPECT_LT(apart_m, 0.01 * kUm);
}

TEST(ValvePhaser, OfAFixedCamDoesNotMove) {
  Rig<double, OneValveWithPhaser> rig(ohc_125_train(), {50e-6, {}}, 90);
  for (int i = 0; i < 100; ++i) {
    Engine<double, OneValveWithPhaser>::Input in;
    in.speed_rad_s = 600;
    in.cam_phase_deg[0] = 30;
    rig.engine().step(in);
  }
  EXPECT_EQ(rig.engine().state().cam_phase[0], 0u);
}

TEST(ValveOnAMeasuredCrank, StartsAnewInEquilibriumWhereThePhaseJumps) {
  const ValveLift lift = lift_of(ohc_125_train());
  const SingleMass mass(ohc_125_valve(), ohc_125_train().rocker, lift.largest_lift_m());
  for (const double to_deg : {450.0, 400.0, 520.0, 330.0, 318.5, 317.0, 90.0}) {
    Rig<double, OneValveOnMeasuredCrank> rig(ohc_125_train(), {100e-6, {}}, 90);
    rig.engine().step(tick_test::at_phase<Engine<double, OneValveOnMeasuredCrank>>(phase_at(90)));
    rig.engine().step(tick_test::at_phase<Engine<double, OneValveOnMeasuredCrank>>(phase_at(90)));
    double rest_m = 0;
    double largest_v = 0;
    for (int i = 0; i < 300; ++i) {
      const auto& out =
          rig.engine().step(tick_test::at_phase<Engine<double, OneValveOnMeasuredCrank>>(phase_at(to_deg)));
      if (i == 0 && to_deg > 300) {
        EXPECT_NE(out.faults & kFaultPhaseJump, 0u) << to_deg;
      }
      const double Y = lift.at((to_deg - 450) / 2 * kRadPerDeg).lift_m;
      const double open = (mass.k * Y - mass.P) / (mass.k + mass.k_s);
      const double pushed = mass.k * Y / (mass.k + mass.k_z + mass.k_s);
      rest_m = open > mass.delta ? open : std::max(0.0, pushed);
      EXPECT_NEAR(out.valve[0][0].lift_m, rest_m, 1e-9) << to_deg << " deg, tick " << i;
      largest_v = std::max(largest_v, std::fabs(out.valve[0][0].velocity_m_s));
    }
    EXPECT_LT(largest_v, 1e-4) << to_deg;
  }
}

TEST(ValveAtStart, StandsOnALiftedCamInEquilibrium) {
  // An engine that stopped with its valve open starts with it open.
  for (const double start_deg : {450.0, 380.0, 520.0}) {
    Rig<double> rig(ohc_125_train(), {100e-6, {}}, start_deg);
    const double Y = lift_of(rig.train()).at((start_deg - 450) / 2 * kRadPerDeg).lift_m;
    const double rest_m = (1000 / 0.085e-3 * Y - 205.8) / (1000 / 0.085e-3 + 40e3);
    for (int i = 0; i < 100; ++i)
      ASSERT_NEAR(rig.step(0).valve[0][0].lift_m, rest_m, 1e-9) << start_deg << " deg, tick " << i;
  }
}

TEST(ValveUnderGas, SinksIntoItsSeatByTheSameLawWhateverTheTick) {
  // 60 bar on 4 cm^2 press with 2.4 kN: 23.6 um into a seat of 100 N/um beside the spring. It swings there for a while,
  // and the seat feels all that the spring does not.
  ValveTrain train = ohc_125_train();
  train.valve.head_area_m2 = 4e-4;
  const double gas_N = (60e5 - kCrankcase_Pa) * 4e-4;
  const double sunk_m = -gas_N / (1e8 + 40e3);
  for (const double tick_s : {5e-6, 20e-6, 100e-6, 1e-3}) {
    Rig<double, OneValveWithGas> rig(train, {tick_s, {}}, 90);
    Engine<double, OneValveWithGas>::Input in;
    in.pressure_Pa[0] = 60e5;
    double lowest_m = 0;
    for (int i = 0; i * tick_s < 20e-3; ++i) lowest_m = std::min(lowest_m, rig.engine().step(in).valve[0][0].lift_m);
    const auto& out = rig.engine().output();
    EXPECT_GE(lowest_m, 2 * sunk_m) << "a sudden load swings to twice its rest";
    EXPECT_NEAR(out.valve[0][0].lift_m, sunk_m, 1e-12) << tick_s;
    EXPECT_EQ(out.valve[0][0].velocity_m_s, 0) << tick_s;
    EXPECT_NEAR(out.valve_forces[0][0].seat_N, 205.8 + gas_N * (1e8 / (1e8 + 40e3)), 1e-6) << tick_s;
  }
}

TEST(ValveUnderGas, MeetsItsTrainWhereItIsPressedIntoTheSeatByMoreThanTheLash) {
  // So slowly that it never leaves its rest by itself: 100 bar in 0.2 s, 40 um into the seat, with a lash of 6 um.
  ValveTrain train = ohc_125_train();
  train.valve.head_area_m2 = 4e-4;
  train.rocker.clearance_m = 6e-6;
  for (const double tick_s : {20e-6, 100e-6}) {
    Rig<double, OneValveWithGas> rig(train, {tick_s, {}}, 90);
    Engine<double, OneValveWithGas>::Input in;
    const int ticks = static_cast<int>(std::lround(0.2 / tick_s));
    for (int i = 0; i <= 2 * ticks; ++i) {
      in.pressure_Pa[0] = kCrankcase_Pa + 100e5 * std::min(i, ticks) / ticks;
      rig.engine().step(in);
    }
    const ValveBody<double>& b = rig.motion().body;
    const double rest_m =
        -(b.train_N_m * 6e-6 + 100e5 * 4e-4) / (b.train_N_m + b.seat_N_m + b.spring_N_m);  // both contacts bear
    const auto& out = rig.engine().output();
    EXPECT_NEAR(out.valve[0][0].lift_m, rest_m, 1e-9) << tick_s;
    EXPECT_EQ(out.valve_forces[0][0].regime, kTrainOn | kSeatOn) << tick_s;
    EXPECT_NEAR(out.valve_forces[0][0].train_N, b.train_N_m * (-6e-6 - rest_m), 0.01) << tick_s;
  }
}

TEST(ValveUnderGas, FeelsAPressureThatRisesEvenlyWithinATick) {
  // A ramp of 100 bar in 4 ms, by less than the lash, sampled at the ticks' ends: with the pressure linear between
  // them, ticks of any length give the same motion. Held over the tick it would be off by half a tick of the ramp: 0.05
  // um at 10 us, 1 um at 200.
  ValveTrain train = ohc_125_train();
  train.valve.head_area_m2 = 4e-4;
  const auto lifts_at = [&](double tick_s) {
    Rig<double, OneValveWithGas> rig(train, {tick_s, {Integrator::exponential}}, 90);
    Engine<double, OneValveWithGas>::Input in;
    std::vector<double> all;
    const int per = static_cast<int>(std::lround(200e-6 / tick_s));
    for (int i = 1; i <= 20 * per; ++i) {
      in.pressure_Pa[0] = kCrankcase_Pa + 100e5 * i / (20.0 * per);
      rig.engine().step(in);
      if (i % per == 0) all.push_back(rig.engine().output().valve[0][0].lift_m);
    }
    return all;
  };
  const std::vector<double> fine = lifts_at(2e-6);
  EXPECT_NEAR(fine.back(), -100e5 * 4e-4 / (1e8 + 40e3), 1 * kUm);
  for (const double tick_s : {10e-6, 20e-6, 100e-6, 200e-6})
    EXPECT_LT(apart(lifts_at(tick_s), fine), 1e-3 * kUm) << tick_s;
}

TEST(ValveUnderGas, OpensLaterAndLessAgainstPressure) {
  ValveTrain train = ohc_125_train();
  train.valve.head_area_m2 = 4e-4;
  const auto cycle = [&](double pressure_Pa) {
    Rig<double, OneValveWithGas> rig(train, {20e-6, {}}, 90);
    SideBySide<double> plain(ohc_125_train(), {20e-6, {}}, 90);
    plain.reference.gas_N = (pressure_Pa - kCrankcase_Pa) * 4e-4;
    Engine<double, OneValveWithGas>::Input in;
    in.speed_rad_s = rad_s_of_rpm(6000);
    in.pressure_Pa[0] = pressure_Pa;
    double worst = 0;
    for (int i = 0; i < 1100; ++i) {
      rig.engine().step(in);
      plain.step(in.speed_rad_s);
      if (i > 500)
        worst = std::max(worst, std::fabs(rig.engine().output().valve[0][0].lift_m -
                                          plain.reference.y));  // the start's swing is over
    }
    std::printf("[ figures  ] %.1f bar on the head, 6000 rpm: %.4f um\n", pressure_Pa / 1e5, worst / kUm);
    EXPECT_LT(worst, 0.05 * kUm);
    return rig.engine().output().valve_cycle[0][0];
  };
  const ValveCycle<double> without = cycle(kCrankcase_Pa);
  const ValveCycle<double> against = cycle(5e5);
  EXPECT_GT(against.opening_delay_deg, without.opening_delay_deg);
  EXPECT_LT(against.largest_lift_m, without.largest_lift_m);
}

TEST(ValveUnderGas, IsSuckedOpenWhereThePortsPressureOvercomesItsSpring) {
  // A soft spring and a large head at part load: 0.7 bar below the port's pressure on 30 cm^2 pulls with 210 N against
  // 100 N.
  ValveTrain train = ohc_125_train();
  train.valve.head_area_m2 = 30e-4;
  train.valve.spring_preload_N = 100;
  Rig<double, OneValveWithGas> rig(train, {100e-6, {}}, 90);
  Engine<double, OneValveWithGas>::Input in;
  in.pressure_Pa[0] = 0.3e5;
  double largest_m = 0;
  for (int i = 0; i < 300; ++i) largest_m = std::max(largest_m, rig.engine().step(in).valve[0][0].lift_m);
  // Static: 110 N on 40 N/mm is 2.8 mm; a sudden load swings to nearly twice that.
  EXPECT_GT(largest_m, 2e-3);
}

}  // namespace
}  // namespace crankloop::valve_rest_test
