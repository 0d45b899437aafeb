// `crankloop live FILE`: the engine against the machine's clock, its crank free, a controller in the loop.
#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../command_line/gas_options.hpp"
#include "../../command_line/operating_point.hpp"
#include "../../command_line/results.hpp"
#include "../../command_line/with_real.hpp"
#include "../../engine_file/plausibility.hpp"
#include "../../files/error.hpp"
#include "../../files/files_in_use.hpp"
#include "../../files/number.hpp"
#include "../../files/output_file.hpp"
#include "../../files/units.hpp"
#include "../../loops/fault_option.hpp"
#include "../../loops/input_option.hpp"
#include "../../loops/run_gas.hpp"
#include "../../signals/signal_dump.hpp"
#include "live_loop.hpp"
#include "live_summary.hpp"

namespace crankloop::program {
namespace {

LiveRequest request_of(const Arguments& arguments, const EngineFile& file) {
  for (const char* option : {"--lead-ticks", "--ring-edges", "--silent-ms"}) arguments.require_with(option, "--shared");
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
  request.lead_ticks = arguments.whole_number("--lead-ticks");
  const GasOrder gas = gas_order(arguments, file, 0);
  request.at_start.load_ratio = arguments.number("--load-ratio");
  request.at_start.throttle_ratio = gas.throttle_ratio;
  request.at_start.fuel_kg = gas.fuel_kg;
  request.at_start.excess_air_ratio = gas.excess_air_ratio;
  request.at_start.burn_start_deg = gas.burn_start_deg;
  request.burn_duration_deg = gas.burn_duration_deg;
  request.at_start.external_torque_Nm = arguments.number("--external-torque-Nm");
  request.at_start.starter = arguments.has("--starter") ? 1 : 0;
  request.wheel_faults = fault_bits(arguments, file.definition());
  request.real_time.priority = arguments.whole_number("--priority");
  if (arguments.has("--cpu")) request.real_time.cpu = arguments.whole_number("--cpu");

  const EngineDefinition& definition = file.definition();
  require_heat_to_scale(arguments, file);
  if (arguments.has("--starter") && definition.starter.stall_Nm == 0) {
    throw InputError(file.path() + ": there is no [starter], so --starter has nothing to engage");
  }
  return request;
}

/// As asked for, or enough for a second at full speed.
std::uint32_t ring_edges_of(const Arguments& arguments, const EngineFile& file, const LiveRequest& request) {
  const double lead_s = static_cast<double>(request.lead_ticks) * request.tick_s;
  const std::uint32_t usual = usual_ring_edges(file.definition(), file.triggers().size(), request.tick_s, lead_s);
  if (!arguments.has("--ring-edges")) return usual;
  const auto asked = static_cast<std::uint32_t>(arguments.whole_number("--ring-edges"));
  if ((asked & (asked - 1)) != 0) throw UsageError("--ring-edges: " + std::to_string(asked) + " is no power of two");
  return usual == 0 ? 0 : asked;
}

/// Nobody brakes or fires the engine but its file and options: warns where it cannot run so.
void warn_of_running_alone(const Arguments& arguments, const EngineFile& file, const LiveRequest& request) {
  if (arguments.has("--shared") || arguments.has("--inputs") || request.at_start.external_torque_Nm != 0) return;
  tell_warnings(arguments, warnings_about_running_free(file, file.definition()));
}

/// Takes every step, whatever becomes of the others; then throws the first failure.
void take_all(std::initializer_list<std::function<void()>> steps) {
  std::exception_ptr failure;
  for (const std::function<void()>& step : steps) {
    try {
      step();
    } catch (...) {
      if (!failure) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

int run_live_command(const Arguments& arguments) {
  EngineFile file = read_engine_for_scenes(arguments, {"engine", "crank", "masses"});
  file.set_misfires(arguments.words("--misfire"));
  const LiveRequest request = request_of(arguments, file);
  const std::string& real = arguments.text("--real");
  const bool shares = arguments.has("--shared");
  warn_of_running_alone(arguments, file, request);
  tell_warnings(arguments, warnings_about_gas(file, 0, request.tick_s));
  std::optional<InputSchedule> schedule = read_inputs(arguments, file, live_inputs(file));
  if (schedule) tell_warnings(arguments, warnings_about_inputs(*schedule, request.at_start.excess_air_ratio));
  std::optional<Output> histogram, trace_file;
  if (arguments.has("--histogram")) histogram.emplace(arguments.text("--histogram"));
  if (arguments.has("--trace")) trace_file.emplace(arguments.text("--trace"));

  const auto figures = std::make_unique<LiveFigures>();
  std::optional<LiveTrace> trace;
  try {
    std::optional<port::SharedBlock> shared;
    if (shares) {
      claim_output(arguments.text("--shared"));
      shared.emplace(port::SharedBlock::create(
          arguments.text("--shared"), live_contents(file, request.tick_s, ring_edges_of(arguments, file, request))));
    }
    if (trace_file) trace.emplace(*trace_file, file.name(), names_of_triggers(file));
    const LiveEnds ends{shares ? &*shared : nullptr, schedule ? &*schedule : nullptr, trace ? &*trace : nullptr};
    with_real(real, [&](auto zero) { run_live<decltype(zero)>(file, request, ends, *figures); });
  } catch (const port::SharedBlockSystemError& failed) {
    throw OutputError(failed.what());
  } catch (const port::SharedBlockError& refused) {
    throw InputError(refused.what());
  }

  const auto finish_trace = [&] {
    if (!trace) return;
    trace->finish();
    trace_file->finish();
  };
  const auto finish_histogram = [&] {
    if (!histogram) return;
    write_live_histogram(*histogram, *figures);
    histogram->finish();
  };
  const bool output_taken = (trace_file && trace_file->is_standard()) || (histogram && histogram->is_standard());
  const auto tell = [&] {
    print_summary(live_summary(file, request, real,
                               {shares, trace ? &*trace : nullptr, schedule ? &*schedule : nullptr}, *figures),
                  output_taken);
  };
  take_all({finish_trace, finish_histogram, tell});
  if (!figures->lost_block) return kSuccess;
  throw std::runtime_error(arguments.text("--shared") + ": was truncated or overwritten after " +
                           std::to_string(figures->tally.ticks) + " ticks");
}

constexpr Option kLiveOptions[] = {
    number("--tick-us", "T", from(1).up_to(2000),
           "length of a tick in us; longer than in other commands: most systems meet it", "1000"),
    number("--seconds", "S", above(0).up_to(1000000), "duration; Ctrl-C stops the run early and prints its summary",
           "10"),
    text("--shared", "PATH", "block of memory shared with a controller, such as /dev/shm/engine: docs/live.md"),
    whole_number("--lead-ticks", "N", from(0).up_to(1000),
                 "edges of trigger wheels in the block are due so many ticks after their time in the tick", "1"),
    whole_number("--ring-edges", "N", from(16).up_to(port::kMaxRingEdges),
                 "room for edges in the block, a power of two; default a second and the lead of all wheels at max_rpm"),
    kInputs,
    number("--silent-ms", "N", above(0).up_to(100000),
           "timeout of the controller: after N ms without a write, fuel, load and starter are off", "100"),
    number("--load-ratio", "Q", from(0).up_to(2),
           "0 = motored, 1 = the pressure diagram as it is; until a controller sets it", "0"),
    number(kThrottle.name, kThrottle.value, kThrottle.range, kThrottle.meaning, "0"),
    kFuel,
    kLambda,
    kBurnStart,
    number("--external-torque-Nm", "L", from(-1e8).up_to(1e8),
           "load on the crankshaft in Nm; until a controller sets it", "0"),
    flag("--starter", "starter engaged; until a controller sets it"),
    number("--from-rpm", "N", from(-100000).up_to(100000), "speed at the start in rpm", "0"),
    kMisfire,
    kFaultBits,
    choice("--real", "float|double", "arithmetic of the tick", "float"),
    whole_number("--cpu", "N", from(0).up_to(1023), "processor to run on, counted from 0; default any"),
    whole_number("--priority", "P", from(0).up_to(99),
                 "SCHED_FIFO priority, where allowed; 0 leaves the scheduler as it is", "80"),
    text("--trace", "F.vcd", "file of the trigger wheels' signals, speed and torque, written while it runs"),
    text("--histogram", "F", "CSV file for the histograms of wake-up latency and of times"),
};

}  // namespace

const Command kLive{
    "live",
    "the engine against the clock, with a controller in the loop: signals, trigger edges, latencies",
    "FILE [--tick-us T] [--seconds S] [--shared PATH] [--inputs IN.csv] [--from-rpm N] [--load-ratio Q] "
    "[--throttle R] [--external-torque-Nm L] [--starter] [...]",
    "crankloop live diesel_495.ini --from-rpm 800 --load-ratio 0.2 --tick-us 100 --seconds 5",
    1,
    kLiveOptions,
    run_live_command};

}  // namespace crankloop::program
