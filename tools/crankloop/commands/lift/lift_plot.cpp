#include "lift_plot.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "../../files/units.hpp"
#include "../../loops/lift_jerk.hpp"
#include "../../report/text.hpp"

namespace crankloop::program {
namespace {

using report::axis_of;
using report::number_text;
using report::Plot;
using report::plot_of;
using report::Series;

constexpr double kMm2PerM2 = 1e6;
constexpr double kLiftStepDeg = 0.25;
constexpr double kAroundLift_deg = 10;

using Value = std::function<double(const LiftPose&, double cam_rad)>;

Series curve(const ValveLift& lift, const char* name, double factor, const Value& value) {
  Series series{name, {}, {}, {}};
  const double from_deg = lift.opens_rad() * kDegPerRad - kAroundLift_deg;
  const double to_deg = lift.closes_rad() * kDegPerRad + kAroundLift_deg;
  for (double deg = from_deg; deg <= to_deg; deg += kLiftStepDeg) {
    series.x.push_back(deg);
    series.y.push_back(factor * value(lift.at(deg * kRadPerDeg), deg * kRadPerDeg));
  }
  return series;
}

Plot over_cam(const ValveLift& lift, const char* title, const char* y, const std::string& unit,
              std::vector<Series> curves) {
  Plot plot = plot_of(title, axis_of("Cam angle from full lift", "deg"), axis_of(y, unit));
  plot.x.range =
      report::Range{lift.opens_rad() * kDegPerRad - kAroundLift_deg, lift.closes_rad() * kDegPerRad + kAroundLift_deg};
  plot.x.tick_step = 30;
  plot.series = std::move(curves);
  return plot;
}

/// A derivative by the cam angle: its units per rad and, at a speed, per second.
struct Derivative {
  const char* title;
  int order;
  const char* per_rad;
  const char* per_second;
  double second_units;  ///< of per_second in one of m/s^order
  Value value;
};

/// Its largest and smallest value are marked in both units.
Plot derivative_plot(const ShownLift& shown, const Derivative& d) {
  const double per_s = shown.speed_rpm ? d.second_units * std::pow(shown.cam_rad_s(), d.order) : kMilli;
  const std::string unit = shown.speed_rpm ? d.per_second : d.per_rad;
  Plot plot = over_cam(shown.lift, d.title, d.title, unit, {curve(shown.lift, "", per_s, d.value)});
  const Series& drawn = plot.series[0];
  const auto mark = [&](std::size_t i) {
    std::string label = number_text(drawn.y[i], 3) + ' ' + unit;
    if (shown.speed_rpm) label += ", " + number_text(drawn.y[i] / per_s * kMilli, 3) + ' ' + d.per_rad;
    plot.markers.push_back({drawn.x[i], drawn.y[i], label, 0});
  };
  const auto [low, high] = std::minmax_element(drawn.y.begin(), drawn.y.end());
  mark(static_cast<std::size_t>(high - drawn.y.begin()));
  mark(static_cast<std::size_t>(low - drawn.y.begin()));
  return plot;
}

Plot lift_plot(const ShownLift& shown) {
  Plot plot =
      over_cam(shown.lift, "Theoretical lift", "Lift", "mm",
               {curve(shown.lift, "", kMilli, [](const LiftPose& p, double) { return std::max(p.lift_m, 0.0); })});
  plot.markers = {
      {0, shown.lift.largest_lift_m() * kMilli, number_text(shown.lift.largest_lift_m() * kMilli, 4) + " mm", 0}};
  return plot;
}

Plot area_plot(const ShownLift& shown) {
  const FlowArea& area = *shown.area;
  Plot plot = over_cam(shown.lift, "Flow area of one valve", "Area", "mm\u00B2",
                       {curve(shown.lift, "geometric", kMm2PerM2,
                              [&](const LiftPose& p, double) { return area.geometric_m2(p.lift_m); }),
                        curve(shown.lift, "effective", kMm2PerM2,
                              [&](const LiftPose& p, double) { return area.effective_m2(p.lift_m); })});
  plot.series[1].style.dashed = true;
  return plot;
}

}  // namespace

report::Sheet lift_sheet(const ShownLift& shown) {
  const ValveLift& lift = shown.lift;
  report::Sheet sheet;
  sheet.plots = {lift_plot(shown),
                 derivative_plot(
                     shown, {"Velocity", 1, "mm/rad", "m/s", 1, [](const LiftPose& p, double) { return p.per_rad_m; }}),
                 derivative_plot(shown, {"Acceleration", 2, "mm/rad\u00B2", "m/s\u00B2", 1,
                                         [](const LiftPose& p, double) { return p.per_rad2_m; }}),
                 derivative_plot(shown, {"Jerk", 3, "mm/rad\u00B3", "mm/ms\u00B3", 1e-6,
                                         [&](const LiftPose&, double rad) { return lift_jerk_m(lift, rad); }}),
                 over_cam(lift, "Rocker ratio", "Ratio", "",
                          {curve(lift, "", 1, [](const LiftPose& p, double) { return p.rocker_ratio; })})};
  if (shown.area) sheet.plots.push_back(area_plot(shown));
  return sheet;
}

}  // namespace crankloop::program
