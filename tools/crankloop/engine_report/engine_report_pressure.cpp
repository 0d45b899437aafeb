// Section of the engine report: cylinder pressure and work.
#include <algorithm>
#include <cmath>

#include <crankloop/tabulate/mechanism.hpp>

#include "../files/units.hpp"
#include "engine_report_parts.hpp"

namespace crankloop::program {
namespace {

using report::Paragraph;
using report::Plot;
using report::Section;

constexpr double kUsualGamma = 1.33;  ///< ratio of specific heats of burning gas

std::vector<double> volume_cm3(const ReportInput& input) {
  const Crank& crank = input.exact.definition().crank;
  std::vector<double> volume = scaled(input.trace[Quantity::displacement], bore_area_m2(crank) * 1e6);
  for (double& v : volume) v += clearance_volume_m3(crank) * 1e6;
  return volume;
}

/// A margin around data on a logarithmic axis, so that no tick is in the corner.
report::Range widened(Span span) { return {0.88 * span.low, 1.13 * span.high}; }

/// Twice the largest pressure of the second half of the exhaust stroke and of the intake stroke.
double exchange_top(const ReportInput& input, const std::vector<double>& pressure_kPa) {
  double most = 0;
  for (std::size_t i = 0; i < pressure_kPa.size(); ++i) {
    if (input.trace.crank_deg[i] > 270 && input.trace.crank_deg[i] < 540) most = std::max(most, pressure_kPa[i]);
  }
  return 2 * most;
}

/// Apparent heat release from pressure and volume: dQ = g/(g-1) p dV + 1/(g-1) V dp (Heywood, Internal Combustion
/// Engine Fundamentals, 1988, section 9.2.2). From shortly before combustion until the exhaust valve opens.
void add_heat_release(Section& section, const ReportInput& input, const std::vector<double>& volume_m3) {
  const Pressure& p = input.exact.definition().pressure;
  const bool synthesised = p.source == PressureSource::wiebe;
  const double gamma = synthesised ? p.wiebe.expansion_exponent : kUsualGamma;
  const double from_deg = synthesised ? p.wiebe.start_of_combustion_deg : -30;
  const double to_deg = synthesised ? p.wiebe.exhaust_valve_opens_deg : 110;
  const std::vector<double>& pressure_Pa = input.trace[Quantity::pressure];
  const double spacing_deg = input.trace.spacing_deg;
  const auto count = static_cast<int>(pressure_Pa.size()) - 1;  // the last is the first of the next cycle
  const auto at = [count](int i) { return static_cast<std::size_t>((i + count) % count); };
  Plot rate = plot_of("Rate of heat release", axis_of("Crank angle from firing TDC", "deg"), axis_of("Rate", "J/deg"));
  Plot heat = plot_of("Heat released", rate.x, axis_of("Heat", "J"));
  rate.series.resize(1);
  heat.series.resize(1);
  double sum_J = 0;
  for (int i = static_cast<int>(std::ceil(from_deg / spacing_deg)); i * spacing_deg < to_deg; ++i) {
    const std::size_t here = at(i);
    const std::size_t next = at(i + 1);
    const double dQ_J = (gamma * (pressure_Pa[here] + pressure_Pa[next]) / 2 * (volume_m3[next] - volume_m3[here]) +
                         (volume_m3[here] + volume_m3[next]) / 2 * (pressure_Pa[next] - pressure_Pa[here])) /
                        (gamma - 1);
    sum_J += dQ_J;
    rate.series[0].x.push_back((i + 0.5) * spacing_deg);
    rate.series[0].y.push_back(dQ_J / spacing_deg);
    heat.series[0].x.push_back((i + 1) * spacing_deg);
    heat.series[0].y.push_back(sum_J);
  }
  rate.markers = {largest_marker(rate, 0)};
  heat.markers = {largest_marker(heat, 0)};
  rate.caption = "Apparent: from pressure and volume, by the ratio of specific heats " + number_text(gamma) +
                 "; what the walls take is not in it.";
  if (breathes(input)) {
    heat.caption = "Of " + number_text(input.figures.gas.cycle.heat_J) + " J of combustion; " +
                   number_text(input.figures.gas.cycle.wall_heat_J) + " J went to the walls in the whole cycle.";
  }
  section.blocks.push_back(std::move(rate));
  section.blocks.push_back(std::move(heat));
}

struct IndicatedWork {
  double net_mep_Pa, gross_mep_Pa;
};

/// Of gas exchange what the tick has summed up: the area between its points is off by some 0.4 % in ticks of 4 deg.
IndicatedWork indicated_work(const ReportInput& input) {
  if (!breathes(input)) return {input.summary.net_mep_Pa, input.summary.gross_mep_Pa};
  const GasCycle<double>& cycle = input.figures.gas.cycle;
  return {cycle.net_mep_Pa, cycle.net_mep_Pa - cycle.pumping_mep_Pa};
}

}  // namespace

report::Section pressure_section(const ReportInput& input) {
  const Trace& trace = input.trace;
  const std::vector<double> volume = volume_cm3(input);
  const std::vector<double> pressure = scaled(trace[Quantity::pressure], kKilo);
  const std::size_t peak = index_of_largest(pressure);

  Section section{"pressure", "Cylinder pressure and work", {}};
  section.blocks.push_back(Paragraph{pressure_remark(input), true});
  Plot over_crank =
      plot_over_angle(input, "Pressure over the crank angle", axis_of("Cylinder pressure, absolute", "kPa"),
                      {over_angle(trace, "", trace[Quantity::pressure], kKilo)});
  over_crank.markers = {largest_marker(over_crank, 0)};
  section.blocks.push_back(std::move(over_crank));

  Plot loop;
  loop.title = "Pressure over the volume";
  loop.x = axis_of("Cylinder volume", "cm\u00B3");
  loop.x.include_zero = true;
  loop.y = axis_of("Cylinder pressure, absolute", "kPa");
  loop.y.include_zero = true;
  loop.series = loop_by_strokes(input, volume, pressure);
  loop.markers = {loop_marker(trace, volume, pressure, peak, "kPa", 0)};
  const IndicatedWork work = indicated_work(input);
  loop.caption = "Its area is the indicated work: net IMEP " + number_text(work.net_mep_Pa * kKilo) +
                 " kPa, gross (over the closed 360 deg) " + number_text(work.gross_mep_Pa * kKilo) + " kPa.";
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
                     report::format_number((work.net_mep_Pa - work.gross_mep_Pa) * kKilo, 3) + " kPa.";
  section.blocks.push_back(std::move(exchange));
  const std::vector<double> volume_m3 = scaled(volume, 1e-6);
  add_heat_release(section, input, volume_m3);
  section.blocks.push_back(table_over_angle(
      trace, "Table: pressure and volume of one cylinder",
      {{"Pressure", "kPa", &trace[Quantity::pressure], kKilo}, {"Volume", "cm\u00B3", &volume_m3, 1e6}}));
  return section;
}

}  // namespace crankloop::program
