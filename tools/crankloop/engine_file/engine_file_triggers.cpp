// Trigger wheels of an engine file: [trigger NAME] as a definition, and what is wrong with one in words.
//
// The 36-2-2-2 wheel of Subaru, which others use too, has two gaps with a single tooth between them and one gap by itself. Teeth and
// gaps in the sense of rotation, from the first tooth after that pair: 13, gap, 16, gap, 1, gap on four-cylinder engines, and 19, gap, 10, gap, 1, gap
// on six-cylinder ones; so they stand in the decoders of Speeduino (its wiki, "Subaru 36-2-2-2") and, the former, of rusEFI.
#include <algorithm>

#include "engine_file.hpp"
#include "engine_file_parts.hpp"
#include "../words.hpp"

namespace crankloop::program {
namespace {

/// A pattern's own text, read from left to right.
class PatternText {
 public:
  explicit PatternText(std::string_view text) : rest_{text} {}

  [[nodiscard]] bool at_end() const { return rest_.empty(); }
  [[nodiscard]] bool skip(char c) {
    if (rest_.empty() || rest_[0] != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  /// Up to three digits; 0 where there are none, or more.
  [[nodiscard]] int number() {
    std::size_t digits = 0;
    while (digits < rest_.size() && rest_[digits] >= '0' && rest_[digits] <= '9') ++digits;
    int number = 0;
    for (std::size_t i = 0; i < digits && digits <= 3; ++i) number = 10 * number + (rest_[i] - '0');
    rest_.remove_prefix(digits);
    return number;
  }

 private:
  std::string_view rest_;
};

void add_gap(TriggerWheel& wheel, ToothGap gap) {
  if (wheel.gap_count < kMaxToothGaps) wheel.gaps[wheel.gap_count] = gap;
  ++wheel.gap_count;  // one too many is refused by validate()
  wheel.places += gap.teeth + gap.missing;
}

/// 60, 60-2. False for anything else.
bool read_nominal(std::string_view text, TriggerWheel& wheel) {
  PatternText pattern(text);
  const int places = pattern.number();
  int missing = 0;
  if (pattern.skip('-')) {
    missing = pattern.number();
    if (missing < 1 || missing >= places) return false;
  }
  if (places < 1 || !pattern.at_end()) return false;
  if (missing > 0) {
    add_gap(wheel, {places - missing, missing});
  } else {
    wheel.places = places;
  }
  return true;
}

/// 13(2)16(2)1(2), 5(1)6. False for anything else.
bool read_runs(std::string_view text, TriggerWheel& wheel) {
  PatternText pattern(text);
  while (!pattern.at_end()) {
    const int teeth = pattern.number();
    if (teeth < 1) return false;
    if (pattern.at_end()) {
      wheel.places += teeth;
      return wheel.gap_count > 0;
    }
    if (!pattern.skip('(')) return false;
    const int missing = pattern.number();
    if (missing < 1 || !pattern.skip(')')) return false;
    add_gap(wheel, {teeth, missing});
  }
  return wheel.gap_count > 0;
}

bool read_pattern(const std::string& text, TriggerWheel& wheel) {
  if (text == "half-moon") return read_nominal("1", wheel);
  if (text == "36-2-2-2") return read_runs("13(2)16(2)1(2)", wheel);
  if (text == "36-2-2-2-H6") return read_runs("19(2)10(2)1(2)", wheel);
  return read_nominal(text, wheel) || read_runs(text, wheel);
}

/// What validate() found of an edge list.
std::string edges_in_words(const TriggerWheel& wheel, const std::vector<double>& edges_deg, const Status& status) {
  const std::string turn = wheel.shaft == TriggerShaft::crank ? "360" : "720";
  const auto entry = static_cast<std::size_t>(std::max(status.index, 0));
  const std::string which = "entry " + std::to_string(entry + 1) + ": " + shortest(edges_deg.at(entry));
  switch (status.reason) {
    case Reason::too_few_points:
    case Reason::inconsistent: return std::to_string(edges_deg.size()) + " given; every rise needs its fall";
    case Reason::not_increasing: return which + " follows " + shortest(edges_deg.at(entry - 1)) + "; they must rise, by at least 0.001 deg";
    case Reason::out_of_range:
      if (entry == 0) return which + " is out of range; the first one is 0 to below 720 deg";
      return which + " is out of range; all lie within one turn of the shaft, " + turn + " deg from the first one";
    default: return which + " " + describe(status.reason);
  }
}

}  // namespace

TriggerWheel build_trigger(const SectionValues& values, const std::string& path) {
  TriggerWheel wheel;
  wheel.shaft = split(values.text("on"), ' ')[0] == "crank" ? TriggerShaft::crank : TriggerShaft::cam;
  wheel.inverted = values.text("inverted") == "yes";
  if (!values.has("pattern")) {
    wheel.pattern = TriggerPattern::edges;
    return wheel;
  }
  const std::string& pattern = values.text("pattern");
  if (!read_pattern(pattern, wheel)) {
    refuse(values, "pattern", in_quotes(pattern) + " is no wheel; allowed: " + find_key("trigger", "pattern")->meaning, path);
  }
  if (wheel.places > kMaxToothPlaces || wheel.gap_count > kMaxToothGaps) {
    refuse(values, "pattern", in_quotes(pattern) + " is too fine; allowed: up to " + std::to_string(kMaxToothPlaces) + " teeth, missing ones counted, and " +
                                  std::to_string(kMaxToothGaps) + " gaps", path);
  }
  wheel.first_tooth_deg = into_cycle_deg(values.si("first_tooth_deg"));
  wheel.tooth_ratio = values.si("tooth_ratio");
  return wheel;
}

/// The train of `on = cam NAME` in the definition; -1 for the crank, for any cam, and for a cam without rocker or valve.
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
      throw InputError(path_, section.line, section.title() + " makes one trigger wheel too many; allowed: " + std::to_string(kMaxTriggerWheels));
    }
    const int train = train_with_phaser(section);
    TriggerWheel wheel = build_trigger(section, path_);
    wheel.train = train;
    triggers_.push_back({section.name, section.has("edges_deg") ? section.numbers("edges_deg") : std::vector<double>{}});
    const std::vector<double>& edges_deg = triggers_.back().edges_deg;  // keeps its place when the list of triggers grows or moves
    wheel.edges_deg = edges_deg.empty() ? nullptr : edges_deg.data();
    wheel.edge_count = static_cast<int>(edges_deg.size());
    if (const Status status = validate(wheel); !status.ok()) {
      if (!edges_deg.empty()) refuse(section, "edges_deg", edges_in_words(wheel, edges_deg, status), path_);
      throw InputError(path_, section.line, section.title() + " " + status.field + " " + describe(status.reason));
    }
    definition_.triggers[definition_.trigger_count++] = wheel;
  }
}

}  // namespace crankloop::program
