#include "measured_rows.hpp"

#include <algorithm>
#include <cmath>

#include "../files/number.hpp"

namespace crankloop::program {
namespace {

/// A row is suspicious if its deviation exceeds this and a multiple of the rows' scatter.
constexpr double kMisread_m = 5e-6;
constexpr double kMisreadSigmas = 5;

double off_neighbours_m(const CamPoint* row) {
  constexpr int kNeighbours[] = {-2, -1, 1, 2};
  double off_m = row->lift_m;
  for (const int j : kNeighbours) {
    double weight = 1;
    for (const int k : kNeighbours)
      if (k != j) weight *= (row->cam_deg - row[k].cam_deg) / (row[j].cam_deg - row[k].cam_deg);
    off_m -= weight * row[j].lift_m;
  }
  return off_m;
}

}  // namespace

std::optional<OddRow> odd_row(const std::vector<CamPoint>& points, double scatter_m) {
  OddRow odd;
  for (std::size_t row = 2; row + 2 < points.size(); ++row) {
    const double off_m = off_neighbours_m(points.data() + row);
    if (std::abs(off_m) > std::abs(odd.off_m)) odd = {row, off_m};
  }
  if (std::abs(odd.off_m) <= std::max(kMisread_m, kMisreadSigmas * scatter_m)) return {};
  return odd;
}

std::optional<Gap> widest_gap(const std::vector<double>& angles_deg, double least_deg) {
  constexpr double kSteps = 5;
  Gap gap;
  std::vector<double> steps_deg;
  for (std::size_t i = 1; i < angles_deg.size(); ++i) {
    steps_deg.push_back(angles_deg[i] - angles_deg[i - 1]);
    if (steps_deg.back() > gap.to_deg - gap.from_deg) gap = {angles_deg[i - 1], angles_deg[i]};
  }
  if (steps_deg.empty()) return {};
  const auto middle = steps_deg.begin() + static_cast<std::ptrdiff_t>(steps_deg.size() / 2);
  std::nth_element(steps_deg.begin(), middle, steps_deg.end());
  gap.usual_deg = *middle;
  if (gap.to_deg - gap.from_deg <= std::max(least_deg, kSteps * gap.usual_deg)) return {};
  return gap;
}

std::string gap_in_words(const Gap& gap) {
  return "no row between " + brief(gap.from_deg) + " and " + brief(gap.to_deg) + " deg, where others are " +
         brief(gap.usual_deg) + " deg apart";
}

std::string row_in_words(const MeasuredRows& rows, std::size_t row) {
  return brief(rows.points[row].cam_deg) + " deg (" + rows.path + ":" + std::to_string(rows.lines[row]) + ")";
}

std::string misread_row(const MeasuredRows& rows, const CamRows& survey) {
  if (survey.smallest_m < std::max({kMisread_m, kMisreadSigmas * survey.scatter_m, survey.unit_m})) return "";
  const std::optional<OddRow> odd = odd_row(rows.points, survey.scatter_m);
  const std::size_t row = odd ? odd->row : static_cast<std::size_t>(survey.worst_row);
  const double off_m = odd ? odd->off_m : survey.worst_off_m;
  return "the row at " + row_in_words(rows, row) + ", which lies " + about(std::abs(off_m) * 1e6) + " um off " +
         (odd ? "its neighbours" : "every smooth lobe") + ", where the rows scatter by " +
         about(survey.scatter_m * 1e6) + " um: was it misread?";
}

}  // namespace crankloop::program
