// The crevices of an engine's cylinders over a step, those of several cylinders abreast.
//
// What belongs here: the cylinder's step with them, what is shown of them. What does not: the step of one
// (crevice.hpp).
#pragma once

#include <cstdint>

#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/crevice.hpp>
#include <crankloop/tick/gas/engine_manifolds.hpp>
#include <crankloop/tick/gas/warm_walls.hpp>

namespace crankloop::detail {

/// At the walls' temperature.
template <class Real>
[[nodiscard, gnu::always_inline]] inline const GasCrevice<Real>& crevice_at(const GasCrevice<Real>& table,
                                                                            const GasWalls<Real>&) noexcept {
  return table;
}
template <class T>
[[nodiscard, gnu::always_inline]] inline WarmCrevice<T> crevice_at(const GasCrevice<NumberOf<T>>& table,
                                                                   const WarmWalls<T>& walls) noexcept {
  return WarmCrevice<T>(table, walls.temperature_K);
}

/// Steps the gas of cylinder `k`, or of lanes, with its crevices where the engine has some.
template <class T, class Real, class S, class Walls, class Far>
[[nodiscard, gnu::always_inline]] inline CylinderStep<T> step_with_crevices(
    const Tables<Real, S>& tables, [[maybe_unused]] State<Real, S>& state, CylinderGas<T>& gas,
    [[maybe_unused]] std::uint32_t k, const T& volume_m3, const GasFuel<T>& fuel, const Walls& walls,
    const EngineGasStep<Real>& step, const T (&to_m2)[kPorts], const Far (&beyond)[kPorts],
    PortStep<T> (&through)[kPorts], [[maybe_unused]] CreviceStep<T>& crevice_step) noexcept {
  if constexpr (S::crevice) {
    const GasCrevice<Real>& table = *tables.gas_crevice;
    const auto crevices = [&](ClosedStep<T> & closed, GasGain<T> & gain) __attribute__((always_inline)) {
      if (table.in_use == 0) return T{};
      CreviceGas<T> crevice = state.crevice_gas.template at<T>(k);
      const auto& at = crevice_at(table, walls);
      const Real step_s = step.drive.step_s;
      const T give_way = leaks(at) ? step_crevice<T, true>(crevice, at, gas, step_s, closed, gain, crevice_step)
                                   : step_crevice<T, false>(crevice, at, gas, step_s, closed, gain, crevice_step);
      state.crevice_gas.put(k, crevice);
      return give_way;
    };
    return step_gas<T>(gas, volume_m3, fuel, walls, step.drive, to_m2, beyond, through, crevices);
  } else {
    (void)tables;
    return step_gas<T>(gas, volume_m3, fuel, walls, step.drive, to_m2, beyond, through);
  }
}

/// Shows what they hold; shows and records what blew by.
template <class T, class Real, class S>
[[gnu::always_inline]] inline void show_crevices(const Tables<Real, S>& tables, State<Real, S>& state,
                                                 Output<Real, S>& out, const CreviceStep<T>& step,
                                                 std::uint32_t k) noexcept {
  for (int i = 0; i < kLanesIn<T>; ++i) {
    const std::uint32_t one = k + static_cast<std::uint32_t>(i);
    CreviceOutput<Real>& shown = out.crevice[one];
    shown.mass_kg = state.crevice_gas.mass_kg[one];
    if (!leaks(*tables.gas_crevice)) continue;
    const Real blow_by_kg = lane(step.blow_by_kg, i);
    shown.blow_by_kg_s += blow_by_kg * tables.drive->per_tick_s;
    if constexpr (S::gas_results) state.cycle_blow_by_kg[one] += blow_by_kg;
  }
}

}  // namespace crankloop::detail
