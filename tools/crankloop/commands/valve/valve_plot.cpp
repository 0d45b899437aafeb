#include "valve_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../files/units.hpp"
#include "../../report/plot.hpp"

namespace crankloop::program {
namespace {

using report::axis_of;
using report::number_text;
using report::Plot;
using report::Series;

using Tick = ValveTickOutput<double>;
using Value = double (*)(const Tick&);

constexpr double kAroundMotion_deg = 8;  // of rest, shown before and behind what moves
constexpr double kBeforeSeating_deg = 1.5;
constexpr double kBehindRest_deg = 3;

/// Who carries the valve in a tick.
enum class Contact : std::uint8_t { closed, train, separated, bouncing };

constexpr struct {
  Contact contact;
  const char* name;
  int colour;
} kContacts[] = {{Contact::train, "on the train", 1},
                 {Contact::separated, "separation", 2},
                 {Contact::bouncing, "bounce", 4},
                 {Contact::closed, "on the seat", 3}};

constexpr int kTheoryColour = 6;

/// A cycle with what its drawings share.
struct Shown {
  const std::vector<Tick>& ticks;
  const ValveCycle<double>& cycle;
  double seat_contact_m;
  std::vector<Contact> contacts{};
  std::size_t seated = 0;  ///< first tick on the seat behind the lobe; ticks.size(): none
  std::size_t rested = 0;  ///< first tick behind that one from which the valve stays closed
};

/// Without any contact the valve is separated until it has met its seat, and bounces after that and before it opens:
/// the rule by which the library counts, here without the least height that it asks for.
Shown shown(const ValveCycleTrace& trace) {
  Shown s{trace.ticks, trace.cycle, trace.seat_contact_m};
  s.seated = s.ticks.size();
  bool open = false;
  for (std::size_t i = 0; i < s.ticks.size(); ++i) {
    const Tick& tick = s.ticks[i];
    const bool on_train = (tick.forces.regime & kTrainOn) != 0;
    const bool on_seat = (tick.forces.regime & kSeatOn) != 0;
    const double opened_m = detail::ValveRecord<double>::kOpened_m;
    if (s.seated == s.ticks.size() && tick.motion.theoretical_lift_m >= opened_m && tick.motion.lift_m >= opened_m)
      open = true;
    if (open && on_seat) open = false, s.seated = i;
    s.contacts.push_back(on_train  ? Contact::train
                         : on_seat ? Contact::closed
                         : open    ? Contact::separated
                                   : Contact::bouncing);
  }
  s.rested = s.ticks.size();
  while (s.rested > s.seated + 1 && s.contacts[s.rested - 1] == Contact::closed) --s.rested;
  return s;
}

struct Part {
  std::size_t from;
  std::size_t to;  ///< exclusive
};

/// What moves, and some of the rest around it.
Part moving_part(const Shown& s) {
  std::size_t first = 0;
  while (first < s.ticks.size() && s.contacts[first] == Contact::closed) ++first;
  std::size_t last = s.ticks.size();
  while (last > first && s.contacts[last - 1] == Contact::closed) --last;
  const auto near = [&](std::size_t i, std::size_t to) {
    return i < s.ticks.size() && std::abs(s.ticks[i].cam_deg - s.ticks[to].cam_deg) <= kAroundMotion_deg;
  };
  if (first == last) return {0, s.ticks.size()};  // it never moves
  Part part{first, last};
  while (part.from > 0 && near(part.from - 1, first)) --part.from;
  while (part.to < s.ticks.size() && near(part.to, last - 1)) ++part.to;
  return part;
}

Part seating_part(const Shown& s) {
  const auto within = [&](std::size_t i, std::size_t of, double deg) {
    return std::abs(s.ticks[i].cam_deg - s.ticks[of].cam_deg) <= deg;
  };
  Part part{s.seated, s.rested};
  while (part.from > 0 && within(part.from - 1, s.seated, kBeforeSeating_deg)) --part.from;
  while (part.to < s.ticks.size() && within(part.to, s.rested - 1, kBehindRest_deg)) ++part.to;
  return part;
}

template <class OfTick>
Series curve(const Shown& s, Part part, const char* name, int colour, const OfTick& value) {
  Series series;
  series.name = name;
  series.style.colour = colour;
  for (std::size_t i = part.from; i < part.to; ++i) {
    series.x.push_back(s.ticks[i].cam_deg);
    series.y.push_back(value(s.ticks[i]));
  }
  return series;
}

Series theory(const Shown& s, Part part, Value value) {
  Series series = curve(s, part, "theory", kTheoryColour, value);
  series.style.dashed = true;
  return series;
}

/// A curve in pieces, each in the colour of its contact; a piece ends where the next begins.
void add_by_contact(Plot& plot, const Shown& s, Part part, Value value) {
  for (const auto& kind : kContacts) {
    Series series = curve(s, part, kind.name, kind.colour, value);
    bool any = false;
    for (std::size_t i = part.from; i < part.to; ++i) {
      const bool here = s.contacts[i] == kind.contact;
      const bool ends_here = i > part.from && s.contacts[i - 1] == kind.contact;
      if (!here && !ends_here) series.y[i - part.from] = std::numeric_limits<double>::quiet_NaN();
      any = any || here;
    }
    if (any) plot.series.push_back(std::move(series));
  }
}

/// The x axis ends with the data, not on the next tick.
Plot plot_over_cam(const Shown& s, Part part, const char* title, const char* y, const char* unit) {
  Plot plot = report::plot_of(title, axis_of("Cam angle from full lift", "deg"), axis_of(y, unit));
  const double from_deg = s.ticks[part.from].cam_deg;
  const double to_deg = s.ticks[part.to - 1].cam_deg;
  plot.x.range = report::Range{std::min(from_deg, to_deg), std::max(from_deg, to_deg)};
  if (std::abs(to_deg - from_deg) > 90) plot.x.tick_step = std::abs(to_deg - from_deg) > 240 ? 60 : 30;
  return plot;
}

/// A y axis that ends shortly beyond the curves: the seat's few micrometres below zero ask for no tick of their own.
void fit_y(Plot& plot) {
  double low = 0;
  double high = 0;
  for (const Series& series : plot.series) {
    for (const double y : series.y) {
      if (std::isnan(y)) continue;
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  const double room = 0.04 * (high - low);
  plot.y.range = report::Range{low < 0 ? low - room : 0, high + room};
}

double theory_mm(const Tick& t) { return t.motion.theoretical_lift_m * kMilli; }
double lift_mm(const Tick& t) { return t.motion.lift_m * kMilli; }
double theory_um(const Tick& t) { return t.motion.theoretical_lift_m * kMicro; }
double lift_um(const Tick& t) { return t.motion.lift_m * kMicro; }
double gap_um(const Tick& t) { return t.forces.train_compression_m * kMicro; }
double train_kN(const Tick& t) { return t.forces.train_N * kKilo; }
double seat_kN(const Tick& t) { return t.forces.seat_N * kKilo; }

/// A label on the tick of this contact with the largest value, if there is any.
void mark(Plot& plot, const Shown& s, Part part, Contact contact, Value place, Value y, const std::string& label) {
  std::size_t best = part.to;
  for (std::size_t i = part.from; i < part.to; ++i) {
    if (s.contacts[i] == contact && (best == part.to || place(s.ticks[i]) > place(s.ticks[best]))) best = i;
  }
  if (best == part.to) return;
  std::size_t series = 0;
  for (const auto& kind : kContacts) {
    if (kind.contact != contact) continue;
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
      if (plot.series[i].name == kind.name) series = i;
    }
  }
  plot.markers.push_back({s.ticks[best].cam_deg, y(s.ticks[best]), label, series});
}

std::string micrometres(double length_m) { return number_text(length_m * kMicro, 3) + " \u00B5m"; }

Plot lift_plot(const Shown& s, Part part) {
  Plot plot = plot_over_cam(s, part, "Lift", "Lift", "mm");
  add_by_contact(plot, s, part, lift_mm);
  plot.series.push_back(theory(s, part, theory_mm));  // dashes on the valve's curve
  fit_y(plot);
  return plot;
}

Plot gap_plot(const Shown& s, Part part) {
  Plot plot = plot_over_cam(s, part, "Train lift less valve lift", "Compressed above 0, apart below", "\u00B5m");
  add_by_contact(plot, s, part, gap_um);
  if (s.cycle.separations > 0) {
    mark(
        plot, s, part, Contact::separated, [](const Tick& t) { return -t.forces.train_compression_m; }, gap_um,
        "separation " + micrometres(s.cycle.separation_clearance_m));
  }
  return plot;
}

Plot force_plot(const Shown& s, Part part) {
  Plot plot = plot_over_cam(s, part, "Forces on the valve", "Force", "kN");
  plot.series = {curve(s, part, "train", 1, train_kN), curve(s, part, "seat", 3, seat_kN)};
  return plot;
}

Plot area_plot(const Shown& s, Part part, const FlowArea& area) {
  constexpr double kMm2PerM2 = 1e6;
  Plot plot = plot_over_cam(s, part, "Flow area of one valve", "Area", "mm\u00B2");
  const auto geometric = [&](double lift_m) { return area.geometric_m2(lift_m) * kMm2PerM2; };
  const auto effective = [&](double lift_m) { return area.effective_m2(lift_m) * kMm2PerM2; };
  plot.series = {
      curve(s, part, "geometric", 1, [&](const Tick& t) { return geometric(t.motion.lift_m); }),
      curve(s, part, "effective", 2, [&](const Tick& t) { return effective(t.motion.lift_m); }),
      curve(s, part, "theory", kTheoryColour, [&](const Tick& t) { return geometric(t.motion.theoretical_lift_m); })};
  plot.series[2].style.dashed = true;
  return plot;
}

Series load_curve(const Shown& s, Part part, const std::vector<CamLoads>& loads, const char* name, int colour,
                  double CamLoads::*of, double factor) {
  Series series = curve(s, part, name, colour, [](const Tick&) { return 0.0; });
  for (std::size_t i = part.from; i < part.to; ++i) series.y[i - part.from] = loads[i].*of * factor;
  return series;
}

Plot stress_plot(const Shown& s, Part part, const ValveCycleTrace& trace) {
  constexpr double kMPaPerPa = 1e-6;
  Plot plot = plot_over_cam(s, part, "Stress between cam and follower", "Largest pressure, by Hertz", "MPa");
  plot.series = {
      load_curve(s, part, trace.loads, trace.limit_Pa > 0 ? "stress" : "", 1, &CamLoads::stress_Pa, kMPaPerPa)};
  if (trace.limit_Pa > 0) {
    plot.series.push_back(
        curve(s, part, "limit", kTheoryColour, [&trace](const Tick&) { return trace.limit_Pa * kMPaPerPa; }));
    plot.series.back().style.dashed = true;
  }
  fit_y(plot);
  return plot;
}

Plot torque_plot(const Shown& s, Part part, const ValveCycleTrace& trace) {
  Plot plot = plot_over_cam(s, part, "Torque of the cam", "Against rotation above 0", "Nm");
  plot.series = {load_curve(s, part, trace.loads, "", 2, &CamLoads::torque_Nm, 1)};
  return plot;
}

Plot seating_plot(const Shown& s) {
  const Part part = seating_part(s);
  Plot plot = plot_over_cam(s, part, "Seating, closer", "Lift above the seat's contact", "\u00B5m");
  add_by_contact(plot, s, part, lift_um);
  plot.series.push_back(theory(s, part, theory_um));
  if (s.cycle.bounces > 0) {
    const Part behind{s.seated, part.to};
    mark(plot, s, behind, Contact::bouncing, lift_um, lift_um, "bounce " + micrometres(s.cycle.bounce_height_m));
  }
  report::count_from(plot, s.seat_contact_m * kMicro, "seat contact", 5);
  fit_y(plot);
  return plot;
}

std::string count(std::uint32_t number, const char* one) {
  return number == 0   ? "no " + std::string(one)
         : number == 1 ? "1 " + std::string(one)
                       : std::to_string(number) + " " + one + "s";
}

std::string motion_in_words(const ValveCycle<double>& c) {
  const std::string delay =
      has_opening_delay(c) ? "opening delay " + number_text(c.opening_delay_deg, 4) + " cam deg" : "no opening delay";
  return "Largest lift " + number_text(c.largest_lift_m * kMilli, 5) + " mm, " + delay + ", seating at " +
         number_text(c.seating_speed_m_s, 3) + " m/s";
}

std::string flight_in_words(const ValveCycle<double>& c) {
  std::string text = c.separations == 0 ? "No separation" : count(c.separations, "separation");
  if (c.separations > 0) text += " of up to " + micrometres(c.separation_clearance_m);
  text += ", " + count(c.bounces, "bounce");
  if (c.bounces > 0) text += " of up to " + micrometres(c.bounce_height_m);
  return text + (c.off_seat_at_end != 0 ? "; still off its seat in the middle of the base circle" : "");
}

std::string margin_in_words(const ValveCycleTrace& trace) {
  if (!(trace.redline.crank_rad_s > 0)) return "no spring margin: the valve never opens";
  return "spring margin at least " + number_text(trace.redline.margin(trace.speed_rad_s), 3) + ", at " +
         number_text(trace.redline.cam_deg, 3) + "\u00B0";
}

}  // namespace

report::Sheet valve_sheet(const ValveCycleTrace& trace, const std::string& title, const std::string& remark) {
  const Shown s = shown(trace);
  const Part part = moving_part(s);
  report::Sheet sheet;
  sheet.title = title;
  sheet.remarks = {remark, motion_in_words(s.cycle) + "; " + margin_in_words(trace), flight_in_words(s.cycle)};
  sheet.plots = {lift_plot(s, part), force_plot(s, part), gap_plot(s, part)};
  if (s.seated < s.ticks.size()) sheet.plots.push_back(seating_plot(s));
  if (trace.area) sheet.plots.push_back(area_plot(s, part, *trace.area));
  if (!trace.loads.empty()) {
    sheet.plots.push_back(stress_plot(s, part, trace));
    sheet.plots.push_back(torque_plot(s, part, trace));
  }
  return sheet;
}

}  // namespace crankloop::program
