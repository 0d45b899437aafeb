// Section of the engine report: the crankshaft, its throws and banks seen along the axis, and the firing order.
#include <cmath>
#include <map>
#include <utility>

#include "../engine_file/crankshaft_words.hpp"
#include "engine_report_parts.hpp"

namespace crankloop::program {
namespace {

using report::List;
using report::Paragraph;
using report::Plot;
using report::Section;

constexpr double kBankLength = 1.6;  ///< of a throw's

/// Coordinates from the shaft's axis outward, up positive, rotation to the right.
report::Series ray(const std::string& name, double direction_deg, double from, double to) {
  const double direction_rad = direction_deg / kDegPerRad;
  report::Series series;
  series.name = name;
  series.x = {from * std::sin(direction_rad), to * std::sin(direction_rad)};
  series.y = {from * std::cos(direction_rad), to * std::cos(direction_rad)};
  return series;
}

Plot end_view(const Layout& layout) {
  Plot plot = plot_of("Throws and banks at engine angle 0",
                      axis_of("A quarter turn on from up, with the rotation", "r"), axis_of("Up", "r"));
  const auto add = [&plot](report::Series series, int colour, const std::string& label) {
    series.style.colour = colour;
    series.style.dashed = colour != 1;
    plot.markers.push_back({series.x.back(), series.y.back(), label, plot.series.size()});
    plot.series.push_back(std::move(series));
  };
  std::map<double, std::string> throws;  // throws and banks in one direction are one line
  for (const CrankThrow& one : throws_of(layout)) {
    for (const int cylinder : one.cylinders) {
      std::string& label = throws[one.direction_deg];
      label += (label.empty() ? "" : "+") + std::to_string(cylinder);
    }
  }
  for (const auto& [direction_deg, label] : throws) add(ray("", direction_deg, 0, 1), 1, "throw " + label);
  std::map<double, std::string> banks;
  for (int k = 0; k < layout.cylinders; ++k) {
    std::string& label = banks[layout.bank_deg[static_cast<std::size_t>(k)]];
    label += (label.empty() ? "" : "+") + std::to_string(k + 1);
  }
  for (const auto& [direction_deg, label] : banks) add(ray("", direction_deg, 0, kBankLength), 2, "bank " + label);
  plot.caption = "Looking along the shaft; lengths in crank radii. Numbers are cylinders.";
  use_equal_scales(plot);
  return plot;
}

Plot firing_order(const Layout& layout) {
  Plot plot = plot_of("Firing order", crank_axis(), axis_of("Cylinder", ""));
  plot.y.tick_step = 1;
  plot.y.range = report::Range{0, layout.cylinders + 1.0};
  report::Series fires;
  fires.style.draw = report::Draw::points;
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    fires.x.push_back(layout.firing_deg[k]);
    fires.y.push_back(static_cast<double>(k) + 1);
  }
  plot.series = {std::move(fires)};
  plot.bands = firings(layout);
  plot.caption = "A dot where a cylinder's own angle is 0 at its firing.";
  return plot;
}

}  // namespace

report::Section crankshaft_section(const ReportInput& input) {
  const Layout& layout = input.exact.definition().layout;
  Section section{"crankshaft", "Crankshaft and firing order", {}};
  std::vector<std::string> words = throws_in_words(layout);
  section.blocks.push_back(Paragraph{words.front()});
  section.blocks.push_back(List{{words.begin() + 1, words.end()}});
  section.blocks.push_back(Paragraph{firing_in_words(layout)});
  if (const std::string hint = shared_pins_hint(layout); !hint.empty()) section.blocks.push_back(Paragraph{hint, true});
  section.blocks.push_back(end_view(layout));
  section.blocks.push_back(firing_order(layout));
  return section;
}

}  // namespace crankloop::program
