// Kinematics in the tick against the exact mechanism: at a million random phases and on both sides of every segment
// border, through the engine as a user runs it and through the tables themselves.
//
// Oracle: support/tick_oracle.hpp, long double and the C library.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "support/engines.hpp"
#include "support/random.hpp"
#include "support/running.hpp"
#include "support/status.hpp"
#include "support/tick_oracle.hpp"

namespace crankloop::tick_kinematics_test {

using namespace detail;
namespace {

using namespace tick_test;
using support::Random;

/// What the issue promises: of r, r w and r w^2; of 1, w and w^2 for the rod.
template <class Real>
constexpr double kTolerance = sizeof(Real) == 4 ? 4e-7 : 2e-9;

constexpr int kRandomPhases = 1'000'000;  // over all mechanisms together
constexpr double kTick_s = 100e-6;

using ByPhase = Asking<kKinematics | kRodMotion, PressureGiven::none, false, CrankGiven::phase, 1>;
using BySpeed = Asking<kKinematics | kRodMotion, PressureGiven::none, false, CrankGiven::speed, 1>;

/// Corners and middle of the promised range, lambda 0.15 to 0.45 and offset up to 0.2 r to either side, with radii that
/// are no round numbers: where r stands between two powers of two decides what float's rounding is worth.
std::vector<Crank> mechanisms(Random& random) {
  std::vector<Crank> cranks;
  for (const double lambda : {0.15, 0.21, 0.2738, 0.32, 0.45}) {
    for (const double offset : {-0.2, -0.03, 0.0, 0.2}) {
      const double r = random.between(0.02, 0.2);
      cranks.push_back({0.1, r, r / lambda, offset * r, 10});
    }
  }
  return cranks;
}

/// Error or motion of each kinematic output, in units of r, r w, r w^2 (piston) and 1, w, w^2 (rod).
struct Six {
  double x = 0, v = 0, a = 0, angle = 0, rod_speed = 0, rod_acceleration = 0;

