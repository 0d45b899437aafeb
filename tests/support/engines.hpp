// Engines for tests: the 495 diesel, and random ones.
#pragma once

#include <crankloop/define/engine_definition.hpp>

#include "support/random.hpp"
#include "support/status.hpp"

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

inline Layout inline_four() {
  Layout layout;
  const int order[] = {1, 3, 4, 2};
  EXPECT_TRUE(accepted(set_firing_order(order, 4, layout)));
  for (std::size_t k = 0; k < 4; ++k) layout.position_m[k] = 0.12 * static_cast<double>(k);
  return layout;
}

}  // namespace crankloop::support
