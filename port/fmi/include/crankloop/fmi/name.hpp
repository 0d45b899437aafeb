// A variable's name as text: "valve[2,1].lift_m".
//
// What belongs here: that. What does not: what a format makes of it (description.hpp). Not for real time.
#pragma once

#include <cstdint>
#include <string>

#include <crankloop/variable.hpp>

namespace crankloop::fmi {

/// "valve[#,#].lift_m" with its indices, counted from 1.
[[nodiscard]] inline std::string name_of(const detail::Variable& variable) {
  std::string name;
  std::uint32_t index = variable.first;
  for (const char* c = variable.name; *c != '\0'; ++c) {
    if (*c != '#') {
      name += *c;
      continue;
    }
    name += std::to_string(index + 1);
    index = variable.second;
  }
  return name;
}

}  // namespace crankloop::fmi
