// A crankcase full of parts, the other way to forces and moments of whole engines: each piston with the vector
// acceleration that geometry gives it, each big end and crank pin turning, put where they are along the shaft, and
// added up. Up is bank angle 0, lateral a quarter turn on in the sense of rotation, as in output.hpp.
#pragma once

#include <crankloop/tabulate/summary.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "support/engines.hpp"
#include "support/fourier.hpp"
#include "support/newton_euler.hpp"
#include "support/status.hpp"
#include "support/vector_geometry.hpp"

namespace crankloop::balance_of_parts {

using support::kEps;
using support::kPi;
using support::kWidePi;
using support::Random;
using support::Vec;
using support::wide;
using support::Wide;

inline constexpr Wide kRadPerDeg = kWidePi / 180;

struct Place {
  double throw_deg;  ///< direction of the pin when cylinder 1 fires, from the vertical
  double bank_deg;
  double position_m;
  bool second_turn;  ///< fires one crank turn later than the throw alone says
  std::uint8_t pin;
};

inline EngineDefinition engine_with(const std::vector<Place>& places) {
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

inline double reciprocating_kg_m(const EngineDefinition& e) {
  return (e.masses.piston_kg + e.masses.rod_small_end_kg) * e.crank.crank_radius_m;
}
inline support::FourierTerm exact_term(const Crank& crank, int order);
/// Second order of one cylinder.
inline double second_kg_m(const EngineDefinition& e) { return exact_term(e.crank, 2).cosine * reciprocating_kg_m(e); }
inline double rotating_kg_m(const EngineDefinition& e, int rods) {
  return (e.masses.crank_pin_equivalent_kg + rods * e.masses.rod_big_end_kg) * e.crank.crank_radius_m;
}

/// Every force is a sum over at most 16 cylinders of a product of some five factors, each with an error of half a unit
/// or so, and of the angles' rounding from degrees (2 units of at most 4 pi).
inline double rounding_kg_m(const EngineDefinition& e) {
  return 32 * kEps * e.layout.cylinders * (reciprocating_kg_m(e) + rotating_kg_m(e, 1));
}
inline double arm_m(const EngineDefinition& e) {
  double arm = 0.01;
  for (std::size_t i = 0; i < static_cast<std::size_t>(e.layout.cylinders); ++i) {
    for (std::size_t k = 0; k < i; ++k) arm = std::max(arm, std::fabs(e.layout.position_m[i] - e.layout.position_m[k]));
  }
  return arm;
}

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
inline Vec turned(Vec v, Wide deg) {
  const Wide c = std::cos(deg * kRadPerDeg);
  const Wide s = std::sin(deg * kRadPerDeg);
  return {v.lateral * c + v.up * s, v.up * c - v.lateral * s};
}

inline Wide middle_of_shaft(const Layout& layout) {
  const auto end = layout.position_m.begin() + layout.cylinders;
  const auto [front, back] = std::minmax_element(layout.position_m.begin(), end);
  return (wide(*front) + wide(*back)) / 2;
}

inline Wide own_deg(const Layout& layout, std::size_t k, Wide engine_deg) {
  return engine_deg - wide(layout.firing_deg[k]);
}

/// Fourier term of a piston's acceleration toward the crankshaft at 1 rad/s, per crank radius: of the vectors of its
/// motion.
inline support::FourierTerm exact_term(const Crank& crank, int order) {
  return support::fourier_term(
      [&](double a) {
        return static_cast<double>(-support::motion_at(crank, wide(a), 1).piston_pin_acceleration.up /
                                   wide(crank.crank_radius_m));
      },
      order, 256);
}

/// The same by one harmonic of it: force along the axis toward the head.
inline Load exact_order(const EngineDefinition& e, Wide engine_deg, int order) {
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
inline Load rotating(const EngineDefinition& e, Wide engine_deg) {
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

inline void expect_same(const Load& got, const Load& want, double force_tolerance, double arm) {
  EXPECT_NEAR(static_cast<double>(got.up), static_cast<double>(want.up), force_tolerance);
  EXPECT_NEAR(static_cast<double>(got.lateral), static_cast<double>(want.lateral), force_tolerance);
  EXPECT_NEAR(static_cast<double>(got.pitch), static_cast<double>(want.pitch), force_tolerance * arm);
  EXPECT_NEAR(static_cast<double>(got.yaw), static_cast<double>(want.yaw), force_tolerance * arm);
}

/// Anything that a crankshaft can carry: pins along it, one or several rods on each, any bank.
inline EngineDefinition random_layout(Random& random) {
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

}  // namespace crankloop::balance_of_parts
