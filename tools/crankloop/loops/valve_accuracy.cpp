#include "valve_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../files/number.hpp"
#include "run_limits.hpp"
#include "valve_tick_limit.hpp"

namespace crankloop::program {
namespace {

constexpr int kShorter = 16;
constexpr int kStarts = 16;  ///< in different parts of a tick

}  // namespace

double expected_error_m(const LoneValve& valve, double speed_rpm, double tick_s, const ValveStepping& stepping) {
  const int shorter = std::clamp(static_cast<int>(tick_s / kShortestTick_s), 1, kShorter);
  const ValveMethod method{stepping};
  ValveLoop<double> coarse(valve, tick_s, method);
  ValveLoop<double> fine(valve, tick_s / shorter, method);
  const int ticks = static_cast<int>(ticks_per_cycle(speed_rpm, tick_s)) + 1;
  double worst_m = 0;
  for (int start = 0; start < kStarts; ++start) {
    const double start_deg = (speed_rpm < 0 ? 180 : -180) + start * coarse.deg_per_tick(speed_rpm) / kStarts;
    coarse.start(speed_rpm, start_deg, 0);
    fine.start(speed_rpm, start_deg, 0);
    for (int i = 0; i < ticks; ++i) {
      coarse.step();
      for (int j = 0; j < shorter; ++j) fine.step();
      worst_m = std::max(worst_m, std::fabs(coarse.output().motion.lift_m - fine.output().motion.lift_m));
    }
  }
  return worst_m;
}

std::vector<std::string> beyond_class(const LoneValve& valve, double speed_rpm, double tick_s,
                                      const ValveStepping& stepping) {
  const double deg = std::fabs(speed_rpm) * 3 * tick_s;
  const double keeps_deg = class_deg(valve.definition().trains[0], tick_s, stepping);
  const bool surges = valve.valve().surge_modes > 0;  // coupled to the valve's step to second order
  if (!(deg > keeps_deg || surges) || deg > 180) return {};
  const double error_m = expected_error_m(valve, speed_rpm, tick_s, stepping);
  if (error_m <= stepping.accuracy_m) return {};
  if (surges && deg <= keeps_deg)
    return {valve.file().path() + ": warning: at " + brief(speed_rpm) + " rpm and a tick of " + brief(tick_s * 1e6) +
            " us the lift of train " + valve.train().name + " may be off by " + about(error_m * 1e6) +
            " um for the surge of its springs, beyond the class of " + brief(stepping.accuracy_m * 1e6) +
            " um: a tick half as long has a quarter of that"};
  return {valve.file().path() + ": warning: at " + brief(speed_rpm) + " rpm a tick of " + brief(tick_s * 1e6) +
          " us turns the cam of train " + valve.train().name + " by " + brief(std::round(deg * 10) / 10) +
          " cam degrees: its valve's lift may be off by " + about(error_m * 1e6) + " um; it keeps the class of " +
          brief(stepping.accuracy_m * 1e6) + " um up to " + brief(std::floor(keeps_deg * 10) / 10) + " degrees"};
}

std::vector<std::string> warnings_about_valves(const EngineFile& file, double speed_rpm, double tick_s,
                                               const ValveStepping& stepping) {
  std::vector<std::string> lines;
  if (speed_rpm == 0) return lines;
  for (const TrainOfFile& train : file.trains()) {
    if (!train.complete()) continue;
    const LoneValve valve(file, train.name);
    Valve as_run = valve.valve();
    as_run.surge_modes = 0;
    for (std::string& line : beyond_class(valve.with(as_run), speed_rpm, tick_s, stepping))
      lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace crankloop::program
