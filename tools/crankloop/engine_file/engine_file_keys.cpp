#include "engine_file_keys.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <type_traits>

#include <crankloop/define/engine_definition.hpp>

#include "../files/words.hpp"
#include "engine_file_key_list.hpp"

namespace crankloop::program {
namespace {

using list::kRows;
using list::kSections;

/// In few steps: a compiler's constant expressions have a limit of them.
constexpr bool is_same(const char* a, const char* b) {
  for (; *a == *b; ++a, ++b)
    if (*a == '\0') return true;
  return false;
}

/// Looks for a field by its name.
struct Find {
  const char* name;
  bool found = false;
  Range range{};

  template <class Field>
  constexpr void operator()(const ListedField& here, const Field& field) {
    if constexpr (std::is_array_v<Field>) {
      (*this)(here, field[0]);
    } else if constexpr (kHasFields<Field>) {
      Field::each_field(*this, field);
    } else if (is_same(name, here.name)) {
      found = true;
      range = here.range;
    }
  }
};
constexpr EngineDefinition kExample{};

/// The range of the key's field, in the key's unit. Throws, which does not compile, where there is no such field.
constexpr Range range_of_field(const Key& key) {
  Find find{key.field};
  EngineDefinition::each_field(find, kExample);
  Gas::each_field(find, kExample.gas);
  CamContact::each_field(find, kExample.contacts[0]);
  Misfire::each_field(find, kExample.misfires[0]);
  WheelFault::each_field(find, kExample.wheel_faults[0]);
  Reluctor::each_field(find, kExample.reluctor);
  LambdaSensor::each_field(find, kExample.lambda_sensor);
  SensorFault::each_field(find, kExample.sensor_faults[0]);
  if (!find.found) throw "a key is that of a field that the definition does not have";
  const auto in_file = [&key](double si) { return si * key.unit.over / key.unit.times; };
  return {in_file(find.range.least), in_file(find.range.most), find.range.without_least, find.range.without_most};
}
constexpr auto keys_with_ranges() {
  std::array<Key, std::size(kRows)> keys{};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    Key& key = keys[i] = kRows[i];
    if (key.field[0] == '\0') continue;
    const Range range = range_of_field(key);
    if (key.range.most > range.most && key.range.least < range.least) key.range = range;
    if (key.range.most > range.most || key.range.least < range.least) throw "a key takes more than its field does";
  }
  return keys;
}
constexpr auto kKeys = keys_with_ranges();

/// Fields that follow from a key, which is none of them by itself.
struct Follows {
  const char* field;
  const char* section;
  const char* key;
};
constexpr Follows kFollows[] = {
    {"crank.crank_radius_m", "crank", "stroke_mm"},
    {"crank.max_speed_rad_s", "engine", "max_rpm"},
    {"masses.rod_inertia_correction_kg_m2", "masses", "rod_inertia_kg_mm2"},
    {"layout.firing_deg", "layout", "firing_angles_deg"},
    {"layout.bank_deg", "layout", "bank_angles_deg"},
    {"layout.position_m", "layout", "cylinder_positions_mm"},
    {"layout.pin", "layout", "shared_pins"},
    {"pressure.source", "pressure", "source"},
    {"pressure.point_count", "pressure", "file"},
    {"pressure.points", "pressure", "file"},
    {"cam.source", "cam", "source"},
    {"cam.full_lift_deg", "cam", "full_lift_at_crank_deg"},
    {"cam.exponent_count", "cam", "exponents"},
    {"cam.exponents", "cam", "exponents"},
    {"cam.point_count", "cam", "file"},
    {"cam.points", "cam", "file"},
    {"rocker.kind", "rocker", "ratio"},
    {"rocker.cam_turns", "rocker", "cam_turns"},
    {"misfire.pattern", "misfire", "every"},
    {"misfire.cycle_count", "misfire", "cycles"},
    {"misfire.cycles", "misfire", "cycles"},
    {"fault.wheel", "fault", "trigger"},
    {"fault.inverted", "fault", "inverted"},
    {"fault.stuck", "fault", "stuck"},
    {"reluctor.wheel", "reluctor", "trigger"},
    {"reluctor.reversed", "reluctor", "reversed"},
    {"sensor_fault.sensor", "sensor_fault", "sensor"},
    {"sensor_fault.wire", "sensor_fault", "wire"},
    {"lambda_sensor.in_use", "lambda_sensor", "pipe_cm3"},
    {"gas.throttle_count", "gas", "throttle_curve"},
    {"gas.throttle_ratio", "gas", "throttle_curve"},
    {"gas.throttle_area_ratio", "gas", "throttle_curve"},
    {"gas.ambient_K", "gas", "ambient_C"},
    {"gas.exhaust_K", "gas", "exhaust_C"},
    {"gas.wall_K", "gas", "wall_C"},
    {"runner.length_m", "gas", "intake_runner_mm"},
    {"runner.diameter_m", "gas", "intake_runner_diameter_mm"},
    {"runner.loss_ratio", "gas", "intake_runner_loss"},
    {"charge_burn.in_use", "gas", "burn_by"},
    {"walls.coolant_K", "gas", "coolant_C"},
    {"walls.manifold_K", "gas", "manifold_C"},
    {"gas.port", "valve", "port"},
    {"gas.flow_count", "valve", "flow_over_lift_ratio"},
    {"gas.flow_lift_ratio", "valve", "flow_over_lift_ratio"},
    {"gas.flow_ratio", "valve", "flow_over_lift_ratio"},
};

/// ", or heat_J", ", or misses and of_cycles, or cycles": what may be given instead, where there is a choice.
std::string other_ways(const Key& key) {
  if (key.form[0] == '\0') return "";
  const std::string_view choice = split(key.form, ':')[0];
  std::vector<std::string_view> forms;
  for (const Key& other : kKeys) {
    const bool instead = key.section == std::string_view(other.section) && split(other.form, ':')[0] == choice &&
                         key.form != std::string_view(other.form) && other.presence != Presence::optional;
    if (instead && std::find(forms.begin(), forms.end(), other.form) == forms.end()) forms.emplace_back(other.form);
  }
  std::string words;
  for (const std::string_view form : forms) words += ", or " + required_keys(key.section, form);
  return words;
}

std::string words_about(const Key& key) {
  std::string words = key.meaning;
  if (const std::string allowed = key.allowed(); !allowed.empty()) words += "; " + allowed;
  if (key.presence == Presence::required) words += "; required" + other_ways(key);
  if (key.presence == Presence::with_default) words += std::string("; default ") + key.fallback;
  if (key.presence == Presence::optional) words += "; optional";
  if (key.usual[0] != '\0') words += std::string("; usual ") + key.usual;
  if (key.only_if[0] != '\0') words += std::string("; only with ") + key.only_if;
  return words;
}

}  // namespace

