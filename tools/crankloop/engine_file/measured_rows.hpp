// Rows of a measured cam, and which of them does not fit.
//
// What belongs here: the row to look at, in words. What does not: whether a lobe comes close to all rows
// (tabulate/cam_rows.hpp).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <crankloop/define/valve_train.hpp>
#include <crankloop/tabulate/cam_profile.hpp>

namespace crankloop::program {

/// Of a file; `lines` has the line of each row.
struct MeasuredRows {
  const std::string& path;
  const std::vector<CamPoint>& points;
  const std::vector<int>& lines;
};

struct OddRow {
  std::size_t row = 0;
  double off_m = 0;  ///< above the cubic through its two neighbours on either side
};

/// The row farthest off its neighbours; none where that is within 5 um or five times the rows' `scatter_m`.
[[nodiscard]] std::optional<OddRow> odd_row(const std::vector<CamPoint>& points, double scatter_m);

/// A step between neighbours that is much wider than the others.
struct Gap {
  double from_deg = 0;
  double to_deg = 0;
  double usual_deg = 0;  ///< median of all steps
};
/// The widest step of rising angles; none up to `least_deg` or five times the median.
[[nodiscard]] std::optional<Gap> widest_gap(const std::vector<double>& angles_deg, double least_deg);

/// "no row between 10 and 40 deg, where others are 2 deg apart".
[[nodiscard]] std::string gap_in_words(const Gap& gap);

/// "10 deg (cam.csv:31)".
[[nodiscard]] std::string row_in_words(const MeasuredRows& rows, std::size_t row);

/// Which row makes the smoothing of `survey` larger than the rows' scatter: where it is, how far off; "" where none
/// does.
[[nodiscard]] std::string misread_row(const MeasuredRows& rows, const CamRows& survey);

}  // namespace crankloop::program
