// What `kinematics` prints beside its table: extremes of the motion, and its series.
//
// What belongs here: figures of one turn. What does not: rows and pictures.
#pragma once

#include <string>
#include <vector>

#include <crankloop/tabulate/mechanism.hpp>

#include "../../command_line/summary.hpp"

namespace crankloop::program {

/// Local extremes of a quantity over a turn, in the order of the angle; each to 1e-7 rad of its place where the curve
/// is curved. Ripples below 1e-9 of the largest value do not count.
struct LocalExtreme {
  Extreme extreme;
  bool is_largest;  ///< of its neighbourhood
};
[[nodiscard]] std::vector<LocalExtreme> local_extremes(const Crank& crank, PoseMember quantity, PoseFunction pose);

inline constexpr int kSeriesOrders = 6;

/// x / r = a_0 + sum of a_n cos n a + b_n sin n a, of the exact motion; the b_n are 0 without a pin offset, and so are
/// a_3 and a_5.
struct ExactSeries {
  double cosine[kSeriesOrders + 1];
  double sine[kSeriesOrders + 1];
};
[[nodiscard]] ExactSeries exact_series(const Crank& crank);

/// The lines of the summary; `beside`: also the largest errors of the approximations.
[[nodiscard]] Summary motion_summary(const Crank& crank, PoseFunction pose, double speed_rad_s, bool beside);

}  // namespace crankloop::program
