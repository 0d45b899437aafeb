// The plots below the picture of `crankloop cam --svg`: the contour's radius of curvature, and the lift.
#include <algorithm>
#include <cmath>

#include "../../files/units.hpp"
#include "../../report/text.hpp"
#include "cam_picture.hpp"

namespace crankloop::program {

using report::axis_of;
using report::number_text;
using report::Plot;
using report::plot_of;
using report::Series;

namespace {

constexpr double kPlotStepDeg = 0.25;

}  // namespace

Plot radius_plot(const ShownCam& shown) {
  const ValveLift& lift = shown.lift;
  const double from = lift.cam().opens_rad() * kDegPerRad;
  const double to = lift.cam().closes_rad() * kDegPerRad;
  Plot plot = plot_of("Radius of curvature", axis_of("Flat follower's cam angle from full lift", "deg"),
                      axis_of("Radius", "mm"));
  plot.y.logarithmic = true;
  Series radius;
  for (double at = from - 10; at <= to + 10; at += kPlotStepDeg) {
    const CamLift y = lift.cam().at(at * kRadPerDeg);
    radius.x.push_back(at);
    radius.y.push_back((shown.rocker.base_circle_m + y.lift_m + y.per_rad2_m) * kMilli);
  }
  plot.series = {radius};
  const double least_deg = lift.smallest_radius_at_deg();
  plot.markers = {{least_deg, lift.smallest_radius_m() * kMilli,
                   number_text(lift.smallest_radius_m() * kMilli, 3) + " mm at " + number_text(least_deg, 3) + "\u00B0",
                   0}};
  plot.x.range = report::Range{from - 10, to + 10};
  plot.x.tick_step = 30;
  return plot;
}

Plot lift_plot(const ShownCam& shown, double cam_deg) {
  const ValveLift& lift = shown.lift;
  const CamFromLift inverse(shown.rocker, lift.largest_lift_m());
  const double from = lift.opens_rad() * kDegPerRad - 10;
  const double to = lift.closes_rad() * kDegPerRad + 10;
  Plot plot = plot_of("Lift", axis_of("Cam angle from full lift", "deg"), axis_of("Lift", "mm"));
  Series valve{"valve", {}, {}, {}};
  Series follower{"flat follower at the contact", {}, {}, {}};
  for (double at = from; at <= to; at += kPlotStepDeg) {
    const LiftPose pose = lift.at(at * kRadPerDeg);
    valve.x.push_back(at);
    valve.y.push_back(std::max(pose.lift_m, 0.0) * kMilli);
    follower.x.push_back(at);
    follower.y.push_back(contact_of(inverse, at * kRadPerDeg, pose).lift_m * kMilli);
  }
  plot.series = {valve, follower};
  const double here = std::remainder(cam_deg, 360);
  const double lift_mm = std::max(lift.at(here * kRadPerDeg).lift_m, 0.0) * kMilli;
  if (here >= from && here <= to) plot.markers = {{here, lift_mm, number_text(lift_mm, 4) + " mm", 0}};
  plot.x.range = report::Range{from, to};
  plot.x.tick_step = 30;
  return plot;
}

}  // namespace crankloop::program
