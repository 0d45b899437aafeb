// The gas of one cylinder: against thermodynamics' closed forms.
#include <crankloop/tick/gas/cylinder_gas.hpp>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/both_reals.hpp"
#include "support/gas_bench.hpp"
#include "support/random.hpp"

namespace crankloop::gas_step_test {
namespace {

using support::gas_energy;
using support::GasBench;
using support::kGasR;
using tick_test::RealName;

constexpr double kPi = 3.14159265358979323846;

template <class Real>
class GasStep : public ::testing::Test {};
TYPED_TEST_SUITE(GasStep, tick_test::BothReals, RealName);

template <class Real>
constexpr bool kFloat = sizeof(Real) == 4;

/// Crank mechanism of the sample: 86 x 86, ratio 10.5, rod 143 mm.
[[nodiscard]] double volume_m3(double crank_deg) {
  const double a = crank_deg * kPi / 180, r = 0.043, l = 0.143;
  const double swept = kPi / 4 * 0.086 * 0.086 * 0.086;
  const double x = r + l - r * std::cos(a) - std::sqrt(l * l - r * r * std::sin(a) * std::sin(a));
  return swept / 9.5 + kPi / 4 * 0.086 * 0.086 * x;
}

/// a ln T + b T + R ln V is the entropy, but for a constant: what it gives at another volume.
[[nodiscard]] double isentropic_K(double from_K, double from_m3, double to_m3, double burned_ratio) {
  const double a = support::gas_a(burned_ratio);
  const double entropy = a * std::log(from_K) + support::kGasB * from_K + kGasR * std::log(from_m3 / to_m3);
  double t = from_K;
  for (int i = 0; i < 100; ++i) t -= (a * std::log(t) + support::kGasB * t - entropy) / (a / t + support::kGasB);
  return t;
}

TYPED_TEST(GasStep, CompressesIsentropically) {
  using Real = TypeParam;
  for (const double per_step_deg : {0.5, 5.0}) {
    GasBench<Real> bench(1e5, 320, 0.1, volume_m3(180));
    double work_J = 0, turned_over_J = 0, worst = 0;
    const auto turn = [&](double from_deg, double to_deg) {
      const int steps = static_cast<int>(std::lround((to_deg - from_deg) / per_step_deg));
      for (int i = 1; i <= steps; ++i) {
        work_J += static_cast<double>(bench.step(1e-4, volume_m3(from_deg + i * per_step_deg)).work_J);
        turned_over_J = std::fmax(turned_over_J, std::fabs(work_J));
        const double exact = isentropic_K(320, volume_m3(180), static_cast<double>(bench.gas.volume_m3), 0.1);
        worst = std::fmax(worst, std::fabs(bench.temperature_K() / exact - 1));
      }
    };
    turn(-180, 0);
    EXPECT_NEAR(turned_over_J, 213, 3);
    turn(0, 180);
    // 3e-7 by the expansions at half a degree per step, 3e-5 at five; what rounding of 720 steps adds is below 1e-6.
    EXPECT_LT(worst, per_step_deg < 1 ? (kFloat<Real> ? 1e-6 : 3e-7) : 3e-5);
    EXPECT_NEAR(bench.temperature_K(), 320, 320 * 1e-6);
    EXPECT_NEAR(work_J, 0, 1e-4);
  }
}

TYPED_TEST(GasStep, KeepsASlowCranksWork) {  // 0.05 rpm at 60 us: five million steps from bottom to top
  using Real = TypeParam;
  GasBench<Real> bench(1e5, 320, 0, volume_m3(180));
  constexpr int kSteps = 5'000'000;
  for (int i = 1; i <= kSteps; ++i) (void)bench.step(60e-6, volume_m3(-180 + 90.0 * i / kSteps));
  const double exact = isentropic_K(320, volume_m3(180), volume_m3(-90), 0);
  EXPECT_NEAR(bench.temperature_K(), exact, exact * 1e-6);
}

/// p of a blow-down through a choked opening with cv constant (b = 0): the closed form. The step's cv has a slope, so
/// this compares with the same integral for the linear cv, by fine RK4 with pow() and an orifice that is choked
/// throughout.
struct BlowDown {
  static constexpr double kVolume = 500e-6, kArea = 5e-4, kFrom_Pa = 8e5, kFrom_K = 1500;
  double m, u;

