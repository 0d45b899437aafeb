#include "settings.hpp"

#include <algorithm>

#include "../files/error.hpp"
#include "../files/number.hpp"
#include "../files/words.hpp"
#include "engine_file.hpp"

namespace crankloop::program {
namespace {

bool is_rod_ratio(const KeyPlace& place) {
  return place.kind == "crank" && std::string_view(place.key->name) == "rod_ratio";
}

/// A whole number from 1; 0 for anything else.
std::size_t entry_number(std::string_view text) {
  const ParsedNumber number = parse_number(text);
  if (!number.ok() || number.value < 1 || number.value > 64) return 0;
  const auto entry = static_cast<std::size_t>(number.value);
  return static_cast<double>(entry) == number.value ? entry : 0;
}

const SectionKind& kind_of(std::string_view word, const EngineFile& file) {
  if (const SectionKind* kind = find_section_kind(std::string(word))) return *kind;
  std::vector<std::string> names;
  for (const SectionKind& known : section_kinds()) names.emplace_back(known.name);
  const std::string guess = suggestion(word, names);
  throw InputError(file.path() + ": engine files have no section " + in_quotes(word) +
                   (guess.empty() ? "; sections: " + join(names) : guess));
}

/// The NAME that a place leaves out.
std::string only_name(const SectionKind& kind, std::string_view text, const EngineFile& file) {
  std::vector<std::string> names;
  for (const SectionValues& section : file.sections()) {
    if (section.kind == kind.name) names.push_back(section.name);
  }
  if (names.size() == 1) return names[0];
  if (names.empty()) throw InputError(file.path() + ": has no [" + kind.name + " NAME] for " + std::string(text));
  const std::string rest(text.substr(text.find('.')));
  for (std::string& name : names) name = std::string(kind.name) + "." + name + rest;
  throw InputError(file.path() + ": " + std::string(text) + " could be any of " + join(names) + "; name one");
}

const Key& key_of(const SectionKind& kind, std::string_view word, const EngineFile& file) {
  if (const Key* key = find_key(kind.name, std::string(word))) return *key;
  std::vector<std::string> names;
  for (const Key* key : keys_of(kind.name)) names.emplace_back(key->name);
  const std::string guess = suggestion(word, names);
  throw InputError(file.path() + ": [" + kind.name + "] has no key " + in_quotes(word) +
                   (guess.empty() ? "; keys: " + join(names) : guess));
}

IniSection& section_at(const KeyPlace& place, IniText& ini) {
  const auto found = std::find_if(ini.sections.begin(), ini.sections.end(), [&place](const IniSection& section) {
    return section.kind == place.kind && section.name == place.name;
  });
  if (found != ini.sections.end()) return *found;
  ini.sections.push_back({place.kind, place.name, ini.last_line, {}});
  return ini.sections.back();
}

std::string with_entry(const std::string& list, std::size_t entry, const std::string& value) {
  std::vector<std::string> parts;
  for (const std::string_view part : split(list, ',')) parts.emplace_back(part);
  if (entry > parts.size())
    throw InputError("it has " + std::to_string(parts.size()) + " entries, and none is number " +
                     std::to_string(entry));
  parts[entry - 1] = value;
  return join(parts, ",");
}

void put(const KeyPlace& place, const std::string& value, IniText& ini, const std::string& path) {
  IniSection& section = section_at(place, ini);
  const auto found = std::find_if(section.entries.begin(), section.entries.end(),
                                  [&place](const IniEntry& entry) { return entry.key == place.key->name; });
  if (found == section.entries.end()) {
    if (place.entry > 0)
      throw InputError(path, section.line, place.text() + ": the file has no " + place.key->name + " there");
    section.entries.push_back({place.key->name, value, section.line});
    return;
  }
  try {
    found->value = place.entry > 0 ? with_entry(found->value, place.entry, value) : value;
  } catch (const InputError& refused) {
    throw InputError(path, found->line, place.text() + ": " + refused.what());
  }
}

std::string text_in(const IniSection& section, std::string_view key) {
  for (const IniEntry& entry : section.entries) {
    if (entry.key == key) return entry.value;
  }
  return "";
}

/// The rod's length of this ratio; nothing where one of them is no number, which the reader then refuses.
void put_rod_length(const KeyPlace& ratio_place, const std::string& ratio_text, IniText& ini, const std::string& path) {
  const ParsedNumber stroke_mm = parse_number(text_in(section_at(ratio_place, ini), "stroke_mm"));
  const ParsedNumber ratio = parse_number(ratio_text);
  if (!stroke_mm.ok() || !ratio.ok() || !(ratio.value > 0)) return;
  put({"crank", "", find_key("crank", "rod_length_mm"), 0}, shortest(stroke_mm.value / 2 / ratio.value), ini, path);
}

}  // namespace

std::string KeyPlace::text() const {
  return kind + (name.empty() ? "" : "." + name) + "." + key->name + (entry == 0 ? "" : "." + std::to_string(entry));
}

KeyPlace find_place(std::string_view text, const EngineFile& file) {
  std::vector<std::string_view> parts = split(text, '.');
  const SectionKind& kind = kind_of(parts[0], file);
  parts.erase(parts.begin());
  KeyPlace place{kind.name, "", nullptr, 0};
  if (parts.size() > 1 && entry_number(parts.back()) > 0) {
    place.entry = entry_number(parts.back());
    parts.pop_back();
  }
  if (kind.named && parts.size() > 1) {
    place.name = std::string(parts[0]);
    parts.erase(parts.begin());
  } else if (kind.named) {
    place.name = only_name(kind, text, file);
  }
  if (parts.size() != 1)
    throw InputError(file.path() + ": " + in_quotes(text) + " is no key; write SECTION.KEY or SECTION.NAME.KEY");
  place.key = &key_of(kind, parts[0], file);
  if (kind.named && !file.has(place.title())) throw InputError(file.path() + ": has no [" + place.title() + "]");
  if (place.entry > 0 && place.key->kind != Kind::numbers)
    throw InputError(file.path() + ": " + place.key->name + " is no list of numbers, so it has no entry " +
                     std::to_string(place.entry));
  return place;
}

std::string value_at(const KeyPlace& place, const EngineFile& file) {
  if (!file.has(place.title())) return "";
  if (is_rod_ratio(place)) return shortest(file.definition().crank.rod_ratio());
  const Value* value = file.section(place.title()).find(place.key->name);
  if (value == nullptr) return "";
  if (place.entry == 0) return value->automatic ? place.key->choices : format_value(*value);
  return place.entry <= value->numbers.size() ? shortest(value->numbers[place.entry - 1]) : "";
}

bool undoes(const KeyPlace& a, const KeyPlace& b) noexcept {
  const auto sets_rod = [](const KeyPlace& place) {
    return is_rod_ratio(place) || (place.kind == "crank" && std::string_view(place.key->name) == "rod_length_mm");
  };
  if (sets_rod(a) && sets_rod(b)) return true;
  return a.kind == b.kind && a.name == b.name && a.key == b.key && (a.entry == b.entry || a.entry == 0 || b.entry == 0);
}

bool uses(const EngineFile& file, const KeyPlace& place) {
  return file.has(place.title()) && file.section(place.title()).has(place.key->name);
}

void apply(const std::vector<Setting>& settings, IniText& ini, const std::string& path) {
  for (const Setting& setting : settings) put(setting.place, setting.value, ini, path);
  for (const Setting& setting : settings) {  // after a stroke that is set too
    if (is_rod_ratio(setting.place)) put_rod_length(setting.place, setting.value, ini, path);
  }
}

}  // namespace crankloop::program
