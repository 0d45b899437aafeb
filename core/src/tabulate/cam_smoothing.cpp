// Smoothing by a penalised spline (Eilers and Marx, Statistical Science 11 (1996) 89; Reinsch, Numerische Mathematik 10
// (1967) 177): weights c >= 0 that minimise
//
//     sum over rows (y(row) - lift)^2  +  stiffness * sum (third differences of c)^2
//
// with the largest stiffness that keeps every row within the permitted residual. Third differences represent the jerk,
// which rounding and noise amplify most. (Fourth differences gave two to three times the error of y'' at the ends of
// the lobe.)
//
//     weights       0 0 0 c c c c c c c c c c 0 0 0     The spline begins and ends with whole basis functions,
//     lift          ______....--''''--....________      so four derivatives are zero there; c >= 0 keeps the lift from
//                                                       swinging below the base circle.
#include "cam_smoothing.hpp"

#include <crankloop/assert.hpp>
#include <crankloop/phase.hpp>
#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tick/one_instruction.hpp>

#include "quintic_basis.hpp"

namespace crankloop::detail {

namespace {

constexpr int kMax = LobeSpline::kMaxWeights;
constexpr int kFewestSegments = 160;  // about one per degree, so that a coarse table is smoothed too and not
                                      // interpolated
constexpr int kMaxSegments = kMax + kBasis - 1;
constexpr double kMarginDeg = 10;  // base circle on either side of the lifted rows, in which the lobe may begin
constexpr double kWidestLobeDeg = 350;
constexpr double kLeastStiffness =
    0.1;  // per row in a segment: halves a wave of four segments, so that the spline does not follow a single row
constexpr double kMaxStiffness = 1e9;
constexpr double kStiffnessStep = 4;  ///< of the search from above

class Smoothing {
 public:
  Smoothing(const Cam& cam, LobeSpline& lobe) noexcept : cam_{cam}, lobe_{lobe} {}

  Status place() noexcept;
  void gather() noexcept;
  [[nodiscard]] CamResidual residual(double stiffness) noexcept;
  [[nodiscard]] double least_stiffness() const noexcept { return least_stiffness_; }

 private:
  [[nodiscard]] double knots(int row) const noexcept {
    return (cam_.points[row].cam_deg * kRadPerDegree - lobe_.first_rad) / lobe_.knot_rad;
  }
  void solve(double stiffness) noexcept;
  [[nodiscard]] bool trim() noexcept;

