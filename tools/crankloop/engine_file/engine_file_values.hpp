// The values of one section: typed, in range, with defaults filled in, each with the line it came from.
//
// What belongs here: rules within one section. What does not: rules between sections (engine_file_parts.hpp).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine_file_keys.hpp"
#include "ini_text.hpp"

namespace crankloop::program {

struct Value {
  const Key* key = nullptr;
  int line = 0;                          ///< 0: a default or derived
  bool used = true;                      ///< false: belongs to a form or source that is not chosen
  std::string text;                      ///< choice, text, path, the word in place of a number
  std::vector<double> numbers;           ///< number, whole_number (one each), numbers, pairs (two each)
  std::vector<std::vector<int>> groups;  ///< firing_order (one group), pin_groups; cylinders counted from 1
  bool automatic = false;                ///< a number that the program chose where the file has a word

  /// True for a number that the file replaces by a word, such as auto, until it is computed.
  [[nodiscard]] bool is_open() const noexcept { return key->kind == Kind::number && numbers.empty(); }
  [[nodiscard]] double si() const {
    return numbers.at(0) * key->unit.times / key->unit.over;
  }  ///< angles stay in degrees
};

/// Reads the text after `key =`; throws InputError at path:line.
[[nodiscard]] Value parse_value(const Key& key, std::string_view text, const std::string& path, int line);

/// The value as text for a file; parse_value() returns the same value, bit for bit.
[[nodiscard]] std::string format_value(const Value& value);

struct SectionValues {
  std::string kind;
  std::string name;
  int line = 0;               ///< of its header; 0: the section is not in the file, all is default
  std::vector<Value> values;  ///< in the order of the key table

  [[nodiscard]] std::string title() const { return name.empty() ? "[" + kind + "]" : "[" + kind + " " + name + "]"; }

  [[nodiscard]] const Value* find(std::string_view key) const;  ///< nullptr: not given and no default, or not used
  [[nodiscard]] const Value* of_field(
      std::string_view field) const;  ///< of the key that is this field; nullptr as for find()
  [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
  [[nodiscard]] const std::string& text(std::string_view key) const { return at(key).text; }
  [[nodiscard]] double number(std::string_view key) const { return at(key).numbers.at(0); }  ///< in the file's unit
  [[nodiscard]] double si(std::string_view key) const { return at(key).si(); }
  [[nodiscard]] const std::vector<double>& numbers(std::string_view key) const { return at(key).numbers; }

  /// Line for messages about a key: its own if it is in the file, otherwise the section's.
  [[nodiscard]] int line_of(std::string_view key) const;

  /// Gives an open number its value.
  void choose(std::string_view key, double number);

  /// Fills in what follows from other keys, for `show`; keeps the table's order.
  void derive(std::string_view key, Value value);

 private:
  [[nodiscard]] const Value& at(
      std::string_view key) const;  ///< throws std::logic_error if it is absent: a defect of the caller
};

[[nodiscard]] SectionValues resolve_section(const IniSection& section, const std::string& path);

}  // namespace crankloop::program
