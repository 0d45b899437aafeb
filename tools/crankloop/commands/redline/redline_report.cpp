// The page of `crankloop redline`: float and bounce over speed, and the influence of what was varied.
#include "../../files/number.hpp"
#include "../../files/units.hpp"
#include "redline.hpp"

namespace crankloop::program {
namespace {

using report::Axis;
using report::axis_of;
using report::Paragraph;
using report::Plot;
using report::plot_of;
using report::Section;

using Value = double (*)(const SpeedResult&);

/// Up to one speed beyond where the curve ends, or to the last before the first lift that no spring allows.
report::Series over_speed(const Sweep& sweep, const std::string& name, Value value, double to_rpm) {
  report::Series series;
  series.name = name;
  for (const SpeedResult& result : sweep.at) {
    if (!result.is_possible) break;
    series.x.push_back(result.speed_rpm);
    series.y.push_back(value(result));
    if (result.speed_rpm > to_rpm) break;
  }
  return series;
}

/// "x 0.85", "0.05 mm", "a.csv".
std::string name_of(const Redline& redline, const Sweep& sweep) {
  if (redline.varied->are_factors) return "\u00D7 " + sweep.value;
  return sweep.value + (redline.varied->unit.empty() ? "" : " " + redline.varied->unit);
}

/// Of a family of curves.
int shade(std::size_t i, std::size_t count) {
  if (count <= report::kRamp) return static_cast<int>(i) + 1;
  return 1 + static_cast<int>(i * (report::kRamp - 1) / (count - 1));
}

/// One curve, with one beside it of springs that follow where they surge; or one for each factor.
Plot plot_over_speed(const Redline& redline, const std::string& title, const Axis& y, Value value) {
  Plot plot = plot_of(title, axis_of("Engine speed", "rpm"), y);
  plot.y.include_zero = true;
  plot.x.range = report::Range{redline.shown_from_rpm(), redline.shown_to_rpm()};
  for (const Sweep& sweep : redline.sweeps) {
    plot.series.push_back(over_speed(sweep, redline.varied != nullptr ? name_of(redline, sweep) : "", value,
                                     redline.shown_to_rpm(sweep)));
    if (redline.varied == nullptr) continue;
    plot.names_at_ends = true;
    plot.series.back().style.ramp = shade(plot.series.size() - 1, redline.sweeps.size());
    plot.series.back().style.bold = sweep.as_given;
  }
  if (redline.following) {
    plot.series.back().name = "springs surge";
    plot.series.push_back(
        over_speed(*redline.following, "springs follow", value, redline.shown_to_rpm(*redline.following)));
  }
  return plot;
}

double gap_mm(const SpeedResult& r) { return r.cycle.separation_clearance_m * 1e3; }
double bounce_mm(const SpeedResult& r) { return r.cycle.bounce_height_m * 1e3; }
double seating_m_s(const SpeedResult& r) { return r.cycle.seating_speed_m_s; }
double lift_mm(const SpeedResult& r) { return r.cycle.largest_lift_m * 1e3; }
double acceleration_km_s2(const SpeedResult& r) { return r.cycle.largest_acceleration_m_s2 * 1e-3; }
double cam_kN(const SpeedResult& r) { return r.cam_N * 1e-3; }

void mark(Plot& plot, const Onset& onset, const char* label) {
  if (onset.found && !onset.at_the_start) {
    plot.markers.push_back({static_cast<double>(onset.speed_rpm), 0,
                            std::string(label) + " " + std::to_string(onset.speed_rpm) + " rpm", 0});
  }
}

Section speed_section(const Redline& redline) {
  Section section{"speed", redline.varied != nullptr ? redline.varied->title + " and speed" : "Over speed", {}};
  if (redline.varied != nullptr) {
    section.blocks.push_back(Paragraph{
        "Each curve is the train with " +
        (redline.varied->are_factors
             ? redline.varied->keys + " times its factor; \u00D7 1, bold, is the train as its file gives it."
             : "another " + redline.varied->title + "; the bold one is the train as its file gives it.") +
        " A curve ends shortly above the speed at which its valve leaves the train: beyond, the motion is chaotic."});
  }
  Plot gap = plot_over_speed(redline, "Separation", axis_of("Largest gap between train and valve", "mm"), gap_mm);
  Plot bounce = plot_over_speed(redline, "Bounce", axis_of("Largest height above the seat", "mm"), bounce_mm);
  if (redline.varied == nullptr) {
    mark(gap, redline.as_given().separation, "from");
    mark(bounce, redline.as_given().bounce, "from");
  }
  gap.caption = "The train carries no force and the valve is in free flight: float.";
  bounce.caption = "Lift-offs after the first contact with the seat.";
  section.blocks.push_back(std::move(gap));
  section.blocks.push_back(std::move(bounce));
  Plot seating =
      plot_over_speed(redline, "Seating", axis_of("Speed at the first contact with the seat", "m/s"), seating_m_s);
  if (redline.varied == nullptr) mark(seating, redline.as_given().seating, "limit from");
  section.blocks.push_back(std::move(seating));
  section.blocks.push_back(
      plot_over_speed(redline, "Largest force between cam and follower", axis_of("Force", "kN"), cam_kN));
  section.blocks.push_back(
      plot_over_speed(redline, "Largest acceleration", axis_of("Acceleration", "km/s\u00B2"), acceleration_km_s2));
  Plot lift = plot_over_speed(redline, "Largest lift", axis_of("Lift", "mm"), lift_mm);
  lift.y.include_zero = false;
  section.blocks.push_back(std::move(lift));
  return section;
}

Axis factor_axis(const Redline& redline) {
  if (redline.varied->are_factors) return axis_of("Factor", "");
  Axis axis = axis_of(redline.varied->title, redline.varied->unit);
  if (redline.varied->are_words) axis.tick_step = 1;
  return axis;
}

Section onset_section(const Redline& redline) {
  Section section{"onset", "Onset of separation and bounce", {}};
  Plot plot = plot_of("Onset", factor_axis(redline), axis_of("Engine speed", "rpm"));
  const auto series = [&](const char* name, Onset Sweep::*onset) {
    report::Series one;
    one.name = name;
    one.style.draw = report::Draw::line_and_points;
    for (const Sweep& sweep : redline.sweeps) {
      if (!(sweep.*onset).found) continue;
      one.x.push_back(sweep.factor);
      one.y.push_back((sweep.*onset).speed_rpm);
    }
    if (!one.x.empty()) plot.series.push_back(std::move(one));
  };
  series("separation", &Sweep::separation);
  series("bounce", &Sweep::bounce);
  series("seating speed", &Sweep::seating);
  report::Series rigid;
  rigid.name = "static redline";
  rigid.style.draw = report::Draw::line_and_points;
  for (const Sweep& sweep : redline.sweeps) {
    if (!(sweep.rigid.crank_rad_s > 0)) continue;
    rigid.x.push_back(sweep.factor);
    rigid.y.push_back(sweep.rigid.crank_rad_s * kRpmPerRad_s);
  }
  if (!rigid.x.empty()) plot.series.push_back(std::move(rigid));
  if (!plot.series.empty()) section.blocks.push_back(std::move(plot));
  report::Table table{"",
                      {{redline.varied->are_factors ? "Factor" : redline.varied->title, redline.varied->unit},
                       {"Separation from", ""},
                       {"Bounce from", ""},
                       {"Seating too fast from", ""},
                       {"Static redline", ""}},
                      {},
                      false};
  for (const Sweep& sweep : redline.sweeps) {
    table.rows.push_back({sweep.value, text_of(sweep.separation, redline.range), text_of(sweep.bounce, redline.range),
                          text_of(sweep.seating, redline.range), text_of(sweep.rigid)});
  }
  section.blocks.push_back(std::move(table));
  return section;
}

Section method_section(const Redline& redline) {
  Section section{"method", "Method", {}};
  section.blocks.push_back(Paragraph{"Command: " + redline.command_line});
  report::List list;
  list.items.push_back("Each speed is run in double for " + std::to_string(kRedlineCycles) +
                       " cycles from rest, in ticks of " + brief(redline.as_given().tick_s * 1e6) +
                       " \u00B5s (rk4); the last cycle gives the result.");
  list.items.push_back(
      "The sweep goes in steps of " + std::to_string(redline.range.step_rpm) +
      " rpm. An onset is narrowed down to 1 rpm between the first speed that has a separation of at least 1 \u00B5m, a "
      "bounce of at least " +
      brief(redline.limits.bounce_m * 1e6) + " \u00B5m, or a seating speed above " + brief(redline.limits.seating_m_s) +
      " m/s, and the speed before it. An effect that comes and goes between two speeds of the sweep is not detected.");
  list.items.push_back(
      "A stiff train lifts its valve off the seat by micrometres at any speed; usual limits for seats and heads are a "
      "bounce of 50 \u00B5m and a seating speed of 0.5 m/s.");
  if (std::string masked = masked_in_words(redline); !masked.empty()) {
    masked[0] = 'L';
    list.items.push_back(masked + ".");
  }
  list.items.push_back(redline.valve.valve().surge_modes > 0
                           ? "The valve's mass opens its contact only at the cam; its springs surge."
                           : "The single-mass model opens its contact only at the cam; its spring follows it without "
                             "surge.");
  list.items.push_back(
      "The static redline is the speed at which the spring can just slow the valve down as the cam asks, " +
      static_in_words(redline) + ".");
  if (redline.varied != nullptr && redline.varied->are_factors)
    list.items.push_back("Damping ratios stay constant while mass or stiffness vary.");
  section.blocks.push_back(std::move(list));
  return section;
}

}  // namespace

report::Page redline_page(const Redline& redline) {
  const Sweep& given = redline.as_given();
  const detail::ValveBody<double> body = redline.valve.body();
  const auto onset = [&](const char* name, const Onset& one, const char* note) {
    if (!one.found) return report::Fact{name, "none", "", "up to " + std::to_string(redline.range.to_rpm) + " rpm"};
    std::string remark = one.at_the_start ? "or below" : note;
    if (one.speed_rpm < redline.rated_rpm())
      remark += "; the engine is rated at " + report::format_number(redline.rated_rpm(), 4);
    return report::Fact{name, std::to_string(one.speed_rpm), "rpm", remark};
  };
  report::Page page;
  page.title =
      "Valve train " + redline.valve.train().name + (redline.varied != nullptr ? ": " + redline.varied->title : "");
  page.subtitle = "Separation and bounce from " + std::to_string(redline.range.from_rpm) + " to " +
                  std::to_string(redline.range.to_rpm) + " rpm of the engine, from " + redline.valve.file().path() +
                  ".";
  page.facts = {
      onset("Separation from", given.separation, "float"),
      onset("Bounce from", given.bounce, "after seating"),
      onset("Seating too fast from", given.seating, "above the limit"),
      {"Static redline",
       given.rigid.crank_rad_s > 0 ? report::format_number(given.rigid.crank_rad_s * kRpmPerRad_s, 4) : "none",
       given.rigid.crank_rad_s > 0 ? "rpm" : "", "spring margin 1, rigid parts"},
      {"Natural frequency", report::format_number(open_frequency_rad_s(body) * kTurnsPerRad, 4), "Hz",
       "open, on the train"},
      {"Seated", report::format_number(seated_frequency_rad_s(body) * kTurnsPerRad, 4), "Hz", "on train and seat"},
      {"Largest theoretical lift", report::format_number(redline.valve.lift().largest_lift_m() * 1e3, 5), "mm", ""}};
  if (redline.following) {
    page.facts.insert(page.facts.begin() + 1, onset("Separation without surge", redline.following->separation,
                                                    "if springs followed the valve"));
  }
  if (redline.varied != nullptr) page.sections.push_back(onset_section(redline));
  page.sections.push_back(speed_section(redline));
  page.sections.push_back(method_section(redline));
  page.footer = "Made by crankloop from " + redline.valve.file().path() + ".";
  return page;
}

}  // namespace crankloop::program