  [[nodiscard]] double largest() const { return std::max({x, v, a, angle, rod_speed, rod_acceleration}); }
};
void keep_largest(Six& worst, const Six& now) {
  worst.x = std::max(worst.x, now.x);
  worst.v = std::max(worst.v, now.v);
  worst.a = std::max(worst.a, now.a);
  worst.angle = std::max(worst.angle, now.angle);
  worst.rod_speed = std::max(worst.rod_speed, now.rod_speed);
  worst.rod_acceleration = std::max(worst.rod_acceleration, now.rod_acceleration);
}
double apart(double a, double b) { return std::fabs(a - b); }
double apart(long double a, long double b) { return static_cast<double>(std::fabs(a - b)); }
Six apart(const Six& p, const Six& q) {
  return {apart(p.x, q.x),
          apart(p.v, q.v),
          apart(p.a, q.a),
          apart(p.angle, q.angle),
          apart(p.rod_speed, q.rod_speed),
          apart(p.rod_acceleration, q.rod_acceleration)};
}
template <class Real>
void print(const char* what, const Six& s) {
  std::printf(
      "[ measured ] %s, %s: x %.3g r, v %.3g r w, a %.3g r w^2; rod angle %.3g rad, speed %.3g w, acceleration %.3g "
      "w^2\n",
      sizeof(Real) == 4 ? "float" : "double", what, s.x, s.v, s.a, s.angle, s.rod_speed, s.rod_acceleration);
}

/// What an engine answered, freed of its size and speed.
template <class Engine>
Six answer(const Engine& engine, const Crank& crank) {
  const auto& out = engine.output();
  const auto number = [](auto real) { return static_cast<double>(real); };
  const double r = crank.crank_radius_m;
  const double w = number(engine.state().speed_rad_s);
  return {number(out.displacement_m[0]) / r,
          number(out.velocity_m_s[0]) / (r * w),
          number(out.acceleration_m_s2[0]) / (r * w * w),
          number(out.rod_angle_rad[0]),
          number(out.rod_speed_rad_s[0]) / w,
          number(out.rod_acceleration_rad_s2[0]) / (w * w)};
}

Six oracle(const Crank& crank, Phase phase) {
  const OraclePose p =
      oracle_pose(crank, static_cast<long double>(phase.units()) * (4 * kWidePi / 18446744073709551616.0L));
  const double r = crank.crank_radius_m;
  return {static_cast<double>(p.displacement_m) / r, static_cast<double>(p.slope_m) / r,
          static_cast<double>(p.acceleration_m) / r, static_cast<double>(p.rod_angle_rad),
          static_cast<double>(p.rod_slope),          static_cast<double>(p.rod_curvature)};
}

template <class Real>
EngineDefinition engine_with(const Crank& crank) {
  EngineDefinition engine = without_gas(single_495());
  engine.crank = crank;
  return engine;
}

/// Measures the angle before and at `phase`: the second answer has a known speed. The step before is 0.03 to 28 deg,
/// either way.
template <class Engine>
void arrive(Engine& engine, Phase phase, Random& random) {
  const double before = random.between(0.00004, 0.04);
  typename Engine::Input in;
  in.crank = phase - Phase::from_cycles(random.coin() ? before : -before);
  engine.step(in);
  in.crank = phase;
  engine.step(in);
}

template <class Real>
class TickKinematics : public ::testing::Test {};
TYPED_TEST_SUITE(TickKinematics, BothReals, RealName);

TYPED_TEST(TickKinematics, AtAMillionRandomPhasesOfTwentyMechanismsAreExactToThePromise) {
  using Real = TypeParam;
  Random random;
  const std::vector<Crank> cranks = mechanisms(random);
  FullTables<Real> tables;
  Six worst;
  int draw = 0;
  for (const Crank& crank : cranks) {
    ASSERT_TRUE(accepted(tables.build(engine_with<Real>(crank), kTick_s)));
    Running<Real, ByPhase> run(tables);
    for (int i = 0; i < kRandomPhases / static_cast<int>(cranks.size()); ++i, ++draw) {
      const Phase phase{random.bits()};
      arrive(run.engine, phase, random);
      const Six error = apart(answer(run.engine, crank), oracle(crank, phase));
      ASSERT_LE(error.largest(), kTolerance<Real>)
          << random.trace(draw) << ", lambda " << crank.rod_ratio() << ", e/r "
          << crank.pin_offset_m / crank.crank_radius_m << " at " << static_cast<double>(deg_of(phase)) << " deg";
      keep_largest(worst, error);
    }
  }
  print<Real>("a million phases", worst);
}

TYPED_TEST(TickKinematics, OnBothSidesOfEveryBorderAreExactAndWithoutAStep) {
  using Real = TypeParam;
  Random random;
  FullTables<Real> tables;
  Six worst;
  Six step;
  // float reads the phase's top word: there the neighbours that differ are 2^32 units apart.
  const std::uint64_t one = sizeof(Real) == 4 ? std::uint64_t{1} << 32 : 1;
  for (const Crank& crank : mechanisms(random)) {
    ASSERT_TRUE(accepted(tables.build(engine_with<Real>(crank), kTick_s)));
    Running<Real, ByPhase> run(tables);
    for (std::uint32_t degree = 0; degree < 720; ++degree) {
      // The first phase whose cell is this degree: the border by long double, then by asking.
      Phase border = phase_at_deg(degree) - Phase{2 * one};
      border = Phase{border.units() / one * one};
      while (border.cell<Real>().degree != degree) border += Phase{one};
      Six last;
      for (int k = -1; k <= 1; ++k) {
        const Phase phase = border + Phase{static_cast<std::uint64_t>(k) * one};
        arrive(run.engine, phase, random);
        const Six now = answer(run.engine, crank);
        const Six error = apart(now, oracle(crank, phase));
        ASSERT_LE(error.largest(), kTolerance<Real>)
            << random.trace(static_cast<int>(degree)) << ", lambda " << crank.rod_ratio() << ", e/r "
            << crank.pin_offset_m / crank.crank_radius_m << ", unit " << k << " of degree " << degree;
        keep_largest(worst, error);
        if (k > -1) {
          ASSERT_LE(apart(now, last).largest(), kTolerance<Real>)
              << "a step at degree " << degree << ", lambda " << crank.rod_ratio();
          keep_largest(step, apart(now, last));
        }
        last = now;
      }
    }
  }
  print<Real>("at borders", worst);
  print<Real>("steps at borders", step);
}

TYPED_TEST(TickKinematics, GoAroundWithoutAStepAt360And720InSmallTicksEitherWay) {
  using Real = TypeParam;
  FullTables<Real> tables;
  const Crank crank = {0.1, 0.0571, 0.127, 0.0114, 10};
  ASSERT_TRUE(accepted(tables.build(engine_with<Real>(crank), 1e-6)));
  for (const long double border_deg : {360.0L, 720.0L}) {
    for (const Real speed : {Real{3}, Real{-3}}) {
      Running<Real, BySpeed> run(tables, phase_at_deg(border_deg - (speed > Real{0} ? 0.02L : -0.02L)));
      typename Engine<Real, BySpeed>::Input in;
      in.speed_rad_s = speed;
      run.engine.step(in);
      Six last = answer(run.engine, crank);
      for (int tick = 0; tick < 240; ++tick) {  // 3 rad/s turns 0.04 deg in 233 us
        run.engine.step(in);
        const Six now = answer(run.engine, crank);
        // In a tick of 3e-6 rad nothing moves by more than 3e-6 times the largest slope, jerk 1 + 4 lambda.
        const double moves = 3e-6 * (1 + 4 * crank.rod_ratio()) * 1.5;
        ASSERT_LE(apart(now, last).largest(), moves + kTolerance<Real>)
            << "tick " << tick << " around " << static_cast<double>(border_deg);
        last = now;
      }
    }
  }
}

TYPED_TEST(TickKinematics, TablesReadByHandHoldThePromiseForEveryCurve) {
  using Real = TypeParam;
  Random random;
  FullTables<Real> tables;
  double displacement = 0, slope = 0, acceleration = 0, tilt = 0, radial = 0, angle = 0, rod_slope = 0, curvature = 0,
         inertia = 0, stroke = 0, stroke_slope = 0;
  for (const Crank& crank : mechanisms(random)) {
    const EngineDefinition engine = engine_with<Real>(crank);
    ASSERT_TRUE(accepted(tables.build(engine, kTick_s)));
    const Sections<Real>& s = tables.sections();
    const double r = crank.crank_radius_m;
    const double mass_r2 = engine.masses.reciprocating_kg() * crank.crank_radius_m * crank.crank_radius_m;
    for (int i = 0; i < 20'000; ++i) {
      const Phase phase{random.bits()};
      const Cell cell = phase.cell<Real>();
      const std::uint32_t degree = cell.degree % 360;
      const Real u = fraction<Real>(cell);
      const OraclePose want =
          oracle_pose(crank, static_cast<long double>(phase.units()) * (4 * kWidePi / 18446744073709551616.0L));
      const auto read = [&](const auto& curve) { return static_cast<long double>(value(curve.at[degree], u)); };
      const auto read_slope = [&](const auto& curve) {
        return static_cast<long double>(value(curve.at[degree].slope, u));
      };
      const auto read_integral = [&](const auto& curve) {
        return static_cast<long double>(
            detail::total(detail::integral_at(curve.at[degree], u, Real{0}), curve.quantum));
      };
      const MotionSegment<Real>& motion = s.motion->at[degree];
      const LeanSegment<Real>& lean = s.lean->at[degree];
      const RodSegment<Real>& rod = s.rod->at[degree];
      const auto keep = [u](double& largest, const auto& segment, long double exact, double unit) {
        largest = std::max(largest, apart(static_cast<long double>(value(segment, u)), exact) / unit);
      };
      keep(displacement, motion.displacement, want.displacement_m, r);
      keep(slope, motion.slope, want.slope_m, r);
      keep(acceleration, motion.acceleration, want.acceleration_m, r);
      keep(tilt, lean.tilt, want.rod_tilt, 1);
      keep(radial, lean.radial, want.radial, 1);
      keep(angle, rod.angle, want.rod_angle_rad, 1);
      keep(rod_slope, rod.slope, want.rod_slope, 1);
      stroke = std::max(stroke, apart(read_integral(*s.stroke), want.displacement_m) / r);
      stroke_slope = std::max(stroke_slope, apart(read_slope(*s.stroke), want.slope_m) / r);
      curvature = std::max(curvature, apart(read(*s.rod_curvature), want.rod_curvature));
      long double torque = 0;
      const auto cylinders = static_cast<std::size_t>(engine.layout.cylinders);
      for (std::size_t k = 0; k < cylinders; ++k) {
        const long double firing = wide(engine.layout.firing_deg[k]) * kWidePi / 180;
        const OraclePose p = oracle_pose(
            crank, static_cast<long double>(phase.units()) * (4 * kWidePi / 18446744073709551616.0L) - firing);
        torque -= wide(engine.masses.reciprocating_kg()) * p.slope_m * p.acceleration_m +
                  wide(engine.masses.rod_inertia_correction_kg_m2) * p.rod_slope * p.rod_curvature;
      }
      inertia =
          std::max(inertia, apart(read_slope(*s.inertia_torque), torque) / (mass_r2 * static_cast<double>(cylinders)));
    }
  }
  const double tolerance = kTolerance<Real>;
  EXPECT_LE(displacement, tolerance) << random.trace(0);
  EXPECT_LE(slope, tolerance) << random.trace(0);
  EXPECT_LE(acceleration, tolerance) << random.trace(0);
  EXPECT_LE(tilt, tolerance) << random.trace(0);
  EXPECT_LE(radial, tolerance) << random.trace(0);
  EXPECT_LE(angle, tolerance) << random.trace(0);
  EXPECT_LE(rod_slope, tolerance) << random.trace(0);
  EXPECT_LE(curvature, tolerance) << random.trace(0);
  // As a polynomial of its own x is as exact as an integral that is added up in the tick, to a rounding here and there.
  EXPECT_LE(displacement, 1.05 * stroke);
  EXPECT_LE(stroke, tolerance) << random.trace(0);
  EXPECT_LE(stroke_slope, tolerance) << random.trace(0);
  // Piston speed times acceleration has harmonics up to the third where each has two: steeper, so its fit errs
  // (3/2)^(degree + 1) as much.
  const double product = sizeof(Real) == 4 ? 3.4 : 5.1;
  EXPECT_LE(inertia, product * tolerance) << random.trace(0);
  std::printf(
      "[ measured ] %s, tables: x %.3g r, dx/da %.3g r, d2x/da2 %.3g r, tan b %.3g, radial %.3g, b %.3g, db/da %.3g, "
      "d2b/da2 %.3g, "
      "inertia torque %.3g m r^2\n",
      sizeof(Real) == 4 ? "float" : "double", displacement, slope, acceleration, tilt, radial, angle, rod_slope,
      curvature, inertia);
}

TYPED_TEST(TickKinematics, DisplacementNeverLeavesTheStroke) {
  using Real = TypeParam;
  Random random;
  FullTables<Real> tables;
  for (const Crank& crank : mechanisms(random)) {
    ASSERT_TRUE(accepted(tables.build(engine_with<Real>(crank), kTick_s)));
    Running<Real, ByPhase> run(tables);
    const double r = crank.crank_radius_m;
    const double l = crank.rod_length_m;
    const double e = crank.pin_offset_m;
    const double stroke = std::sqrt((l + r) * (l + r) - e * e) - std::sqrt((l - r) * (l - r) - e * e);
    for (const double centre : {std::asin(e / (l + r)), kPi + std::asin(e / (l - r))}) {
      for (int i = -200; i <= 200; ++i) {
        typename Engine<Real, ByPhase>::Input in;
        in.crank = phase_at_deg(wide(centre * 180 / kPi + i * 0.001));
        const double x = static_cast<double>(run.engine.step(in).displacement_m[0]);
        ASSERT_GE(x, -kTolerance<Real> * r);
        ASSERT_LE(x, stroke + kTolerance<Real> * r);
      }
    }
  }
}

}  // namespace
}  // namespace crankloop::tick_kinematics_test
