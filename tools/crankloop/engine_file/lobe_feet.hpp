// Slope of a measured cam's lift at both ends of the lobe.
//
// What belongs here: slopes from the rows. What does not: whether they are usual (plausibility_trains.cpp).
#pragma once

#include <cstddef>
#include <vector>

#include <crankloop/define/valve_train.hpp>

namespace crankloop::program {

/// Speeds of the lift in m per cam degree, all 0 where rows are too few, or more than 2.5 deg apart.
struct LobeFeet {
  std::size_t first_row = 0;  ///< of the lobe
  double step_m_deg = 0;      ///< where the lift leaves 0 or returns to it: the smaller of both
  double largest_m_deg = 0;   ///< from row to row, anywhere
};

/// Rows up to `smoothing_m` are base circle, up to 20 um at most.
[[nodiscard]] LobeFeet lobe_feet(const std::vector<CamPoint>& rows, double smoothing_m);

}  // namespace crankloop::program
