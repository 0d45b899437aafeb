// The walls of an engine's cylinders over a tick.
//
// What belongs here: the temperature that a cylinder's gas sees, the heat that it gives, when that changes the
// temperature. What does not: the formulas (warm_walls.hpp), walls of manifolds and ports (engine_manifolds.hpp,
// engine_runners.hpp).
//
// Each step adds its heat to a sum; only every few ticks, so few that no wall changes by 0.05 K, does the sum change
// the temperature: walls take minutes, and a division a tick would be for nothing.
#pragma once

#include <cstdint>
#include <cstring>

#include <crankloop/faults.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/warm_walls.hpp>

namespace crankloop::detail {

/// Of cylinder `k`, or of lanes.
template <class T, class Real, class S>
[[nodiscard, gnu::always_inline]] inline decltype(auto) walls_at(const GasCylinders<Real>& table,
                                                                 [[maybe_unused]] const State<Real, S>& state,
                                                                 [[maybe_unused]] std::uint32_t k) noexcept {
  if constexpr (S::walls) {
    return WarmWalls<T>(table.walls, load<T>(state.wall_K + k));
  } else {
    return (table.walls);
  }
}

/// Heat that the gas of cylinder `k`, or of lanes, gave its walls in a step.
template <class T, class Real, class S>
[[gnu::always_inline]] inline void add_wall_heat(State<Real, S>& state, std::uint32_t k, const T& heat_J) noexcept {
  store<T>(state.wall_heat_J + k, load<T>(state.wall_heat_J + k) + heat_J);
}

/// Lets the heat of the last ticks change the temperatures of all walls. Answers fault bits.
template <class Real, class S>
[[nodiscard, gnu::noinline]] std::uint32_t change_wall_temperatures(const Tables<Real, S>& tables,
                                                                    State<Real, S>& state) noexcept {
  const Real time_s = static_cast<Real>(tables.gas_walls->ticks) * tables.drive->tick_s;
  std::uint32_t faults = 0;
  for (std::uint32_t k = 0; k < count<S>(tables.drive->cylinders); ++k) {
    Real &wall_K = state.wall_K[k], crevice_J_K{};
    if constexpr (S::crevice) {
      const CreviceGas<Real> crevice = state.crevice_gas.template at<Real>(k);
      crevice_J_K = crevice.mass_kg * (Real{646} + kHeatSlope<Real> * wall_K) + crevice.burned_kg * Real{93};
    }
    if (!step_walls(wall_K, state.wall_heat_J[k], *tables.gas_walls, crevice_J_K, time_s)) faults = kFaultGas;
  }
  return faults;
}

/// Once a tick, after the steps of the gas. Answers fault bits.
template <class Real, class S>
[[nodiscard, gnu::always_inline]] inline std::uint32_t step_cylinder_walls(const Tables<Real, S>& tables,
                                                                           State<Real, S>& state,
                                                                           Output<Real, S>& out) noexcept {
  std::uint32_t faults = 0;
  if ((static_cast<std::uint32_t>(state.ticks) & (tables.gas_walls->ticks - 1)) == 0)
    faults = change_wall_temperatures(tables, state);
  std::memcpy(out.wall_K, state.wall_K, sizeof out.wall_K);
  return faults;
}

}  // namespace crankloop::detail
