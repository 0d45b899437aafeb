// The surge of a valve spring over a cycle: against the steady state of its modes by the lift's Fourier series.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <vector>

#include "crankloop/engine_file/engine_file.hpp"
#include "crankloop/loops/surge_force.hpp"
#include "crankloop/loops/valve_loop.hpp"
#include "support/units.hpp"
#include "support/valve_runs.hpp"

namespace crankloop::program::surge_force_test {
namespace {

using support::kPi;

/// Each harmonic of the lift drives each mode by itself: q'' + 2 z w q' + w^2 q = 2 (-1)^n / (n pi) y''.
double steady_force_N(const ValveLift& lift, const Valve& valve, double cam_rad_s, double damping_ratio, int modes) {
  constexpr int kSamples = 8192, kHarmonics = 400;
  std::vector<std::complex<double>> harmonic(kHarmonics + 1);
  std::vector<double> y(kSamples);
  for (int i = 0; i < kSamples; ++i) y[std::size_t(i)] = std::max(0.0, lift.at(2 * kPi * i / kSamples).lift_m);
  for (int k = 1; k <= kHarmonics; ++k) {
    std::complex<double> sum;
    for (int i = 0; i < kSamples; ++i) sum += y[std::size_t(i)] * std::polar(1.0, -2 * kPi * k * i / kSamples);
    const double rate = k * cam_rad_s;
    std::complex<double> force;
    for (int n = 1; n <= modes; ++n) {
      const double w = n * kPi * std::sqrt(valve.spring_N_m / valve.spring_kg);
      const std::complex<double> stiffness(w * w - rate * rate, 2 * damping_ratio * w * rate);
      force += valve.spring_N_m * 2.0 * (-rate * rate) / stiffness;  // n pi (-1)^n times 2 (-1)^n / (n pi)
    }
    harmonic[std::size_t(k)] = force * sum / double(kSamples);
  }
  double largest = 0;
  for (int i = 0; i < 4 * kSamples; ++i) {
    double force_N = 0;
    for (int k = 1; k <= kHarmonics; ++k)
      force_N += 2 * (harmonic[std::size_t(k)] * std::polar(1.0, 2 * kPi * k * i / (4 * kSamples))).real();
    largest = std::max(largest, std::abs(force_N));
  }
  return largest;
}

TEST(SurgeForce, IsTheSteadyStateOfTheLiftsHarmonics) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  for (const double rpm : {4000.0, 7000.0, -7000.0, 12'000.0}) {
    const double cam_rad_s = rpm * kPi / 60;
    const SpringSurgeCycle surge = surge_over_cycle(LiftSlopes(valve.lift()), valve.valve(), cam_rad_s);
    const double exact_N = steady_force_N(valve.lift(), valve.valve(), std::abs(cam_rad_s), 0.01, 3);
    EXPECT_NEAR(surge.largest_N / exact_N, 1, 5e-3) << rpm << " rpm, " << exact_N << " N";
  }
}

TEST(SurgeForce, PeaksWhereAHarmonicOfTheLiftMeetsTheSpring) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  const double first_Hz = surge_over_cycle(LiftSlopes(valve.lift()), valve.valve(), 1).frequency_Hz;
  EXPECT_NEAR(first_Hz, std::sqrt(valve.valve().spring_N_m / valve.valve().spring_kg) / 2, 1e-9 * first_Hz);
  const auto at = [&](double harmonic) {
    return surge_over_cycle(LiftSlopes(valve.lift()), valve.valve(), 2 * kPi * first_Hz / harmonic).largest_N;
  };
  for (const double harmonic : {6.0, 7.0}) {
    EXPECT_GT(at(harmonic), 1.2 * at(harmonic + 0.5)) << harmonic;
    EXPECT_GT(at(harmonic), 1.2 * at(harmonic - 0.5)) << harmonic;
  }
}

/// Anywhere between the table's points, by differences of the lift itself; but within a fifth of a point of where
/// the valve opens or closes, for there the slope steps.
TEST(LiftSlopes, AreThoseOfTheLift) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  const LiftSlopes slopes(valve.lift());
  const auto lift_m = [&](double turn) { return std::max(0.0, valve.lift().at(2 * kPi * (turn - 0.5)).lift_m); };
  double largest = 0;
  int at_steps = 0;
  for (int i = 1; i < 10'007; ++i) {
    constexpr double kApart = 1e-6, kNear = 0.2 / 18'000;
    const double turn = i / 10'007.0;
    if ((lift_m(turn - kNear) > 0) != (lift_m(turn + kNear) > 0)) {
      ++at_steps;
      continue;
    }
    const double per_rad_m = (lift_m(turn + kApart) - lift_m(turn - kApart)) / (2 * kPi * 2 * kApart);
    EXPECT_NEAR(slopes.at(turn), per_rad_m, 2e-6) << turn;
    largest = std::max(largest, per_rad_m);
  }
  EXPECT_GT(largest, 5e-3);
  EXPECT_LE(at_steps, 4);
  EXPECT_EQ(slopes.at(0), 0);
  EXPECT_EQ(slopes.at(1), 0);
}

TEST(SurgeForce, ASpringWithoutMassHasNone) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  Valve light = valve.valve();
  light.spring_kg = 0;
  EXPECT_EQ(surge_over_cycle(LiftSlopes(valve.lift()), light, 300).frequency_Hz, 0);
  EXPECT_EQ(surge_over_cycle(LiftSlopes(valve.lift()), valve.valve(), 0).largest_N, 0);
}

/// A spring far slower than its cam does not follow it: q_n'' is the drive, and the force that of the lift less its
/// mean course. It has next to no damping within a cycle, so a start that has to decay would never end.
TEST(SurgeForce, OfASpringFarSlowerThanItsCamIsFiniteAndSmall) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  Valve slow = valve.valve();
  slow.spring_N_m = 1e-3, slow.spring_kg = 100;
  const double largest_N = surge_over_cycle(LiftSlopes(valve.lift()), slow, 600).largest_N;
  EXPECT_GT(largest_N, 0);
  EXPECT_LT(largest_N, 3 * 2 * slow.spring_N_m * valve.lift().largest_lift_m());
}

}  // namespace
}  // namespace crankloop::program::surge_force_test
