#include "motion_plot.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "../../files/units.hpp"
#include "../../report/sheet.hpp"
#include "motion_summary.hpp"

namespace crankloop::program {
namespace {

using report::axis_of;
using report::number_text;
using report::Plot;
using report::Series;

constexpr int kPoints = 361;  // a degree apart

struct Shown {
  const char* title;
  const char* unit;
  PoseMember member;
  double factor;
};

template <class Value>
Series curve(const std::string& name, const Value& value) {
  Series series;
  series.name = name;
  for (int deg = 0; deg < kPoints; ++deg) {
    series.x.push_back(deg);
    series.y.push_back(value(deg * kRadPerDeg));
  }
  return series;
}

Plot plot_over_turn(const std::string& title, const char* y, const char* unit) {
  Plot plot = report::plot_of(title, axis_of("Crank angle", "deg"), axis_of(y, unit));
  plot.x.tick_step = 60;
  plot.x.range = report::Range{0, kPoints - 1};
  return plot;
}

Plot motion_of(const Shown& of, const Crank& crank, PoseFunction pose, bool beside) {
  Plot plot = plot_over_turn(of.title, of.title, of.unit);
  const auto values_of = [&](PoseFunction function) {
    return [&of, &crank, function](double a) { return function(crank, a).*of.member * of.factor; };
  };
  plot.series.push_back(curve(beside ? "exact" : "", values_of(pose)));
  if (beside) {
    plot.series.push_back(curve("approximation", values_of(second_order_pose)));
    plot.series.back().style.dashed = true;
  }
  for (const LocalExtreme& local : local_extremes(crank, of.member, pose)) {
    const double value = local.extreme.value * of.factor;
    const double deg = local.extreme.at_rad / kRadPerDeg;
    const std::string text = number_text(value, 4) + " " + of.unit;
    const bool is_named = std::any_of(plot.markers.begin(), plot.markers.end(), [&](const report::Marker& marker) {
      return marker.label.compare(0, text.size(), text) == 0;  // the same on the way back
    });
    plot.markers.push_back({deg, value, is_named ? "" : text + " at " + number_text(deg, 4) + " deg", 0});
  }
  return plot;
}

Plot error_of(const Shown& of, const Crank& crank) {
  Plot plot = plot_over_turn(std::string(of.title) + ": approximation less exact", "Error", of.unit);
  plot.series.push_back(curve("", [&](double a) {
    return (second_order_pose(crank, a).*of.member - exact_pose(crank, a).*of.member) * of.factor;
  }));
  return plot;
}

}  // namespace

std::string motion_picture(const std::string& engine, const Crank& crank, PoseFunction pose, double speed_rad_s,
                           bool beside) {
  const Shown all[] = {
      {"Displacement", "mm", &Pose<double>::displacement_m, 1e3},
      {"Velocity", "m/s", &Pose<double>::slope_m, speed_rad_s},
      {"Acceleration", "m/s\u00B2", &Pose<double>::acceleration_m, speed_rad_s * speed_rad_s},
      {"Rod angle", "deg", &Pose<double>::rod_angle_rad, 1 / kRadPerDeg},
  };
  report::Sheet sheet;
  sheet.title = engine + ": motion of piston and rod";
  sheet.remarks = {number_text(speed_rad_s / kRad_sPerRpm, 6) + " rpm, crank radius over rod length " +
                   number_text(crank.rod_ratio(), 4)};
  for (const Shown& of : all) {
    sheet.plots.push_back(motion_of(of, crank, pose, beside));
    if (beside) sheet.plots.push_back(error_of(of, crank));
  }
  return report::to_svg_file(sheet);
}

}  // namespace crankloop::program
