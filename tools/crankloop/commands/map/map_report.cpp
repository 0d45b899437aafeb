// The page of `crankloop map`: a heat map of each result over speed and throttle.
#include <algorithm>

#include "../../engine_file/pressure_words.hpp"
#include "engine_map.hpp"

namespace crankloop::program {
namespace {

using report::Plot;
using report::Section;

std::string unit_of(const MapColumn& column) { return column.is_share ? "%" : column.unit; }

double shown(const MapColumn& column, const MapPoint& point) {
  return (column.is_share ? 100 : 1) * column.value(point);
}

/// A grid's values; a single value is widened to a range, so that the map has an area.
std::vector<double> lattice(const Grid& grid) {
  if (grid.count == 1) return {grid.from - grid.step() / 2, grid.from + grid.step() / 2};
  std::vector<double> at;
  for (int i = 0; i < grid.count; ++i) at.push_back(grid.at(i));
  return at;
}

Plot heat_map(const EngineMap& map, const MapColumn& column) {
  const int loads = map.request.load.count;
  Plot plot = report::plot_of(column.title, report::axis_of("Engine speed", "rpm"),
                              report::axis_of(map.request.axis->title, map.request.axis->unit));
  report::Field& field = plot.field;
  field = {column.title, unit_of(column), lattice(map.request.speed_rpm), lattice(map.request.load), {}};
  for (std::size_t i = 0; i < field.x.size(); ++i) {
    for (std::size_t j = 0; j < field.y.size(); ++j) {
      const int speed = std::min(static_cast<int>(i), map.request.speed_rpm.count - 1);
      const int load = std::min(static_cast<int>(j), loads - 1);
      field.values.push_back(shown(column, map.points[static_cast<std::size_t>(speed * loads + load)]));
    }
  }
  plot.x.range = report::Range{field.x.front(), field.x.back()};
  plot.y.range = report::Range{field.y.front(), field.y.back()};
  return plot;
}

}  // namespace

report::Page map_page(const EngineMap& map) {
  const auto number = [](double value) { return report::format_number(value, 4); };
  const auto most = [&](double (*value)(const MapPoint&)) {
    return *std::max_element(map.points.begin(), map.points.end(),
                             [&](const MapPoint& a, const MapPoint& b) { return value(a) < value(b); });
  };
  report::Page page;
  const MapAxis& axis = *map.request.axis;
  page.title = map.file.name() + " over speed and " + axis.word;
  const auto counted = [](int count, const std::string& what) {
    return std::to_string(count) + ' ' + what + (count == 1 ? "" : "s");
  };
  page.subtitle = counted(map.request.speed_rpm.count, "speed") + ", " +
                  counted(map.request.load.count, axis.positions) + ", each until it has settled.";
  const MapPoint torque = most([](const MapPoint& p) { return p.brake_torque_Nm; });
  const MapPoint power = most([](const MapPoint& p) { return p.power_W; });
  const MapPoint charge = most([](const MapPoint& p) { return p.gas.cycle.volumetric_efficiency; });
  page.facts = {{"Largest brake torque", number(torque.brake_torque_Nm), "Nm", map.place_of(torque)},
                {"Largest brake power", number(power.power_W / 1e3), "kW", map.place_of(power)},
                {"Largest volumetric efficiency", number(100 * charge.gas.cycle.volumetric_efficiency), "%",
                 map.place_of(charge)}};

  Section maps{"maps", std::string("Over speed and ") + axis.word, {}};
  maps.blocks.push_back(
      report::Paragraph{pressure_in_words(map.file, 1, map.request.gas, map.request.axis->varied), true});
  for (const MapColumn& column : kMapColumnList) {
    if (column.title != nullptr) maps.blocks.push_back(heat_map(map, column));
  }
  report::Table table{"Table: all points", {{"Speed", "rpm"}, {axis.title, axis.unit}}, {}, true};
  for (const MapColumn& column : kMapColumnList) {
    std::string title = column.name;
    if (const std::string unit = std::string("_") + column.unit; *column.unit != '\0' && title.size() > unit.size())
      title.resize(title.size() - unit.size());
    std::replace(title.begin(), title.end(), '_', ' ');
    table.columns.push_back({title, unit_of(column)});
  }
  for (const MapPoint& point : map.points) {
    std::vector<std::string> row{number(point.speed_rpm), report::format_fixed(point.load, 3)};
    for (const MapColumn& column : kMapColumnList) row.push_back(number(shown(column, point)));
    table.rows.push_back(std::move(row));
  }
  maps.blocks.push_back(std::move(table));
  page.sections.push_back(std::move(maps));

  Section method{"method", "Method", {}};
  method.blocks.push_back(report::Paragraph{"Command: " + map.command_line});
  report::List list;
  list.items.push_back("Each point is run at constant speed in ticks of " +
                       report::number_text(map.request.tick_s * 1e6) + " \u00B5s, in float, for " +
                       std::to_string(cycles_to_settle(map.file.definition())) +
                       " cycles to settle and one for the result.");
  list.items.push_back(
      std::string("The burn starts at the same angle everywhere: the spark timing is not optimised. ") +
      (map.request.gas.excess_air_ratio > 0 ? "Fuel follows the air in each cylinder."
                                            : "Fuel burns only as far as there is air for it."));
  list.items.push_back(map.file.definition().friction.any()
                           ? "Brake torque is the indicated torque less the file's [friction]."
                           : "Brake torque is the indicated torque: the file has no [friction].");
  method.blocks.push_back(std::move(list));
  page.sections.push_back(std::move(method));
  page.footer = "Made by crankloop from " + map.file.path() + ".";
  return page;
}

}  // namespace crankloop::program
