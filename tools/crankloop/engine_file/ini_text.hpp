// An engine file's text as sections and entries with their line numbers; no meaning yet.
//
// What belongs here: brackets, equals signs, comments. What does not: which sections and keys exist
// (engine_file_keys.hpp).
#pragma once

#include <string>
#include <vector>

namespace crankloop::program {

struct IniEntry {
  std::string key;
  std::string value;  ///< trimmed; a comment (# at the start or after a blank) is cut off
  int line;
};

struct IniSection {
  std::string kind;  ///< "cam" in [cam intake]
  std::string name;  ///< "intake"; empty in [crank]
  int line;
  std::vector<IniEntry> entries;

  [[nodiscard]] std::string title() const { return name.empty() ? "[" + kind + "]" : "[" + kind + " " + name + "]"; }
};

struct IniText {
  std::vector<IniSection> sections;
  int last_line = 1;
};

/// Throws InputError for what is not `[section]`, `[section NAME]`, `key = value`, a comment or a blank line, and for
/// an empty file.
[[nodiscard]] IniText parse_ini(const std::vector<std::string>& lines, const std::string& path);

}  // namespace crankloop::program
