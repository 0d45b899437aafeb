#include "ini_text.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "../files/error.hpp"
#include "../files/words.hpp"
#include "problems.hpp"

namespace crankloop::program {
namespace {

constexpr std::string_view kWordCharacters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
constexpr std::size_t kLongestSectionName = 32;

bool is_word(std::string_view text) {
  return !text.empty() && text.find_first_not_of(kWordCharacters) == std::string_view::npos;
}

/// A comment starts at a # at the start of the line or after a blank, because names ("V8 no.#2") and paths may contain
/// a #.
std::string_view without_comment(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '#' && (i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t')) return line.substr(0, i);
  }
  return line;
}

IniSection parse_header(std::string_view text, const std::string& path, int line) {
  // Inside brackets a # has no other meaning than a comment, with or without a blank before it.
  text = trim(text.substr(0, text.find('#')));
  if (text.back() != ']')
    throw InputError(path, line, "section " + in_quotes(text) + " has no closing bracket; write [section]");
  const std::string_view inside = trim(text.substr(1, text.size() - 2));
  const auto blank = inside.find_first_of(" \t");
  IniSection section{std::string(inside.substr(0, blank)), "", line, {}};
  if (blank != std::string_view::npos) section.name = std::string(trim(inside.substr(blank)));
  const bool name_is_fine =
      section.name.empty() || (is_word(section.name) && section.name.size() <= kLongestSectionName);
  if (!is_word(section.kind) || !name_is_fine) {
    throw InputError(path, line,
                     in_quotes(text) +
                         " is not a section; write [section] or [section NAME], NAME of letters, digits, _ and -, " +
                         "at most " + std::to_string(kLongestSectionName));
  }
  return section;
}

IniEntry parse_entry(std::string_view text, const std::string& path, int line) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) {
    throw InputError(path, line, in_quotes(text) + " is neither 'key = value' nor '[section]' nor a comment ('# ...')");
  }
  const std::string_view key = trim(text.substr(0, equals));
  if (key.empty()) throw InputError(path, line, "no key stands before '='; write 'key = value'");
  if (!is_word(key))
    throw InputError(path, line, in_quotes(key) + " is not a key; keys consist of letters, digits and _");
  std::string_view value = trim(text.substr(equals + 1));
  if (!value.empty() && value[0] == '#')
    value = {};  // "name =# text": written again with a blank it would be a comment
  return {std::string(key), std::string(value), line};
}

}  // namespace

IniText parse_ini(const std::vector<std::string>& lines, const std::string& path) {
  IniText ini;
  Problems problems;
  bool any_header = false;  // also an invalid one, which keys may follow
  ini.last_line = std::max(1, static_cast<int>(lines.size()));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const int line = static_cast<int>(i) + 1;
    const std::string_view text = trim(without_comment(lines[i]));
    if (text.empty()) continue;
    problems.of([&] {
      if (text[0] == '[') {
        any_header = true;
        ini.sections.push_back(parse_header(text, path, line));
        return;
      }
      IniEntry entry = parse_entry(text, path, line);
      if (!any_header) {
        any_header = true;  // report it only once
        throw InputError(path, line,
                         "key '" + entry.key + "' stands before the first section; write [section] above it");
      }
      if (!ini.sections.empty()) ini.sections.back().entries.push_back(std::move(entry));
    });
  }
  problems.refuse(path);
  if (ini.sections.empty())
    throw InputError(path, ini.last_line, "the file is empty; an engine file has at least one [section]");
  return ini;
}

}  // namespace crankloop::program
