// The engines that tests run: the 495 diesel, others made hostile on purpose, and random ones.
//
// What belongs here: definitions by struct, as a user's set-up code writes them. What does not: valve trains
// (valve_trains.hpp), scenes (scenes.hpp), tables and steps (running.hpp, kept_engines.hpp), expectations.
#pragma once

#include <cstddef>
#include <vector>

#include <crankloop/define/engine_definition.hpp>

#include "support/random.hpp"
#include "support/valve_trains.hpp"

namespace crankloop::support {

/// Lengths of the 495 diesel as its design sheet gives them: bore 95, stroke 115, rod 210 mm.
inline Crank diesel_495_crank() {
  Crank crank;
  crank.bore_m = 0.095;
  crank.crank_radius_m = 0.0575;
  crank.rod_length_m = 0.210;
  crank.compression_ratio = 19;
  return crank;
}

/// One cylinder of the 495 diesel with a pin offset and a rod inertia that its design sheet does not have: so that
/// every term counts.
inline EngineDefinition single_495() {
  EngineDefinition engine;
  engine.crank = {0.095, 0.0575, 0.210, 0.0, 19.0};
  engine.masses = {0.810, 0.505, 1.382, -0.0042, 3.1, 0.45};
  engine.layout.cylinders = 1;
  engine.pressure.source = PressureSource::wiebe;
  engine.pressure.wiebe.net_mep_Pa = 809.7e3;
  return engine;
}

/// Puts `firing_deg.size()` cylinders in a row, 0.12 m apart, each on its own pin.
inline EngineDefinition with_cylinders(EngineDefinition engine, const std::vector<double>& firing_deg) {
  engine.layout = Layout{};
  engine.layout.cylinders = static_cast<int>(firing_deg.size());
  for (std::size_t k = 0; k < firing_deg.size(); ++k) {
    engine.layout.firing_deg[k] = firing_deg[k];
    engine.layout.position_m[k] = 0.12 * static_cast<double>(k);
  }
  return engine;
}

/// The four-cylinder 495: firing order 1-3-4-2.
inline EngineDefinition diesel_495() { return with_cylinders(single_495(), {0, 540, 180, 360}); }

/// A 90 deg V4 that fires unevenly: two rods on a shared pin, two cylinders that fire together, a pin offset.
inline EngineDefinition uneven_v4() {
  EngineDefinition engine = with_cylinders(single_495(), {0, 90, 450, 0});
  engine.crank.pin_offset_m = 0.004;
  engine.layout.bank_deg = {0, 90, 90, 0};
  engine.layout.position_m = {0, 0.02, 0.14, 0.16};
  engine.layout.pin = {0, 0, 1, 2};  // throws all point the same way
  return engine;
}

inline EngineDefinition without_gas(EngineDefinition engine) {
  engine.pressure = Pressure{};
  return engine;
}

/// A four-cylinder diesel with eight elastic valves, whose cams have phasers.
inline EngineDefinition four_with_valves() {
  EngineDefinition engine = diesel_495();
  engine.train_count = 2;
  for (int t = 0; t < 2; ++t) {
    engine.trains[t] = ohc_125_train();
    engine.trains[t].cam.full_lift_deg = t == 0 ? 450 : 250;
    engine.trains[t].cam.phase_rate_deg_s = 2000;
  }
  return engine;
}

/// An engine that breathes: two litres, four cylinders, four valves each; all of it assumed
/// (tools/engines/four_2000.ini). 86 x 86, ratio 10.5, valves of 33 and 28 mm, lobes of 256 deg of the crank.
inline EngineDefinition four_2000() {
  EngineDefinition engine;
  engine.crank = {0.086, 0.043, 0.143, 0, 10.5};
  engine.masses = {0.35, 0.15, 0.35, 0, 0, 0.15};
  const int order[] = {1, 3, 4, 2};
  static_cast<void>(set_firing_order(order, 4, engine.layout));
  for (int k = 0; k < 4; ++k) engine.layout.position_m[static_cast<std::size_t>(k)] = 0.09 * k;
  engine.pressure.source = PressureSource::gas;
  engine.train_count = 2;
  for (int t = 0; t < 2; ++t) {
    const bool intake = t == 0;
    ValveTrain& train = engine.trains[t];
    train.cam.max_lift_m = intake ? 9.5e-3 : 9e-3;
    train.cam.half_angle_deg = 64;
    train.cam.exponent_count = 4;
    const double exponents[] = {2, 10, 18, 26};
    for (int i = 0; i < 4; ++i) train.cam.exponents[i] = exponents[i];
    train.cam.full_lift_deg = intake ? 470 : 250;
    train.rocker.kind = RockerKind::ratio;
    train.rocker.ratio = 1;
    train.rocker.base_circle_m = 0.018;
    train.rocker.clearance_m = 0;
    train.valve.per_cylinder = 2;
    train.valve.valve_kg = 0.06;
    train.valve.spring_kg = 0.04;
    train.valve.spring_N_m = 40e3;
    train.valve.spring_preload_N = 250;
    train.valve.train_N_m = 12e6;
    train.valve.train_damping_ratio = 0.1;
    train.valve.guide_damping_ratio = 0.003;
    train.valve.seat_N_m = 5e7;
    train.valve.seat_damping_ratio = 0.1;
    train.valve.head_area_m2 = intake ? 8.6e-4 : 6.2e-4;
    PortOfTrain& port = engine.gas.ports[t];
    port.port = intake ? GasPort::intake : GasPort::exhaust;
    port.seat_diameter_m = intake ? 0.033 : 0.028;
  }
  return engine;
}

inline Layout inline_four() {
  Layout layout;
  const int order[] = {1, 3, 4, 2};
  static_cast<void>(set_firing_order(order, 4, layout));
  for (std::size_t k = 0; k < 4; ++k) layout.position_m[k] = 0.12 * static_cast<double>(k);
  return layout;
}

/// A crank mechanism of the range the library promises its accuracy for: lambda 0.15 to 0.45, offset up to 0.2 r to
/// either side.
inline Crank random_crank(Random& random) {
  Crank crank;
  crank.crank_radius_m = random.between(0.02, 0.2);
  crank.rod_length_m = crank.crank_radius_m / random.between(0.15, 0.45);
  crank.pin_offset_m = crank.crank_radius_m * random.between(-0.2, 0.2);
  crank.bore_m = crank.crank_radius_m * random.between(1.2, 2.5);
  crank.compression_ratio = random.between(6, 22);
  return crank;
}

/// A rod whose inertia is anything from a point mass to twice that of two masses at its ends, so dI has either sign.
inline RigidRod random_rod(Random& random, const Crank& crank) {
  RigidRod rod;
  rod.mass_kg = random.between(0.2, 5);
  rod.com_to_crank_m = crank.rod_length_m * random.between(0.05, 0.6);
  const double two_masses = rod.mass_kg * rod.com_to_crank_m * (crank.rod_length_m - rod.com_to_crank_m);
  rod.inertia_kg_m2 = two_masses * random.between(0, 2);
  return rod;
}

/// One cylinder with random geometry, a rigid rod and no pressure source.
struct RandomEngine {
  EngineDefinition definition;
  RigidRod rod;
};
inline RandomEngine random_engine(Random& random) {
  RandomEngine engine;
  engine.definition.crank = random_crank(random);
  engine.rod = random_rod(random, engine.definition.crank);
  Masses& masses = engine.definition.masses;
  masses.piston_kg = random.between(0.2, 5);
  masses.crank_pin_equivalent_kg = random.between(0, 5);
  masses.crank_inertia_kg_m2 = random.between(0, 2);
  lump_rod(engine.rod, engine.definition.crank, masses);
  engine.definition.pressure.crankcase_Pa = random.between(90e3, 120e3);
  return engine;
}

}  // namespace crankloop::support

namespace crankloop::tick_test {

using support::diesel_495;
using support::four_with_valves;
using support::single_495;
using support::uneven_v4;
using support::with_cylinders;
using support::without_gas;

}  // namespace crankloop::tick_test
