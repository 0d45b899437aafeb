// The walls of an engine's cylinders over a step, those of several cylinders abreast.
//
// What belongs here: the temperature that a cylinder's gas sees, the walls' step. What does not: the formulas
// (warm_walls.hpp), walls of manifolds and ports (engine_manifolds.hpp, engine_runners.hpp).
#pragma once

#include <cstdint>

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

/// Of cylinder `k`, or of lanes, whose gas gave them `heat_J`. Answers fault bits.
template <class T, class Real, class S>
[[nodiscard, gnu::always_inline]] inline std::uint32_t step_cylinder_walls(const Tables<Real, S>& tables,
                                                                           State<Real, S>& state, Output<Real, S>& out,
                                                                           std::uint32_t k, const T& heat_J,
                                                                           Real step_s) noexcept {
  const WarmWallsTable<Real>& table = *tables.gas_walls;
  T wall_K = load<T>(state.wall_K + k);
  std::uint32_t faults = 0;
  if (table.capacity_J_K > 0) {
    T rest_K = load<T>(state.wall_rest_K + k);
    bool plain = true;
    if constexpr (S::crevice) {
      if (tables.gas_crevice->in_use != 0) {
        const CreviceGas<T> crevice = state.crevice_gas.template at<T>(k);
        const T crevice_J_K = crevice.mass_kg * (Real{646} + kHeatSlope<Real> * wall_K) + crevice.burned_kg * Real{93};
        step_walls<T>(wall_K, rest_K, table, heat_J, crevice_J_K, step_s), plain = false;
      }
    }
    if (plain) step_walls<T>(wall_K, rest_K, table, heat_J, step_s);
    const auto well = both_hold(wall_K >= static_cast<Real>(kLeastGas_K), wall_K <= static_cast<Real>(kMaxGas_K));
    if (__builtin_expect(!all(well), 0)) put_walls_right<T>(wall_K, rest_K), faults = kFaultGas;
    store<T>(state.wall_K + k, wall_K), store<T>(state.wall_rest_K + k, rest_K);
  }
  store<T>(out.wall_K + k, wall_K);
  return faults;
}

}  // namespace crankloop::detail
