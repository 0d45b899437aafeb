// The cycle of one cylinder of an engine: the fuel that it brings to a step, the results that it leaves.
#pragma once

#include <cstdint>

#include <crankloop/input.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/charge_burn.hpp>
#include <crankloop/tick/gas/combustion.hpp>
#include <crankloop/tick/gas/knock.hpp>

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

/// Fuel that burns on the way of a cylinder: where that passes latch_deg, of a new cycle. `ends`: it passes a cycle's
/// end.
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
    const BurnOrder<Real> order = burn_order(tables, input, cylinder);
    if constexpr (Needs<S>::charge_burn) burn.start_deg = state.charge_burn[cylinder].spark_deg;  // last good
    faults |= take_fuel(burn, table, mass_kg, burned_kg, order, cut);
    if constexpr (Needs<S>::charge_burn) order_start(state.charge_burn[cylinder], burn, table, *tables.charge_burn);
    if constexpr (Needs<S>::knock) reset_knock(state.knock[cylinder], *tables.knock, burn.fuel_kg);
  }
  if constexpr (Needs<S>::charge_burn) {
    if (state.charge_burn[cylinder].due != 0 && burn.taken != 0 && way.deg<Real>() > burn.start_deg)
      begin_burn(tables, state, cylinder, way);
  }
  if constexpr (Needs<S>::knock) {
    KnockRecord<Real>& knock = state.knock[cylinder];
    if (knock.stage == kKnockDue && burn.fuel_kg > 0 && way.deg<Real>() > burn.start_deg)
      begin_knock(knock, charge_at_start(tables, state, cylinder, way));
  }
  const GasFuel<Real> fuel = burnt_fuel(burn, table, mass_kg, burned_kg, way);
  if (ends && way.forward()) end_burn(burn);
  return fuel;
}

/// The step of a cylinder in its burn as far as knock goes, and what a cycle shows of it.
template <class Real, class S>
[[gnu::always_inline]] inline void knock_on_way(const Tables<Real, S>& tables, State<Real, S>& state,
                                                Output<Real, S>& out, std::uint32_t cylinder, const CycleWay& way,
                                                bool ends, Real step_s) noexcept {
  KnockRecord<Real>& knock = state.knock[cylinder];
  if (knock.stage == kKnockInBurn)
    step_knock(knock, *tables.knock, state.burn[cylinder], state.cylinder_gas.pressure_Pa[cylinder], step_s, way);
  if (!ends) return;
  if (knock.stage == kKnockInBurn) knock.stage = kKnockDone;
  if (!way.forward()) return;
  out.knock_integral[cylinder] = knock.integral_ratio, out.knock_deg[cylinder] = knock.passes_deg;
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
    if constexpr (Needs<S>::charge_burn) out.cycle_burn[cylinder] = burn_of_cycle(tables, state, cylinder);
    if constexpr (S::crevice) out.cycle_blow_by_kg[cylinder] = state.cycle_blow_by_kg[cylinder];
  }
  if constexpr (S::crevice) state.cycle_blow_by_kg[cylinder] = Real{0};
  begin_cycle(record, gas);
}

}  // namespace crankloop::detail
