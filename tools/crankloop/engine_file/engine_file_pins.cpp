// place_cylinders(): positions of cylinders along the crankshaft, and shared crank pins.
#include <algorithm>
#include <limits>

#include "../files/error.hpp"
#include "engine_file_parts.hpp"

namespace crankloop::program {
namespace {

using Groups = std::vector<std::vector<int>>;  ///< cylinders, counted from 1, that share a pin

/// Throws on one pin are equal but for rounding; the same limit as in core.
constexpr double kSamePinDeg = 1e-6;

/// shared_pins as given, checked; empty where it is not given.
Groups given_groups(const SectionValues& values, const std::string& path, const Layout& layout) {
  if (!values.has("shared_pins")) return {};
  const Groups& groups = values.find("shared_pins")->groups;
  const auto wrong = [&](const std::string& message) { refuse(values, "shared_pins", message, path); };
  std::vector<int> seen;
  for (const std::vector<int>& group : groups) {
    const std::string first = std::to_string(group[0]);
    if (group.size() < 2) wrong("cylinder " + first + " stands alone; a shared pin has two or more, like 1-2,3-4");
    for (const int cylinder : group) {
      const std::string name = std::to_string(cylinder);
      if (cylinder > layout.cylinders) {
        wrong("cylinder " + name + " does not exist; there " + (layout.cylinders == 1 ? "is " : "are ") +
              cylinders_text(layout.cylinders));
      }
      if (std::find(seen.begin(), seen.end(), cylinder) != seen.end()) {
        wrong("cylinder " + name + " is named twice; each rod runs on one pin");
      }
      seen.push_back(cylinder);
      const double throw_deg = layout.throw_deg(cylinder - 1);
      const double first_deg = layout.throw_deg(group[0] - 1);
      if (apart_deg(first_deg, throw_deg) > kSamePinDeg) {
        wrong("cylinders " + first + " and " + name + " cannot share a pin; their throws (bank - firing) point to " +
              brief(full_turn(first_deg)) + " and " + brief(full_turn(throw_deg)) + " deg, and must be equal");
      }
    }
  }
  return groups;
}

/// For each cylinder the lowest cylinder on its pin, both counted from 0; it identifies the pin until pins are
/// numbered.
std::vector<std::size_t> leaders(const Groups& groups, std::size_t cylinders) {
  std::vector<std::size_t> leader(cylinders);
  for (std::size_t k = 0; k < cylinders; ++k) leader[k] = k;
  for (const std::vector<int>& group : groups) {
    const int lowest = *std::min_element(group.begin(), group.end());
    for (const int one : group) leader[static_cast<std::size_t>(one - 1)] = static_cast<std::size_t>(lowest - 1);
  }
  return leader;
}

/// Given positions, or the spacing from pin to pin in the order of the lowest cylinder on each.
void set_positions(SectionValues& values, double bore_mm, const std::vector<std::size_t>& leader,
                   const std::string& path, Layout& layout) {
  if (values.has("cylinder_positions_mm")) {
    const std::vector<double>& positions_mm = one_per_cylinder(values, "cylinder_positions_mm", path);
    for (std::size_t k = 0; k < leader.size(); ++k) layout.position_m[k] = positions_mm[k] / 1e3;
    return;
  }
  if (!values.has("cylinder_spacing_mm")) {
    Value usual;
    usual.numbers = {bore_mm * 6 / 5};
    values.derive("cylinder_spacing_mm", usual);
  }
  const double spacing_mm = values.number("cylinder_spacing_mm");
  int pins = 0;
  for (std::size_t k = 0; k < leader.size(); ++k) {
    const bool starts_a_pin = leader[k] == k;
    layout.position_m[k] = starts_a_pin ? pins * spacing_mm / 1e3 : layout.position_m[leader[k]];
    if (starts_a_pin) ++pins;
  }
}

/// Numbers the pins of given groups along the shaft, as share_pins_by_position() does where none are given.
void number_pins(const SectionValues& values, const std::vector<std::size_t>& leader, const std::string& path,
                 Layout& layout) {
  struct Pin {
    std::size_t leader;
    double begin_m;
    double end_m;
    double middle_m;  ///< mean position of its rods, by which core orders the pins
  };
  std::vector<Pin> pins;
  for (std::size_t k = 0; k < leader.size(); ++k) {
    if (leader[k] != k) continue;
    Pin pin{k, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), 0};
    int rods = 0;
    for (std::size_t other = 0; other < leader.size(); ++other) {
      if (leader[other] != k) continue;
      pin.begin_m = std::min(pin.begin_m, layout.position_m[other]);
      pin.end_m = std::max(pin.end_m, layout.position_m[other]);
      pin.middle_m += layout.position_m[other] - layout.position_m[k];  // exact if all have the same position
      ++rods;
    }
    pin.middle_m = layout.position_m[k] + pin.middle_m / rods;
    pins.push_back(pin);
  }
  std::stable_sort(pins.begin(), pins.end(), [](const Pin& a, const Pin& b) { return a.middle_m < b.middle_m; });
  for (std::size_t k = 0; k < leader.size(); ++k) {
    for (std::size_t i = 0; i < pins.size(); ++i) {
      if (pins[i].leader == leader[k]) layout.pin[k] = static_cast<std::uint8_t>(i);
      const bool between = pins[i].begin_m < layout.position_m[k] && layout.position_m[k] < pins[i].end_m;
      if (pins[i].leader != leader[k] && between) {
        refuse(values, "shared_pins",
               "cylinder " + std::to_string(k + 1) + " stands between the cylinders on cylinder " +
                   std::to_string(pins[i].leader + 1) + "'s pin; cylinders that share a pin must be neighbours",
               path);
      }
    }
  }
}

/// The groups that follow from equal positions and throws.
void derive_groups(SectionValues& values, const Layout& layout) {
  Value shared;
  for (int pin = 0; pin < layout.cylinders; ++pin) {
    std::vector<int> group;
    for (int k = 0; k < layout.cylinders; ++k) {
      if (layout.pin[static_cast<std::size_t>(k)] == pin) group.push_back(k + 1);
    }
    if (group.size() > 1) shared.groups.push_back(group);
  }
  if (!shared.groups.empty()) values.derive("shared_pins", shared);
}

}  // namespace

void place_cylinders(SectionValues& values, double bore_mm, const std::string& path, Layout& layout) {
  const Groups groups = given_groups(values, path, layout);
  const std::vector<std::size_t> leader = leaders(groups, static_cast<std::size_t>(layout.cylinders));
  set_positions(values, bore_mm, leader, path, layout);
  if (groups.empty()) {
    share_pins_by_position(layout);
    derive_groups(values, layout);
  } else {
    number_pins(values, leader, path, layout);
  }
}

}  // namespace crankloop::program
