// A small reader of XML: elements with attributes, in order; and the fault that stopped it, if any.
//
// What belongs here: what tests of pages and pictures need to find their way. What does not: entities but the common
// five, comments, declarations.
#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace crankloop::support {

struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;  // directly inside
};

struct Markup {
  std::vector<Element> elements;
  std::string fault;

  std::vector<Element> all(const std::string& name) const {
    std::vector<Element> found;
    std::copy_if(elements.begin(), elements.end(), std::back_inserter(found),
                 [&](const Element& element) { return element.name == name; });
    return found;
  }
  /// Elements one of whose classes is `wanted`.
  std::vector<Element> of_class(const std::string& wanted) const {
    std::vector<Element> found;
    for (const Element& element : elements) {
      const auto it = element.attributes.find("class");
      if (it != element.attributes.end() && (' ' + it->second + ' ').find(' ' + wanted + ' ') != std::string::npos) {
        found.push_back(element);
      }
    }
    return found;
  }
};

inline bool has_bare_ampersand(const std::string& text) {
  static const std::array<std::string, 5> kEntities{"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  for (std::size_t at = text.find('&'); at != std::string::npos; at = text.find('&', at + 1)) {
    if (std::none_of(kEntities.begin(), kEntities.end(),
                     [&](const std::string& entity) { return text.compare(at, entity.size(), entity) == 0; })) {
      return true;
    }
  }
  return false;
}

inline Markup read(const std::string& source) {
  Markup markup;
  std::vector<std::size_t> open;
  std::size_t at = source.rfind("<!DOCTYPE html>", 0) == 0 ? 15 : 0;
  while (at < source.size()) {
    if (source[at] != '<') {
      const std::size_t end = std::min(source.find('<', at), source.size());
      const std::string text = source.substr(at, end - at);
      if (has_bare_ampersand(text)) return {markup.elements, "bare & in: " + text};
      const std::string inside = open.empty() ? "style" : markup.elements[open.back()].name;
      if (text.find('>') != std::string::npos && inside != "style" && inside != "script") {
        return {markup.elements, "bare > in: " + text};
      }
      if (!open.empty()) markup.elements[open.back()].text += text;
      at = end;
      continue;
    }
    const bool closes = source.compare(at, 2, "</") == 0;
    at += closes ? 2 : 1;
    const std::size_t name_end = source.find_first_of(" />\n", at);
    if (name_end == std::string::npos) return {markup.elements, "tag without end"};
    const std::string name = source.substr(at, name_end - at);
    at = name_end;
    if (closes) {
      if (open.empty() || markup.elements[open.back()].name != name) return {markup.elements, "unexpected </" + name};
      if (source[at] != '>') return {markup.elements, "attributes on </" + name};
      open.pop_back();
      ++at;
      continue;
    }
    Element element{name, {}, ""};
    while (source[at] == ' ') {
      const std::size_t equals = source.find("=\"", at);
      if (equals == std::string::npos) return {markup.elements, "attribute without value in <" + name};
      const std::size_t end = source.find('"', equals + 2);
      if (end == std::string::npos) return {markup.elements, "attribute without end in <" + name};
      const std::string key = source.substr(at + 1, equals - at - 1);
      const std::string value = source.substr(equals + 2, end - equals - 2);
      if (value.find('<') != std::string::npos || has_bare_ampersand(value))
        return {markup.elements, "bare in " + value};
      if (!element.attributes.emplace(key, value).second) return {markup.elements, "attribute twice: " + key};
      at = end + 1;
    }
    markup.elements.push_back(element);
    if (source.compare(at, 2, "/>") == 0) {
      at += 2;
    } else if (source.compare(at, 1, ">") == 0) {
      open.push_back(markup.elements.size() - 1);
      ++at;
    } else {
      return {markup.elements, "<" + name + " is not closed"};
    }
  }
  if (!open.empty()) markup.fault = "left open: " + markup.elements[open.back()].name;
  return markup;
}

}  // namespace crankloop::support
