// Misfires of an engine file, [misfire N], and of a command line, --misfire 'cylinder=N every=16'.
#include <algorithm>

#include "../files/words.hpp"
#include "engine_file.hpp"
#include "engine_file_parts.hpp"
#include "problems.hpp"

namespace crankloop::program {
namespace {

/// The cylinder that a section's NAME is, from 0.
std::size_t cylinder_of(const SectionValues& values, int cylinders, const std::string& path) {
  const ParsedNumber number = parse_number(values.name, from(1).up_to(cylinders), "");
  const auto cylinder = static_cast<std::size_t>(number.ok() ? number.value : 0);
  if (!number.ok() || static_cast<double>(cylinder) != number.value) {
    throw InputError(path, values.line,
                     values.title() + ": " + in_quotes(values.name) +
                         " is no cylinder; allowed: whole numbers from 1 to " + std::to_string(cylinders));
  }
  return cylinder - 1;
}

void take_list(const SectionValues& values, const std::string& path, Misfire& misfire) {
  const std::vector<double>& cycles = values.numbers("cycles");
  if (cycles.size() > kMaxListedMisfires) {
    refuse(values, "cycles",
           std::to_string(cycles.size()) + " given; allowed: up to " + std::to_string(kMaxListedMisfires), path);
  }
  for (const double cycle : cycles) {
    const int whole = static_cast<int>(cycle);
    if (static_cast<double>(whole) != cycle) refuse(values, "cycles", shortest(cycle) + " is not a whole number", path);
    if (misfire.cycle_count > 0 && whole <= misfire.cycles[misfire.cycle_count - 1]) {
      refuse(
          values, "cycles",
          shortest(cycle) + " follows " + std::to_string(misfire.cycles[misfire.cycle_count - 1]) + "; they must rise",
          path);
    }
    misfire.cycles[misfire.cycle_count++] = whole;
  }
}

Misfire build_misfire(const SectionValues& values, const std::string& path) {
  Misfire misfire;
  fill(values, misfire);
  if (values.has("cycles")) {
    misfire.pattern = MisfirePattern::listed;
    take_list(values, path, misfire);
  } else if (values.has("random_ratio")) {
    misfire.pattern = MisfirePattern::random;
  } else if (values.has("burst")) {
    misfire.pattern = MisfirePattern::burst;
    misfire.misfires = static_cast<int>(values.number("burst"));
    misfire.of = misfire.misfires + static_cast<int>(values.number("gap"));
    if (misfire.of > kMaxMisfirePeriod)
      refuse(values, "gap", "burst and gap are more than " + std::to_string(kMaxMisfirePeriod) + " cycles together",
             path);
  } else {
    misfire.pattern = MisfirePattern::spread;
    misfire.of = static_cast<int>(values.number(values.has("every") ? "every" : "of_cycles"));
    if (misfire.misfires > misfire.of) {
      refuse(values, "misses",
             std::to_string(misfire.misfires) + " of " + std::to_string(misfire.of) + " cycles cannot misfire", path);
    }
  }
  return misfire;
}

/// "cylinder=2 every=16" as a section of an engine file.
IniSection section_of(const std::string& words) {
  const std::string path = "--misfire " + in_quotes(words);
  IniSection section{"misfire", "", 1, {}};
  for (const std::string_view word : split(words, ' ')) {
    if (trim(word).empty()) continue;
    const std::size_t equals = word.find('=');
    if (equals == std::string_view::npos || equals == 0)
      throw UsageError(path + ": " + in_quotes(word) + " is not KEY=VALUE; write it like 'cylinder=2 every=16'");
    const std::string key(word.substr(0, equals)), value(word.substr(equals + 1));
    if (key == "cylinder") {
      if (!section.name.empty()) throw UsageError(path + ": cylinder is given twice; each cylinder has its own rule");
      section.name = value;
    } else {
      section.entries.push_back({key, value, 1});
    }
  }
  if (section.name.empty())
    throw UsageError(path + ": lacks cylinder=N; write a rule in quotes, like 'cylinder=2 every=16'");
  return section;
}

}  // namespace

void EngineFile::build_misfires() {
  for (const SectionValues& section : sections_) {
    if (section.kind != "misfire") continue;
    Misfire& misfire = definition_.misfires[cylinder_of(section, definition_.layout.cylinders, path_)];
    if (misfire.pattern != MisfirePattern::none)  // [misfire 02] behind [misfire 2]
      throw InputError(path_, section.line, section.title() + ": this cylinder has a rule already");
    misfire = build_misfire(section, path_);
  }
}

void EngineFile::set_misfires(const std::vector<std::string>& orders) {
  std::vector<IniSection> sections;  // all first, so that parts of a rule without quotes are told as that
  for (const std::string& order : orders) sections.push_back(section_of(order));
  bool ruled[kMaxCylinders] = {};  // by this command line, which replaces the file's
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const std::string path = "--misfire " + in_quotes(orders[i]);
    try {
      const SectionValues values = resolve_section(sections[i], path);
      const std::size_t cylinder = cylinder_of(values, definition_.layout.cylinders, path);
      if (ruled[cylinder])
        throw UsageError("--misfire: cylinder " + std::to_string(cylinder + 1) + " has two rules; give it one");
      ruled[cylinder] = true;
      definition_.misfires[cylinder] = build_misfire(values, path);
    } catch (const InputError& error) {
      throw UsageError(without_line_numbers(error.what(), path));
    }
  }
}

bool EngineFile::misfires() const noexcept {
  return std::any_of(std::begin(definition_.misfires), std::end(definition_.misfires),
                     [](const Misfire& misfire) { return misfire.pattern != MisfirePattern::none; });
}

}  // namespace crankloop::program
