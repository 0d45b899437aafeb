#include "answers.hpp"

#include <cstddef>
#include <utility>

#include <crankloop/fmi/name.hpp>

#include "crankloop/files/words.hpp"

namespace crankloop::page {
namespace {

/// The line of "PATH:LINE: ..."; 0 where the message names none of this file.
int line_of(std::string_view message, std::string_view path) {
  const std::string begin = std::string(path) + ":";
  if (message.substr(0, begin.size()) != begin) return 0;
  int line = 0;
  for (const char c : message.substr(begin.size())) {
    if (c == ':') return line;
    if (c < '0' || c > '9') return 0;
    line = line * 10 + (c - '0');
  }
  return 0;
}

std::vector<std::string> lines_of(const char* text) {
  std::vector<std::string> lines;
  for (const std::string_view line : program::split(text, '\n')) lines.emplace_back(line);
  return lines;
}

}  // namespace

const char* answer(std::string text) {
  static std::string last;
  last = std::move(text);
  return last.c_str();
}

void add_messages(Json& json, const char* key, const std::vector<std::string>& lines, const std::string& path) {
  json.key(key).open('[');
  for (const std::string& line : lines)
    json.open('{').member("line", line_of(line, path)).member("text", line).close('}');
  json.close(']');
}

void add_variable(Json& json, const detail::Variable& variable) {
  const std::string base = variable.name;
  const std::size_t hash = base.find('#');
  const bool two = hash != std::string::npos && base.find('#', hash + 1) != std::string::npos;
  const detail::UnitOfName& unit = detail::unit_of(variable);
  constexpr const char* kKinds[] = {"real", "whole", "truth"};
  json.member("name", fmi::name_of(variable)).member("base", base);
  json.member("first", hash == std::string::npos ? 0 : variable.first + 1)
      .member("second", two ? variable.second + 1 : 0);
  json.member("unit", unit.written).member("shown_unit", unit.displayed);
  json.member("shown_per_unit", unit.displayed_per_written).member("kind", kKinds[static_cast<int>(variable.kind)]);
  json.member("meaning", variable.meaning);
}

const char* answer_failure(const std::string& path, const char* what) {
  Json json;
  json.open('{');
  add_messages(json, "errors", lines_of(what), path);
  add_messages(json, "warnings", {}, path);
  return answer(json.close('}').text());
}

}  // namespace crankloop::page
