// The cycle of a cylinder of an engine: the fuel that it brings to a step, the results that it leaves.
//
// What belongs here: of one, and of several abreast. What does not: what burns (combustion.hpp), how long
// (charge_burn.hpp), the sums of a record (gas_results.hpp).
#pragma once

#include <cstdint>

#include <crankloop/input.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/crank/misfire_step.hpp>
#include <crankloop/tick/gas/charge_burn.hpp>
#include <crankloop/tick/gas/combustion.hpp>
#include <crankloop/tick/gas/exhaust_lambda.hpp>
#include <crankloop/tick/gas/knock.hpp>
#include <crankloop/tick/gas/unburned_fuel.hpp>

namespace crankloop::detail {

/// As an input asks, or as defined.
template <class Real, class S>
[[nodiscard]] inline BurnOrder<Real> burn_order(const Tables<Real, S>& tables,
                                                [[maybe_unused]] const Input<Real, S>& input,
                                                [[maybe_unused]] std::uint32_t cylinder) noexcept {
  if constexpr (Needs<S>::burn_input) {
    (void)tables;
    Real start_deg = input.burn_start_deg[cylinder];
    if constexpr (S::controller_names) {
      if (input.by_spark_advance != 0) start_deg = -input.spark_advance_deg[cylinder];
    }
    return {input.fuel_kg[cylinder], input.excess_air_ratio[cylinder], start_deg, input.burn_duration_deg[cylinder]};
  } else {
    const BurnTable<Real>& table = *tables.burn;
    return {table.fuel_kg, table.excess_air_ratio, table.burn_start_deg, table.burn_duration_deg};
  }
}

/// The knock integral of a cylinder whose burn begins on its way.
template <class Real, class S>
[[gnu::noinline]] void begin_knock_on_way(const Tables<Real, S>& tables, State<Real, S>& state, std::uint32_t cylinder,
                                          const CycleWay& way) noexcept {
  begin_knock(state.knock[cylinder], charge_at_start(tables, state, cylinder, way));
  state.knock_due &= ~(std::uint32_t{1} << cylinder), state.knock_in_burn |= std::uint32_t{1} << cylinder;
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
    if constexpr (Needs<S>::charge_burn) burn.start_deg = state.charge_burn[cylinder].spark_deg;  // last good
    faults |= take_fuel(burn, table, mass_kg, burned_kg, order, cut);
    if constexpr (S::misfire) burn.fuel_kg *= burning_ratio;  // the mixture's excess air stays
    if constexpr (Needs<S>::charge_burn) order_start(state.charge_burn[cylinder], burn, table, *tables.charge_burn);
    if constexpr (Needs<S>::knock) {
      const std::uint32_t bit = std::uint32_t{1} << cylinder;
      reset_knock(state.knock[cylinder]);
      state.knock_due = tables.knock->in_use != 0 && burn.fuel_kg > 0 ? state.knock_due | bit : state.knock_due & ~bit;
    }
  }
  if constexpr (Needs<S>::charge_burn) {
    if (state.charge_burn[cylinder].due != 0 && burn.taken != 0 && way.deg<Real>() > burn.start_deg)
      begin_burn(tables, state, cylinder, way);
  }
  const GasFuel<Real> fuel = burnt_fuel(burn, table, mass_kg, burned_kg, way);
  if constexpr (Needs<S>::knock) {
    if (fuel.mass_kg > 0 && (state.knock_due >> cylinder & 1u) != 0) begin_knock_on_way(tables, state, cylinder, way);
  }
  if constexpr (Needs<S>::lambda) leave_unburned(*tables.lambda, state, cylinder, fuel.mass_kg);
  if (ends && way.forward()) end_burn(burn);
  return fuel;
}

