// Trigger signals of a free run's last cycle as square waves.
#include <algorithm>

#include "../../report/page.hpp"
#include "free_run.hpp"

namespace crankloop::program {
namespace {

using report::axis_of;
using report::Plot;
using report::plot_of;
using report::Series;

/// A square wave over a part of the cycle, in ms from its begin.
Series square_wave(const FreeCycle& cycle, std::size_t wheel, double from_s, double to_s) {
  const double begin_s = cycle.samples.front().time_s;
  Series series;
  series.style.draw = report::Draw::step;
  bool level = cycle.levels[wheel];
  const auto point = [&](double time_s) {
    series.x.push_back((time_s - begin_s) * 1e3);
    series.y.push_back(level ? 1 : 0);
  };
  bool begun = false;
  for (const FreeCycle::Edge& edge : cycle.edges[wheel]) {
    if (edge.time_s > to_s) break;
    if (edge.time_s >= from_s && !begun) {
      point(from_s);
      begun = true;
    }
    level = edge.level;
    if (begun) point(edge.time_s);
  }
  if (!begun) point(from_s);
  point(to_s);
  return series;
}

Plot signal_plot(const std::string& title, const FreeCycle& cycle, std::size_t wheel, double from_s, double to_s) {
  const double begin_s = cycle.samples.front().time_s;
  Plot one = plot_of(title, axis_of("Time in the cycle", "ms"), axis_of("Level", ""));
  one.x.range = report::Range{(from_s - begin_s) * 1e3, (to_s - begin_s) * 1e3};
  one.y.tick_step = 1;
  one.y.range = report::Range{-0.25, 1.25};
  one.series.push_back(square_wave(cycle, wheel, from_s, to_s));
  return one;
}

/// The time from tooth to tooth: in a whole cycle of many teeth the only thing that can be read is where there is none.
Plot tooth_time_plot(const std::string& name, const FreeCycle& cycle, std::size_t wheel) {
  Plot one = plot_of(name + ", from tooth to tooth", axis_of("Time in the cycle", "ms"),
                     axis_of("Time since the last tooth", "ms"));
  one.y.include_zero = true;
  one.caption = "From rising edge to rising edge: gaps stand out; between them the ripple of the speed shows.";
  Series series;
  series.style.draw = report::Draw::step;
  double before_s = -1;
  std::size_t longest = 0;
  for (const FreeCycle::Edge& edge : cycle.edges[wheel]) {
    if (!edge.level) continue;
    if (before_s >= 0) {
      series.x.push_back((before_s - cycle.samples.front().time_s) * 1e3);
      series.y.push_back((edge.time_s - before_s) * 1e3);
      if (series.y.back() > series.y[longest]) longest = series.y.size() - 1;
    }
    before_s = edge.time_s;
  }
  if (!series.y.empty()) one.markers.push_back({series.x[longest], series.y[longest], "gap", 0});
  one.series.push_back(std::move(series));
  return one;
}

/// Twelve edges on either side of the longest time between two: where the gap of a wheel with many teeth is.
Plot close_up(const std::string& name, const FreeCycle& cycle, std::size_t wheel) {
  constexpr std::size_t kAround = 12;
  const std::vector<FreeCycle::Edge>& edges = cycle.edges[wheel];
  std::size_t longest = 1;
  for (std::size_t i = 2; i < edges.size(); ++i) {
    if (edges[i].time_s - edges[i - 1].time_s > edges[longest].time_s - edges[longest - 1].time_s) longest = i;
  }
  const std::size_t first = longest > kAround ? longest - kAround : 0;
  const std::size_t last = std::min(longest + kAround, edges.size() - 1);
  return signal_plot(name + ", where it is still for longest", cycle, wheel, edges[first].time_s, edges[last].time_s);
}

}  // namespace

report::Section trigger_signal_section(const FreeReportInput& input) {
  constexpr std::size_t kManyEdges = 50;
  report::Section section{"signals", "Trigger signals of the last cycle", {}};
  const FreeCycle& cycle = input.figures.cycles.back();
  const std::vector<SignalFigures>& signals = input.figures.signals;
  for (std::size_t w = 0; w < signals.size(); ++w) {
    const bool many = cycle.edges[w].size() > kManyEdges;
    section.blocks.push_back(
        many ? tooth_time_plot(signals[w].name, cycle, w)
             : signal_plot(signals[w].name, cycle, w, cycle.samples.front().time_s, cycle.samples.back().time_s));
  }
  for (std::size_t w = 0; w < signals.size(); ++w) {  // beside each other, so that whole cycles can be compared
    if (cycle.edges[w].size() > kManyEdges) section.blocks.push_back(close_up(signals[w].name, cycle, w));
  }
  return section;
}

}  // namespace crankloop::program
