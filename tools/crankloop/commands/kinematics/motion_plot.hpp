// The picture of `kinematics`: displacement, velocity, acceleration and rod angle over one turn.
//
// What belongs here: its drawings. What does not: writing files.
#pragma once

#include <string>

#include <crankloop/tabulate/mechanism.hpp>

namespace crankloop::program {

/// An SVG file. `pose` is drawn; `beside`: the approximations are dashed beside it, with their errors to the right.
[[nodiscard]] std::string motion_picture(const std::string& engine, const Crank& crank, PoseFunction pose,
                                         double speed_rad_s, bool beside);

}  // namespace crankloop::program
