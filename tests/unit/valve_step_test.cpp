// A valve's step: its matrix against the textbook and against the exact solution, contacts, frequencies, energy, step
// lengths, size of the state.
#include <crankloop/output.hpp>
#include <crankloop/tabulate/valve_motion.hpp>
#include <crankloop/tick/valve/valve_access.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "crankloop/loops/textbook_valve.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"

namespace crankloop::valve_step_test {

using namespace detail;
namespace {

using namespace valve_test;
using support::Random;
using support::refuses;
using tick_test::BothReals;
using tick_test::RealName;

/// Drawn evenly over the decades.
double logarithmic(Random& random, double low, double high) { return low * std::pow(high / low, random.between(0, 1)); }

/// The cam over a step: at its ends, and by the cubic Hermite formulas of any handbook between them.
struct CamStep {
  Lift<double> from, to;
  double deg;

  struct At {
    double lift_m, slope_m;  ///< slope by the part of the step
  };
  [[nodiscard]] At at(double x) const {
    const double p0 = from.lift_m, p1 = to.lift_m, m0 = deg * from.per_deg_m, m1 = deg * to.per_deg_m;
    return {
        (2 * x * x * x - 3 * x * x + 1) * p0 + (x * x * x - 2 * x * x + x) * m0 + (3 * x * x - 2 * x * x * x) * p1 +
            (x * x * x - x * x) * m1,
        (6 * x * x - 6 * x) * p0 + (3 * x * x - 4 * x + 1) * m0 + (6 * x - 6 * x * x) * p1 + (3 * x * x - 2 * x) * m1};
  }
};

CamStep cam_step_at(const ValveLift& lift, double deg, double turned_deg) {
  const auto at = [&](double cam_deg) {
    const LiftPose pose = lift.at(cam_deg * kRadPerDeg);
    return Lift<double>{pose.lift_m, pose.per_rad_m * kRadPerDeg};
  };
  return {at(deg), at(deg + turned_deg), turned_deg};
}

/// The textbook's four stages in one regime, n times over the step [Li 2017, 4.9-4.13]; the gas force rises evenly.
ValveState<double> textbook(const ValveBody<double>& b, std::uint32_t regime, double step_s, int n,
                            ValveState<double> s, const CamStep& cam, const detail::GasForce<double>& gas) {
  const auto f = [&](double x, double y, double v) {
    double force = -b.spring_N_m * y - b.preload_N - b.guide_Ns_m * v - (gas.from_N + x * (gas.to_N - gas.from_N));
    const CamStep::At c = cam.at(x);
    if ((regime & kTrainOn) != 0) force += b.train_N_m * (c.lift_m - y) + b.train_Ns_m * (c.slope_m / step_s - v);
    if ((regime & kSeatOn) != 0) force += b.seat_N_m * (b.preload_N / b.seat_N_m - y) - b.seat_Ns_m * v;
    return force / b.mass_kg;
  };
  const double d = step_s / n;
  for (int i = 0; i < n; ++i) {
    s = program::textbook_step([&](int half, double y, double v) { return f((i + 0.5 * half) / n, y, v); }, d, s);
  }
  return s;
}

/// Force that does not depend on the motion: a preloaded seat carries the spring's preload.
double constant_force_N(const ValveBody<double>& body, std::uint32_t regime, double gas_N) {
  return (regime & kSeatOn) != 0 ? -gas_N : -body.preload_N - gas_N;
}

/// A step somewhere in a cycle, near where its regime lives: about the lift, or about the seat.
struct DrawnStep {
  CamStep cam;
  ValveState<double> before;
  detail::GasForce<double> gas;