std::string Key::allowed() const {
  switch (kind) {
    case Kind::choice: {
      std::vector<std::string> names;
      for (const std::string_view one : split(choices, '|')) names.emplace_back(one);
      return join(names, " | ");
    }
    case Kind::firing_order:
      return "like 1-3-4-2";
    case Kind::pin_groups:
      return "like 1-2,3-4";
    case Kind::numbers:
      return "list; each " + describe(range, unit_in_words(unit.name));
    case Kind::pairs:
      return "pairs, like 0:0, 1:1; each " + describe(range, unit_in_words(unit.name));
    case Kind::whole_number:
      return "whole number; " + describe(range, unit_in_words(unit.name));
    case Kind::number:
      return describe(range, unit_in_words(unit.name)) + (choices[0] == '\0' ? "" : std::string(", or ") + choices);
    case Kind::text:
    case Kind::path:
      break;
  }
  return "";
}

const std::vector<SectionKind>& section_kinds() {
  static const std::vector<SectionKind> kinds(std::begin(kSections), std::end(kSections));
  return kinds;
}

const SectionKind* find_section_kind(const std::string& name) {
  for (const SectionKind& kind : kSections) {
    if (kind.name == name) return &kind;
  }
  return nullptr;
}

std::string required_keys(const std::string& section, std::string_view form) {
  const std::vector<const Key*> keys = keys_of(section);
  for (const Presence most_needed : {Presence::required, Presence::with_default, Presence::optional}) {
    std::vector<std::string> names;
    for (const Key* key : keys) {
      if (form == key->form && key->presence == most_needed) names.emplace_back(key->name);
    }
    if (!names.empty()) return join(names, " and ");
  }
  return "";
}

std::vector<const Key*> keys_of(const std::string& section) {
  std::vector<const Key*> keys;
  for (const Key& key : kKeys) {
    if (key.section == section) keys.push_back(&key);
  }
  return keys;
}

const Key* find_key(const std::string& section, const std::string& name) {
  for (const Key& key : kKeys) {
    if (key.section == section && key.name == name) return &key;
  }
  return nullptr;
}

const Key* key_of_field(std::string_view field) {
  for (const Key& key : kKeys) {
    if (key.field == field) return &key;
  }
  for (const Follows& follows : kFollows) {
    if (follows.field == field) return find_key(follows.section, follows.key);
  }
  return nullptr;
}

std::vector<std::string> sections_with_key(const std::string& name) {
  std::vector<std::string> sections;
  for (const Key& key : kKeys) {
    if (key.name == name)
      sections.push_back("[" + std::string(key.section) + (find_section_kind(key.section)->named ? " NAME]" : "]"));
  }
  return sections;
}

std::string describe_all_keys() {
  constexpr std::size_t kColumn = 28;
  std::string text;
  for (const SectionKind& kind : kSections) {
    text += std::string(text.empty() ? "" : "\n") + "[" + kind.name + (kind.named ? " NAME]" : "]") + "  " +
            kind.meaning + "\n";
    for (const Key* key : keys_of(kind.name)) {
      std::string name = key->name;
      name.resize(std::max(kColumn, name.size() + 1), ' ');
      text += "  " + name + words_about(*key) + "\n";
    }
  }
  return text;
}

}  // namespace crankloop::program
