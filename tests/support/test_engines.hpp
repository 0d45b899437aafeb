// Engines that the tests of the tick run: the 495 diesel, and others made hostile on purpose.
//
// What belongs here: definitions by struct, as a user's set-up code writes them. What does not: scenes
// (running.hpp), expectations.
#pragma once

#include <cstddef>
#include <vector>

#include <crankloop/define/engine_definition.hpp>

namespace crankloop::tick_test {

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

}  // namespace crankloop::tick_test
