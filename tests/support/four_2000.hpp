// An engine that breathes: two litres, four cylinders, four valves each; all of it assumed
// (tools/engines/four_2000.ini).
#pragma once

#include <cstddef>

#include <gtest/gtest.h>

#include <crankloop/define/engine_definition.hpp>

#include "support/status.hpp"

namespace crankloop::support {

/// 86 x 86, ratio 10.5, valves of 33 and 28 mm, lobes of 256 deg of the crank.
inline EngineDefinition four_2000() {
  EngineDefinition engine;
  engine.crank = {0.086, 0.043, 0.143, 0, 10.5};
  engine.masses = {0.35, 0.15, 0.35, 0, 0, 0.15};
  const int order[] = {1, 3, 4, 2};
  EXPECT_TRUE(accepted(set_firing_order(order, 4, engine.layout)));
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

}  // namespace crankloop::support
