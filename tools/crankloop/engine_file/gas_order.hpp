// The inputs of an engine with gas exchange, the same for all its cylinders: throttle, fuel, spark.
//
// What belongs here: the order, its way into a step's input. What does not: its options (command_line/gas_options.hpp),
// what becomes of it (loops/, commands/).
#pragma once

#include <cstdint>

#include <crankloop/scenes.hpp>

namespace crankloop::program {

struct GasOrder {
  double throttle_ratio = 1;
  double fuel_kg = 0;           ///< per cylinder and cycle
  double excess_air_ratio = 0;  ///< lambda; above 0, it sets the fuel
  double burn_start_deg = 0;
  double burn_duration_deg = 0;
};

/// As the engine is defined.
[[nodiscard]] inline GasOrder gas_order(const Gas& gas) {
  return {1, gas.excess_air_ratio > 0 ? 0 : gas.fuel_kg, gas.excess_air_ratio, gas.burn_start_deg,
          gas.burn_duration_deg};
}

template <class Real, class S>
void tell(Input<Real, S>& in, const GasOrder& order) noexcept {
  in.throttle_ratio = static_cast<Real>(order.throttle_ratio);
  for (std::uint32_t k = 0; k < S::cylinders.capacity; ++k) {
    in.fuel_kg[k] = static_cast<Real>(order.fuel_kg);
    in.excess_air_ratio[k] = static_cast<Real>(order.excess_air_ratio);
    in.burn_start_deg[k] = static_cast<Real>(order.burn_start_deg);
    in.burn_duration_deg[k] = static_cast<Real>(order.burn_duration_deg);
  }
}

[[nodiscard]] inline bool breathes(const EngineDefinition& engine) noexcept {
  return engine.pressure.source == PressureSource::gas;
}

}  // namespace crankloop::program
