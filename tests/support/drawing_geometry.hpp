// Where things stand on a drawing: the lines of its paths, the room that its labels take.
//
// What belongs here: geometry read back from markup. What does not: expectations.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "crankloop/report/geometry.hpp"
#include "crankloop/report/text.hpp"
#include "support/markup.hpp"

namespace crankloop::support {

inline double number_of(const Element& element, const char* attribute) {
  return std::strtod(element.attributes.at(attribute).c_str(), nullptr);
}

/// The unbroken lines of a path of M, L, H, V, h, v and Z.
inline std::vector<report::Polyline> lines_of(const std::string& d) {
  std::vector<report::Polyline> lines;
  char command = 'M';
  const char* at = d.c_str();
  while (*at != '\0') {
    if (std::string("MLHVhvZ").find(*at) != std::string::npos) {
      command = *at++;
      if (command == 'M') lines.emplace_back();
      if (command == 'Z') lines.back().push_back(lines.back().front());
      continue;
    }
    char* end = nullptr;
    const double first = std::strtod(at, &end);
    report::Point point = lines.back().empty() ? report::Point{} : lines.back().back();
    if (command == 'H') point.x = first;
    if (command == 'V') point.y = first;
    if (command == 'h') point.x += first;
    if (command == 'v') point.y += first;
    if (command == 'M' || command == 'L') point = {first, std::strtod(end, &end)};
    lines.back().push_back(point);
    at = end;
    while (*at == ' ') ++at;
  }
  return lines;
}

/// What a text covers at its largest size, semi-bold, a unit less on each side.
inline report::Box room_of(const Element& text) {
  const double width = 1.1 * report::text_width(text.text);
  const auto anchor = text.attributes.find("text-anchor");
  const double part = anchor == text.attributes.end() ? 0 : anchor->second == "middle" ? 0.5 : 1;
  const double left = number_of(text, "x") - part * width;
  const double y = number_of(text, "y");
  return report::grown({left, y - 0.76 * report::kTypeSize, left + width, y + 0.24 * report::kTypeSize}, -1);
}

/// Labels beside curves that lie on a curve, on an axis or on each other, or run out of the drawing: "PLOT: LABEL".
inline std::vector<std::string> labels_in_the_way(const Markup& page) {
  std::vector<std::string> found;
  std::vector<report::Polyline> lines;
  std::vector<report::Box> rooms;
  std::string plot;
  for (const Element& element : page.elements) {
    if (element.name == "svg") {
      lines.clear();
      rooms.clear();
    }
    if (element.name == "title") plot = element.text;
    const auto of_class = element.attributes.find("class");
    if (of_class == element.attributes.end()) continue;
    const std::string what = of_class->second.substr(0, of_class->second.find(' '));
    if (element.name == "path" && (what == "curve" || what == "axis" || what == "zero")) {
      for (report::Polyline& line : lines_of(element.attributes.at("d"))) lines.push_back(std::move(line));
    }
    if (element.name != "text" || what != "name") continue;
    const report::Box room = room_of(element);
    bool hidden = room.left < -1 || room.right > 521;
    for (const report::Polyline& line : lines) {
      for (std::size_t i = 1; i < line.size(); ++i) hidden |= report::length_inside(room, line[i - 1], line[i]) > 0;
    }
    for (const report::Box& other : rooms) hidden |= report::overlap_area(room, other) > 0;
    if (hidden) found.push_back(plot + ": " + element.text);
    rooms.push_back(room);
  }
  return found;
}

}  // namespace crankloop::support
