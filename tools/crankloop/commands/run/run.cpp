// `crankloop run FILE`: the fixed-step loop over some cycles, its figures, its ticks as CSV, its report. With --free:
// free_request.cpp.
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tabulate/summary.hpp>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../command_line/gas_options.hpp"
#include "../../command_line/operating_point.hpp"
#include "../../command_line/progress.hpp"
#include "../../command_line/results.hpp"
#include "../../command_line/summary.hpp"
#include "../../command_line/with_real.hpp"
#include "../../engine_file/following_springs.hpp"
#include "../../engine_file/plausibility.hpp"
#include "../../engine_file/pressure_words.hpp"
#include "../../engine_report/engine_report.hpp"
#include "../../files/csv.hpp"
#include "../../files/words.hpp"
#include "../../loops/fault_option.hpp"
#include "../../loops/input_option.hpp"
#include "../../loops/run_accuracy.hpp"
#include "../../loops/run_hash.hpp"
#include "../../loops/run_loop.hpp"
#include "../../loops/run_trace.hpp"
#include "../../loops/run_valves.hpp"
#include "../../loops/valve_accuracy.hpp"
#include "../../loops/valve_tick_limit.hpp"
#include "against.hpp"
#include "free_request.hpp"
#include "run_cams.hpp"
#include "run_signals.hpp"

namespace crankloop::program {
namespace {

std::vector<std::string> csv_header(const EngineDefinition& engine, const std::vector<std::string>& trains,
                                    const CamColumns& cams) {
  const int cylinders = engine.layout.cylinders;
  std::vector<std::string> header{"time_s", "crank_deg", "speed_rpm", "torque_Nm", "mean_torque_Nm"};
  for (int k = 1; k <= cylinders; ++k) {
    for (std::size_t i = 0; i < kCsvQuantities; ++i) {
      header.push_back("c" + std::to_string(k) + "_" + kQuantityKinds[i].name + "_" + kQuantityKinds[i].suffix);
    }
  }
  for (int k = 1; k <= cylinders; ++k) {
    for (const std::string& train : trains) {
      const std::string valve = "c" + std::to_string(k) + "_" + train + "_";
      for (const ValveQuantityKind& kind : kValveQuantityKinds) header.push_back(valve + kind.name + "_" + kind.suffix);
      header.push_back(valve + "regime");
    }
  }
  if (breathes(engine)) add_gas_columns(header, engine);
  if (cams.any()) cams.add_names(header);
  return header;
}

template <class Real, class S>
void write_row(CsvWriter& csv, const EngineDefinition& definition, const Operation& operation, std::uint64_t tick,
               double crank_deg, const WholeOutput<Real, S>& out, const CamColumns& cams) {
  const Layout& layout = definition.layout;
  csv.cell(static_cast<double>(tick) * operation.tick_s);
  csv.cell(crank_deg);
  csv.cell(operation.speed_rpm);
  csv.cell(out.torque_Nm);
  csv.cell(out.mean_torque_Nm);
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    const QuantityValues<Real> values = values_of(out, layout, k);
    for (std::size_t i = 0; i < kCsvQuantities; ++i) csv.cell(values[i] * static_cast<Real>(kQuantityKinds[i].per_si));
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    for (std::size_t t = 0; t < static_cast<std::size_t>(definition.train_count); ++t) {
      const auto values = values_of(out, t, k);
      for (std::size_t i = 0; i < kValveQuantities; ++i)
        csv.cell(values[i] * static_cast<Real>(kValveQuantityKinds[i].per_si));
      csv.cell(static_cast<int>(out.valve_forces[t][k].regime));
    }
  }
  if constexpr (detail::Needs<S>::gas) write_gas(csv, out, definition);
  if (cams.any()) cams.write<Real, S>(csv, crank_deg, operation.speed_rad_s() / 2, out);
  csv.end_row();
}

/// What the user asked for, but for the files.
struct Request {
  Operation operation;
  int cycles;
  std::string real;
  std::vector<std::string> warnings;  ///< told, for the report
};

struct Engines {
  const EngineFile& file;
  const ExactEngine& exact;

