// `crankloop run FILE`: the fixed-step loop over some cycles, its files, its report, another engine beside it.
//
// What belongs here: options, and the loop with its files. What does not: printed figures (run_summary.hpp), rows of
// the CSV (run_csv.hpp), a crank that forces turn (free_request.hpp).
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <crankloop/tabulate/summary.hpp>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../command_line/gas_options.hpp"
#include "../../command_line/operating_point.hpp"
#include "../../command_line/progress.hpp"
#include "../../command_line/results.hpp"
#include "../../command_line/with_real.hpp"
#include "../../engine_file/following_springs.hpp"
#include "../../engine_file/plausibility.hpp"
#include "../../engine_report/engine_report.hpp"
#include "../../files/words.hpp"
#include "../../loops/fault_option.hpp"
#include "../../loops/input_option.hpp"
#include "../../loops/run_accuracy.hpp"
#include "../../loops/run_hash.hpp"
#include "../../loops/run_trace.hpp"
#include "../../loops/run_valves.hpp"
#include "../../loops/valve_accuracy.hpp"
#include "../../loops/valve_tick_limit.hpp"
#include "against.hpp"
#include "free_request.hpp"
#include "run_csv.hpp"
#include "run_signals.hpp"
#include "run_summary.hpp"

namespace crankloop::program {
namespace {

std::string command_line(const Arguments& arguments, const HeldRequest& request, bool breathes) {
  return "crankloop run " + shell_word(arguments.file()) + " --rpm " + shortest(request.operation.speed_rpm) +
         " --tick-us " + shortest(arguments.number("--tick-us")) + " --cycles " + std::to_string(request.cycles) +
         " --real " + request.real + " " +
         (breathes ? options_of(request.operation.gas) : "--load-ratio " + shortest(request.operation.load_ratio));
}

template <class Real, class S>
void run(const HeldEngine& engine, const HeldRequest& request, const Arguments& arguments) {
  const EngineDefinition& definition = engine.exact.definition();
  const Operation& operation = request.operation;
  Progress progress("running", (request.cycles + cycles_to_settle(definition)) * 720 /
                                   (operation.speed_rad_s() * kDegPerRad * operation.tick_s));
  FixedStepLoop<Real, S> loop(definition, operation, 0, [&progress] { progress.step(); });

  Results results(arguments, {"--csv", "--report", "--vcd"});
  if (Output* vcd = results["--vcd"]) write_signals(engine.file, operation, request.cycles, *vcd);
  std::optional<CsvWriter> csv;
  const CamColumns cams(engine.file);
  if (Output* file = results["--csv"]) csv.emplace(*file, csv_header(definition, names_of_trains(engine.file), cams));

  Trace trace;
  if (results["--report"] != nullptr) trace = record_trace<Real, S>(definition, operation);
  CycleSummary summary{};
  if (!engine.breathes()) {
    summary = summarise(engine.exact, operation.speed_rad_s(), operation.load_ratio);
  } else if (results["--report"] != nullptr) {
    summary = summarise(definition, operation.speed_rad_s(), trace);
  }
  const CloseUpWindow window = close_up_window(summary.largest_torque_deg, loop.deg_per_tick());
  std::vector<CloseUpTick> close_up;
  const bool is_hashed = arguments.has("--hash");
  BitHash hash;
  const detail::EngineShape shape = detail::shape_of<Real, S>(*loop.engine().tables());
  const OnTick<Real, S> on_tick = [&](std::uint64_t tick, double crank_deg, const WholeOutput<Real, S>& out) {
    if (csv) write_row<Real, S>(*csv, definition, operation, tick, crank_deg, out, cams);
    if (is_hashed) add_tick<S>(hash, loop.engine(), shape);
    if (static_cast<double>(tick) <= loop.ticks_per_cycle() && window.contains(crank_deg)) {
      close_up.push_back({crank_deg, static_cast<double>(out.torque_Nm), static_cast<double>(out.mean_torque_Nm)});
    }
    progress.step();
  };
  const RunFigures figures = run_cycles<Real, S>(loop, definition, operation, request.cycles, on_tick);
  const double wall_time_per_tick_ns = loop.wall_time_per_tick_ns();

  if (Output* page = results["--report"]) {
    const Accuracy accuracy = engine.breathes() ? Accuracy{} : measure_accuracy<Real>(engine.exact, operation);
    const ReportInput input{engine.file,
                            engine.exact,
                            summary,
                            operation,
                            figures,
                            trace,
                            accuracy,
                            close_up,
                            request.real,
                            command_line(arguments, request, engine.breathes()),
                            wall_time_per_tick_ns,
                            request.warnings};
    page->write(report::to_html(engine_report(input)));
  }
  Summary printed = summary_of(engine, request, figures, summary);
  if (is_hashed) printed.line("hash", hash.text(), "", "of every bit that the recorded ticks show");
  add_wall_time(printed, wall_time_per_tick_ns);
  results.finish(printed.text());
}

std::vector<std::string> needed_sections() { return {"engine", "crank", "masses"}; }

/// Throttle, fuel and spark; refuses what no run can do.
GasOrder gas_for(const Arguments& arguments, const EngineFile& file) {
  require_heat_to_scale(arguments, file);
  const GasOrder gas = gas_order(arguments, file, 1);
  require_manifolds(file, millionths(arguments.number("--tick-us")));
  return gas;
}

Operation operation_of(const Arguments& arguments, const EngineFile& file, const GasOrder& gas) {
  return {speed_rpm(arguments, file), millionths(arguments.number("--tick-us")), arguments.number("--load-ratio"), gas};
}

ExactEngine exact_of(const EngineFile& file) {
  ExactEngine exact;
  if (const Status refused = exact.init(file.definition()); !refused.ok()) throw file.explain(refused);
  return exact;
}

/// Calls `work` with a zero of the arithmetic and the scene.
template <class Work>
auto with_scene(const HeldEngine& engine, const std::string& real, const Work& work) {
  return with_real(real, [&](auto zero) {
    return engine.breathes() ? work(zero, scenes::Breathing{}) : work(zero, scenes::Whole{});
  });
}

/// Of a run at constant speed, without the time that this machine takes.
Summary figures_of_run(const Arguments& arguments, const EngineFile& file) {
  file.require(needed_sections());
  const Operation operation = operation_of(arguments, file, gas_for(arguments, file));
  require_trains(file, operation.tick_s);
  const HeldRequest request{operation, arguments.whole_number("--cycles"), arguments.text("--real"), {}};
  const ExactEngine exact = exact_of(file);
  const HeldEngine engine{file, exact};
  const CycleSummary cycle =
      engine.breathes() ? CycleSummary{} : summarise(exact, operation.speed_rad_s(), operation.load_ratio);
  return with_scene(engine, request.real, [&](auto zero, auto scene) {
    using Real = decltype(zero);
    using S = decltype(scene);
    FixedStepLoop<Real, S> loop(file.definition(), operation);
    return summary_of(engine, request, run_cycles<Real, S>(loop, file.definition(), operation, request.cycles), cycle);
  });
}

Trace trace_of(const Arguments& arguments, const EngineFile& file) {
  const Operation operation = operation_of(arguments, file, gas_for(arguments, file));
  return with_real(arguments.text("--real"), [&](auto zero) {
    using Real = decltype(zero);
    return breathes(file.definition()) ? record_trace<Real, scenes::Breathing>(file.definition(), operation)
                                       : record_trace<Real, scenes::Whole>(file.definition(), operation);
  });
}

/// Tells where the operation is beyond the promised accuracy; throws InputError for a tick too long for a train.
std::vector<std::string> tell_accuracy(const Arguments& arguments, const EngineFile& file, const Operation& operation) {
  std::vector<std::string> told =
      tell_warnings(arguments, warnings_about_gas(file, operation.speed_rpm, operation.tick_s));
  require_trains(file, operation.tick_s);
  for (std::string& line : tell_warnings(arguments, warnings_about_valves(file, operation.speed_rpm, operation.tick_s)))
    told.push_back(std::move(line));
  return told;
}

/// Of one of two: a refusal says of which.
Side side_of(const Arguments& arguments, const EngineFile& file) {
  try {
    return {file, figures_of_run(arguments, file)};
  } catch (const UsageError& error) {
    throw UsageError(file.path() + ": " + error.what());
  }
}

/// Both engines with the same options; each at its own rated speed without --rpm.
int run_against(const Arguments& arguments, const EngineFile& first) {
  for (const char* option : {"--free", "--csv", "--vcd", "--hash"}) {
    if (arguments.has(option)) throw UsageError(std::string(option) + " is of one engine; --against compares two");
  }
  const std::string& path = arguments.text("--against");
  const EngineFile second = read_engine_file(path, needed_sections());
  (void)tell_warnings(arguments, warnings_about(second));
  (void)tell_warnings(arguments, warnings_about_springs_that_follow(second));
  for (const EngineFile* file : {&first, &second})
    (void)tell_accuracy(arguments, *file, operation_of(arguments, *file, gas_for(arguments, *file)));
  Results results(arguments, {"--report"});
  Side sides[] = {side_of(arguments, first), side_of(arguments, second)};
  if (Output* page = results["--report"]) {
    for (Side& side : sides) side.trace = trace_of(arguments, side.file);
    page->write(report::to_html(against_page(
        sides[0], sides[1],
        "crankloop run " + shell_word(first.path()) + " --against " + shell_word(path) +
            (arguments.has("--rpm") ? " --rpm " + shortest(arguments.number("--rpm")) : "") + " --tick-us " +
            shortest(arguments.number("--tick-us")) + " --real " + arguments.text("--real"))));
  }
  results.finish(side_by_side(sides[0], sides[1]).text());
  return kSuccess;
}

int run_run(const Arguments& arguments) {
  require_options_that_fit(arguments);
  std::vector<std::string> warnings;
  EngineFile file = read_engine_for_scenes(arguments, needed_sections(), &warnings);
  if (!arguments.has("--free")) {
    for (std::string& line : tell_warnings(arguments, warnings_about_misfires_left_out(file)))
      warnings.push_back(std::move(line));
  }
  if (arguments.has("--against")) return run_against(arguments, file);
  const GasOrder gas = gas_for(arguments, file);
  if (arguments.has("--free")) file.set_misfires(arguments.words("--misfire"));
  if (arguments.has("--free")) return run_free_by(arguments, file, gas, std::move(warnings));
  const Operation operation = operation_of(arguments, file, gas);
  for (std::string& line : tell_accuracy(arguments, file, operation)) warnings.push_back(std::move(line));
  const HeldRequest request{operation, arguments.whole_number("--cycles"), arguments.text("--real"),
                            std::move(warnings)};
  const ExactEngine exact = exact_of(file);
  const HeldEngine engine{file, exact};
  with_scene(engine, request.real,
             [&](auto zero, auto scene) { run<decltype(zero), decltype(scene)>(engine, request, arguments); });
  return kSuccess;
}

constexpr Option kRunOptions[] = {
    number("--rpm", "N", above(0).up_to(100000), "engine speed in rpm; default the file's rated_rpm"),
    kTick,
    whole_number("--cycles", "N", from(1).up_to(1000000),
                 "cycles of 720 deg to record, after one to settle (more with gas exchange)", "2"),
    choice("--real", "float|double", "arithmetic of the tick, and digits of the CSV", "float"),
    kLoadRatio,
    kThrottle,
    kFuel,
    kLambda,
    kBurnStart,
    text("--csv", "F", "file for a row per tick; - is standard output, the summary then goes to stderr"),
    flag("--hash", "prints a hash of every bit that the ticks show: equal on every machine, and in a page"),
    text("--report", "F.html", "HTML file with the report; opens in any browser"),
    text("--against", "B.ini", "another engine file: figures of both, and with --report their curves in one drawing"),
    text("--vcd", "F", "file for the trigger wheels' signals, a value change dump as GTKWave and PulseView open it"),
    flag("--free", "free-running: gas, friction and load set the speed; needed by the options below"),
    number("--from-rpm", "N", from(-100000).up_to(100000), "initial speed, backwards if negative", "0"),
    number("--seconds", "S", above(0).up_to(1e6), "duration", "2"),
    number("--machine-Nm", "L", from(0).up_to(1e7),
           "a brake of constant torque instead of that of the file's [machine], whose inertia stays"),
    flag("--starter", "the file's [starter] turns the crank too; it free-wheels where the engine is faster"),
    text("--cut", "K,..", "cylinders that do not fire, like 1,3"),
    kMisfire,
    kFaultBits,
    text("--analogue", "F.csv", "with --free and a [reluctor]: its voltage, 16 samples a tick, and its comparator"),
    text("--cranking", "F.svg",
         "with --free and a [reluctor]: a drawing of the run's first second: speed, voltage, threshold, edges"),
    kInputs,
};

}  // namespace

const Command kRun{
    "run",
    "the fixed-step loop: torque, power, peak forces, time per tick; or a free-running engine; CSV and report",
    "FILE [--rpm N] [--cycles N] [--tick-us T] [--real R] [--load-ratio Q] [--csv F] [--report F.html] [--vcd F]\n"
    "       [--throttle R] [--lambda L | --fuel-mg M] [--burn-start-deg A] [--against B.ini]\n"
    "       crankloop run FILE --free [--from-rpm N] [--seconds S] [--machine-Nm L] [--starter] [--cut K,..]\n"
    "       [--misfire RULE ...] [--fault-bits B,..] [--inputs IN.csv] [...]",
    "crankloop run diesel_495.ini --rpm 2000 --csv run.csv --report report.html",
    1,
    kRunOptions,
    run_run,
    false,
    figures_of_run};

}  // namespace crankloop::program
