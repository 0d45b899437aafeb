// `crankloop map FILE`: torque, air charge and mean pressures of an engine with gas exchange over speed, and over
// throttle or fuel.
#include <algorithm>
#include <cmath>
#include <string>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../command_line/gas_options.hpp"
#include "../../command_line/operating_point.hpp"
#include "../../command_line/results.hpp"
#include "../../command_line/shards.hpp"
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

constexpr const char* kSpeeds = "--rpm";
constexpr Option kBestSpark = flag(
    "--mbt", "each point at the burn start of its best torque, found between -60 and 20 deg to 0.5 deg by twelve runs");

/// "800:6000:14"
Grid grid(const Arguments& arguments, const std::string& name, Range range) {
  const char* example = name == kSpeeds ? "800:6000:14" : name == kThrottle.name ? "0:1:11" : "10:60:6";
  return parse_grid(name, arguments.text(name), range, 1000, example);
}

double one_number(const Arguments& arguments, const Option& option) {
  const ParsedNumber number = parse_number(arguments.text(option.name), option.range, "");
  if (!number.ok()) throw UsageError(std::string(option.name) + ": " + number.problem);
  return number.value;
}

bool is_grid(const Arguments& arguments, const Option& option) {
  return arguments.text_or_empty(option.name).find(':') != std::string::npos;
}

/// Sets the quantity that the map varies besides the speed, and the constant ones.
void set_loads(MapRequest& request, const Arguments& arguments, const EngineFile& file) {
  const bool over_throttle = is_grid(arguments, kThrottle), over_fuel = is_grid(arguments, kFuel);
  if (over_throttle == over_fuel)
    throw UsageError(over_fuel
                         ? "--throttle and --fuel-mg are both FROM:TO:N: a map is over one of them"
                         : "give FROM:TO:N as --throttle or as --fuel-mg: a map is over one of them; 1:1:1 is one "
                           "value");
  const Option& varied = over_fuel ? kFuel : kThrottle;
  request.axis = over_fuel ? &kFuelAxis : &kThrottleAxis;
  request.load = grid(arguments, varied.name, varied.range);
  request.gas = lambda_and_spark(arguments, file);
  if (over_fuel) request.gas.excess_air_ratio = 0;
  if (!over_fuel && arguments.has(kFuel.name)) set_fuel_mg(request.gas, one_number(arguments, kFuel));
  if (!over_throttle && arguments.has(kThrottle.name)) request.gas.throttle_ratio = one_number(arguments, kThrottle);
}

void write_csv(Output& out, const EngineMap& map) {
  std::vector<std::string> header{"speed_rpm", map.request.axis->column};
  for (const MapColumn& column : kMapColumnList) header.emplace_back(column.name);
  CsvWriter csv(out, header);
  for (const MapPoint& point : map.points) {
    csv.cell(point.speed_rpm);
    csv.cell(point.load);
    for (const MapColumn& column : kMapColumnList) {
      const double value = column.value(point);
      if (std::isnan(value)) {
        csv.cell("");
      } else {
        csv.cell(static_cast<float>(value));
      }
    }
    csv.end_row();
  }
}

std::string summary(const EngineMap& map) {
  Summary s;
  s.remark(map.file.name() + " over speed and " + map.request.axis->word + ", fixed-step loop in float");
  s.remark(pressure_in_short(map.file));
  s.line("points", static_cast<double>(map.points.size()));
  if (map.request.axis == &kFuelAxis) {
    s.line("throttle", map.request.gas.throttle_ratio);
  } else {
    add_fuel(s, map.request.gas);
  }
  if (map.request.best_spark) {
    s.remark("burn_start of each point: that of its best torque");
  } else {
    s.line("burn_start", map.request.gas.burn_start_deg, "deg");
  }
  const auto add = [&](const char* name, MapResult result, const char* unit) {
    const MapPoint& most = map.largest(result);
    s.line(name, most.at(result), unit, map.place_of(most));
  };
  add("max_brake_torque", MapResult::brake_torque, "Nm");
  add("max_brake_power", MapResult::brake_power, "kW");
  add("max_net_mep", MapResult::net_mep, "kPa");
  add("max_volumetric_efficiency", MapResult::volumetric_efficiency, "");
  add("max_brake_efficiency", MapResult::brake_efficiency, "");
  if (map.file.definition().gas.octane_number > 0) add("max_knock_integral", MapResult::knock_integral, "");
  for (const std::string& doubt : map.doubts()) s.remark(doubt);
  double faulty_ticks = 0;
  std::uint32_t faults = 0;
  for (const MapPoint& point : map.points) faulty_ticks += point.at(MapResult::faulty_ticks), faults |= point.faults;
  s.faulty_ticks(static_cast<std::uint64_t>(faulty_ticks), faults);
  return s.text();
}

