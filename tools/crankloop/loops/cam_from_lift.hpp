// From the valve's lift back to the cam: the contour whose contact with the follower gives that lift. Formulas:
// docs/model.md "Profile".
//
// What belongs here: one place of the lobe, in double. What does not: cam to lift (tabulate/valve_lift.hpp), files of
// wanted lifts (commands/cam).
#pragma once

#include <crankloop/define/valve_train.hpp>
#include <crankloop/tabulate/cam_profile.hpp>

namespace crankloop::program {

/// Where cam and follower touch, as the flat follower that would touch there.
struct FlatContact {
  double flat_rad = 0;            ///< phi, within half a turn of the cam angle
  double lift_m = 0;              ///< y
  double per_rad_m = 0;           ///< y', by phi
  double curvature_radius_m = 0;  ///< of the contour, r_0 + y + y''; below 0 where it is hollow
  double flat_per_cam = 0;        ///< dphi/dphi_r; not above 0: the contour turns back
  bool exists = false;            ///< false: the screw or the pad cannot stand where this lift needs them
};

/// The profile in the cam's frame: x toward full lift, angles as phi grows.
struct ContourPoint {
  double x_m;
  double y_m;
};
[[nodiscard]] ContourPoint contour_point(double base_circle_m, double flat_rad, const CamLift& y) noexcept;

/// Where pad centre and pivot stand in the cam's frame.
struct FollowerPlace {
  ContourPoint pivot;
  ContourPoint pad_centre;
};

/// The inverse of ValveLift for one rocker and one largest lift.
class CamFromLift {
 public:
  /// The rocker is valid; the largest lift is that at cam angle 0.
  CamFromLift(const Rocker& rocker, double largest_lift_m) noexcept;

  /// The train's unclipped lift at a cam angle, with its derivatives by the cam angle. Exact to rounding.
  [[nodiscard]] FlatContact at(double cam_rad, const CamLift& valve) const noexcept;

  /// W, by the lift; 0 for a constant ratio.
  [[nodiscard]] double rocker_rad(double lift_m) const noexcept;
  /// psi, of the screw above the pivot's level; 0 for a constant ratio.
  [[nodiscard]] double screw_rad(double lift_m) const noexcept;
  [[nodiscard]] FollowerPlace follower(double cam_rad, double lift_m) const noexcept;

 private:
  [[nodiscard]] bool reaches(double lift_m) const noexcept;
  [[nodiscard]] double pivot_rad(double cam_rad) const noexcept;
  [[nodiscard]] FlatContact pad_contact(double cam_rad, const CamLift& valve) const noexcept;

  Rocker rocker_;
  double toward_ = 1;              ///< -1: the cam turns away from the pivot
  double at_rest_rad_ = 0;         ///< W_0
  double screw_at_rest_rad_ = 0;   ///< psi_0
  double pivot_at_full_lift_ = 0;  ///< polar angle of the pivot at cam angle 0
};

}  // namespace crankloop::program
