#include "bench_report.hpp"

#include <utility>

#include "bench_report_parts.hpp"

namespace crankloop::program::bench {
namespace {

using report::Paragraph;
using report::Section;
using report::Table;

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

report::Sheet bench_sheet(const std::vector<Row>& rows, const std::string& machine) {
  report::Sheet sheet;
  sheet.title = "Run time against error";
  sheet.remarks = {machine};
  sheet.plots = precision_plots(rows);
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