int run_map_command(const Arguments& arguments) {
  MapRequest request;
  request.speed_rpm = grid(arguments, kSpeeds, above(0).up_to(100000));
  const EngineFile file = read_engine_for_scenes(arguments, {"engine", "crank", "masses"});
  (void)tell_warnings(arguments, warnings_about_misfires_left_out(file));
  set_loads(request, arguments, file);
  const double count = static_cast<double>(request.speed_rpm.count) * request.load.count;
  if (count > kMaxPoints)
    throw UsageError("a map of " + brief(count) + " points; at most " + brief(kMaxPoints) + " are allowed");
  if (!breathes(file.definition())) {
    throw InputError(
        file.path() +
        " has no [pressure] source = gas: without it nothing depends on throttle or fuel; use `crankloop run`");
  }
  request.best_spark = arguments.has(kBestSpark.name);
  if (request.best_spark && arguments.has(kBurnStart.name))
    throw UsageError("--mbt finds the burn start of each point: leave out --burn-start-deg");
  request.tick_s = millionths(arguments.number("--tick-us"));
  require_trains(file, request.tick_s);
  require_manifolds(file, request.tick_s);
  (void)tell_warnings(arguments, warnings_about_gas(file, request.speed_rpm.to, request.tick_s));
  const bool over_fuel = request.axis == &kFuelAxis;
  EngineMap map{file, request, ""};
  const std::string options =
      "--rpm " + arguments.text(kSpeeds) + " --throttle " +
      (over_fuel ? shortest(request.gas.throttle_ratio) : arguments.text("--throttle")) + " " +
      (over_fuel ? "--fuel-mg " + arguments.text("--fuel-mg") : fuel_option(request.gas)) +
      (request.best_spark ? std::string(" --mbt") : " --burn-start-deg " + shortest(request.gas.burn_start_deg)) +
      " --tick-us " + shortest(arguments.number("--tick-us"));
  map.command_line = "crankloop map " + shell_word(arguments.file()) + " " + options;
  Results results(arguments, {"--csv", "--report"});
  const Points points{"map", "mapping", static_cast<std::size_t>(count), Identity().add_engine(file).add(options)};
  const auto texts = results_of(arguments, points, {"--csv", "--report"}, [&](std::size_t point) {
    return run_point(file.definition(), request, static_cast<int>(point));
  });
  if (!texts) return kSuccess;
  map.points = points_of(request, *texts);
  if (Output* csv = results["--csv"]) write_csv(*csv, map);
  if (Output* page = results["--report"]) page->write(report::to_html(map_page(map)));
  results.finish(summary(map));
  return kSuccess;
}

constexpr Option kMapOptions[] = {
    required(text("--rpm", "FROM:TO:N", "engine speeds in rpm, N of them evenly spaced")),
    text(kThrottle.name, "R|FROM:TO:N",
         "throttle ratios, N of them evenly spaced: 0 closed, 1 wide open; or one, 1 by default"),
    text(kFuel.name, "M|FROM:TO:N",
         "fuel per cylinder and cycle in mg, N values evenly spaced; or one, the file's by default"),
    kLambda,
    kBurnStart,
    kBestSpark,
    kTick,
    kThreads,
    kShard,
    kPart,
    kJoin,
    text("--csv", "F", "file for a row per point; - is standard output, the summary then goes to stderr"),
    text("--report", "F.html", "HTML file with heat maps, or curves where N is 1; opens in any browser"),
};

}  // namespace

const Command kMap{
    "map",
    "torque, air charge and mean pressures of an engine with gas exchange, over speed and throttle or fuel",
    "FILE --rpm FROM:TO:N --throttle FROM:TO:N [--lambda L | --fuel-mg M] [--burn-start-deg A | --mbt] "
    "[--tick-us T] [--threads N] [--csv F] [--report F.html] [--shard K/N --part F | --join F...]\n"
    "       crankloop map FILE --rpm FROM:TO:N --fuel-mg FROM:TO:N [--throttle R] [...]",
    "crankloop map four_2000.ini --rpm 1000:6000:6 --throttle 0:1:6 --csv map.csv --report map.html",
    1,
    kMapOptions,
    run_map_command};

}  // namespace crankloop::program
