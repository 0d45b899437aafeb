#include "bench_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>

#include "crankloop/files/number.hpp"
#include "groups.hpp"

namespace crankloop::program::bench {
namespace {

using report::Axis;
using report::Paragraph;
using report::Plot;
using report::plot_of;
using report::Section;
using report::Series;
using report::Table;

Axis axis(const char* title, const char* unit, bool logarithmic) {
  Axis one;
  one.title = title;
  one.unit = unit;
  one.logarithmic = logarithmic;
  return one;
}

std::string digits(double value, int count = 3) { return report::format_number(value, count); }

/// Rows are in ASCII; a page uses the typographic signs.
std::string with_signs(std::string text) {
  const std::pair<const char*, const char*> signs[] = {{" us", " \u00B5s"}, {" um", " \u00B5m"}, {"^2", "\u00B2"}};
  for (const auto& [plain, sign] : signs) {
    const std::string from = plain;
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1))
      text.replace(at, from.size(), sign);
  }
  return text;
}

std::string error_text(const Row& row) { return with_signs(digits(row.error) + " " + row.error_unit); }

bool starts_with(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

using Rows = std::vector<Row>;
Rows where(const Rows& rows, const std::function<bool(const Row&)>& wanted) {
  Rows some;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(some), wanted);
  return some;
}

// ---- work and precision ---------------------------------------------------------------------------------------------

constexpr const char* kLibm = "libm";
constexpr const char* kHigherDegrees = "degree 3 to 5";
/// False for a row of several methods, whose points are not joined by a line.
bool is_one_method(const std::string& name) { return name != kLibm && name != kHigherDegrees; }

/// One line per method in the order of its settings, and the front. `line_of` names the line of a row, "" leaves it
/// out.
Plot work_precision(const std::string& title, const Rows& rows, const Axis& time, double per_ns, const Axis& error,
                    const std::function<std::string(const Row&)>& line_of) {
  Plot plot = plot_of(title, time, error);
  std::vector<Work> all;
  for (const Row& row : rows) {
    const std::string name = line_of(row);
    if (name.empty() || !(row.error > 0)) continue;
    auto line = std::find_if(plot.series.begin(), plot.series.end(), [&](const Series& s) { return s.name == name; });
    if (line == plot.series.end()) {
      line = plot.series.insert(line, Series{});
      line->name = name;
      line->style.draw = is_one_method(name) ? report::Draw::line_and_points : report::Draw::points;
    }
    line->x.push_back(row.ns_median * per_ns);
    line->y.push_back(row.error);
    all.push_back({row.ns_median * per_ns, row.error});
  }
  Series front;
  front.name = "Pareto front";
  front.style.dashed = true;
  for (const Work& best : pareto_front(all)) {
    front.x.push_back(best.time);
    front.y.push_back(best.error);
  }
  plot.series.push_back(std::move(front));
  return plot;
}

std::string polynomial_line(const Row& row) {
  if (starts_with(row.contestant, "libm")) return kLibm;
  if (row.contestant == "cubic" || row.contestant == "quartic" || row.contestant == "quintic") return kHigherDegrees;
  return row.contestant;
}

Plot kinematics_plot(const Rows& rows, const char* real) {
  Plot plot = work_precision(std::string("Piston motion in ") + real,
                             where(rows, [&](const Row& r) { return r.group == "kinematics" && r.real == real; }),
                             axis("Time", "ns", true), 1, axis("Largest error", "", true), polynomial_line);
  plot.caption = *real == 'd' ? "libm: by asin, and by sin, cos and sqrt." : "libm: sinf, cosf, sqrtf.";
  return plot;
}

Section kinematics_section(const Rows& rows) {
  Section section{"kinematics", "Displacement, velocity, acceleration", {}};
  section.blocks.push_back(
      Paragraph{"One evaluation of all three at a random crank angle. The error is the largest of the three, relative "
                "to r, r w and r w\u00B2. A line joins "
                "the settings of a method: widths of the table's segments. Down and left is better; the dashed line is "
                "the Pareto front, the settings that "
                "no other beats in both."});
  for (const char* real : {"float", "double"}) section.blocks.push_back(kinematics_plot(rows, real));
  return section;
}

/// Each accuracy class has its own line. Other solvers are in the table of all rows.
std::string method_line(const Row& row) {
  const bool peer = starts_with(row.contestant, "odeint") || starts_with(row.contestant, "GSL");
  return peer || row.setting.find("class") != std::string::npos ? std::string() : row.contestant;
}

struct ValveSpeed {
  double rpm;
  const char* what;
};
constexpr ValveSpeed kValveSpeeds[] = {
    {kSmooth_rpm, "gentle contacts"}, {kSwitching_rpm, "hard contacts"}, {kBouncing_rpm, "float and bounce"}};

Plot valve_plot(const Rows& rows, const ValveSpeed& speed, const char* real) {
  const std::string start = brief(speed.rpm) + " rpm, ";
  return work_precision(
      brief(speed.rpm) + " rpm, " + speed.what + ", in " + real,
      where(rows, [&](const Row& r) { return r.group == "valve" && r.real == real && starts_with(r.setting, start); }),
      axis("Time of a cam cycle", "\u00B5s", true), 1e-3, axis("Largest error of lift", "\u00B5m", true), method_line);
}

