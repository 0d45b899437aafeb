// `crankloop map FILE`: torque, air charge and mean pressures of an engine that breathes over speed and throttle.
#include <algorithm>
#include <cmath>
#include <string>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../command_line/gas_options.hpp"
#include "../../command_line/operating_point.hpp"
#include "../../command_line/progress.hpp"
#include "../../command_line/results.hpp"
#include "../../command_line/summary.hpp"
#include "../../engine_file/plausibility.hpp"
#include "../../engine_file/pressure_words.hpp"
#include "../../files/csv.hpp"
#include "../../files/error.hpp"
#include "../../files/number.hpp"
#include "../../files/words.hpp"
#include "../../loops/valve_tick_limit.hpp"
#include "engine_map.hpp"

namespace crankloop::program {
namespace {

constexpr double kMaxPoints = 10000;

/// "800:6000:14"
Grid grid(const Arguments& arguments, const char* option, Range range) {
  const auto parts = split(arguments.text(option), ':');
  if (parts.size() != 3)
    throw UsageError(std::string(option) + ": give FROM:TO:N, like " +
                     (option == std::string("--rpm") ? "800:6000:14" : "0:1:11"));
  double numbers[3] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const ParsedNumber number = parse_number(parts[i], i < 2 ? range : from(1).up_to(1000), "");
    if (!number.ok()) throw UsageError(std::string(option) + ": " + number.problem);
    numbers[i] = number.value;
  }
  if (numbers[2] != std::floor(numbers[2]))
    throw UsageError(std::string(option) + ": " + in_quotes(parts[2]) + " is not a whole number");
  if (numbers[2] == 1 ? numbers[0] != numbers[1] : numbers[0] >= numbers[1]) {
    throw UsageError(std::string(option) + ": FROM must be less than TO, or the same with N = 1");
  }
  return {numbers[0], numbers[1], static_cast<int>(numbers[2])};
}

void write_csv(Output& out, const EngineMap& map) {
  std::vector<std::string> header{"speed_rpm", "throttle"};
  for (const MapColumn& column : kMapColumnList) header.emplace_back(column.name);
  CsvWriter csv(out, header);
  for (const MapPoint& point : map.points) {
    csv.cell(point.speed_rpm);
    csv.cell(point.throttle_ratio);
    for (const MapColumn& column : kMapColumnList) csv.cell(static_cast<float>(column.value(point)));
    csv.end_row();
  }
}

std::string summary(const EngineMap& map) {
  Summary s;
  s.remark(map.file.name() + " over speed and throttle, fixed-step loop in float");
  s.remark(pressure_in_short(map.file));
  s.line("points", static_cast<double>(map.points.size()));
  s.line("fuel", map.request.gas.fuel_kg * 1e6, "mg", "per cylinder and cycle");
  s.line("burn_start", map.request.gas.burn_start_deg, "deg");
  const auto add = [&](const char* name, double (*value)(const MapPoint&), const char* unit) {
    const MapPoint& most = *std::max_element(map.points.begin(), map.points.end(),
                                             [&](const MapPoint& a, const MapPoint& b) { return value(a) < value(b); });
    s.line(name, value(most), unit, "at " + brief(most.speed_rpm) + " rpm, throttle " + brief(most.throttle_ratio));
  };
  add(
      "largest_brake_torque", [](const MapPoint& p) { return p.brake_torque_Nm; }, "Nm");
  add(
      "largest_brake_power", [](const MapPoint& p) { return p.power_W / 1e3; }, "kW");
  add(
      "largest_net_mep", [](const MapPoint& p) { return p.gas.cycle.net_mep_Pa / 1e3; }, "kPa");
  add(
      "largest_volumetric_efficiency", [](const MapPoint& p) { return p.gas.cycle.volumetric_efficiency; }, "");
  double faulty_ticks = 0;
  std::uint32_t faults = 0;
  for (const MapPoint& point : map.points) faulty_ticks += point.faulty_ticks, faults |= point.faults;
  s.faulty_ticks(static_cast<std::uint64_t>(faulty_ticks), faults);
  return s.text();
}

int run_map_command(const Arguments& arguments) {
  const Grid speed_rpm = grid(arguments, "--rpm", above(0).up_to(100000));
  const Grid throttle_ratio = grid(arguments, "--throttle", from(0).up_to(1));
  const double count = static_cast<double>(speed_rpm.count) * throttle_ratio.count;
  if (count > kMaxPoints)
    throw UsageError("a map of " + brief(count) + " points; at most " + brief(kMaxPoints) + " are allowed");
  const EngineFile file = read_engine(arguments, {"engine", "crank", "masses"});
  if (!breathes(file.definition())) {
    throw InputError(
        file.path() +
        " has no [pressure] source = gas: without it nothing depends on the throttle; take `crankloop run`");
  }
  const double tick_s = millionths(arguments.number("--tick-us"));
  require_trains(file, tick_s);
  require_manifolds(file, tick_s);
  (void)tell_warnings(arguments, warnings_about_gas(file, std::max(speed_rpm.from, speed_rpm.to), tick_s));
  EngineMap map{file, {speed_rpm, throttle_ratio, fuel_and_spark(arguments, file), tick_s}, ""};
  map.command_line = "crankloop map " + shell_word(arguments.file()) + " --rpm " + arguments.text("--rpm") +
                     " --throttle " + arguments.text("--throttle") + " --fuel-mg " +
                     brief(map.request.gas.fuel_kg * 1e6) + " --burn-start-deg " +
                     shortest(map.request.gas.burn_start_deg) + " --tick-us " + shortest(arguments.number("--tick-us"));
  Results results(arguments, {"--csv", "--report"});
  {
    Progress progress("mapping", count, Progress::kLogPeriod_ns);
    run_map(map, [&progress] { progress.long_step(); });
  }
  if (Output* csv = results["--csv"]) write_csv(*csv, map);
  if (Output* page = results["--report"]) page->write(report::to_html(map_page(map)));
  results.finish(summary(map));
  return kSuccess;
}

constexpr Option kOptions[] = {
    required(text("--rpm", "FROM:TO:N", "engine speeds in rpm, N of them evenly spaced")),
    required(text("--throttle", "FROM:TO:N", "throttle ratios, likewise: 0 closed, 1 wide open")),
    kFuel,
    kBurnStart,
    kTick,
    text("--csv", "F", "file for a row per point; - is standard output, the summary then goes to stderr"),
    text("--report", "F.html", "file for the heat maps, which any browser shows"),
};

}  // namespace

const Command kMap{"map",
                   "torque, air charge and mean pressures of an engine that breathes, over speed and throttle",
                   "FILE --rpm FROM:TO:N --throttle FROM:TO:N [--fuel-mg M] [--burn-start-deg A] [--tick-us T] "
                   "[--csv F] [--report F.html]",
                   "crankloop map four_2000.ini --rpm 1000:6000:6 --throttle 0:1:6 --csv map.csv --report map.html",
                   1,
                   kOptions,
                   run_map_command};

}  // namespace crankloop::program
