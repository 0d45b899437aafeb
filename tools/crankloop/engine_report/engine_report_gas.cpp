// Section of the engine report: gas exchange.
#include <algorithm>

#include "../files/units.hpp"
#include "engine_report_parts.hpp"

namespace crankloop::program {
namespace {

using report::Plot;
using report::Section;

/// Cylinder, manifolds, and ports at the ends of runners. The frame holds manifolds and ports, not the cylinder.
Plot pressures(const ReportInput& input) {
  const Trace& trace = input.trace;
  const GasTrace& gas = trace.gas;
  std::vector<report::Series> curves{over_angle(trace, "cylinder", trace[Quantity::pressure], kKilo),
                                     over_angle(trace, "intake manifold", gas.manifold_Pa[kIntake], kKilo),
                                     over_angle(trace, "exhaust manifold", gas.manifold_Pa[kExhaust], kKilo)};
  const char* const ports[kPorts] = {"intake port", "exhaust port"};
  double most_Pa = 0;
  for (std::size_t i = 0; i < std::size_t{kPorts}; ++i) {
    most_Pa = std::max(most_Pa, 2 * span_of(gas.manifold_Pa[i]).high);
    if (gas.port_Pa[i].empty()) continue;
    most_Pa = std::max(most_Pa, span_of(gas.port_Pa[i]).high);
    curves.push_back(over_angle(trace, ports[i], gas.port_Pa[i], kKilo));
  }
  Plot plot = plot_over_angle(input, "Pressure on both sides of the valves", axis_of("Pressure, absolute", "kPa"),
                              std::move(curves));
  plot.y.range = report::Range{0, most_Pa * kKilo};
  plot.caption = "Of cylinder 1. Blow-down and compression go beyond the frame.";
  if (plot.series.size() > 3) plot.caption += " A port is the end of its runner: its gas swings.";
  return plot;
}

Plot flows(const ReportInput& input) {
  const Trace& trace = input.trace;
  Plot plot = plot_over_angle(input, "Flow through the valves", axis_of("Into the cylinder", "g/s"),
                              {over_angle(trace, "intake", trace.gas[GasQuantity::intake_flow], 1e3),
                               over_angle(trace, "exhaust", trace.gas[GasQuantity::exhaust_flow], 1e3)});
  plot.caption = "Positive into cylinder 1: intake below zero and exhaust above it are backflow.";
  return plot;
}

report::Table cycle_table(const ReportInput& input) {
  const GasCycle<double>& c = input.figures.gas.cycle;
  report::Table table{
      "A cycle of a cylinder", {{"Quantity", "", false}, {"Value", ""}, {"Unit", "", false}}, {}, false};
  const auto row = [&](const char* name, double value, const char* unit) {
    table.rows.push_back({name, number_text(value), unit});
  };
  row("Net IMEP", c.net_mep_Pa / 1e3, "kPa");
  row("Pumping mean pressure", c.pumping_mep_Pa / 1e3, "kPa");
  row("Volumetric efficiency", 100 * c.volumetric_efficiency, "%");
  row("Trapped air", c.trapped_air_kg * 1e6, "mg");
  row("Residual gas, share of the trapped mass", 100 * c.residual_ratio, "%");
  row("Excess air ratio", c.excess_air_ratio, "");
  row("Fuel burned", c.fuel_kg * 1e6, "mg");
  if (const double unburned = unburned_kg(input.file.definition().gas, input.figures.gas); unburned > 0)
    row("Fuel that found no air beside that in crevices", unburned * 1e6, "mg");
  row("Heat of combustion", c.heat_J, "J");
  row("Heat to the walls", c.wall_heat_J, "J");
  if (input.file.definition().gas.crevice.any())
    row("Blow-by into the crankcase", input.figures.gas.blow_by_kg * 1e6, "mg");
  if (input.file.definition().gas.charge_burn.in_use) {
    row("Burn by charge, start", input.figures.gas.burn_start_deg, "deg");
    row("Burn by charge, duration", input.figures.gas.burn_duration_deg, "deg");
  }
  if (input.file.definition().gas.octane_number > 0)
    row("Knock integral of the cylinder nearest to knock", input.figures.gas.knock_integral, "");
  row("Temperature of the gas that leaves through the exhaust valve", c.exhaust_K, "K");
  row("Intake manifold, mean pressure", input.figures.gas.intake_Pa / 1e3, "kPa");
  row("Exhaust manifold, mean pressure", input.figures.gas.exhaust_Pa / 1e3, "kPa");
  const std::string left_out = exhaust_heat_left_out(input.file.definition());
  row(("Exhaust manifold, mean temperature" + (left_out.empty() ? "" : "; " + left_out)).c_str(),
      input.figures.gas.exhaust_manifold_K, "K");
  row("Energy balance error", c.energy_defect_J, "J");
  return table;
}

}  // namespace

report::Section gas_section(const ReportInput& input) {
  const Trace& trace = input.trace;
  Section section{"gas", "Gas exchange", {}};
  for (const std::string& doubt : doubts_about(input.figures.gas))
    section.blocks.push_back(report::Paragraph{doubt, true});
  section.blocks.push_back(flows(input));
  section.blocks.push_back(pressures(input));
  Plot temperature = plot_over_angle(input, "Temperature of the gas", axis_of("Temperature", "K"),
                                     {over_angle(trace, "", trace.gas[GasQuantity::temperature], 1)});
  temperature.markers = {largest_marker(temperature, 0)};
  temperature.caption = "Mean of the cylinder: one zone.";
  section.blocks.push_back(std::move(temperature));
  section.blocks.push_back(plot_over_angle(input, "Mass in the cylinder", axis_of("Mass", "mg"),
                                           {over_angle(trace, "", trace.gas[GasQuantity::mass], 1e6)}));
  section.blocks.push_back(plot_over_angle(input, "Heat to the walls", axis_of("Heat flow", "kW"),
                                           {over_angle(trace, "", trace.gas[GasQuantity::wall_heat], 1e-3)}));
  section.blocks.push_back(cycle_table(input));
  return section;
}

}  // namespace crankloop::program
