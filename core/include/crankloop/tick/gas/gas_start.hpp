// What an engine's gas starts from, at init and where a measured crank jumps.
#pragma once

#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/gas_inputs.hpp>
#include <crankloop/tick/gas/gas_places.hpp>
#include <crankloop/tick/gas/unburned_fuel.hpp>

namespace crankloop::detail {

/// A cylinder's crevices, in equilibrium with it.
template <class Real, class S>
void fill_crevice(const Tables<Real, S>& tables, State<Real, S>& state, std::uint32_t k) noexcept {
  Real mass_kg = tables.gas_crevice->kg_per_Pa * state.cylinder_gas.pressure_Pa[k];
  if constexpr (S::walls) mass_kg *= tables.gas_cylinders->walls.temperature_K / state.wall_K[k];
  state.crevice_gas.put(k, CreviceGas<Real>{mass_kg, mass_kg * state.cylinder_gas.burned_ratio[k]});
}

/// In a manifold.
template <class Real, class S>
[[nodiscard]] GasPoint<Real> manifold_of(const State<Real, S>& state, int port) noexcept {
  if constexpr (Needs<S>::manifolds) {
    return state.manifold[port].point;
  } else {
    const GivenGas<Real>& given = state.given_gas[port];
    return {given.pressure_Pa, given.temperature_K, static_cast<Real>(port), Real{0}};
  }
}

/// A cylinder's runners as the manifolds are, at rest.
template <class Real, class S>
void fill_runners(const Tables<Real, S>& tables, State<Real, S>& state, std::uint32_t k) noexcept {
  for (int port = 0; port < kPorts; ++port) {
    const GasRunner<Real>& table = tables.gas_runners->of[port];
    RunnerGas<Real>& runner = state.runner[port][k] = {};
    if (!(table.area_m2 > 0)) continue;
    const GasPoint<Real> from = manifold_of(state, port);
    runner.contents =
        contents_of(from.pressure_Pa, from.temperature_K, from.burned_ratio, Real{1} / table.per_volume_m3);
    runner.point = point_of(runner.contents, table.per_volume_m3);
  }
}

/// Anew, from the intake manifold, at the volumes as they are.
template <class Real, class S>
[[gnu::cold, gnu::noinline]] void fill_cylinders(const Tables<Real, S>& tables, State<Real, S>& state) noexcept {
  const GasPoint<Real> from = manifold_of(state, kIntake);
  if constexpr (Needs<S>::knock) state.knock_due = state.knock_in_burn = 0;
  for (std::uint32_t k = 0; k < count<S>(tables.drive->cylinders); ++k) {
    CylinderGas<Real> gas{};
    gas.volume_m3 = gas_volume_m3(tables, state.phase.units(), tables.drive->mechanism_of[k]);
    gas.contents = contents_of(from.pressure_Pa, from.temperature_K, from.burned_ratio, gas.volume_m3);
    gas.point = point_of(gas.contents, Real{1} / gas.volume_m3);
    const GasWalls<Real>& walls = walls_of(tables, state, k);
    gas.wall_heat_W = wall_heat_W(walls, gas.point, gas.volume_m3, stirring_m_s(walls, state.speed_rad_s));
    state.cylinder_gas.put(k, gas), state.cylinder_gas.put_areas(k, gas);
    state.cylinder_gas.pressure_before_Pa[k] = gas.point.pressure_Pa;
    state.cylinder_gas.spare[k] = Real{0};
    if constexpr (Needs<S>::burn) end_burn(state.burn[k]);
    if constexpr (S::gas_results) state.gas_record[k] = {};
    if constexpr (S::crevice) fill_crevice(tables, state, k);
    if constexpr (S::runners) fill_runners(tables, state, k);
    if constexpr (S::crevice && S::gas_results) state.cycle_blow_by_kg[k] = Real{0};
    if constexpr (Needs<S>::lambda) refill_unburned(state, k);
  }
}

/// Manifolds as outside, and cylinders filled from there.
template <class Real, class S>
[[gnu::cold]] void start_gas(const Tables<Real, S>& tables, State<Real, S>& state) noexcept {
  start_gas_inputs(tables, state);
  if constexpr (S::walls) {
    for (Real& wall_K : state.wall_K) wall_K = tables.gas_cylinders->walls.temperature_K;
    for (Real& heat_J : state.wall_heat_J) heat_J = Real{0};
  }
  if constexpr (Needs<S>::manifolds) {
    for (int port = 0; port < kPorts; ++port) {
      const GasBeyond<Real>& outside = tables.gas_manifolds->outside[port];
      state.outlet = {tables.gas_cylinders->ambient_K, Real{0}};
      const Real per_volume_m3 = tables.gas_manifolds->per_volume_m3[port];
      ManifoldGas<Real>& manifold = state.manifold[port];
      manifold.contents = contents_of(outside.pressure_Pa, outside.specific_work_J_kg * kPerGasConstant<Real>,
                                      outside.burned_ratio, Real{1} / per_volume_m3);
      manifold.point = point_of(manifold.contents, per_volume_m3);
    }
  }
  fill_cylinders(tables, state);
  // Cylinders that a scene has room for and the engine has not: as the first, so that a saved state is all numbers that
  // a step could compute with.
  for (std::uint32_t k = count<S>(tables.drive->cylinders); k < S::cylinders.capacity; ++k) {
    state.cylinder_gas.copy(0, k);
    if constexpr (S::crevice) fill_crevice(tables, state, k);
    if constexpr (S::runners) fill_runners(tables, state, k);
  }
}

}  // namespace crankloop::detail
