// The cam for a wanted valve lift, as the table that an engine file reads: docs/model.md "Profile".
//
// What belongs here: files of wanted lifts, and why there is no cam for one. What does not: the contact at one place
// (loops/cam_from_lift.hpp).
#pragma once

#include <string>
#include <vector>

#include <crankloop/define/valve_train.hpp>
#include <crankloop/tabulate/cam_profile.hpp>
#include <crankloop/tabulate/valve_lift.hpp>

namespace crankloop::program {

/// A designed cam, and the lift that it is for.
struct WantedCam {
  std::vector<CamPoint> rows{};    ///< of the wanted lift: the train's, minus the clearance on the base circle
  std::vector<CamPoint> points{};  ///< of the cam's flat follower, with the 12 digits of their file
  double smoothing_m = 0;          ///< of the wanted lift's rows, chosen by their scatter
  double residual_m = 0;           ///< largest distance of a row from the smooth wanted lift
  double peak_deg = 0;             ///< cam angle of the wanted lift's peak in its file, here 0
  std::string misread{};           ///< the row that makes the smoothing large; "" where none does
};

struct WantedOptions {
  double step_deg = 1;     ///< between rows of the cam's table, of the flat follower's angle
  bool zero_lash = false;  ///< the wanted lift is that without clearance: 0 on the base circle
};

/// Throws InputError, with the angle, where no cam of this rocker gives the lift: a step where it leaves its clearance,
/// a screw or pad out of reach, a contour that turns back or is undercut.
[[nodiscard]] WantedCam cam_for_lift(const std::string& path, const Rocker& rocker, const WantedOptions& options);

/// Chooses smoothing_m by the scatter of the rows, as an engine file with `smoothing_um = auto` does.
Status choose_smoothing(Cam& table, CamRows& rows) noexcept;

/// The largest distance of a wanted row from the lift that the designed cam gives, read from its table again.
[[nodiscard]] double deviation_m(const WantedCam& wanted, const ValveLift& lift) noexcept;

}  // namespace crankloop::program
