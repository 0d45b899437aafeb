// EngineFile::explain(): a Status of the library as a message about the engine file's own keys, in its own units.
#include <cmath>
#include <string_view>

#include "engine_file.hpp"
#include "engine_file_parts.hpp"
#include "../words.hpp"

namespace crankloop::program {
namespace {

/// rod_length_mm itself was long enough (build_crank): rod_ratio made the rod too short.
std::string rod_too_short(const SectionValues& crank, const Crank& built) {
  return "rod_ratio: " + shortest(crank.number("rod_ratio")) + " makes the rod " + brief(built.rod_length_m * 1e3) +
         " mm long; it must be longer than stroke_mm / 2 + |pin_offset_mm| = " +
         brief(crank.number("stroke_mm") / 2 + std::abs(crank.number("pin_offset_mm"))) + " mm, by more than a billionth, or the crank cannot turn";
}

std::string combustion_too_long(const SectionValues& pressure) {
  const double end_deg = pressure.number("start_of_combustion_deg") + pressure.number("combustion_duration_deg");
  return "combustion_duration_deg: combustion would end at " + brief(end_deg) +
         " deg; it must end before exhaust_valve_opens_deg = " + shortest(pressure.number("exhaust_valve_opens_deg"));
}

std::string motored_gives_work(const SectionValues& pressure) {
  return "motored_expansion_exponent: " + shortest(pressure.number("motored_expansion_exponent")) +
         " would give work without combustion; it must be at least compression_exponent = " + shortest(pressure.number("compression_exponent")) +
         ", or 0 for that + 0.03";
}

}  // namespace

bool is_named(const Key& key, std::string_view field) {
  std::string_view name = key.name;
  const std::string_view unit = key.unit.name;
  if (!unit.empty() && name.size() > unit.size() && name.substr(name.size() - unit.size()) == unit) {
    name.remove_suffix(unit.size() + 1);
  }
  return name == field;
}

InputError EngineFile::explain(const Status& status) const {
  const std::vector<std::string_view> field = split(status.field, '.');
  if (const TrainOfFile* train = train_to_blame(status)) return explain({status.reason, -1, status.field}, *train);
  const SectionValues* home = find(std::string(field[0]));
  if (home == nullptr || field.size() != 2)
    return InputError(path_ + ": " + status.field + " " + describe(status.reason));

  if (field[1] == "file" && !points_path_.empty()) {
    const bool has_row = status.index >= 0 && static_cast<std::size_t>(status.index) < point_lines_.size();
    const int line = has_row ? point_lines_[static_cast<std::size_t>(status.index)]
                             : (point_lines_.empty() ? 1 : point_lines_.back());
    std::string message = "the diagram " + std::string(describe(status.reason));
    if (status.reason == Reason::too_few_points)
      message = std::to_string(points_.size()) + " rows are too few for a diagram";
    if (status.reason == Reason::not_one_period && !points_.empty()) {
      message = "the angles run from " + brief(points_.front().at) + " to " + brief(points_.back().at) +
                " deg; they must span one period of 720 deg (a closing row at its end may be left out)";
    }
    return InputError(points_path_, line, message);
  }
  if (status.reason == Reason::rod_too_short) {
    return InputError(path_, home->line_of("rod_ratio"),
                      rod_too_short(*home, definition_.crank));
  }
  if (status.reason == Reason::inconsistent && field[1] == "combustion_duration") {
    return InputError(path_, home->line_of("combustion_duration_deg"), combustion_too_long(*home));
  }
  if (status.reason == Reason::inconsistent && field[1] == "motored_expansion_exponent") {
    return InputError(path_, home->line_of("motored_expansion_exponent"), motored_gives_work(*home));
  }

  for (const Key* key : keys_of(home->kind)) {
    if (!is_named(*key, field[1])) continue;
    const Value* value = home->find(key->name);
    std::string message = std::string(key->name) + ": ";
    if (value != nullptr) message += format_value(*value) + " ";
    if (status.index >= 0) message += "(cylinder " + std::to_string(status.index + 1) + ") ";
    message += describe(status.reason);
    if (status.reason == Reason::out_of_range) message += "; allowed: " + key->allowed();
    return InputError(path_, home->line_of(key->name), message);
  }
  return InputError(path_, home->line_of(field[1]),
                    home->title() + " " + std::string(field[1]) + " " + describe(status.reason));
}

}  // namespace crankloop::program
