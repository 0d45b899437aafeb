#include "cam_wanted.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <crankloop/tabulate/cam_profile.hpp>

#include "../../engine_file/lobe_feet.hpp"
#include "../../engine_file/measured_rows.hpp"
#include "../../files/error.hpp"
#include "../../files/number.hpp"
#include "../../files/table_file.hpp"
#include "../../files/units.hpp"
#include "../../files/words.hpp"
#include "../../loops/cam_from_lift.hpp"

namespace crankloop::program {
namespace {

constexpr TableFormat kWantedTable{"cam_deg", "lift_mm", from(-360).up_to(360), from(-100).up_to(100)};
constexpr double kOnBaseCircle_m = 1e-6;
constexpr double kLargestFirstSpeed = 0.1;  // of the largest: an engine file's table is warned of with more
constexpr double kMarginDeg = 10;           // of base circle on either side of the table's lobe
constexpr double kTurnDeg = 360;
constexpr int kScan = 4096;

struct Wanted {
  std::string path;
  std::vector<CamPoint> rows{};
  std::vector<int> lines{};
};

/// Above the base circle by `from_base_m`: 0 for the train's lift, the clearance for one without lash.
Wanted read_wanted(const std::string& path, double from_base_m) {
  Wanted wanted{path};
  for (const TableRow& row : read_table(path, kWantedTable)) {
    if (!wanted.rows.empty() && row.at <= wanted.rows.back().cam_deg) {
      throw InputError(path, row.line,
                       "cam_deg: " + shortest(row.at) + " follows " + shortest(wanted.rows.back().cam_deg) +
                           "; angles must rise from row to row");
    }
    wanted.rows.push_back({row.at, row.value / 1e3 - from_base_m});
    wanted.lines.push_back(row.line);
  }
  if (wanted.rows.size() > kMaxCamPoints) {
    throw InputError(
        path, wanted.lines[kMaxCamPoints],
        std::to_string(wanted.rows.size()) + " rows; at most " + std::to_string(kMaxCamPoints) + " are allowed");
  }
  return wanted;
}

std::string millimetres(double metres) { return brief(metres * 1e3) + " mm"; }

/// Both sides must come down to the base circle, and no row go below it.
void require_base_circle(const Wanted& wanted, double clearance_m) {
  const auto lower = [](const CamPoint& a, const CamPoint& b) { return a.lift_m < b.lift_m; };
  const auto peak = std::max_element(wanted.rows.begin(), wanted.rows.end(), lower);
  const auto line_of = [&](auto row) { return wanted.lines[static_cast<std::size_t>(row - wanted.rows.begin())]; };
  for (const auto& [first, last] : {std::pair(wanted.rows.begin(), peak), std::pair(peak, wanted.rows.end())}) {
    const auto lowest = std::min_element(first, last, lower);
    const bool any = lowest != last;
    const double lift_m = any ? lowest->lift_m : peak->lift_m;
    const int line = line_of(any ? lowest : peak);
    if (lift_m < -clearance_m - kOnBaseCircle_m) {
      throw InputError(wanted.path, line,
                       "lift_mm: " + millimetres(lift_m) +
                           " is below the base circle, where the lift is minus the "
                           "clearance, " +
                           millimetres(-clearance_m));
    }
    if (lift_m > -clearance_m + kOnBaseCircle_m) {
      throw InputError(wanted.path, line,
                       "lift_mm: on this side the lift comes down to " + millimetres(lift_m) +
                           " only, which is a step of the cam: give the train's lift with its ramps, from " +
                           millimetres(-clearance_m) +
                           " on the base circle (minus the clearance) through 0, where "
                           "the valve opens");
    }
  }
}

InputError explain_rows(const Wanted& wanted, const Status& refused, double scatter_m) {
  const bool has_row = refused.index >= 0 && static_cast<std::size_t>(refused.index) < wanted.lines.size();
  int line = has_row ? wanted.lines[static_cast<std::size_t>(refused.index)] : wanted.lines.back();
  if (const std::optional<OddRow> odd = odd_row(wanted.rows, scatter_m); odd && refused.reason == Reason::no_solution)
    line = wanted.lines[odd->row];
  switch (refused.reason) {
    case Reason::too_few_points:
      return InputError(wanted.path, line, too_few_rows(wanted.rows.size(), "a lift"));
    case Reason::no_solution:
      return InputError(wanted.path, line, "no smooth lift comes within 1000 um of every row; check this one");
    case Reason::inconsistent:
      return InputError(wanted.path, line, "the lift must rise from the base circle and return to it within the table");
    default:
      return InputError(wanted.path, line,
                        std::string("the lift ") + describe(refused.reason) +
                            ": rows within one turn, the lobe within 330 deg of it");
  }
}

/// The smooth wanted lift over the cam angle from its peak, and its cam.
class Inverse {
 public:
  Inverse(const Wanted& wanted, const Rocker& rocker, WantedCam& result)
      : wanted_{wanted}, clearance_m_{rocker.clearance_m}, profile_{std::make_unique<CamProfile>()}, cam_{rocker, 0} {
    std::vector<CamPoint> raised = wanted.rows;
    for (CamPoint& row : raised) row.lift_m += clearance_m_;
    Cam lift;
    lift.source = CamSource::table;
    lift.points = raised.data();
    lift.point_count = static_cast<int>(raised.size());
    CamRows rows;
    if (const Status refused = choose_smoothing(lift, rows); !refused.ok())
      throw explain_rows(wanted, refused, rows.scatter_m);
    if (const Status refused = profile_->init(lift); !refused.ok()) throw explain_rows(wanted, refused, rows.scatter_m);
    const LobeFeet feet = lobe_feet(raised, lift.smoothing_m);
    if (feet.step_m_deg > kLargestFirstSpeed * feet.largest_m_deg) {
      throw InputError(wanted.path, wanted.lines[feet.first_row],
                       "the lift leaves the base circle with a step in speed, to " +
                           brief(feet.step_m_deg / feet.largest_m_deg * 100) +
                           " % of the largest, and returns with one: give it with its ramps");
    }
    result.smoothing_m = lift.smoothing_m;
    result.misread = misread_row({wanted.path, wanted.rows, wanted.lines}, rows);
    result.residual_m = profile_->residual_m();
    result.peak_deg = profile_->peak_deg();
    cam_ = CamFromLift(rocker, profile_->largest_lift_m() - clearance_m_);
    require_contour();
  }

