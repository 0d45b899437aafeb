// Valve trains of an engine file: [cam NAME], [material NAME], [rocker NAME] and [valve NAME] as definitions, and
// messages for core's refusals.
#include <algorithm>
#include <cmath>

#include "../files/number.hpp"
#include "../files/table_file.hpp"
#include "../files/text_file.hpp"
#include "../files/words.hpp"
#include "engine_file.hpp"
#include "engine_file_parts.hpp"
#include "measured_rows.hpp"

namespace crankloop::program {
namespace {

constexpr TableFormat kCamTable{"cam_deg", "lift_mm", from(-360).up_to(360), from(-100).up_to(100)};

/// A number with few digits, as in a file.
double micrometres(double metres) { return parse_number(brief(metres * 1e6)).value; }

TrainOfFile& named(std::vector<TrainOfFile>& trains, const std::string& name) {
  const auto found =
      std::find_if(trains.begin(), trains.end(), [&name](const TrainOfFile& one) { return one.name == name; });
  if (found != trains.end()) return *found;
  trains.emplace_back();
  trains.back().name = name;
  return trains.back();
}

}  // namespace

double into_cycle_deg(double crank_deg) {
  const double rest = std::fmod(crank_deg, 720);
  return rest < 0 ? rest + 720 : rest;
}

Cam build_cam(const SectionValues& values, const std::string& path) {
  Cam cam;
  fill(values, cam);
  cam.full_lift_deg = into_cycle_deg(values.si("full_lift_at_crank_deg"));
  if (values.text("source") == "table") {
    cam.source = CamSource::table;
    return cam;
  }
  const std::vector<double>& exponents = values.numbers("exponents");
  if (exponents.size() < 2 || exponents.size() > kMaxCamExponents) {
    refuse(values, "exponents", std::to_string(exponents.size()) + " given; allowed: 2 to 8 of them, rising", path);
  }
  for (const double exponent : exponents) {
    if (cam.exponent_count > 0 && exponent <= cam.exponents[cam.exponent_count - 1]) {
      refuse(values, "exponents",
             shortest(exponent) + " follows " + shortest(cam.exponents[cam.exponent_count - 1]) + "; they must rise",
             path);
    }
    cam.exponents[cam.exponent_count++] = exponent;
  }
  return cam;
}

Rocker build_rocker(const SectionValues& values) {
  Rocker rocker;
  fill(values, rocker);
  if (values.has("ratio")) {
    rocker.kind = RockerKind::ratio;
  } else if (values.text("cam_turns") == "away_from_pivot") {
    rocker.cam_turns = CamTurns::away_from_pivot;
  }
  return rocker;
}

void EngineFile::build_trains() {
  const auto accept = [this](const Status& status, const TrainOfFile& train) {
    if (!status.ok()) throw explain(status, train);
  };
  for (SectionValues& section : sections_) {
    if (section.kind != "cam" && section.kind != "material" && section.kind != "rocker" && section.kind != "valve")
      continue;
    if (section.kind == "material" && !has("cam " + section.name)) {
      throw InputError(path_, section.line,
                       "[material " + section.name + "] has no [cam " + section.name + "] beside it");
    }
    TrainOfFile& train = named(trains_, section.name);
    if (section.kind == "material") {
      fill(section, train.contact);
      accept(validate(train.contact), train);
    } else if (section.kind == "cam") {
      train.has_cam = true;
      train.definition.cam = build_cam(section, path_);
      fill(section, train.contact);
      if (section.has("limit_MPa")) train.stress_limit_Pa = section.si("limit_MPa");
      accept(validate(train.contact), train);
      if (section.has("file")) read_cam(section, train);
      accept(validate(train.definition.cam), train);
    } else if (section.kind == "rocker") {
      train.has_rocker = true;
      train.definition.rocker = build_rocker(section);
      accept(validate(train.definition.rocker), train);
    } else {
      train.has_valve = true;
      fill(section, train.definition.valve);
      train.port = build_port(section, path_);
      train.has_flow_curve = section.has("flow_over_lift_ratio");
      train.wire = build_spring_wire(section, path_);
      train.geometry = build_port_geometry(section, path_);
      accept(validate(train.definition.valve), train);
    }
  }
  for (const TrainOfFile& train : trains_) {
    if (!train.complete()) continue;
    accept(validate(train.definition), train);
    if (definition_.train_count == kMaxTrains) {
      throw InputError(
          path_, section("cam " + train.name).line,
          "[cam " + train.name + "] makes one valve train too many; allowed: " + std::to_string(kMaxTrains));
    }
    definition_.contacts[definition_.train_count] = train.contact;
    definition_.trains[definition_.train_count++] = train.definition;
  }
}

void EngineFile::read_cam(SectionValues& cam, TrainOfFile& train) {
  train.points_path = in_folder(folder_of(path_), cam.text("file"));
  for (const TableRow& row : read_table(train.points_path, kCamTable, path_, cam.line_of("file"))) {
    if (!train.points.empty() && row.at <= train.points.back().cam_deg) {
      throw InputError(train.points_path, row.line,
                       "cam_deg: " + shortest(row.at) + " follows " + shortest(train.points.back().cam_deg) +
                           "; angles must rise from row to row");
    }
    train.points.push_back({row.at, row.value / 1e3});
    train.point_lines.push_back(row.line);
  }
  if (train.points.size() > kMaxCamPoints) {
    throw InputError(
        train.points_path, train.point_lines[kMaxCamPoints],
        std::to_string(train.points.size()) + " rows; at most " + std::to_string(kMaxCamPoints) + " are allowed");
  }
  train.definition.cam.points = train.points.data();
  train.definition.cam.point_count = static_cast<int>(train.points.size());
  if (!cam.find("smoothing_um")->is_open()) return;
  train.rows.emplace();
  if (const Status refused = survey_rows(train.definition.cam, *train.rows); !refused.ok())
    throw explain(refused, train);
  cam.choose("smoothing_um", micrometres(train.rows->automatic_m));
  train.definition.cam.smoothing_m = cam.si("smoothing_um");
}

const TrainOfFile& EngineFile::train(const std::string& name) const {
  std::vector<std::string> names;
  for (const TrainOfFile& train : trains_) {
    if (train.name == name) return train;
    names.push_back(train.name);
  }
  const std::string guess = suggestion(name, names);
  throw InputError(path_ + ": no valve train is called " + in_quotes(name) +
                   (!guess.empty()  ? guess
                    : names.empty() ? "; the file has none"
                                    : "; there are: " + join(names)));
}

/// The train of a Status, by its index among the complete trains.
const TrainOfFile* EngineFile::train_to_blame(const Key& key, int index) const {
  const std::string_view kind = key.section;
  if (kind != "cam" && kind != "material" && kind != "rocker" && kind != "valve") return nullptr;
  int number = 0;
  for (const TrainOfFile& train : trains_) {
    if (train.complete() && number++ == index) return &train;
  }
  return nullptr;
}

namespace {

/// Not less than the value.
std::string three_digits_up(double value) {
  const double place = last_place(value, 3);
  return brief(std::ceil(value / place) * place);
}

/// "-30 deg (cam.csv:152)"
/// The message for a geometry that ValveLift refused; empty for other refusals.
std::string geometry_in_words(std::string_view field, const std::string& at) {
  if (field == "rocker.base_circle_m")
    return "base_circle_mm: the cam is undercut" + at + "; a larger base circle or a blunter lift is needed";
  if (field == "rocker.pivot_to_pad_m") return "pivot_to_pad_mm: pivot, pad and cam form no triangle" + at;
  if (field == "rocker.pivot_to_cam_m")
    return "pivot_to_cam_mm: the train jams" + at + ", where the contact's normal meets the pivot";
  if (field == "rocker.pivot_to_screw_m")
    return "pivot_to_screw_mm: the screw would stand more than 90 deg off the pivot's level" + at;
  if (field == "valve.rocker_inertia_kg_m2")
    return "rocker_inertia_kg_mm2: must be 0 with a constant ratio, which has no lever; add the rocker's share to "
           "valve_g";
  return "";
}

}  // namespace

/// The message for a refusal of a measured cam's rows or of its smoothing.
InputError EngineFile::explain_cam(const Status& status, const TrainOfFile& train, const SectionValues& cam) const {
  const bool has_row = status.index >= 0 && static_cast<std::size_t>(status.index) < train.point_lines.size();
  const int line = has_row ? train.point_lines[static_cast<std::size_t>(status.index)] : train.point_lines.back();
  const Value& smoothing = *cam.find("smoothing_um");
  const MeasuredRows measured{train.points_path, train.points, train.point_lines};
  CamRows rows;
  const Status survey = survey_rows(train.definition.cam, rows);
  const std::optional<OddRow> odd = odd_row(train.points, rows.scatter_m);
  const bool follows = survey.ok();
  if (status.reason == Reason::no_solution) {
    const std::string refused =
        "smoothing_um: " + (smoothing.is_open() ? "auto" : shortest(smoothing.numbers[0])) + " has no solution: ";
    if (!follows) {
      return InputError(
          path_, smoothing.line,
          refused + "no smooth lobe comes within 1000 um of every row; check the row at " +
              row_in_words(measured, odd ? odd->row : static_cast<std::size_t>(std::max(survey.index, 0))));
    }
    return InputError(path_, smoothing.line,
                      refused + "no smooth lobe comes that close to every row; smallest possible: " +
                          three_digits_up(rows.smallest_m * 1e6) + ", for which the row at " +
                          row_in_words(measured, static_cast<std::size_t>(rows.worst_row)) + " lies " +
                          three_digits_up(std::abs(rows.worst_off_m) * 1e6) + " um " +
                          (rows.worst_off_m > 0 ? "above" : "below") + " the lobe; allow more, or correct " +
                          (!odd || odd->row == static_cast<std::size_t>(rows.worst_row)
                               ? "that row"
                               : "the row at " + row_in_words(measured, odd->row) + ", which lies " +
                                     three_digits_up(std::abs(odd->off_m) * 1e6) + " um off its neighbours"));
  }
  std::string message = "the cam " + std::string(describe(status.reason));
  if (status.reason == Reason::too_few_points) message = too_few_rows(train.points.size(), "a cam");
  if (status.reason == Reason::inconsistent) {
    message = "the lobe must rise from the base circle and return to it within the table; ";
    message += smoothing.is_open() ? "no row on this side comes down to 50 um"
                                   : "smoothing_um (" + shortest(smoothing.numbers[0]) +
                                         ") is the lift that still counts as base circle";
    if (follows) message += "; smallest possible: " + three_digits_up(rows.smallest_m * 1e6);
  }
  if (status.reason == Reason::out_of_range && !has_row)
    message = "the rows must lie within one turn of 360 deg, and the lobe within 330 deg of it";
  return InputError(train.points_path, line, message);
}

InputError EngineFile::explain(const Status& status, const TrainOfFile& train, double cam_deg) const {
  const Key* key = key_of_field(status.field);
  const SectionValues* home = key == nullptr ? nullptr : find(key->section + (" " + train.name));
  if (home == nullptr)
    return InputError(path_ + ": valve train " + train.name + ": " + status.field + " " + describe(status.reason));

  const std::string_view field = status.field;
  const bool of_rows = field == "cam.points" || (field == "cam.smoothing_m" && status.reason == Reason::no_solution);
  if (of_rows && !train.point_lines.empty()) return explain_cam(status, train, *home);
  if (status.reason == Reason::inconsistent) {
    const std::string words =
        geometry_in_words(field, " at " + brief(cam_deg) + " deg of the flat follower's cam angle");
    if (!words.empty()) return InputError(path_, home->line_of(split(words, ':')[0]), words);
  }
  std::string refusal = field == "cam.exponents" && status.reason == Reason::not_increasing
                            ? "must rise by at least 0.1"
                            : describe(status.reason);
  return InputError(path_, home->line_of(key->name), in_words(*home, *key, status.reason, refusal));
}

}  // namespace crankloop::program
