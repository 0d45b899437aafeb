#include "engine_source.hpp"

#include <algorithm>
#include <map>

#include <crankloop/tick/state/saved_bytes.hpp>

#include "../../files/table_file.hpp"
#include "../../files/text_file.hpp"
#include "../../files/words.hpp"

namespace crankloop::program {
namespace {

constexpr const char* kEngineName = "engine.ini";
constexpr const char* kTickName = "tick_us.txt";
constexpr Range kTicks_us = from(1).up_to(2000);
/// A function, not a constant: a loaded object must not run constructors of this code.
std::vector<std::string> needed() { return {"engine", "crank", "masses"}; }

std::string bytes_of(const std::string& path, std::size_t most) {
  FileBytes file = read_file(path, most);
  if (!file.ok()) throw InputError(path + ": " + file.problem);
  return std::move(file.bytes);
}

/// Whether a parameter may be set: a number that determines no other structure, and that an FMU steps by.
bool is_parameter(const SectionValues& section, const Value& value) {
  const std::string_view name = value.key->name;
  for (const char* of_surge : {"surge_damping_ratio", "spring_active_g", "inner_spring_N_per_mm", "inner_spring_g"})
    if (name == of_surge) return false;
  return value.used && value.key->kind == Kind::number && section.kind != "engine";
}

/// Units of keys that no variable of the library has.
constexpr UnitOfName kUnitsOfKeys[] = {
    {"C", "degC", 0, 0, 0, 1, 0},        {"cm3", "cm3", 0, 3, 0, 0, 0, 1e-6},
    {"mg", "mg", 1, 0, 0, 0, 0, 1e-6},   {"J_per_K", "J/K", 1, 2, -2, -1, 0},
    {"W_per_K", "W/K", 1, 2, -3, -1, 0}, {"MJ_per_kg", "MJ/kg", 0, 2, -2, 0, 0, 1e6},
};

/// The whole unit of a key: a part of it, such as the K of W_per_K, is another.
const UnitOfName& unit_of_key(std::string_view name) {
  if (name.empty()) return detail::kNoUnit;
  for (const UnitOfName& unit : kUnitsOfKeys) {
    if (unit.suffix == name) return unit;
  }
  const std::string end = "_" + std::string(name);
  const UnitOfName& unit = detail::unit_of(end);
  return unit.suffix == end ? unit : detail::kNoUnit;
}

/// The file complete, as `show` has it without its comments. word_of(section, value) is what stands behind the key.
template <class WordOf>
std::string text_of(const EngineFile& engine, const WordOf& word_of) {
  std::string text;
  for (const SectionValues& section : engine.sections()) {
    text += (text.empty() ? "" : "\n") + section.title() + "\n";
    for (const Value& value : section.values) {
      if (value.used) text += std::string(value.key->name) + " = " + word_of(section, value) + "\n";
    }
  }
  return text;
}

/// A user's name as part of a variable's name: letters, digits and _.
std::string as_identifier(std::string name) {
  for (char& c : name) {
    const bool good = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!good) c = '_';
  }
  return name.empty() || (name[0] >= '0' && name[0] <= '9') ? "_" + name : name;
}

/// Hash of the resources' bytes: engine.ini, and the tables that the engine reads.
std::uint64_t identity_of(const std::string& engine_ini, const EngineFile& engine) {
  std::string tables;
  for (const SectionValues& section : engine.sections()) {
    for (const Value& value : section.values) {
      if (value.used && value.key->kind == Kind::path)
        tables += bytes_of(in_folder(folder_of(engine.path()), value.text), kMaxTableBytes);
    }
  }
  const auto crc = [](const std::string& bytes) {
    return std::uint64_t{detail::crc32_of(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size())};
  };
  return crc(engine_ini) << 32 | crc(tables);
}

}  // namespace

EngineSource::EngineSource(const std::string& folder)
    : path_(in_folder(folder, kEngineName)), file_(read_engine_file(path_, needed())) {
  const std::string tick_path = in_folder(folder, kTickName);
  const std::string tick = bytes_of(tick_path, std::size_t{1} << 20);
  const ParsedNumber tick_us = parse_number(trim(split(tick, '\n')[0]), kTicks_us, "us");
  if (!tick_us.ok()) throw InputError(tick_path, 1, tick_us.problem);
  tick_s_ = millionths(tick_us.value);
  identity_ = identity_of(bytes_of(path_, kMaxEngineFileBytes), file_);
  collect_numbers();
}

EngineSource::EngineSource(const EngineFile& engine, double tick_us)
    : path_(engine.path()),
      file_(read_engine_text(
          text_of(engine, [](const SectionValues&, const Value& value) { return format_value(value); }), path_,
          needed())),
      tick_s_(millionths(tick_us)) {
  for (const ZipEntry& entry : resources_of(engine, tick_us)) {
    if (entry.name == kEngineName) identity_ = identity_of(entry.bytes, file_);
  }
  collect_numbers();
}

void EngineSource::collect_numbers() {
  for (const SectionValues& section : file_.sections()) {
    const std::string part = section.name.empty() ? section.kind : section.kind + "." + as_identifier(section.name);
    for (const Value& value : section.values) {
      if (!is_parameter(section, value)) continue;
      const std::string_view unit = value.key->unit.name;
      std::string name = "engine." + part + "." + value.key->name;
      const auto taken = [&name](const EngineNumber& other) { return other.name == name; };
      while (std::any_of(numbers_.begin(), numbers_.end(), taken)) name += "_";  // names that differ only in blanks
      numbers_.push_back({name, value.key, &unit_of_key(unit), value.numbers.at(0)});
    }
  }
}

EngineFile EngineSource::with(const double* values) const {
  std::size_t next = 0;
  const std::string text = text_of(file_, [&](const SectionValues& section, const Value& value) {
    if (is_parameter(section, value)) return shortest(values[next++]);
    return format_value(value);
  });
  return read_engine_text(text, path_, needed());
}

std::vector<ZipEntry> resources_of(const EngineFile& engine, double tick_us) {
  std::vector<ZipEntry> entries;
  const std::string folder = folder_of(engine.path());
  const std::string text = text_of(engine, [&](const SectionValues&, const Value& value) {
    if (value.key->kind != Kind::path) return format_value(value);
    const std::string name = "table_" + std::to_string(entries.size() + 1) + ".csv";
    entries.push_back({name, bytes_of(in_folder(folder, value.text), kMaxTableBytes)});
    return name;
  });
  entries.push_back({kEngineName, text});
  entries.push_back({kTickName, shortest(tick_us) + "\n"});
  return entries;
}

}  // namespace crankloop::program
