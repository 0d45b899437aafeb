// The inputs of an engine with gas exchange, the same for all its cylinders: throttle, fuel, spark.
//
// What belongs here: the values, and copying them into a step's input. What does not: their options
// (command_line/gas_options.hpp), runs (loops/, commands/).
#pragma once

#include <cstdint>

#include <crankloop/scenes.hpp>

namespace crankloop::program {

struct GasOrder {
  double throttle_ratio = 1;
  double fuel_kg = 0;           ///< per cylinder and cycle
  double excess_air_ratio = 0;  ///< lambda; if above 0, it determines the fuel
  double burn_start_deg = 0;
  double burn_duration_deg = 0;
};

/// The values of the definition.
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
