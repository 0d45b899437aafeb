#include "against.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../../loops/run_valves.hpp"

namespace crankloop::program {
namespace {

using report::Plot;
using report::Section;

const Figure* find(const Summary& summary, const std::string& name) {
  for (const Figure& figure : summary.figures()) {
    if (figure.name == name) return &figure;
  }
  return nullptr;
}

constexpr const char* kAbsent = "absent";

std::string text_of(const Figure* figure) {
  if (figure == nullptr) return kAbsent;
  return figure->number ? brief(*figure->number) : figure->word;
}

/// "+3.2 %", of the second over the first; empty where that says nothing: of places, words and nothing.
std::string difference(const Figure& first, const Figure* second) {
  if (second == nullptr || !first.number || !second->number || first.unit == "deg" || *first.number == 0) return "";
  const double percent = 100 * (*second->number / *first.number - 1);
  if (!std::isfinite(percent)) return "";
  if (percent == 0) return "equal";
  char text[40];
  std::snprintf(text, sizeof text, "%+.3g %%", percent);
  return text;
}

/// As a page writes it: "m/s²".
std::string page_unit(std::string unit) {
  const std::size_t power = unit.find('^');
  if (power != std::string::npos) unit.replace(power, 2, unit[power + 1] == '2' ? "\u00B2" : "\u00B3");
  return unit;
}

/// Names of the figures, the first's with those that only the second has behind.
std::vector<Figure> all_figures(const Side& first, const Side& second) {
  std::vector<Figure> all = first.figures.figures();
  for (const Figure& figure : second.figures.figures()) {
    if (find(first.figures, figure.name) == nullptr) all.push_back({figure.name, figure.unit, {}, kAbsent});
  }
  return all;
}

/// Where both files have one name, their paths tell them apart.
std::string name_of(const Side& side, const Side& other) {
  return side.file.name() != other.file.name() ? side.file.name() : side.file.path();
}

/// A curve of each over the angle of cylinder 1's cycle.
template <class Values>
Plot two_curves(const Side& first, const Side& second, const std::string& title, const std::string& unit,
                const Values& values) {
  Plot plot = report::plot_of(title, report::axis_of("Crank angle", "deg"), report::axis_of(title, page_unit(unit)));
  plot.x.tick_step = 90;
  plot.x.range = report::Range{0, 720};
  for (const Side* side : {&first, &second}) {
    report::Series& series = plot.series.emplace_back();
    series.name = name_of(*side, side == &first ? second : first);
    series.style.dashed = side == &second;
    series.x = side->trace.crank_deg;
    series.y = values(*side);
  }
  return plot;
}

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

Section curves_section(const Side& first, const Side& second) {
  Section section{"cycle", "Over the cycle", {}};
  section.blocks.push_back(
      two_curves(first, second, "Engine torque", "Nm", [](const Side& s) { return s.trace.torque_Nm; }));
  const struct {
    Quantity quantity;
    const char* title;
  } shown[] = {{Quantity::pressure, "Pressure in cylinder 1"},
               {Quantity::acceleration, "Piston acceleration"},
               {Quantity::side_force, "Side force"},
               {Quantity::crank_pin_load, "Crank pin load"}};
  for (const auto& one : shown) {
    const QuantityKind& kind = kQuantityKinds[index_of(one.quantity)];
    section.blocks.push_back(two_curves(first, second, one.title, kind.unit,
                                        [&](const Side& s) { return scaled(s.trace[one.quantity], kind.per_si); }));
  }
  const std::vector<std::string> trains = names_of_trains(first.file), others = names_of_trains(second.file);
  for (std::size_t t = 0; t < trains.size(); ++t) {
    const auto same = std::find(others.begin(), others.end(), trains[t]);
    if (same == others.end()) continue;
    const auto of_second = static_cast<std::size_t>(same - others.begin());
    for (const ValveQuantity quantity : {ValveQuantity::lift, ValveQuantity::train_force}) {
      const ValveQuantityKind& kind = kValveQuantityKinds[index_of(quantity)];
      const char* title = quantity == ValveQuantity::lift ? "Valve lift, " : "Force between train and valve, ";
      section.blocks.push_back(two_curves(first, second, title + trains[t], kind.unit, [&](const Side& s) {
        return scaled(s.trace.valves[&s == &first ? t : of_second][quantity], kind.per_si);
      }));
    }
  }
  return section;
}

Section figures_section(const Side& first, const Side& second) {
  Section section{"figures", "Figures", {}};
  report::Table table{
      "",
      {{"Figure", "", false}, {name_of(first, second), ""}, {name_of(second, first), ""}, {"Difference", ""}},
      {},
      false};
  for (const Figure& figure : all_figures(first, second)) {
    const Figure* other = find(second.figures, figure.name);
    std::string title = figure.name;
    std::replace(title.begin(), title.end(), '_', ' ');
    if (!figure.unit.empty()) title += ", " + page_unit(figure.unit);
    const auto cell = [](const std::string& text) {
      return text == kAbsent ? "\u2013" : text[0] == '-' ? "\u2212" + text.substr(1) : text;
    };
    table.rows.push_back({title, cell(text_of(&figure)), cell(text_of(other)), cell(difference(figure, other))});
  }
  section.blocks.push_back(std::move(table));
  return section;
}

}  // namespace

Summary side_by_side(const Side& first, const Side& second) {
  Summary s;
  s.remark(first.file.name() + ", " + first.file.path() + ", against " + second.file.name() + ", " +
           second.file.path());
  s.remark("each figure is the first's, with the second's behind it");
  for (const Figure& figure : all_figures(first, second)) {
    const Figure* other = find(second.figures, figure.name);
    const std::string more = difference(figure, other);
    const std::string remark = "against " + text_of(other) + (more.empty() ? "" : ", " + more);
    if (figure.number) {
      s.line(figure.name, *figure.number, figure.unit, remark);
    } else {
      s.line(figure.name, figure.word, "", remark);
    }
  }
  return s;
}

report::Page against_page(const Side& first, const Side& second, const std::string& command_line) {
  report::Page page;
  page.title = name_of(first, second) + " against " + name_of(second, first);
  page.subtitle = "Engine files " + first.file.path() + " and " + second.file.path() + ".";
  const struct {
    const char *name, *title;
  } facts[] = {
      {"speed", "Speed"},      {"mean_torque", "Mean torque"},    {"power", "Power"},
      {"net_mep", "Net IMEP"}, {"max_pressure", "Peak pressure"}, {"volumetric_efficiency", "Volumetric efficiency"}};
  for (const auto& fact : facts) {
    const Figure* figure = find(first.figures, fact.name);
    if (figure == nullptr || !figure->number) continue;
    const Figure* other = find(second.figures, fact.name);
    const bool has_number = other != nullptr && other->number;
    page.facts.push_back({fact.title, report::number_text(*figure->number, 4), figure->unit,
                          "against " + (has_number ? report::number_text(*other->number, 4) : text_of(other))});
  }
  page.sections = {curves_section(first, second), figures_section(first, second),
                   Section{"method", "Method", {report::Paragraph{"Command: " + command_line}}}};
  page.footer = "Made by crankloop from " + first.file.path() + " and " + second.file.path() + ".";
  return page;
}

}  // namespace crankloop::program
