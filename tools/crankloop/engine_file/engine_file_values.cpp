#include "engine_file_values.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <crankloop/define/layout.hpp>

#include "../files/error.hpp"
#include "../files/words.hpp"

namespace crankloop::program {
namespace {

constexpr std::size_t kLongestList = 64;  // no key needs more; limits the length of messages about hostile files

double number_in_range(const Key& key, std::string_view text, const std::string& path, int line,
                       const std::string& where) {
  const ParsedNumber number = parse_number(text, key.range, unit_in_words(key.unit.name));
  const std::string word = key.choices[0] == '\0' ? "" : std::string("; the word ") + key.choices + " is allowed too";
  if (!number.ok()) throw InputError(path, line, std::string(key.name) + ": " + where + number.problem + word);
  return number.value;
}

/// Cylinder numbers joined by '-'.
std::vector<int> cylinder_numbers(const Key& key, std::string_view text, const std::string& path, int line) {
  std::vector<int> cylinders;
  for (const std::string_view part : split(text, '-')) {
    const ParsedNumber number = parse_number(part);
    const bool in_range = number.ok() && number.value >= 1 && number.value <= kMaxCylinders;
    if (!in_range || number.value != std::floor(number.value) || cylinders.size() >= kLongestList) {
      throw InputError(path, line,
                       std::string(key.name) + ": " + in_quotes(text) + " does not consist of cylinder numbers (1 to " +
                           std::to_string(kMaxCylinders) + "); write it " + key.allowed());
    }
    cylinders.push_back(static_cast<int>(number.value));
  }
  return cylinders;
}

std::string choice_of(const Key& key, std::string_view text, const std::string& path, int line) {
  std::vector<std::string> choices;
  for (const std::string_view one : split(key.choices, '|')) choices.emplace_back(one);
  if (std::find(choices.begin(), choices.end(), text) == choices.end()) {
    throw InputError(
        path, line,
        std::string(key.name) + ": " + in_quotes(text) + " is not one of " + join(choices) + suggestion(text, choices));
  }
  return std::string(text);
}

}  // namespace

Value parse_value(const Key& key, std::string_view text, const std::string& path, int line) {
  Value value{&key, line, true, "", {}, {}};
  const bool free_text = key.kind == Kind::text || key.kind == Kind::path;
  if (!free_text) text = trim(text.substr(0, text.find('#')));  // "95# bore": only free text may contain a #
  if (text.empty()) {
    const std::string allowed = key.allowed();
    throw InputError(path, line,
                     std::string(key.name) + " has no value" + (allowed.empty() ? "" : "; allowed: " + allowed));
  }
  switch (key.kind) {
    case Kind::text:
    case Kind::path:
      value.text = std::string(text);
      break;
    case Kind::choice:
      value.text = choice_of(key, text, path, line);
      break;
    case Kind::whole_number:
    case Kind::number:
      if (!text.empty() && text == key.choices) {
        value.text = key.choices;
        break;
      }
      value.numbers.push_back(number_in_range(key, text, path, line, ""));
      if (key.kind == Kind::whole_number && value.numbers[0] != std::floor(value.numbers[0])) {
        throw InputError(
            path, line,
            std::string(key.name) + ": " + in_quotes(text) + " is not a whole number; allowed: " + key.allowed());
      }
      break;
    case Kind::numbers:
      for (const std::string_view part : split(text, ',')) {
        const std::string where = "entry " + std::to_string(value.numbers.size() + 1) + ": ";
        value.numbers.push_back(number_in_range(key, part, path, line, where));
        if (value.numbers.size() > kLongestList)
          throw InputError(path, line, std::string(key.name) + ": the list is too long");
      }
      break;
    case Kind::pairs:
      for (const std::string_view part : split(text, ',')) {
        const std::string where = "entry " + std::to_string(value.numbers.size() / 2 + 1) + ": ";
        const std::vector<std::string_view> pair = split(part, ':');
        if (pair.size() != 2) {
          throw InputError(
              path, line,
              std::string(key.name) + ": " + where + in_quotes(trim(part)) + " is no pair; allowed: " + key.allowed());
        }
        for (const std::string_view one : pair)
          value.numbers.push_back(number_in_range(key, trim(one), path, line, where));
        if (value.numbers.size() > kLongestList)
          throw InputError(path, line, std::string(key.name) + ": the list is too long");
      }
      break;
    case Kind::firing_order:
      value.groups.push_back(cylinder_numbers(key, text, path, line));
      break;
    case Kind::pin_groups:
      for (const std::string_view part : split(text, ','))
        value.groups.push_back(cylinder_numbers(key, part, path, line));
      break;
  }
  return value;
}

std::string format_value(const Value& value) {
  std::vector<std::string> parts;
  if (value.key != nullptr && value.key->kind == Kind::pairs) {
    for (std::size_t i = 0; i + 1 < value.numbers.size(); i += 2)
      parts.push_back(shortest(value.numbers[i]) + ":" + shortest(value.numbers[i + 1]));
    return join(parts, ",");
  }
  for (const double number : value.numbers) parts.push_back(shortest(number));
  for (const std::vector<int>& group : value.groups) {
    std::vector<std::string> cylinders;
    for (const int cylinder : group) cylinders.push_back(std::to_string(cylinder));
    parts.push_back(join(cylinders, "-"));
  }
  return value.text + join(parts, ",");
}

const Value* SectionValues::find(std::string_view key) const {
  for (const Value& value : values) {
    if (value.used && key == value.key->name) return &value;
  }
  return nullptr;
}

const Value* SectionValues::of_field(std::string_view field) const {
  for (const Value& value : values) {
    if (value.used && field == value.key->field) return &value;
  }
  return nullptr;
}

const Value& SectionValues::at(std::string_view key) const {
  const Value* value = find(key);
  if (value == nullptr) throw std::logic_error(title() + " has no " + std::string(key));
  return *value;
}

int SectionValues::line_of(std::string_view key) const {
  const Value* value = find(key);
  return value != nullptr && value->line > 0 ? value->line : std::max(line, 1);
}

void SectionValues::choose(std::string_view key, double number) {
  for (Value& value : values) {
    if (key != value.key->name || !value.is_open()) continue;
    value.text.clear();
    value.numbers = {number};
    value.automatic = true;
  }
}

void SectionValues::derive(std::string_view key, Value value) {
  value.key = find_key(kind, std::string(key));
  const auto next =
      std::find_if(values.begin(), values.end(), [&value](const Value& other) { return other.key > value.key; });
  values.insert(next, std::move(value));
}

}  // namespace crankloop::program