/// The same of cylinder `k`, or of lanes; `ends` has a bit of each, from this one on.
template <class T, class Real, class S>
[[nodiscard, gnu::always_inline]] inline GasFuel<T> burn_of_block(const Tables<Real, S>& tables, State<Real, S>& state,
                                                                  const Input<Real, S>& input, std::uint32_t k,
                                                                  const CycleWay* way, std::uint32_t ends,
                                                                  std::uint32_t& faults) noexcept {
  GasFuel<T> fuel{};
  if constexpr (Needs<S>::burn) {
    for (int i = 0; i < kLanesIn<T>; ++i) {
      const GasFuel<Real> one =
          burn_on_way(tables, state, input, k + static_cast<std::uint32_t>(i), way[i], (ends >> i & 1u) != 0, faults);
      put_lane(fuel.mass_kg, i, one.mass_kg);
      put_lane(fuel.energy_J, i, one.energy_J);
      put_lane(fuel.burned_kg, i, one.burned_kg);
    }
  }
  return fuel;
}

/// The step of all cylinders as far as knock goes, and what their cycles show of it. Bits of each: `in_burn`, its
/// integral grows, `ends`, its cycle does.
template <class Real, class S>
[[gnu::noinline]] void knock_on_way(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out,
                                    std::uint32_t in_burn, std::uint32_t ends, const CycleWay* way,
                                    Real step_s) noexcept {
  for (std::uint32_t left = in_burn | ends; left != 0; left &= left - 1) {
    const std::uint32_t k = trailing_zeros(left), bit = std::uint32_t{1} << k;
    KnockRecord<Real>& knock = state.knock[k];
    const Real pressure_Pa = state.cylinder_gas.pressure_Pa[k];
    const bool goes_on =
        (in_burn & bit) != 0 && step_knock(knock, *tables.knock, state.burn[k], pressure_Pa, step_s, way[k]);
    const bool ended = (ends & bit) != 0;
    if (!goes_on || ended) state.knock_in_burn &= ~bit;
    if (ended && way[k].forward()) out.knock_integral[k] = knock.integral_ratio, out.knock_deg[k] = knock.passes_deg;
  }
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
    if constexpr (Needs<S>::lambda) {
      if (tables.lambda->in_use != 0)
        out.outflow_excess_air_ratio[cylinder] = outflow_lambda(*tables.lambda, state, cylinder);
    }
  }
  if constexpr (Needs<S>::lambda) state.outflow_unburned_kg[cylinder] = Real{0};
  if constexpr (S::crevice) state.cycle_blow_by_kg[cylinder] = Real{0};
  begin_cycle(record, gas);
}

/// Whether a cylinder is before firing dead centre, and none of its fuel has burned.
template <class Real, class S>
[[nodiscard]] inline bool before_burn([[maybe_unused]] const State<Real, S>& state, [[maybe_unused]] std::uint32_t k,
                                      const CycleWay& way) noexcept {
  if (way.to >> 63 == 0) return false;
  if constexpr (Needs<S>::burn) {
    return state.burn[k].taken == 0 || !(state.burn[k].burnt_ratio > 0);
  } else {
    return true;
  }
}

/// What a step of cylinder `k`, or of lanes, leaves in the records of their cycles. Bits of each: `shut`, its intake
/// did, `ends`, its cycle does.
template <class T, class Real, class S>
[[gnu::always_inline]] inline void record_block(const Tables<Real, S>& tables, State<Real, S>& state,
                                                Output<Real, S>& out, std::uint32_t k, const CylinderStep<T>& done,
                                                const PortStep<T> (&through)[kPorts], const T& gained_J,
                                                const T& fuel_kg, const CycleWay* way, std::uint32_t shut,
                                                std::uint32_t ends) noexcept {
  record_step<T>(&state.gas_record[k], done, through, fuel_kg, way);
  for (int i = 0; i < kLanesIn<T>; ++i) {
    const std::uint32_t one = k + static_cast<std::uint32_t>(i);
    GasRecord<Real>& record = state.gas_record[one];
    record_end(record, state.cylinder_gas.pressure_Pa[one], lane(gained_J, i), way[i]);
    if ((shut >> i & 1u) != 0 && before_burn(state, one, way[i]))
      record_trapped(record, state.cylinder_gas.template at<Real>(one).contents);
    if ((ends >> i & 1u) != 0) end_cycle(tables, state, out, one);
  }
}

}  // namespace crankloop::detail
