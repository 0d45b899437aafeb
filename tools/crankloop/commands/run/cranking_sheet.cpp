#include "cranking_sheet.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "../../files/units.hpp"
#include "../../report/text.hpp"

namespace crankloop::program {
namespace {

using report::axis_of;
using report::number_text;
using report::Plot;
using report::Series;

constexpr double kAround_s = 0.06;  ///< of the first edge, each way

/// Teeth whose two lobes went by. Between teeth the voltage is 0 to rounding: that is no lobe.
std::size_t teeth_passed(const AnalogueTrace& trace) {
  constexpr double kLobe_ratio = 0.1;  // of the tooth before, at least
  std::size_t teeth = 0;
  double largest_V = 0, before_V = 0;
  for (const double V : trace.voltage_V) {
    largest_V = std::max(largest_V, V);
    const bool positive = largest_V > kLobe_ratio * before_V, negative = V < -kLobe_ratio * largest_V;
    if (!positive || !negative) continue;
    ++teeth;
    before_V = largest_V, largest_V = 0;
  }
  return teeth;
}

Series series_of(const char* name, const std::vector<double>& x, const std::vector<double>& y, report::Range over) {
  Series series;
  series.name = name;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] < over.low || x[i] > over.high) continue;
    series.x.push_back(x[i]), series.y.push_back(y[i]);
  }
  return series;
}

Plot voltage_plot(const AnalogueTrace& trace, const char* title, report::Range over) {
  Plot plot = report::plot_of(title, axis_of("Time", "s"), axis_of("Voltage", "V"));
  plot.x.range = over;
  plot.series = {series_of("sensor", trace.time_s, trace.voltage_V, over),
                 series_of("arms beyond", trace.time_s, trace.arms_V, over)};
  plot.series[1].style.bold = true;
  return plot;
}

}  // namespace

report::Sheet cranking_sheet(const AnalogueTrace& trace, const std::string& title) {
  const report::Range whole{0, trace.time_s.empty() ? 1 : trace.time_s.back()};
  const double first_s = trace.edges_s.empty() ? whole.high / 2 : trace.edges_s.front();
  const report::Range around{std::max(0.0, first_s - kAround_s), std::min(whole.high, first_s + kAround_s)};
  report::Sheet sheet;
  sheet.title = title;
  sheet.remarks = {"The comparator told " + std::to_string(trace.edges_s.size()) + " of " +
                   std::to_string(teeth_passed(trace)) + " teeth that passed the sensor" +
                   (trace.edges_s.empty() ? "" : ", the first after " + number_text(first_s, 3) + " s")};
  Plot speed = report::plot_of("Crank speed", axis_of("Time", "s"), axis_of("Speed", "rpm"));
  std::vector<double> rpm;
  for (const double rad_s : trace.speed_rad_s) rpm.push_back(rad_s * kRpmPerRad_s);
  speed.x.range = whole;
  speed.y.include_zero = true;
  speed.series = {series_of("", trace.tick_end_s, rpm, whole)};
  Plot level = report::plot_of("Comparator", axis_of("Time", "s"), axis_of("Level", ""));
  level.x.range = around, level.y.range = report::Range{-0.1, 1.1};
  level.y.tick_step = 1;
  level.series = {series_of("", trace.time_s, trace.level, around)};
  sheet.plots = {speed, voltage_plot(trace, "Sensor and threshold", whole),
                 voltage_plot(trace, "Around the first edge", around), level};
  return sheet;
}

}  // namespace crankloop::program