  BlowDown() : m{kFrom_Pa * kVolume / (kGasR * kFrom_K)}, u{m * gas_energy(kFrom_K, 1)} {}
  [[nodiscard]] static double temperature(double m, double u) {
    const double a = support::gas_a(1), e = u / m;
    return 2 * e / (a + std::sqrt(a * a + 2 * support::kGasB * e));
  }
  [[nodiscard]] static double psi() { return std::sqrt(1.36) * std::pow(2 / 2.36, 2.36 / 0.72); }
  static void slope(double m, double u, double& dm, double& du) {
    const double t = temperature(m, u), p = m * kGasR * t / kVolume;
    dm = -kArea * p / std::sqrt(kGasR * t) * psi();
    du = dm * (u / m + kGasR * t);
  }
  void run(double time_s) {
    constexpr double h = 1e-7;
    for (int n = static_cast<int>(std::lround(time_s / h)); n > 0; --n) {
      double k[4][2];
      slope(m, u, k[0][0], k[0][1]);
      slope(m + h / 2 * k[0][0], u + h / 2 * k[0][1], k[1][0], k[1][1]);
      slope(m + h / 2 * k[1][0], u + h / 2 * k[1][1], k[2][0], k[2][1]);
      slope(m + h * k[2][0], u + h * k[2][1], k[3][0], k[3][1]);
      m += h / 6 * (k[0][0] + 2 * k[1][0] + 2 * k[2][0] + k[3][0]);
      u += h / 6 * (k[0][1] + 2 * k[1][1] + 2 * k[2][1] + k[3][1]);
    }
  }
  [[nodiscard]] double pressure_Pa() const { return m * kGasR * temperature(m, u) / kVolume; }
};

TEST(GasReference, BlowsDownAsTheClosedForm) {  // at b = 0, which a temperature range of 1 K is as good as
  const double g = 1 + kGasR / (support::gas_a(1) + support::kGasB * BlowDown::kFrom_K);
  BlowDown exact;
  const double rate =
      (g - 1) / 2 * BlowDown::psi() * BlowDown::kArea / BlowDown::kVolume * std::sqrt(kGasR * BlowDown::kFrom_K);
  exact.run(2e-6);
  EXPECT_NEAR(exact.pressure_Pa() / BlowDown::kFrom_Pa, std::pow(1 + rate * 2e-6, -2 * g / (g - 1)), 1e-6);
}

template <class Real>
[[nodiscard]] double worst_of_blow_down(double step_s) {
  GasBench<Real> bench(BlowDown::kFrom_Pa, BlowDown::kFrom_K, 1, BlowDown::kVolume);
  bench.given(1, 1e5, 300, 1);
  bench.gas.area_m2[1] = static_cast<Real>(BlowDown::kArea);
  BlowDown exact;
  double worst = 0;
  while (exact.pressure_Pa() > 3e5) {
    (void)bench.step(step_s, BlowDown::kVolume, 0, BlowDown::kArea);
    exact.run(step_s);
    worst = std::fmax(worst, std::fabs(bench.pressure_Pa() / exact.pressure_Pa() - 1));
  }
  return worst;
}

TYPED_TEST(GasStep, BlowsDown) {
  const double at_10 = worst_of_blow_down<TypeParam>(10e-6);
  const double at_50 = worst_of_blow_down<TypeParam>(50e-6);
  const double at_100 = worst_of_blow_down<TypeParam>(100e-6);
  EXPECT_LT(at_10, 3.6e-5);
  EXPECT_LT(at_50, 2.4e-4);
  EXPECT_LT(at_100, 6.5e-4);
  EXPECT_LT(at_10, at_100 / 10 * 1.1);  // of first order at least
}

TYPED_TEST(
    GasStep,
    FillsAnEvacuatedVolume) {  // the gas that comes in brings its enthalpy: cv T = cp T0, with cv's slope e(T) = h(T0)
  using Real = TypeParam;
  GasBench<Real> bench(10, 300, 0, 500e-6);
  bench.given(0, 1e5, 300, 0);
  double highest = 0;
  for (int i = 0; i < 100'000; ++i) {
    (void)bench.step(50e-6, 500e-6, 3e-4);
    highest = std::fmax(highest, bench.pressure_Pa());
  }
  const double h = gas_energy(300, 0) + kGasR * 300;
  const double a = support::gas_a(0);
  const double end_K = 2 * h / (a + std::sqrt(a * a + 2 * support::kGasB * h));
  EXPECT_NEAR(bench.temperature_K(), end_K,
              end_K * 1e-4 + 0.03);  // 0.03 K: a ten-thousandth of the mass was there before
  EXPECT_NEAR(bench.pressure_Pa(), 1e5, 0.1);
  EXPECT_LE(highest, 1e5 * (1 + 1e-6));
}

TYPED_TEST(GasStep, BurnsAtConstantVolume) {
  using Real = TypeParam;
  GasBench<Real> bench(20e5, 700, 0.05, 55e-6);
  bench.fuel_J_kg = 42.3e6, bench.fuel_burned_kg_kg = 15.6;
  const double before_J = static_cast<double>(bench.gas.contents.energy_J),
               before_kg = static_cast<double>(bench.gas.contents.mass_kg);
  double burned_kg = static_cast<double>(bench.gas.contents.burned_kg);
  constexpr int kSteps = 200;
  const Real part = static_cast<Real>(30e-6 / kSteps / 2);
  for (int i = 0; i < kSteps; ++i) (void)bench.step(1e-4, 55e-6, 0, 0, static_cast<double>(part));
  const double fuel_kg = static_cast<double>(part) * kSteps;
  const double m = before_kg + fuel_kg, u = before_J + fuel_kg * bench.fuel_J_kg;
  burned_kg += fuel_kg * bench.fuel_burned_kg_kg;
  const double rounding = static_cast<double>(std::numeric_limits<Real>::epsilon());
  EXPECT_NEAR(static_cast<double>(bench.gas.contents.energy_J), u, u * rounding);
  EXPECT_NEAR(static_cast<double>(bench.gas.contents.mass_kg), m, m * rounding);
  EXPECT_NEAR(static_cast<double>(bench.gas.contents.burned_kg), burned_kg, burned_kg * 2 * rounding);
  const double a = support::gas_a(burned_kg / m), e = u / m;
  const double end_K = 2 * e / (a + std::sqrt(a * a + 2 * support::kGasB * e));
  EXPECT_NEAR(bench.temperature_K(), end_K, end_K * 4 * rounding);
  EXPECT_NEAR(bench.pressure_Pa(), m * kGasR * end_K / 55e-6, bench.pressure_Pa() * 6 * rounding);
}

TYPED_TEST(GasStep, ChangesNothingWhereNothingPushes) {
  using Real = TypeParam;
  GasBench<Real> bench(1e5, 300, 0, 500e-6);
  bench.given(0, bench.pressure_Pa(), 350, 0);
  bench.given(1, bench.pressure_Pa(), 800, 1);
  const detail::CylinderGas<Real> before = [&] {
    (void)bench.step(1e-4, 500e-6, 3e-4, 2e-4);
    return bench.gas;
  }();
  for (int i = 0; i < 1'000'000; ++i) (void)bench.step(1e-4, 500e-6, i % 3 == 0 ? 3e-4 : 1e-4, i % 3 == 1 ? 0 : 2e-4);
  EXPECT_EQ(bench.gas.contents.mass_kg, before.contents.mass_kg);
  EXPECT_EQ(bench.gas.contents.energy_J, before.contents.energy_J);
  EXPECT_EQ(bench.gas.contents.burned_kg, before.contents.burned_kg);
  EXPECT_EQ(bench.gas.point.pressure_Pa, before.point.pressure_Pa);
}

TYPED_TEST(GasStep, CoolsToItsWalls) {
  using Real = TypeParam;
  GasBench<Real> bench(10e5, 900, 0, 500e-6);
  const auto real = [](double x) { return static_cast<Real>(x); };
  bench.walls = {real(130e-4), real(0.0116), real(46.5), real(423), real(0.027)};
  double before = 901;
  for (int i = 0; i < 400'000; ++i) {
    (void)bench.step(1e-4, 500e-6);
    ASSERT_LE(bench.temperature_K(), before);
    before = bench.temperature_K() * (1 + 1e-6);
  }
  EXPECT_NEAR(bench.temperature_K(), 423, 0.01);
  EXPECT_NEAR(bench.pressure_Pa(), 10e5 * 423 / 900, 10e5 * 423 / 900 * 3e-5);
}

TYPED_TEST(GasStep, SettlesWithoutRipple) {  // N: share of the volume that the opening could exchange in a step
  using Real = TypeParam;
  for (const double n : {0.01, 0.1, 1.0, 10.0, 1e3, 1e5}) {
    for (const double from_Pa : {0.9e5, 1.1e5}) {
      GasBench<Real> bench(from_Pa, 300, 0, 500e-6);
      const double area = n * 500e-6 / (1e-4 * std::sqrt(kGasR * 300));
      double before = bench.pressure_Pa(), ripple = 0;
      for (int i = 0; i < 20'000; ++i) {
        (void)bench.step(1e-4, 500e-6, area);
        const double now = bench.pressure_Pa();
        const double toward = from_Pa < 1e5 ? now - before : before - now;
        ripple = std::fmax(ripple, -toward);
        before = now;
      }
      EXPECT_LT(ripple, 1e-5 * 1e5) << n << " from " << from_Pa;
      EXPECT_NEAR(before, 1e5, 1e-5 * 1e5) << n << " from " << from_Pa;
    }
  }
}

/// What flows through a cylinder between two manifolds at 1.02 and 1.00 bar, and the largest swing of the pressure
/// between.
template <class Real>
[[nodiscard]] std::pair<double, double> flow_through(double n, double& pressure_Pa) {
  GasBench<Real> bench(1e5, 300, 0, 500e-6);
  bench.given(0, 1.02e5, 300, 0);
  bench.given(1, 1.00e5, 300, 0);
  const double area = n * 500e-6 / (1e-4 * std::sqrt(kGasR * 300));
  double through = 0, least = 1e9, most = 0;
  for (int i = 0; i < 40'000; ++i) {
    (void)bench.step(1e-4, 500e-6, area, area);
    if (i < 20'000) continue;
    through -= static_cast<double>(bench.through[1].mass_kg) / (20'000 * 1e-4);
    least = std::fmin(least, bench.pressure_Pa()), most = std::fmax(most, bench.pressure_Pa());
  }
  pressure_Pa = (least + most) / 2;
  return {through / area, (most - least) / pressure_Pa};
}

TYPED_TEST(GasStep, LetsFlowThroughBothPorts) {
  const auto orifice = [](double up_Pa, double down_Pa) {
    const double s = (up_Pa - down_Pa) / up_Pa / 0.46488669399358847;
    return up_Pa * 0.6778852870696124 / std::sqrt(kGasR * 300) * std::sqrt(s * (2 - s));
  };
  for (const double n : {0.05, 0.3, 3.0, 1e3, 1e5}) {
    double between_Pa = 0;
    const auto [through, swing] = flow_through<TypeParam>(n, between_Pa);
    EXPECT_GE(between_Pa, 1.00e5) << n;
    EXPECT_LE(between_Pa, 1.02e5) << n;
    EXPECT_LT(swing, 7e-6 * 2) << n;
    if (n < 0.1) {
      EXPECT_NEAR(through / orifice(1.02e5, between_Pa), 1, 1e-5);
    }
    if (n < 1) {
      EXPECT_NEAR(through / orifice(1.02e5, between_Pa), 1, 0.02);
    }
  }
}

/// Sizes, speeds, manifolds at random, ports that open and shut at random, steps of 1 us to 2 ms and 34 deg; guards
/// have no part in it. CRANKLOOP_LONG_TESTS=1 in the environment: 20 000 cylinders.
TYPED_TEST(GasStep, StandsWhateverItsPortsDo) {
  using Real = TypeParam;
  const int cylinders = std::getenv("CRANKLOOP_LONG_TESTS") != nullptr ? 20'000 : 2000;
  support::Random random;
  const auto wide = [&random](double least, double most) {
    return least * std::pow(most / least, random.between(0, 1));
  };
  const auto real = [](double x) { return static_cast<Real>(x); };
  for (int n = 0; n < cylinders; ++n) {
    SCOPED_TRACE(random.trace(n));
    const double scale = wide(1e-3, 1e3);  // of the sample's volume
    const double step_s = wide(1e-6, 2e-3), step_deg = random.between(-34, 34);
    const double widest_m2 = wide(1e-3, 1e3) * 1e-3 * std::pow(scale, 2.0 / 3);
    GasBench<Real> bench(wide(1e3, 1e7), wide(200, 2500), random.between(0, 1), scale * volume_m3(0));
    bench.fuel_J_kg = 44e6, bench.fuel_burned_kg_kg = 15.6;
    bench.walls = {real(130e-4), real(0.0116 * std::pow(scale, 2.0 / 3)), real(46.5 / std::cbrt(scale)), real(423),
                   real(0.027)};
    for (int port = 0; port < 2; ++port) bench.given(port, wide(1e3, 1e7), wide(200, 2500), random.between(0, 1));
    for (int i = 1; i <= 300; ++i) {
      const auto area = [&] { return random.between(0, 1) < 0.3 ? 0 : random.between(0, widest_m2); };
      const double intake_m2 = area(), exhaust_m2 = area();
      const double mass_kg = static_cast<double>(bench.gas.contents.mass_kg);
      const double air_kg = mass_kg - static_cast<double>(bench.gas.contents.burned_kg);
      const double fuel_kg = random.between(0, 1) < 0.05 ? std::fmax(0, std::fmin(0.012 * mass_kg, air_kg / 14.6)) : 0;
      (void)bench.step(step_s, scale * volume_m3(i * step_deg), intake_m2, exhaust_m2, fuel_kg);
      const auto& now = bench.gas;
      ASSERT_TRUE(std::isfinite(now.point.pressure_Pa) && now.point.pressure_Pa > 0) << i;
      ASSERT_TRUE(std::isfinite(now.point.temperature_K) && now.point.temperature_K > 0) << i;
      ASSERT_TRUE(std::isfinite(now.contents.mass_kg) && now.contents.mass_kg > 0) << i;
      ASSERT_TRUE(std::isfinite(now.contents.energy_J) && now.contents.energy_J > 0) << i;
      ASSERT_GE(now.contents.burned_kg, -now.contents.mass_kg * real(1e-5)) << i;
      ASSERT_LE(now.contents.burned_kg, now.contents.mass_kg * real(1 + 1e-5)) << i;
    }
  }
}

TEST(GasFlow, IsTheEllipseOfSaintVenant) {
  const double from[] = {1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.05, 0.1, 0.2, 0.3, 0.4, 0.4648, 0.47, 0.6, 0.8, 0.999};
  for (const double drop : from) {
    const detail::GasPoint<double> gas{2e5, 400, 0.5, 0.35};
    const detail::GasPoint<double> lower{2e5 * (1 - drop), 400, 0.5, 0.35};
    const double in = detail::Orifice<double>::at(lower.pressure_Pa, 400, detail::beyond(gas, 0.0)).flow_kg_s_m2;
    const double out = detail::Orifice<double>::at(gas.pressure_Pa, 400, detail::beyond(lower, 0.0)).flow_kg_s_m2;
    EXPECT_NEAR(in / support::saint_venant(2e5, 2e5 * (1 - drop), 400), 1, 0.006) << drop;
    EXPECT_NEAR(in, -out, in * 1e-15);
  }
}

/// Hohenberg's: 130 V^-0.06 (p/bar)^0.8 T^-0.4 (v + 1.4)^0.8 W/(m2 K), of the volume as it is; the first step takes one
/// and a half of it, its own begin and half of that again.
TYPED_TEST(GasStep, LosesHeatByItsOwnVolume) {
  using Real = TypeParam;
  const auto real = [](double x) { return static_cast<Real>(x); };
  for (const double volume_m3 : {5e-8, 3e-6, 5.3e-5, 5.5e-4, 2e-2}) {
    GasBench<Real> bench(40e5, 1200, 0.3, volume_m3);
    bench.walls = {real(130e-4), real(0.0116), real(46.5), real(423), real(0.027)};
    const double film_W_m2K =
        130 * std::pow(volume_m3, -0.06) * std::pow(40, 0.8) * std::pow(1200, -0.4) * std::pow(1.4, 0.8);
    const double step_s = 1e-9;
    const double lost_J = static_cast<double>(bench.step(step_s, volume_m3).closed.wall_heat_J);
    EXPECT_NEAR(lost_J / (1.5 * step_s * film_W_m2K * (0.0116 + 46.5 * volume_m3) * (1200 - 423)), 1, 1e-4)
        << volume_m3;
  }
}

TYPED_TEST(GasStep, KnowsThePowerOfAVolume) {
  using Real = TypeParam;
  for (double volume = 1e-12; volume < 250; volume *= 1.0123) {
    const Real x = static_cast<Real>(volume);
    EXPECT_NEAR(static_cast<double>(detail::volume_power(x)) / std::pow(static_cast<double>(x), -0.06), 1, 5e-5) << x;
  }
  for (const Real x : {Real{0}, Real{-1}, std::numeric_limits<Real>::min(), std::numeric_limits<Real>::max(),
                       std::numeric_limits<Real>::quiet_NaN()}) {
    EXPECT_TRUE(std::isfinite(detail::volume_power(x)));
  }
}

TYPED_TEST(GasStep, KnowsThePowerOfTwoFifths) {
  using Real = TypeParam;
  for (double u = 1e3; u < 1e13; u *= 1.0123) {
    const Real x = static_cast<Real>(u);
    EXPECT_NEAR(static_cast<double>(detail::power_two_fifths(x)) / std::pow(static_cast<double>(x), 0.4), 1, 2e-5) << u;
  }
  for (const Real x : {Real{0}, std::numeric_limits<Real>::min(), std::numeric_limits<Real>::max(),
                       std::numeric_limits<Real>::infinity()}) {
    EXPECT_TRUE(std::isfinite(detail::power_two_fifths(x)));
  }
}

}  // namespace
}  // namespace crankloop::gas_step_test
