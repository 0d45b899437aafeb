// Section of the engine report: torque.
#include <algorithm>

#include "engine_report_parts.hpp"

namespace crankloop::program {
namespace {

using report::Plot;
using report::Section;
using report::Series;

Plot engine_torque(const ReportInput& input) {
  const Trace& trace = input.trace;
  Plot plot = plot_over_angle(input, "Engine torque, all cylinders", axis_of("Torque", "Nm"),
                              {over_angle(trace, "torque", trace.torque_Nm, 1)});
  plot.id = "engine-torque";
  plot = with_extremes(std::move(plot));
  plot.bands = input.exact.definition().layout.cylinders > 1 && has_gas(input)
                   ? firings(input.exact.definition().layout)
                   : plot.bands;
  Series mean;
  mean.name = "mean " + number_text(input.figures.mean_torque_Nm) + " Nm";
  mean.x = {0, 720};
  mean.y = {input.figures.mean_torque_Nm, input.figures.mean_torque_Nm};
  mean.style.dashed = true;
  mean.style.colour = 2;
  if (has_gas(input)) plot.series.push_back(std::move(mean));
  plot.caption = "Sum of all cylinders at each angle.";
  if (has_gas(input))
    plot.caption += " Shaded from each cylinder's firing TDC to the next. Dashed: mean of the recorded cycles.";
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
  std::vector<double> orders, amplitudes_Nm;
  for (const Harmonic& h : input.summary.harmonics) {
    orders.push_back(h.order);
    amplitudes_Nm.push_back(h.amplitude_Nm);
  }
  Plot plot = plot_over_orders("Torque harmonics", "Order per crank revolution", "Nm", std::move(orders),
                               std::move(amplitudes_Nm));
  plot.caption = "Amplitudes of the engine torque's Fourier series, from " +
                 (breathes(input) ? std::to_string(input.trace.crank_deg.size() - 1) + " torques of the loop"
                                  : std::string("7200 exact torques")) +
                 " over the cycle.";
  return plot;
}

Plot close_up(const ReportInput& input) {
  const std::vector<CloseUpTick>& ticks = input.close_up;
  // The run counts engine angles, the page those from cylinder 1's firing TDC: they differ only if the layout shifts
  // cylinder 1.
  const double first_deg = input.exact.definition().layout.firing_deg[0];
  const double shift = ticks.back().crank_deg < first_deg ? 720 - first_deg : -first_deg;
  const report::Range window{ticks.front().crank_deg - input.figures.deg_per_tick + shift,
                             ticks.back().crank_deg + shift};
  Series fine{"torque over the angle", {}, {}, {}};
  for (const double turns_deg : {-720.0, 0.0}) {
    for (std::size_t i = 0; i + 1 < input.trace.crank_deg.size(); ++i) {
      const double deg = input.trace.crank_deg[i] + turns_deg;
      if (deg < window.low || deg > window.high) continue;
      fine.x.push_back(deg);
      fine.y.push_back(input.trace.torque_Nm[i]);
    }
  }
  Series mean{"mean over each tick", {}, {}, {}};
  mean.style.draw = report::Draw::step;
  Series points{"at each tick", {}, {}, {}};
  points.style.draw = report::Draw::points;
  for (const CloseUpTick& tick : ticks) {
    points.x.push_back(tick.crank_deg + shift);
    points.y.push_back(tick.torque_Nm);
    mean.x.push_back(tick.crank_deg + shift - input.figures.deg_per_tick);
    mean.y.push_back(tick.mean_torque_Nm);
  }
  mean.x.push_back(window.high);
  mean.y.push_back(mean.y.back());
  Plot plot = plot_of("The fixed step close up", crank_axis(), axis_of("Engine torque", "Nm"));
  plot.x.tick_step = 0;
  plot.x.range = report::Range{window.low, window.high + input.figures.deg_per_tick / 2};  // do not clip the last dot
  plot.series = {std::move(fine), std::move(mean), std::move(points)};
  plot.caption = "The torque that a controller gets at a tick of " + number_text(input.operation.tick_s * 1e6) +
                 " \u00B5s, one tick every " + number_text(input.figures.deg_per_tick) +
                 " deg: its value at the tick, and its mean over the tick (work done divided by angle turned), which "
                 "does not alias.";
  return plot;
}

}  // namespace

report::Section torque_section(const ReportInput& input) {
  const Trace& trace = input.trace;
  Section section{"torque", "Torque", {}};
  section.blocks.push_back(engine_torque(input));
  if (input.exact.definition().layout.cylinders > 1) section.blocks.push_back(single_torque(input));  // else the same
  section.blocks.push_back(harmonics(input));
  if (input.close_up.size() > 2) section.blocks.push_back(close_up(input));

  std::vector<AngleColumn> columns{{"All", "Nm", &trace.torque_Nm}};
  for (std::size_t k = 0; k < trace.cylinder_torque_Nm.size(); ++k) {
    columns.push_back({"Cylinder " + std::to_string(k + 1), "Nm", &trace.cylinder_torque_Nm[k]});
  }
  section.blocks.push_back(table_over_angle(trace, "Table: torque of the engine and of each cylinder", columns));
  report::Table table{"Table: torque harmonics",
                      {{"Order", ""}, {"Amplitude", "Nm"}, {"Phase", "deg"}, {"Cosine", "Nm"}, {"Sine", "Nm"}},
                      {},
                      true};
  double largest = 0;
  for (const Harmonic& h : input.summary.harmonics) largest = std::max(largest, h.amplitude_Nm);
  const int decimals = decimals_for(largest, 5);
  for (const Harmonic& h : input.summary.harmonics) {
    table.rows.push_back({report::format_fixed(h.order, 1), report::format_fixed(h.amplitude_Nm, decimals),
                          h.amplitude_Nm > 1e-9 * largest ? report::format_fixed(h.phase_deg, 1) : "",
                          report::format_fixed(h.cosine_Nm, decimals), report::format_fixed(h.sine_Nm, decimals)});
  }
  section.blocks.push_back(std::move(table));
  return section;
}

}  // namespace crankloop::program
