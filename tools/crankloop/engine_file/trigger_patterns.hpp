// Patterns of trigger wheels, `pattern = TEXT`: teeth and gaps, or the NAME of a pair of wheels of production engines.
//
// What belongs here: the shape of a wheel. What does not: its angle and shaft (engine_file_triggers.cpp).
#pragma once

#include <array>
#include <string>
#include <vector>

#include <crankloop/define/trigger_wheel.hpp>

namespace crankloop::program {

/// A crank and a cam wheel that belong together. Either is teeth and gaps, 36-1 or 16(2)17(1), or a list of teeth in
/// crank degrees after the first one's rising edge: 0+140 is one of 140 deg, 0+5x16/10 are 16 of 5 deg, 10 deg from
/// rise to rise.
struct WheelPair {
  const char* name;
  const char* crank;
  const char* cam;
  const char* used_by;
  const char* source;
};
inline constexpr std::size_t kWheelPairs = 12;
[[nodiscard]] const std::array<WheelPair, kWheelPairs>& wheel_pairs();

/// Fills in the wheel of this text, of a pair the one on wheel.shaft; `edges_deg` if it is a list, else empty. False if
/// the text is not a pattern.
[[nodiscard]] bool read_pattern(const std::string& text, TriggerWheel& wheel, std::vector<double>& edges_deg);

/// What `crankloop help patterns` prints.
[[nodiscard]] std::string describe_patterns();

}  // namespace crankloop::program
