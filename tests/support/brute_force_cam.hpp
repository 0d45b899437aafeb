// Cam and rocker by brute force: a turned convex body and a circle that touches it. No formula of the rocker's
// kinematics, no derivative.
//
// A flat follower of direction n(theta) stands base + y(theta) above the cam's centre, so the cam is what lies below
// all of them, and the distance of a point P outside it is the largest P n(theta) - (base + y(theta)) over theta.
//
//        A  pad centre, l_a from O            x axis: from the cam's centre Oc to the pivot O
//       / \                                   A = O + l_a (-cos W, sin W)
//     Oc---O                                  the contact lies above, so the cam turns toward the pivot clockwise
#pragma once

#include <crankloop/define/valve_train.hpp>

#include <cmath>
#include <functional>

#include "support/units.hpp"

namespace crankloop::support {

struct BruteForceCam {
  Rocker rocker;
  std::function<double(double)> follower_lift_m;  ///< y over phi in rad, -pi to pi, 0 at full lift

  struct Touch {
    double gap_m;    ///< of the pad's circle and the cam, less than 0 where they overlap
    double phi_rad;  ///< the flat follower's angle that touches at the same point
  };

  /// The cam is turned by `turned_rad` in its sense of rotation from where its nose points along the x axis.
  [[nodiscard]] Touch touch(double rocker_rad, double turned_rad) const {
    const double x = rocker.pivot_to_cam_m - rocker.pivot_to_pad_m * std::cos(rocker_rad);
    const double y = rocker.pivot_to_pad_m * std::sin(rocker_rad);
    // On a cam that turns clockwise phi grows counter-clockwise, so that its larger angles come by later; and the other
    // way round.
    const double sense = rocker.cam_turns == CamTurns::toward_pivot ? 1 : -1;
    const auto above = [&](double phi) {
      const double in_space = sense * (phi - turned_rad);
      return x * std::cos(in_space) + y * std::sin(in_space) - rocker.base_circle_m - follower_lift_m(wrapped(phi));
    };
    constexpr int kDirections = 360;
    constexpr double kStep = 2 * kPi / kDirections;
    double best = 0;
    for (int i = 1; i < kDirections; ++i) {
      if (above(i * kStep) > above(best)) best = i * kStep;
    }
    double low = best - kStep;
    double high = best + kStep;
    while (high - low > 1e-9) {  // flat at the top: the distance is good to rounding, phi to its square root
      const double third = (high - low) / 3;
      if (above(low + third) < above(high - third)) {
        low += third;
      } else {
        high -= third;
      }
    }
    return {above((low + high) / 2) - rocker.pad_radius_m, wrapped((low + high) / 2)};
  }

  /// The rocker's angle W at which the pad touches, by bisection between 1 and 179 deg.
  [[nodiscard]] double rocker_rad(double turned_rad) const {
    double low = kPi / 180;  // overlaps
    double high = kPi - kPi / 180;
    while (high - low > 1e-15) {
      const double middle = (low + high) / 2;
      if (middle == low || middle == high) break;
      (touch(middle, turned_rad).gap_m < 0 ? low : high) = middle;
    }
    return (low + high) / 2;
  }

  /// The turn at which the rocker stands highest: full lift.
  [[nodiscard]] double turned_at_full_lift_rad() const {
    // There the nose points at the pad's centre: by the triangle with the sides l_a, l_c and the nose's height.
    const double side = rocker.base_circle_m + rocker.pad_radius_m + follower_lift_m(0);
    const double l_a = rocker.pivot_to_pad_m;
    const double l_c = rocker.pivot_to_cam_m;
    const double at_cam = std::acos((l_c * l_c + side * side - l_a * l_a) / (2 * l_c * side));
    return rocker.cam_turns == CamTurns::toward_pivot ? -at_cam : at_cam;
  }

  static double wrapped(double rad) { return rad - 2 * kPi * std::floor((rad + kPi) / (2 * kPi)); }
};

}  // namespace crankloop::support
