// Surge of the valve springs over the speed, in the report's section of the valve trains.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <crankloop/tabulate/valve_lift.hpp>
#include <crankloop/tabulate/valve_springs.hpp>

#include "../loops/surge_force.hpp"
#include "engine_report_parts.hpp"

namespace crankloop::program {
namespace {

using report::Plot;
using report::Series;

constexpr int kSurgeSpeeds = 181;
constexpr double kSurgeFrom = 0.3;  ///< of the larger of rated speed and the run's
constexpr double kSurgeTo = 1.2;
constexpr double kCamPerCrank = 0.5;  ///< turns
constexpr int kHarmonics = 8;
constexpr double kPeakOver = 1.15;  ///< what a marked peak exceeds its neighbourhood by
constexpr int kNeighbourhood = 6;

/// Cam turns per second at a speed of the crank.
double cam_Hz(double rpm) { return rpm / 60 * kCamPerCrank; }

std::string ordinal(int n) {
  const int tens = n % 100 / 10, last = n % 10;
  const char* const ending = tens == 1 ? "th" : last == 1 ? "st" : last == 2 ? "nd" : last == 3 ? "rd" : "th";
  return std::to_string(n) + ending;
}

/// The lift's harmonics against the modes of the springs: where they cross, the lift drives the spring.
Plot campbell_plot(const std::string& name, const Valve& valve, double high_rpm) {
  Plot plot = plot_of("Campbell diagram of the " + name + " spring", axis_of("Engine speed", "rpm"),
                      axis_of("Frequency", "Hz"));
  SurgingSpring springs[2];
  const int count = springs_of(valve, springs);
  double lowest_Hz = 0, highest_Hz = 0;
  for (int i = 0; i < count; ++i) {
    const double first_Hz = surge_frequency_rad_s(springs[i]) * kTurnsPerRad;
    lowest_Hz = i == 0 ? first_Hz : std::min(lowest_Hz, first_Hz);
    highest_Hz = std::max(highest_Hz, first_Hz);
    for (int n = 1; n <= kMaxSpringModes; ++n) {
      Series mode{(count == 1 ? ""
                   : i == 0   ? "outer, "
                              : "inner, ") +
                      std::string("mode ") + std::to_string(n),
                  {kSurgeFrom * high_rpm, kSurgeTo * high_rpm},
                  {n * first_Hz, n * first_Hz}};
      mode.style.colour = i + 1;
      mode.style.bold = true;
      plot.series.push_back(std::move(mode));
    }
  }
  // From the harmonic that meets the first mode at the highest speed on: those of higher orders are small.
  const int first = std::max(1, static_cast<int>(std::ceil(lowest_Hz / cam_Hz(kSurgeTo * high_rpm))));
  for (int n = first; n < first + kHarmonics; ++n) {
    Series harmonic{ordinal(n), {kSurgeFrom * high_rpm, kSurgeTo * high_rpm}, {}};
    for (const double rpm : harmonic.x) harmonic.y.push_back(n * cam_Hz(rpm));
    harmonic.style.colour = 4;
    harmonic.style.dashed = true;
    plot.series.push_back(std::move(harmonic));
  }
  plot.y.range = report::Range{0, 1.15 * highest_Hz * kMaxSpringModes};
  plot.names_at_ends = true;
  plot.caption =
      "Frequencies of the spring itself between its ends, and harmonics of the lift, one per turn of the cam: where "
      "they "
      "cross, the spring surges.";
  return plot;
}

/// Marks where the force is largest within its neighbourhood, with the harmonic that meets the first mode there.
void mark_peaks(Plot& plot, double first_Hz) {
  const Series& force = plot.series[0];
  const int last = static_cast<int>(force.y.size()) - 1;
  for (int i = kNeighbourhood; i <= last - kNeighbourhood; ++i) {
    const auto at = [&](int j) { return force.y[static_cast<std::size_t>(j)]; };
    const auto begin = force.y.begin() + (i - kNeighbourhood), end = force.y.begin() + (i + kNeighbourhood + 1);
    if (at(i) < *std::max_element(begin, end) || at(i) < kPeakOver * *std::min_element(begin, end)) continue;
    const double rpm = force.x[static_cast<std::size_t>(i)];
    const int harmonic = static_cast<int>(std::lround(first_Hz / cam_Hz(rpm)));
    plot.markers.push_back({rpm, at(i), ordinal(harmonic), 0});
  }
}

Plot force_plot(const std::string& name, const Valve& valve, const ValveLift& lift, double high_rpm) {
  Plot plot =
      plot_of("Surge of the " + name + " spring over the speed", axis_of("Engine speed", "rpm"), axis_of("Force", "N"));
  Series surge{"largest surge force", {}, {}, {}}, preload{"preload", {}, {}, {}};
  const LiftSlopes slopes(lift);
  double first_Hz = 0;
  for (int i = 0; i < kSurgeSpeeds; ++i) {
    const double rpm = high_rpm * (kSurgeFrom + (kSurgeTo - kSurgeFrom) * i / (kSurgeSpeeds - 1));
    const SpringSurgeCycle cycle = surge_over_cycle(slopes, valve, 2 * kPi * cam_Hz(rpm));
    first_Hz = cycle.frequency_Hz;
    surge.x.push_back(rpm), surge.y.push_back(cycle.largest_N);
  }
  preload.x = {kSurgeFrom * high_rpm, kSurgeTo * high_rpm};
  preload.y = {valve.spring_preload_N, valve.spring_preload_N};
  preload.style.dashed = true;
  plot.series = {std::move(surge), std::move(preload)};
  plot.y.include_zero = true;
  mark_peaks(plot, first_Hz);
  plot.caption =
      "Largest force of the spring's first three modes beyond its static one, driven by the theoretical lift "
      "in its steady state, damping ratio " +
      number_text(valve.surge_damping_ratio, 3) +
      "; named: the lift's harmonic that meets the first mode. The motion above is of a spring that follows "
      "its valve; `crankloop valve` and `redline` step the surge with the valve (surge_modes).";
  return plot;
}

}  // namespace

void add_surge(const ReportInput& input, report::Section& section) {
  const EngineDefinition& definition = input.exact.definition();
  const std::vector<std::string> names = names_of_trains(input.file);
  const double high_rpm = std::max(std::abs(input.operation.speed_rpm), input.file.rated_rpm());
  const auto lift = std::make_unique<ValveLift>();
  for (std::size_t t = 0; t < input.trace.valves.size(); ++t) {
    const ValveTrain& train = definition.trains[t];
    if (!(train.valve.spring_kg > 0 && train.valve.spring_N_m > 0)) continue;
    if (!lift->init(train.cam, train.rocker).ok()) continue;  // the loop has accepted it
    section.blocks.push_back(campbell_plot(names[t], train.valve, high_rpm));
    section.blocks.push_back(force_plot(names[t], train.valve, *lift, high_rpm));
  }
}

}  // namespace crankloop::program
