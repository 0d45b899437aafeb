// Free forces and moments of whole engines, and what their pins and journals carry: against sums over every moving
// part.
//
// The other way is a crankcase full of parts: each piston with the vector acceleration that geometry gives it, each big
// end and crank pin turning, each rod with Newton's and Euler's equations, put where they are along the shaft, and
// added up. Up is bank angle 0, lateral a quarter turn on in the sense of rotation, as in tick/io.hpp.
#include <crankloop/tabulate/summary.hpp>
#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/scenes.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "support/engines.hpp"
#include "support/fourier.hpp"
#include "support/newton_euler.hpp"
#include "support/status.hpp"
#include "support/vector_geometry.hpp"

namespace crankloop {
namespace {

using support::kEps;
using support::kWidePi;
using support::Random;
using support::Vec;
using support::wide;
using support::Wide;

constexpr double kPi = 3.14159265358979323846;
constexpr Wide kRadPerDeg = kWidePi / 180;

// ---- engines --------------------------------------------------------------------------------------------------------

struct Place {
  double throw_deg;  ///< direction of the pin when cylinder 1 fires, from the vertical
  double bank_deg;
  double position_m;
  bool second_turn;  ///< fires one crank turn later than the throw alone says
  std::uint8_t pin;
};

EngineDefinition engine_with(const std::vector<Place>& places) {
  EngineDefinition engine;
  engine.crank = support::diesel_495_crank();
  engine.masses.piston_kg = 0.810;
  engine.masses.rod_small_end_kg = 0.505;
  engine.masses.rod_big_end_kg = 1.382;
  engine.masses.crank_pin_equivalent_kg = 1.1;
  engine.layout.cylinders = static_cast<int>(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double firing = places[k].bank_deg - places[k].throw_deg + (places[k].second_turn ? 360 : 0);
    engine.layout.firing_deg[k] = firing - 720 * std::floor(firing / 720);
    engine.layout.bank_deg[k] = places[k].bank_deg;
    engine.layout.position_m[k] = places[k].position_m;
    engine.layout.pin[k] = places[k].pin;
  }
  EXPECT_TRUE(accepted(validate(engine)));
  return engine;
}

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

double reciprocating_kg_m(const EngineDefinition& e) {
  return (e.masses.piston_kg + e.masses.rod_small_end_kg) * e.crank.crank_radius_m;
}
support::FourierTerm exact_term(const Crank& crank, int order);
/// Second order of one cylinder.
double second_kg_m(const EngineDefinition& e) { return exact_term(e.crank, 2).cosine * reciprocating_kg_m(e); }
double rotating_kg_m(const EngineDefinition& e, int rods) {
  return (e.masses.crank_pin_equivalent_kg + rods * e.masses.rod_big_end_kg) * e.crank.crank_radius_m;
}

/// Every force is a sum over at most 16 cylinders of a product of some five factors, each with an error of half a unit
/// or so, and of the angles' rounding from degrees (2 units of at most 4 pi).
double rounding_kg_m(const EngineDefinition& e) {
  return 32 * kEps * e.layout.cylinders * (reciprocating_kg_m(e) + rotating_kg_m(e, 1));
}
double arm_m(const EngineDefinition& e) {
  double arm = 0.01;
  for (std::size_t i = 0; i < static_cast<std::size_t>(e.layout.cylinders); ++i) {
    for (std::size_t k = 0; k < i; ++k) arm = std::max(arm, std::fabs(e.layout.position_m[i] - e.layout.position_m[k]));
  }
  return arm;
}

// ---- the sum over parts ---------------------------------------------------------------------------------------------

/// A force in the engine's frame and its moment about the middle of the crankshaft.
struct Load {
  Wide up{}, lateral{}, pitch{}, yaw{};

