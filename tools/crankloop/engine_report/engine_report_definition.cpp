// Sections of the engine report: how its figures were computed and how accurate they are, and the whole definition.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <crankloop/tabulate/mechanism.hpp>

#include "../files/number.hpp"
#include "../files/units.hpp"
#include "../files/words.hpp"
#include "engine_report_parts.hpp"

namespace crankloop::program {
namespace {

using report::List;
using report::Paragraph;
using report::Section;
using report::Table;

// ---- Remarks in the engine file ----

/// The lines of a text file; none if it cannot be read (again).
std::vector<std::string> lines_of(const std::string& path) {
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// The comment after '#' on a line of the engine file, counted from 1; empty if there is none.
std::string remark_on(const std::vector<std::string>& lines, int line) {
  if (line < 1 || static_cast<std::size_t>(line) > lines.size()) return "";
  const std::string& text = lines[static_cast<std::size_t>(line) - 1];
  const std::size_t hash = text.find('#');
  return hash == std::string::npos ? "" : std::string(trim(text.substr(hash + 1)));
}

bool is_comment_or_blank(const std::string& line) {
  const std::string_view text = trim(line);
  return text.empty() || text.front() == '#';
}

/// Whole-line comments in a range of lines as one text, without keys that are commented out.
std::string remarks_in(const std::vector<std::string>& lines, std::size_t from, std::size_t to) {
  std::string remarks;
  for (std::size_t i = from; i < to; ++i) {
    const std::string line{trim(lines[i])};
    if (line.empty() || line.front() != '#') continue;
    const std::string text{trim(std::string_view(line).substr(1))};
    const std::string before_equals{trim(std::string_view(text).substr(0, text.find('=')))};
    if (text.find('=') != std::string::npos && before_equals.find(' ') == std::string::npos) continue;
    remarks += (remarks.empty() ? "" : " ") + text;
  }
  return remarks;
}

std::size_t next_header(const std::vector<std::string>& lines, std::size_t from) {
  while (from < lines.size() && (lines[from].empty() || trim(lines[from]).substr(0, 1) != "[")) ++from;
  return from;
}

/// The comments of a section: those between the previous section's last key and its header, and those inside it.
std::string remarks_about(const std::vector<std::string>& lines, int header_line) {
  const auto header = static_cast<std::size_t>(header_line - 1);
  if (header >= lines.size()) return "";  // the file has changed meanwhile
  std::size_t from = header;
  while (from > 0 && is_comment_or_blank(lines[from - 1])) --from;
  if (from == 0) from = header;  // the file's own
  std::size_t to = next_header(lines, header + 1);
  if (to < lines.size()) {
    while (is_comment_or_blank(lines[to - 1])) --to;
  }
  return remarks_in(lines, from, to);
}

// ---- Definition ----

/// Lines as in a complete engine file: they wrap on a phone, and can be copied.
Table section_table(const SectionValues& values, const std::vector<std::string>& lines) {
  Table table{values.title(), {{"Key and value", "", false}, {"Meaning, and the file's remark", "", false}}, {}, true};
  for (const Value& value : values.values) {
    if (!value.used) continue;
    const std::string remark = value.line == 0 ? "not in the file: default or derived" : remark_on(lines, value.line);
    table.rows.push_back({value.key->name + (" = " + format_value(value)),
                          value.key->meaning + (remark.empty() ? "" : " (" + remark + ")")});
  }
  return table;
}

Table derived_table(const ReportInput& input) {
  const EngineDefinition& d = input.exact.definition();
  const DeadCentres centres = dead_centres(d.crank);
  Table table{"Derived quantities", {{"Quantity", "", false}, {"Value", ""}, {"Unit", "", false}}, {}, false};
  const auto row = [&](const char* name, double value, const char* unit) {
    table.rows.push_back({name, number_text(value, 6), unit});
  };
  row("Rod ratio \u03BB = r / l", d.crank.rod_ratio(), "");
  row("Rod length as used", d.crank.rod_length_m * 1e3, "mm");
  row("Stroke", centres.stroke_m * 1e3, "mm");
  row("Top dead centre at", centres.tdc_rad * kDegPerRad, "deg");
  row("Bottom dead centre at", centres.bdc_rad * kDegPerRad, "deg");
  row("Piston area", bore_area_m2(d.crank) * 1e4, "cm\u00B2");
  row("Swept volume of one cylinder", swept_volume_m3(d.crank) * 1e6, "cm\u00B3");
  row("Swept volume of the engine", swept_volume_m3(d.crank) * d.layout.cylinders * 1e6, "cm\u00B3");
  row("Clearance volume", clearance_volume_m3(d.crank) * 1e6, "cm\u00B3");
  row("Mean piston speed", mean_piston_speed_m_s(d.crank, input.operation.speed_rad_s()), "m/s");
  row("Reciprocating mass m_j", d.masses.reciprocating_kg() * 1e3, "g");
  row("Rotating mass of one rod", d.masses.rod_big_end_kg * 1e3, "g");
  row("Rod's inertia correction dI", d.masses.rod_inertia_correction_kg_m2 * 1e6, "kg mm\u00B2");
  if (input.exact.diagram().heat_J() > 0)
    row("Heat per cycle and cylinder at full load", input.exact.diagram().heat_J(), "J");
  return table;
}

List assumptions(const ReportInput& input) {
  const EngineDefinition& d = input.exact.definition();
  List list;
  list.items.push_back(
      "Crank speed is constant over the cycle. A real crankshaft speeds up and slows down with the torque, and its "
      "inertia (" +
      number_text(d.masses.crank_inertia_kg_m2) + " kg m\u00B2) decides how much; no figure here depends on it.");
  list.items.push_back(
      "Piston, rod and crankshaft are rigid, without clearance or friction. Power and mean effective pressure are "
      "indicated.");
  list.items.push_back(d.masses.rod_inertia_correction_kg_m2 == 0
                           ? "The rod is two masses at its ends, without inertia correction (dI = 0)."
                           : "The rod is a rigid body: two masses at its ends and the inertia correction dI, whose "
                             "couple is in every force.");
  list.items.push_back(breathes(input)
                           ? "All cylinders are alike; they differ only by the manifold pressure while their valves "
                             "are open. Curves are of cylinder 1."
                           : "All cylinders are alike: they have the same pressure at the same angle of their cycles.");
  if (has_gas(input))
    list.items.push_back("The pressure below the piston is constant, the crankcase pressure of " +
                         number_text(d.pressure.crankcase_Pa * kKilo) + " kPa.");
  if (input.file.section("crank").has("rod_ratio")) {
    const SectionValues& crank = input.file.section("crank");
    list.items.push_back("rod_ratio = " + shortest(crank.number("rod_ratio")) +
                         " is used for \u03BB, not stroke / 2 / rod_length_mm = " +
                         number_text(crank.number("stroke_mm") / 2 / crank.number("rod_length_mm"), 6) +
                         ": the rod is taken as " + number_text(d.crank.rod_length_m * 1e3, 7) + " mm long.");
  }
  if (d.crank.pin_offset_m != 0) {
    list.items.push_back(
        "With the pin offset, angle 0 (throw parallel to the cylinder axis) is not top dead centre: that is at " +
        number_text(dead_centres(d.crank).tdc_rad * kDegPerRad) + " deg.");
  }
  return list;
}

// ---- Accuracy ----

std::string pretty(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  name[0] = static_cast<char>(name[0] - 'a' + 'A');
  return name;
}

std::string percent_of_tick(const ReportInput& input) {
  return report::format_number(100 * input.wall_time_per_tick_ns / (input.operation.tick_s * 1e9), 2) + " %";
}

Table deviation_table(const ReportInput& input) {
  Table table{"Fixed-step loop against exact equations: largest differences",
              {{"Quantity", "", false},
               {"Unit", "", false},
               {"Difference", ""},
               {"at", "deg"},
               {"Peak value", ""},
               {"Difference / peak", ""}},
              {},
              false};
  const auto row = [&](const std::string& name, const char* unit, const Deviation& d, double per_si) {
    table.rows.push_back({name, pretty_unit(unit), report::format_number(d.largest * per_si, 2),
                          report::format_fixed(d.at_deg, 1), report::format_number(d.peak * per_si, 4),
                          report::format_number(d.ratio(), 2)});
  };
  row("Torque of the engine", "Nm", input.accuracy.torque, 1);
  for (const QuantityKind& kind : kQuantityKinds) {
    if (kind.quantity == Quantity::pin_radial || kind.quantity == Quantity::pin_tangential)
      continue;  // in the pin load
    if (!has_gas(input) && (kind.quantity == Quantity::pressure || kind.quantity == Quantity::gas_force)) continue;
    row(kind.quantity == Quantity::torque ? "Torque of one cylinder" : pretty(kind.name), kind.unit,
        input.accuracy.of[index_of(kind.quantity)], kind.per_si);
  }
  return table;
}

/// The net IMEP that the report shows, beside the same from pressure and volume.
std::string imep_check(const ReportInput& input, int digits, const char* loop) {
  return "Net IMEP is " + number_text(input.figures.net_mep_Pa * kKilo, digits) +
         " kPa by the loop's torque, as shown above. As a check, the integral of p dV " + loop + " gives " +
         number_text(input.summary.net_mep_Pa * kKilo, digits) + " kPa.";
}

}  // namespace

report::Section accuracy_section(const ReportInput& input) {
  const RunFigures& f = input.figures;
  Section section{"made", "Method", {}};
  section.blocks.push_back(Paragraph{"Command: " + input.command_line});
  List list;
  list.items.push_back(
      (has_gas(input) ? std::string("Mean torque, power and IMEP come") : std::string("The close-up of torque comes")) +
      " from the fixed-step loop that firmware would run: " + input.real + ", tick " +
      number_text(input.operation.tick_s * 1e6) + " \u00B5s (" + number_text(f.deg_per_tick) + " deg), " +
      std::to_string(f.ticks) + " ticks recorded over " + std::to_string(f.cycles) +
      (f.cycles == 1 ? " cycle" : " cycles") + " after " + std::to_string(f.settling_ticks) + " to settle. " +
      (f.faulty_ticks == 0
           ? "No tick raised a fault."
           : std::to_string(f.faulty_ticks) + " ticks raised a fault: " + crankloop::describe(f.faults).text + "."));
  list.items.push_back("Curves, their extremes and the tables come from the same loop at a tick of " +
                       number_text(input.trace.tick_s * 1e6) + " \u00B5s, one point every " +
                       number_text(input.trace.spacing_deg) + " deg of a cycle.");
  list.items.push_back(
      "Where a cycle is not a whole number of ticks, only the part of the last tick inside the cycle counts.");
  if (breathes(input)) {
    list.items.push_back(imep_check(input, 5, "over cylinder 1's curve"));
  } else if (has_gas(input)) {
    list.items.push_back(imep_check(input, 7, "of the diagram"));
    list.items.push_back("The pressure table has " + std::to_string(f.tables.gas_segments) +
                         " segments and is within " + number_text(f.tables.pressure_error_Pa * kKilo, 2) +
                         " kPa of the diagram.");
  }
  list.items.push_back("A tick takes " + number_text(input.wall_time_per_tick_ns, 3) +
                       " ns on the machine that wrote this page (" + percent_of_tick(input) +
                       " of the tick), with every output of every cylinder.");
  if (breathes(input)) {
    list.items.push_back("Free forces' largest values are computed in double from the equations, without tables.");
    section.blocks.push_back(std::move(list));
    return section;
  }
  list.items.push_back(
      "Harmonics, free forces' largest values and the exact figures to compare with are computed in double from the "
      "equations, without tables.");
  section.blocks.push_back(std::move(list));
  section.blocks.push_back(deviation_table(input));
  section.blocks.push_back(
      Paragraph{"Over " + std::to_string(input.accuracy.angles) +
                " angles of a cycle and all cylinders. Peak value: largest magnitude of the exact quantity."});
  return section;
}

report::Section definition_section(const ReportInput& input) {
  Section section{"definition", "Definition and assumptions", {}};
  section.blocks.push_back(assumptions(input));
  const std::vector<std::string> lines = lines_of(input.file.path());
  const std::string about = remarks_in(lines, 0, next_header(lines, 0));
  if (!about.empty()) section.blocks.push_back(Paragraph{"From the engine file: " + about});
  for (const SectionValues& values : input.file.sections()) {
    const std::string remarks = values.line > 0 ? remarks_about(lines, values.line) : "";
    if (!remarks.empty()) section.blocks.push_back(Paragraph{values.title() + ": " + remarks});
    section.blocks.push_back(section_table(values, lines));
  }
  section.blocks.push_back(derived_table(input));
  return section;
}

}  // namespace crankloop::program
