// The picture of `crankloop cam --svg`: cam, pad and rocker at one cam angle, to scale, with curvature and lift below.
//
// What belongs here: places and labels. What does not: outlines (cam_canvas.hpp), their contact
// (loops/cam_from_lift.hpp), the sheet (report/sheet.hpp).
#pragma once

#include <string>
#include <vector>

#include <crankloop/define/valve_train.hpp>
#include <crankloop/tabulate/valve_lift.hpp>

#include "../../loops/cam_from_lift.hpp"
#include "../../report/sheet.hpp"

namespace crankloop::program {

/// A train whose geometry ValveLift has accepted.
struct ShownCam {
  const Rocker& rocker;
  const ValveLift& lift;
  double stem_m = 0;  ///< diameter of the valve's stem; 0: not known
};

/// Where the cam touches its follower at a cam angle whose lift is `pose`.
[[nodiscard]] FlatContact contact_of(const CamFromLift& inverse, double cam_rad, const LiftPose& pose);

[[nodiscard]] report::Plot radius_plot(const ShownCam& shown);
/// Marks the valve's lift at `cam_deg`.
[[nodiscard]] report::Plot lift_plot(const ShownCam& shown, double cam_deg);

/// Title and remarks are the caller's.
[[nodiscard]] report::Sheet cam_sheet(const ShownCam& shown, double cam_deg);

/// A measured table before and after its smoothing: residual, velocity, acceleration and jerk of the flat follower.
[[nodiscard]] report::Sheet smoothing_sheet(const std::vector<CamPoint>& rows, const CamProfile& smooth);

}  // namespace crankloop::program
