#include "variation.hpp"

#include <algorithm>

#include "../files/error.hpp"
#include "../files/number.hpp"
#include "../files/words.hpp"
#include "grid.hpp"

namespace crankloop::program {
namespace {

constexpr const char* kForm = "; write NAME=FROM:TO:N or NAME=A,B,C, like cam.max_lift_mm=6:8:11 or rpm=2000:6000:9";

bool is_list(Kind kind) {
  return kind == Kind::numbers || kind == Kind::pairs || kind == Kind::firing_order || kind == Kind::pin_groups;
}

bool is_number(const Target& target) {
  if (!target.key)
    return target.option->kind == Option::Kind::number || target.option->kind == Option::Kind::whole_number;
  const Kind kind = target.key->key->kind;
  return kind == Kind::number || kind == Kind::whole_number || target.key->entry > 0;
}

/// What stands between the values of a list of them.
char separator_of(const Target& target) {
  return target.key && target.key->entry == 0 && is_list(target.key->key->kind) ? '/' : ',';
}

const Option& option_of(std::string_view name, const std::vector<const Option*>& options) {
  std::vector<std::string> names;
  for (const Option* option : options) {
    names.emplace_back(option->name + 2);  // without the dashes
    if (names.back() == name) return *option;
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  const std::string guess = suggestion(name, names);
  throw UsageError(in_quotes(name) + " is neither SECTION.KEY of the engine file nor an option of the commands" +
                   (!guess.empty()  ? guess
                    : names.empty() ? ""
                                    : "; options: " + join(names)));
}

Target target_of(std::string_view name, const EngineFile& file, const std::vector<const Option*>& options) {
  if (name.find('.') != std::string_view::npos) return {find_place(name, file), nullptr};
  return {{}, &option_of(name, options)};
}

/// Numbers of all values; none where one of them is a word.
std::vector<double> numbers_of(const std::vector<std::string>& values) {
  std::vector<double> numbers;
  for (const std::string& value : values) {
    const ParsedNumber number = parse_number(value);
    if (!number.ok()) return {};
    numbers.push_back(number.value);
  }
  return numbers;
}

std::vector<std::string> listed(const std::string& name, std::string_view text, char separator) {
  std::vector<std::string> values;
  for (const std::string_view value : split(text, separator)) {
    if (value.empty()) throw UsageError(name + ": a value is missing" + kForm);
    values.emplace_back(value);
  }
  if (values.size() > static_cast<std::size_t>(kMaxValues))
    throw UsageError(name + ": too many values; allowed: " + std::to_string(kMaxValues));
  return values;
}

struct NameAndRest {
  std::string name;
  std::string rest;
};

NameAndRest split_name(const std::string& text, const char* form) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw UsageError(in_quotes(text) + " has no name or no value" + form);
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace

std::string Target::name() const { return key ? key->text() : option->name + 2; }

std::string Target::unit() const { return key ? unit_in_words(key->key->unit.name) : ""; }

std::string Target::title() const {
  if (!key) return std::string(option->name).substr(2);  // without "--"
  std::string words = key->key->name;
  const std::string suffix = std::string("_") + key->key->unit.name;
  if (suffix.size() > 1 && words.size() > suffix.size() &&
      words.compare(words.size() - suffix.size(), suffix.size(), suffix) == 0)
    words.resize(words.size() - suffix.size());
  std::replace(words.begin(), words.end(), '_', ' ');
  return words + (key->entry > 0 ? " " + std::to_string(key->entry) : "") + " of [" + key->title() + "]";
}

Variation parse_variation(const std::string& text, const EngineFile& file, const std::vector<const Option*>& options) {
  const NameAndRest given = split_name(text, kForm);
  Variation variation;
  variation.target = target_of(given.name, file, options);
  const Target& target = variation.target;
  if (is_number(target) && given.rest.find(':') != std::string::npos) {
    const Range range = target.key ? target.key->key->range : target.option->range;
    const Grid grid = parse_grid(given.name, given.rest, range, kMaxValues, "6:8:11");
    variation.numbers = grid.values();
    for (const double number : variation.numbers) variation.values.push_back(shortest(number));
  } else {
    variation.values = listed(given.name, given.rest, separator_of(target));
    if (is_number(target)) variation.numbers = numbers_of(variation.values);
  }
  variation.own = target.key                           ? value_at(*target.key, file)
                  : target.option->fallback != nullptr ? target.option->fallback
                                                       : "";
  const ParsedNumber own = parse_number(variation.own);
  if (!variation.is_of_words() && own.ok()) variation.own_number = own.value;
  return variation;
}

Constant parse_constant(const std::string& text, const EngineFile& file, const std::vector<const Option*>& options) {
  const NameAndRest given = split_name(text, "; write NAME=VALUE, like rpm=7000 or cam.source=table");
  return {target_of(given.name, file, options), given.rest};
}

void require_used(const EngineFile& file, const KeyPlace& place) {
  if (uses(file, place)) return;
  throw InputError(file.path() + ": " + place.text() + " is not used" +
                   (place.key->only_if[0] == '\0' ? "" : std::string("; it is only with ") + place.key->only_if));
}

}  // namespace crankloop::program
