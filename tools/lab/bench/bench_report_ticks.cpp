// The benchmark's tables and plots of whole ticks.
#include <cstdio>
#include <cstdlib>
#include <map>

#include "bench_report_parts.hpp"
#include "crankloop/files/number.hpp"
#include "groups.hpp"

namespace crankloop::program::bench {
namespace {

using report::Paragraph;
using report::Plot;
using report::plot_of;
using report::Section;
using report::Series;
using report::Table;

constexpr const char* kFourCylinders = "Four cylinders, 6000 rpm, 20 \u00B5s";

/// "8 valves" of "4 cylinders, 8 valves, 6000 rpm, 20 us".
std::string valves_text(const Row& row) {
  const std::size_t from = row.setting.find(", ") + 2;
  return row.setting.substr(from, row.setting.find(", ", from) - from);
}

/// Mean and, if measured, the distribution of each row.
Table distribution_table(const char* caption, const char* engine, std::string (*engine_text)(const Row&),
                         const Rows& ticks) {
  Table table{caption,
              {{"Contestant", "", false},
               {"Real", "", false},
               {engine, "", false},
               {"Mean", "ns"},
               {"Median", "ns"},
               {"99.9 %", "ns"},
               {"Worst", "ns"},
               {"Error", "", false}},
              {},
              false};
  for (std::size_t i = 0; i + 3 < ticks.size(); i += 4) {
    const Row& mean = ticks[i];
    table.rows.push_back({mean.contestant, mean.real, engine_text(mean), time_text(mean),
                          digits(ticks[i + 1].ns_median), digits(ticks[i + 2].ns_median),
                          digits(ticks[i + 3].ns_median), error_text(mean)});
  }
  return table;
}

struct EngineSetting {
  int cylinders = 0;
  int valves = 0;
  double rpm = 0;
  double tick_us = 0;
};
EngineSetting parsed(const std::string& setting) {
  EngineSetting s;
  std::sscanf(setting.c_str(), "%d %*[^,], %d %*[^,], %lf rpm, %lf us", &s.cylinders, &s.valves, &s.rpm, &s.tick_us);
  return s;
}

Plot cylinders_plot(const Rows& rows, const char* which, double rpm) {
  Plot plot =
      plot_of((*which == '\0' ? std::string("Mean tick") : std::string("Worst tick")) + " at " + brief(rpm) + " rpm",
              axis("Cylinders", "", false), axis("Time", "ns", false));
  plot.y.include_zero = true;
  std::map<int, Series> by_valves;
  for (const Row& row : rows) {
    const EngineSetting s = parsed(row.setting);
    if (row.contestant != std::string("library, any engine") + which || s.rpm != rpm) continue;
    Series& line = by_valves[s.valves / s.cylinders];
    line.x.push_back(s.cylinders);
    line.y.push_back(row.ns_median);
  }
  for (auto& [valves, line] : by_valves) {
    line.name = valves == 0 ? "no valves" : std::to_string(valves) + " each";
    line.style.draw = report::Draw::line_and_points;
    plot.series.push_back(std::move(line));
  }
  return plot;
}

}  // namespace

Section tick_section(const Rows& rows) {
  Section section{"ticks", "Whole ticks", {}};
  section.blocks.push_back(
      Paragraph{"Motion of every piston, torque of given pressures, motion of every elastic valve. The plain engines "
                "give the same outputs by one textbook "
                "step per tick and valve; \"usual flags\" are those without the library's promise of equal bits. "
                "Median, 99.9 % and worst are over the ticks of a cycle, each "
                "timed by itself many times, which keeps the processor from overlapping it with its neighbours: they "
                "exceed the mean also where all ticks are alike."});
  section.blocks.push_back(distribution_table(kFourCylinders, "Valves", valves_text, where(rows, [](const Row& r) {
                                                return r.group == "tick" &&
                                                       !starts_with(r.contestant, "library, any engine");
                                              })));
  const Rows any =
      where(rows, [](const Row& r) { return r.group == "tick" && starts_with(r.contestant, "library, any engine"); });
  for (const double rpm : {kIdle_rpm, kRated_rpm, kRedline_rpm}) {
    section.blocks.push_back(cylinders_plot(any, "", rpm));
    section.blocks.push_back(cylinders_plot(any, ", worst tick", rpm));
  }
  Table all = distribution_table(
      "Any number of cylinders and valves, as the figures above show it", "Engine",
      [](const Row& row) { return with_signs(row.setting); }, any);
  all.folded = true;
  section.blocks.push_back(std::move(all));
  return section;
}

Section growth_section(const Rows& rows) {
  Section section{"growth", "Longer ticks", {}};
  Plot plot =
      plot_of("Time of a tick over its length, 6000 rpm", axis("Tick", "\u00B5s", true), axis("Time", "ns", true));
  for (const char* name : {"located RK4", "located exponential", "one valve held by its train"}) {
    Series line;
    line.name = *name == 'o' ? name : std::string("8 valves, ") + name;
    line.style.draw = report::Draw::line_and_points;
    for (const Row& row : rows) {
      if (row.group != "growth" || row.contestant != name) continue;
      const std::size_t comma = row.setting.rfind(", ");
      line.x.push_back(std::strtod(row.setting.c_str() + comma + 2, nullptr));
      line.y.push_back(row.ns_median);
    }
    plot.series.push_back(std::move(line));
  }
  plot.caption = "A tick takes whole steps where no contact changes, and fine ones where one does.";
  section.blocks.push_back(std::move(plot));
  return section;
}

Section skip_section(const Rows& rows) {
  Section section{"skips", "What is left out costs nothing", {}};
  Table table{kFourCylinders + std::string(", float"),
              {{"Scene", "", false}, {"Valves", "", false}, {"Tick", "ns"}, {"Error", "", false}},
              {},
              false};
  for (const Row& row : rows) {
    if (row.group != "skips") continue;
    table.rows.push_back({row.contestant, valves_text(row), time_text(row), error_text(row)});
  }
  section.blocks.push_back(std::move(table));
  return section;
}

}  // namespace crankloop::program::bench
