// From the rows of a measured cam to a smooth lobe.
#pragma once

#include <crankloop/define/valve_train.hpp>
#include <crankloop/tabulate/cam_profile.hpp>

namespace crankloop::detail {

/// The row with the largest deviation, and its lift less the lobe's.
struct CamResidual {
  double off_m;
  int row;
};

/// The smoothest lobe whose distance from every row is at most cam.smoothing_m, angles as in the table. `residual_m`:
/// the largest distance. Refuses a table without a lobe that begins and ends on the base circle (inconsistent
/// "cam.points", the row), a lobe of nearly a turn (out_of_range "cam.points"), and a residual that no lobe keeps
/// (no_solution "cam.smoothing_m"). Takes 27 kB of stack and some milliseconds.
Status smooth_cam(const Cam& cam, LobeSpline& lobe, double& residual_m) noexcept;

/// The residual of the closest lobe that smooth_cam() tries; smooth_cam() refuses a smaller cam.smoothing_m. Refuses
/// what smooth_cam() refuses of "cam.points".
Status closest_lobe(const Cam& cam, LobeSpline& lobe, CamResidual& closest) noexcept;

/// Angle of largest lift.
[[nodiscard]] double peak_of(const LobeSpline& lobe) noexcept;

}  // namespace crankloop::detail