  const Cam& cam_;
  LobeSpline& lobe_;
  int weights_ = 0;
  double least_stiffness_ = 0;
  double rows_[kMax][kBasis];  ///< normal equations: row i holds columns i to i + 5
  double right_[kMax];
  double factor_[kMax][kBasis];  ///< Cholesky factor, transposed
};

/// Sets the range of the lobe and its knots.
Status Smoothing::place() noexcept {
  const CamPoint* row = cam_.points;
  const int last = cam_.point_count - 1;
  int peak = 0;
  for (int i = 1; i <= last; ++i) {
    if (row[i].lift_m > row[peak].lift_m) peak = i;
  }
  int left = peak;
  while (left > 0 && row[left].lift_m > cam_.smoothing_m) --left;
  int right = peak;
  while (right < last && row[right].lift_m > cam_.smoothing_m) ++right;
  if (left == right || row[left].lift_m > cam_.smoothing_m) return refuse("cam.points", Reason::inconsistent, left);
  if (row[right].lift_m > cam_.smoothing_m) return refuse("cam.points", Reason::inconsistent, right);

  double from = row[left].cam_deg - kMarginDeg;
  double to = row[right].cam_deg + kMarginDeg;
  int rows = 0;
  for (int i = 0; i <= last; ++i) {
    if (row[i].cam_deg >= from && row[i].cam_deg <= to) ++rows;
  }
  int segments = rows;
  if (segments < kFewestSegments) segments = kFewestSegments;
  if (segments > kMaxSegments) segments = kMaxSegments;
  // The base circle continues beyond the table's ends: three more segments let a lobe begin there as smoothly as
  // elsewhere.
  const double beyond = 3 * (row[right].cam_deg - row[left].cam_deg) / (segments - 6);
  if (from < row[0].cam_deg - beyond) from = row[0].cam_deg - beyond;
  if (to > row[last].cam_deg + beyond) to = row[last].cam_deg + beyond;
  if (to - from > kWidestLobeDeg) return refuse("cam.points", Reason::out_of_range);
  weights_ = segments - (kBasis - 1);
  least_stiffness_ = kLeastStiffness * rows / segments;
  lobe_.first_rad = from * kRadPerDegree;
  lobe_.knot_rad = (to - from) * kRadPerDegree / segments;
  return {};
}

/// Adds the rows to the normal equations.
void Smoothing::gather() noexcept {
  for (int i = 0; i < kMax; ++i) {
    right_[i] = 0;
    for (int k = 0; k < kBasis; ++k) rows_[i][k] = 0;
  }
  for (int row = 0; row < cam_.point_count; ++row) {
    const double at = knots(row);
    if (!(at >= 0 && at < weights_ + kBasis - 1)) continue;
    const int segment = static_cast<int>(at);
    const QuinticBasis basis = quintic_basis(at - segment);
    for (int j = 0; j < kBasis; ++j) {
      const int i = segment - (kBasis - 1) + j;
      if (i < 0 || i >= weights_) continue;
      right_[i] += basis.value[j] * cam_.points[row].lift_m;
      for (int k = 0; j + k < kBasis && i + k < weights_; ++k) rows_[i][k] += basis.value[j] * basis.value[j + k];
    }
  }
}

/// Computes the lobe's weights by Cholesky's method; O(weights). The matrix is positive definite because the
/// differences extend beyond both ends.
void Smoothing::solve(double stiffness) noexcept {
  CRANKLOOP_ASSERT(lobe_.begin >= 0 && lobe_.begin < lobe_.end && lobe_.end <= kMax);
  constexpr double kThirdDifferences[kBasis] = {20, -15, 6, -1, 0, 0};  // D'D of D = (1, -3, 3, -1)
  double* c = lobe_.c_m;
  const auto reach = [&](int i) { return i - (kBasis - 1) > lobe_.begin ? i - (kBasis - 1) : lobe_.begin; };
  for (int i = 0; i < kMax; ++i) c[i] = 0;
  for (int i = lobe_.begin; i < lobe_.end; ++i) {
    for (int k = 0; k < kBasis && i + k < lobe_.end; ++k) {
      double sum = rows_[i][k] + stiffness * kThirdDifferences[k];
      for (int m = reach(i + k); m < i; ++m) sum -= factor_[m][i - m] * factor_[m][i + k - m];
      CRANKLOOP_ASSERT(k != 0 || sum > 0);  // the matrix is positive definite
      factor_[i][k] = k == 0 ? square_root(sum) : sum / factor_[i][0];
    }
    double sum = right_[i];
    for (int m = reach(i); m < i; ++m) sum -= factor_[m][i - m] * c[m];
    c[i] = sum / factor_[i][0];
  }
  for (int i = lobe_.end - 1; i >= lobe_.begin; --i) {
    double sum = c[i];
    for (int k = 1; k < kBasis && i + k < lobe_.end; ++k) sum -= factor_[i][k] * c[i + k];
    c[i] = sum / factor_[i][0];
  }
}

/// On each side of the peak, removes the outermost weight that is not above 0 and the weights outside it. True if there
/// was one. Only one at a time, because the next ones often become positive.
bool Smoothing::trim() noexcept {
  int peak = lobe_.begin;
  for (int i = lobe_.begin; i < lobe_.end; ++i) {
    if (lobe_.c_m[i] > lobe_.c_m[peak]) peak = i;
  }
  int begin = lobe_.begin;
  while (begin < peak && lobe_.c_m[begin] > 0) ++begin;
  int end = lobe_.end;
  while (end - 1 > peak && lobe_.c_m[end - 1] > 0) --end;
  if (begin < peak) lobe_.begin = begin + 1;
  if (end - 1 > peak) lobe_.end = end - 1;
  return begin < peak || end - 1 > peak;
}

/// Residual of the lobe with this stiffness, which stays in lobe_.
CamResidual Smoothing::residual(double stiffness) noexcept {
  lobe_.begin = 0;
  lobe_.end = weights_;
  do {
    solve(stiffness);
  } while (trim());
  CamResidual largest{};
  for (int row = 0; row < cam_.point_count; ++row) {
    const double off = cam_.points[row].lift_m - lobe_.at(cam_.points[row].cam_deg * kRadPerDegree).lift_m;
    if (magnitude(off) > magnitude(largest.off_m)) largest = {off, row};
  }
  return largest;
}

}  // namespace

Status closest_lobe(const Cam& cam, LobeSpline& lobe, CamResidual& closest) noexcept {
  Smoothing smoothing{cam, lobe};
  if (const Status refused = smoothing.place(); !refused.ok()) return refused;
  smoothing.gather();
  double stiffness = kMaxStiffness;
  closest = smoothing.residual(stiffness);
  while (stiffness >= smoothing.least_stiffness()) {
    stiffness /= kStiffnessStep;
    const CamResidual next = smoothing.residual(stiffness);
    if (magnitude(next.off_m) < magnitude(closest.off_m)) closest = next;
  }
  return {};
}

Status smooth_cam(const Cam& cam, LobeSpline& lobe, double& residual_m) noexcept {
  Smoothing smoothing{cam, lobe};
  if (const Status refused = smoothing.place(); !refused.ok()) return refused;
  smoothing.gather();
  const auto keeps_to_rows = [&](double stiffness) {
    residual_m = magnitude(smoothing.residual(stiffness).off_m);
    return residual_m <= cam.smoothing_m;
  };
  // From the stiffest downward, because a soft spline follows the noise, and a lobe trimmed to noise may fail at rows
  // that a stiffer one fits.
  double low = kMaxStiffness;
  double high = low;
  while (!keeps_to_rows(low)) {
    if (low < smoothing.least_stiffness()) return refuse("cam.smoothing_m", Reason::no_solution);
    high = low;
    low /= kStiffnessStep;
  }
  while (high > low * 1.02) {
    const double middle = square_root(low * high);
    (keeps_to_rows(middle) ? low : high) = middle;
  }
  if (!keeps_to_rows(low)) return refuse("cam.smoothing_m", Reason::no_solution);
  return {};
}

double peak_of(const LobeSpline& lobe) noexcept {
  double low = lobe.opens_rad();
  double largest = 0;
  for (int knot = lobe.begin; knot < lobe.end + kBasis; ++knot) {
    const double phi = lobe.first_rad + knot * lobe.knot_rad;
    const double lift = lobe.at(phi).lift_m;
    if (lift > largest) {
      largest = lift;
      low = phi - lobe.knot_rad;
    }
  }
  double high = low + 2 * lobe.knot_rad;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (lobe.at(middle).per_rad_m > 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace crankloop::detail
