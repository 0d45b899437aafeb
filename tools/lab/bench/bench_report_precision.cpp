// The benchmark's plots of run time against error.
#include <algorithm>

#include "bench_report.hpp"
#include "bench_report_parts.hpp"
#include "crankloop/files/number.hpp"
#include "groups.hpp"

namespace crankloop::program::bench {
namespace {

using report::Axis;
using report::Paragraph;
using report::Plot;
using report::plot_of;
using report::Section;
using report::Series;

constexpr const char* kLibm = "libm";
constexpr const char* kHigherDegrees = "degree 3 to 5";
/// False for a row of several methods, whose points are not joined by a line.
bool is_one_method(const std::string& name) { return name != kLibm && name != kHigherDegrees; }

/// One line per method in the order of its settings, and the front. `line_of` names the line of a row, "" leaves it
/// out.
Plot work_precision(const std::string& title, const Rows& rows, const Axis& time, double per_ns, const Axis& error,
                    const std::function<std::string(const Row&)>& line_of) {
  Plot plot = plot_of(title, time, error);
  std::vector<Work> all;
  for (const Row& row : rows) {
    const std::string name = line_of(row);
    if (name.empty() || !(row.error > 0)) continue;
    auto line = std::find_if(plot.series.begin(), plot.series.end(), [&](const Series& s) { return s.name == name; });
    if (line == plot.series.end()) {
      line = plot.series.insert(line, Series{});
      line->name = name;
      line->style.draw = is_one_method(name) ? report::Draw::line_and_points : report::Draw::points;
    }
    line->x.push_back(row.ns_median * per_ns);
    line->y.push_back(row.error);
    all.push_back({row.ns_median * per_ns, row.error});
  }
  Series front;
  front.name = "Pareto front";
  front.style.dashed = true;
  for (const Work& best : pareto_front(all)) {
    front.x.push_back(best.time);
    front.y.push_back(best.error);
  }
  plot.series.push_back(std::move(front));
  return plot;
}

std::string polynomial_line(const Row& row) {
  if (starts_with(row.contestant, "libm")) return kLibm;
  if (row.contestant == "cubic" || row.contestant == "quartic" || row.contestant == "quintic") return kHigherDegrees;
  return row.contestant;
}

Plot kinematics_plot(const Rows& rows, const char* real) {
  Plot plot = work_precision(std::string("Piston motion in ") + real,
                             where(rows, [&](const Row& r) { return r.group == "kinematics" && r.real == real; }),
                             axis("Time", "ns", true), 1, axis("Largest error", "", true), polynomial_line);
  plot.caption = *real == 'd' ? "libm: by asin, and by sin, cos and sqrt." : "libm: sinf, cosf, sqrtf.";
  return plot;
}

/// Each accuracy class has its own line. Other solvers are in the table of all rows.
std::string method_line(const Row& row) {
  const bool peer = starts_with(row.contestant, "odeint") || starts_with(row.contestant, "GSL");
  return peer || row.setting.find("class") != std::string::npos ? std::string() : row.contestant;
}

struct ValveSpeed {
  double rpm;
  const char* what;
};
constexpr ValveSpeed kValveSpeeds[] = {
    {kSmooth_rpm, "gentle contacts"}, {kSwitching_rpm, "hard contacts"}, {kBouncing_rpm, "float and bounce"}};

Plot valve_plot(const Rows& rows, const ValveSpeed& speed, const char* real) {
  const std::string start = brief(speed.rpm) + " rpm, ";
  return work_precision(
      brief(speed.rpm) + " rpm, " + speed.what + ", in " + real,
      where(rows, [&](const Row& r) { return r.group == "valve" && r.real == real && starts_with(r.setting, start); }),
      axis("Time of a cam cycle", "\u00B5s", true), 1e-3, axis("Largest error of lift", "\u00B5m", true), method_line);
}

}  // namespace

std::vector<Work> pareto_front(std::vector<Work> points) {
  std::sort(points.begin(), points.end(),
            [](const Work& a, const Work& b) { return a.time < b.time || (a.time == b.time && a.error < b.error); });
  std::vector<Work> front;
  for (const Work& point : points) {
    if (front.empty() || point.error < front.back().error) front.push_back(point);
  }
  return front;
}

std::vector<report::Plot> precision_plots(const Rows& rows) {
  std::vector<report::Plot> plots;
  for (const char* real : {"float", "double"}) plots.push_back(kinematics_plot(rows, real));
  for (const ValveSpeed& speed : kValveSpeeds) {
    for (const char* real : {"float", "double"}) plots.push_back(valve_plot(rows, speed, real));
  }
  return plots;
}

Section kinematics_section(const Rows& rows) {
  Section section{"kinematics", "Displacement, velocity, acceleration", {}};
  section.blocks.push_back(
      Paragraph{"One evaluation of all three at a random crank angle. The error is the largest of the three, relative "
                "to r, r w and r w\u00B2. A line joins "
                "the settings of a method: widths of the table's segments. Down and left is better; the dashed line is "
                "the Pareto front, the settings that "
                "no other beats in both."});
  for (const char* real : {"float", "double"}) section.blocks.push_back(kinematics_plot(rows, real));
  return section;
}

Section valve_section(const Rows& rows) {
  Section section{"valve", "One elastic valve", {}};
  section.blocks.push_back(
      Paragraph{"A whole turn of the cam, the look-up of its lift included, against the true motion. The error is the "
                "largest of the lift, the worst of six shifts "
                "of the ticks against the cam. A line joins a method's steps or ticks, from 1 \u00B5s on the right to "
                "the last that is stable. The library's finest "
                "steps do not grow with its tick: its longest are as exact as its shortest."});
  for (const ValveSpeed& speed : kValveSpeeds) {
    for (const char* real : {"float", "double"}) section.blocks.push_back(valve_plot(rows, speed, real));
  }
  return section;
}

}  // namespace crankloop::program::bench
