// A valve's step: its matrix against the textbook and against the exact solution, contacts, frequencies, energy, step
// lengths, size of the state.
#include <crankloop/tabulate/valve_motion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "support/status.hpp"
#include "support/test_valves.hpp"

namespace crankloop {
namespace {

using namespace valve_test;
using support::Random;
using support::refuses;
using tick_test::BothReals;
using tick_test::RealName;

ValveBody<double> body_of(const ValveTrain& train) {
  const ValveLift lift = lift_of(train);
  return valve_body(train.valve, lift.lever_m() > 0 ? lift.lever_m() : 1);
}

/// A motion whose fine step is the tick itself: nothing is divided, so that one matrix is one Runge-Kutta step.
ValveMotion<double> motion_in_one_step(const ValveBody<double>& body, double step_s,
                                       Integrator integrator = Integrator::rk4) {
  ValveMotion<double> motion{};
  const Status status = motion_of(body, step_s, {integrator, 10e-6}, motion);
  EXPECT_TRUE(status.ok()) << status.field;
  EXPECT_EQ(motion.whole.parts * motion.fine.parts, 1u) << "choose a shorter step";
  return motion;
}

/// The train's lift at 0, 1/2 and 1 of a step, and d times its speed: the middle by the cubic Hermite formulas of any handbook, or given.
struct ThreePoints {
  double value[3], slope[3];
  explicit ThreePoints(const LiftStep<double>& l) : ThreePoints(l, {}) {
    value[1] = (l.from_m + l.to_m) / 2 + (l.from_slope_m - l.to_slope_m) / 8;
    slope[1] = 1.5 * (l.to_m - l.from_m) - (l.from_slope_m + l.to_slope_m) / 4;
  }
  ThreePoints(const LiftStep<double>& l, const LiftMiddle<double>& middle)
      : value{l.from_m, middle.at_m, l.to_m}, slope{l.from_slope_m, middle.slope_m, l.to_slope_m} {}
};

/// The textbook's four stages in one regime [Li 2017, 4.9-4.13].
ValveState<double> textbook(const ValveBody<double>& b, std::uint32_t regime, double d, ValveState<double> s,
                            const ThreePoints& lift, double gas_N) {
  const auto f = [&](int i, double y, double v) {
    double force = -b.spring_N_m * y - b.preload_N - b.guide_Ns_m * v - gas_N;
    if ((regime & kTrainOn) != 0) force += b.train_N_m * (lift.value[i] - y) + b.train_Ns_m * (lift.slope[i] / d - v);
    if ((regime & kSeatOn) != 0) force += b.seat_N_m * (b.preload_N / b.seat_N_m - y) - b.seat_Ns_m * v;
    return force / b.mass_kg;
  };
  const double y = s.lift_m;
  const double v = s.velocity_m_s;
  const double k1 = f(0, y, v);
  const double k2 = f(1, y + d / 2 * v, v + d / 2 * k1);
  const double k3 = f(1, y + d / 2 * v + d * d / 4 * k1, v + d / 2 * k2);
  const double k4 = f(2, y + d * v + d * d / 2 * k2, v + d * k3);
  return {y + d * v + d * d / 6 * (k1 + k2 + k3), v + d / 6 * (k1 + 2 * k2 + 2 * k3 + k4)};
}

LiftStep<double> lift_step_at(const ValveLift& lift, double deg, double turned_deg) {
  const LiftPose from = lift.at(deg * kRadPerDeg);
  const LiftPose to = lift.at((deg + turned_deg) * kRadPerDeg);
  return {from.lift_m, to.lift_m, from.per_rad_m * turned_deg * kRadPerDeg, to.per_rad_m * turned_deg * kRadPerDeg};
}

LiftMiddle<double> lift_middle_at(const ValveLift& lift, double deg, double turned_deg) {
  const LiftPose middle = lift.at((deg + turned_deg / 2) * kRadPerDeg);
  return {middle.lift_m, middle.per_rad_m * turned_deg * kRadPerDeg};
}

/// A step in any regime: the train's lift drives it where the train is on.
ValveState<double> step_of(const StepMatrix<double>& m, std::uint32_t regime, ValveState<double> s, const LiftStep<double>& lift,
                           double gas_N) {
  const GasForce<double> gas{gas_N};
  return (regime & kTrainOn) != 0 ? stepped(m, s, gas, lift) : stepped(m, s, gas);
}

/// Force that does not depend on the motion: a preloaded seat carries the spring's preload.
double constant_force_N(const ValveBody<double>& body, std::uint32_t regime, double gas_N) {
  return (regime & kSeatOn) != 0 ? -gas_N : -body.preload_N - gas_N;
}

TEST(ValveStep, IsTheTextbooksFourStagesMultipliedOutInEveryRegime) {
  const ValveTrain train = ohc_125_train();
  const ValveLift lift = lift_of(train);
  const ValveBody<double> body = body_of(train);
  Random random;
  double worst = 0;
  for (const double d : {1e-6, 5e-6, 20e-6}) {
    const ValveMotion<double> motion = motion_in_one_step(body, d);
    for (int draw = 0; draw < 4'000; ++draw) {
      const std::uint32_t regime = static_cast<std::uint32_t>(random.whole(0, 3));
      const double deg = random.between(-60, 60);
      const double turned = random.between(-0.5, 0.5);
      const LiftStep<double> step = lift_step_at(lift, deg, turned);
      // Near where such a regime lives: about the lift, or about the seat.
      const double y = ((regime & kSeatOn) != 0 ? 0 : step.from_m) + random.between(-50e-6, 50e-6);
      const ValveState<double> before{y, random.between(-8, 8)};
      const double gas_N = random.between(-50, 400);
      const bool wide = (regime & kTrainOn) != 0 && random.coin();
      const LiftMiddle<double> middle = lift_middle_at(lift, deg, turned);
      const StepMatrix<double>& matrix = motion.fine.matrix[regime];
      const ValveState<double> by_matrix =
          wide ? stepped(matrix, before, GasForce<double>{gas_N}, step, middle) : step_of(matrix, regime, before, step, gas_N);
      const ValveState<double> by_stages =
          textbook(body, regime, d, before, wide ? ThreePoints(step, middle) : ThreePoints(step), gas_N);
      // Relative to what is added up: a state, what drives it, and what a step makes of them.
      const double w = std::sqrt((body.train_N_m + body.seat_N_m) / body.mass_kg);
      const double size = std::fabs(y) + std::fabs(step.from_m) + std::fabs(before.velocity_m_s) / w;
      worst = std::max(worst, std::fabs(by_matrix.lift_m - by_stages.lift_m) / size);
      worst = std::max(worst, std::fabs(by_matrix.velocity_m_s - by_stages.velocity_m_s) / (size * w));
    }
  }
  std::printf("[ figures  ] matrix step against textbook with the same mid-step lift: %.1e of the state\n", worst);
  EXPECT_LT(worst, 1e-12);
}

TEST(ValveStep, DiffersFromTheTextbookWithTrueMidStepLiftsByLessThanTheLiftTablesOwnError) {
  const ValveTrain train = ohc_125_train();
  const ValveLift lift = lift_of(train);
  const ValveBody<double> body = body_of(train);
  for (const double rpm : {6000.0, 12000.0}) {
    for (const double d : {5e-6, 20e-6}) {
      const ValveMotion<double> motion = motion_in_one_step(body, d);
      const double turned = rpm / 2 * 6 * d;
      double worst = 0;
      for (double deg = -70; deg < 70; deg += 0.37) {
        const LiftStep<double> step = lift_step_at(lift, deg, turned);
        ThreePoints truly(step);
        const LiftPose middle = lift.at((deg + turned / 2) * kRadPerDeg);
        truly.value[1] = middle.lift_m;
        truly.slope[1] = middle.per_rad_m * kRadPerDeg * turned;
        const ValveState<double> before{step.from_m - 30e-6, step.from_slope_m / d};
        const ValveState<double> by_matrix = step_of(motion.fine.matrix[kTrainOn], kTrainOn, before, step, 0);
        worst = std::max(worst, std::fabs(by_matrix.lift_m - textbook(body, kTrainOn, d, before, truly, 0).lift_m));
      }
      std::printf("[ figures  ] against textbook with true mid-step lifts, %5.0f rpm, %2.0f us: %.1e um per step\n",
                  rpm, d * 1e6, worst * 1e6);
      EXPECT_LT(worst, 0.005e-6);
    }
  }
}

TEST(ValveStep, ByTheExponentialIsTheExactSolutionForThePolynomialLift) {
  const ValveTrain train = ohc_125_train();
  const ValveLift lift = lift_of(train);
  const ValveBody<double> body = body_of(train);
  const double d = 20e-6;
  const ValveMotion<double> motion = motion_in_one_step(body, d, Integrator::exponential);
  // Power series of the solution of M y'' + C y' + K y = F + k Y + b Y' with Y a polynomial, in long double, term by term
  // until nothing is added.
  using Long = long double;
  const auto wide = [](double x) { return static_cast<Long>(x); };
  for (std::uint32_t regime = 0; regime < 4; ++regime) {
    for (double deg = -60; deg < 60; deg += 7.7) {
      const LiftStep<double> step = lift_step_at(lift, deg, 0.7);
      const LiftMiddle<double> middle = lift_middle_at(lift, deg, 0.7);
      const bool by_middle = (regime & kTrainOn) != 0 && static_cast<int>(deg * 10) % 2 == 0;
      const LiftWithin<double> within = by_middle ? LiftWithin<double>(step, middle) : LiftWithin<double>(step);
      const Long h = wide(d);
      const Long M = wide(body.mass_kg);
      const bool on_train = (regime & kTrainOn) != 0;
      const bool on_seat = (regime & kSeatOn) != 0;
      const Long K = wide(body.spring_N_m + (on_train ? body.train_N_m : 0) + (on_seat ? body.seat_N_m : 0));
      const Long C = wide(body.guide_Ns_m + (on_train ? body.train_Ns_m : 0) + (on_seat ? body.seat_Ns_m : 0));
      const double force_N = constant_force_N(body, regime, 12.0);
      Long term[60];
      const double start_m = on_seat ? 3e-6 : step.from_m - 20e-6;
      term[0] = wide(start_m);
      term[1] = wide(0.9) * h;
      Long y = term[0] + term[1];
      Long v = term[1];
      for (int n = 0; n < 58; ++n) {
        Long drive = n == 0 ? wide(force_N) : 0;
        if (on_train && n < 6) drive += wide(body.train_N_m) * wide(within.coefficient(n));
        if (on_train && n < 5) drive += wide(body.train_Ns_m) / h * (n + 1) * wide(within.coefficient(n + 1));
        term[n + 2] = (drive * h * h - K * h * h * term[n] - C * h * (n + 1) * term[n + 1]) / (M * (n + 1) * (n + 2));
        y += term[n + 2];
        v += (n + 2) * term[n + 2];
      }
      const ValveState<double> before{start_m, 0.9};
      const StepMatrix<double>& matrix = motion.fine.matrix[regime];
      const ValveState<double> after =
          by_middle ? stepped(matrix, before, GasForce<double>{12.0}, step, middle) : step_of(matrix, regime, before, step, 12.0);
      // Fourth-order steps of d / 64: w d / 64 <= 0.0134, so 0.0134^4 / 120 w d = 2.3e-10 of what swings, twice that
      // for its damping.
      const double w = std::sqrt(static_cast<double>(K / M));
      const double driven_m =
          std::fabs(force_N + (on_train ? body.train_N_m * step.from_m : 0)) / static_cast<double>(K);
      const double swing_m = std::fabs(start_m - driven_m) + (0.9 + (on_train ? std::fabs(step.from_slope_m / d) : 0)) / w;
      EXPECT_NEAR(after.lift_m, static_cast<double>(y), 5e-10 * swing_m)
          << "regime " << regime << ", " << deg << " deg";
      EXPECT_NEAR(after.velocity_m_s, static_cast<double>(v / h), 5e-10 * swing_m * w)
          << "regime " << regime << ", " << deg << " deg";
    }
  }
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
    EXPECT_DOUBLE_EQ(body.seat_sink_m, 205.8 / 1e8);
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
        step_of(motion.fine.matrix[regime], regime, s, LiftStep<double>{}, 0.0);
    if (s.lift_m < rest_m && next.lift_m >= rest_m) {
      const double at = i - (next.lift_m - rest_m) / (next.lift_m - s.lift_m);  // near the crossing a sine is straight
      if (upward == 0) first = at;
      if (upward++ == swings) return (at - first) * motion.fine.step_s / swings;
    }
    s = next;
  }
}

TEST(ValveBody, SwingsAtItsNaturalFrequencies) {
  ValveTrain train = ohc_125_train();
  train.valve.train_damping_ratio = train.valve.guide_damping_ratio = train.valve.seat_damping_ratio = 0;
  const ValveBody<double> body = body_of(train);
  const ValveMotion<double> motion = motion_in_one_step(body, 1e-6, Integrator::exponential);
  EXPECT_NEAR(swing_s(motion, kTrainOn, 1000), 2 * kPi / open_frequency_rad_s(body),
              1e-9 * swing_s(motion, kTrainOn, 10));
  EXPECT_NEAR(swing_s(motion, kTrainOn | kSeatOn, 1000), 2 * kPi / seated_frequency_rad_s(body),
              1e-8 * swing_s(motion, 3, 10));
  EXPECT_NEAR(open_frequency_rad_s(body) / (2 * kPi), 2216, 1);     // Hz: 11.805 kN/mm on 60.87 g
  EXPECT_NEAR(seated_frequency_rad_s(body) / (2 * kPi), 6820, 10);  // Hz: 111.8 kN/mm
}

TEST(Contacts, HoldOnlyWhileBothTheGapAndTheForceArePositive) {
  ValveBody<double> b{};
  b.train_N_m = 1e7, b.train_Ns_m = 100, b.seat_N_m = 1e8, b.seat_Ns_m = 500, b.preload_N = 200, b.seat_sink_m = 2e-6,
  b.mass_kg = 0.06;
  const auto regime = [&](double y, double v, double Y, double Yd) {
    return contacts(b, ValveState<double>{y, v}, Y, Yd).regime();
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

TEST(ValveStepping, RefusesWhatItCannotStepAndNamesTheLongestTick) {
  const ValveBody<double> body = body_of(ohc_125_train());
  ValveMotion<double> motion{};
  for (const double accuracy_m : {0.009e-6, 11e-6, 0.0, -1e-6, std::nan(""), HUGE_VAL}) {
    EXPECT_TRUE(
        refuses(motion_of(body, 100e-6, {Integrator::rk4, accuracy_m}, motion), Reason::out_of_range, "tick.accuracy"))
        << accuracy_m;
  }
  for (const int number : {2, 3, 255}) {
    const ValveStepping unknown{static_cast<Integrator>(number), 0.1e-6};
    EXPECT_TRUE(refuses(motion_of(body, 100e-6, unknown, motion), Reason::out_of_range, "tick.integrator")) << number;
  }
  for (const double tick_s : {0.0, -1e-6, std::nan("")}) {
    EXPECT_TRUE(refuses(motion_of(body, tick_s, {}, motion), Reason::out_of_range, "tick.tick")) << tick_s;
  }
  ValveBody<double> boulder = body;
  for (const double mass_kg : {1.1e9, HUGE_VAL, std::nan("")}) {
    boulder.mass_kg = mass_kg;
    EXPECT_TRUE(refuses(motion_of(boulder, 100e-6, {}, motion), Reason::out_of_range, "valve.rocker_inertia")) << mass_kg;
  }
  Random random;
  for (int draw = 0; draw < 200; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    ValveBody<double> b = body;
    b.mass_kg *= std::pow(10, random.between(-2, 1));
    b.train_N_m *= std::pow(10, random.between(-1, 1));
    b.seat_N_m *= std::pow(10, random.between(-2, 2));
    b.seat_Ns_m *= std::pow(10, random.between(-2, 1.5));
    const ValveStepping stepping{Integrator::rk4, 0.01e-6 * std::pow(10, random.between(0, 3))};
    const double longest = longest_tick_s(b, stepping);
    EXPECT_TRUE(motion_of(b, longest * 0.999999, stepping, motion).ok());
    EXPECT_LE(motion.whole.parts * motion.fine.parts, static_cast<std::uint32_t>(kMostFineSteps));
    if (longest < 0.9) {
      EXPECT_TRUE(refuses(motion_of(b, longest * 1.000001, stepping, motion), Reason::out_of_range, "tick.tick"));
      EXPECT_TRUE(refuses(motion_of(b, longest * 4, stepping, motion), Reason::out_of_range, "tick.tick"));
    }
    // Monotone: what is accepted at a tick is accepted at every shorter one.
    for (int i = 0; i < 20; ++i) {
      EXPECT_TRUE(motion_of(b, longest * random.between(1e-3, 0.999), stepping, motion).ok());
      EXPECT_NEAR(motion.whole.parts * motion.fine.parts * motion.fine.step_s, motion.whole.step_s * motion.whole.parts, 1e-15);
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
  const ValveMotion<double> motion = motion_in_one_step(body, step_s, integrator);
  const StepMatrix<Real> matrix = in_real<Real>(motion).fine.matrix[regime];
  const bool on_train = (regime & kTrainOn) != 0;
  const double stiffness =
      body.spring_N_m + (on_train ? body.train_N_m : 0) + ((regime & kSeatOn) != 0 ? body.seat_N_m : 0);
  const Real level_m = on_train ? static_cast<Real>(5e-3) : Real{0};
  const LiftStep<Real> lift{level_m, level_m, Real{0}, Real{0}};
  const double force_N = constant_force_N(body, regime, 0.0);
  const double rest_m = (force_N + (on_train ? body.train_N_m * static_cast<double>(level_m) : 0)) / stiffness;
  ValveState<Real> s{static_cast<Real>(rest_m + 1e-3), Real{0}};
  const double first = energy_J(body, regime, rest_m, static_cast<double>(s.lift_m), 0);
  double largest = 0;
  for (long i = 0; i < steps; ++i) {
    s = on_train ? stepped(matrix, s, NoGasForce<Real>{}, lift) : stepped(matrix, s, NoGasForce<Real>{});
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

template <std::uint32_t Cylinders, std::uint32_t Trains, bool Phasing, bool Results>
struct Sized : Scene {
  static constexpr Count cylinders = exactly<Cylinders>;
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr Count trains = exactly<Trains>;
  static constexpr bool valve_results = Results;
  static constexpr bool cam_phasing = Phasing;
};

/// Bytes of a state's members, one by one.
template <class Real, std::uint32_t Cylinders, std::uint32_t Trains, bool Phasing, bool Results>
constexpr std::size_t bytes_of_parts() {
  constexpr std::size_t real = sizeof(Real);
  constexpr std::size_t valves = std::size_t{Cylinders} * Trains;
  std::size_t bytes = 8 + 8 + 8 + 2 * real;  // fingerprint, phase, ticks; speed and load ratio
  bytes += valves * (4 * real + 2 * 4);      // lift, velocity; the train's lift and slope; regime, sleep
  if (Phasing) bytes += Trains * 8 + (Trains + 1) / 2 * 2 * real;
  if (Results) bytes += valves * ((9 + 3) * real + (4 + 2) * 4);  // cycle and record: numbers, counts
  return bytes;
}

template <class Real, std::uint32_t C, std::uint32_t T>
constexpr bool no_padding() {
  return sizeof(State<Real, Sized<C, T, false, false>>) == bytes_of_parts<Real, C, T, false, false>() &&
         sizeof(State<Real, Sized<C, T, true, false>>) == bytes_of_parts<Real, C, T, true, false>() &&
         sizeof(State<Real, Sized<C, T, false, true>>) == bytes_of_parts<Real, C, T, false, true>() &&
         sizeof(State<Real, Sized<C, T, true, true>>) == bytes_of_parts<Real, C, T, true, true>();
}

TYPED_TEST(ValveEnergy, StateOfAnyNumberOfValvesHasNoPadding) {
  using Real = TypeParam;
  EXPECT_TRUE((no_padding<Real, 1, 1>() && no_padding<Real, 1, 2>() && no_padding<Real, 1, 3>()));
  EXPECT_TRUE((no_padding<Real, 2, 1>() && no_padding<Real, 2, 2>() && no_padding<Real, 2, 3>()));
  EXPECT_TRUE((no_padding<Real, 3, 1>() && no_padding<Real, 3, 2>() && no_padding<Real, 3, 3>()));
}

}  // namespace
}  // namespace crankloop