  [[nodiscard]] bool has_gas() const noexcept { return exact.definition().pressure.source != PressureSource::none; }
  [[nodiscard]] bool breathes() const noexcept { return program::breathes(exact.definition()); }
};

void add_peak(Summary& s, const std::string& name, Peak peak, double per_si, const std::string& unit) {
  s.line(name, peak.value * per_si, unit);
  s.line(name + "_at", std::round(peak.at_deg * 1e3) / 1e3, "deg");
}

void add_peaks(Summary& s, const std::string& name, const Peaks& peaks, double per_si, const std::string& unit) {
  add_peak(s, "max_" + name, peaks.largest, per_si, unit);
  add_peak(s, "min_" + name, peaks.smallest, per_si, unit);
}

/// The worst of a train's valves in their last whole cycle, and peaks over the ticks.
void add_valves(Summary& s, const std::string& train, const ValveFigures& f) {
  const ValveCycle<double>& cycle = f.last_cycle;
  const auto peak = [&](ValveQuantity quantity) {
    const ValveQuantityKind& kind = kValveQuantityKinds[index_of(quantity)];
    add_peak(s, "max_" + train + "_" + kind.name, f.of[index_of(quantity)].largest, kind.per_si, kind.unit);
  };
  s.line(train + "_max_lift", cycle.largest_lift_m * 1e3, "mm");
  add_opening_delay(s, train + "_opening_delay", cycle);
  s.line(train + "_separations", cycle.separations);
  s.line(train + "_separation_max_gap", cycle.separation_clearance_m * 1e3, "mm");
  s.line(train + "_seating_speed", cycle.seating_speed_m_s, "m/s");
  s.line(train + "_bounces", cycle.bounces);
  s.line(train + "_bounce_height", cycle.bounce_height_m * 1e3, "mm");
  peak(ValveQuantity::train_force);
  peak(ValveQuantity::seat_force);
  peak(ValveQuantity::cam_force);
}

void add_brake(Summary& s, const EngineDefinition& definition, const RunFigures& f, double speed_rad_s) {
  const BrakeFigures brake = brake_figures(definition, f.mean_torque_Nm, speed_rad_s);
  s.line("friction_mep", brake.friction_mep_Pa / 1e3, "kPa", "of [friction] at this speed");
  s.line("brake_torque", brake.torque_Nm, "Nm");
  s.line("brake_power", brake.power_W / 1e3, "kW",
         brief(brake.power_W / 1e3 / definition.layout.cylinders) + " kW a cylinder");
  if (brake.efficiency_ratio > 0) s.line("mechanical_efficiency", brake.efficiency_ratio);
  if (const double fuel = fuel_kg_s(definition, f.gas, speed_rad_s); fuel > 0 && brake.power_W > 0)
    s.line("brake_specific_consumption", fuel / brake.power_W * 3.6e9, "g/kWh");
}

Summary summary_of(const Engines& engine, const Request& request, const RunFigures& f, const CycleSummary& summary) {
  const EngineDefinition& definition = engine.exact.definition();
  const double speed = request.operation.speed_rad_s();
  Summary s;
  s.remark(engine.file.name() + ", fixed-step loop in " + request.real +
           (engine.has_gas() ? "" : ", no pressure source: inertia only"));
  s.remark(pressure_in_short(engine.file));
  s.remark("angles: torque and journals from cylinder 1's firing TDC, all else from that of the cylinder itself");
  s.remark("max_ and min_ are over the ticks, every " + brief(f.deg_per_tick) + " deg");
  s.line("speed", request.operation.speed_rpm, "rpm");
  if (engine.breathes()) {
    add_order(s, request.operation.gas);
  } else if (engine.has_gas()) {
    s.line("load_ratio", request.operation.load_ratio);
  }
  s.line("tick", request.operation.tick_s * 1e6, "us");
  s.line("deg_per_tick", f.deg_per_tick, "deg");
  s.line("cycles", static_cast<double>(f.cycles));
  // Not settled: a thousandth of 500 kPa a cycle.
  s.line("ticks", f.ticks, "",
         "after " + std::to_string(f.settling_ticks) + " to settle" +
             (f.unsettled_Pa > 500
                  ? ", not settled: net mep moved by " + brief(f.unsettled_Pa / 1e3) + " kPa in the last cycle of those"
                  : ""));
  s.line("mean_torque", f.mean_torque_Nm, "Nm");
  if (engine.has_gas()) {
    s.line("power", f.power_W / 1e3, "kW", "indicated: friction is not subtracted");
    if (definition.friction.any()) add_brake(s, definition, f, speed);
    s.line("net_mep", f.net_mep_Pa / 1e3, "kPa");
    if (engine.breathes()) {
      add_gas(s, definition, f.gas);
      s.line("energy_defect", f.gas.cycle.energy_defect_J, "J", "of a cylinder's cycle, the largest: rounding");
      s.line("intake_pressure", f.gas.intake_Pa / 1e3, "kPa", "in the manifold, mean");
      s.line("exhaust_pressure", f.gas.exhaust_Pa / 1e3, "kPa", "in the manifold, mean");
      const std::string left_out = exhaust_heat_left_out(definition);
      s.line("exhaust_manifold_temperature", f.gas.exhaust_manifold_K, "K",
             "mean" + (left_out.empty() ? ", as a probe reads it" : "; " + left_out));
    } else {
      s.line("net_mep_exact", summary.net_mep_Pa / 1e3, "kPa", "loop integral of p dV");
      s.line("gross_mep_exact", summary.gross_mep_Pa / 1e3, "kPa", "over the closed 360 deg");
    }
  }
  add_peaks(s, "torque", f.torque, 1, "Nm");
  for (const Quantity quantity : {Quantity::pressure, Quantity::gas_force}) {
    const QuantityKind& kind = kQuantityKinds[index_of(quantity)];
    if (engine.has_gas())
      add_peak(s, std::string("max_") + kind.name, f.of[index_of(quantity)].largest, kind.per_si, kind.unit);
  }
  for (const Quantity quantity : {Quantity::inertia_force, Quantity::total_force, Quantity::side_force,
                                  Quantity::rod_force, Quantity::tangential_force, Quantity::radial_force}) {
    const QuantityKind& kind = kQuantityKinds[index_of(quantity)];
    add_peaks(s, kind.name, f.of[index_of(quantity)], kind.per_si, kind.unit);
  }
  add_peak(s, "max_crank_pin_load", f.of[index_of(Quantity::crank_pin_load)].largest, 1, "N");
  add_peak(s, "max_main_journal_load", f.journal_load.largest, 1, "N");
  add_peaks(s, "velocity", f.of[index_of(Quantity::velocity)], 1, "m/s");
  add_peaks(s, "acceleration", f.of[index_of(Quantity::acceleration)], 1, "m/s^2");
  s.line("mean_piston_speed", mean_piston_speed_m_s(definition.crank, speed), "m/s");
  s.line("stroke", dead_centres(definition.crank).stroke_m * 1e3, "mm", "true one, with the pin offset");
  s.line("swept_volume", swept_volume_m3(definition.crank) * 1e6, "cm^3", "one cylinder");
  const std::vector<std::string> trains = names_of_trains(engine.file);
  for (std::size_t t = 0; t < f.valves.size(); ++t) add_valves(s, trains[t], f.valves[t]);
  if (!engine.breathes()) {
    s.line("table_gas_segments", f.tables.gas_segments);
    s.line("table_pressure_error", f.tables.pressure_error_Pa / 1e3, "kPa");
  }
  if (f.tables.valve_fine_steps > 0) {
    s.line("valve_fine_steps_worst_tick", f.tables.valve_fine_steps);
    s.line("event_budget", f.tables.event_budget);
  }
  s.faulty_ticks(f.faulty_ticks, f.faults);
  return s;
}

void add_wall_time(Summary& s, double wall_time_per_tick_ns) {
  s.line("wall_time_per_tick", wall_time_per_tick_ns, "ns",
         "this machine: median of " + std::to_string(FixedStepLoop<float>::kBatches) + " batches of " +
             std::to_string(FixedStepLoop<float>::kBatchTicks) + " steps, nothing recorded");
}

std::string command_line(const Arguments& arguments, const Request& request, bool breathes) {
  return "crankloop run " + shell_word(arguments.file()) + " --rpm " + shortest(request.operation.speed_rpm) +
         " --tick-us " + shortest(arguments.number("--tick-us")) + " --cycles " + std::to_string(request.cycles) +
         " --real " + request.real + " " +
         (breathes ? options_of(request.operation.gas) : "--load-ratio " + shortest(request.operation.load_ratio));
}

template <class Real, class S>
void run(const Engines& engine, const Request& request, const Arguments& arguments) {
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
auto with_scene(const Engines& engine, const std::string& real, const Work& work) {
  return with_real(real, [&](auto zero) {
    return engine.breathes() ? work(zero, scenes::Breathing{}) : work(zero, scenes::Whole{});
  });
}

/// Of a run at constant speed, without the time that this machine takes.
Summary figures_of_run(const Arguments& arguments, const EngineFile& file) {
  file.require(needed_sections());
  const Operation operation = operation_of(arguments, file, gas_for(arguments, file));
  require_trains(file, operation.tick_s);
  const Request request{operation, arguments.whole_number("--cycles"), arguments.text("--real"), {}};
  const ExactEngine exact = exact_of(file);
  const Engines engine{file, exact};
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
  Side sides[] = {{first, figures_of_run(arguments, first)}, {second, figures_of_run(arguments, second)}};
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
  const Request request{operation, arguments.whole_number("--cycles"), arguments.text("--real"), std::move(warnings)};
  const ExactEngine exact = exact_of(file);
  const Engines engine{file, exact};
  with_scene(engine, request.real,
             [&](auto zero, auto scene) { run<decltype(zero), decltype(scene)>(engine, request, arguments); });
  return kSuccess;
}

constexpr Option kOptions[] = {
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
    kOptions,
    run_run,
    false,
    figures_of_run};

}  // namespace crankloop::program
