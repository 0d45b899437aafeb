// The page of `crankloop map`: a heat map of each result over speed and throttle, a curve where one of them is fixed.
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

report::Axis speed_axis() { return report::axis_of("Engine speed", "rpm"); }
report::Axis load_axis(const EngineMap& map) {
  return report::axis_of(map.request.axis->title, map.request.axis->unit);
}

Plot heat_map(const EngineMap& map, const MapColumn& column) {
  Plot plot = report::plot_of(column.title, speed_axis(), load_axis(map));
  report::Field& field = plot.field;
  field = {column.title, unit_of(column), map.request.speed_rpm.values(), map.request.load.values(), {}};
  for (const MapPoint& point : map.points) field.values.push_back(shown(column, point));
  plot.x.range = report::Range{field.x.front(), field.x.back()};
  plot.y.range = report::Range{field.y.front(), field.y.back()};
  return plot;
}

/// Over the load where there is but one speed, else over the speed.
Plot curve(const EngineMap& map, const MapColumn& column) {
  const bool over_load = map.request.speed_rpm.count == 1 && map.request.load.count > 1;
  Plot plot = report::plot_of(column.title, over_load ? load_axis(map) : speed_axis(),
                              report::axis_of(column.title, unit_of(column)));
  report::Series& series = plot.series.emplace_back();
  series.style.draw = report::Draw::line_and_points;
  for (const MapPoint& point : map.points) {
    series.x.push_back(over_load ? point.load : point.speed_rpm);
    series.y.push_back(shown(column, point));
  }
  return plot;
}

/// "over throttle at 2000 rpm".
std::string over_what(const EngineMap& map) {
  const MapRequest& request = map.request;
  const std::string load = std::string(request.axis->word);
  const std::string speed = report::number_text(request.speed_rpm.from) + " rpm";
  const std::string unit = *request.axis->unit == '\0' ? "" : std::string(" ") + request.axis->unit;
  const std::string one_load = load + ' ' + report::number_text(request.load.from) + unit;
  if (request.speed_rpm.count > 1) return "over speed " + (request.load.count > 1 ? "and " + load : "at " + one_load);
  return request.load.count > 1 ? "over " + load + " at " + speed : "at " + speed + " and " + one_load;
}

/// Results that every map shows, and those that this one asks for.
bool is_drawn(const EngineMap& map, const MapColumn& column) {
  if (column.result == MapResult::burn_start) return map.request.best_spark;
  if (column.result == MapResult::knock_integral) return map.file.definition().gas.octane_number > 0;
  return column.title != nullptr;
}

}  // namespace

report::Page map_page(const EngineMap& map) {
  const auto number = [](double value) { return report::format_number(value, 4); };
  report::Page page;
  const MapAxis& axis = *map.request.axis;
  page.title = map.file.name() + ' ' + over_what(map);
  const auto counted = [](int count, const std::string& what) {
    return std::to_string(count) + ' ' + what + (count == 1 ? "" : "s");
  };
  page.subtitle = counted(map.request.speed_rpm.count, "speed") + ", " +
                  counted(map.request.load.count, axis.positions) + ", each until it has settled.";
  const MapPoint& torque = map.largest(MapResult::brake_torque);
  const MapPoint& power = map.largest(MapResult::brake_power);
  const MapPoint& charge = map.largest(MapResult::volumetric_efficiency);
  page.facts = {{"Largest brake torque", number(torque.at(MapResult::brake_torque)), "Nm", map.place_of(torque)},
                {"Largest brake power", number(power.at(MapResult::brake_power)), "kW", map.place_of(power)},
                {"Largest volumetric efficiency", number(100 * charge.at(MapResult::volumetric_efficiency)), "%",
                 map.place_of(charge)}};

  const bool is_field = map.request.speed_rpm.count > 1 && map.request.load.count > 1;
  Section maps{"maps", "Results " + over_what(map), {}};
  maps.blocks.push_back(
      report::Paragraph{pressure_in_words(map.file, 1, map.request.gas, map.request.axis->varied), true});
  for (const std::string& doubt : map.doubts()) maps.blocks.push_back(report::Paragraph{doubt, true});
  for (const MapColumn& column : kMapColumnList) {
    if (is_drawn(map, column)) maps.blocks.push_back(is_field ? heat_map(map, column) : curve(map, column));
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
      std::string(map.request.best_spark
                      ? "The burn of each point starts where its torque is best, found within 0.5 deg. "
                      : "The burn starts at the same angle everywhere: the spark timing is not optimised. ") +
      (map.request.gas.excess_air_ratio > 0 ? "Fuel follows the air in each cylinder."
                                            : "Fuel burns only as far as there is air for it."));
  list.items.push_back(map.file.definition().friction.any()
                           ? "Brake torque is the indicated torque less the file's [friction]."
                           : "Brake torque is the indicated torque: the file has no [friction].");
  if (const std::string left_out = exhaust_heat_left_out(map.file.definition()); !left_out.empty())
    list.items.push_back("The exhaust manifold loses " + left_out + ".");
  method.blocks.push_back(std::move(list));
  page.sections.push_back(std::move(method));
  page.footer = "Made by crankloop from " + map.file.path() + ".";
  return page;
}

}  // namespace crankloop::program