Section valve_section(const Rows& rows) {
  Section section{"valve", "One elastic valve", {}};
  section.blocks.push_back(
      Paragraph{"A whole turn of the cam, the look-up of its lift included, against the true motion. The error is the "
                "largest of the lift, the worst of six shifts "
                "of the ticks against the cam. A line joins a method's steps or ticks, from 1 \u00B5s on the right to "
                "the last that is stable. The library's finest "
                "steps do not grow with its tick: its longest are as exact as its shortest."});
  for (const ValveSpeed& speed : kValveSpeeds) {
    for (const char* real : {"float", "double"}) section.blocks.push_back(valve_plot(rows, speed, real));
  }
  return section;
}

// ---- whole ticks ----------------------------------------------------------------------------------------------------

std::string time_text(const Row& row) { return digits(row.ns_median) + " \u00B1 " + digits(row.ns_spread / 2, 2); }

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

// ---- ratios and rows ------------------------------------------------------------------------------------------------

Section ratio_section(const Rows& rows) {
  Section section{"ratios", "Ratios", {}};
  Table table{"In this process, float",
              {{"Ratio", "", false}, {"", ""}, {"Setting", "", false}, {"Error of the library", "", false}},
              {},
              false};
  for (const Row& row : rows) {
    if (row.ratio) table.rows.push_back({row.contestant, digits(*row.ratio), with_signs(row.setting), error_text(row)});
  }
  section.blocks.push_back(std::move(table));
  return section;
}

Table all_rows(const Rows& rows, const char* group, const char* caption) {
  Table table{
      caption,
      {{"Contestant", "", false}, {"Real", "", false}, {"Setting", "", false}, {"Time", "ns"}, {"Error", "", false}},
      {},
      true};
  for (const Row& row : rows) {
    if (row.group == group)
      table.rows.push_back({row.contestant, row.real, with_signs(row.setting), time_text(row), error_text(row)});
  }
  return table;
}

}  // namespace

std::vector<Work> pareto_front(std::vector<Work> points) {
  std::sort(points.begin(), points.end(),
            [](const Work& a, const Work& b) { return a.time < b.time || (a.time == b.time && a.error < b.error); });
  std::vector<Work> front;
  for (const Work& point : points) {
    if (front.empty() || point.error < front.back().error) front.push_back(point);
  }
  return front;
}

report::Sheet bench_sheet(const std::vector<Row>& rows, const std::string& machine) {
  report::Sheet sheet;
  sheet.title = "Run time against error";
  sheet.remarks = {machine};
  for (const char* real : {"float", "double"}) sheet.plots.push_back(kinematics_plot(rows, real));
  for (const ValveSpeed& speed : kValveSpeeds) {
    for (const char* real : {"float", "double"}) sheet.plots.push_back(valve_plot(rows, speed, real));
  }
  return sheet;
}

report::Page bench_page(const std::vector<Row>& rows, const std::string& machine, const std::string& command_line) {
  report::Page page;
  page.title = "Run time against error";
  page.subtitle = "crankloop's tick, other methods and plain code, in one process on " + machine + ".";
  const char* four_cylinders = "4 cylinders, 8 valves, 6000 rpm, 20 us";
  const Row& eight = find(rows, "tick", "library", "float", four_cylinders);
  const Row& plain = find(rows, "tick", "linear tables + textbook RK4", "float", four_cylinders);
  const Row& motion = find(rows, "kinematics", "library", "float", "1 deg");
  const Row& valve = find(rows, "valve", "located exponential", "float", "12000 rpm, 10 us");
  page.facts = {{"Four cylinders, 8 elastic valves", digits(eight.ns_median), "ns",
                 "a tick of 20 \u00B5s; lift within " + digits(eight.error) + " \u00B5m"},
                {"Piston motion", digits(motion.ns_median), "ns", "x, v and a; within " + digits(motion.error)},
                {"A bouncing valve's cycle", digits(valve.ns_median * 1e-3), "\u00B5s",
                 "lift within " + digits(valve.error) + " \u00B5m"},
                {"The same tick in plain code", digits(plain.ns_median), "ns",
                 "linear tables, textbook Runge-Kutta; lift within " + digits(plain.error) + " \u00B5m"}};
  page.sections = {kinematics_section(rows), valve_section(rows), tick_section(rows), growth_section(rows),
                   skip_section(rows)};
  Section all{"rows", "All rows", {}};
  all.blocks.push_back(Paragraph{
      "Command: " + command_line +
      ". Medians over rounds in which all contestants took turns; \u00B1 half the distance between the quartiles. "
      "A time without a number is one that was not measured."});
  all.blocks.push_back(all_rows(rows, "kinematics", "Piston motion"));
  all.blocks.push_back(all_rows(rows, "valve", "One elastic valve"));
  all.blocks.push_back(all_rows(rows, "growth", "Longer ticks"));
  page.sections.push_back(std::move(all));
  page.sections.push_back(ratio_section(rows));
  page.footer = "Made by crankloop bench on " + machine + ".";
  return page;
}

}  // namespace crankloop::program::bench
