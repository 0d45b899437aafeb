// The texts that the exports answer: objects with their messages, lists, variables.
//
// What belongs here: how an answer is made, and the one that the caller still reads. What does not: what it is about
// (module.cpp), JSON (json.hpp).
#pragma once

#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include <crankloop/variable.hpp>

#include "json.hpp"

namespace crankloop::page {

/// Keeps the text until the next answer.
[[nodiscard]] const char* answer(std::string text);

/// `key`: a list of the lines, each with its place in the engine file `path`.
void add_messages(Json& json, const char* key, const std::vector<std::string>& lines, const std::string& path);

/// Name, unit, kind and meaning, into an object that is open.
void add_variable(Json& json, const detail::Variable& variable);

/// {"errors": [...], "warnings": []}; the lines of `what` are the errors.
[[nodiscard]] const char* answer_failure(const std::string& path, const char* what);

/// Answers what `work` adds to an object that has "errors"; where it throws, that alone.
template <class Work>
[[nodiscard]] const char* answer_or_errors(const std::string& path, const Work& work) {
  try {
    Json json;
    json.open('{');
    add_messages(json, "errors", {}, path);
    work(json);
    return answer(json.close('}').text());
  } catch (const std::exception& error) {
    return answer_failure(path, error.what());
  }
}

/// A list, of what `add` writes of each entry.
template <class List, class Add>
[[nodiscard]] const char* list_of(const List& list, const Add& add) {
  Json json;
  json.open('[');
  for (const auto& entry : list) add(json, entry);
  return answer(json.close(']').text());
}

}  // namespace crankloop::page
