// EngineFile::explain(): a Status of the library as a message about the engine file's own keys, in its own units.
#include <cmath>
#include <string_view>

#include <crankloop/tabulate/mechanism.hpp>

#include "../files/words.hpp"
#include "engine_file.hpp"
#include "engine_file_parts.hpp"

namespace crankloop::program {
namespace {

/// rod_length_mm itself was long enough (build_crank): rod_ratio made the rod too short.
std::string rod_too_short(const SectionValues& crank, const Crank& built) {
  return "rod_ratio: " + shortest(crank.number("rod_ratio")) + " makes the rod " + brief(built.rod_length_m * 1e3) +
         " mm long; it must be longer than stroke_mm / 2 + |pin_offset_mm| = " +
         brief(crank.number("stroke_mm") / 2 + std::abs(crank.number("pin_offset_mm"))) +
         " mm, by more than a billionth, or the crank cannot turn";
}

std::string combustion_too_long(const SectionValues& pressure) {
  const double end_deg = pressure.number("start_of_combustion_deg") + pressure.number("combustion_duration_deg");
  return "combustion_duration_deg: combustion would end at " + brief(end_deg) +
         " deg; it must end before exhaust_valve_opens_deg = " + shortest(pressure.number("exhaust_valve_opens_deg"));
}

std::string motored_gives_work(const SectionValues& pressure) {
  return "motored_expansion_exponent: " + shortest(pressure.number("motored_expansion_exponent")) +
         " would give work without combustion; it must be at least compression_exponent = " +
         shortest(pressure.number("compression_exponent")) + ", or 0 for that + 0.03";
}

std::string too_much_heat(const SectionValues& gas) {
  const double ratio = gas.number("air_fuel_ratio");
  const double heat_MJ_kg = gas.number("combustion_efficiency") * gas.number("heating_value_MJ_per_kg") / (1 + ratio);
  return "air_fuel_ratio: " + shortest(ratio) +
         " with heating_value_MJ_per_kg = " + shortest(gas.number("heating_value_MJ_per_kg")) + " releases " +
         brief(heat_MJ_kg) + " MJ per kg of mixture; allowed: up to " + brief(kMaxMixtureHeat_J_kg / 1e6) +
         ", and no fuel has more (petrol 2.8, hydrogen 3.4)";
}

std::string volume_outside(double volume_m3, const Crank& crank) {
  const double clearance_m3 = clearance_volume_m3(crank);
  return "volume_cm3: " + brief(volume_m3 * 1e6) + " lies outside this engine's " + brief(clearance_m3 * 1e6) + " to " +
         brief((clearance_m3 + swept_volume_m3(crank)) * 1e6) + " cm3 (bore, stroke, compression_ratio)";
}

}  // namespace

std::string in_words(const SectionValues& home, const Key& key, Reason reason, const std::string& refusal) {
  std::string message = std::string(key.name) + ": ";
  if (const Value* value = home.find(key.name); value != nullptr) message += format_value(*value) + " ";
  message += refusal;
  if (reason == Reason::out_of_range) message += "; allowed: " + key.allowed();
  return message;
}

InputError EngineFile::explain(const Status& status) const {
  const Key* key = key_of_field(status.field);
  if (key == nullptr) return InputError(path_ + ": " + status.field + " " + describe(status.reason));
  if (const TrainOfFile* train = train_to_blame(*key, status.index))
    return explain(crankloop::refuse(status.field, status.reason), *train);
  if (const SectionValues* fault = fault_to_blame(*key, status.index)) return explain_fault(status, *fault);
  const SectionValues* home = find(key->section);
  if (home == nullptr) return InputError(path_ + ": " + key->name + ": " + describe(status.reason));

  const std::string_view field = status.field;
  if (field == "pressure.points" && !points_path_.empty()) {
    const bool has_row = status.index >= 0 && static_cast<std::size_t>(status.index) < point_lines_.size();
    const int line = has_row ? point_lines_[static_cast<std::size_t>(status.index)]
                             : (point_lines_.empty() ? 1 : point_lines_.back());
    std::string message = "the diagram " + std::string(describe(status.reason));
    if (status.reason == Reason::too_few_points) message = too_few_rows(points_.size(), "a diagram");
    if (status.reason == Reason::out_of_range && has_row && definition_.pressure.source == PressureSource::volume_table)
      message = volume_outside(points_[static_cast<std::size_t>(status.index)].at, definition_.crank);
    if (status.reason == Reason::not_one_period && !points_.empty()) {
      message = "the angles run from " + brief(points_.front().at) + " to " + brief(points_.back().at) +
                " deg; they must span one period of 720 deg (a closing row at its end may be left out)";
    }
    return InputError(points_path_, line, message);
  }
  if (status.reason == Reason::rod_too_short) {
    return InputError(path_, home->line_of("rod_ratio"), rod_too_short(*home, definition_.crank));
  }
  if (status.reason == Reason::inconsistent && field == "pressure.wiebe.combustion_duration_deg") {
    return InputError(path_, home->line_of(key->name), combustion_too_long(*home));
  }
  if (status.reason == Reason::inconsistent && field == "pressure.wiebe.motored_expansion_exponent") {
    return InputError(path_, home->line_of(key->name), motored_gives_work(*home));
  }
  // Within its own range, or the file had been refused: it is the tick that is too short.
  if (status.reason == Reason::out_of_range && field == "reluctor.delay_s") {
    return InputError(path_, home->line_of(key->name), in_words(*home, *key, Reason::ok, "is more than a tick"));
  }
  if (status.reason == Reason::too_much_heat) return InputError(path_, home->line_of(key->name), too_much_heat(*home));
  const std::string whose = status.index >= 0 ? "(cylinder " + std::to_string(status.index + 1) + ") " : "";
  return InputError(path_, home->line_of(key->name),
                    in_words(*home, *key, status.reason, whose + describe(status.reason)));
}

}  // namespace crankloop::program
