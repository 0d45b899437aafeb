// A spring's modes over a tick: against the differential equation, a chain of masses, and the static spring.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <vector>

#include <crankloop/tabulate/spring_surge.hpp>

#include "support/status.hpp"
#include "support/units.hpp"

namespace crankloop::spring_surge_test {
namespace {

using support::kPi;

constexpr double kTick_s = 20e-6;

/// 60 g at 40 N/mm.
SurgingSpring spring_60_g(int modes, double damping_ratio = 0) { return {40e3, 60e-3, damping_ratio, modes}; }

SpringSurge surge_at(const SurgingSpring& spring, double tick_s = kTick_s) {
  SpringSurge surge;
  EXPECT_TRUE(accepted(surge_of(spring, tick_s, surge)));
  return surge;
}

/// The modes of a spring whose end moves.
struct Ringing {
  explicit Ringing(const SpringSurge& of) : surge{of} {}

  void step(double mean_m_s2) {
    for (int i = 0; i < surge.modes; ++i) {
      const detail::ModeStep<double>& m = surge.mode[i].step;
      const double was_m = q[i];
      q[i] += m.of_q.q * was_m + m.of_q.v * v[i] + m.of_q.drive * mean_m_s2;
      v[i] += m.of_v.q * was_m + m.of_v.v * v[i] + m.of_v.drive * mean_m_s2;
    }
  }
  [[nodiscard]] double force_N() const {
    double force = 0;
    for (int i = 0; i < surge.modes; ++i) force += surge.mode[i].step.valve_N_m * q[i];
    return force;
  }

  SpringSurge surge;
  double q[kMaxSpringModes] = {}, v[kMaxSpringModes] = {};
};

/// An 8 mm raised cosine in 4.29 ms; then the end stands still.
struct RaisedCosine {
  static constexpr double kHeight_m = 8e-3, kTime_s = 4.29e-3, kRate = 2 * kPi / kTime_s;

  static double lift_m(double t) { return t < kTime_s ? kHeight_m / 2 * (1 - std::cos(kRate * t)) : 0; }
  static double speed_m_s(double t) { return t < kTime_s ? kHeight_m / 2 * kRate * std::sin(kRate * t) : 0; }
  static double acceleration_m_s2(double t) {
    return t < kTime_s ? kHeight_m / 2 * kRate * kRate * std::cos(kRate * t) : 0;
  }
};

/// The spring as 400 masses between springs, the last half a mass at the moving end. Steps of 50 ns: an eighth of what
/// its fastest oscillation allows.
class Chain {
 public:
  Chain(double rate_N_m, double active_kg) : rate_N_m_{rate_N_m * kMasses}, mass_kg_{active_kg / kMasses} {}

  void advance(double duration_s) {
    const int steps = static_cast<int>(std::lround(duration_s / 50e-9));
    const double h = duration_s / steps;
    for (int i = 0; i < steps; ++i, t_ += h) {
      place_[kMasses] = RaisedCosine::lift_m(t_);
      for (std::size_t j = 1; j < kMasses; ++j)
        speed_[j] += h * rate_N_m_ / mass_kg_ * (place_[j + 1] - 2 * place_[j] + place_[j - 1]);
      for (std::size_t j = 1; j < kMasses; ++j) place_[j] += h * speed_[j];
    }
    place_[kMasses] = RaisedCosine::lift_m(t_);
  }
  /// On what moves its end.
  [[nodiscard]] double force_N() const {
    return rate_N_m_ * (place_[kMasses] - place_[kMasses - 1]) + mass_kg_ / 2 * RaisedCosine::acceleration_m_s2(t_);
  }

