// `crankloop live FILE`: the engine against the machine's clock, its crank free, a controller in the loop.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../command_line/gas_options.hpp"
#include "../../command_line/operating_point.hpp"
#include "../../command_line/with_real.hpp"
#include "../../engine_file/plausibility.hpp"
#include "../../files/error.hpp"
#include "../../files/files_in_use.hpp"
#include "../../files/number.hpp"
#include "../../files/output_file.hpp"
#include "../../files/units.hpp"
#include "live_loop.hpp"
#include "live_summary.hpp"

namespace crankloop::program {
namespace {

std::uint32_t cylinders_of(const EngineFile& file) {
  return static_cast<std::uint32_t>(file.definition().layout.cylinders);
}

LiveRequest request_of(const Arguments& arguments, const EngineFile& file) {
  const double tick_us = arguments.number("--tick-us");
  LiveRequest request;
  request.tick_ns = std::llround(tick_us * 1e3);
  request.tick_s = millionths(tick_us);
  if (std::abs(tick_us * 1e3 - static_cast<double>(request.tick_ns)) > 1e-6) {
    throw UsageError("--tick-us " + shortest(tick_us) + " is not a whole number of nanoseconds, the unit of the clock");
  }
  request.ticks = static_cast<std::uint64_t>(std::max(1.0, std::round(arguments.number("--seconds") / request.tick_s)));
  request.start_rad_s = arguments.number("--from-rpm") * kRad_sPerRpm;
  request.patience_ns = std::llround(arguments.number("--silent-ms") * 1e6);
  const GasOrder gas = gas_order(arguments, file, 0);
  request.at_start.load_ratio = arguments.number("--load-ratio");
  request.at_start.throttle_ratio = gas.throttle_ratio;
  request.at_start.fuel_kg = gas.fuel_kg;
  request.at_start.excess_air_ratio = gas.excess_air_ratio;
  request.at_start.burn_start_deg = gas.burn_start_deg;
  request.burn_duration_deg = gas.burn_duration_deg;
  request.at_start.external_torque_Nm = arguments.number("--external-torque-Nm");
  request.at_start.starter = arguments.has("--starter") ? 1 : 0;
  request.real_time.priority = arguments.whole_number("--priority");
  if (arguments.has("--cpu")) request.real_time.cpu = arguments.whole_number("--cpu");

  const EngineDefinition& definition = file.definition();
  require_heat_to_scale(arguments, file);
  if (arguments.has("--starter") && definition.starter.stall_Nm == 0) {
    throw InputError(file.path() + ": there is no [starter], so --starter has nothing to engage");
  }
  return request;
}

int run_live_command(const Arguments& arguments) {
  EngineFile file = read_engine_for_scenes(arguments, {"engine", "crank", "masses"});
  file.set_misfires(arguments.words("--misfire"));
  const LiveRequest request = request_of(arguments, file);
  const std::string& real = arguments.text("--real");
  const bool shares = arguments.has("--shared");
  if (!shares && request.at_start.external_torque_Nm == 0)
    tell_warnings(arguments, warnings_about_running_free(file, file.definition()));
  std::optional<Output> histogram;
  if (arguments.has("--histogram")) histogram.emplace(arguments.text("--histogram"));

  const auto figures = std::make_unique<LiveFigures>();
  try {
    std::optional<port::SharedBlock> shared;
    if (shares) {
      claim_output(arguments.text("--shared"));
      shared.emplace(port::SharedBlock::create(arguments.text("--shared"), request.tick_s, cylinders_of(file),
                                               breathes(file.definition())));
    }
    with_real(real, [&](auto zero) { run_live<decltype(zero)>(file, request, shares ? &*shared : nullptr, *figures); });
  } catch (const port::SharedBlockError& refused) {
    throw InputError(refused.what());
  }

  if (histogram) {
    write_live_histogram(*histogram, *figures);
    histogram->finish();
  }
  print(live_summary(file, request, real, shares, *figures));
  if (!figures->lost_block) return kSuccess;
  throw std::runtime_error(arguments.text("--shared") + ": was truncated or overwritten after " +
                           std::to_string(figures->tally.ticks) + " ticks");
}

constexpr Option kOptions[] = {
    number("--tick-us", "T", from(1).up_to(2000),
           "length of a tick in us; longer than in other commands: most systems meet it", "1000"),
    number("--seconds", "S", above(0).up_to(1000000), "duration; Ctrl-C stops the run early and prints its summary",
           "10"),
    text("--shared", "PATH", "block of memory shared with a controller, such as /dev/shm/engine: docs/live.md"),
    number("--silent-ms", "N", above(0).up_to(100000),
           "timeout of the controller: after N ms without a write, fuel, load and starter are off", "100"),
    number("--load-ratio", "Q", from(0).up_to(2),
           "0 = motored, 1 = the pressure diagram as it is; until a controller sets it", "0"),
    kThrottle,
    kFuel,
    kLambda,
    kBurnStart,
    number("--external-torque-Nm", "L", from(-1e8).up_to(1e8),
           "load on the crankshaft in Nm; until a controller sets it", "0"),
    flag("--starter", "starter engaged; until a controller sets it"),
    number("--from-rpm", "N", from(-100000).up_to(100000), "speed at the start in rpm", "0"),
    kMisfire,
    choice("--real", "float|double", "arithmetic of the tick", "float"),
    whole_number("--cpu", "N", from(0).up_to(1023), "processor to run on, counted from 0; default any"),
    whole_number("--priority", "P", from(0).up_to(99),
                 "SCHED_FIFO priority, where allowed; 0 leaves the scheduler as it is", "80"),
    text("--histogram", "F", "CSV file for the histograms of wake-up latency and of times"),
};

}  // namespace

const Command kLive{"live",
                    "the engine against the clock, with a controller in the loop: latencies, missed deadlines",
                    "FILE [--tick-us T] [--seconds S] [--shared PATH] [--from-rpm N] [--load-ratio Q] [--throttle R] "
                    "[--external-torque-Nm L] [--starter] [...]",
                    "crankloop live diesel_495.ini --from-rpm 800 --load-ratio 0.2 --tick-us 100 --seconds 5",
                    1,
                    kOptions,
                    run_live_command};

}  // namespace crankloop::program
