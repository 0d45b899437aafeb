// resolve_section(): completes the values of a section from its lines.
#include <algorithm>
#include <map>
#include <utility>

#include "../files/error.hpp"
#include "../files/words.hpp"
#include "engine_file_values.hpp"
#include "problems.hpp"

namespace crankloop::program {
namespace {

const Key& known_key(const IniSection& section, const IniEntry& entry, const std::string& path) {
  if (const Key* key = find_key(section.kind, entry.key)) return *key;
  std::vector<std::string> names;
  for (const Key* key : keys_of(section.kind)) names.emplace_back(key->name);
  std::string help = suggestion(entry.key, names);
  if (const std::vector<std::string> homes = sections_with_key(entry.key); !homes.empty())
    help = "; it belongs to " + join(homes, " or ");
  if (help.empty()) help = "; keys: " + join(names);
  throw InputError(path, entry.line, "unknown key " + in_quotes(entry.key) + " in " + section.title() + help);
}

/// The values of a section, and the keys that could not be read.
struct Given {
  SectionValues values;
  std::vector<const Key*> bad;  ///< present, but without a valid value
  bool guessing = false;        ///< the set of required keys depends on a value that could not be read
};

Value read_entry(const IniSection& section, const IniEntry& entry, const SectionValues& before,
                 const std::string& path) {
  const Key& key = known_key(section, entry, path);
  if (before.has(key.name)) {
    throw InputError(path, entry.line,
                     std::string(key.name) + " is given twice in " + section.title() + " (first in line " +
                         std::to_string(before.find(key.name)->line) + "); once is allowed");
  }
  return parse_value(key, entry.value, path, entry.line);
}

Given read_given(const IniSection& section, const std::string& path, Problems& problems) {
  Given given{{section.kind, section.name, section.line, {}}, {}, false};
  for (const IniEntry& entry : section.entries) {
    const std::size_t before = given.values.values.size();
    problems.of([&] { given.values.values.push_back(read_entry(section, entry, given.values, path)); });
    if (given.values.values.size() > before) continue;
    const Key* key = find_key(section.kind, entry.key);
    given.guessing = given.guessing || key == nullptr || key->kind == Kind::choice || key->form[0] != '\0';
    given.bad.push_back(key);
  }
  return given;
}

/// "source=angle_table|volume_table": whether the source is one of them.
bool counts(const Key& key, const SectionValues& values) {
  const std::vector<std::string_view> condition = split(key.only_if, '=');
  if (condition.size() < 2) return true;
  const Value* deciding = values.find(condition[0]);
  if (deciding == nullptr) return true;
  const std::vector<std::string_view> wanted = split(condition[1], '|');
  return std::find(wanted.begin(), wanted.end(), deciding->text) != wanted.end();
}

/// A choice between forms: its name, and the form that the file uses.
struct FormInUse {
  const Value* first_given = nullptr;
  std::vector<std::string> forms;  ///< all of them, in the order of the table
  std::string in_use;              ///< "" where none is
  bool needed = false;
};

/// The default form: one whose keys all have defaults; else "".
std::string form_by_default(const std::string& section, const std::vector<std::string>& forms) {
  for (const std::string& form : forms) {
    const std::vector<const Key*> keys = keys_of(section);
    const bool all = std::all_of(keys.begin(), keys.end(), [&form](const Key* key) {
      return form != key->form || key->presence == Presence::with_default;
    });
    if (all) return form;
  }
  return "";
}

/// Refuses a file with two forms of the same quantity, and one without any.
std::map<std::string, FormInUse> forms_in_use(const SectionValues& values, const std::string& path) {
  std::map<std::string, FormInUse> choices;
  for (const Key* key : keys_of(values.kind)) {
    if (key->form[0] == '\0' || !counts(*key, values)) continue;
    FormInUse& choice = choices[std::string(split(key->form, ':')[0])];
    if (choice.forms.empty() || choice.forms.back() != key->form) choice.forms.emplace_back(key->form);
    choice.needed = choice.needed || key->presence == Presence::required;
  }
  for (const Value& value : values.values) {
    if (value.key->form[0] == '\0' || !value.used) continue;
    FormInUse& choice = choices[std::string(split(value.key->form, ':')[0])];
    const Value* first = choice.first_given;
    if (first != nullptr && first->key->form != std::string_view(value.key->form)) {
      throw InputError(path, value.line,
                       std::string(value.key->name) + " and " + first->key->name + " (line " +
                           std::to_string(first->line) + ") exclude each other; give either " +
                           required_keys(values.kind, first->key->form) + ", or " +
                           required_keys(values.kind, value.key->form));
    }
    if (first == nullptr) choice.first_given = &value;
  }
  for (auto& [name, choice] : choices) {
    choice.in_use =
        choice.first_given != nullptr ? choice.first_given->key->form : form_by_default(values.kind, choice.forms);
    if (!choice.needed || !choice.in_use.empty()) continue;
    std::vector<std::string> ways;
    for (const std::string& form : choice.forms) ways.push_back(required_keys(values.kind, form));
    throw InputError(path, values.line, values.title() + " needs either " + join(ways, ", or "));
  }
  return choices;
}

}  // namespace

SectionValues resolve_section(const IniSection& section, const std::string& path) {
  Problems problems;
  Given given = read_given(section, path, problems);
  if (given.guessing) problems.refuse(path);
  SectionValues& values = given.values;
  for (Value& value : values.values) value.used = counts(*value.key, values);
  std::map<std::string, FormInUse> choices;
  if (!problems.of([&] { choices = forms_in_use(values, path); })) problems.refuse(path);

  std::vector<Value> complete;
  for (const Key* key : keys_of(section.kind)) {
    const auto found = std::find_if(values.values.begin(), values.values.end(),
                                    [key](const Value& value) { return value.key == key; });
    if (found != values.values.end()) {
      complete.push_back(*found);
      continue;
    }
    if (!counts(*key, values) || key->presence == Presence::optional) continue;
    if (key->form[0] != '\0' && choices.at(std::string(split(key->form, ':')[0])).in_use != key->form) continue;
    if (key->presence == Presence::with_default) {
      complete.push_back(parse_value(*key, key->fallback, path, 0));
      continue;
    }
    if (std::find(given.bad.begin(), given.bad.end(), key) != given.bad.end()) continue;
    const std::string allowed = key->allowed();
    problems.of([&] {
      throw InputError(path, section.line,
                       section.title() + " lacks " + key->name + " (" + key->meaning + (allowed.empty() ? "" : "; ") +
                           allowed + ")" +
                           (key->only_if[0] == '\0' ? "" : std::string(", needed with ") + key->only_if));
    });
    if (key->kind == Kind::choice) break;  // the set of required keys depends on it
  }
  problems.refuse(path);
  values.values = std::move(complete);
  return std::move(given.values);
}

}  // namespace crankloop::program