  /// Rows of the flat follower, with base circle on both sides.
  [[nodiscard]] std::vector<CamPoint> table(double step_deg) const {
    const double opens_deg = at(profile_->opens_rad()).flat_rad * kDegPerRad;
    const double closes_deg = at(profile_->closes_rad()).flat_rad * kDegPerRad;
    const double margin_deg = std::min(kMarginDeg, (kTurnDeg - (closes_deg - opens_deg)) / 2 - step_deg);
    const auto first = static_cast<int>(std::ceil((opens_deg - margin_deg) / step_deg));
    const auto last = static_cast<int>(std::floor((closes_deg + margin_deg) / step_deg));
    if (last - first >= kMaxCamPoints) {
      throw UsageError("--step-deg " + brief(step_deg) + ": the cam's table would have " +
                       std::to_string(last - first + 1) + " rows, at most " + std::to_string(kMaxCamPoints) +
                       " are allowed");
    }
    std::vector<CamPoint> points;
    for (int i = first; i <= last; ++i) {
      const double deg = i * step_deg;
      const double lift_m = deg > opens_deg && deg < closes_deg ? follower_m(deg * kRadPerDeg) : 0;
      points.push_back({deg, parse_number(significant(std::max(lift_m, 0.0) * 1e3)).value / 1e3});
    }
    return points;
  }

 private:
  [[nodiscard]] FlatContact at(double cam_rad) const {
    CamLift lift = profile_->at(cam_rad);
    lift.lift_m -= clearance_m_;
    return cam_.at(cam_rad, lift);
  }

  /// The flat angle rises with the cam angle: by bisection.
  [[nodiscard]] double follower_m(double flat_rad) const {
    double low = profile_->opens_rad();
    double high = profile_->closes_rad();
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = (low + high) / 2;
      (at(middle).flat_rad < flat_rad ? low : high) = middle;
    }
    return at(low).lift_m;
  }

  [[nodiscard]] InputError refused_at(double cam_rad, const std::string& what) const {
    return InputError(wanted_.path + ": no cam of this rocker gives this lift: at " +
                      brief(cam_rad * kDegPerRad + profile_->peak_deg()) + " deg of the table " + what);
  }

  /// Every place of the lobe, the worst one told.
  void require_contour() const {
    double least_turning = 1;
    double turning_rad = 0;
    double least_radius_m = 1;
    double radius_rad = 0;
    const double step_rad = (profile_->closes_rad() - profile_->opens_rad()) / kScan;
    for (int i = 0; i <= kScan; ++i) {
      const double rad = profile_->opens_rad() + i * step_rad;
      const FlatContact contact = at(rad);
      if (!contact.exists) throw refused_at(rad, "screw or pad cannot stand where the lift needs them");
      if (contact.flat_per_cam < least_turning) least_turning = contact.flat_per_cam, turning_rad = rad;
      if (contact.curvature_radius_m < least_radius_m) least_radius_m = contact.curvature_radius_m, radius_rad = rad;
    }
    if (!(least_turning > 0)) {
      throw refused_at(turning_rad, "(" + brief(at(turning_rad).flat_rad * kDegPerRad) +
                                        " deg of the flat follower's angle) the flat follower's angle does not rise: "
                                        "the contour would be hollow; a gentler lift or a smaller pad is needed");
    }
    if (!(least_radius_m > 0)) {
      throw refused_at(radius_rad, "(" + brief(at(radius_rad).flat_rad * kDegPerRad) +
                                       " deg of the flat follower's angle) the cam is undercut, its radius of "
                                       "curvature would be " +
                                       millimetres(least_radius_m) +
                                       "; a larger base circle or a blunter lift is needed");
    }
  }

  const Wanted& wanted_;
  double clearance_m_;
  std::unique_ptr<CamProfile> profile_;
  CamFromLift cam_;
};

}  // namespace

WantedCam cam_for_lift(const std::string& path, const Rocker& rocker, const WantedOptions& options) {
  const Wanted wanted = read_wanted(path, options.zero_lash ? rocker.clearance_m : 0);
  require_base_circle(wanted, rocker.clearance_m);
  WantedCam result;
  result.points = Inverse(wanted, rocker, result).table(options.step_deg);
  result.rows = wanted.rows;
  return result;
}

Status choose_smoothing(Cam& table, CamRows& rows) noexcept {
  if (const Status refused = survey_rows(table, rows); !refused.ok()) return refused;
  table.smoothing_m = millionths(parse_number(brief(rows.automatic_m * 1e6)).value);
  return {};
}

double deviation_m(const WantedCam& wanted, const ValveLift& lift) noexcept {
  double largest_m = 0;
  for (const CamPoint& row : wanted.rows) {
    const double given_m = lift.at((row.cam_deg - wanted.peak_deg) * kRadPerDeg).lift_m;
    largest_m = std::max(largest_m, std::abs(given_m - row.lift_m));
  }
  return largest_m;
}

}  // namespace crankloop::program
