// Springs that surge in the tick: against the coupled equations, by energy, at rest, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <ostream>
#include <string>

#include <crankloop/tabulate/valve_springs.hpp>

#include "support/status.hpp"
#include "support/surging_valve.hpp"
#include "support/test_valves.hpp"

namespace crankloop::spring_step_test {
namespace {

using namespace valve_test;
using support::refuses;

struct Surging : tick_test::OneValve {
  static constexpr std::uint32_t spring_modes = kMaxValveModes;
};
struct SurgingWithGas : tick_test::OneValveWithGas {
  static constexpr std::uint32_t spring_modes = 3;
};
struct SurgingALittle : tick_test::OneValve {
  static constexpr std::uint32_t spring_modes = 1;
};

ValveTrain surging_train(int modes) {
  ValveTrain train = ohc_125_train();
  train.valve.surge_modes = modes;
  return train;
}

/// The same with two springs, one in the other.
ValveTrain nested_train(int modes) {
  ValveTrain train = surging_train(modes);
  train.valve.inner_spring_N_m = 15e3;
  train.valve.inner_spring_kg = 18e-3;
  return train;
}

SurgingValve reference_of(const ValveTrain& train, const ValveLift& lift) {
  const Valve& v = train.valve;
  SurgingValve reference(SingleMass(v, train.rocker, lift.largest_lift_m()), TurnedCam(lift));
  reference.add_spring(v.spring_N_m - v.inner_spring_N_m, v.spring_kg - v.inner_spring_kg, v.surge_damping_ratio,
                       v.surge_modes);
  if (v.inner_spring_N_m > 0)
    reference.add_spring(v.inner_spring_N_m, v.inner_spring_kg, v.surge_damping_ratio, v.surge_modes);
  return reference;
}

/// Largest errors of lift and of surge force, and the largest force.
struct Errors {
  double lift_um = 0, force_N = 0, largest_N = 0;
};

/// Over a turn of the cam from rest.
template <class Real>
Errors errors_over_a_turn(const ValveTrain& train, double rpm, double tick_us) {
  Rig<Real, Surging> rig(train, {tick_us * 1e-6, {}}, 90);
  const ValveLift lift = lift_of(train);
  SurgingValve reference = reference_of(train, lift);
  Errors errors;
  double cam_deg = rig.cam_deg();
  for (int i = 0; i < rig.ticks_per_cycle(rad_s_of_rpm(rpm)); ++i) {
    const auto& out = rig.step(rad_s_of_rpm(rpm));
    double turned = rig.cam_deg() - cam_deg;
    turned -= 360 * std::floor(turned / 360 + 0.5);
    reference.advance(rig.tick_s(), cam_deg, cam_deg + turned);
    cam_deg = rig.cam_deg();
    errors.lift_um =
        std::max(errors.lift_um, 1e6 * std::fabs(static_cast<double>(out.valve[0][0].lift_m) - reference.lift_m()));
    errors.force_N =
        std::max(errors.force_N, std::fabs(static_cast<double>(out.valve_spring[0][0].surge_N) - reference.surge_N()));
    errors.largest_N = std::max(errors.largest_N, std::fabs(reference.surge_N()));
    EXPECT_EQ(out.faults, 0u);
  }
  return errors;
}

struct Case {
  double rpm, tick_us;
  int modes;
  bool nested;
  double lift_um;  ///< bound of the lift's error: some twice of what is found, 0.03 of it the reference's own;
                   ///< of the force's: what is told at set-up
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.rpm << " rpm, " << c.tick_us << " us, " << c.modes; }
class CoupledSprings : public ::testing::TestWithParam<Case> {};

TEST_P(CoupledSprings, AreFollowedAsCloselyAsIsTold) {
  const Case& c = GetParam();
  const ValveTrain train = c.nested ? nested_train(c.modes) : surging_train(c.modes);
  SurgeOfValve surge;
  EXPECT_TRUE(accepted(surge_of(train.valve, c.tick_us * 1e-6, surge)));
  const Errors found = errors_over_a_turn<double>(train, c.rpm, c.tick_us);
  const double told_N = surge_error_ratio(surge, c.tick_us * 1e-6) * found.largest_N;
  std::printf("[ figures  ] %.0f rpm, %.0f us, %u modes: lift %.3f um, force %.3f N of %.1f N, told %.3f N\n", c.rpm,
              c.tick_us, surge.springs.modes, found.lift_um, found.force_N, found.largest_N, told_N);
  EXPECT_LT(found.lift_um, c.lift_um);
  EXPECT_LT(found.force_N, told_N);
  EXPECT_GT(found.largest_N, 90);
}
INSTANTIATE_TEST_SUITE_P(Ticks, CoupledSprings,
                         ::testing::Values(Case{6000, 10, 2, false, 0.05}, Case{6000, 20, 1, false, 0.05},
                                           Case{6000, 20, 2, false, 0.05}, Case{6000, 20, 3, false, 0.05},
                                           Case{6000, 20, 3, true, 0.05}, Case{6000, 50, 2, false, 0.16},
                                           Case{6000, 100, 2, false, 0.66}, Case{7200, 20, 2, false, 0.7},
                                           Case{7200, 20, 2, true, 0.05}),
                         [](const ::testing::TestParamInfo<Case>& at) {
                           return std::to_string(static_cast<int>(at.param.rpm)) + "rpm" +
                                  std::to_string(static_cast<int>(at.param.tick_us)) + "us" +
                                  std::to_string(at.param.modes) + (at.param.nested ? "Nested" : "Modes");
                         });

TEST(SpringStep, FollowsThemInFloat) {
  const Errors found = errors_over_a_turn<float>(nested_train(2), 6000, 20);
  std::printf("[ figures  ] in float: lift %.3f um, force %.3f N\n", found.lift_um, found.force_N);
  EXPECT_LT(found.lift_um, 0.04);
  EXPECT_LT(found.force_N, 0.4);
}

TEST(SpringStep, GainsAccuracyWithTheSquareOfTheTick) {
  const ValveTrain train = surging_train(2);
  const double at_100_us = errors_over_a_turn<double>(train, 6000, 100).force_N;
  const double at_50_us = errors_over_a_turn<double>(train, 6000, 50).force_N;
  EXPECT_NEAR(std::log2(at_100_us / at_50_us), 2, 0.3);
}

/// What valve, spring and modes hold, by the definition of a mode: M y'^2 / 2 + k y^2 / 2 + its share of the coils'
/// own.
template <class S>
double energy_J(Rig<double, S>& rig, const SurgeOfValve& surge) {
  const auto& state = rig.engine().state();
  const Valve& v = rig.train().valve;
  const double y = static_cast<double>(rig.valve().lift_m), speed = static_cast<double>(rig.valve().velocity_m_s);
  double energy = v.spring_N_m * y * y / 2 + v.seat_N_m * y * y / 2;
  // The coils at x/l move by y' x/l + sum q_n' sin(n pi x/l), and stretch likewise.
  double kinetic = (v.valve_kg + v.spring_kg / 3) * speed * speed / 2, stretch = 0;
  for (std::uint32_t n = 0; n < surge.springs.modes; ++n) {
    const double order = n + 1, sign = n % 2 == 0 ? 1 : -1;  // of the integral of x sin: (-1)^(n+1) / (n pi)
    const double q = state.spring_mode_m[n][0], q_m_s = state.spring_mode_m_s[n][0];
    kinetic += v.spring_kg * (q_m_s * q_m_s / 4 + speed * q_m_s * sign / (order * support::kPi));
    stretch += v.spring_N_m * order * order * support::kPi * support::kPi * q * q / 4;
  }
  return energy + kinetic + stretch;
}

TEST(SpringStep, MakesNoEnergyFromNothing) {
  // The crank stands, the valve lies on its seat, and its spring rings without any damping: ten million ticks.
  ValveTrain train = surging_train(3);
  train.valve.surge_damping_ratio = 0;
  train.valve.seat_damping_ratio = 0;
  train.valve.guide_damping_ratio = 0;
  train.rocker.clearance_m = 0.3e-3;
  Rig<double, Surging> rig(train, {20e-6, {}}, 90);
  SurgeOfValve surge;
  EXPECT_TRUE(accepted(surge_of(train.valve, 20e-6, surge)));
  auto state = rig.engine().state();
  for (std::size_t n = 0; n < 3; ++n) state.spring_mode_m[n][0] = 0.2e-3 / static_cast<double>((n + 1) * (n + 1));
  EXPECT_TRUE(accepted(rig.engine().restore(state)));
  // The steps follow one another, so that the sum of energies sways; but it does not rise.
  const auto most_over = [&](int ticks) {
    double most_J = 0;
    for (int i = 0; i < ticks; ++i) {
      rig.step(0);
      most_J = std::max(most_J, energy_J(rig, surge));
    }
    return most_J;
  };
  const double before_J = most_over(5'000'000);
  const double after_J = most_over(5'000'000);
  std::printf("[ figures  ] at most %.6e J in five million ticks, %.6f of it in five more\n", before_J,
              after_J / before_J);
  EXPECT_GT(before_J, 5e-3);
  EXPECT_LE(after_J, before_J);
  EXPECT_GT(after_J, 0.95 * before_J);
}

TEST(SpringStep, IsStillOnceTheSpringHasRungOut) {
  Rig<float, Surging> rig(surging_train(3), {100e-6, {}}, 90);
  for (int i = 0; i < 2 * rig.ticks_per_cycle(rad_s_of_rpm(6000)); ++i) rig.step(rad_s_of_rpm(6000));
  for (int i = 0; i < 60'000; ++i) rig.step(0);
  for (const auto& mode : rig.engine().state().spring_mode_m) EXPECT_EQ(mode[0], 0.0F);
  for (const auto& mode : rig.engine().state().spring_mode_m_s) EXPECT_EQ(mode[0], 0.0F);
}

TEST(SpringStep, ShowsPreloadAndRateWhereTheCamTurnsSlowly) {
  Rig<double, Surging> rig(surging_train(2), {100e-6, {}}, 330);
  const Valve& v = rig.train().valve;
  double highest_N = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto& out = rig.step(rad_s_of_rpm(20));
    const auto& spring = out.valve_spring[0][0];
    const double static_N = v.spring_preload_N + v.spring_N_m * out.valve[0][0].lift_m;
    EXPECT_NEAR(spring.moving_N, static_N + spring.surge_N, 1e-9);
    EXPECT_NEAR(spring.moving_N, static_N, 0.02 * static_N);
    EXPECT_NEAR(spring.fixed_N, static_N, 0.02 * static_N);
    highest_N = std::max(highest_N, spring.moving_N);
  }
  EXPECT_GT(highest_N, v.spring_preload_N + 0.9 * v.spring_N_m * lift_of(rig.train()).largest_lift_m());
}

/// The first mode pushes the coils from one end towards the other: what one end has more the other has less.
TEST(SpringStep, OfOneModePushesItsFixedEndByAsMuchLess) {
  Rig<double, Surging> rig(surging_train(1), {100e-6, {}}, 330);
  const Valve& v = rig.train().valve;
  double largest_N = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto& out = rig.step(rad_s_of_rpm(6000));
    const auto& spring = out.valve_spring[0][0];
    const double static_N = v.spring_preload_N + v.spring_N_m * out.valve[0][0].lift_m;
    ASSERT_NEAR(spring.fixed_N - static_N, -spring.surge_N, 1e-9 * static_N);
    largest_N = std::max(largest_N, std::fabs(spring.surge_N));
  }
  EXPECT_GT(largest_N, 1);
}

TEST(SpringStep, TellsOfTheSpringsThatATickIsTooLongFor) {
  TableStorage<float, Surging> storage;
  for (const double tick_s : {20e-6, 100e-6}) {
    SurgeOfValve surge;
    ASSERT_TRUE(accepted(surge_of(surging_train(2).valve, tick_s, surge)));
    TableReport report;
    ASSERT_TRUE(accepted(storage.build(engine_with(surging_train(2)), {tick_s, {}}, &report)));
    EXPECT_EQ(report.surge_error_ratio, surge_error_ratio(surge, tick_s));
    EXPECT_GT(report.surge_error_ratio, 0);
  }
}

TEST(SpringStep, OfAnActiveMassRingsAtItsFrequencyWhateverItsCoilsAtRestWeigh) {
  // Of a spring of 78 g 45 g move: pi n sqrt(c / m), and modes of 2 m / (pi n)^2.
  constexpr double kActive_kg = 45e-3;
  ValveTrain train = nested_train(2);
  train.valve.spring_kg = 96e-3;
  train.valve.spring_active_kg = kActive_kg;
  ASSERT_TRUE(accepted(validate(train.valve)));
  const double rate_N_m = train.valve.spring_N_m - 15e3;  // of the outer one
  const double kPi2 = support::kPi * support::kPi;
  const double outer_rad_s = 2 * support::kPi * std::sqrt(rate_N_m / kActive_kg);
  const double inner_rad_s = 2 * support::kPi * std::sqrt(15e3 / 18e-3);
  SurgeOfValve surge;
  ASSERT_TRUE(accepted(surge_of(train.valve, 20e-6, surge)));
  EXPECT_NEAR(surge.highest_rad_s, std::max(outer_rad_s, inner_rad_s), 1e-9 * outer_rad_s);
  EXPECT_NEAR(surge.moving_kg, 2 / kPi2 * (1 + 1.0 / 4) * (kActive_kg + 18e-3), 1e-15);
  SurgingSpring springs[2];
  ASSERT_EQ(springs_of(train.valve, springs), 2);
  EXPECT_NEAR(surge_frequency_rad_s(springs[0]), outer_rad_s / 2, 1e-9 * outer_rad_s);
  // Where none is given all of it moves.
  train.valve.spring_active_kg = 0;
  ASSERT_TRUE(accepted(surge_of(train.valve, 20e-6, surge)));
  EXPECT_NEAR(surge.moving_kg, 2 / kPi2 * (1 + 1.0 / 4) * 96e-3, 1e-15);
}

TEST(SpringStep, WithoutModesIsTheSpringThatFollows) {
  Rig<float, tick_test::OneValveWithGas> plain(ohc_125_train(), {20e-6, {}});
  Rig<float, SurgingWithGas> none(ohc_125_train(), {20e-6, {}});
  for (int i = 0; i < 3 * plain.ticks_per_cycle(rad_s_of_rpm(9000)); ++i) {
    const auto& a = plain.step(rad_s_of_rpm(9000)).valve_forces[0][0];
    const auto& b = none.step(rad_s_of_rpm(9000)).valve_forces[0][0];
    ASSERT_EQ(plain.valve().lift_m, none.valve().lift_m);
    ASSERT_EQ(plain.valve().velocity_m_s, none.valve().velocity_m_s);
    ASSERT_EQ(a.train_N, b.train_N);
    ASSERT_EQ(plain.regime(), none.regime());
  }
}

TEST(SpringStep, RefusesATrainThatTheSceneCannotStep) {
  const auto refusal_of = [](auto scene, const ValveTrain& train, double tick_s) {
    using S = decltype(scene);
    const auto tables = std::make_unique<TableStorage<double, S>>();
    const Status status = tables->build(engine_with(train), {tick_s, {}});
    if (!status.ok()) return status;
    return Engine<double, S>{}.init(tables->tables());
  };
  EXPECT_TRUE(
      refuses(refusal_of(tick_test::OneValve{}, surging_train(1), 20e-6), Reason::inconsistent, "scene.spring_modes"));
  EXPECT_TRUE(
      refuses(refusal_of(SurgingALittle{}, surging_train(2), 20e-6), Reason::inconsistent, "scene.spring_modes"));
  EXPECT_TRUE(
      refuses(refusal_of(SurgingALittle{}, nested_train(1), 20e-6), Reason::inconsistent, "scene.spring_modes"));
  EXPECT_TRUE(accepted(refusal_of(SurgingALittle{}, surging_train(1), 20e-6)));
  // Beyond a radian of the highest mode, and where a stiff seat would feed a heavy spring.
  EXPECT_TRUE(refuses(refusal_of(Surging{}, surging_train(3), 150e-6), Reason::unstable, "valve.surge_modes", 0));
  ValveTrain undamped = surging_train(2);
  undamped.valve.surge_damping_ratio = undamped.valve.seat_damping_ratio = undamped.valve.guide_damping_ratio = 0;
  EXPECT_TRUE(refuses(refusal_of(Surging{}, undamped, 50e-6), Reason::unstable, "valve.surge_modes", 0));
  EXPECT_TRUE(accepted(refusal_of(Surging{}, undamped, 10e-6)));
}

TEST(SpringStep, RefusesSpringsThatCannotBe) {
  const auto refusal_of = [](auto change) {
    Valve valve = nested_train(2).valve;
    change(valve);
    return validate(valve);
  };
  EXPECT_TRUE(accepted(refusal_of([](Valve&) {})));
  EXPECT_TRUE(refuses(refusal_of([](Valve& v) { v.surge_modes = 4; }), Reason::out_of_range, "valve.surge_modes"));
  EXPECT_TRUE(refuses(refusal_of([](Valve& v) { v.surge_modes = -1; }), Reason::out_of_range, "valve.surge_modes"));
  EXPECT_TRUE(refuses(refusal_of([](Valve& v) { v.surge_damping_ratio = 1; }), Reason::out_of_range,
                      "valve.surge_damping_ratio"));
  EXPECT_TRUE(refuses(refusal_of([](Valve& v) { v.spring_N_m = 0; }), Reason::not_positive, "valve.spring_N_m"));
  EXPECT_TRUE(refuses(refusal_of([](Valve& v) { v.spring_kg = 0; }), Reason::not_positive, "valve.spring_kg"));
  EXPECT_TRUE(
      refuses(refusal_of([](Valve& v) { v.inner_spring_kg = 0; }), Reason::inconsistent, "valve.inner_spring_N_m"));
  EXPECT_TRUE(refuses(refusal_of([](Valve& v) { v.inner_spring_N_m = v.spring_N_m; }), Reason::inconsistent,
                      "valve.inner_spring_N_m"));
  EXPECT_TRUE(refuses(refusal_of([](Valve& v) { v.inner_spring_kg = v.spring_kg; }), Reason::inconsistent,
                      "valve.inner_spring_kg"));
  EXPECT_TRUE(
      refuses(refusal_of([](Valve& v) { v.spring_active_kg = 0.05; }), Reason::inconsistent, "valve.spring_active_kg"));
  EXPECT_TRUE(
      accepted(refusal_of([](Valve& v) { v.surge_modes = 0, v.spring_active_kg = 0.05, v.inner_spring_kg = 1; })));
}

}  // namespace
}  // namespace crankloop::spring_step_test