  DrawnStep(const ValveLift& lift, std::uint32_t regime, Random& random)
      : cam{cam_step_at(lift, random.between(-60, 60), random.between(-0.5, 0.5))},
        before{((regime & kSeatOn) != 0 ? 0 : cam.from.lift_m) + random.between(-50e-6, 50e-6), random.between(-8, 8)},
        gas{random.between(-50, 400), random.between(-50, 400)} {}
};

TEST(ValveRecord, IsSoManyTextbookStepsMultipliedOutInEveryRegime) {
  const ValveTrain train = ohc_125_train();
  const ValveLift lift = lift_of(train);
  const ValveBody<double> body = body_of(train);
  const double fastest = SingleMass(train.valve, train.rocker, lift.largest_lift_m()).fastest();
  Random random;
  double worst = 0;
  for (const double tick_s : {1e-6, 5e-6, 20e-6, 100e-6, 400e-6}) {
    const ValveMotion<double> motion = motion_for(body, tick_s);
    for (int draw = 0; draw < 2'000; ++draw) {
      const std::uint32_t regime = static_cast<std::uint32_t>(random.whole(0, 3));
      const DrawnStep step(lift, regime, random);
      for (const bool whole : {false, true}) {
        const double step_s = whole ? tick_s : motion.fine_step_s;
        const int n = static_cast<int>(std::ceil(step_s * fastest / 0.1 * (1 - 1e-12)));  // rate times step at most 0.1
        const RegimeStep<double>& record = (whole ? motion.whole : motion.fine)[regime];
        const ValveState<double> by_record =
            detail::stepped(record, step.before, step.cam.from, step.cam.to, step.cam.deg, step.gas).state;
        const ValveState<double> by_stages = textbook(body, regime, step_s, n, step.before, step.cam, step.gas);
        // Relative to what is added up: a state, what drives it, and what a step makes of them.
        const double w = std::sqrt((body.train_N_m + body.seat_N_m) / body.mass_kg);
        const double size =
            std::fabs(step.before.lift_m) + std::fabs(step.cam.from.lift_m) + std::fabs(step.before.velocity_m_s) / w;
        worst = std::max(worst, std::fabs(by_record.lift_m - by_stages.lift_m) / size);
        worst = std::max(worst, std::fabs(by_record.velocity_m_s - by_stages.velocity_m_s) / (size * w));
      }
    }
  }
  std::printf("[ figures  ] record against textbook steps: %.1e of the state\n", worst);
  EXPECT_LT(worst, 1e-12);
}

TEST(ValveRecord, OfTheExponentialIsTheExactSolutionForTheCubicLift) {
  const ValveTrain train = ohc_125_train();
  const ValveLift lift = lift_of(train);
  const ValveBody<double> body = body_of(train);
  const double d = 20e-6;
  const ValveMotion<double> motion = motion_for(body, d, Integrator::exponential);
  ASSERT_EQ(motion.parts, 1u);
  // Power series of the solution of M y'' + C y' + K y = F + k Y + b Y' with Y a polynomial, in long double, term by
  // term until nothing is added: one series over all of the step.
  using Long = long double;
  const auto wide = [](double x) { return static_cast<Long>(x); };
  Random random;
  for (int draw = 0; draw < 400; ++draw) {
    const std::uint32_t regime = static_cast<std::uint32_t>(draw % 4);
    const DrawnStep step(lift, regime, random);
    const CamStep& cam = step.cam;
    const double rise = cam.to.lift_m - cam.from.lift_m, m0 = cam.deg * cam.from.per_deg_m,
                 m1 = cam.deg * cam.to.per_deg_m;
    const Long within[] = {wide(cam.from.lift_m), wide(m0), wide(3 * rise - 2 * m0 - m1), wide(m0 + m1 - 2 * rise)};
    const Long h = wide(d);
    const Long M = wide(body.mass_kg);
    const bool on_train = (regime & kTrainOn) != 0;
    const bool on_seat = (regime & kSeatOn) != 0;
    const Long K = wide(body.spring_N_m + (on_train ? body.train_N_m : 0) + (on_seat ? body.seat_N_m : 0));
    const Long C = wide(body.guide_Ns_m + (on_train ? body.train_Ns_m : 0) + (on_seat ? body.seat_Ns_m : 0));
    Long term[60];
    term[0] = wide(step.before.lift_m);
    term[1] = wide(step.before.velocity_m_s) * h;
    Long y = term[0] + term[1];
    Long v = term[1];
    for (int n = 0; n < 58; ++n) {
      Long drive = n == 0 ? wide(constant_force_N(body, regime, step.gas.from_N)) : 0;
      if (n == 1) drive -= wide(step.gas.to_N - step.gas.from_N);
      if (on_train && n < 4) drive += wide(body.train_N_m) * within[n];
      if (on_train && n < 3) drive += wide(body.train_Ns_m) / h * (n + 1) * within[n + 1];
      term[n + 2] = (drive * h * h - K * h * h * term[n] - C * h * (n + 1) * term[n + 1]) / (M * (n + 1) * (n + 2));
      y += term[n + 2];
      v += (n + 2) * term[n + 2];
    }
    const ValveState<double> after =
        detail::stepped(motion.fine[regime], step.before, cam.from, cam.to, cam.deg, step.gas).state;
    const double w = std::sqrt(static_cast<double>(K / M));
    const double size =
        std::fabs(step.before.lift_m) + std::fabs(cam.from.lift_m) + std::fabs(step.before.velocity_m_s) / w;
    EXPECT_NEAR(after.lift_m, static_cast<double>(y), 1e-13 * size)
        << "regime " << regime << ", " << random.trace(draw);
    EXPECT_NEAR(after.velocity_m_s, static_cast<double>(v / h), 1e-13 * size * w)
        << "regime " << regime << ", " << random.trace(draw);
  }
}

TEST(ValveRecord, HasTheForcesOfItsRegimeOverTheMass) {
  const ValveTrain train = ohc_125_train();
  const ValveLift lift = lift_of(train);
  const ValveBody<double> b = body_of(train);
  const ValveMotion<double> motion = motion_for(b, 100e-6);
  Random random;
  for (int draw = 0; draw < 1000; ++draw) {
    const std::uint32_t regime = static_cast<std::uint32_t>(random.whole(0, 3));
    const DrawnStep step(lift, regime, random);
    const double gap = step.cam.to.lift_m - step.before.lift_m, gap_speed = random.between(-5, 5);
    const double train_N = b.train_N_m * gap + b.train_Ns_m * gap_speed;
    const double seat_N =
        b.seat_N_m * (b.seat_compression_m - step.before.lift_m) - b.seat_Ns_m * step.before.velocity_m_s;
    double force_N =
        -b.spring_N_m * step.before.lift_m - b.preload_N - b.guide_Ns_m * step.before.velocity_m_s - step.gas.to_N;
    if ((regime & kTrainOn) != 0) force_N += train_N;
    if ((regime & kSeatOn) != 0) force_N += seat_N;
    const double of_forces = std::fabs(train_N) + std::fabs(seat_N) + 1000;
    EXPECT_NEAR(detail::acceleration(motion.fine[regime].acceleration, step.before, gap, gap_speed, step.gas),
                force_N / b.mass_kg, 1e-14 * of_forces / b.mass_kg);
  }
}

TEST(ValveRecord, WhoseGuardsHoldAtBothEndsHasNoContactThatChangesBetween) {
  // By the exact motion, looked at in a hundred places of each step: where the step is long, where a contact is near,
  // at all speeds of the cam.
  const ValveTrain train = ohc_125_train();
  const ValveLift lift = lift_of(train);
  const ValveBody<double> body = body_of(train);
  Random random;
  int sure = 0;
  int near = 0;
  for (const double tick_s : {5e-6, 20e-6, 100e-6}) {
    const ValveMotion<double> motion = motion_for(body, tick_s, Integrator::exponential);
    for (int draw = 0; draw < 30'000; ++draw) {
      const std::uint32_t regime = static_cast<std::uint32_t>(random.whole(0, 3));
      const double speed_deg_s = random.between(-36000, 36000);
      const CamStep cam = cam_step_at(lift, random.between(-80, 80), speed_deg_s * tick_s);
      const double scale_m = std::pow(10, random.between(-7, -4));
      const double place_m = (regime & kTrainOn) != 0  ? cam.from.lift_m
                             : (regime & kSeatOn) != 0 ? 0
                                                       : std::max(0.0, cam.from.lift_m);
      const ValveState<double> before{
          place_m + random.between(-scale_m, scale_m),
          speed_deg_s * cam.from.per_deg_m * random.whole(0, 1) + random.between(-1, 1) * scale_m * 4e4};
      const RegimeStep<double>& record = motion.whole[regime];
      const auto holds = [&](const ValveState<double>& s, const Lift<double>& at) {
        return detail::passes(record.train, at.lift_m - s.lift_m, speed_deg_s * at.per_deg_m - s.velocity_m_s) &&
               detail::passes(record.seat, s.lift_m, s.velocity_m_s);
      };
      const ValveState<double> after =
          detail::stepped(record, before, cam.from, cam.to, cam.deg, detail::NoGasForce<double>{}).state;
      if (!holds(before, cam.from) || !holds(after, cam.to)) continue;
      ++sure;
      const double rise = cam.to.lift_m - cam.from.lift_m;
      const StepDrive drive{cam.from.lift_m,
                            rise,
                            cam.deg * cam.from.per_deg_m,
                            cam.deg * cam.to.per_deg_m,
                            constant_force_N(body, regime, 0),
                            0};
      double least_compression_m = 1;
      for (int i = 0; i <= 100; ++i) {
        const double x = i / 100.0;
        // The exact motion up to a place: the same cubic over the shorter step.
        const StepDrive::Piece there = drive.about(x);
        const StepDrive part{
            cam.from.lift_m, there.c[0] - cam.from.lift_m, drive.from_m * x, there.c[1] * x, drive.force_N, 0};
        const ValveState<double> s = i == 0 ? before : exact_motion(body, regime, tick_s * x, before, part);
        const CamStep::At at = cam.at(x);
        least_compression_m = std::min(
            {least_compression_m, std::fabs(at.lift_m - s.lift_m), std::fabs(body.seat_compression_m - s.lift_m)});
        ASSERT_EQ(detail::required_contacts(motion, s, Lift<double>{at.lift_m, at.slope_m / cam.deg}, speed_deg_s),
                  regime)
            << random.trace(draw) << ", tick " << tick_s << ", at " << x;
      }
      near += least_compression_m < 1e-6 ? 1 : 0;
    }
  }
  std::printf("[ figures  ] %d steps with sure contacts, %d of them within a micrometre of a change\n", sure, near);
  EXPECT_GT(sure, 4'000);
  EXPECT_GT(near, 100);
}

TEST(ValveBody, IsThePrintedFormulasOfItsDefinition) {
  for (const double inertia_kg_m2 : {8.12e-6, 0.0}) {
    ValveTrain train = ohc_125_train();
    train.valve.rocker_inertia_kg_m2 = inertia_kg_m2;
    const ValveLift lift = lift_of(train);
    const SingleMass mass(train.valve, train.rocker, lift.largest_lift_m());
    const ValveBody<double> body = body_of(train);
    EXPECT_NEAR(body.mass_kg, mass.M, 1e-14);
    EXPECT_NEAR(body.rocker_mass_kg, mass.rocker_kg, 1e-14);
    EXPECT_NEAR(body.train_Ns_m, mass.b, 1e-11);
    EXPECT_NEAR(body.seat_Ns_m, mass.b_z, 1e-11);
    EXPECT_NEAR(body.guide_Ns_m, mass.c, 1e-13);
    EXPECT_DOUBLE_EQ(body.seat_compression_m, 205.8 / 1e8);
  }
}

TEST(ValveBody, OfTheOneTwentyFiveHasTheMassThatItsDescriptionImplies) {
  // 33 g, a third of 60 g, and 8.12 kg mm^2 on the mean lever of a ball that travels from 20.6 deg above the pivot to
  // 7.1 deg above it.
  EXPECT_NEAR(body_of(ohc_125_train()).mass_kg, 0.033 + 0.020 + 0.00787, 2e-5);
}

/// Time of n whole swings of an undamped valve that touches the train, the seat or both all the time, counted on the
/// matrix's own steps.
double swing_s(const ValveMotion<double>& motion, std::uint32_t regime, int swings) {
  const ValveBody<double>& b = motion.body;
  const double stiffness =
      b.spring_N_m + ((regime & kTrainOn) != 0 ? b.train_N_m : 0) + ((regime & kSeatOn) != 0 ? b.seat_N_m : 0);
  const double rest_m = constant_force_N(b, regime, 0.0) / stiffness;
  ValveState<double> s{rest_m - 1e-6, 0};
  int upward = 0;
  double first = 0;
  for (int i = 1;; ++i) {
    const ValveState<double> next =
        detail::stepped(motion.fine[regime], s, Lift<double>{}, Lift<double>{}, 0.0, detail::NoGasForce<double>{})
            .state;
    if (s.lift_m < rest_m && next.lift_m >= rest_m) {
      const double at = i - (next.lift_m - rest_m) / (next.lift_m - s.lift_m);  // near the crossing a sine is straight
      if (upward == 0) first = at;
      if (upward++ == swings) return (at - first) * motion.fine_step_s / swings;
    }
    s = next;
  }
}

TEST(ValveBody, SwingsAtItsNaturalFrequencies) {
  ValveTrain train = ohc_125_train();
  train.valve.train_damping_ratio = train.valve.guide_damping_ratio = train.valve.seat_damping_ratio = 0;
  const ValveBody<double> body = body_of(train);
  const ValveMotion<double> motion = motion_for(body, 1e-6, Integrator::exponential);
  EXPECT_NEAR(swing_s(motion, kTrainOn, 1000), 2 * kPi / open_frequency_rad_s(body),
              1e-9 * swing_s(motion, kTrainOn, 10));
  EXPECT_NEAR(swing_s(motion, kTrainOn | kSeatOn, 1000), 2 * kPi / seated_frequency_rad_s(body),
              1e-8 * swing_s(motion, 3, 10));
  EXPECT_NEAR(open_frequency_rad_s(body) / (2 * kPi), 2216, 1);     // Hz: 11.805 kN/mm on 60.87 g
  EXPECT_NEAR(seated_frequency_rad_s(body) / (2 * kPi), 6820, 10);  // Hz: 111.8 kN/mm
}

TEST(Contacts, HoldOnlyWhileBothTheGapAndTheForceArePositive) {
  ValveBody<double> b{};
  b.train_N_m = 1e7, b.train_Ns_m = 100, b.seat_N_m = 1e8, b.seat_Ns_m = 500, b.preload_N = 200,
  b.seat_compression_m = 2e-6, b.mass_kg = 0.06;
  const ValveMotion<double> motion = motion_for(b, 20e-6);
  const auto regime = [&](double y, double v, double Y, double Yd) {
    return detail::required_contacts(motion, ValveState<double>{y, v}, Lift<double>{Y, Yd}, 1.0);
  };
  EXPECT_EQ(regime(0, 0, -50e-6, 0), kSeatOn) << "closed, lash open";
  EXPECT_EQ(regime(0, 0, 1e-6, 0), kSeatOn | kTrainOn) << "the train presses";
  EXPECT_EQ(regime(3e-3, 0, 3.01e-3, 0), kTrainOn) << "lifted";
  EXPECT_EQ(regime(3e-3, 2, 3.01e-3, 0), 0u)
      << "pressed by 10 um, 100 N, but leaving at 2 m/s: the damper would have to pull";
  EXPECT_EQ(regime(3.01e-3, -2, 3e-3, 0), 0u) << "the damper would push, but there is a gap";
  EXPECT_EQ(regime(1e-6, 1, -50e-6, 0), 0u) << "in the seat but leaving faster than it springs back: no adhesion";
  EXPECT_EQ(regime(3e-6, -1, -50e-6, 0), 0u) << "coming down, not there yet";
  EXPECT_EQ(regime(2e-6, 0, -50e-6, 0), 0u) << "at the very end of the seat's spring there is no force";
}

TEST(Contacts, PushAndNeverPull) {
  ValveBody<double> b{};
  b.train_N_m = 1e7, b.train_Ns_m = 100, b.seat_N_m = 1e8, b.seat_Ns_m = 500, b.preload_N = 200;
  EXPECT_NEAR(detail::train_force_N(b, kTrainOn, 3e-5, -1.0), 300 - 100, 1e-9);
  EXPECT_EQ(detail::train_force_N(b, kTrainOn, 3e-5, -4.0), 0) << "its damper would hold it back by 100 N";
  EXPECT_EQ(detail::train_force_N(b, kSeatOn, 3e-5, -1.0), 0) << "not in contact";
  const auto on_seat_N = [&b](double y, double v) {
    ValveForcesOutput<double> shown{};
    detail::write_seat_forces(shown, b, ValveState<double>{y, v}, {});
    EXPECT_EQ(shown.train_N, 0);
    EXPECT_EQ(shown.regime, kSeatOn);
    return shown.seat_N;
  };
  EXPECT_NEAR(on_seat_N(-1e-6, -0.1), 200 + 100 + 50, 1e-9) << "pressed in, and going deeper";
  EXPECT_EQ(on_seat_N(1e-6, 0.3), 0) << "100 N are left of the spring's, of which its damper takes 150";
}

/// A valve between its cam and its seat goes along with the cam by the stiffnesses alone: as the places do where it
/// would rest under a cam that stands a little lower, and a little higher.
TEST(ValveOnItsCam, MovesInItsSeatAsItsPlacesOfRestDo) {
  const ValveMotion<double> motion = motion_for(body_of(ohc_125_train()), 10e-6);
  const auto rest_at = [&motion](double cam_m) { return detail::in_equilibrium(motion, cam_m, 0.0); };
  for (const double cam_m : {2e-6, 8e-6, 15e-6}) {
    const auto resting = rest_at(cam_m);
    ASSERT_EQ(resting.regime, kTrainOn | kSeatOn) << cam_m;
    const double per_cam = (rest_at(cam_m + 1e-7).state.lift_m - rest_at(cam_m - 1e-7).state.lift_m) / 2e-7;
    ASSERT_GT(per_cam, 0.01);
    for (const double deg_per_s : {3000.0, -3000.0}) {
      const Lift<double> cam{cam_m, 1e-7};
      const auto carried = detail::carried_along(motion, resting, cam, 1e-6, deg_per_s);
      EXPECT_EQ(carried.state.lift_m, resting.state.lift_m) << "no inertia bends it there";
      EXPECT_NEAR(carried.state.velocity_m_s, per_cam * deg_per_s * cam.per_deg_m, 1e-6 * 3e-4);
      EXPECT_EQ(carried.regime, kTrainOn | kSeatOn);
    }
  }
}

TEST(ValveStepping, RefusesWhatItCannotStepAndNamesTheLongestTick) {
  const ValveBody<double> body = body_of(ohc_125_train());
  ValveMotion<double> motion{};
  for (const double accuracy_m : {0.009e-6, 11e-6, 0.0, -1e-6, std::nan(""), HUGE_VAL}) {
    EXPECT_TRUE(refuses(motion_of(body, 100e-6, {Integrator::rk4, accuracy_m}, motion), Reason::out_of_range,
                        "options.valves.accuracy_m"))
        << accuracy_m;
  }
  for (const int number : {2, 3, 255}) {
    const ValveStepping unknown{static_cast<Integrator>(number), 0.1e-6};
    EXPECT_TRUE(refuses(motion_of(body, 100e-6, unknown, motion), Reason::out_of_range, "options.valves.integrator"))
        << number;
  }
  for (const double tick_s : {0.0, -1e-6, std::nan("")}) {
    EXPECT_TRUE(refuses(motion_of(body, tick_s, {}, motion), Reason::out_of_range, "options.tick_s")) << tick_s;
  }
  ValveBody<double> boulder = body;
  for (const double mass_kg : {1.1e9, HUGE_VAL, std::nan("")}) {
    boulder.mass_kg = mass_kg;
    EXPECT_TRUE(refuses(motion_of(boulder, 100e-6, {}, motion), Reason::out_of_range, "valve.rocker_inertia_kg_m2"))
        << mass_kg;
  }
  Random random;
  for (int draw = 0; draw < 30; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    ValveBody<double> b = body;
    b.mass_kg *= std::pow(10, random.between(-2, 1));
    b.train_N_m *= std::pow(10, random.between(-1, 1));
    b.seat_N_m *= std::pow(10, random.between(-2, 2));
    b.seat_Ns_m *= std::pow(10, random.between(-2, 1.5));
    const ValveStepping stepping{Integrator::rk4, 0.01e-6 * std::pow(10, random.between(0, 3))};
    const double longest = longest_tick_s(b, stepping);
    EXPECT_TRUE(accepted(motion_of(b, longest * 0.999999, stepping, motion)));
    EXPECT_LE(motion.parts, static_cast<std::uint32_t>(kMaxFineSteps));
    if (longest < 0.9) {
      EXPECT_TRUE(refuses(motion_of(b, longest * 1.000001, stepping, motion), Reason::out_of_range, "options.tick_s"));
      EXPECT_TRUE(refuses(motion_of(b, longest * 4, stepping, motion), Reason::out_of_range, "options.tick_s"));
    }
    // Monotone: what is accepted at a tick is accepted at every shorter one.
    for (int i = 0; i < 4; ++i) {
      EXPECT_TRUE(accepted(motion_of(b, longest * random.between(1e-3, 0.999), stepping, motion)));
      EXPECT_NEAR(motion.parts * motion.fine_step_s, motion.tick_s, 1e-15);
    }
  }
}

// ---- energy
// ----------------------------------------------------------------------------------------------------------------

/// 10^7 steps, or 10^8 when long tests are asked for.
long energy_steps() { return std::getenv("CRANKLOOP_LONG_TESTS") != nullptr ? 100'000'000 : 10'000'000; }

template <class Real>
ValveMotion<Real> in_real(const ValveMotion<double>& motion) {
  if constexpr (sizeof(Real) == 4) {
    return rounded(motion);
  } else {
    return motion;
  }
}

/// Energy of a valve that swings about its rest in a regime, lift constant.
double energy_J(const ValveBody<double>& b, std::uint32_t regime, double rest_m, double y, double v) {
  const double stiffness =
      b.spring_N_m + ((regime & kTrainOn) != 0 ? b.train_N_m : 0) + ((regime & kSeatOn) != 0 ? b.seat_N_m : 0);
  return b.mass_kg * v * v / 2 + stiffness * (y - rest_m) * (y - rest_m) / 2;
}

/// Largest growth of energy, relative to the first, over many steps.
template <class Real>
double energy_growth(const ValveBody<double>& body, std::uint32_t regime, double step_s, Integrator integrator,
                     long steps) {
  const ValveMotion<double> motion = motion_for(body, step_s, integrator);
  const RegimeStep<Real> record = in_real<Real>(motion).whole[regime];
  const bool on_train = (regime & kTrainOn) != 0;
  const double stiffness =
      body.spring_N_m + (on_train ? body.train_N_m : 0) + ((regime & kSeatOn) != 0 ? body.seat_N_m : 0);
  const Real level_m = on_train ? static_cast<Real>(5e-3) : Real{0};
  const Lift<Real> lift{level_m, Real{0}};
  const double force_N = constant_force_N(body, regime, 0.0);
  const double rest_m = (force_N + (on_train ? body.train_N_m * static_cast<double>(level_m) : 0)) / stiffness;
  ValveState<Real> s{static_cast<Real>(rest_m + 1e-3), Real{0}};
  const double first = energy_J(body, regime, rest_m, static_cast<double>(s.lift_m), 0);
  double largest = 0;
  for (long i = 0; i < steps; ++i) {
    s = detail::stepped(record, s, lift, lift, Real{0}, detail::NoGasForce<Real>{}).state;
    if (i % 997 == 0)
      largest = std::max(
          largest, energy_J(body, regime, rest_m, static_cast<double>(s.lift_m), static_cast<double>(s.velocity_m_s)));
  }
  return largest / first - 1;
}

template <class Real>
class ValveEnergy : public ::testing::Test {};
TYPED_TEST_SUITE(ValveEnergy, BothReals, RealName);

TYPED_TEST(ValveEnergy, OfAnUndampedValveDoesNotGrow) {
  using Real = TypeParam;
  ValveTrain train = ohc_125_train();
  train.valve.train_damping_ratio = train.valve.guide_damping_ratio = train.valve.seat_damping_ratio = 0;
  const ValveBody<double> body = body_of(train);
  const double bound = sizeof(Real) == 4 ? 1e-3 : 1e-9;
  for (const Integrator integrator : {Integrator::rk4, Integrator::exponential}) {
    for (const std::uint32_t regime : {0u, kTrainOn}) {
      for (const double step_s : {3e-6, 7e-6}) {
        const double growth = energy_growth<Real>(body, regime, step_s, integrator, energy_steps());
        std::printf("[ figures  ] %s, %s, regime %u, %.0f us: energy grows by %+.1e\n",
                    sizeof(Real) == 4 ? "float" : "double", integrator == Integrator::rk4 ? "rk4" : "exponential",
                    regime, step_s * 1e6, growth);
        EXPECT_LE(growth, bound) << "regime " << regime << ", " << step_s << " s";
      }
    }
  }
}

TEST(ValveCalm, NeverFailsAGuardHoweverItSwings) {
  // On its seat, its cam on the base circle: a swing below decoupled_m, from any place and speed that it may have,
  // through many ticks of exact motion.
  Random random;
  int swings = 0;
  for (int draw = 0; draw < 400; ++draw) {
    ValveTrain train = ohc_125_train();
    train.valve.valve_kg = logarithmic(random, 0.01, 0.5);
    train.valve.seat_N_m = logarithmic(random, 1e6, 1e9);
    train.valve.seat_damping_ratio = random.between(0, 1);
    train.valve.spring_preload_N = logarithmic(random, 1, 1000);
    const double lash_m = random.coin() ? logarithmic(random, 1e-8, 1e-3) : 0;
    const double tick_s = logarithmic(random, 1e-6, 5e-4);
    ValveMotion<double> motion{};
    const ValveBody<double> body = body_of(train);
    if (!motion_of(body, tick_s, {}, motion).ok()) continue;
    find_decoupled(motion, lash_m);
    const Lift<double> cam{-lash_m, 0};
    for (const std::uint32_t regime : {0u, kTrainOn, kTrainOn | kSeatOn})
      EXPECT_EQ(motion.whole[regime].decoupled_m, 0);
    for (const std::uint32_t regime : {kSeatOn, kQuiet}) {
      const RegimeStep<double>& step = motion.whole[regime];
      if (step.decoupled_m == 0) continue;
      ++swings;
      const double share = random.between(-1, 1);
      const double sign = random.coin() ? 1 : -1;
      ValveState<double> s{share * step.decoupled_m,
                           sign * (1 - std::fabs(share)) * step.decoupled_m / motion.per_seat_rate_s};
      for (int tick = 0; tick < 200; ++tick) {
        s = exact_motion(body, kSeatOn, tick_s, s, {});
        ASSERT_TRUE(detail::passes(step.train, cam.lift_m - s.lift_m, -s.velocity_m_s))
            << random.trace(draw) << ", regime " << regime;
        ASSERT_TRUE(detail::passes(step.seat, s.lift_m, s.velocity_m_s)) << random.trace(draw) << ", regime " << regime;
        ASSERT_EQ(detail::required_contacts(motion, s, cam, 0.0), kSeatOn) << random.trace(draw);
      }
    }
  }
  EXPECT_GT(swings, 100);
}

TEST(ValveCalm, HasThePlainStepsBitsWithoutItsCam) {
  // What a short step leaves out are products with 0: the cam's rise, its slopes and the gap.
  const auto in_float = std::make_unique<ValveMotion<float>>(rounded(motion_for(body_of(ohc_125_train()), 20e-6)));
  const RegimeStep<float>& step = in_float->whole[kSeatOn];
  EXPECT_EQ(step.lift.rest, 0);
  for (const StepRow<float>* row : {&step.lift, &step.velocity}) {
    EXPECT_EQ(row->gap, 0);
    EXPECT_EQ(row->rise, 0);
    EXPECT_EQ(row->from, 0);
    EXPECT_EQ(row->to, 0);
  }
  EXPECT_EQ(step.acceleration.gap, 0);
  EXPECT_EQ(step.acceleration.gap_speed, 0);
}

TEST(ValveRounding, ToFloatMakesNoStepGrow) {
  // What a step makes of (y, v) must have a determinant of at most 1, whatever the train: else an undamped valve gains
  // energy.
  Random random;
  int at_one = 0;
  for (int draw = 0; draw < 300; ++draw) {
    ValveTrain train = ohc_125_train();
    train.valve.valve_kg = logarithmic(random, 0.01, 0.5);
    if (draw % 3 == 0) train.valve.spring_N_m = draw % 2 == 0 ? 0 : logarithmic(random, 1e-9, 1);
    train.valve.train_N_m = logarithmic(random, 1e6, 1e9);
    train.valve.seat_N_m = logarithmic(random, 1e6, 1e9);
    train.valve.train_damping_ratio = train.valve.guide_damping_ratio = train.valve.seat_damping_ratio = 0;
    ValveMotion<double> motion{};
    if (!motion_of(body_of(train), logarithmic(random, 1e-6, 2e-4),
                   {random.coin() ? Integrator::rk4 : Integrator::exponential, 0.1e-6}, motion)
             .ok())
      continue;
    const ValveMotion<float> in_float = rounded(motion);
    for (const RegimeStep<float>* level : {in_float.whole, in_float.fine}) {
      for (int regime = 0; regime < kRegimes; ++regime) {
        const RegimeStep<float>& step = level[regime];
        const auto real = [](float x) { return static_cast<double>(x); };
        const double yy = 1 + (real(step.lift.lift) - real(step.lift.gap)), vv = 1 + real(step.velocity.velocity);
        const double determinant =
            yy * vv - real(step.lift.velocity) * (real(step.velocity.lift) - real(step.velocity.gap));
        EXPECT_LE(determinant, 1) << random.trace(draw) << ", regime " << regime;
        EXPECT_GT(determinant, 0.97) << random.trace(draw) << ", regime " << regime;
        at_one += determinant > 1 - 1e-6 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(at_one, 1000);
}

TYPED_TEST(ValveEnergy, OfADampedValveNeverGrowsBeyondRounding) {
  using Real = TypeParam;
  const ValveBody<double> body = body_of(ohc_125_train());
  const double rounding = sizeof(Real) == 4 ? 1e-5 : 1e-13;
  for (const Integrator integrator : {Integrator::rk4, Integrator::exponential}) {
    for (std::uint32_t regime = 0; regime < 4; ++regime) {
      EXPECT_LE(energy_growth<Real>(body, regime, 7e-6, integrator, 1'000'000), rounding) << "regime " << regime;
    }
  }
}

// ---- the state
// -------------------------------------------------------------------------------------------------------------

/// Bytes of a state's members, one by one.
template <class Real, std::uint32_t Cylinders, std::uint32_t Trains, bool Phasing, bool Results>
constexpr std::size_t bytes_of_parts() {
  constexpr std::size_t real = sizeof(Real);
  constexpr std::size_t valves = std::size_t{Cylinders} * Trains;
  std::size_t bytes = 8 + 8 + 8 + 2 * real;  // fingerprint, phase, ticks; speed and load ratio
  const std::size_t lanes = (valves + 1) / 2 * 2;
  bytes +=
      lanes * (2 * real + 4) + ((Phasing ? Trains : 1) + 1) / 2 * 2 * real;  // lift, velocity, regime; what cams turned
  if (Phasing) bytes += Trains * 8 + (Trains + 1) / 2 * 2 * real;
  if (Results) bytes += valves * ((9 + 3) * real + (4 + 2) * 4);  // cycle and record: numbers, counts
  return bytes;
}

template <class Real, std::uint32_t C, std::uint32_t T>
constexpr bool no_padding() {
  return sizeof(State<Real, tick_test::Elastic<C, T, false, false>>) == bytes_of_parts<Real, C, T, false, false>() &&
         sizeof(State<Real, tick_test::Elastic<C, T, true, false>>) == bytes_of_parts<Real, C, T, true, false>() &&
         sizeof(State<Real, tick_test::Elastic<C, T, false, true>>) == bytes_of_parts<Real, C, T, false, true>() &&
         sizeof(State<Real, tick_test::Elastic<C, T, true, true>>) == bytes_of_parts<Real, C, T, true, true>();
}

TYPED_TEST(ValveEnergy, StateOfAnyNumberOfValvesHasNoPadding) {
  using Real = TypeParam;
  EXPECT_TRUE((no_padding<Real, 1, 1>() && no_padding<Real, 1, 2>() && no_padding<Real, 1, 3>()));
  EXPECT_TRUE((no_padding<Real, 2, 1>() && no_padding<Real, 2, 2>() && no_padding<Real, 2, 3>()));
  EXPECT_TRUE((no_padding<Real, 3, 1>() && no_padding<Real, 3, 2>() && no_padding<Real, 3, 3>()));
}

}  // namespace
}  // namespace crankloop::valve_step_test
