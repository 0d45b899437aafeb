// `crankloop redline FILE`: the speeds at which a valve starts to float and to bounce, and the influence of its train.
//
// What belongs here: options, and which sweeps are run. What does not: a sweep (redline_search.hpp), what is printed
// (redline_text.cpp), the page (redline_report.cpp).
#include "redline.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../command_line/operating_point.hpp"
#include "../../command_line/parallel.hpp"
#include "../../command_line/progress.hpp"
#include "../../command_line/results.hpp"
#include "../../command_line/summary.hpp"
#include "../../files/units.hpp"
#include "../../files/words.hpp"
#include "../../loops/valve_accuracy.hpp"

namespace crankloop::program {
namespace {

constexpr double kMostRpm = 100000;

/// Approximate number of speeds of a sweep: its own and two bisections.
double speeds_of(const SpeedRange& range) {
  return (range.to_rpm - range.from_rpm) / range.step_rpm + 1 + 2 * std::log2(std::max(range.step_rpm, 1));
}

RedlineLimits limits_of(const Arguments& arguments, const LoneValve& valve) {
  RedlineLimits limits{millionths(arguments.number("--bounce-um")), arguments.number("--seating-m-s"), 0};
  if (!arguments.has("--coil-bind-mm")) return limits;
  limits.lift_m = arguments.number("--coil-bind-mm") / 1e3;
  const double lift_m = valve.lift().largest_lift_m();
  if (limits.lift_m <= lift_m)
    throw UsageError("--coil-bind-mm must be above the largest theoretical lift, " + brief(lift_m * 1e3) + " mm");
  return limits;
}

/// As the options ask; else for most engines 500 to 15000 rpm, and what a very slow or fast one needs.
SpeedRange range_of(const Arguments& arguments, const EngineFile& file) {
  constexpr double kFrom_rpm = 500, kTo_rpm = 15000, kFromOfRated = 0.25, kLeastToOfRated = 2, kMostToOfRated = 20;
  double from_rpm = kFrom_rpm, to_rpm = kTo_rpm;
  if (file.has("engine")) {
    const double rated_rpm = file.rated_rpm();
    from_rpm = std::max(1.0, std::min(from_rpm, kFromOfRated * rated_rpm));
    to_rpm = std::max(std::min(to_rpm, kMostToOfRated * rated_rpm), kLeastToOfRated * rated_rpm);
  }
  const auto rpm = [&](const char* option, double usual_rpm) {
    return arguments.has(option) ? arguments.whole_number(option) : static_cast<int>(std::lround(usual_rpm));
  };
  const SpeedRange range = speed_range(rpm("--from", from_rpm), rpm("--to", std::min(to_rpm, kMostRpm)));
  if (range.from_rpm >= range.to_rpm) throw UsageError("--from must be less than --to");
  return range;
}

/// The train with springs that follow their valve.
Sweep sweep_following(const Redline& redline, const std::function<void()>& after_speed) {
  Valve valve = redline.valve.valve();
  valve.surge_modes = 0;
  return sweep_speeds(redline.valve.with(valve), redline.range, 1, after_speed, redline.limits);
}

/// Of the train as the file has it.
Summary figures_of_redline(const Arguments& arguments, const EngineFile& file) {
  const SpeedRange range = range_of(arguments, file);
  const LoneValve valve(file, train_name(arguments, file));
  Redline redline{valve, range, nullptr, {}, "", limits_of(arguments, valve)};
  redline.sweeps.push_back(sweep_speeds(valve, range, 1, {}, redline.limits));
  if (redline.surges()) redline.following = sweep_following(redline, {});
  return summary_of(redline);
}

std::string command_line(const Arguments& arguments, const Redline& redline, const std::string& train) {
  std::string text = "crankloop redline " + shell_word(arguments.file()) + " --train " + train + " --from " +
                     std::to_string(redline.range.from_rpm) + " --to " + std::to_string(redline.range.to_rpm) +
                     " --bounce-um " + shortest(arguments.number("--bounce-um")) + " --seating-m-s " +
                     shortest(arguments.number("--seating-m-s"));
  if (arguments.has("--coil-bind-mm")) text += " --coil-bind-mm " + shortest(arguments.number("--coil-bind-mm"));
  return text + (redline.varied != nullptr ? " --vary " + shell_word(redline.varied->option) : "");
}

/// The trains on all processors.
void sweep_all(Redline& redline) {
  const std::size_t count = redline.varied != nullptr ? redline.varied->trains.size() : 1;
  const std::size_t besides = redline.surges() ? 1 : 0;
  Progress progress("searching", static_cast<double>(count + besides) * speeds_of(redline.range));
  std::mutex one_at_a_time;
  const auto after_speed = [&] {
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    progress.long_step();
  };
  redline.sweeps.resize(count);
  const auto sweep = [&](std::size_t i) {
    if (i == count) {
      redline.following = sweep_following(redline, after_speed);
      return;
    }
    if (redline.varied == nullptr) {
      redline.sweeps[i] = sweep_speeds(redline.valve, redline.range, 1, after_speed, redline.limits);
      return;
    }
    const VariedTrain& train = redline.varied->trains[i];
    redline.sweeps[i] = sweep_speeds(*train.valve, redline.range, train.at, after_speed, redline.limits);
    redline.sweeps[i].value = train.value;
    redline.sweeps[i].as_given = train.as_given;
  };
  run_in_parallel(processors(), count + besides, sweep, [] {});
}

int run_redline(const Arguments& arguments) {
  const EngineFile file = read_engine(arguments, {});
  const SpeedRange range = range_of(arguments, file);
  const std::string name = train_name(arguments, file);
  const LoneValve valve(file, name);
  std::optional<VariedTrains> varied;
  if (arguments.has("--vary")) varied.emplace(varied_trains(valve, arguments.text("--vary")));
  Results results(arguments, {"--csv", "--report"});
  Redline redline{valve, range, varied ? &*varied : nullptr, {}, "", limits_of(arguments, valve)};
  redline.command_line = command_line(arguments, redline, name);
  sweep_all(redline);
  tell_warnings(arguments, beyond_class(valve, range.to_rpm, redline.sweeps.front().tick_s));
  if (Output* csv = results["--csv"]) write_csv(*csv, redline);
  if (Output* page = results["--report"]) page->write(report::to_html(redline_page(redline)));
  results.finish(summary_of(redline).text() + "\n" + table_of(redline));
  return kSuccess;
}

constexpr Option kRedlineOptions[] = {
    text("--train", "NAME",
         "valve train: the NAME of its [cam NAME], [rocker NAME] and [valve NAME]; default the only one of the file"),
    whole_number("--from", "N", from(1).up_to(kMostRpm),
                 "lowest engine speed in rpm; default 500, or a quarter of rated_rpm where that is less"),
    whole_number("--to", "N", from(1).up_to(kMostRpm),
                 "highest engine speed in rpm; default 15000, but 2 to 20 times rated_rpm"),
    number("--bounce-um", "H", from(1).up_to(1000), "minimum height of a bounce for its onset", "50"),
    number("--seating-m-s", "V", above(0).up_to(100), "highest permissible seating speed", "0.5"),
    number("--coil-bind-mm", "L", above(0).up_to(1000),
           "valve lift at which the spring binds: results beyond are left out; default 1.5 times the theoretical lift"),
    text("--vary", "P",
         "repeats the sweep with train, mass, spring, preload or damping times 0.5, 0.7, 0.85, 1, 1.2, 1.5, 2 (mass: "
         "all "
         "that moves, damping: all three ratios), or with SECTION.KEY=FROM:TO:N or =A,B,C of the engine file"),
    text("--csv", "F", "file for a row per factor and speed; - is standard output, the rest then goes to stderr"),
    text("--report", "F.html", "HTML file with the plots; opens in any browser"),
};

}  // namespace

const Command kRedline{"redline",
                       "the speeds at which a valve starts to float and to bounce, and what influences them",
                       "FILE [--train NAME] [--from N] [--to N] [--bounce-um H] [--seating-m-s V] [--coil-bind-mm L] "
                       "[--vary P] [--csv F] [--report F.html]",
                       "crankloop redline ohc_125.ini --train intake --vary spring --report redline.html",
                       1,
                       kRedlineOptions,
                       run_redline,
                       false,
                       figures_of_redline};

}  // namespace crankloop::program
