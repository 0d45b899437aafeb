// Two frames: the cam's own, in which contours and contacts are computed, and the picture's, in mm with y upward. The
// picture's origin is the rocker's pivot, the valve opens downward on its left, and the contact with the base circle is
// level with the pivot; without a rocker the origin is the cam's centre and the flat follower lies above it.
#include "cam_picture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../../files/units.hpp"
#include "../../report/text.hpp"
#include "cam_canvas.hpp"

namespace crankloop::program {
namespace {

using report::number_text;

constexpr double kContourStepDeg = 0.25;

// ---- places --------------------------------------------------------------------------------------------------------

/// From the cam's frame to the picture's: the cam's centre, and how angles turn.
struct CamFrame {
  Place centre;
  double at_rad;  ///< direction in the picture of polar angle from_rad in the cam's frame
  double from_rad;
  double sense;  ///< -1: mirrored

  [[nodiscard]] double turned(double rad) const { return at_rad + sense * (rad - from_rad); }
  [[nodiscard]] Place operator()(const ContourPoint& p) const {
    return centre + toward(std::hypot(p.x_m, p.y_m) * kMilli, turned(std::atan2(p.y_m, p.x_m)));
  }
};

/// All that the picture shows of one cam angle.
struct Scene {
  const ShownCam& shown;
  CamFromLift inverse;
  double cam_rad;
  LiftPose pose;
  FlatContact contact;
  CamFrame frame{};

