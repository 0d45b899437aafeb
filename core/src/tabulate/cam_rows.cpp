// Scatter of a measured cam's rows, and how closely a smooth lobe can fit them: docs/model.md "Cam".
//
// What belongs here: a proposal for cam.smoothing_m from the rows. What does not: the lobe (cam_smoothing.cpp).
#include <crankloop/assert.hpp>
#include <crankloop/tabulate/cam_profile.hpp>
#include <crankloop/tick/one_instruction.hpp>

#include "cam_smoothing.hpp"

namespace crankloop {

namespace {

using detail::CamResidual;
using detail::closest_lobe;
using detail::magnitude;
using detail::square_root;

constexpr int kNeighbours = 3;  ///< on each side
constexpr double kLobe = 0.01;  ///< share of the largest lift: leaves out the ends of the lobe, where y'' changes most
constexpr double kMedianOfNormal = 0.6745;  ///< median of the absolute value, in standard deviations
constexpr double kSigmas = 5;
constexpr double kRoundingSigmas = 0.5;    ///< rounding alone scatters by 1 / sqrt(12) of its unit
constexpr double kRoundingResidual = 0.6;  ///< and changes a lift by at most half a unit
constexpr double kAboveSmallest = 1.5;     ///< with less, the lobe follows every row
constexpr double kFinestUnit_m = 1e-8;
constexpr double kCoarsestUnit_m = 1e-4;
constexpr double kWholeMultiple = 1e-4;   ///< rounding of decimal fractions and of the conversion from millimetres, in
                                          ///< units
constexpr double kLargestBase_m = 50e-6;  ///< largest lift of a row on the base circle, without a given smoothing_m
constexpr double kLargestSmoothing_m = 1e-3;
constexpr double kTolerance = 1.01;  ///< relative, of smallest_m
constexpr int kMaxTrials = 60;
constexpr int kNextTrials = 20;  ///< of the next number of two digits; then by kTrialGrowth
constexpr double kTrialGrowth = 1.1;

struct Lobe {
  int first;
  int last;
  int peak;
};

/// The rows around the largest lift that are above a share of it.
Lobe rows_above(const Cam& cam, double share_of_peak) noexcept {
  int peak = 0;
  for (int i = 1; i < cam.point_count; ++i) {
    if (cam.points[i].lift_m > cam.points[peak].lift_m) peak = i;
  }
  const double above_m = share_of_peak * cam.points[peak].lift_m;
  int first = peak;
  while (first > 0 && cam.points[first - 1].lift_m > above_m) --first;
  int last = peak;
  while (last < cam.point_count - 1 && cam.points[last + 1].lift_m > above_m) ++last;
  return {first, last, peak};
}

/// Deviation of a row from the polynomial through its neighbours, scaled to the standard deviation of one row: rows of
/// scatter sigma deviate by sigma sqrt(1 + sum w^2), w the weights of Lagrange's polynomial.
double off_neighbours_m(const CamPoint* row) noexcept {
  double off_m = row->lift_m;
  double variance = 1;
  for (int j = -kNeighbours; j <= kNeighbours; ++j) {
    if (j == 0) continue;
    double weight = 1;
    for (int k = -kNeighbours; k <= kNeighbours; ++k) {
      if (k != 0 && k != j) weight *= (row[0].cam_deg - row[k].cam_deg) / (row[j].cam_deg - row[k].cam_deg);
    }
    off_m -= weight * row[j].lift_m;
    variance += weight * weight;
  }
  return magnitude(off_m) / square_root(variance);
}

/// By bisection; O(count).
double median(const double* values, int count) noexcept {
  double low = 0;
  double high = 0;
  for (int i = 0; i < count; ++i) high = values[i] > high ? values[i] : high;
  for (int round = 0; round < kMaxTrials; ++round) {
    const double middle = (low + high) / 2;
    int below = 0;
    for (int i = 0; i < count; ++i) below += values[i] <= middle ? 1 : 0;
    (2 * below < count ? low : high) = middle;
  }
  return high;
}

double scatter_of(const Cam& cam) noexcept {
  double off_m[kMaxCamPoints];
  int count = 0;
  const Lobe lobe = rows_above(cam, kLobe);
  for (int row = lobe.first; row <= lobe.last; ++row) {
    if (row >= kNeighbours && row + kNeighbours < cam.point_count) off_m[count++] = off_neighbours_m(cam.points + row);
  }
  return count == 0 ? 0 : median(off_m, count) / kMedianOfNormal;
}

/// The largest unit of which every lift is a whole multiple; 0 where there is none.
double unit_of(const Cam& cam) noexcept {
  constexpr double kSteps[] = {1, 2, 5};
  double largest_m = 0;
  for (double decade_m = kFinestUnit_m; decade_m < kCoarsestUnit_m * kTolerance; decade_m *= 10) {
    for (const double step : kSteps) {
      const double unit_m = step * decade_m;
      bool all = true;
      for (int row = 0; row < cam.point_count && all; ++row) {
        const double units = magnitude(cam.points[row].lift_m) / unit_m;
        all = magnitude(units - static_cast<double>(static_cast<long>(units + 0.5))) < kWholeMultiple;
      }
      if (all) largest_m = unit_m;
    }
  }
  return largest_m;
}

/// The next larger number of two digits.
double two_digits_up(double value) noexcept {
  double unit = 1e-12;
  while (unit * 100 < value) unit *= 10;
  const double units = value / unit;
  const auto whole = static_cast<long>(units);
  return unit * (static_cast<double>(whole) < units - kWholeMultiple ? static_cast<double>(whole + 1)
                                                                     : static_cast<double>(whole));
}

/// Tries values of cam.smoothing_m.
class Trial {
 public:
  explicit Trial(const Cam& cam) noexcept : cam_{cam} {}

