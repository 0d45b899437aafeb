// The page of `crankloop map`: a heat map of each result over speed and throttle.
#include <algorithm>

#include "../../engine_file/pressure_words.hpp"
#include "engine_map.hpp"

namespace crankloop::program {
namespace {

using report::Plot;
using report::Section;

/// Bounds of at most kRamp levels, at round numbers.
std::vector<double> levels_of(double low, double high) {
  report::Scale scale;
  for (int intervals = report::kRamp; intervals >= 2; --intervals) {
    scale = report::make_scale({}, {low, high}, intervals);
    if (scale.ticks.size() <= std::size_t{report::kRamp} + 1) break;
  }
  std::vector<double> bounds;
  for (const report::Tick& tick : scale.ticks) bounds.push_back(tick.value);
  return bounds;
}

Plot heat_map(const EngineMap& map, const MapColumn& column) {
  const Grid& speed = map.request.speed_rpm;
  const Grid& throttle = map.request.throttle_ratio;
  Plot plot = report::plot_of(std::string(column.title) + (*column.unit != '\0' ? ", " + std::string(column.unit) : ""),
                              report::axis_of("Engine speed", "rpm"), report::axis_of("Throttle", ""));
  plot.cell_x = speed.step();
  plot.cell_y = throttle.step();
  plot.x.range = report::Range{speed.from - plot.cell_x / 2, speed.to + plot.cell_x / 2};
  plot.y.range = report::Range{throttle.from - plot.cell_y / 2, throttle.to + plot.cell_y / 2};
  double low = column.value(map.points.front());
  double high = low;
  for (const MapPoint& point : map.points) {
    low = std::min(low, column.value(point));
    high = std::max(high, column.value(point));
  }
  const std::vector<double> bounds = levels_of(low, high);
  const std::size_t levels = bounds.size() - 1;
  for (std::size_t level = 0; level < levels; ++level) {
    report::Series series;
    series.name = report::number_text(bounds[level]) + " to " + report::number_text(bounds[level + 1]);
    series.style.draw = report::Draw::cells;
    series.style.ramp = levels > 1 ? 1 + static_cast<int>(level * (report::kRamp - 1) / (levels - 1)) : report::kRamp;
    for (const MapPoint& point : map.points) {
      const double value = column.value(point);
      const bool here = value >= bounds[level] && (value < bounds[level + 1] || level + 1 == levels);
      if (!here) continue;
      series.x.push_back(point.speed_rpm);
      series.y.push_back(point.throttle_ratio);
    }
    if (!series.x.empty()) plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace

report::Page map_page(const EngineMap& map) {
  const auto number = [](double value) { return report::format_number(value, 4); };
  const auto where = [&](const MapPoint& p) {
    return "at " + number(p.speed_rpm) + " rpm, throttle " + report::number_text(p.throttle_ratio);
  };
  const auto most = [&](double (*value)(const MapPoint&)) {
    return *std::max_element(map.points.begin(), map.points.end(),
                             [&](const MapPoint& a, const MapPoint& b) { return value(a) < value(b); });
  };
  report::Page page;
  page.title = map.file.name() + " over speed and throttle";
  page.subtitle = std::to_string(map.request.speed_rpm.count) + " speeds, " +
                  std::to_string(map.request.throttle_ratio.count) + " throttles, each until it has settled.";
  const MapPoint torque = most([](const MapPoint& p) { return p.brake_torque_Nm; });
  const MapPoint power = most([](const MapPoint& p) { return p.power_W; });
  const MapPoint charge = most([](const MapPoint& p) { return p.gas.cycle.volumetric_efficiency; });
  page.facts = {{"Largest brake torque", number(torque.brake_torque_Nm), "Nm", where(torque)},
                {"Largest brake power", number(power.power_W / 1e3), "kW", where(power)},
                {"Largest volumetric efficiency", number(charge.gas.cycle.volumetric_efficiency), "", where(charge)}};

  Section maps{"maps", "Over speed and throttle", {}};
  maps.blocks.push_back(report::Paragraph{pressure_in_words(map.file, 1, map.request.gas, "varied"), true});
  for (const MapColumn& column : kMapColumnList) {
    if (column.title != nullptr) maps.blocks.push_back(heat_map(map, column));
  }
  report::Table table{"Table: all points", {{"Speed", "rpm"}, {"Throttle", ""}}, {}, true};
  for (const MapColumn& column : kMapColumnList) {
    std::string title = column.name;
    if (const std::string unit = std::string("_") + column.unit; *column.unit != '\0' && title.size() > unit.size())
      title.resize(title.size() - unit.size());
    std::replace(title.begin(), title.end(), '_', ' ');
    table.columns.push_back({title, column.unit});
  }
  for (const MapPoint& point : map.points) {
    std::vector<std::string> row{number(point.speed_rpm), report::format_fixed(point.throttle_ratio, 3)};
    for (const MapColumn& column : kMapColumnList) row.push_back(number(column.value(point)));
    table.rows.push_back(std::move(row));
  }
  maps.blocks.push_back(std::move(table));
  page.sections.push_back(std::move(maps));

  Section method{"method", "How this was found", {}};
  method.blocks.push_back(report::Paragraph{"Command: " + map.command_line});
  report::List list;
  list.items.push_back("Each point is run at constant speed in ticks of " +
                       report::number_text(map.request.tick_s * 1e6) + " \u00B5s, in float, for " +
                       std::to_string(cycles_to_settle(map.file.definition())) +
                       " cycles to settle and one that counts.");
  list.items.push_back(
      "Fuel and start of the burn are the same everywhere: no more fuel burns than there is air for, and no point has "
      "the spark that is best for it.");
  list.items.push_back(map.file.definition().friction.any()
                           ? "Brake torque: less friction, by the file's [friction]."
                           : "Brake torque is the indicated one: the file has no [friction].");
  method.blocks.push_back(std::move(list));
  page.sections.push_back(std::move(method));
  page.footer = "Made by crankloop from " + map.file.path() + ".";
  return page;
}

}  // namespace crankloop::program
