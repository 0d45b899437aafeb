#include "engine_file.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "../files/table_file.hpp"
#include "../files/text_file.hpp"
#include "../files/words.hpp"
#include "engine_file_parts.hpp"
#include "problems.hpp"

namespace crankloop::program {
namespace {

constexpr TableFormat kAngleTable{"crank_deg", "pressure_kPa", from(-kMaxDiagramAngle_deg).up_to(kMaxDiagramAngle_deg),
                                  from(0).up_to(kMaxPressure_Pa / 1e3)};
constexpr TableFormat kVolumeTable{"volume_cm3", "pressure_kPa", above(0).up_to(1e9),
                                   from(0).up_to(kMaxPressure_Pa / 1e3)};

std::string title_of(const SectionValues& section) {
  return section.name.empty() ? section.kind : section.kind + " " + section.name;
}

/// Checks the headers: known kinds, names where required, no duplicates.
void check_header(const IniSection& section, std::map<std::string, int>& first_lines, const std::string& path) {
  const SectionKind* kind = find_section_kind(section.kind);
  if (kind == nullptr) {
    std::vector<std::string> names;
    for (const SectionKind& known : section_kinds()) names.emplace_back(known.name);
    const std::string guess = suggestion(section.kind, names);
    throw InputError(path, section.line,
                     "unknown section [" + section.kind + "]" + (guess.empty() ? "; sections: " + join(names) : guess));
  }
  if (kind->named && section.name.empty()) {
    throw InputError(path, section.line,
                     "[" + section.kind + "] needs a name; write it like [" + section.kind + " intake]");
  }
  if (!kind->named && !section.name.empty()) {
    throw InputError(path, section.line, section.title() + " takes no name; write it [" + section.kind + "]");
  }
  const auto [first, is_new] = first_lines.emplace(section.title(), section.line);
  if (is_new) return;
  throw InputError(path, section.line,
                   section.title() + " is given twice (first in line " + std::to_string(first->second) +
                       "); put all its keys under one header");
}

void check_headers(const IniText& ini, const std::string& path) {
  Problems problems;
  std::map<std::string, int> first_lines;
  for (const IniSection& section : ini.sections) problems.of([&] { check_header(section, first_lines, path); });
  problems.refuse(path);
}

InputError section_is_missing(const std::string& path, int last_line, const std::string& title) {
  return {path, last_line, "section [" + title + "] is missing; this command needs it"};
}

/// In the order of section_kinds(); sections of one kind stay in the order of the file.
void sort_by_kind(std::vector<SectionValues>& sections) {
  const auto place = [](const SectionValues& section) {
    return find_section_kind(section.kind) - section_kinds().data();
  };
  std::stable_sort(sections.begin(), sections.end(),
                   [&place](const auto& a, const auto& b) { return place(a) < place(b); });
}

}  // namespace

EngineFile read_engine_file(const std::string& path, const std::vector<std::string>& needed_sections) {
  const FileBytes file = read_file(path, kMaxEngineFileBytes);
  if (!file.ok()) throw InputError(path + ": " + file.problem);
  return read_engine_text(file.bytes, path, needed_sections);
}

EngineFile read_engine_text(const std::string& text, const std::string& path,
                            const std::vector<std::string>& needed_sections, const std::vector<Setting>& settings) {
  IniText ini = parse_ini(split_lines(text, path), path);
  apply(settings, ini, path);
  check_headers(ini, path);

  EngineFile engine(path);
  engine.last_line_ = ini.last_line;
  Problems problems;
  for (const IniSection& section : ini.sections)
    problems.of([&] { engine.sections_.push_back(resolve_section(section, path)); });
  for (const std::string& title : needed_sections) {
    const bool there = std::any_of(ini.sections.begin(), ini.sections.end(),
                                   [&title](const IniSection& one) { return one.kind == title; });
    problems.of([&] {
      if (!there) throw section_is_missing(path, ini.last_line, title);
    });
  }
  problems.refuse(path);
  if (engine.has("crank")) {
    if (!engine.has("layout")) engine.sections_.push_back(resolve_section({"layout", "", 0, {}}, path));
    const SectionValues* const pressure = engine.find("pressure");
    const bool breathes = pressure != nullptr && pressure->text("source") == "gas";
    if (breathes && !engine.has("gas")) engine.sections_.push_back(resolve_section({"gas", "", 0, {}}, path));
    if (!engine.has("pressure"))
      engine.sections_.push_back(resolve_section({"pressure", "", 0, {{"source", "none", 0}}}, path));
    for (const char* optional : {"friction", "machine", "starter"}) {
      if (!engine.has(optional)) engine.sections_.push_back(resolve_section({optional, "", 0, {}}, path));
    }
  }
  sort_by_kind(engine.sections_);
  engine.build_definition();
  return engine;
}

void EngineFile::build_definition() {
  for (const SectionValues& section : sections_) {
    const bool of_train =
        section.kind == "cam" || section.kind == "material" || section.kind == "rocker" || section.kind == "valve";
    const bool needs_crank = !of_train && section.kind != "engine" && section.kind != "crank";
    if (needs_crank && !has("crank"))
      throw InputError(path_, section.line, section.title() + " needs a [crank] section beside it");
  }
  build_trains();
  build_triggers();
  if (!has("crank")) return;

  const auto accept = [this](const Status& status) {
    if (!status.ok()) throw explain(status);
  };
  definition_.crank = build_crank(section("crank"), path_);
  if (const SectionValues* engine = find("engine"); engine != nullptr && engine->has("max_rpm")) {
    if (engine->number("max_rpm") < engine->number("rated_rpm"))
      throw InputError(path_, engine->line_of("max_rpm"), "max_rpm: must not be less than rated_rpm");
    definition_.crank.max_speed_rad_s = engine->si("max_rpm");
  }
  accept(validate(definition_.crank));
  if (const SectionValues* masses = find("masses")) {
    definition_.masses = build_masses(*masses, definition_.crank, path_);
    accept(validate(definition_.masses));
  }
  definition_.layout = build_layout(*find("layout"), section("crank").number("bore_mm"), path_);
  accept(validate(definition_.layout));
  balancers_ = build_balancers(sections_, definition_.layout);
  build_misfires();
  build_faults();
  build_reluctor();
  definition_.pressure = build_pressure(section("pressure"));
  if (section("pressure").has("file")) read_diagram(section("pressure"));
  accept(validate(definition_.pressure, definition_.crank));
  if (definition_.pressure.source == PressureSource::gas) build_gas_exchange();
  build_lambda_sensor();
  build_sensor_faults();
  fill(section("friction"), definition_.friction);
  fill(section("machine"), definition_.machine);
  fill(section("starter"), definition_.starter);
  for (const Status& status :
       {validate(definition_.friction), validate(definition_.machine), validate(definition_.starter)})
    accept(status);
  if (has("masses")) accept(validate(definition_));  // rules between the parts
}

/// Needs the trains, to which the ports belong.
void EngineFile::build_gas_exchange() {
  Gas gas = build_gas(section("gas"), path_);
  int number = 0;
  for (const TrainOfFile& train : trains_) {
    if (!train.complete()) continue;
    const SectionValues& valve = section("valve " + train.name);
    for (const char* key : {"port", "seat_diameter_mm"}) {
      if (!valve.has(key)) {
        throw InputError(path_, valve.line, valve.title() + " lacks " + key + ", needed with [pressure] source = gas");
      }
    }
    gas.ports[number++] = train.port;
  }
  if (number == 0) {
    throw InputError(path_, section("pressure").line_of("source"),
                     "source: gas needs valves: a [cam NAME], [rocker NAME] and [valve NAME] each");
  }
  definition_.gas = gas;
  if (const Status status = validate(definition_.gas, definition_.train_count); !status.ok()) throw explain(status);
}

void EngineFile::read_diagram(const SectionValues& pressure) {
  const bool over_angle = definition_.pressure.source == PressureSource::angle_table;
  points_path_ = in_folder(folder_of(path_), pressure.text("file"));
  for (const TableRow& row :
       read_table(points_path_, over_angle ? kAngleTable : kVolumeTable, path_, pressure.line_of("file"))) {
    // Core refuses this too, but without the row's line and value.
    if (over_angle && !points_.empty() && row.at <= points_.back().at) {
      throw InputError(points_path_, row.line,
                       "crank_deg: " + shortest(row.at) + " follows " + shortest(points_.back().at) +
                           "; angles must rise from row to row");
    }
    points_.push_back({over_angle ? row.at : row.at / 1e6, row.value * 1e3});
    point_lines_.push_back(row.line);
  }
  definition_.pressure.points = points_.data();
  definition_.pressure.point_count = static_cast<int>(points_.size());
}

const SectionValues* EngineFile::find(const std::string& title) const noexcept {
  const auto found = std::find_if(sections_.begin(), sections_.end(),
                                  [&title](const SectionValues& one) { return title_of(one) == title; });
  return found == sections_.end() ? nullptr : &*found;
}

SectionValues* EngineFile::find(const std::string& title) noexcept {
  return const_cast<SectionValues*>(std::as_const(*this).find(title));
}

void EngineFile::require(const std::vector<std::string>& needed_sections) const {
  Problems problems;
  for (const std::string& title : needed_sections) {
    problems.of([&] {
      if (!has(title)) throw section_is_missing(path_, last_line_, title);
    });
  }
  problems.refuse(path_);
}

const SectionValues& EngineFile::section(const std::string& title) const {
  const SectionValues* section = find(title);
  if (section == nullptr)
    throw std::logic_error("the engine file has no [" + title + "], and the command did not ask for it");
  return *section;
}

}  // namespace crankloop::program