  [[nodiscard]] const Rocker& rocker() const { return shown.rocker; }
  [[nodiscard]] bool has_pad() const { return rocker().kind == RockerKind::circular_pad; }
  [[nodiscard]] CamLift follower_at(double flat_rad) const { return shown.lift.cam().at(flat_rad); }
  [[nodiscard]] Place contour(double flat_rad) const {
    return frame(contour_point(rocker().base_circle_m, flat_rad, follower_at(flat_rad)));
  }
};

/// The direction of the cam's centre from the pivot that puts the contact with the base circle level with the pivot.
double cam_direction(const Rocker& rocker, double rest_rad) {
  const Place centre{rocker.pivot_to_cam_m, 0};
  const Place pad = toward(rocker.pivot_to_pad_m, rest_rad);
  return -direction(centre + toward(rocker.base_circle_m, direction(pad - centre)));
}

CamFrame frame_of(const Scene& s) {
  const Rocker& rocker = s.rocker();
  if (!s.has_pad()) return {{0, 0}, kPi / 2, s.cam_rad, -1};
  const double from_pivot = cam_direction(rocker, s.inverse.rocker_rad(-rocker.clearance_m));
  const ContourPoint pivot = s.inverse.follower(s.cam_rad, s.pose.lift_m).pivot;
  return {toward(rocker.pivot_to_cam_m * kMilli, from_pivot), from_pivot + kPi, std::atan2(pivot.y_m, pivot.x_m),
          rocker.cam_turns == CamTurns::toward_pivot ? -1.0 : 1.0};
}

Scene scene_of(const ShownCam& shown, double cam_deg) {
  Scene s{shown, CamFromLift(shown.rocker, shown.lift.largest_lift_m()), cam_deg * kRadPerDeg, {}, {}};
  s.pose = shown.lift.at(s.cam_rad);
  s.contact = contact_of(s.inverse, s.cam_rad, s.pose);
  s.frame = frame_of(s);
  return s;
}

// ---- drawing -------------------------------------------------------------------------------------------------------

void draw_cam(Canvas& canvas, const Scene& s) {
  Outline contour;
  for (double deg = -180; deg < 180; deg += kContourStepDeg) contour.push_back(s.contour(deg * kRadPerDeg));
  const double base = s.rocker().base_circle_m * kMilli;
  canvas.path("cam", contour, true);
  canvas.circle("thin dashes", s.frame.centre, base);
  canvas.cross(s.frame.centre, 0.25 * base);
  // The turn: an arrow inside the base circle, against the sense in which the flat angle grows.
  const double end_rad = s.frame.at_rad + s.frame.sense * 2.2;
  Outline turn;
  add_arc(turn, s.frame.centre, 0.62 * base, end_rad, end_rad - s.frame.sense * 1.5);
  const Place tip = turn.back();
  const double along = direction(tip - turn[turn.size() - 2]);
  canvas.path("thin", turn, false);
  canvas.path("thin", {tip + toward(0.12 * base, along + 2.7), tip, tip + toward(0.12 * base, along - 2.7)}, false);
  const Place least = s.contour(s.shown.lift.smallest_radius_at_deg() * kRadPerDeg);
  canvas.circle("dot", least, 0.03 * base);
}

/// Directions on the pad, from its centre in the cam's frame less that of the pivot, between which the contact runs.
std::pair<double, double> contact_range(const Scene& s) {
  std::pair<double, double> range{10, -10};
  constexpr int kPlaces = 400;
  const ValveLift& lift = s.shown.lift;
  for (int i = 0; i <= kPlaces; ++i) {
    const double rad = lift.opens_rad() + i * (lift.closes_rad() - lift.opens_rad()) / kPlaces;
    const LiftPose pose = lift.at(rad);
    const FollowerPlace at = s.inverse.follower(rad, pose.lift_m);
    const double to_pivot = std::atan2(at.pivot.y_m - at.pad_centre.y_m, at.pivot.x_m - at.pad_centre.x_m);
    const double there = std::remainder(contact_of(s.inverse, rad, pose).flat_rad + kPi - to_pivot, 2 * kPi);
    range = {std::min(range.first, there), std::max(range.second, there)};
  }
  return range;
}

struct Pad {
  Place centre;
  double radius;
  double from_rad;  ///< in the picture, of the part that the contact sweeps
  double to_rad;
};

Pad pad_of(const Scene& s) {
  const FollowerPlace at = s.inverse.follower(s.cam_rad, s.pose.lift_m);
  const double to_pivot = std::atan2(at.pivot.y_m - at.pad_centre.y_m, at.pivot.x_m - at.pad_centre.x_m);
  const auto [low, high] = contact_range(s);
  const double a = s.frame.turned(to_pivot + low);
  const double b = s.frame.turned(to_pivot + high);
  return {s.frame(at.pad_centre), s.rocker().pad_radius_m * kMilli, std::min(a, b), std::max(a, b)};
}

void draw_rocker(Canvas& canvas, const Scene& s, const Pad& pad, const Place& ball) {
  const double arm = s.rocker().pivot_to_screw_m * kMilli;
  const double boss = 0.2 * arm;
  const double beyond_rad = std::min(2.5 / pad.radius, 0.6);  // 2.5 mm of pad beside the contact
  const double from_rad = pad.from_rad - beyond_rad;
  const double to_rad = pad.to_rad + beyond_rad;
  Outline face;
  add_arc(face, pad.centre, pad.radius, from_rad, to_rad);
  const double back = std::max(pad.radius - 0.8 * boss, 0.0);
  Outline segment = face;
  add_arc(segment, pad.centre, back, to_rad, from_rad);
  const bool from_is_near = length(face.front()) < length(face.back());
  Outline cam_arm{from_is_near ? face.front() : face.back()};
  add_arc(cam_arm, pad.centre, back, from_rad, to_rad);
  add_arc(cam_arm, {0, 0}, boss, 0, 2 * kPi);
  Outline valve_arm;
  add_arc(valve_arm, {0, 0}, boss, 0, 2 * kPi);
  add_arc(valve_arm, ball, 0.8 * boss, 0, 2 * kPi);
  for (const char* layer : {"edge", "body"}) {  // the fills cover the edges inside
    canvas.path(layer, segment, true);
    canvas.path(layer, around(cam_arm), true);
    canvas.path(layer, around(valve_arm), true);
  }
  canvas.path("outline", face, false);
  Outline rubbed;
  add_arc(rubbed, pad.centre, pad.radius, pad.from_rad, pad.to_rad);
  canvas.path("rubbed", rubbed, false);
  canvas.circle("pin", {0, 0}, 0.5 * boss);
}

/// The adjusting screw: a shaft that ends in a part of its ball, and stands square on its arm.
void draw_screw(Canvas& canvas, const Scene& s, const Place& ball) {
  const double radius = s.rocker().screw_ball_m * kMilli;
  const double half = std::max(std::min(radius, 0.1 * s.rocker().pivot_to_screw_m * kMilli), 0.5);
  const double tilt = s.inverse.screw_rad(s.shown.lift.largest_lift_m() / 2) - s.inverse.screw_rad(s.pose.lift_m);
  const double edge = radius > half ? std::asin(half / radius) : kPi / 2;
  Outline screw{ball + toward(half, tilt) + toward(2.6 * half, tilt + kPi / 2),
                ball - toward(half, tilt) + toward(2.6 * half, tilt + kPi / 2)};
  add_arc(screw, ball, std::max(radius, 0.01), tilt - kPi / 2 - edge, tilt - kPi / 2 + edge);
  canvas.path("screw", screw, true);
}

void draw_stem(Canvas& canvas, const Scene& s) {
  const Rocker& r = s.rocker();
  const double arm = r.pivot_to_screw_m * kMilli;
  const double half = (s.shown.stem_m > 0 ? s.shown.stem_m / 2 * kMilli : 0.09 * arm);
  const double x =
      -arm * (std::cos(s.inverse.screw_rad(0)) + std::cos(s.inverse.screw_rad(s.shown.lift.largest_lift_m()))) / 2;
  const double end = (r.stem_above_pivot_m - std::max(s.pose.lift_m, 0.0)) * kMilli;
  const double foot = r.stem_above_pivot_m * kMilli - s.shown.lift.largest_lift_m() * kMilli - 0.55 * arm;
  canvas.path("stem", {{x - half, foot}, {x - half, end}, {x + half, end}, {x + half, foot}}, false);
  canvas.line("centre", {x, foot - 2}, {x, end + 3});
  canvas.label({x - half, foot}, -10, -4, "valve");
}

/// Lever lengths between centres, and the contact's normal.
void draw_levers(Canvas& canvas, const Scene& s, const Pad& pad, const Place& ball) {
  const Rocker& r = s.rocker();
  const auto lever = [&](const Place& a, const Place& b, double length_m, double right, double down) {
    canvas.line("lever", a, b);
    canvas.label({(a.x + b.x) / 2, (a.y + b.y) / 2}, right, down, number_text(length_m * kMilli, 4));
  };
  lever({0, 0}, pad.centre, r.pivot_to_pad_m, -8, 0);
  lever({0, 0}, s.frame.centre, r.pivot_to_cam_m, -6, 16);
  lever({0, 0}, ball, r.pivot_to_screw_m, 4, -14);
  const Place contact = s.contour(s.contact.flat_rad);
  const double along = direction(pad.centre - contact);
  const double reach = 0.25 * r.pivot_to_cam_m * kMilli;
  canvas.line("normal", contact - toward(1.6 * reach, along), pad.centre + toward(0.4 * reach, along));
  canvas.cross(pad.centre, 1.5);
  canvas.label(pad.centre, 12, -8, "pad centre, radius " + number_text(r.pad_radius_m * kMilli, 4) + " mm");
}

void draw_contact(Canvas& canvas, const Scene& s) {
  canvas.circle("contact", s.contour(s.contact.flat_rad), 0.045 * s.rocker().base_circle_m * kMilli);
}

void draw_with_rocker(Canvas& canvas, const Scene& s) {
  const Pad pad = pad_of(s);
  const double psi = s.inverse.screw_rad(s.pose.lift_m);
  const Place ball = toward(s.rocker().pivot_to_screw_m * kMilli, kPi - psi);
  draw_rocker(canvas, s, pad, ball);
  draw_screw(canvas, s, ball);
  draw_stem(canvas, s);
  draw_cam(canvas, s);
  draw_levers(canvas, s, pad, ball);
  canvas.cross({0, 0}, 0.06 * s.rocker().pivot_to_screw_m * kMilli);
  canvas.label({0, 0}, -8, 68, "pivot");
  draw_contact(canvas, s);
}

/// A flat follower: its face spans what the contact sweeps.
void draw_with_flat(Canvas& canvas, const Scene& s) {
  double half = 0;
  for (double deg = -180; deg < 180; deg += kContourStepDeg)
    half = std::max(half, std::abs(s.follower_at(deg * kRadPerDeg).per_rad_m) * kMilli);
  half += 2.5;
  const double face = (s.rocker().base_circle_m + s.contact.lift_m) * kMilli;
  const double thick = 0.3 * s.rocker().base_circle_m * kMilli;
  draw_cam(canvas, s);
  const Outline plate{{-half, face}, {half, face}, {half, face + thick}, {-half, face + thick}};
  canvas.path("edge", plate, true);
  canvas.path("body", plate, true);
  canvas.path("outline", {{-half, face}, {half, face}}, false);
  canvas.line("centre", {0, -0.4 * face}, {0, face + 2 * thick});
  draw_contact(canvas, s);
}

std::string mm(double metres, int digits = 4) { return number_text(metres * kMilli, digits) + " mm"; }
std::string deg(double radians) { return number_text(radians * kDegPerRad, 4) + "\u00B0"; }

Figures figures_of(const Scene& s) {
  Figures figures{
      {"Cam angle from full lift", deg(s.cam_rad)},
      {"Flat follower's angle of the contact", deg(s.contact.flat_rad)},
      {"Lift of the flat follower", mm(s.contact.lift_m)},
      {"Valve lift", s.pose.lift_m > 0 ? mm(s.pose.lift_m) : "0, lash " + mm(-s.pose.lift_m, 3)},
      {"Rocker ratio", number_text(s.pose.rocker_ratio, 4)},
      {"Radius of curvature at the contact", mm(s.contact.curvature_radius_m)},
      {"Least radius of curvature, at the dot", mm(s.shown.lift.smallest_radius_m(), 3)},
      {"Base circle, radius", mm(s.rocker().base_circle_m)},
  };
  if (!s.has_pad()) return figures;
  const auto [low, high] = contact_range(s);
  figures.emplace_back("Contact travels on the pad", mm((high - low) * s.rocker().pad_radius_m, 3));
  return figures;
}

report::Picture picture_of(const Scene& s) {
  Canvas canvas;
  s.has_pad() ? draw_with_rocker(canvas, s) : draw_with_flat(canvas, s);
  return canvas.picture(figures_of(s));
}

}  // namespace

FlatContact contact_of(const CamFromLift& inverse, double cam_rad, const LiftPose& pose) {
  return inverse.at(cam_rad, {pose.lift_m, pose.per_rad_m, pose.per_rad2_m});
}

report::Sheet cam_sheet(const ShownCam& shown, double cam_deg) {
  const Scene s = scene_of(shown, cam_deg);
  report::Sheet sheet;
  sheet.picture = picture_of(s);
  sheet.plots = {radius_plot(shown), lift_plot(shown, cam_deg)};
  return sheet;
}

}  // namespace crankloop::program
