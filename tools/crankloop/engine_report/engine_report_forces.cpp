// Sections of the engine report: motion and forces of one cylinder.
#include <algorithm>

#include <crankloop/tabulate/mechanism.hpp>

#include "../files/units.hpp"
#include "engine_report_parts.hpp"

namespace crankloop::program {
namespace {

using report::Axis;
using report::Paragraph;
using report::Plot;
using report::Section;
using report::Series;

constexpr double kMega = 1e-6;

/// One row per quantity: where it is largest and smallest.
report::Table extremes_table(const ReportInput& input) {
  const Trace& trace = input.trace;
  report::Table table{
      "Largest and smallest over the cycle",
      {{"Quantity", "", false}, {"Unit", "", false}, {"Largest", ""}, {"at", "deg"}, {"Smallest", ""}, {"at", "deg"}},
      {},
      false};
  const auto row = [&](const char* name, const char* unit, const std::vector<double>& values, double factor) {
    const std::size_t most = index_of_largest(values);
    const std::size_t least = index_of_smallest(values);
    const int decimals = decimals_for(std::max(values[most], -values[least]) * factor, 5);
    table.rows.push_back({name, unit, report::format_fixed(values[most] * factor, decimals),
                          report::format_fixed(trace.crank_deg[most], 2),
                          report::format_fixed(values[least] * factor, decimals),
                          report::format_fixed(trace.crank_deg[least], 2)});
  };
  const auto of = [&](const char* name, Quantity quantity, const char* unit, double factor = 1) {
    row(name, unit, trace[quantity], factor);
  };
  if (has_gas(input)) of("Pressure", Quantity::pressure, "kPa", kKilo);
  if (has_gas(input)) of("Gas force", Quantity::gas_force, "N");
  of("Reciprocating inertia force", Quantity::inertia_force, "N");
  of("Total force on the piston", Quantity::total_force, "N");
  of("Side force", Quantity::side_force, "N");
  of("Rod force", Quantity::rod_force, "N");
  of("Tangential force", Quantity::tangential_force, "N");
  of("Radial force", Quantity::radial_force, "N");
  of("Crank pin load", Quantity::crank_pin_load, "N");
  of("Torque of one cylinder", Quantity::torque, "Nm");
  row("Torque of the engine", "Nm", trace.torque_Nm, 1);
  of("Tilting moment of one cylinder", Quantity::tilting_moment, "Nm");
  of("Piston velocity", Quantity::velocity, "m/s");
  of("Piston acceleration", Quantity::acceleration, "m/s\u00B2");
  of("Rod speed", Quantity::rod_speed, "rad/s");
  of("Rod acceleration", Quantity::rod_acceleration, "rad/s\u00B2");
  return table;
}

}  // namespace

report::Section motion_section(const ReportInput& input) {
  const Trace& trace = input.trace;
  Section section{"motion", "Motion of piston and rod", {}};
  const auto plot = [&](const char* title, const char* quantity, const char* unit, Quantity of, double factor,
                        const char* caption) {
    Plot drawn = with_extremes(
        plot_over_angle(input, title, axis_of(quantity, unit), {over_angle(trace, "", trace[of], factor)}));
    drawn.caption = caption;
    section.blocks.push_back(std::move(drawn));
  };
  plot("Piston displacement", "Displacement from TDC", "mm", Quantity::displacement, 1e3, "");
  plot("Piston velocity", "Velocity", "m/s", Quantity::velocity, 1, "Positive toward the crankshaft.");
  plot("Piston acceleration", "Acceleration", "m/s\u00B2", Quantity::acceleration, 1,
       "Positive toward the crankshaft.");
  plot("Rod angle", "Rod angle from the cylinder axis", "deg", Quantity::rod_angle, kDegPerRad, "");
  section.blocks.push_back(table_over_angle(trace, "Table: motion over one turn; the second repeats it",
                                            {{"Displacement", "mm", &trace[Quantity::displacement], 1e3},
                                             {"Velocity", "m/s", &trace[Quantity::velocity]},
                                             {"Acceleration", "m/s\u00B2", &trace[Quantity::acceleration]},
                                             {"Rod angle", "deg", &trace[Quantity::rod_angle], kDegPerRad},
                                             {"Rod speed", "rad/s", &trace[Quantity::rod_speed]},
                                             {"Rod acceleration", "rad/s\u00B2", &trace[Quantity::rod_acceleration]}},
                                            360));
  return section;
}

report::Section force_section(const ReportInput& input) {
  const Trace& trace = input.trace;
  Section section{"forces", "Forces of one cylinder", {}};
  const Axis force = axis_of("Force", "kN");
  std::vector<Series> piston_forces{over_angle(trace, "inertia", trace[Quantity::inertia_force], kKilo)};
  if (has_gas(input)) {
    piston_forces.insert(piston_forces.begin(), over_angle(trace, "gas", trace[Quantity::gas_force], kKilo));
    piston_forces.push_back(over_angle(trace, "total", trace[Quantity::total_force], kKilo));
  }
  Plot on_piston =
      plot_over_angle(input, "Gas force, reciprocating inertia force and their sum", force, std::move(piston_forces));
  if (!has_gas(input)) on_piston.title = "Reciprocating inertia force";
  const std::size_t inertia = has_gas(input) ? 1 : 0;
  on_piston.markers = {largest_marker(on_piston, inertia), smallest_marker(on_piston, inertia)};
  if (has_gas(input)) on_piston.markers.push_back(largest_marker(on_piston, 0));
  on_piston.caption = "On the piston along the cylinder axis, positive toward the crankshaft.";
  section.blocks.push_back(std::move(on_piston));

  const auto plot = [&](const char* title, Quantity of, const char* caption) {
    Plot drawn = with_extremes(plot_over_angle(input, title, force, {over_angle(trace, "", trace[of], kKilo)}));
    drawn.caption = caption;
    section.blocks.push_back(std::move(drawn));
  };
  plot("Side force on the cylinder wall", Quantity::side_force,
       "Of the piston on the wall. Positive on the thrust side of the power stroke, opposite to where the crank pin "
       "moves after TDC.");
  const std::vector<double> displacement = scaled(trace[Quantity::displacement], 1e3);
  const std::vector<double> side = scaled(trace[Quantity::side_force], kKilo);
  Plot over_stroke = plot_of("Side force over the piston displacement", axis_of("Displacement from TDC", "mm"),
                             axis_of("Side force", "kN"));
  over_stroke.series = loop_by_strokes(input, displacement, side);
  over_stroke.caption = "Where along the cylinder the wall is loaded, and from which side.";
  section.blocks.push_back(std::move(over_stroke));
  plot("Rod force", Quantity::rod_force, "Along the rod, positive in compression.");
  plot("Tangential force at the crank pin", Quantity::tangential_force, "Positive with the rotation.");
  plot("Radial force at the crank pin", Quantity::radial_force,
       "Positive toward the crank centre; without the rod's own centrifugal force (see the crank pin's load).");

  std::vector<AngleColumn> columns{{"Displacement", "mm", &trace[Quantity::displacement], 1e3}};
  if (has_gas(input)) columns.push_back({"Gas", "N", &trace[Quantity::gas_force]});
  columns.push_back({"Inertia", "N", &trace[Quantity::inertia_force]});
  if (has_gas(input)) columns.push_back({"Total", "N", &trace[Quantity::total_force]});
  columns.push_back({"Side", "N", &trace[Quantity::side_force]});
  columns.push_back({"Rod", "N", &trace[Quantity::rod_force]});
  columns.push_back({"Tangential", "N", &trace[Quantity::tangential_force]});
  columns.push_back({"Radial", "N", &trace[Quantity::radial_force]});
  columns.push_back({"Torque", "Nm", &trace[Quantity::torque]});
  section.blocks.push_back(table_over_angle(trace, "Table: forces and torque of one cylinder", columns));
  section.blocks.push_back(extremes_table(input));
  return section;
}

report::Section force_per_area_section(const ReportInput& input) {
  const Trace& trace = input.trace;
  const double area_m2 = bore_area_m2(input.exact.definition().crank);
  const double factor = kMega / area_m2;
  Section section{"per-area", "Forces per piston area", {}};
  section.blocks.push_back(
      Paragraph{"Divided by the piston area of " + number_text(area_m2 * 1e4) + " cm\u00B2, forces compare between " +
                "engines. The torque of one cylinder is the tangential one times crank radius and area: " +
                number_text(input.exact.definition().crank.crank_radius_m * area_m2 * 1e6, 5) + " Nm per MPa."});
  const Axis axis = axis_of("Force per piston area", "MPa");
  std::vector<Series> piston_forces{over_angle(trace, "inertia", trace[Quantity::inertia_force], factor)};
  if (has_gas(input)) {
    piston_forces.insert(piston_forces.begin(), over_angle(trace, "gas", trace[Quantity::gas_force], factor));
    piston_forces.push_back(over_angle(trace, "total", trace[Quantity::total_force], factor));
  }
  section.blocks.push_back(
      plot_over_angle(input, has_gas(input) ? "Gas, inertia and total" : "Inertia", axis, std::move(piston_forces)));
  const auto plot = [&](const char* title, Quantity of) {
    section.blocks.push_back(
        with_extremes(plot_over_angle(input, title, axis, {over_angle(trace, "", trace[of], factor)})));
  };
  plot("Tangential force", Quantity::tangential_force);
  plot("Side force", Quantity::side_force);
  section.blocks.push_back(plot_over_angle(input, "Rod force and radial force", axis,
                                           {over_angle(trace, "rod", trace[Quantity::rod_force], factor),
                                            over_angle(trace, "radial", trace[Quantity::radial_force], factor)}));
  std::vector<AngleColumn> columns;
  const auto column = [&](const char* title, Quantity of) { columns.push_back({title, "MPa", &trace[of], factor}); };
  if (has_gas(input)) column("Gas", Quantity::gas_force);
  column("Inertia", Quantity::inertia_force);
  if (has_gas(input)) column("Total", Quantity::total_force);
  column("Side", Quantity::side_force);
  column("Rod", Quantity::rod_force);
  column("Tangential", Quantity::tangential_force);
  column("Radial", Quantity::radial_force);
  section.blocks.push_back(table_over_angle(trace, "Table: forces per piston area", columns));
  return section;
}

}  // namespace crankloop::program
