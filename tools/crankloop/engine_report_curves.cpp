// Sections of the engine report: torque, pressure, motion, forces.
#include <algorithm>
#include <cmath>

#include <crankloop/tabulate/mechanism.hpp>

#include "engine_report_parts.hpp"

namespace crankloop::program {
namespace {

using report::Axis;
using report::Paragraph;
using report::Plot;
using report::Section;
using report::Series;

constexpr double kBar = 1e-5;
constexpr double kKilo = 1e-3;
constexpr double kMega = 1e-6;

Axis axis_of(const std::string& title, const std::string& unit) {
  Axis axis;
  axis.title = title;
  axis.unit = unit;
  return axis;
}

// ---- Torque ----

Plot engine_torque(const ReportInput& input) {
  const Trace& trace = input.trace;
  Plot plot = plot_over_angle(input, "Engine torque, all cylinders", axis_of("Torque", "Nm"),
                              {over_angle(trace, "torque", trace.torque_Nm, 1)});
  plot.id = "engine-torque";
  plot = with_extremes(std::move(plot));
  plot.bands = input.exact.definition().layout.cylinders > 1 && has_gas(input) ? firings(input.exact.definition().layout)
                                                                              : plot.bands;
  Series mean;
  mean.name = "mean " + number_text(input.figures.mean_torque_Nm) + " Nm";
  mean.x = {0, 720};
  mean.y = {input.figures.mean_torque_Nm, input.figures.mean_torque_Nm};
  mean.style.dashed = true;
  mean.style.colour = 2;
  if (has_gas(input)) plot.series.push_back(std::move(mean));
  plot.caption = "Sum of all cylinders at each angle.";
  if (has_gas(input)) plot.caption += " Shaded from each cylinder's firing TDC to the next. Dashed: mean of the recorded cycles.";
  return plot;
}

Plot single_torque(const ReportInput& input) {
  const Trace& trace = input.trace;
  Plot plot = with_extremes(plot_over_angle(input, "Torque of one cylinder", axis_of("Torque", "Nm"),
                                            {over_angle(trace, "", trace[Quantity::torque], 1)}));
  plot.caption = "Tangential force times crank radius; all cylinders are alike, each at its own angle.";
  return plot;
}

Plot harmonics(const ReportInput& input) {
  Plot plot;
  plot.title = "Torque harmonics";
  plot.x = axis_of("Order per crank revolution", "");
  plot.x.tick_step = 1;
  plot.y = axis_of("Amplitude", "Nm");
  Series bars;
  bars.style.draw = report::Draw::bar;
  for (const Harmonic& h : input.summary.harmonics) {
    bars.x.push_back(h.order);
    bars.y.push_back(h.amplitude_Nm);
  }
  const auto most = static_cast<std::size_t>(std::max_element(bars.y.begin(), bars.y.end()) - bars.y.begin());
  plot.markers.push_back({bars.x[most], bars.y[most],
                          number_text(bars.y[most], 3) + " Nm at order " + number_text(bars.x[most]), 0});
  plot.series.push_back(std::move(bars));
  plot.caption = "Amplitudes of the engine torque's Fourier series, from 7200 exact torques over the cycle.";
  return plot;
}

Plot close_up(const ReportInput& input) {
  const std::vector<CloseUpTick>& ticks = input.close_up;
  const double from = ticks.front().crank_deg;
  const double to = ticks.back().crank_deg;
  Series fine{"torque over the angle", {}, {}, {}};
  const double shift = input.exact.definition().layout.firing_deg[0];
  for (std::size_t i = 0; i < input.trace.crank_deg.size(); ++i) {
    const double engine_deg = std::fmod(input.trace.crank_deg[i] + shift, 720.0);
    if (engine_deg < from || engine_deg > to) continue;
    fine.x.push_back(input.trace.crank_deg[i]);
    fine.y.push_back(input.trace.torque_Nm[i]);
  }
  Series mean{"mean over each tick", {}, {}, {}};
  mean.style.draw = report::Draw::step;
  Series points{"at each tick", {}, {}, {}};
  points.style.draw = report::Draw::points;
  const auto own = [shift](double engine_deg) { return engine_deg < shift ? engine_deg - shift + 720 : engine_deg - shift; };
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    points.x.push_back(own(ticks[i].crank_deg));
    points.y.push_back(ticks[i].torque_Nm);
    if (i + 1 == ticks.size()) break;
    mean.x.push_back(own(ticks[i].crank_deg));
    mean.y.push_back(ticks[i + 1].mean_torque_Nm);
  }
  mean.x.push_back(own(ticks.back().crank_deg));
  mean.y.push_back(mean.y.back());
  Plot plot;
  plot.title = "The fixed step close up";
  plot.x = crank_axis();
  plot.x.tick_step = 0;
  plot.x.range = report::Range{own(from), own(to)};
  plot.y = axis_of("Engine torque", "Nm");
  plot.series = {std::move(fine), std::move(mean), std::move(points)};
  plot.caption = "What a controller gets at a tick of " + number_text(input.operation.tick_s * 1e6) + " \u00B5s, one tick every " +
                 number_text(input.figures.deg_per_tick) +
                 " deg: the torque at the tick, and its mean over the tick (work done divided by angle turned), which does not alias.";
  return plot;
}

// ---- Loops ----

/// Part of a curve between two crank angles, across the end of the cycle if need be.
Series piece(const Trace& trace, const std::string& name, const std::vector<double>& x, const std::vector<double>& y, double from_deg,
             double to_deg) {
  Series series;
  series.name = name;
  const auto count = static_cast<long>(trace.crank_deg.size()) - 1;  // the last point is the first of the next cycle
  const auto at = [&](double deg) { return std::lround(deg / trace.spacing_deg); };
  for (long i = at(from_deg); i <= at(to_deg); ++i) {
    const auto k = static_cast<std::size_t>((i % count + count) % count);
    series.x.push_back(x[k]);
    series.y.push_back(y[k]);
  }
  return series;
}

/// A loop over the displacement or the volume, in a colour for each stroke.
std::vector<Series> loop_by_strokes(const ReportInput& input, const std::vector<double>& x, const std::vector<double>& y) {
  const DeadCentres centres = dead_centres(input.exact.definition().crank);
  const double tdc = centres.tdc_rad * kDegPerRad;
  const double bdc = centres.bdc_rad * kDegPerRad;
  if (!has_gas(input)) return {piece(input.trace, "down", x, y, tdc, bdc), piece(input.trace, "up", x, y, bdc, tdc + 360)};
  return {piece(input.trace, "power", x, y, tdc, bdc), piece(input.trace, "exhaust", x, y, bdc, tdc + 360),
          piece(input.trace, "intake", x, y, tdc + 360, bdc + 360), piece(input.trace, "compression", x, y, bdc + 360, tdc + 720)};
}

/// "25.1 bar at 8 deg" for a point of the loop that belongs to entry i of the trace.
report::Marker loop_marker(const Trace& trace, const std::vector<double>& x, const std::vector<double>& y, std::size_t i,
                           const std::string& unit, std::size_t series) {
  return {x[i], y[i], number_text(y[i], 3) + " " + unit + " at " + number_text(trace.crank_deg[i], 3) + " deg", series};
}

std::vector<double> volume_cm3(const ReportInput& input) {
  const Crank& crank = input.exact.definition().crank;
  std::vector<double> volume = scaled(input.trace[Quantity::displacement], bore_area_m2(crank) * 1e6);
  for (double& v : volume) v += clearance_volume_m3(crank) * 1e6;
  return volume;
}

/// A little room around data on a logarithmic axis, so that no tick stands in the corner.
report::Range widened(Span span) { return {0.88 * span.low, 1.13 * span.high}; }

/// Twice the largest pressure of the second half of the exhaust stroke and of the intake stroke.
double exchange_top(const ReportInput& input, const std::vector<double>& pressure_bar) {
  double most = 0;
  for (std::size_t i = 0; i < pressure_bar.size(); ++i) {
    if (input.trace.crank_deg[i] > 270 && input.trace.crank_deg[i] < 540) most = std::max(most, pressure_bar[i]);
  }
  return 2 * most;
}

/// One row per quantity: where it is largest and smallest.
report::Table extremes_table(const ReportInput& input) {
  const Trace& trace = input.trace;
  report::Table table{"Largest and smallest over the cycle",
                      {{"Quantity", "", false}, {"Unit", "", false}, {"Largest", ""}, {"at", "deg"}, {"Smallest", ""}, {"at", "deg"}},
                      {},
                      false};
  const auto row = [&](const char* name, const char* unit, const std::vector<double>& values, double factor) {
    const std::size_t most = index_of_largest(values);
    const std::size_t least = index_of_smallest(values);
    const int decimals = decimals_for(std::max(values[most], -values[least]) * factor, 5);
    table.rows.push_back({name, unit, report::format_fixed(values[most] * factor, decimals), report::format_fixed(trace.crank_deg[most], 2),
                          report::format_fixed(values[least] * factor, decimals), report::format_fixed(trace.crank_deg[least], 2)});
  };
  const auto of = [&](const char* name, Quantity quantity, const char* unit, double factor = 1) { row(name, unit, trace[quantity], factor); };
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

report::Section torque_section(const ReportInput& input) {
  const Trace& trace = input.trace;
  Section section{"torque", "Torque", {}};
  section.blocks.push_back(engine_torque(input));
  section.blocks.push_back(single_torque(input));
  section.blocks.push_back(harmonics(input));
  if (input.close_up.size() > 2) section.blocks.push_back(close_up(input));

  std::vector<AngleColumn> columns{{"All", "Nm", &trace.torque_Nm}};
  for (std::size_t k = 0; k < trace.cylinder_torque_Nm.size(); ++k) {
    columns.push_back({"Cylinder " + std::to_string(k + 1), "Nm", &trace.cylinder_torque_Nm[k]});
  }
  section.blocks.push_back(table_over_angle(trace, "Table: torque of the engine and of each cylinder", columns));
  report::Table table{"Table: torque harmonics", {{"Order", ""}, {"Amplitude", "Nm"}, {"Cosine", "Nm"}, {"Sine", "Nm"}}, {}, true};
  double largest = 0;
  for (const Harmonic& h : input.summary.harmonics) largest = std::max(largest, h.amplitude_Nm);
  const int decimals = decimals_for(largest, 5);
  for (const Harmonic& h : input.summary.harmonics) {
    table.rows.push_back({report::format_fixed(h.order, 1), report::format_fixed(h.amplitude_Nm, decimals),
                          report::format_fixed(h.cosine_Nm, decimals), report::format_fixed(h.sine_Nm, decimals)});
  }
  section.blocks.push_back(std::move(table));
  return section;
}

report::Section pressure_section(const ReportInput& input) {
  const Trace& trace = input.trace;
  const std::vector<double> volume = volume_cm3(input);
  const std::vector<double> pressure = scaled(trace[Quantity::pressure], kBar);
  const std::size_t peak = index_of_largest(pressure);

  Section section{"pressure", "Cylinder pressure and work", {}};
  section.blocks.push_back(Paragraph{pressure_remark(input), true});
  Plot over_crank = plot_over_angle(input, "Pressure over the crank angle", axis_of("Cylinder pressure, absolute", "bar"),
                                    {over_angle(trace, "", trace[Quantity::pressure], kBar)});
  over_crank.markers = {largest_marker(over_crank, 0)};
  section.blocks.push_back(std::move(over_crank));

  Plot loop;
  loop.title = "Pressure over the volume";
  loop.x = axis_of("Cylinder volume", "cm\u00B3");
  loop.x.include_zero = true;
  loop.y = axis_of("Cylinder pressure, absolute", "bar");
  loop.y.include_zero = true;
  loop.series = loop_by_strokes(input, volume, pressure);
  loop.markers = {loop_marker(trace, volume, pressure, peak, "bar", 0)};
  loop.caption = "Its area is the indicated work: net IMEP " + number_text(input.summary.net_mep_Pa * kKilo) + " kPa, gross (over the " +
                 "closed 360 deg) " + number_text(input.summary.gross_mep_Pa * kKilo) + " kPa.";
  Plot log_loop = loop;
  Plot exchange = loop;
  section.blocks.push_back(std::move(loop));
  log_loop.title = "The same, both axes logarithmic";
  log_loop.x.logarithmic = log_loop.y.logarithmic = true;
  log_loop.x.range = widened(span_of(volume));
  log_loop.y.range = widened(span_of(pressure));
  log_loop.markers.clear();
  log_loop.caption = "Polytropic compression and expansion are straight lines here.";
  section.blocks.push_back(std::move(log_loop));
  exchange.title = "Gas exchange";
  exchange.markers.clear();
  exchange.y.range = report::Range{0, exchange_top(input, pressure)};
  exchange.caption = "The lower end of the loop: exhaust and intake enclose net less gross IMEP, " +
                     number_text((input.summary.net_mep_Pa - input.summary.gross_mep_Pa) * kKilo, 3) + " kPa.";
  section.blocks.push_back(std::move(exchange));
  const std::vector<double> volume_m3 = scaled(volume, 1e-6);
  section.blocks.push_back(table_over_angle(trace, "Table: pressure and volume of one cylinder",
                                            {{"Pressure", "bar", &trace[Quantity::pressure], kBar}, {"Volume", "cm\u00B3", &volume_m3, 1e6}}));
  return section;
}

report::Section motion_section(const ReportInput& input) {
  const Trace& trace = input.trace;
  Section section{"motion", "Motion of piston and rod", {}};
  const auto plot = [&](const char* title, const char* quantity, const char* unit, Quantity of, double factor, const char* caption) {
    Plot drawn = with_extremes(plot_over_angle(input, title, axis_of(quantity, unit), {over_angle(trace, "", trace[of], factor)}));
    drawn.caption = caption;
    section.blocks.push_back(std::move(drawn));
  };
  plot("Piston displacement", "Displacement from TDC", "mm", Quantity::displacement, 1e3, "");
  plot("Piston velocity", "Velocity", "m/s", Quantity::velocity, 1, "Positive toward the crankshaft.");
  plot("Piston acceleration", "Acceleration", "m/s\u00B2", Quantity::acceleration, 1, "Positive toward the crankshaft.");
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
  Plot on_piston = plot_over_angle(input, "Gas force, reciprocating inertia force and their sum", force, std::move(piston_forces));
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
       "Of the piston on the wall. Positive on the thrust side of the power stroke, opposite to where the crank pin moves after TDC.");
  const std::vector<double> displacement = scaled(trace[Quantity::displacement], 1e3);
  const std::vector<double> side = scaled(trace[Quantity::side_force], kKilo);
  Plot over_stroke;
  over_stroke.title = "Side force over the piston displacement";
  over_stroke.x = axis_of("Displacement from TDC", "mm");
  over_stroke.y = axis_of("Side force", "kN");
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
  section.blocks.push_back(Paragraph{"Divided by the piston area of " + number_text(area_m2 * 1e4) + " cm\u00B2, forces compare between " +
                                     "engines. The torque of one cylinder is the tangential one times crank radius and area: " +
                                     number_text(input.exact.definition().crank.crank_radius_m * area_m2 * 1e6, 5) + " Nm per MPa."});
  const Axis axis = axis_of("Force per piston area", "MPa");
  std::vector<Series> piston_forces{over_angle(trace, "inertia", trace[Quantity::inertia_force], factor)};
  if (has_gas(input)) {
    piston_forces.insert(piston_forces.begin(), over_angle(trace, "gas", trace[Quantity::gas_force], factor));
    piston_forces.push_back(over_angle(trace, "total", trace[Quantity::total_force], factor));
  }
  section.blocks.push_back(plot_over_angle(input, has_gas(input) ? "Gas, inertia and total" : "Inertia", axis, std::move(piston_forces)));
  const auto plot = [&](const char* title, Quantity of) {
    section.blocks.push_back(with_extremes(plot_over_angle(input, title, axis, {over_angle(trace, "", trace[of], factor)})));
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