  void add(Vec force, Wide position) {
    up += force.up;
    lateral += force.lateral;
    pitch += position * force.up;
    yaw += position * force.lateral;
  }
};

/// v turned by an angle in the sense of rotation: from a cylinder's own frame into the engine's.
Vec turned(Vec v, Wide deg) {
  const Wide c = std::cos(deg * kRadPerDeg);
  const Wide s = std::sin(deg * kRadPerDeg);
  return {v.lateral * c + v.up * s, v.up * c - v.lateral * s};
}

Wide middle_of_shaft(const Layout& layout) {
  const auto end = layout.position_m.begin() + layout.cylinders;
  const auto [front, back] = std::minmax_element(layout.position_m.begin(), end);
  return (wide(*front) + wide(*back)) / 2;
}

Wide own_deg(const Layout& layout, std::size_t k, Wide engine_deg) { return engine_deg - wide(layout.firing_deg[k]); }

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

/// Fourier term of a piston's acceleration toward the crankshaft at 1 rad/s, per crank radius: of the vectors of its motion.
support::FourierTerm exact_term(const Crank& crank, int order) {
  return support::fourier_term(
      [&](double a) { return static_cast<double>(-support::motion_at(crank, wide(a), 1).piston_pin_acceleration.up / wide(crank.crank_radius_m)); },
      order, 256);
}

/// The same by one harmonic of it: force along the axis toward the head.
Load exact_order(const EngineDefinition& e, Wide engine_deg, int order) {
  Load sum;
  const support::FourierTerm term = exact_term(e.crank, order);
  for (std::size_t k = 0; k < static_cast<std::size_t>(e.layout.cylinders); ++k) {
    const Wide a = own_deg(e.layout, k, engine_deg) * kRadPerDeg;
    const Wide shape = wide(term.cosine) * std::cos(order * a) + wide(term.sine) * std::sin(order * a);
    const Vec toward_head{0, wide(reciprocating_kg_m(e)) * shape};
    sum.add(turned(toward_head, wide(e.layout.bank_deg[k])), wide(e.layout.position_m[k]) - middle_of_shaft(e.layout));
  }
  return sum;
}

/// Big ends where their cylinders are, each pin with its webs in the middle of its rods.
Load rotating(const EngineDefinition& e, Wide engine_deg) {
  Load sum;
  const Wide r = wide(e.crank.crank_radius_m);
  for (std::size_t k = 0; k < static_cast<std::size_t>(e.layout.cylinders); ++k) {
    const Wide throw_deg = wide(e.layout.bank_deg[k]) + own_deg(e.layout, k, engine_deg);
    const Vec outward = turned({0, r}, throw_deg);
    sum.add(wide(e.masses.rod_big_end_kg) * outward, wide(e.layout.position_m[k]) - middle_of_shaft(e.layout));
    Wide place = 0;
    int rods = 0;
    bool first_on_pin = true;
    for (std::size_t other = 0; other < static_cast<std::size_t>(e.layout.cylinders); ++other) {
      if (e.layout.pin[other] != e.layout.pin[k]) continue;
      if (other < k) first_on_pin = false;
      place += wide(e.layout.position_m[other]);
      ++rods;
    }
    if (first_on_pin)
      sum.add(wide(e.masses.crank_pin_equivalent_kg) * outward, place / rods - middle_of_shaft(e.layout));
  }
  return sum;
}

Load of_turning(const Turning<double>& t, int order, Wide engine_deg) {
  const Wide c = std::cos(order * engine_deg * kRadPerDeg);
  const Wide s = std::sin(order * engine_deg * kRadPerDeg);
  const auto at = [&](double cosine, double sine) { return wide(cosine) * c + wide(sine) * s; };
  return {at(t.up_cos, t.up_sin), at(t.lateral_cos, t.lateral_sin), at(t.pitch_cos, t.pitch_sin),
          at(t.yaw_cos, t.yaw_sin)};
}

void expect_same(const Load& got, const Load& want, double force_tolerance, double arm) {
  EXPECT_NEAR(static_cast<double>(got.up), static_cast<double>(want.up), force_tolerance);
  EXPECT_NEAR(static_cast<double>(got.lateral), static_cast<double>(want.lateral), force_tolerance);
  EXPECT_NEAR(static_cast<double>(got.pitch), static_cast<double>(want.pitch), force_tolerance * arm);
  EXPECT_NEAR(static_cast<double>(got.yaw), static_cast<double>(want.yaw), force_tolerance * arm);
}

void expect_balance_of_parts(const EngineDefinition& e) {
  const Balance<double> b = balance_of(e);
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

/// Anything that a crankshaft can carry: pins along it, one or several rods on each, any bank.
EngineDefinition random_layout(Random& random) {
  EngineDefinition e = support::random_engine(random).definition;
  const int pins = random.whole(1, 8);
  int n = 0;
  for (int pin = 0; pin < pins; ++pin) {
    const double throw_deg = random.between(-180, 180);
    const double place = pin * random.between(0.1, 0.101);
    const int rods = random.whole(1, 2);
    for (int rod = 0; rod < rods; ++rod, ++n) {
      const auto k = static_cast<std::size_t>(n);
      e.layout.bank_deg[k] = random.between(-180, 180);
      const double firing = e.layout.bank_deg[k] - throw_deg + 360 * random.whole(0, 1);
      e.layout.firing_deg[k] = firing - 720 * std::floor(firing / 720);
      e.layout.position_m[k] = place + random.between(0, 0.03);
      e.layout.pin[k] = static_cast<std::uint8_t>(pin);
    }
  }
  e.layout.cylinders = n;
  EXPECT_TRUE(accepted(validate(e)));
  return e;
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
      const Turning<double> t = reciprocating_order(e, order);
      // The sum over cylinders of m_j j, whole, and its Fourier terms: nothing of the single harmonics goes in.
      const auto term = [&](Wide Load::*part) {
        return support::fourier_term(
            [&](double a) { return static_cast<double>(exact_reciprocating(e, wide(a) / kRadPerDeg).*part); }, order, 64);
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
      Turning<double> orders[7] = {};
      for (int order = 1; order <= 6; ++order) orders[order] = reciprocating_order(e, order);
      // Of order 8 5/2048 lambda^7 times 64 is left, and with an offset less of order 7: below 1e-4 of a cylinder's first order.
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
  // Eight cylinders 90 deg apart in fourth order all push at once, along both banks: sqrt 2 of four of them, straight up.
  const EngineDefinition e = cross_plane_v8();
  const Turning<double> fourth = reciprocating_order(e, 4);
  const double want = 8 * std::sqrt(0.5) * std::fabs(exact_term(e.crank, 4).cosine) * reciprocating_kg_m(e);
  EXPECT_NEAR(peak_force_kg_m(fourth), want, 16 * rounding_kg_m(e));
  EXPECT_GT(want, 8 * std::sqrt(0.5) * 0.9 * std::pow(e.crank.rod_ratio(), 3) / 4 * reciprocating_kg_m(e));
}

// ---- what every engine builder knows --------------------------------------------------------------------------------

/// Longest force and moment of each kind over a turn, in kg m and kg m^2.
struct Peaks {
  double first, second, rotating, first_moment, second_moment, rotating_moment;
  explicit Peaks(const EngineDefinition& e) {
    const Balance<double> b = balance_of(e);
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
  EXPECT_NEAR(p.second_moment, std::sqrt(3) * second_kg_m(e) * kSpacing_m,
              tolerance * arm_m(e));
  EXPECT_NEAR(p.rotating_moment, std::sqrt(3) * rotating_kg_m(e, 1) * kSpacing_m, tolerance * arm_m(e));
}

TEST(Balance, OfA90DegreeVTwinIsAFirstOrderForceThatTurnsWithTheCrankAndALateralSecondOrder) {
  const EngineDefinition e = v_engine({-45}, 45);
  const Balance<double> b = balance_of(e);
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
  const Balance<double> b = balance_of(e);
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
  EXPECT_NEAR(p.second_moment, std::sqrt(6) * second_kg_m(e) * kSpacing_m,
              tolerance * arm_m(e));
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
    Turning<double> t{};
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

// ---- pins and journals ----------------------------------------------------------------------------------------------

/// Pressure, the same for sum and library: none but the crankcase's, or the synthesised diagram's at full load.
struct Loaded {
  EngineDefinition engine;
  RigidRod rod;
  ExactEngine exact;
};

/// A random layout whose rods are rigid bodies, with combustion.
std::unique_ptr<Loaded> random_loaded_engine(Random& random) {
  auto loaded = std::make_unique<Loaded>();
  EngineDefinition& e = loaded->engine;
  e = random_layout(random);
  loaded->rod = support::random_rod(random, e.crank);
  lump_rod(loaded->rod, e.crank, e.masses);
  e.pressure.source = PressureSource::wiebe;
  e.pressure.wiebe.net_mep_Pa = random.between(3e5, 12e5);
  e.pressure.wiebe.exhaust_valve_opens_deg = 130;
  EXPECT_TRUE(accepted(loaded->exact.init(e)));
  return loaded;
}

/// Force of every rod on its pin in the engine's frame, by Newton and Euler, added up for each pin; and of the turning
/// pin itself.
struct PinForces {
  std::vector<Vec> on_pin;    ///< of the rods
  std::vector<Vec> on_shaft;  ///< of rods and the throw's own unbalance: what the journals hold
  std::vector<Vec> outward;   ///< unit vector of the throw
};

PinForces pin_forces(const Loaded& loaded, Wide engine_deg, Wide speed) {
  const EngineDefinition& e = loaded.engine;
  PinForces f;
  const std::size_t pins = 1u + *std::max_element(e.layout.pin.begin(), e.layout.pin.begin() + e.layout.cylinders);
  f.on_pin.resize(pins);
  f.on_shaft.resize(pins);
  f.outward.resize(pins);
  EngineDefinition bare = e;
  bare.masses.crank_pin_equivalent_kg = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(e.layout.cylinders); ++k) {
    const Wide deg = own_deg(e.layout, k, engine_deg);
    const support::Motion m = support::motion_at(e.crank, deg * kRadPerDeg, speed);
    const Wide area = kWidePi / 4 * wide(e.crank.bore_m) * wide(e.crank.bore_m);
    const Wide gas =
        (wide(loaded.exact.diagram().full_Pa(static_cast<double>(deg))) - wide(e.pressure.crankcase_Pa)) * area;
    const std::size_t pin = e.layout.pin[k];
    f.on_pin[pin] = f.on_pin[pin] + turned(support::newton_euler(bare, loaded.rod, m, gas).rod_on_crank_pin,
                                           wide(e.layout.bank_deg[k]));
    f.outward[pin] = turned((1 / support::length(m.crank_pin)) * m.crank_pin, wide(e.layout.bank_deg[k]));
  }
  const Wide pin_kg_m = wide(e.masses.crank_pin_equivalent_kg) * wide(e.crank.crank_radius_m);
  for (std::size_t pin = 0; pin < pins; ++pin)
    f.on_shaft[pin] = f.on_pin[pin] + (pin_kg_m * speed * speed) * f.outward[pin];
  return f;
}

/// Size of the forces in an engine, for tolerances.
double force_size(const EngineDefinition& e, double speed) {
  const double area = kPi / 4 * e.crank.bore_m * e.crank.bore_m;
  const double masses =
      e.masses.piston_kg + e.masses.rod_small_end_kg + e.masses.rod_big_end_kg + e.masses.crank_pin_equivalent_kg;
  return 200e5 * area + 2 * masses * e.crank.crank_radius_m * speed * speed;
}

// Exact functions: angles pass through degrees, where 2 eps of 720 deg on a pressure that rises 20 bar/deg is 6e-12 of
// the peak.
constexpr double kExactShare = 1e-11;

TEST(Pins, CarryTheVectorSumOfTheirRods) {
  Random random;
  for (int draw = 0; draw < 30; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const std::unique_ptr<Loaded> loaded = random_loaded_engine(random);
    const double speed = random.between(20, 600);
    const double tolerance = kExactShare * force_size(loaded->engine, speed);
    for (int i = 0; i < 20; ++i) {
      const double deg = random.between(0, 720);
      const PinForces want = pin_forces(*loaded, wide(deg), wide(speed));
      for (int k = 0; k < loaded->engine.layout.cylinders; ++k) {
        const std::size_t pin = loaded->engine.layout.pin[static_cast<std::size_t>(k)];
        const PinLoad got = loaded->exact.pin_load(k, deg, speed);
        EXPECT_NEAR(got.radial_N, static_cast<double>(-support::dot(want.on_pin[pin], want.outward[pin])), tolerance);
        EXPECT_NEAR(got.tangential_N,
                    static_cast<double>(support::dot(want.on_pin[pin], support::quarter_turn(want.outward[pin]))),
                    tolerance);
      }
    }
    if (HasFailure()) return;
  }
}

TEST(Bearings, KnowEveryPinsThrowAndMasses) {
  Random random;
  for (int draw = 0; draw < 200; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const EngineDefinition e = random_layout(random);
    const Bearings<double> b = bearings_of(e);
    const std::size_t pins = 1u + *std::max_element(e.layout.pin.begin(), e.layout.pin.begin() + e.layout.cylinders);
    ASSERT_EQ(b.pins, pins);
    ASSERT_EQ(b.by_pin.end[pins - 1], e.layout.cylinders);
    std::size_t first_on_zero = 0;
    while (e.layout.pin[first_on_zero] != 0) ++first_on_zero;
    for (std::size_t k = 0; k < static_cast<std::size_t>(e.layout.cylinders); ++k) {
      const std::size_t pin = e.layout.pin[k];
      EXPECT_EQ(b.pin_of[k], pin);
      const auto* const begin = b.by_pin.cylinder + (pin == 0 ? 0 : b.by_pin.end[pin - 1]);
      EXPECT_EQ(std::count(begin, b.by_pin.cylinder + b.by_pin.end[pin], k), 1) << "cylinder " << k << " on pin " << pin;
      const auto rods = std::count(e.layout.pin.begin(), e.layout.pin.begin() + e.layout.cylinders, e.layout.pin[k]);
      EXPECT_NEAR(b.rods_kg_m[pin], static_cast<double>(rods) * e.masses.rod_big_end_kg * e.crank.crank_radius_m,
                  rounding_kg_m(e));
      EXPECT_NEAR(b.throw_kg_m[pin], rotating_kg_m(e, static_cast<int>(rods)), rounding_kg_m(e));
      // Direction of the throw in the frame of pin 0's, by turning vectors.
      const Vec own = turned({0, 1}, wide(e.layout.bank_deg[k]) - wide(e.layout.firing_deg[k]));
      const Vec zero =
          turned({0, 1}, wide(e.layout.bank_deg[first_on_zero]) - wide(e.layout.firing_deg[first_on_zero]));
      EXPECT_NEAR(b.throw_cos[pin], static_cast<double>(support::dot(own, zero)), 64 * kEps);
      EXPECT_NEAR(b.throw_sin[pin], static_cast<double>(support::dot(own, support::quarter_turn(zero))), 64 * kEps);
    }
  }
}

TEST(Tick, ReportsTheLoadsOfPinsAndJournalsAndTheFreeForcesOfItsParts) {
  using Scene = scenes::Whole;
  Random random;
  for (int draw = 0; draw < 5; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const std::unique_ptr<Loaded> loaded = random_loaded_engine(random);
    const EngineDefinition& e = loaded->engine;
    const auto tables = std::make_unique<TableStorage<double, Scene, static_cast<std::size_t>(kMostGasSegments)>>();
    ASSERT_TRUE(accepted(tables->build(e, {100e-6})));
    const double speed = random.between(20, 600);
    // Curves within 2e-9 of their scale, pressure within 1e-5 of its peak (tabulate.hpp).
    const double tolerance = 1e-8 * force_size(e, speed) + 1e-5 * 250e5 * kPi / 4 * e.crank.bore_m * e.crank.bore_m;
    for (int i = 0; i < 40; ++i) {
      const auto engine = std::make_unique<Engine<double, Scene>>();
      ASSERT_TRUE(accepted(engine->init(tables->tables(), Phase{random.bits()})));
      Engine<double, Scene>::Input in;
      in.speed_rad_s = speed;
      in.load_ratio = 1;
      const auto& out = engine->step(in);
      ASSERT_EQ(out.faults, 0u);
      const Wide deg = static_cast<Wide>(engine->state().phase.units()) * (720 / 18446744073709551616.0L);
      const PinForces want = pin_forces(*loaded, deg, wide(speed));
      const std::size_t pins = want.on_pin.size();
      const Vec along = want.outward[0];
      const Vec across = support::quarter_turn(along);
      for (std::size_t pin = 0; pin < pins; ++pin) {
        EXPECT_NEAR(out.pin_radial_N[pin], static_cast<double>(-support::dot(want.on_pin[pin], want.outward[pin])),
                    tolerance);
        EXPECT_NEAR(out.pin_tangential_N[pin],
                    static_cast<double>(support::dot(want.on_pin[pin], support::quarter_turn(want.outward[pin]))),
                    tolerance);
        EXPECT_NEAR(out.pin_load_N[pin], static_cast<double>(support::length(want.on_pin[pin])), 2 * tolerance);
      }
      for (std::size_t journal = 0; journal <= pins; ++journal) {
        // Each throw rests on the journals beside it, half on each.
        Vec load{};
        if (journal > 0) load = load + 0.5L * want.on_shaft[journal - 1];
        if (journal < pins) load = load + 0.5L * want.on_shaft[journal];
        EXPECT_NEAR(out.journal_along_N[journal], static_cast<double>(support::dot(load, along)), tolerance);
        EXPECT_NEAR(out.journal_across_N[journal], static_cast<double>(support::dot(load, across)), tolerance);
        EXPECT_NEAR(out.journal_load_N[journal], static_cast<double>(support::length(load)), 2 * tolerance);
        const BlockLoad block = in_block(e, static_cast<double>(deg), out.journal_along_N[journal], out.journal_across_N[journal]);
        EXPECT_NEAR(block.up_N, static_cast<double>(load.up), 2 * tolerance);
        EXPECT_NEAR(block.lateral_N, static_cast<double>(load.lateral), 2 * tolerance);
      }
      const Wide w2 = wide(speed) * wide(speed);
      const double free_tolerance =
          1e-8 * speed * speed * e.layout.cylinders * (reciprocating_kg_m(e) + rotating_kg_m(e, 1));
      const auto reported = [&](const FreeForce<double>& f) {
        return Load{wide(f.up_N), wide(f.lateral_N), wide(f.pitch_Nm), wide(f.yaw_Nm)};
      };
      const auto scaled = [&](Load load) {
        return Load{load.up * w2, load.lateral * w2, load.pitch * w2, load.yaw * w2};
      };
      expect_same(reported(out.first), scaled(exact_order(e, deg, 1)), free_tolerance, arm_m(e));
      expect_same(reported(out.second), scaled(exact_order(e, deg, 2)), free_tolerance, arm_m(e));
      expect_same(reported(out.rotating), scaled(rotating(e, deg)), free_tolerance, arm_m(e));
      if (HasFailure()) return;
    }
  }
}

}  // namespace
}  // namespace crankloop