  /// Whether a lobe fits within it.
  bool keeps(double smoothing_m) noexcept {
    cam_.smoothing_m = smoothing_m;
    refused_ = closest_lobe(cam_, lobe_, closest_);
    return refused_.ok() && magnitude(closest_.off_m) <= smoothing_m;
  }
  [[nodiscard]] const CamResidual& closest() const noexcept { return closest_; }
  [[nodiscard]] const Status& refused() const noexcept { return refused_; }

 private:
  Cam cam_;
  LobeSpline lobe_;
  CamResidual closest_{};
  Status refused_;
};

/// The larger of the smallest lifts on both sides of the peak: rows up to it count as base circle.
Status find_base(const Cam& cam, double& base_m) noexcept {
  const int peak = rows_above(cam, 1).peak;
  base_m = 0;
  for (const int end : {0, cam.point_count - 1}) {
    double least_m = cam.points[end].lift_m;
    for (int row = end; row != peak; row += end == 0 ? 1 : -1) {
      if (cam.points[row].lift_m < least_m) least_m = cam.points[row].lift_m;
    }
    if (least_m > kLargestBase_m) return refuse("cam.points", Reason::inconsistent, end);
    if (least_m > base_m) base_m = least_m;
  }
  return {};
}

/// The smallest residual that a lobe keeps: searched upward from `from_m`, then by bisection to within kTolerance.
Status find_smallest(Trial& trial, double from_m, CamRows& rows) noexcept {
  double low_m = from_m;
  double high_m = from_m;
  while (!trial.keeps(high_m)) {
    if (!trial.refused().ok()) return trial.refused();
    if (high_m >= kLargestSmoothing_m) return refuse("cam.smoothing_m", Reason::no_solution, trial.closest().row);
    low_m = high_m;
    const double closest_m = magnitude(trial.closest().off_m);
    high_m = closest_m > kTolerance * low_m ? closest_m : kTolerance * low_m;
    if (high_m > kLargestSmoothing_m) high_m = kLargestSmoothing_m;
  }
  for (int round = 0; round < kMaxTrials && high_m > kTolerance * low_m; ++round) {
    const double middle_m = square_root(low_m * high_m);
    (trial.keeps(middle_m) ? high_m : low_m) = middle_m;
  }
  CRANKLOOP_ASSERT(high_m >= low_m);
  static_cast<void>(trial.keeps(high_m));
  rows.smallest_m = high_m;
  rows.worst_row = trial.closest().row;
  rows.worst_off_m = trial.closest().off_m;
  return {};
}

}  // namespace

Status survey_rows(const Cam& cam, CamRows& rows) noexcept {
  rows = CamRows{};
  Cam with_smoothing = cam;
  with_smoothing.smoothing_m = kLargestSmoothing_m;
  if (const Status refused = validate(with_smoothing); !refused.ok()) return refused;
  if (cam.source != CamSource::table) return refuse("cam.source", Reason::inconsistent);
  double base_m = 0;
  if (const Status refused = find_base(cam, base_m); !refused.ok()) return refused;
  rows.scatter_m = scatter_of(cam);
  rows.unit_m = unit_of(cam);
  Trial trial{cam};
  if (const Status refused = find_smallest(trial, base_m + kFinestUnit_m, rows); !refused.ok()) return refused;

  const bool only_rounded =
      rows.scatter_m <= kRoundingSigmas * rows.unit_m && rows.smallest_m <= kRoundingResidual * rows.unit_m;
  const double for_scatter_m = only_rounded ? rows.unit_m : kSigmas * rows.scatter_m;
  const double least_m = kAboveSmallest * rows.smallest_m;
  // A trimmed lobe may fail at a larger residual although it fitted at a smaller one.
  rows.automatic_m = rows.smallest_m;
  double trial_m = two_digits_up(for_scatter_m > least_m ? for_scatter_m : least_m);
  if (trial_m > kLargestSmoothing_m) trial_m = kLargestSmoothing_m;
  for (int round = 0; trial_m <= kLargestSmoothing_m; ++round) {
    if (trial.keeps(trial_m)) {
      rows.automatic_m = trial_m;
      break;
    }
    trial_m = two_digits_up((round < kNextTrials ? kTolerance : kTrialGrowth) * trial_m);
  }
  return {};
}

}  // namespace crankloop
