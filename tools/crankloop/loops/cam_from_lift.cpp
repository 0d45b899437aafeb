#include "cam_from_lift.hpp"

#include <cmath>

#include <crankloop/tabulate/elementary.hpp>

#include "../files/units.hpp"

namespace crankloop::program {
namespace {

ContourPoint along(double length_m, const elementary::SinCos& direction) noexcept {
  return {length_m * direction.cos, length_m * direction.sin};
}
ContourPoint across(double length_m, const elementary::SinCos& direction) noexcept {
  return {-length_m * direction.sin, length_m * direction.cos};
}
ContourPoint operator+(const ContourPoint& a, const ContourPoint& b) noexcept { return {a.x_m + b.x_m, a.y_m + b.y_m}; }
double dot(const ContourPoint& a, const ContourPoint& b) noexcept { return a.x_m * b.x_m + a.y_m * b.y_m; }
double cross(const ContourPoint& a, const ContourPoint& b) noexcept { return a.x_m * b.y_m - a.y_m * b.x_m; }

/// The angle next to `near_rad` that is the same direction.
double next_to(double near_rad, double rad) noexcept {
  return rad - 2 * kPi * std::floor((rad - near_rad + kPi) / (2 * kPi));
}

/// Angle at O of the triangle O A Oc whose side Oc-A is R.
double angle_at_pivot(double l_a, double l_c, double R) noexcept {
  return elementary::acos((l_a * l_a + l_c * l_c - R * R) / (2 * l_a * l_c));
}

}  // namespace

ContourPoint contour_point(double base_circle_m, double flat_rad, const CamLift& y) noexcept {
  const elementary::SinCos flat = elementary::sin_cos(flat_rad);
  return along(base_circle_m + y.lift_m, flat) + across(y.per_rad_m, flat);
}

CamFromLift::CamFromLift(const Rocker& rocker, double largest_lift_m) noexcept
    : rocker_{rocker}, toward_{rocker.cam_turns == CamTurns::toward_pivot ? 1.0 : -1.0} {
  if (rocker.kind == RockerKind::ratio) return;
  const double base_m = rocker.base_circle_m + rocker.pad_radius_m;
  at_rest_rad_ = angle_at_pivot(rocker.pivot_to_pad_m, rocker.pivot_to_cam_m, base_m);
  screw_at_rest_rad_ = screw_rad(-rocker.clearance_m);
  // K_d: there the contact's normal goes through the cam's centre, and the pad's centre lies in the direction of full
  // lift.
  const elementary::SinCos W = elementary::sin_cos(rocker_rad(largest_lift_m));
  const double K =
      elementary::atan2(rocker.pivot_to_pad_m * W.sin, rocker.pivot_to_cam_m - rocker.pivot_to_pad_m * W.cos);
  pivot_at_full_lift_ = -toward_ * K;
}

bool CamFromLift::reaches(double lift_m) const noexcept {
  const double sine = (rocker_.screw_ball_m + rocker_.stem_above_pivot_m - lift_m) / rocker_.pivot_to_screw_m;
  if (!(sine > -1 && sine < 1)) return false;
  const double W = rocker_rad(lift_m);
  return W > 0 && W < kPi;
}

double CamFromLift::screw_rad(double lift_m) const noexcept {
  if (rocker_.kind == RockerKind::ratio) return 0;
  const double height_m = rocker_.screw_ball_m + rocker_.stem_above_pivot_m - lift_m;
  return elementary::asin(height_m / rocker_.pivot_to_screw_m);
}

double CamFromLift::rocker_rad(double lift_m) const noexcept {
  if (rocker_.kind == RockerKind::ratio) return 0;
  return at_rest_rad_ + screw_at_rest_rad_ - screw_rad(lift_m);
}

double CamFromLift::pivot_rad(double cam_rad) const noexcept { return cam_rad + pivot_at_full_lift_; }

FollowerPlace CamFromLift::follower(double cam_rad, double lift_m) const noexcept {
  const double pivot = pivot_rad(cam_rad);
  const ContourPoint O = along(rocker_.pivot_to_cam_m, elementary::sin_cos(pivot));
  const double arm = pivot + kPi - toward_ * rocker_rad(lift_m);
  return {O, O + along(rocker_.pivot_to_pad_m, elementary::sin_cos(arm))};
}

FlatContact CamFromLift::at(double cam_rad, const CamLift& valve) const noexcept {
  if (rocker_.kind == RockerKind::circular_pad) return pad_contact(cam_rad, valve);
  const double lift_m = (valve.lift_m + rocker_.clearance_m) / rocker_.ratio;
  return {cam_rad,
          lift_m,
          valve.per_rad_m / rocker_.ratio,
          rocker_.base_circle_m + lift_m + valve.per_rad2_m / rocker_.ratio,
          1,
          true};
}

/// The pad's centre A runs on a curve outside the cam's contour by the pad's radius, with the same normal.
FlatContact CamFromLift::pad_contact(double cam_rad, const CamLift& valve) const noexcept {
  if (!reaches(valve.lift_m)) return {};
  const elementary::SinCos screw = elementary::sin_cos(screw_rad(valve.lift_m));
  const double l_b = rocker_.pivot_to_screw_m;
  const double W_per_cam = valve.per_rad_m / (l_b * screw.cos);
  const double W_per_cam2 = (valve.per_rad2_m / l_b - screw.sin * W_per_cam * W_per_cam) / screw.cos;

  const double pivot = pivot_rad(cam_rad);
  const elementary::SinCos to_pivot = elementary::sin_cos(pivot);
  const elementary::SinCos arm = elementary::sin_cos(pivot + kPi - toward_ * rocker_rad(valve.lift_m));
  const double turns = 1 - toward_ * W_per_cam;  // of the arm, per turn of the cam
  const double l_a = rocker_.pivot_to_pad_m;
  const double l_c = rocker_.pivot_to_cam_m;
  const ContourPoint A = along(l_c, to_pivot) + along(l_a, arm);
  const ContourPoint first = across(l_c, to_pivot) + across(l_a * turns, arm);
  const ContourPoint second =
      along(-l_c, to_pivot) + across(-l_a * toward_ * W_per_cam2, arm) + along(-l_a * turns * turns, arm);

  const double speed = std::sqrt(dot(first, first));
  if (!(speed > 0)) return {};
  const ContourPoint tangent{first.x_m / speed, first.y_m / speed};
  const ContourPoint normal{tangent.y_m, -tangent.x_m};  // away from the cam
  FlatContact c;
  c.exists = true;
  c.flat_rad = next_to(cam_rad, elementary::atan2(normal.y_m, normal.x_m));
  c.lift_m = dot(A, normal) - rocker_.pad_radius_m - rocker_.base_circle_m;
  c.per_rad_m = dot(A, tangent);
  c.flat_per_cam = cross(first, second) / (speed * speed);
  c.curvature_radius_m = speed / c.flat_per_cam - rocker_.pad_radius_m;
  return c;
}

}  // namespace crankloop::program
