// Free forces and moments of whole engines, against sums over every moving part. Pins and journals: bearings_test.cpp.
#include <crankloop/tabulate/summary.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "support/balance_of_parts.hpp"

namespace crankloop::balance_of_parts::balance_test {
namespace {

// ---- engines --------------------------------------------------------------------------------------------------------

constexpr double kSpacing_m = 0.12;

/// In line, with the throws given from front to back.
EngineDefinition in_line(const std::vector<double>& throws_deg) {
  std::vector<Place> places;
  for (std::size_t k = 0; k < throws_deg.size(); ++k) {
    places.push_back({throws_deg[k], 0, kSpacing_m * static_cast<double>(k), false, static_cast<std::uint8_t>(k)});
  }
  return engine_with(places);
}

/// Two cylinders on every pin, at -bank and +bank.
EngineDefinition v_engine(const std::vector<double>& throws_deg, double bank_deg, double stagger_m = 0) {
  std::vector<Place> places;
  for (std::size_t k = 0; k < throws_deg.size(); ++k) {
    for (const double side : {-1.0, 1.0}) {
      places.push_back({throws_deg[k], side * bank_deg,
                        kSpacing_m * static_cast<double>(k) + (side > 0 ? stagger_m : 0), false,
                        static_cast<std::uint8_t>(k)});
    }
  }
  return engine_with(places);
}

EngineDefinition cross_plane_v8() { return v_engine({-45, 45, 225, 135}, 45); }
EngineDefinition boxer_four() {
  // Banks alternate along the shaft, throws 0, 180, 180, 0: opposite pistons move against each other.
  return engine_with({{90, 90, 0, false, 0},
                      {270, -90, kSpacing_m, false, 1},
                      {270, 90, 2 * kSpacing_m, false, 2},
                      {90, -90, 3 * kSpacing_m, false, 3}});
}

// ---- the sum over parts ---------------------------------------------------------------------------------------------

/// What all pistons and small ends push into the block at 1 rad/s: minus mass times acceleration, exact motion.
Load exact_reciprocating(const EngineDefinition& e, Wide engine_deg) {
  Load sum;
  for (std::size_t k = 0; k < static_cast<std::size_t>(e.layout.cylinders); ++k) {
    const support::Motion m = support::motion_at(e.crank, own_deg(e.layout, k, engine_deg) * kRadPerDeg, 1);
    const Wide mass = wide(e.masses.piston_kg) + wide(e.masses.rod_small_end_kg);
    sum.add(turned((-mass) * m.piston_pin_acceleration, wide(e.layout.bank_deg[k])),
            wide(e.layout.position_m[k]) - middle_of_shaft(e.layout));
  }
  return sum;
}

Load of_turning(const detail::RotatingVector<double>& t, int order, Wide engine_deg) {
  const Wide c = std::cos(order * engine_deg * kRadPerDeg);
  const Wide s = std::sin(order * engine_deg * kRadPerDeg);
  const auto at = [&](double cosine, double sine) { return wide(cosine) * c + wide(sine) * s; };
  return {at(t.up_cos, t.up_sin), at(t.lateral_cos, t.lateral_sin), at(t.pitch_cos, t.pitch_sin),
          at(t.yaw_cos, t.yaw_sin)};
}

void expect_balance_of_parts(const EngineDefinition& e) {
  const detail::Balance<double> b = balance_of(e);
  const double tolerance = rounding_kg_m(e);
  const double arm = arm_m(e);
  for (int deg = 0; deg < 720; deg += 7) {
    SCOPED_TRACE("at " + std::to_string(deg) + " deg");
    expect_same(of_turning(b.first, 1, deg), exact_order(e, deg, 1), tolerance, arm);
    expect_same(of_turning(b.second, 2, deg), exact_order(e, deg, 2), tolerance, arm);
    expect_same(of_turning(b.rotating, 1, deg), rotating(e, deg), tolerance, arm);
    if (testing::Test::HasFailure()) return;
  }
}

struct Named {
  const char* name;
  EngineDefinition engine;
};
std::vector<Named> known_engines() {
  return {{"single", in_line({0})},
          {"parallel twin, 360 deg", in_line({0, 0})},
          {"parallel twin, 180 deg", in_line({0, 180})},
          {"inline three", in_line({0, 240, 120})},
          {"inline four", in_line({0, 180, 180, 0})},
          {"inline five", in_line({0, 144, 216, 288, 72})},
          {"inline six", in_line({0, 240, 120, 120, 240, 0})},
          {"90 deg V-twin", v_engine({-45}, 45)},
          {"45 deg V-twin with staggered rods", v_engine({-22.5}, 22.5, 0.024)},
          {"odd-fire 90 deg V6", v_engine({-45, 75, 195}, 45)},
          {"90 deg cross-plane V8", cross_plane_v8()},
          {"cross-plane V8 with staggered banks", v_engine({-45, 45, 225, 135}, 45, 0.02)},
          {"60 deg V12", v_engine({-30, 210, 90, 90, 210, -30}, 30)},
          {"boxer four", boxer_four()}};
}

TEST(Balance, OfEveryKnownEngineIsTheSumOverItsParts) {
  for (Named& known : known_engines()) {
    for (const double offset_m : {0.0, 0.008, -0.008}) {
      SCOPED_TRACE(std::string(known.name) + ", offset " + std::to_string(offset_m));
      known.engine.crank.pin_offset_m = offset_m;
      expect_balance_of_parts(known.engine);
    }
  }
}

TEST(Balance, OfAnyEngineIsTheSumOverItsParts) {
  Random random;
  for (int draw = 0; draw < 200; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    expect_balance_of_parts(random_layout(random));
    if (HasFailure()) return;
  }
}

TEST(Balance, HasEveryFourierTermOfTheExactForces) {
  Random random;
  std::vector<Named> engines = known_engines();
  for (Named& offset : known_engines()) {
    offset.engine.crank.pin_offset_m = 0.008;
    engines.push_back(offset);
  }
  for (int draw = 0; draw < 10; ++draw) engines.push_back({"random", random_layout(random)});
  for (const Named& known : engines) {
    SCOPED_TRACE(known.name);
    const EngineDefinition& e = known.engine;
    for (int order = 1; order <= 6; ++order) {
      SCOPED_TRACE("order " + std::to_string(order));
      const detail::RotatingVector<double> t = reciprocating_order(e, order);
      // The sum over cylinders of m_j j, whole, and its Fourier terms: nothing of the single harmonics goes in.
      const auto term = [&](Wide Load::*part) {
        return support::fourier_term(
            [&](double a) { return static_cast<double>(exact_reciprocating(e, wide(a) / kRadPerDeg).*part); }, order,
            64);
      };
      const struct {
        Wide Load::*part;
        double cosine, sine, arm;
      } parts[] = {{&Load::up, t.up_cos, t.up_sin, 1},
                   {&Load::lateral, t.lateral_cos, t.lateral_sin, 1},
                   {&Load::pitch, t.pitch_cos, t.pitch_sin, arm_m(e)},
                   {&Load::yaw, t.yaw_cos, t.yaw_sin, arm_m(e)}};
      // The displacement's rounding counts order^2 times.
      const double tolerance = order * order * rounding_kg_m(e);
      for (const auto& part : parts) {
        EXPECT_NEAR(part.cosine, term(part.part).cosine, tolerance * part.arm);
        EXPECT_NEAR(part.sine, term(part.part).sine, tolerance * part.arm);
        const Wave wave = wave_of(part.cosine, part.sine);
        EXPECT_NEAR(wave.amplitude * std::cos(wave.phase_deg * kPi / 180), part.cosine, tolerance * part.arm);
        EXPECT_NEAR(wave.amplitude * std::sin(wave.phase_deg * kPi / 180), part.sine, tolerance * part.arm);
      }
    }
  }
}

TEST(Balance, OrdersOneToSixAreAllThatCountsOfTheExactForce) {
  for (const Named& known : known_engines()) {
    for (const double offset_m : {0.0, 0.008}) {
      SCOPED_TRACE(known.name);
      EngineDefinition e = known.engine;
      e.crank.pin_offset_m = offset_m;
      detail::RotatingVector<double> orders[7] = {};
      for (int order = 1; order <= 6; ++order) orders[order] = reciprocating_order(e, order);
      // Of order 8 5/2048 lambda^7 times 64 is left, and with an offset less of order 7: below 1e-4 of a cylinder's
      // first order.
      const double left_kg_m = 1e-4 * e.layout.cylinders * reciprocating_kg_m(e);
      for (int deg = 0; deg < 360; deg += 5) {
        Load sum;
        for (int order = 1; order <= 6; ++order) {
          const Load one = of_turning(orders[order], order, deg);
          sum = {sum.up + one.up, sum.lateral + one.lateral, sum.pitch + one.pitch, sum.yaw + one.yaw};
        }
        expect_same(sum, exact_reciprocating(e, deg), left_kg_m, arm_m(e));
      }
    }
  }
}

TEST(Balance, OfACrossPlaneV8HasAFourthOrderForceThatIsLeftOverAndAMomentOfNone) {
  // Eight cylinders 90 deg apart in fourth order all push at once, along both banks: sqrt 2 of four of them, straight
  // up.
  const EngineDefinition e = cross_plane_v8();
  const detail::RotatingVector<double> fourth = reciprocating_order(e, 4);
  const double want = 8 * std::sqrt(0.5) * std::fabs(exact_term(e.crank, 4).cosine) * reciprocating_kg_m(e);
  EXPECT_NEAR(peak_force_kg_m(fourth), want, 16 * rounding_kg_m(e));
  EXPECT_GT(want, 8 * std::sqrt(0.5) * 0.9 * std::pow(e.crank.rod_ratio(), 3) / 4 * reciprocating_kg_m(e));
}

// ---- what every engine builder knows --------------------------------------------------------------------------------

/// Longest force and moment of each kind over a turn, in kg m and kg m^2.
struct Peaks {
  double first, second, rotating, first_moment, second_moment, rotating_moment;
  explicit Peaks(const EngineDefinition& e) {
    const detail::Balance<double> b = balance_of(e);
    first = peak_force_kg_m(b.first);
    second = peak_force_kg_m(b.second);
    rotating = peak_force_kg_m(b.rotating);
    first_moment = peak_moment_kg_m2(b.first);
    second_moment = peak_moment_kg_m2(b.second);
    rotating_moment = peak_moment_kg_m2(b.rotating);
  }
};

TEST(Balance, OfASingleCylinderHasNothingToBalanceIt) {
  const EngineDefinition e = in_line({0});
  const Peaks p{e};
  const double tolerance = rounding_kg_m(e);
  EXPECT_NEAR(p.first, reciprocating_kg_m(e), tolerance);
  EXPECT_NEAR(p.second, second_kg_m(e), tolerance);
  EXPECT_NEAR(p.rotating, rotating_kg_m(e, 1), tolerance);
  EXPECT_EQ(p.first_moment, 0);
  EXPECT_EQ(p.second_moment, 0);
  EXPECT_EQ(p.rotating_moment, 0);
}

TEST(Balance, OfAnInlineFourLeavesOnlyFourSecondOrderForces) {
  const EngineDefinition e = in_line({0, 180, 180, 0});
  const Peaks p{e};
  EXPECT_EQ(p.first, 0) << "to the last bit: the throws are whole half turns";
  EXPECT_EQ(p.rotating, 0);
  EXPECT_NEAR(p.first_moment, 0, rounding_kg_m(e) * arm_m(e)) << "0.12 m has no exact double";
  EXPECT_NEAR(p.rotating_moment, 0, rounding_kg_m(e) * arm_m(e));
  EXPECT_NEAR(p.second, 4 * second_kg_m(e), rounding_kg_m(e));
  EXPECT_NEAR(p.second_moment, 0, rounding_kg_m(e) * arm_m(e));
  // up and down only, upward when the outer pistons are at top dead centre
  EXPECT_EQ(balance_of(e).second.lateral_cos, 0);
  EXPECT_GT(balance_of(e).second.up_cos, 0);
}

TEST(Balance, OfAnInlineFourFromItsFiringOrderIsTheSame) {
  EngineDefinition e = in_line({0, 180, 180, 0});
  const int order[] = {1, 3, 4, 2};
  ASSERT_TRUE(accepted(set_firing_order(order, 4, e.layout)));
  const Peaks p{e};
  EXPECT_EQ(p.first, 0);
  EXPECT_NEAR(p.first_moment, 0, rounding_kg_m(e) * arm_m(e));
  EXPECT_NEAR(p.second, 4 * second_kg_m(e), rounding_kg_m(e));
}

TEST(Balance, OfAnInlineSixIsPerfect) {
  const EngineDefinition e = in_line({0, 240, 120, 120, 240, 0});
  const Peaks p{e};
  const double tolerance = rounding_kg_m(e);
  for (const double force : {p.first, p.second, p.rotating}) EXPECT_NEAR(force, 0, tolerance);
  for (const double moment : {p.first_moment, p.second_moment, p.rotating_moment})
    EXPECT_NEAR(moment, 0, tolerance * arm_m(e));
}

TEST(Balance, OfAnInlineThreeRocksButDoesNotShake) {
  // Throws 120 deg apart at -s, 0, s: the vectors' difference is sqrt 3.
  const EngineDefinition e = in_line({0, 240, 120});
  const Peaks p{e};
  const double tolerance = rounding_kg_m(e);
  for (const double force : {p.first, p.second, p.rotating}) EXPECT_NEAR(force, 0, tolerance);
  EXPECT_NEAR(p.first_moment, std::sqrt(3) * reciprocating_kg_m(e) * kSpacing_m, tolerance * arm_m(e));
  EXPECT_NEAR(p.second_moment, std::sqrt(3) * second_kg_m(e) * kSpacing_m, tolerance * arm_m(e));
  EXPECT_NEAR(p.rotating_moment, std::sqrt(3) * rotating_kg_m(e, 1) * kSpacing_m, tolerance * arm_m(e));
}

TEST(Balance, OfA90DegreeVTwinIsAFirstOrderForceThatTurnsWithTheCrankAndALateralSecondOrder) {
  const EngineDefinition e = v_engine({-45}, 45);
  const detail::Balance<double> b = balance_of(e);
  const double tolerance = rounding_kg_m(e);
  for (int deg = 0; deg < 360; deg += 15) {
    // A counterweight of m_j opposite the pin would cancel it: constant size, always along the throw (-45 deg when
    // cylinder 1 fires).
    const Load first = of_turning(b.first, 1, deg);
    const Vec along = turned({0, wide(reciprocating_kg_m(e))}, -45 + deg);
    EXPECT_NEAR(static_cast<double>(first.up - along.up), 0, tolerance);
    EXPECT_NEAR(static_cast<double>(first.lateral - along.lateral), 0, tolerance);
  }
  EXPECT_NEAR(b.second.up_cos, 0, tolerance);
  EXPECT_NEAR(b.second.up_sin, 0, tolerance);
  EXPECT_NEAR(peak_force_kg_m(b.second), std::sqrt(2) * second_kg_m(e), tolerance);
  EXPECT_NEAR(peak_force_kg_m(b.rotating), rotating_kg_m(e, 2), tolerance) << "two rods on one pin, its own mass once";
}

TEST(Balance, OfACrossPlaneV8LeavesOnlyAMomentThatTurnsWithTheCrank) {
  // Throws at 0, 90, 270, 180 deg and -1.5, -0.5, 0.5, 1.5 spacings: 3 spacings one way, 1 across: sqrt 10. Every pair
  // on a pin pushes along its throw with m_j (as the V-twin does), so counterweights can take all of it.
  const EngineDefinition e = cross_plane_v8();
  const Peaks p{e};
  const double tolerance = rounding_kg_m(e);
  EXPECT_NEAR(p.first, 0, tolerance);
  EXPECT_NEAR(p.second, 0, tolerance);
  EXPECT_NEAR(p.second_moment, 0, tolerance * arm_m(e));
  EXPECT_NEAR(p.rotating, 0, tolerance);
  EXPECT_NEAR(p.first_moment, std::sqrt(10) * reciprocating_kg_m(e) * kSpacing_m, tolerance * arm_m(e));
  EXPECT_NEAR(p.rotating_moment, std::sqrt(10) * rotating_kg_m(e, 2) * kSpacing_m, tolerance * arm_m(e));
  const detail::Balance<double> b = balance_of(e);
  for (int deg = 0; deg < 360; deg += 15) {
    const Load first = of_turning(b.first, 1, deg);
    EXPECT_NEAR(static_cast<double>(std::hypot(first.pitch, first.yaw)), p.first_moment, tolerance * arm_m(e))
        << "constant size";
    const Load turning = of_turning(b.rotating, 1, deg);
    EXPECT_NEAR(static_cast<double>(first.pitch * turning.yaw - first.yaw * turning.pitch), 0,
                tolerance * arm_m(e) * p.rotating_moment)
        << "one direction";
  }
}

TEST(Balance, OfABoxerFourLeavesOnlyTheSecondOrderMomentOfItsStaggeredBanks) {
  // Opposed pistons cancel but for the spacing between them; in first order the two pairs' couples oppose each other,
  // in second order they add.
  const EngineDefinition e = boxer_four();
  const Peaks p{e};
  const double tolerance = rounding_kg_m(e);
  EXPECT_NEAR(p.first, 0, tolerance);
  EXPECT_NEAR(p.second, 0, tolerance);
  EXPECT_NEAR(p.rotating, 0, tolerance);
  EXPECT_NEAR(p.first_moment, 0, tolerance * arm_m(e));
  EXPECT_NEAR(p.rotating_moment, 0, tolerance * arm_m(e));
  EXPECT_NEAR(p.second_moment, 2 * second_kg_m(e) * kSpacing_m, tolerance * arm_m(e));
  EXPECT_NEAR(balance_of(e).second.pitch_cos, 0, tolerance * arm_m(e)) << "about the vertical axis alone";
}

TEST(Balance, OfAnOddFireV6DoesNotShakeButRocks) {
  const EngineDefinition e = v_engine({-45, 75, 195}, 45);
  const Peaks p{e};
  const double tolerance = rounding_kg_m(e);
  for (const double force : {p.first, p.second, p.rotating}) EXPECT_NEAR(force, 0, tolerance);
  // Each pair is a V-twin: first order m_j along the throw, so the inline three's sqrt 3 as a turning couple; second
  // order sqrt 2 lambda m_j across.
  EXPECT_NEAR(p.first_moment, std::sqrt(3) * reciprocating_kg_m(e) * kSpacing_m, tolerance * arm_m(e));
  EXPECT_NEAR(p.second_moment, std::sqrt(6) * second_kg_m(e) * kSpacing_m, tolerance * arm_m(e));
  EXPECT_NEAR(p.rotating_moment, std::sqrt(3) * rotating_kg_m(e, 2) * kSpacing_m, tolerance * arm_m(e));
}

TEST(Balance, OfASixtyDegreeV12IsThatOfTwoInlineSixes) {
  const EngineDefinition e = v_engine({-30, 210, 90, 90, 210, -30}, 30);
  const Peaks p{e};
  const double tolerance = rounding_kg_m(e);
  for (const double force : {p.first, p.second, p.rotating}) EXPECT_NEAR(force, 0, tolerance);
  for (const double moment : {p.first_moment, p.second_moment, p.rotating_moment})
    EXPECT_NEAR(moment, 0, tolerance * arm_m(e));
}

TEST(Balance, DoesNotDependOnWhereTheShaftIsMeasuredFrom) {
  const EngineDefinition e = v_engine({-45, 75, 195}, 45);
  EngineDefinition moved = e;
  for (double& position : moved.layout.position_m) position += 3;
  // The positions themselves lose two digits by the shift.
  EXPECT_NEAR(Peaks{moved}.first_moment, Peaks{e}.first_moment, 16 * kEps * 3 * 6 * reciprocating_kg_m(e));
  EXPECT_NEAR(Peaks{moved}.rotating_moment, Peaks{e}.rotating_moment, 16 * kEps * 3 * 6 * rotating_kg_m(e, 1));
}

TEST(Peak, IsTheLongestTheTurningVectorGetsAtAnyAngle) {
  Random random;
  for (int draw = 0; draw < 100; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    detail::RotatingVector<double> t{};
    for (double* amplitude :
         {&t.up_cos, &t.up_sin, &t.lateral_cos, &t.lateral_sin, &t.pitch_cos, &t.pitch_sin, &t.yaw_cos, &t.yaw_sin}) {
      *amplitude = random.between(-1, 1);
    }
    double force = 0;
    double moment = 0;
    constexpr int kSteps = 3600;
    for (int i = 0; i < kSteps; ++i) {
      const Load load = of_turning(t, 1, 360.0L * i / kSteps);
      force = std::max(force, static_cast<double>(std::hypot(load.up, load.lateral)));
      moment = std::max(moment, static_cast<double>(std::hypot(load.pitch, load.yaw)));
    }
    // Half a step from the peak the vector is shorter by at most (1 - cos 0.05 deg) = 4e-7 of it.
    EXPECT_LE(force, peak_force_kg_m(t) * (1 + 4 * kEps));
    EXPECT_GE(force, peak_force_kg_m(t) * (1 - 1e-6));
    EXPECT_LE(moment, peak_moment_kg_m2(t) * (1 + 4 * kEps));
    EXPECT_GE(moment, peak_moment_kg_m2(t) * (1 - 1e-6));
  }
}

}  // namespace
}  // namespace crankloop::balance_of_parts::balance_test
