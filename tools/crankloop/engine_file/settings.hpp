// Other values for keys of an engine file, as a study varies them: put in place of those in the text before it is read,
// so that they are checked as if the file had them.
//
// What belongs here: names of keys, and values in their places. What does not: which values a study takes
// (command_line/variation.hpp).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine_file_keys.hpp"
#include "ini_text.hpp"

namespace crankloop::program {

class EngineFile;

/// One key of one section.
struct KeyPlace {
  std::string kind;  ///< "cam"
  std::string name;  ///< "intake"; empty in [crank]
  const Key* key = nullptr;
  std::size_t entry = 0;  ///< of a list, from 1; 0: the whole value

  [[nodiscard]] std::string title() const { return name.empty() ? kind : kind + " " + name; }
  [[nodiscard]] std::string text() const;  ///< "cam.intake.exponents.2"
};

struct Setting {
  KeyPlace place;
  std::string value;  ///< as in a file
};

/// "crank.bore_mm", "cam.intake.exponents.2"; "cam.max_lift_mm" where the file has but one [cam NAME]. Throws
/// InputError for what the file cannot have.
[[nodiscard]] KeyPlace find_place(std::string_view text, const EngineFile& file);

/// The key's value as text, also a default; empty where it has none. Of crank.rod_ratio that of the rod's length.
[[nodiscard]] std::string value_at(const KeyPlace& place, const EngineFile& file);

/// Whether one value undoes the other: two of one key, a list and an entry of it, the rod's length and its ratio.
[[nodiscard]] bool undoes(const KeyPlace& a, const KeyPlace& b) noexcept;

/// Whether the file uses the key: not where another source or form excludes it.
[[nodiscard]] bool uses(const EngineFile& file, const KeyPlace& place);

/// Replaces values, and adds keys and sections that the text lacks. With crank.rod_ratio the rod's length follows: the
/// stroke stays. Throws InputError for an entry that a list does not have.
void apply(const std::vector<Setting>& settings, IniText& ini, const std::string& path);

}  // namespace crankloop::program
