// A layout as a crankshaft in words: throws, the cylinders on each, firing order.
//
// What belongs here: its description for `show` and reports. What does not: how it is built (engine_file_layout.cpp,
// engine_file_pins.cpp).
#pragma once

#include <string>
#include <vector>

#include <crankloop/define/layout.hpp>

namespace crankloop::program {

/// One crank pin between its webs, in the order of the shaft. A group of rods on one pin has one throw.
struct CrankThrow {
  double direction_deg = 0;    ///< at engine angle 0 from the vertical in the sense of rotation, 0 to below 360
  std::vector<int> cylinders;  ///< counted from 1
};
[[nodiscard]] std::vector<CrankThrow> throws_of(const Layout& layout);

/// The number of throws and their directions, then a line for each throw.
[[nodiscard]] std::vector<std::string> throws_in_words(const Layout& layout);

/// "Fires 1, 3, 4, 2, at 0, 180, 360, 540 deg: 180, 180, 180, 180 deg apart."
[[nodiscard]] std::string firing_in_words(const Layout& layout);

/// Neighbours of two banks at an angle whose throws agree, "1-2" and "3-4".
[[nodiscard]] std::vector<std::string> pairs_for_one_pin(const Layout& layout);

/// Whether each cylinder lies opposite to its neighbours: a boxer.
[[nodiscard]] bool are_opposed(const Layout& layout);

/// How to define rods of two banks on one pin; "" if some share a pin, and if no two banks are at an angle.
[[nodiscard]] std::string shared_pins_hint(const Layout& layout);

/// All three as comments of an engine file; "" for one cylinder.
[[nodiscard]] std::string crankshaft_comments(const Layout& layout);

}  // namespace crankloop::program
