#include "engine_facts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <crankloop/tabulate/cam_profile.hpp>
#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tabulate/valve_lift.hpp>

#include "crankloop/engine_file/gas_order.hpp"
#include "crankloop/files/units.hpp"
#include "crankloop/files/words.hpp"
#include "json.hpp"

namespace crankloop::page {
namespace {

using program::kDegPerRad;
using program::kRadPerDeg;
using program::kRpmPerRad_s;

void add_crank(Json& json, const Crank& crank) {
  const double swept_m3 = swept_volume_m3(crank);
  json.key("crank").open('{');
  json.member("bore_m", crank.bore_m).member("crank_radius_m", crank.crank_radius_m);
  json.member("rod_length_m", crank.rod_length_m).member("pin_offset_m", crank.pin_offset_m);
  json.member("compression_ratio", crank.compression_ratio).member("stroke_m", dead_centres(crank).stroke_m);
  json.member("swept_m3", swept_m3).member("clearance_m3", swept_m3 / (crank.compression_ratio - 1));
  json.close('}');
}

void add_cylinders(Json& json, const Layout& layout) {
  const auto count = static_cast<std::size_t>(layout.cylinders);
  json.key("cylinders").open('[');
  for (std::size_t k = 0; k < count; ++k) {
    json.open('{').member("firing_deg", layout.firing_deg[k]).member("bank_deg", layout.bank_deg[k]);
    json.member("position_m", layout.position_m[k]).member("pin", static_cast<int>(layout.pin[k]));
    json.member("throw_deg", layout.throw_deg(static_cast<int>(k))).close('}');
  }
  json.close(']');
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&layout](std::size_t a, std::size_t b) { return layout.firing_deg[a] < layout.firing_deg[b]; });
  json.key("firing_order").open('[');
  for (const std::size_t k : order) json.value(k + 1);
  json.close(']');
}

const char* name_of(GasPort port) {
  return port == GasPort::intake ? "intake" : port == GasPort::exhaust ? "exhaust" : "";
}

template <class At>
void add_curve(Json& json, const char* name, const At& at) {
  json.key(name).open('[');
  for (int deg = -180; deg <= 180; ++deg) json.value(at(deg));
  json.close(']');
}

void add_train(Json& json, const program::TrainOfFile& train) {
  const ValveTrain& definition = train.definition;
  ValveLift lift;
  CamProfile profile;
  if (!lift.init(definition.cam, definition.rocker).ok() || !profile.init(definition.cam).ok()) return;
  const double full_lift_deg = definition.cam.full_lift_deg;
  json.open('{').member("name", train.name).member("port", name_of(train.port.port));
  json.member("valves_per_cylinder", definition.valve.per_cylinder).member("max_lift_m", lift.largest_lift_m());
  json.member("full_lift_deg", full_lift_deg).member("opens_deg", full_lift_deg + 2 * lift.opens_rad() * kDegPerRad);
  json.member("closes_deg", full_lift_deg + 2 * lift.closes_rad() * kDegPerRad);
  json.member("rocker", definition.rocker.kind == RockerKind::ratio ? "ratio" : "circular_pad");
  json.member("base_circle_m", definition.rocker.base_circle_m).member("clearance_m", definition.rocker.clearance_m);
  json.member("seat_m", train.port.seat_diameter_m);
  add_curve(json, "cam_deg", [](int deg) { return deg; });
  add_curve(json, "cam_lift_m", [&lift](int deg) { return std::max(0.0, lift.at(deg * kRadPerDeg).lift_m); });
  const double base_m = definition.rocker.base_circle_m;
  add_curve(json, "profile_m", [&](int deg) { return base_m + profile.at(deg * kRadPerDeg).lift_m; });
  json.close('}');
}

/// Edges of a turn of the wheel's shaft, in crank degrees from cylinder 1's firing top dead centre.
struct WheelEdges {
  std::vector<double> rising_deg, falling_deg;
};

