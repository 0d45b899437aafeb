// Rows of the list of variables: outputs of gas exchange.
//
// What belongs here: rows of cylinders, crevices, runners, walls, manifolds, combustion and knock. What does not: all
// others, and what a list is for (variables.hpp).
#pragma once

#include <cstdint>

#include <crankloop/output.hpp>
#include <crankloop/variable.hpp>

namespace crankloop::detail {

/// In the order of Output.
template <class S, class Visit, class AnOutput>
constexpr void each_gas_output([[maybe_unused]] Visit& visit, [[maybe_unused]] AnOutput& out,
                               [[maybe_unused]] const EngineShape& shape) {
  [[maybe_unused]] const auto each = [&visit](const Variable& variable, auto& values, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) visit(variable.at(i), values[i]);
  };
  if constexpr (detail::Needs<S>::gas) {
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
      auto& g = out.cylinder_gas[k];
      visit(real("cylinder_gas[#].pressure_Pa", "Absolute pressure").at(k), g.pressure_Pa);
      visit(real("cylinder_gas[#].temperature_K", "Temperature").at(k), g.temperature_K);
      visit(real("cylinder_gas[#].mass_kg", "Mass of gas").at(k), g.mass_kg);
      visit(real("cylinder_gas[#].burned_ratio", "Burned share of the mass").at(k), g.burned_ratio);
      visit(real("cylinder_gas[#].intake_kg_s", "In through the intake, mean of the tick").at(k), g.flow_kg_s[kIntake]);
      visit(real("cylinder_gas[#].exhaust_kg_s", "In through the exhaust, mean of the tick").at(k),
            g.flow_kg_s[kExhaust]);
      visit(real("cylinder_gas[#].wall_heat_W", "Heat to the walls, mean of the tick").at(k), g.wall_heat_W);
    }
  }
  if constexpr (S::crevice) {
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
      auto& c = out.crevice[k];
      visit(real("crevice[#].mass_kg", "Mass of gas in the cylinder's crevices").at(k), c.mass_kg);
      visit(real("crevice[#].blow_by_kg_s", "From them into the crankcase, mean of the tick").at(k), c.blow_by_kg_s);
    }
  }
  if constexpr (S::runners) {
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
      auto& r = out.runner[k];
      visit(real("runner[#].intake_port_Pa", "Absolute pressure at the intake port").at(k),
            r.port_pressure_Pa[kIntake]);
      visit(real("runner[#].exhaust_port_Pa", "Absolute pressure at the exhaust port").at(k),
            r.port_pressure_Pa[kExhaust]);
      visit(real("runner[#].intake_kg_s", "Through the intake runner, toward the cylinder").at(k),
            r.flow_kg_s[kIntake]);
      visit(real("runner[#].exhaust_kg_s", "Through the exhaust runner, toward the cylinder").at(k),
            r.flow_kg_s[kExhaust]);
    }
  }
  if constexpr (S::walls) {
    each(real("wall_K[#]", "Temperature of the cylinder's walls"), out.wall_K, shape.cylinders);
    visit(real("intake_wall_heat_W", "To the walls of intake manifold or runners, mean of the tick"),
          out.port_heat_W[kIntake]);
    visit(real("exhaust_wall_heat_W", "To the walls of exhaust manifold or runners, mean of the tick"),
          out.port_heat_W[kExhaust]);
  }
  if constexpr (detail::Needs<S>::manifolds) {
    const auto manifold = [&visit](const Variable& pressure, const Variable& temperature, const Variable& burned,
                                   auto& values) {
      visit(pressure, values.pressure_Pa);
      visit(temperature, values.temperature_K);
      visit(burned, values.burned_ratio);
    };
    manifold(real("intake.pressure_Pa", "Absolute pressure in the intake manifold"),
             real("intake.temperature_K", "Temperature"), real("intake.burned_ratio", "Burned share of its gas"),
             out.manifold[kIntake]);
    manifold(real("exhaust.pressure_Pa", "Absolute pressure in the exhaust manifold"),
             real("exhaust.temperature_K", "Temperature"), real("exhaust.burned_ratio", "Burned share of its gas"),
             out.manifold[kExhaust]);
    visit(real("throttle_kg_s", "Through the throttle, mean of the tick"), out.throttle_kg_s);
    visit(real("outlet_kg_s", "Out of the exhaust manifold, mean of the tick"), out.outlet_kg_s);
  }
  if constexpr (S::gas_results) {
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
      auto& c = out.gas_cycle[k];
      visit(real("gas_cycle[#].net_mep_Pa", "Of the last whole cycle: work over the swept volume").at(k), c.net_mep_Pa);
      visit(real("gas_cycle[#].pumping_mep_Pa", "Its part from 180 to 540 deg; negative: a loss").at(k),
            c.pumping_mep_Pa);
      visit(real("gas_cycle[#].peak_Pa", "Largest pressure").at(k), c.peak_Pa);
      visit(real("gas_cycle[#].peak_deg", "Where it was").at(k), c.peak_deg);
      visit(real("gas_cycle[#].trapped_kg", "Gas in the cylinder when the intake closed").at(k), c.trapped_kg);
      visit(real("gas_cycle[#].trapped_air_kg", "Air of it").at(k), c.trapped_air_kg);
      visit(real("gas_cycle[#].residual_ratio", "Burned share of it").at(k), c.residual_ratio);
      visit(real("gas_cycle[#].volumetric_efficiency", "Air through the intake over ambient air that fills the stroke")
                .at(k),
            c.volumetric_efficiency);
      visit(real("gas_cycle[#].exhaust_K", "Of the gas through the exhaust, by its mean enthalpy").at(k), c.exhaust_K);
      visit(real("gas_cycle[#].fuel_kg", "Fuel burned").at(k), c.fuel_kg);
      visit(real("gas_cycle[#].excess_air_ratio", "Air there over air that the fuel wanted; 0: no fuel").at(k),
            c.excess_air_ratio);
      visit(real("gas_cycle[#].heat_J", "Of combustion").at(k), c.heat_J);
      visit(real("gas_cycle[#].wall_heat_J", "To the walls").at(k), c.wall_heat_J);
      visit(real("gas_cycle[#].energy_defect_J", "What the first law lacks: rounding").at(k), c.energy_defect_J);
    }
  }
  if constexpr (S::crevice && S::gas_results) {
    each(real("cycle_blow_by_kg[#]", "Of the last whole cycle: what blew by into the crankcase"), out.cycle_blow_by_kg,
         shape.cylinders);
  }
  if constexpr (detail::Needs<S>::lambda) {
    visit(real("exhaust.excess_air_ratio", "Lambda of the gas in the exhaust manifold; 100: air; 0: no sensor"),
          out.exhaust_excess_air_ratio);
    visit(real("sensor_excess_air_ratio", "Lambda that the sensor shows, behind its pipe and lag; 100: air"),
          out.sensor_excess_air_ratio);
    if constexpr (S::gas_results) {
      each(real("outflow_excess_air_ratio[#]", "Of the last whole cycle: lambda of what left the cylinder"),
           out.outflow_excess_air_ratio, shape.cylinders);
    }
  }
  if constexpr (detail::Needs<S>::charge_burn && S::gas_results) {
    for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
      auto& b = out.cycle_burn[k];
      visit(real("cycle_burn[#].start_deg", "Of the last whole cycle: where the burn began, by the charge").at(k),
            b.start_deg);
      visit(real("cycle_burn[#].duration_deg", "How long it lasted, by the charge; 0: nothing burned").at(k),
            b.duration_deg);
    }
  }
  if constexpr (detail::Needs<S>::knock) {
    each(real("knock_integral[#]", "Of the last whole cycle: the unburned gas ignites by itself at 1"),
         out.knock_integral, shape.cylinders);
    each(real("knock_deg[#]", "Where it passed 1; 0: it did not"), out.knock_deg, shape.cylinders);
  }
}

}  // namespace crankloop::detail
