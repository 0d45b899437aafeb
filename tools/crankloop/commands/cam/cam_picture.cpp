// Two frames: the cam's own, in which contours and contacts are computed, and the picture's, in mm with y upward. The
// picture's origin is the rocker's pivot, the valve opens downward on its left, and the contact with the base circle is
// level with the pivot; without a rocker the origin is the cam's centre and the flat follower lies above it.
#include "cam_picture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../../files/units.hpp"
#include "../../loops/cam_from_lift.hpp"
#include "../../report/text.hpp"

namespace crankloop::program {
namespace {

using report::Axis;
using report::axis_of;
using report::coordinate;
using report::number_text;
using report::Plot;
using report::plot_of;
using report::Series;

constexpr double kMilli = 1e3;
constexpr double kWidth = 1080;  // of the picture, as wide as two columns of plots
constexpr double kFigure = 700;  // of the drawing, left of its figures
constexpr double kHeight = 640;
constexpr double kBorder = 30;
constexpr double kStepDeg = 0.25;

struct Place {  // mm
  double x;
  double y;
};
using Outline = std::vector<Place>;

Place operator+(const Place& a, const Place& b) { return {a.x + b.x, a.y + b.y}; }
Place operator-(const Place& a, const Place& b) { return {a.x - b.x, a.y - b.y}; }
Place toward(double length, double rad) { return {length * std::cos(rad), length * std::sin(rad)}; }
double direction(const Place& a) { return std::atan2(a.y, a.x); }
double length(const Place& a) { return std::hypot(a.x, a.y); }
double cross(const Place& a, const Place& b) { return a.x * b.y - a.y * b.x; }

void add_arc(Outline& outline, const Place& centre, double radius, double from_rad, double to_rad) {
  constexpr int kParts = 96;
  for (int i = 0; i <= kParts; ++i)
    outline.push_back(centre + toward(radius, from_rad + i * (to_rad - from_rad) / kParts));
}

/// The convex outline around some points (Andrew's monotone chain).
Outline around(Outline points) {
  std::sort(points.begin(), points.end(),
            [](const Place& a, const Place& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  Outline hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const Place& point : points) {
      while (hull.size() >= start + 2 && cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

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
  CamContact contact;
  CamFrame frame{};

  [[nodiscard]] const Rocker& rocker() const { return shown.rocker; }
  [[nodiscard]] bool has_pad() const { return rocker().kind == RockerKind::circular_pad; }
  [[nodiscard]] CamLift follower_at(double flat_rad) const { return shown.lift.cam().at(flat_rad); }
  [[nodiscard]] Place contour(double flat_rad) const {
    return frame(contour_point(rocker().base_circle_m, flat_rad, follower_at(flat_rad)));
  }
};

CamContact contact_of(const CamFromLift& inverse, double cam_rad, const LiftPose& pose) {
  return inverse.at(cam_rad, {pose.lift_m, pose.per_rad_m, pose.per_rad2_m});
}

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

/// Elements of the drawing, in mm until they are written.
class Canvas {
 public:
  void path(const char* what, const Outline& outline, bool closed) { paths_.push_back({what, outline, closed}); }
  void line(const char* what, const Place& a, const Place& b) { path(what, {a, b}, false); }
  void circle(const char* what, const Place& centre, double radius) {
    Outline outline;
    add_arc(outline, centre, radius, 0, 2 * kPi);
    path(what, outline, true);
  }
  /// Text beside a place, `right` and `down` in user units.
  void label(const Place& at, double right, double down, const std::string& text) {
    labels_.push_back({at, right, down, text});
  }

  /// The whole, as large as it fits.
  [[nodiscard]] std::string svg() const {
    Place low{1e9, 1e9};
    Place high{-1e9, -1e9};
    for (const Path& path : paths_) {
      for (const Place& p : path.outline) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    }
    const double scale =
        std::min((kFigure - 2 * kBorder) / (high.x - low.x), (kHeight - 3 * kBorder) / (high.y - low.y));
    const double left = (kFigure - scale * (low.x + high.x)) / 2;
    const double top = (kHeight - kBorder + scale * (low.y + high.y)) / 2;
    const auto at = [&](const Place& p) {
      return coordinate(left + scale * p.x) + ' ' + coordinate(top - scale * p.y);
    };
    std::string svg;
    for (const Path& path : paths_) {
      svg += "<path class=\"" + path.what + "\" d=\"M";
      for (std::size_t i = 0; i < path.outline.size(); ++i)
        svg += (i == 1 ? "L" : i > 1 ? " " : "") + at(path.outline[i]);
      svg += path.closed ? "Z\"/>\n" : "\"/>\n";
    }
    for (const Label& label : labels_) {
      svg += "<text class=\"mark\" x=\"" + coordinate(left + scale * label.at.x + label.right) + "\" y=\"" +
             coordinate(top - scale * label.at.y + label.down) + "\"" +
             (label.right < 0 ? " text-anchor=\"end\"" : "") + ">" + report::escape(label.text) + "</text>\n";
    }
    return svg + scale_bar(scale);
  }

 private:
  struct Path {
    std::string what;
    Outline outline;
    bool closed;
  };
  struct Label {
    Place at;
    double right;
    double down;
    std::string text;
  };

  static std::string scale_bar(double scale) {
    const double length_mm = scale * 10 < 220 ? 10 : 5;
    const std::string y = coordinate(kHeight - 12);
    return "<path class=\"bar-of-scale\" d=\"M12 " + coordinate(kHeight - 18) + "v12M12 " + y + "h" +
           coordinate(scale * length_mm) + "m0 -6v12\"/>\n<text class=\"mark\" x=\"" +
           coordinate(24 + scale * length_mm) + "\" y=\"" + coordinate(kHeight - 6) + "\">" + number_text(length_mm) +
           " mm</text>\n";
  }

  std::vector<Path> paths_{};
  std::vector<Label> labels_{};
};

void draw_cross(Canvas& canvas, const Place& at, double half) {
  canvas.line("centre", at - Place{half, 0}, at + Place{half, 0});
  canvas.line("centre", at - Place{0, half}, at + Place{0, half});
}

void draw_cam(Canvas& canvas, const Scene& s) {
  Outline contour;
  for (double deg = -180; deg < 180; deg += kStepDeg) contour.push_back(s.contour(deg * kRadPerDeg));
  const double base = s.rocker().base_circle_m * kMilli;
  canvas.path("cam", contour, true);
  canvas.circle("thin dashes", s.frame.centre, base);
  draw_cross(canvas, s.frame.centre, 0.25 * base);
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
  draw_cross(canvas, pad.centre, 1.5);
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
  draw_cross(canvas, {0, 0}, 0.06 * s.rocker().pivot_to_screw_m * kMilli);
  canvas.label({0, 0}, -8, 30, "pivot");
  draw_contact(canvas, s);
}

/// A flat follower: its face spans what the contact sweeps.
void draw_with_flat(Canvas& canvas, const Scene& s) {
  double half = 0;
  for (double deg = -180; deg < 180; deg += kStepDeg)
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

constexpr const char* kPictureStyle = R"css(
.mech path { fill: none; stroke: var(--ink); stroke-width: 1.5px; stroke-linejoin: round; stroke-linecap: round; }
.mech .cam { fill: var(--series-1); fill-opacity: 0.16; stroke: var(--series-1); stroke-width: 3px; }
.mech .edge { stroke: var(--axis); stroke-width: 3px; }
.mech .body { fill: var(--band); stroke: none; }
.mech .screw, .mech .stem { fill: var(--paper); stroke: var(--muted); }
.mech .pin { fill: var(--paper); stroke: var(--axis); }
.mech .outline { stroke: var(--series-2); stroke-width: 2.5px; }
.mech .rubbed { stroke: var(--series-2); stroke-width: 6px; stroke-linecap: butt; }
.mech .thin { stroke: var(--series-1); stroke-width: 1.25px; }
.mech .dashes { stroke-dasharray: 7 5; }
.mech .centre { stroke: var(--muted); stroke-width: 1px; stroke-dasharray: 12 3 2 3; }
.mech .lever { stroke: var(--muted); stroke-width: 1px; }
.mech .normal { stroke: var(--series-2); stroke-width: 1px; stroke-dasharray: 12 3 2 3; }
.mech .dot { fill: var(--series-1); stroke: none; }
.mech .contact { fill: var(--series-2); stroke: var(--paper); }
.mech .bar-of-scale { stroke: var(--ink); stroke-width: 1.5px; }
.mech text { font-variant-numeric: tabular-nums; }
.mech .mark {
  fill: var(--ink); font-size: 15px; stroke: var(--paper); stroke-width: 4px; stroke-linejoin: round;
  paint-order: stroke;
}
.mech .figure-name { fill: var(--muted); font-size: 15px; }
.mech .figure-value { fill: var(--ink); font-size: 17px; font-weight: 600; }
)css";

std::string mm(double metres, int digits = 4) { return number_text(metres * kMilli, digits) + " mm"; }
std::string deg(double radians) { return number_text(radians * kDegPerRad, 4) + "\u00B0"; }

/// Names and values beside the drawing.
std::vector<std::pair<std::string, std::string>> figures_of(const Scene& s) {
  std::vector<std::pair<std::string, std::string>> figures{
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

std::string figures_svg(const Scene& s) {
  std::string svg;
  double y = 70;
  for (const auto& [name, value] : figures_of(s)) {
    const auto text = [&](const char* what, double at, const std::string& content) {
      svg += std::string("<text class=\"") + what + "\" x=\"" + coordinate(kFigure + 60) + "\" y=\"" + coordinate(at) +
             "\">" + report::escape(content) + "</text>\n";
    };
    text("figure-name", y, name);
    text("figure-value", y + 21, value);
    y += 58;
  }
  return svg;
}

report::Picture picture_of(const Scene& s) {
  Canvas canvas;
  s.has_pad() ? draw_with_rocker(canvas, s) : draw_with_flat(canvas, s);
  return {"<g class=\"mech\">\n" + canvas.svg() + figures_svg(s) + "</g>\n", kPictureStyle, kWidth, kHeight};
}

// ---- plots ---------------------------------------------------------------------------------------------------------

Plot radius_plot(const Scene& s) {
  const ValveLift& lift = s.shown.lift;
  const double from = lift.cam().opens_rad() * kDegPerRad;
  const double to = lift.cam().closes_rad() * kDegPerRad;
  Plot plot = plot_of("Radius of curvature", axis_of("Flat follower's cam angle from full lift", "deg"),
                      axis_of("Radius", "mm"));
  plot.y.logarithmic = true;
  Series radius;
  for (double at = from - 10; at <= to + 10; at += kStepDeg) {
    const CamLift y = s.follower_at(at * kRadPerDeg);
    radius.x.push_back(at);
    radius.y.push_back((s.rocker().base_circle_m + y.lift_m + y.per_rad2_m) * kMilli);
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

Plot lift_plot(const Scene& s) {
  const ValveLift& lift = s.shown.lift;
  const double from = lift.opens_rad() * kDegPerRad - 10;
  const double to = lift.closes_rad() * kDegPerRad + 10;
  Plot plot = plot_of("Lift", axis_of("Cam angle from full lift", "deg"), axis_of("Lift", "mm"));
  Series valve{"valve", {}, {}, {}};
  Series follower{"flat follower at the contact", {}, {}, {}};
  for (double at = from; at <= to; at += kStepDeg) {
    const LiftPose pose = lift.at(at * kRadPerDeg);
    valve.x.push_back(at);
    valve.y.push_back(std::max(pose.lift_m, 0.0) * kMilli);
    follower.x.push_back(at);
    follower.y.push_back(contact_of(s.inverse, at * kRadPerDeg, pose).lift_m * kMilli);
  }
  plot.series = {valve, follower};
  const double here = std::remainder(s.cam_rad, 2 * kPi) * kDegPerRad;
  if (here >= from && here <= to)
    plot.markers = {{here, std::max(s.pose.lift_m, 0.0) * kMilli, mm(std::max(s.pose.lift_m, 0.0)), 0}};
  plot.x.range = report::Range{from, to};
  plot.x.tick_step = 30;
  return plot;
}

}  // namespace

report::Sheet cam_sheet(const ShownCam& shown, double cam_deg) {
  const Scene s = scene_of(shown, cam_deg);
  report::Sheet sheet;
  sheet.picture = picture_of(s);
  sheet.plots = {radius_plot(s), lift_plot(s)};
  return sheet;
}

}  // namespace crankloop::program
