// The geometry of the 125 cm^3 overhead-cam engine's valve train, for code that runs it without a file:
// tools/engines/ohc_125.ini [Li 2017].
//
// What belongs here: its cam and its rocker's geometry. What does not: clearance, phase and valve, which the user of
// this header chooses.
#pragma once

#include <crankloop/define/valve_train.hpp>

namespace crankloop::program {

inline void shape_as_ohc_125(Cam& cam, Rocker& rocker) {
  cam.max_lift_m = 6.301099e-3;
  cam.half_angle_deg = 74;
  for (const double p : {2, 10, 18, 26}) cam.exponents[cam.exponent_count++] = p;
  rocker.base_circle_m = 12.5e-3;
  rocker.pivot_to_pad_m = 39.61e-3;
  rocker.pivot_to_cam_m = 30.28e-3;
  rocker.pad_radius_m = 30e-3;
  rocker.pivot_to_screw_m = 33.28e-3;
  rocker.screw_ball_m = 10e-3;
  rocker.stem_above_pivot_m = 1.65e-3;
}

}  // namespace crankloop::program
