#include "engines.hpp"

#include <stdexcept>
#include <vector>

#include "../reference/ohc_125.hpp"

namespace crankloop::program::bench {
namespace {

std::vector<int> firing_order(int cylinders) {
  switch (cylinders) {
    case 1:
      return {1};
    case 4:
      return {1, 3, 4, 2};
    case 6:
      return {1, 5, 3, 6, 2, 4};
    case 8:
      return {1, 8, 4, 3, 6, 5, 7, 2};
    case 12:
      return {1, 7, 5, 11, 3, 9, 6, 12, 2, 8, 4, 10};
    default:
      throw std::logic_error("no firing order for that many cylinders");
  }
}

}  // namespace

Crank diesel_495_crank() {
  Crank crank;
  crank.bore_m = 0.095;
  crank.crank_radius_m = 0.0575;
  crank.rod_length_m = crank.crank_radius_m / 0.2738;
  crank.compression_ratio = 19;
  return crank;
}

ValveTrain ohc_125_train() {
  ValveTrain train;
  shape_as_ohc_125(train.cam, train.rocker);
  train.cam.full_lift_deg = 470;
  train.rocker.clearance_m = 0.05e-3;
  train.valve.valve_kg = 0.033;
  train.valve.spring_kg = 0.06;
  train.valve.rocker_inertia_kg_m2 = 8.12e-6;
  train.valve.spring_N_m = 40e3;
  train.valve.spring_preload_N = 205.8;
  train.valve.train_N_m = 11765e3;
  train.valve.train_damping_ratio = 0.10;
  train.valve.guide_damping_ratio = 0.003;
  train.valve.seat_N_m = 1e8;
  train.valve.seat_damping_ratio = 0.10;
  return train;
}

EngineDefinition engine_of(int cylinders, int trains) {
  EngineDefinition engine;
  engine.crank.bore_m = 52.4e-3;
  engine.crank.crank_radius_m = 57.8e-3 / 2;
  engine.crank.rod_length_m = 101e-3;
  engine.crank.compression_ratio = 9.2;
  engine.masses.piston_kg = 0.120;
  engine.masses.rod_small_end_kg = 0.035;
  engine.masses.rod_big_end_kg = 0.110;
  engine.masses.crank_inertia_kg_m2 = 0.003;
  const std::vector<int> order = firing_order(cylinders);
  if (!set_firing_order(order.data(), cylinders, engine.layout).ok())
    throw std::logic_error("a firing order was refused");
  for (int k = 0; k < cylinders; ++k) engine.layout.position_m[static_cast<std::size_t>(k)] = 0.07 * k;
  engine.train_count = trains;
  const double full_lift_deg[] = {470, 250, 474, 254};
  for (int t = 0; t < trains; ++t) {
    engine.trains[t] = ohc_125_train();
    engine.trains[t].cam.full_lift_deg = full_lift_deg[t];
  }
  return engine;
}

EngineDefinition one_valve_engine() { return engine_of(1, 1); }

}  // namespace crankloop::program::bench
