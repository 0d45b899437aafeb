#include "lobe_feet.hpp"

#include <algorithm>
#include <cmath>

namespace crankloop::program {
namespace {

constexpr double kFootDeg = 2.5;  ///< and at least three rows; coarser rows give no slope
constexpr double kMaxBase_m = 20e-6;
constexpr std::size_t kMinRows = 12;
constexpr double kMinLobeDeg = 20;

double determinant(const double* a, const double* b, const double* c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) + c[0] * (a[1] * b[2] - a[2] * b[1]);
}

/// Slope of the parabola through the first rows of the lobe where it meets the base circle; 0 if it does not. Rows are
/// counted by `step` from `first`: 1 at the lobe's start, -1 at its end.
double step_m_deg(const std::vector<CamPoint>& rows, std::size_t first, int step) {
  const auto row = [&](int i) { return rows[first + static_cast<std::size_t>(step * i)]; };
  const double unit_deg = std::abs(row(1).cam_deg - row(0).cam_deg);
  double moments[5] = {};
  double lifts_m[3] = {};
  for (int i = 0; i < 3 || std::abs(row(i).cam_deg - row(0).cam_deg) <= kFootDeg; ++i) {
    const double x = std::abs(row(i).cam_deg - row(0).cam_deg) / unit_deg;
    double power = 1;
    for (int k = 0; k < 5; ++k, power *= x) {
      moments[k] += power;
      if (k < 3) lifts_m[k] += power * row(i).lift_m;
    }
  }
  // Least squares of c0 + c1 x + c2 x^2, by Cramer's rule.
  const double all = determinant(moments, moments + 1, moments + 2);
  const double c0 = determinant(lifts_m, moments + 1, moments + 2) / all;
  const double c1 = determinant(moments, lifts_m, moments + 2) / all;
  const double c2 = determinant(moments, moments + 1, lifts_m) / all;
  return std::sqrt(std::max(c1 * c1 - 4 * c0 * c2, 0.0)) / unit_deg;
}

}  // namespace

LobeFeet lobe_feet(const std::vector<CamPoint>& rows, double smoothing_m) {
  const double base_m = std::min(smoothing_m, kMaxBase_m);
  LobeFeet feet;
  const auto lower = [](const CamPoint& a, const CamPoint& b) { return a.lift_m < b.lift_m; };
  const auto peak = static_cast<std::size_t>(std::max_element(rows.begin(), rows.end(), lower) - rows.begin());
  std::size_t first = peak;
  while (first > 0 && rows[first - 1].lift_m > base_m) --first;
  std::size_t last = peak;
  while (last + 1 < rows.size() && rows[last + 1].lift_m > base_m) ++last;
  const double lobe_deg = rows[last].cam_deg - rows[first].cam_deg;
  if (last < first + kMinRows || lobe_deg < kMinLobeDeg || lobe_deg > kFootDeg * static_cast<double>(last - first))
    return feet;
  feet.first_row = first;
  for (std::size_t i = first; i < last; ++i) {
    const CamPoint& from = rows[i];
    const CamPoint& to = rows[i + 1];
    feet.largest_m_deg = std::max(feet.largest_m_deg, std::abs(to.lift_m - from.lift_m) / (to.cam_deg - from.cam_deg));
  }
  feet.step_m_deg = std::min(step_m_deg(rows, first, 1), step_m_deg(rows, last, -1));
  return feet;
}

}  // namespace crankloop::program
