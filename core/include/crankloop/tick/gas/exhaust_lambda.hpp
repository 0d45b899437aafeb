// Lambda of the exhaust, and of a sensor behind a pipe: docs/model.md "Exhaust lambda".
//
// What belongs here: lambda of a gas, the pipe, the sensor. What does not: how fuel that lacked air gets there
// (unburned_fuel.hpp).
//
// Counted as 1 / lambda, which is fuel by air: 0 of air, and what a wideband sensor's current follows. The pipe is a
// ring of equal parcels in plug flow, by the volume that flows out.
//
//     manifold -> parcel that fills -> ring of parcels -> oldest parcel: the sensor -> first order
#pragma once

#include <cstdint>

#include <crankloop/input.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>

namespace crankloop::detail {

/// 1 / lambda of gas with this mass, burned mass, and fuel that lacked air: L fuel / air, air free and bound.
/// 0 to kMaxExcessAir_ratio.
template <class Real>
[[nodiscard]] inline Real fuel_by_air_ratio(const LambdaTable<Real>& table, Real mass_kg, Real burned_kg,
                                            Real unburned_kg) noexcept {
  constexpr Real kMost = static_cast<Real>(kMaxExcessAir_ratio);
  const Real fuel_kg = burned_kg * table.burned_fuel_ratio + unburned_kg;
  const Real air_kg = mass_kg - fuel_kg, wants_kg = table.air_fuel_ratio * fuel_kg;
  if (!(wants_kg > 0)) return Real{0};
  return wants_kg < kMost * air_kg ? wants_kg / air_kg : kMost;
}
/// Lambda, up to kMaxExcessAir_ratio.
template <class Real>
[[nodiscard]] inline Real lambda_of(Real fuel_by_air_ratio) noexcept {
  constexpr Real kMost = static_cast<Real>(kMaxExcessAir_ratio);
  return fuel_by_air_ratio * kMost > 1 ? Real{1} / fuel_by_air_ratio : kMost;
}

/// Lets parcels of gas flow into the pipe, at most as many as it has; fewer than none flow back and come again before
/// any other. O(parcels).
template <class Real, class S>
inline void flow_into_pipe(State<Real, S>& state, Real parcels, Real ratio) noexcept {
  constexpr std::uint32_t kParcels = S::lambda_parcels;
  constexpr Real kAll = Real{kParcels};
  parcels -= state.owed_ratio;
  state.owed_ratio = parcels < 0 ? (parcels > -kAll ? -parcels : kAll) : Real{0};
  if (!(parcels > 0)) return;
  if (parcels > kAll) parcels = kAll;
  Real lacks = Real{1} - state.filled_ratio;
  for (std::uint32_t i = 0; i <= kParcels && parcels >= lacks; ++i) {
    state.pipe_ratio[state.oldest_parcel] = state.filling_ratio + ratio * lacks;
    state.oldest_parcel = (state.oldest_parcel + 1) % kParcels;
    state.filled_ratio = state.filling_ratio = Real{0};
    parcels -= lacks, lacks = Real{1};
  }
  state.filled_ratio += parcels;
  state.filling_ratio += ratio * parcels;
}

/// The exhaust manifold as a tick left it, the pipe behind it and the sensor.
template <class Real, class S>
[[gnu::noinline]] void show_lambda(const Tables<Real, S>& tables, State<Real, S>& state,
                                   Output<Real, S>& out) noexcept {
  const LambdaTable<Real>& table = *tables.lambda;
  const GasContents<Real>& gas = state.manifold[kExhaust].contents;
  const Real ratio = fuel_by_air_ratio(table, gas.mass_kg, gas.burned_kg, state.manifold_unburned_kg[kExhaust]);
  out.exhaust_excess_air_ratio = lambda_of(ratio);
  Real seen = ratio;
  if (table.pipes_in_exhaust > 0) {
    const Real out_kg = out.outlet_kg_s * tables.drive->tick_s;
    const Real pipes = out_kg / gas.mass_kg * table.pipes_in_exhaust;
    flow_into_pipe(state, pipes * Real{S::lambda_parcels}, ratio);
    seen = state.pipe_ratio[state.oldest_parcel];
  }
  add_carried(state.sensor_ratio, state.sensor_rest_ratio, table.follows_ratio * (seen - state.sensor_ratio));
  if (!(state.sensor_ratio >= static_cast<Real>(1e-9))) state.sensor_ratio = state.sensor_rest_ratio = Real{0};
  out.sensor_excess_air_ratio = lambda_of(state.sensor_ratio);
}

/// Lambda of what left a cylinder in a cycle; 0: nothing did.
template <class Real, class S>
[[nodiscard]] inline Real outflow_lambda(const LambdaTable<Real>& table, const State<Real, S>& state,
                                         std::uint32_t cylinder) noexcept {
  const GasRecord<Real>& record = state.gas_record[cylinder];
  const Real unburned_kg = state.outflow_unburned_kg[cylinder];
  if (!(record.exhaust_kg >= static_cast<Real>(1e-12))) return Real{0};
  return lambda_of(fuel_by_air_ratio(table, record.exhaust_kg, record.exhaust_burned_kg, unburned_kg));
}

}  // namespace crankloop::detail
