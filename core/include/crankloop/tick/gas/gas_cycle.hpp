// The cycle of one cylinder of an engine: the fuel that it brings to a step, the results that it leaves.
#pragma once

#include <cstdint>

#include <crankloop/input.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/crank/misfire_step.hpp>
#include <crankloop/tick/gas/combustion.hpp>

namespace crankloop::detail {

/// As an input asks, or as defined.
template <class Real, class S>
[[nodiscard]] inline BurnOrder<Real> burn_order(const Tables<Real, S>& tables,
                                                [[maybe_unused]] const Input<Real, S>& input,
                                                [[maybe_unused]] std::uint32_t cylinder) noexcept {
  if constexpr (Needs<S>::burn_input) {
    (void)tables;
    return {input.fuel_kg[cylinder], input.excess_air_ratio[cylinder], input.burn_start_deg[cylinder],
            input.burn_duration_deg[cylinder]};
  } else {
    const BurnTable<Real>& table = *tables.burn;
    return {table.fuel_kg, table.excess_air_ratio, table.burn_start_deg, table.burn_duration_deg};
  }
}

/// Fuel that burns on the way of a cylinder: where that passes latch_deg, of a new cycle, or of a misfiring one a
/// share. `ends`: it passes a cycle's end.
template <class Real, class S>
[[nodiscard]] inline GasFuel<Real> burn_on_way(const Tables<Real, S>& tables, State<Real, S>& state,
                                               const Input<Real, S>& input, std::uint32_t cylinder, const CycleWay& way,
                                               bool ends, std::uint32_t& faults) noexcept {
  const BurnTable<Real>& table = *tables.burn;
  CylinderBurn<Real>& burn = state.burn[cylinder];
  if (ends && !way.forward()) end_burn(burn);
  const auto& gas = state.cylinder_gas;
  const Real &mass_kg = gas.mass_kg[cylinder], &burned_kg = gas.burned_kg[cylinder];
  if (burn.taken == 0 && way.passes_forward(table.latch_phase)) {
    bool cut = false;
    if constexpr (Needs<S>::gas_cut) cut = (input.cut_cylinders >> cylinder & 1u) != 0;
    Real burning_ratio{1};
    if constexpr (S::misfire) {
      burning_ratio = begin_cycle(tables.misfires[cylinder], state.misfire[cylinder]);
      cut = cut || !(burning_ratio > 0);
    }
    const BurnOrder<Real> order = burn_order(tables, input, cylinder);
    faults |= take_fuel(burn, table, mass_kg, burned_kg, order, cut);
    if constexpr (S::misfire) burn.fuel_kg *= burning_ratio;  // the mixture's excess air stays
  }
  const GasFuel<Real> fuel = burnt_fuel(burn, table, mass_kg, burned_kg, way);
  if (ends && way.forward()) end_burn(burn);
  return fuel;
}

/// Shows a cycle that was recorded from its begin, and begins the next.
template <class Real, class S>
[[gnu::noinline]] void end_cycle(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out,
                                 std::uint32_t cylinder) noexcept {
  GasRecord<Real>& record = state.gas_record[cylinder];
  const GasContents<Real> gas = state.cylinder_gas.template at<Real>(cylinder).contents;
  if (record.whole != 0) {
    Real heat_J_kg{}, excess_air_ratio{};
    if constexpr (Needs<S>::burn) {
      const CylinderBurn<Real>& burn = state.burn[cylinder];
      heat_J_kg = tables.burn->heat_J_kg * burning_ratio(burn), excess_air_ratio = burn.excess_air_ratio;
    }
    out.gas_cycle[cylinder] = finished(record, gas, *tables.gas_cylinders, heat_J_kg, excess_air_ratio);
    if constexpr (S::crevice) out.cycle_blow_by_kg[cylinder] = state.cycle_blow_by_kg[cylinder];
  }
  if constexpr (S::crevice) state.cycle_blow_by_kg[cylinder] = Real{0};
  begin_cycle(record, gas);
}

}  // namespace crankloop::detail
