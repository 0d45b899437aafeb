// Section of the engine report: the valve trains of cylinder 1, theoretical and elastic motion.
#include <algorithm>
#include <cmath>
#include <utility>

#include "../files/units.hpp"
#include "engine_report_trains.hpp"

namespace crankloop::program {
namespace {

using report::Axis;
using report::Paragraph;
using report::Plot;
using report::Section;
using report::Series;

constexpr int kTheoryColour = 6;
constexpr double kHighBounce_m = 0.5e-3;  // higher and longer than in an engine in service

Series curve(const ReportInput& input, const ShownTrain& train, ValveQuantity quantity, double factor,
             const std::string& name, int colour) {
  Series series = over_angle(input.trace, name, train.trace[quantity], factor);
  series.style.colour = colour;
  return series;
}

/// Crank angles of opening and closing: where the theoretical lift passes 1 mm, or half of a smaller valve's lift.
struct Timing {
  double opens_deg;
  double closes_deg;
};
double timed_lift_m(const ShownTrain& train) { return std::min(1e-3, train.largest_theory_m / 2); }
Timing timing_of(const ReportInput& input, const ShownTrain& train) {
  const std::vector<double>& lift_m = train.trace[ValveQuantity::theoretical_lift];
  const std::size_t count = lift_m.size() - 1;  // the last is the first of the next cycle
  const double spacing_deg = input.trace.spacing_deg;
  const auto steps_until_low = [&](std::size_t direction) {
    double steps = 0;
    std::size_t i = train.full_lift % count;
    for (; steps < static_cast<double>(count) && lift_m[i] > timed_lift_m(train); ++steps) i = (i + direction) % count;
    return steps;
  };
  const double full_deg = static_cast<double>(train.full_lift) * spacing_deg;
  return {full_deg - steps_until_low(count - 1) * spacing_deg, full_deg + steps_until_low(1) * spacing_deg};
}

/// "12 deg before TDC", from the nearest dead centre, at 0, 180, 360 and 540 deg.
std::string from_dead_centre(double crank_deg) {
  const double nearest = std::round(crank_deg / 180);
  const double after_deg = crank_deg - 180 * nearest;
  const bool top = std::fmod(std::abs(nearest), 2) == 0;
  return number_text(std::abs(after_deg), 3) + " deg " + (after_deg < 0 ? "before " : "after ") + (top ? "TDC" : "BDC");
}

/// The circle of the crank, clockwise from top dead centre, an arc for each train while its valve is open.
Plot timing_plot(const ReportInput& input, const std::vector<ShownTrain>& trains) {
  Plot plot = plot_of("Valve timing", {}, {});
  plot.x.bare = plot.y.bare = true;
  const auto arc = [&plot](const std::string& name, double radius, double from_deg, double to_deg, int colour) {
    Series series{name, {}, {}, {}};
    series.style.colour = colour;
    series.style.bold = !name.empty();
    const double step_deg = (to_deg - from_deg) / 120;
    for (int i = 0; i <= 120; ++i) {
      const double angle_rad = (from_deg + i * step_deg) * kRadPerDeg;
      series.x.push_back(radius * std::sin(angle_rad));
      series.y.push_back(radius * std::cos(angle_rad));
    }
    plot.series.push_back(std::move(series));
  };
  double radius = 1;
  for (std::size_t t = 0; t < trains.size(); ++t, radius -= 0.18) {
    const Timing timing = timing_of(input, trains[t]);
    const std::size_t series = plot.series.size();
    arc(trains[t].name, radius, timing.opens_deg, timing.closes_deg, static_cast<int>(t) + 1);
    const Series& drawn = plot.series[series];
    plot.markers.push_back({drawn.x.front(), drawn.y.front(), from_dead_centre(timing.opens_deg), series});
    plot.markers.push_back({drawn.x.back(), drawn.y.back(), from_dead_centre(timing.closes_deg), series});
    plot.caption += trains[t].name + " opens " + from_dead_centre(timing.opens_deg) + ", closes " +
                    from_dead_centre(timing.closes_deg) + "; ";
  }
  arc("", 1.15, 0, 360, kTheoryColour);
  plot.caption += "at " + number_text(timed_lift_m(trains[0]) * kMilli, 3) +
                  " mm of theoretical lift. Clockwise, top dead centre above.";
  use_equal_scales(plot);
  return plot;
}

/// Labels of several marked curves in one plot contain only the values.
Plot with_short_labels(Plot plot) {
  for (report::Marker& marker : plot.markers)
    marker.label.resize(std::min(marker.label.size(), marker.label.find(" at ")));
  return plot;
}

Plot lift_plot(const ReportInput& input, const std::vector<ShownTrain>& trains) {
  std::vector<Series> curves;
  for (std::size_t t = 0; t < trains.size(); ++t) {
    const int colour = static_cast<int>(t) + 1;
    curves.push_back(curve(input, trains[t], ValveQuantity::lift, kMilli, trains[t].name, colour));
    curves.push_back(
        curve(input, trains[t], ValveQuantity::theoretical_lift, kMilli, t == 0 ? "theory" : "", kTheoryColour));
    curves.back().style.dashed = true;
  }
  Plot plot = plot_over_angle(input, "Valve lift", axis_of("Lift", "mm"), std::move(curves));
  for (std::size_t t = 0; t < trains.size(); ++t) plot.markers.push_back(largest_marker(plot, 2 * t));
  plot.caption =
      "Dashed: theoretical lift of cam and rocker. The valve stays below it by the compression of the train.";
  return with_short_labels(std::move(plot));
}

Plot one_each(const ReportInput& input, const std::vector<ShownTrain>& trains, const std::string& title,
              const Axis& axis, ValveQuantity quantity, double factor) {
  std::vector<Series> curves;
  for (std::size_t t = 0; t < trains.size(); ++t) {
    curves.push_back(curve(input, trains[t], quantity, factor, trains[t].name, static_cast<int>(t) + 1));
  }
  if (curves.size() == 1) curves[0].name.clear();
  return plot_over_angle(input, title, axis, std::move(curves));
}

/// A motion of the valves, with that of rigid parts dashed.
Plot with_theory(const ReportInput& input, const std::vector<ShownTrain>& trains, Plot plot,
                 std::vector<double> RigidMotion::*theory, double factor) {
  if (trains.size() == 1) plot.series[0].name = trains[0].name;
  for (std::size_t t = 0; t < trains.size(); ++t) {
    Series rigid = over_angle(input.trace, t == 0 ? "theory" : "", trains[t].theory.*theory, factor);
    rigid.style.colour = kTheoryColour;
    rigid.style.dashed = true;
    plot.series.push_back(std::move(rigid));
  }
  plot.caption = "Dashed: of rigid parts, by cam and rocker.";
  return plot;
}

Plot jerk_plot(const ReportInput& input, const std::vector<ShownTrain>& trains) {
  constexpr double kMmPerMs3 = 1e-6;
  std::vector<Series> curves;
  for (std::size_t t = 0; t < trains.size(); ++t) {
    curves.push_back(
        over_angle(input.trace, trains.size() == 1 ? "" : trains[t].name, trains[t].theory.jerk_m_s3, kMmPerMs3));
    curves.back().style.colour = static_cast<int>(t) + 1;
  }
  Plot plot = plot_over_angle(input, "Jerk of the theoretical lift", axis_of("Jerk", "mm/ms\u00B3"), std::move(curves));
  plot.caption =
      "Of rigid parts, while the lash is closed: what excites the train. The elastic valve's own follows its contacts.";
  return plot;
}

Plot force_plot(const ReportInput& input, const ShownTrain& train) {
  Plot plot = plot_over_angle(input, "Forces of the " + train.name + " valve", axis_of("Force", "kN"),
                              {curve(input, train, ValveQuantity::cam_force, kKilo, "cam", 0),
                               curve(input, train, ValveQuantity::train_force, kKilo, "train", 0),
                               curve(input, train, ValveQuantity::seat_force, kKilo, "seat", 0)});
  plot.markers = {largest_marker(plot, 0), largest_marker(plot, 2)};
  plot.caption =
      "Cam: between cam and follower, the train's times the rocker ratio. Train: on the valve. Seat: the closed valve "
      "carries its spring.";
  return with_short_labels(std::move(plot));
}

/// Compression of the train, or the gap between train and valve.
Plot gap_plot(const ReportInput& input, const ShownTrain& train) {
  Plot plot =
      plot_over_angle(input, "Between train and valve, " + train.name, axis_of("Train lift less valve lift", "\u00B5m"),
                      {curve(input, train, ValveQuantity::compression, kMicro, "", 0)});
  plot.caption =
      "Above zero the train is compressed and carries force; below zero there is a gap: the clearance while the valve "
      "is closed.";
  const ValveCycle<double>& cycle = train.trace.cycle;
  if (cycle.separations == 0) return plot;
  const double begin_deg = crank_deg(train, cycle.separation_start_deg);
  std::size_t widest = 0;
  double gap = 0;
  for (std::size_t i = 0; i < train.trace.regime.size(); ++i) {
    const double since_deg = std::fmod(input.trace.crank_deg[i] - begin_deg + 720, 720);
    const double here = train.trace[ValveQuantity::compression][i];
    if (since_deg < 2 * cycle.separation_duration_deg && here < gap) gap = here, widest = i;
  }
  if (gap < 0) {
    plot.markers.push_back({input.trace.crank_deg[widest], gap * kMicro,
                            "separation " + number_text(cycle.separation_clearance_m * kMicro, 3) + " \u00B5m", 0});
  }
  return plot;
}

/// The seating: from shortly before contact until the valve is at rest.
Plot seating_plot(const ReportInput& input, const ShownTrain& train) {
  constexpr double kBefore_deg = 3;
  const double behind_deg = train.trace.cycle.bounce_height_m < kHighBounce_m ? 45 : 180;
  const std::vector<std::size_t> entries = entries_of_lobe(train);
  const std::size_t seated = seating_place(train, entries);
  const auto places = [&](double deg) { return static_cast<std::size_t>(deg / input.trace.spacing_deg); };
  const std::size_t from = seated > places(kBefore_deg) ? seated - places(kBefore_deg) : 0;
  const std::size_t to = std::min(entries.size(), seated + places(behind_deg));
  Series actual{"valve", {}, {}, {}};
  Series theory{"theory", {}, {}, {}};
  theory.style.dashed = true;
  theory.style.colour = kTheoryColour;
  std::size_t top = 0;
  double deg = from < to ? input.trace.crank_deg[entries[from]] : 0;
  for (std::size_t i = from; i < to; ++i, deg += input.trace.spacing_deg) {
    actual.x.push_back(deg);
    actual.y.push_back(train.trace[ValveQuantity::lift][entries[i]] * kMicro);
    theory.x.push_back(deg);
    theory.y.push_back(train.trace[ValveQuantity::theoretical_lift][entries[i]] * kMicro);
    const bool in_the_air = i > seated && (train.trace.regime[entries[i]] & kSeatOn) == 0;
    if (in_the_air && (top == 0 || actual.y.back() > actual.y[top])) top = actual.y.size() - 1;
  }
  Plot plot =
      plot_of("Seating of the " + train.name + " valve", axis_of("Crank angle from cylinder 1's firing TDC", "deg"),
              axis_of("Lift above the seat's contact", "\u00B5m"));
  plot.caption =
      "Zero is where the valve meets its seat; bounces count from there. Below, the seat yields: to the closed valve's "
      "spring, more to the impact.";
  if (top > 0 && train.trace.cycle.bounces > 0) {
    plot.markers.push_back({actual.x[top], actual.y[top],
                            "bounce " + number_text(train.trace.cycle.bounce_height_m * kMicro, 3) + " \u00B5m", 0});
  }
  plot.series = {std::move(actual), std::move(theory)};
  report::count_from(plot, train.seat_contact_m * kMicro, "seat contact", 5);
  return plot;
}

std::string verdict(const std::vector<ShownTrain>& trains) {
  std::string floating;
  for (const ShownTrain& train : trains) {
    if (train.trace.cycle.separations > 0) floating += (floating.empty() ? "" : ", ") + train.name;
  }
  return floating.empty() ? "At this speed every valve follows its cam."
                          : "At this speed the valve leaves its train: " + floating + ".";
}

}  // namespace

report::Section valve_section(const ReportInput& input) {
  const std::vector<ShownTrain> trains = trains_of(input);
  Section section{"valves", "Valve train", {}};
  section.blocks.push_back(
      Paragraph{"The valves of cylinder 1. Each is one elastic mass between train and seat, stepped in time; it may "
                "leave its train (separation, float) "
                "and lift off its seat again (bounce). Either counts from 1 \u00B5m. Its spring follows it without "
                "surge. " +
                verdict(trains)});
  section.blocks.push_back(lift_plot(input, trains));
  section.blocks.push_back(timing_plot(input, trains));
  section.blocks.push_back(
      with_theory(input, trains,
                  with_short_labels(with_extremes(one_each(input, trains, "Valve velocity", axis_of("Velocity", "m/s"),
                                                           ValveQuantity::velocity, 1))),
                  &RigidMotion::velocity_m_s, 1));
  section.blocks.push_back(
      with_theory(input, trains,
                  one_each(input, trains, "Valve acceleration", axis_of("Acceleration", "km/s\u00B2"),
                           ValveQuantity::acceleration, kKilo),
                  &RigidMotion::acceleration_m_s2, kKilo));
  section.blocks.push_back(jerk_plot(input, trains));
  for (const ShownTrain& train : trains) section.blocks.push_back(force_plot(input, train));
  for (const ShownTrain& train : trains) section.blocks.push_back(gap_plot(input, train));
  for (const ShownTrain& train : trains) {
    if (seating_place(train, entries_of_lobe(train)) < train.trace.regime.size() - 1)
      section.blocks.push_back(seating_plot(input, train));
  }
  section.blocks.push_back(results_table(trains));
  add_cam_loads(input, section);
  add_surge(input, section);
  add_flow_area(input, section);
  for (const ShownTrain& train : trains) section.blocks.push_back(table_of_train(input, train));
  return section;
}

}  // namespace crankloop::program
