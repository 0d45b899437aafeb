// What pins and journals of whole engines carry, against Newton's and Euler's equations of every rod, added up.
#include <crankloop/scenes.hpp>
#include <crankloop/tabulate/tabulate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "support/balance_of_parts.hpp"

namespace crankloop::balance_of_parts::bearings_test {
namespace {

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
    const detail::Bearings<double> b = bearings_of(e);
    const std::size_t pins = 1u + *std::max_element(e.layout.pin.begin(), e.layout.pin.begin() + e.layout.cylinders);
    ASSERT_EQ(b.pins, pins);
    ASSERT_EQ(b.by_pin.end[pins - 1], e.layout.cylinders);
    std::size_t first_on_zero = 0;
    while (e.layout.pin[first_on_zero] != 0) ++first_on_zero;
    for (std::size_t k = 0; k < static_cast<std::size_t>(e.layout.cylinders); ++k) {
      const std::size_t pin = e.layout.pin[k];
      EXPECT_EQ(b.pin_of[k], pin);
      const auto* const begin = b.by_pin.cylinder + (pin == 0 ? 0 : b.by_pin.end[pin - 1]);
      EXPECT_EQ(std::count(begin, b.by_pin.cylinder + b.by_pin.end[pin], k), 1)
          << "cylinder " << k << " on pin " << pin;
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

/// At its firing angle a cylinder's throw points along its axis.
TEST(Journals, HaveTheirLoadsAlongTheFirstPinsThrowWhicheverCylinderIsOnIt) {
  EngineDefinition e = support::diesel_495();
  Layout& layout = e.layout;
  layout = {};
  layout.cylinders = 3;
  for (std::size_t k = 0; k < 3; ++k) {  // numbered from the shaft's end, banks fanned out
    layout.firing_deg[k] = 240.0 * static_cast<double>(k);
    layout.bank_deg[k] = 40.0 * static_cast<double>(k) - 30;
    layout.position_m[k] = -0.1 * static_cast<double>(k);
    layout.pin[k] = static_cast<std::uint8_t>(2 - k);
  }
  ASSERT_TRUE(accepted(validate(layout)));
  const double axis_rad = 50 * kPi / 180;  // of the third cylinder, which is on pin 0
  const BlockLoad along = in_block(e, 480, 1000, 0), across = in_block(e, 480, 0, 1000);
  EXPECT_NEAR(along.up_N, 1000 * std::cos(axis_rad), 1e-9);
  EXPECT_NEAR(along.lateral_N, 1000 * std::sin(axis_rad), 1e-9);
  EXPECT_NEAR(across.up_N, -1000 * std::sin(axis_rad), 1e-9) << "90 deg further in the sense of rotation";
  EXPECT_NEAR(across.lateral_N, 1000 * std::cos(axis_rad), 1e-9);
  layout.pin[0] = 0, layout.pin[2] = 2;  // of the first: 30 deg to the other side when it fires
  const BlockLoad of_first = in_block(e, 0, 1000, 0);
  EXPECT_NEAR(of_first.up_N, 1000 * std::cos(kPi / 6), 1e-9);
  EXPECT_NEAR(of_first.lateral_N, -1000 * std::sin(kPi / 6), 1e-9);
}

TEST(Tick, ReportsTheLoadsOfPinsAndJournalsAndTheFreeForcesOfItsParts) {
  using Scene = scenes::Whole;
  Random random;
  for (int draw = 0; draw < 5; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const std::unique_ptr<Loaded> loaded = random_loaded_engine(random);
    const EngineDefinition& e = loaded->engine;
    const auto tables = std::make_unique<TableStorage<double, Scene, static_cast<std::size_t>(kMaxGasSegments)>>();
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
        const BlockLoad block =
            in_block(e, static_cast<double>(deg), out.journal_along_N[journal], out.journal_across_N[journal]);
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
}  // namespace crankloop::balance_of_parts::bearings_test
