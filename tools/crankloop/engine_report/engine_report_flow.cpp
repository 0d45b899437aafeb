// Flow area of the valves of cylinder 1, in the report's section of the valve trains.
#include <cmath>
#include <memory>
#include <utility>

#include <crankloop/tabulate/valve_lift.hpp>
#include <crankloop/tabulate/valve_motion.hpp>

#include "../loops/flow_lines.hpp"
#include "engine_report_parts.hpp"

namespace crankloop::program {
namespace {

using report::Plot;
using report::Series;

constexpr double kMm2PerM2 = 1e6;

/// One train of which the file has a diameter of the valve.
struct TrainFlow {
  const TrainOfFile& train;
  std::size_t number;  ///< among all complete trains, for its colour
  std::vector<double> geometric_m2{};
  std::vector<double> effective_m2{};
  FlowIntegrals theory{};
  FlowIntegrals elastic{};
  FlowFigures figures{};
};

/// Open where the valve is off its seat, as in the other results.
double seat_contact_m(const Valve& valve, const ValveLift& lift) {
  const detail::ValveBody<double> body = valve_body(valve, lift);
  return body.preload_N / body.seat_N_m;
}

std::vector<TrainFlow> flows_of(const ReportInput& input) {
  const EngineDefinition& definition = input.exact.definition();
  const std::vector<std::string> names = names_of_trains(input.file);
  std::vector<TrainFlow> flows;
  const auto lift = std::make_unique<ValveLift>();
  for (std::size_t t = 0; t < input.trace.valves.size(); ++t) {
    const TrainOfFile& train = input.file.train(names[t]);
    const std::optional<FlowArea> area = flow_area_of(train);
    if (!area || !lift->init(definition.trains[t].cam, definition.trains[t].rocker).ok()) continue;
    TrainFlow flow{train, t};
    FlowSum sum(*area, seat_contact_m(definition.trains[t].valve, *lift), input.trace.spacing_deg);
    const std::vector<double>& lifts_m = input.trace.valves[t][ValveQuantity::lift];
    const std::size_t count = lifts_m.size() - 1;  // the last is the first of the next cycle
    const std::size_t base_circle =
        index_of_largest(input.trace.valves[t][ValveQuantity::theoretical_lift]) + count / 2;
    for (std::size_t i = 0; i <= count; ++i) sum.add(lifts_m[(base_circle + i) % count]);
    for (const double lift_m : lifts_m) {
      flow.geometric_m2.push_back(area->geometric_m2(lift_m));
      flow.effective_m2.push_back(area->effective_m2(lift_m));
    }
    flow.theory = theoretical_flow(*area, *lift);
    flow.elastic = sum.largest();
    if (std::optional<OtherValves> others = valves_beside(input.file, train); others && flow.elastic.open_deg > 0) {
      others->area.add(flow.elastic, train.definition.valve.per_cylinder);
      flow.figures = flow_figures(others->area, definition, input.operation.speed_rad_s());
    }
    flows.push_back(std::move(flow));
  }
  return flows;
}

Plot flow_plot(const ReportInput& input, const std::vector<TrainFlow>& flows) {
  std::vector<Series> curves;
  for (const TrainFlow& flow : flows) {
    const int colour = static_cast<int>(flow.number) + 1;
    curves.push_back(over_angle(input.trace, flow.train.name, flow.geometric_m2, kMm2PerM2));
    curves.back().style.colour = colour;
    curves.push_back(over_angle(input.trace, flow.train.name + ", effective", flow.effective_m2, kMm2PerM2));
    curves.back().style.colour = colour;
    curves.back().style.dashed = true;
  }
  Plot plot = plot_over_angle(input, "Flow area of one valve", axis_of("Area", "mm\u00B2"), std::move(curves));
  plot.caption =
      "Least geometric area between seat and head at the valve's lift, at most that of the port less the stem. Dashed: "
      "effective area, by flow coefficients.";
  for (const TrainFlow& flow : flows) {
    const std::string assumed = assumed_of(flow.train);
    if (!assumed.empty()) plot.caption += " Assumed, " + flow.train.name + ": " + assumed + ".";
  }
  return plot;
}

report::Table flow_table(const std::vector<TrainFlow>& flows) {
  report::Table table{"Flow area", {{"", "", false}, {"Unit", "", false}}, {}, false};
  for (const TrainFlow& flow : flows) table.columns.push_back({flow.train.name, ""});
  const auto row = [&](const char* name, const char* unit, const auto& value) {
    std::vector<std::string> cells{name, unit};
    for (const TrainFlow& flow : flows) {
      const double number = value(flow);
      cells.push_back(number > 0 ? number_text(number, 4) : std::string("\u2013"));
    }
    table.rows.push_back(std::move(cells));
  };
  using Flow = TrainFlow;
  row("Valves in a cylinder", "",
      [](const Flow& f) { return static_cast<double>(f.train.definition.valve.per_cylinder); });
  row("Open period of theory, crank angle", "deg", [](const Flow& f) { return f.theory.open_deg; });
  row("Open period", "deg", [](const Flow& f) { return f.elastic.open_deg; });
  row("Integral of the area, theory", "mm\u00B2 deg",
      [](const Flow& f) { return f.theory.geometric_m2_deg * kMm2PerM2; });
  row("Integral of the area", "mm\u00B2 deg", [](const Flow& f) { return f.elastic.geometric_m2_deg * kMm2PerM2; });
  row("Integral of the effective area, theory", "mm\u00B2 deg",
      [](const Flow& f) { return f.theory.effective_m2_deg * kMm2PerM2; });
  row("Integral of the effective area", "mm\u00B2 deg",
      [](const Flow& f) { return f.elastic.effective_m2_deg * kMm2PerM2; });
  row("Mean area while open", "mm\u00B2", [](const Flow& f) { return f.elastic.mean_geometric_m2() * kMm2PerM2; });
  row("Mean effective area", "mm\u00B2", [](const Flow& f) { return f.elastic.mean_effective_m2() * kMm2PerM2; });
  row("Mean area of the valves over displacement", "1/m",
      [](const Flow& f) { return f.figures.area_per_displacement_per_m; });
  row("Mean gas speed", "m/s", [](const Flow& f) { return f.figures.gas_speed_m_s; });
  row("Inlet Mach index Z", "", [](const Flow& f) { return is_exhaust(f.train) ? 0 : f.figures.mach_index; });
  return table;
}

}  // namespace

void add_flow_area(const ReportInput& input, report::Section& section) {
  const std::vector<TrainFlow> flows = flows_of(input);
  if (flows.empty()) return;
  section.blocks.push_back(flow_plot(input, flows));
  section.blocks.push_back(flow_table(flows));
}

}  // namespace crankloop::program
