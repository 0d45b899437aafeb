// The sheet of `crankloop cam --smoothing`: what a measured table's rows say, and the lobe that replaces them.
#include <algorithm>
#include <cmath>

#include "../../files/units.hpp"
#include "cam_picture.hpp"

namespace crankloop::program {
namespace {

using report::axis_of;
using report::Plot;
using report::plot_of;
using report::Series;

constexpr double kJerkStep_rad = 1e-4;  // of differences of y'', which is a cubic between knots
constexpr double kSmoothingStepDeg = 0.25;
constexpr double kAroundLobe_deg = 10;

/// A derivative of the rows by divided differences of their neighbours, each between the places of the two.
struct RowDerivative {
  std::vector<double> deg{};
  std::vector<double> m{};  ///< per rad to the order of the derivative

  [[nodiscard]] RowDerivative derived() const {
    RowDerivative next;
    for (std::size_t i = 1; i < deg.size(); ++i) {
      next.deg.push_back((deg[i - 1] + deg[i]) / 2);
      next.m.push_back((m[i] - m[i - 1]) / ((deg[i] - deg[i - 1]) * kRadPerDeg));
    }
    return next;
  }
};

/// Rows around the lobe, their angles from the smooth peak.
RowDerivative rows_near(const std::vector<CamPoint>& rows, const CamProfile& smooth) {
  RowDerivative near;
  for (const CamPoint& row : rows) {
    const double deg = row.cam_deg - smooth.peak_deg();
    if (deg < smooth.opens_rad() * kDegPerRad - kAroundLobe_deg ||
        deg > smooth.closes_rad() * kDegPerRad + kAroundLobe_deg)
      continue;
    near.deg.push_back(deg);
    near.m.push_back(row.lift_m);
  }
  return near;
}

Series before(const RowDerivative& rows, double factor) {
  Series series{"rows, by differences", rows.deg, rows.m, {}};
  for (double& y : series.y) y *= factor;
  series.style.colour = 6;
  return series;
}

template <class Value>
Series after(const CamProfile& smooth, double factor, const Value& value) {
  Series series{"smoothed", {}, {}, {}};
  series.style.colour = 2;
  const double from_deg = smooth.opens_rad() * kDegPerRad - kAroundLobe_deg;
  const double to_deg = smooth.closes_rad() * kDegPerRad + kAroundLobe_deg;
  for (double deg = from_deg; deg <= to_deg; deg += kSmoothingStepDeg) {
    series.x.push_back(deg);
    series.y.push_back(value(deg * kRadPerDeg) * factor);
  }
  return series;
}

Plot over_cam(const CamProfile& smooth, const char* title, const char* y, const char* unit,
              std::vector<Series> curves) {
  Plot plot = plot_of(title, axis_of("Flat follower's cam angle from full lift", "deg"), axis_of(y, unit));
  plot.x.range = report::Range{smooth.opens_rad() * kDegPerRad - kAroundLobe_deg,
                               smooth.closes_rad() * kDegPerRad + kAroundLobe_deg};
  plot.x.tick_step = 30;
  plot.series = std::move(curves);
  return plot;
}

}  // namespace

report::Sheet smoothing_sheet(const std::vector<CamPoint>& rows, const CamProfile& smooth) {
  const RowDerivative lift = rows_near(rows, smooth);
  RowDerivative residual = lift;
  for (std::size_t i = 0; i < residual.m.size(); ++i) residual.m[i] -= smooth.at(residual.deg[i] * kRadPerDeg).lift_m;
  const RowDerivative speed = lift.derived();
  const RowDerivative acceleration = speed.derived();
  const RowDerivative jerk = acceleration.derived();
  Series rest{"rows less smoothed lift", residual.deg, residual.m, {}};
  for (double& y : rest.y) y *= kMicro;
  rest.style.colour = 1;
  rest.style.draw = report::Draw::points;
  rest.name.clear();
  const auto smooth_jerk = [&](double rad) {
    return (smooth.at(rad + kJerkStep_rad).per_rad2_m - smooth.at(rad - kJerkStep_rad).per_rad2_m) /
           (2 * kJerkStep_rad);
  };
  Plot rest_plot = over_cam(smooth, "Residual: each row less the smoothed lift", "Lift", "\u00B5m", {std::move(rest)});
  const double widest_um = 1.15 * smooth.residual_m() * kMicro;
  rest_plot.y.range = report::Range{-widest_um, widest_um};
  report::Sheet sheet;
  sheet.plots = {
      std::move(rest_plot),
      over_cam(smooth, "Velocity of the flat follower", "Velocity", "mm/rad",
               {before(speed, kMilli), after(smooth, kMilli, [&](double rad) { return smooth.at(rad).per_rad_m; })}),
      over_cam(
          smooth, "Acceleration", "Acceleration", "mm/rad\u00B2",
          {before(acceleration, kMilli), after(smooth, kMilli, [&](double rad) { return smooth.at(rad).per_rad2_m; })}),
      over_cam(smooth, "Jerk", "Jerk", "mm/rad\u00B3", {before(jerk, kMilli), after(smooth, kMilli, smooth_jerk)})};
  return sheet;
}

}  // namespace crankloop::program
