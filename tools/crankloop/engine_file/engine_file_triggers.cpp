// Trigger wheels of an engine file: [trigger NAME] as a definition, and messages for its errors.
#include <algorithm>

#include "../files/words.hpp"
#include "engine_file.hpp"
#include "engine_file_parts.hpp"
#include "trigger_patterns.hpp"

namespace crankloop::program {
namespace {

/// The message for an edge list that validate() refused.
std::string edges_in_words(const TriggerWheel& wheel, const std::vector<double>& edges_deg, const Status& status) {
  const std::string turn = wheel.shaft == TriggerShaft::crank ? "360" : "720";
  const auto entry = static_cast<std::size_t>(std::max(status.index, 0));
  const std::string which = "entry " + std::to_string(entry + 1) + ": " + shortest(edges_deg.at(entry));
  switch (status.reason) {
    case Reason::too_few_points:
    case Reason::inconsistent:
      return std::to_string(edges_deg.size()) + " given; every rise needs its fall";
    case Reason::not_increasing:
      return which + " follows " + shortest(edges_deg.at(entry - 1)) + "; they must rise, by at least 0.001 deg";
    case Reason::out_of_range:
      if (entry == 0) return which + " is out of range; the first one is 0 to below 720 deg";
      return which + " is out of range; all lie within one turn of the shaft, " + turn + " deg from the first one";
    default:
      return which + " " + describe(status.reason);
  }
}

}  // namespace

TriggerWheel build_trigger(const SectionValues& values, const std::string& path, std::vector<double>& edges_deg) {
  TriggerWheel wheel;
  wheel.shaft = split(values.text("on"), ' ')[0] == "crank" ? TriggerShaft::crank : TriggerShaft::cam;
  wheel.inverted = values.text("inverted") == "yes";
  if (!values.has("pattern")) {
    edges_deg = values.numbers("edges_deg");
    return wheel;
  }
  const std::string& pattern = values.text("pattern");
  if (!read_pattern(pattern, wheel, edges_deg)) {
    refuse(values, "pattern", in_quotes(pattern) + " is no wheel; allowed: " + find_key("trigger", "pattern")->meaning,
           path);
  }
  if (wheel.places > kMaxToothPlaces || wheel.gap_count > kMaxToothGaps) {
    refuse(values, "pattern",
           in_quotes(pattern) + " is too fine; allowed: up to " + std::to_string(kMaxToothPlaces) +
               " teeth, missing ones counted, and " + std::to_string(kMaxToothGaps) + " gaps",
           path);
  }
  wheel.first_tooth_deg = into_cycle_deg(values.si("first_tooth_deg"));
  for (double& edge_deg : edges_deg) edge_deg += wheel.first_tooth_deg;
  wheel.tooth_ratio = values.si("tooth_ratio");
  return wheel;
}

/// The train of `on = cam NAME` in the definition; -1 for the crank, for any cam, and for a cam without rocker or
/// valve.
int EngineFile::train_with_phaser(const SectionValues& trigger) const {
  const std::string& on = trigger.text("on");
  if (on == "crank" || on == "cam") return -1;
  const std::string name = on.rfind("cam ", 0) == 0 ? std::string(trim(on.substr(4))) : "";
  std::vector<std::string> allowed{"crank", "cam"};
  int number = 0;
  for (const TrainOfFile& train : trains_) {
    if (train.has_cam && train.name == name) return train.complete() ? number : -1;
    if (train.has_cam) allowed.push_back("cam " + train.name);
    if (train.complete()) ++number;
  }
  refuse(trigger, "on", in_quotes(on) + " is not one of " + join(allowed) + suggestion(on, allowed), path_);
}

void EngineFile::build_triggers() {
  for (const SectionValues& section : sections_) {
    if (section.kind != "trigger") continue;
    if (definition_.trigger_count == kMaxTriggerWheels) {
      throw InputError(
          path_, section.line,
          section.title() + " makes one trigger wheel too many; allowed: " + std::to_string(kMaxTriggerWheels));
    }
    const int train = train_with_phaser(section);
    triggers_.push_back({section.name, {}});
    std::vector<double>& edges_deg =
        triggers_.back().edges_deg;  // its data stays in place when the list of triggers grows or moves
    TriggerWheel wheel = build_trigger(section, path_, edges_deg);
    wheel.train = train;
    if (!edges_deg.empty()) wheel.pattern = TriggerPattern::edges;
    wheel.edges_deg = edges_deg.empty() ? nullptr : edges_deg.data();
    wheel.edge_count = static_cast<int>(edges_deg.size());
    if (const Status status = validate(wheel); !status.ok()) {
      if (!edges_deg.empty()) refuse(section, "edges_deg", edges_in_words(wheel, edges_deg, status), path_);
      refuse(section, "pattern", std::string(status.field) + " " + describe(status.reason), path_);
    }
    definition_.triggers[definition_.trigger_count++] = wheel;
  }
}

}  // namespace crankloop::program