 private:
  static constexpr std::size_t kMasses = 400;
  double rate_N_m_, mass_kg_;
  double t_ = 0;
  std::vector<double> place_ = std::vector<double>(kMasses + 1), speed_ = std::vector<double>(kMasses + 1);
};

TEST(SpringSurge, OfSixtyGramsAtFortyNewtonPerMillimetreIs408Hz) {
  const SpringSurge surge = surge_at(spring_60_g(3, 0.01));
  EXPECT_NEAR(surge_frequency_rad_s(spring_60_g(1)) / (2 * kPi), 408.2, 0.05);
  for (int n = 1; n <= 3; ++n) {
    EXPECT_NEAR(surge.mode[n - 1].rate_rad_s / (2 * kPi), 408.248 * n, 0.01 * n);
    // A wave along the spring takes sqrt(m/k): a mode has n half waves.
    EXPECT_NEAR(surge.mode[n - 1].rate_rad_s * std::sqrt(60e-3 / 40e3), n * kPi, 1e-12);
  }
}

TEST(SpringSurge, StepsItsModesAsTheirDifferentialEquationDoes) {
  for (const double tick_s : {10e-6, 20e-6, 100e-6}) {
    for (const double damping : {0.01, 0.3}) {
      Ringing tick(surge_at(spring_60_g(3, damping), tick_s));
      double q[3] = {1e-3, -2e-3, 5e-4}, v[3] = {3, 1, -4};
      std::copy(q, q + 3, tick.q), std::copy(v, v + 3, tick.v);
      for (int i = 0; i < 50; ++i) {
        const double accelerates_m_s2 = 5000 * std::sin(0.3 * i) + 800;
        tick.step(accelerates_m_s2);
        for (int n = 1; n <= 3; ++n) {
          const double w = n * kPi * std::sqrt(40e3 / 60e-3);
          const double drive = 2 * (n % 2 == 0 ? 1 : -1) / (n * kPi) * accelerates_m_s2;
          const auto rate = [&](double x, double speed) { return drive - 2 * damping * w * speed - w * w * x; };
          constexpr int kParts = 40;
          const double h = tick_s / kParts;
          double &x = q[n - 1], &s = v[n - 1];
          for (int part = 0; part < kParts; ++part) {  // classical Runge-Kutta
            const double a1 = rate(x, s), a2 = rate(x + h / 2 * s, s + h / 2 * a1);
            const double a3 = rate(x + h / 2 * (s + h / 2 * a1), s + h / 2 * a2);
            const double a4 = rate(x + h * (s + h / 2 * a2), s + h * a3);
            x += h * s + h * h / 6 * (a1 + a2 + a3), s += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
          }
          EXPECT_NEAR(tick.q[n - 1], x, 1e-10) << n << " " << tick_s << " " << damping;
          EXPECT_NEAR(tick.v[n - 1], s, 1e-6) << n << " " << tick_s << " " << damping;
        }
      }
    }
  }
}

TEST(SpringSurge, ComesNearerAChainOf400MassesWithEachMode) {
  double rms_N[4] = {}, low_N = 1e9, high_N = -1e9;
  Ringing ringing[4] = {Ringing(surge_at(spring_60_g(0))), Ringing(surge_at(spring_60_g(1))),
                        Ringing(surge_at(spring_60_g(2))), Ringing(surge_at(spring_60_g(3)))};
  Chain chain(40e3, 60e-3);
  const int ticks = static_cast<int>(2 * RaisedCosine::kTime_s / kTick_s);  // as long again it rings
  for (int i = 0; i < ticks; ++i) {
    const double from = i * kTick_s, to = (i + 1) * kTick_s;
    chain.advance(kTick_s);
    low_N = std::min(low_N, chain.force_N()), high_N = std::max(high_N, chain.force_N());
    for (int modes = 0; modes <= 3; ++modes) {
      ringing[modes].step((RaisedCosine::speed_m_s(to) - RaisedCosine::speed_m_s(from)) / kTick_s);
      const double force_N = 40e3 * RaisedCosine::lift_m(to) + ringing[modes].force_N() +
                             (60e-3 / 3 - ringing[modes].surge.moving_kg) * RaisedCosine::acceleration_m_s2(to);
      rms_N[modes] += (force_N - chain.force_N()) * (force_N - chain.force_N()) / ticks;
    }
  }
  for (double& error : rms_N) error = std::sqrt(error);
  std::printf("[ figures  ] against 400 masses, range %.0f N: rms %.1f, %.1f, %.1f, %.1f N with 0 to 3 modes\n",
              high_N - low_N, rms_N[0], rms_N[1], rms_N[2], rms_N[3]);
  EXPECT_NEAR(high_N - low_N, 588, 3);
  EXPECT_NEAR(rms_N[0], 141, 2);
  EXPECT_NEAR(rms_N[1], 34, 1);
  EXPECT_NEAR(rms_N[2], 12, 1);
  EXPECT_LT(rms_N[3], rms_N[2]);
}

TEST(SpringSurge, TakesAwayTheMassThatItsModesMove) {
  // All modes together move what the spring counts for, m / 3. Under an even acceleration they push as that mass does.
  double all_kg = 0;
  for (int n = 1; n <= 100000; ++n) all_kg += 2 * 60e-3 / (kPi * kPi * n * n);
  EXPECT_NEAR(all_kg, 60e-3 / 3, 1e-6);
  for (int modes = 1; modes <= 3; ++modes) {
    Ringing ringing(surge_at(spring_60_g(modes, 0.5)));
    EXPECT_LT(ringing.surge.moving_kg, 60e-3 / 3);
    for (int i = 0; i < 2000; ++i) ringing.step(1000);
    EXPECT_NEAR(ringing.force_N(), 1000 * ringing.surge.moving_kg, 1e-9);
  }
}

TEST(SpringSurge, StandsStillAtRestAndKeepsTheEnergyOfAnUndampedSpring) {
  Ringing resting(surge_at(spring_60_g(3)));
  for (int i = 0; i < 1000; ++i) resting.step(0);
  EXPECT_EQ(resting.force_N(), 0);
  Ringing ringing(surge_at(spring_60_g(3)));
  const auto energy = [&ringing](int n) {
    const double w = ringing.surge.mode[n].rate_rad_s;
    return ringing.v[n] * ringing.v[n] + w * w * ringing.q[n] * ringing.q[n];
  };
  for (double& q : ringing.q) q = 1e-3;
  const double start[] = {energy(0), energy(1), energy(2)};
  for (int i = 0; i < 10000000; ++i) ringing.step(0);
  for (int n = 0; n < 3; ++n) EXPECT_NEAR(energy(n) / start[n], 1, 1e-9);
}

TEST(SpringSurge, RefusesWhatItCannotStep) {
  SpringSurge surge;
  const auto refused_for = [&surge](SurgingSpring spring, double tick_s) { return surge_of(spring, tick_s, surge); };
  const SurgingSpring good = spring_60_g(2, 0.01);
  const auto with = [&good](auto change) {
    SurgingSpring spring = good;
    change(spring);
    return spring;
  };
  struct Case {
    SurgingSpring spring;
    double tick_s;
    const char* field;
    Reason reason;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Case cases[] = {
      {with([](auto& s) { s.modes = -1; }), kTick_s, "spring.modes", Reason::out_of_range},
      {with([](auto& s) { s.modes = 4; }), kTick_s, "spring.modes", Reason::out_of_range},
      {with([](auto& s) { s.rate_N_m = 0; }), kTick_s, "spring.rate_N_m", Reason::not_positive},
      {with([](auto& s) { s.active_kg = 0; }), kTick_s, "spring.active_kg", Reason::not_positive},
      {with([nan](auto& s) { s.active_kg = nan; }), kTick_s, "spring.active_kg", Reason::not_positive},
      {with([](auto& s) { s.damping_ratio = 1; }), kTick_s, "spring.damping_ratio", Reason::out_of_range},
      {with([nan](auto& s) { s.damping_ratio = nan; }), kTick_s, "spring.damping_ratio", Reason::out_of_range},
      {with([](auto& s) { s.rate_N_m = std::numeric_limits<double>::infinity(); }), kTick_s, "spring.rate_N_m",
       Reason::not_positive},
      {with([](auto& s) {
         s.rate_N_m = std::numeric_limits<double>::denorm_min();
         s.active_kg = 1e9;  // no frequency is left of them
       }),
       kTick_s, "tick_s", Reason::out_of_range},
      {good, 0, "tick_s", Reason::out_of_range},
      {good, 400e-6, "tick_s", Reason::out_of_range}};
  for (const Case& c : cases) {
    const Status status = refused_for(c.spring, c.tick_s);
    EXPECT_EQ(status.reason, c.reason) << c.field;
    EXPECT_STREQ(status.field, c.field);
  }
  EXPECT_TRUE(accepted(refused_for(with([](auto& s) { s.damping_ratio = 0; }), 20e-6)));
}

}  // namespace
}  // namespace crankloop::spring_surge_test