WheelEdges edges_of(const TriggerWheel& wheel) {
  WheelEdges edges;
  if (wheel.pattern == TriggerPattern::edges) {
    for (int i = 0; i < wheel.edge_count; ++i)
      (i % 2 == 0 ? edges.rising_deg : edges.falling_deg).push_back(wheel.edges_deg[i]);
    return edges;
  }
  const double place_deg = (wheel.shaft == TriggerShaft::crank ? 360.0 : 720.0) / wheel.places;
  std::vector<bool> has_tooth(static_cast<std::size_t>(wheel.places), true);
  std::size_t place = 0;
  for (int g = 0; g < wheel.gap_count; ++g) {
    place += static_cast<std::size_t>(wheel.gaps[g].teeth);
    for (int i = 0; i < wheel.gaps[g].missing && place < has_tooth.size(); ++i) has_tooth[place++] = false;
  }
  for (std::size_t i = 0; i < has_tooth.size(); ++i) {
    if (!has_tooth[i]) continue;
    const double rising_deg = wheel.first_tooth_deg + static_cast<double>(i) * place_deg;
    edges.rising_deg.push_back(rising_deg);
    edges.falling_deg.push_back(rising_deg + wheel.tooth_ratio * place_deg);
  }
  return edges;
}

void add_numbers(Json& json, const char* name, const std::vector<double>& numbers) {
  json.key(name).open('[');
  for (const double x : numbers) json.value(x);
  json.close(']');
}

void add_wheel(Json& json, const std::string& name, const TriggerWheel& wheel) {
  const WheelEdges edges = edges_of(wheel);
  json.open('{').member("name", name).member("shaft", wheel.shaft == TriggerShaft::crank ? "crank" : "cam");
  json.member("places", wheel.places).member("inverted", wheel.inverted);
  add_numbers(json, "rising_deg", edges.rising_deg);
  add_numbers(json, "falling_deg", edges.falling_deg);
  json.close('}');
}

/// As page_keys() names it.
const char* name_of(program::Kind kind) {
  using program::Kind;
  switch (kind) {
    case Kind::number:
      return "number";
    case Kind::whole_number:
      return "whole_number";
    case Kind::numbers:
      return "numbers";
    case Kind::pairs:
      return "pairs";
    case Kind::choice:
      return "choice";
    case Kind::text:
      return "text";
    case Kind::path:
      return "path";
    case Kind::firing_order:
      return "firing_order";
    case Kind::pin_groups:
      return "pin_groups";
  }
  return "";
}

void add_key(Json& json, const program::SectionValues& section, const program::Value& value) {
  const program::Key& key = *value.key;
  json.open('{');
  json.member("key", section.kind + (section.name.empty() ? "" : "." + section.name) + "." + key.name);
  json.member("section", section.kind).member("name", section.name).member("unit", key.unit.name);
  json.member("kind", name_of(key.kind)).key("choices").open('[');
  for (const std::string_view choice : program::split(key.choices, '|')) {
    if (!choice.empty()) json.value(choice);
  }
  json.close(']').member("least", key.range.least).member("most", key.range.most);
  json.member("without_least", key.range.without_least).member("without_most", key.range.without_most);
  json.member("value", value.is_open() ? value.text : program::format_value(value)).member("line", value.line);
  json.member("used", value.used).member("meaning", key.meaning).close('}');
}

}  // namespace

std::string facts_of(const program::EngineFile& file) {
  const EngineDefinition& engine = file.definition();
  Json json;
  json.open('{').member("name", file.name()).member("path", file.path());
  json.member("breathes", program::breathes(engine))
      .member("has_pressure", engine.pressure.source != PressureSource::none);
  json.member("has_starter", engine.starter.stall_Nm > 0).member("has_triggers", !file.triggers().empty());
  json.member("rated_rpm", file.rated_rpm()).key("max_rpm");
  const double max_rpm = engine.crank.max_speed_rad_s * kRpmPerRad_s;
  json.value(max_rpm > 0 ? max_rpm : std::numeric_limits<double>::infinity());
  add_crank(json, engine.crank);
  add_cylinders(json, engine.layout);
  json.key("trains").open('[');
  for (const program::TrainOfFile& train : file.trains()) {
    if (train.complete()) add_train(json, train);
  }
  json.close(']').key("wheels").open('[');
  for (std::size_t w = 0; w < file.triggers().size(); ++w) add_wheel(json, file.triggers()[w].name, engine.triggers[w]);
  return json.close(']').close('}').text();
}

std::string keys_of(const program::EngineFile& file) {
  Json json;
  json.open('[');
  for (const program::SectionValues& section : file.sections()) {
    for (const program::Value& value : section.values) add_key(json, section, value);
  }
  return json.close(']').text();
}

}  // namespace crankloop::page
