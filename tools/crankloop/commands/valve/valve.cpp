// `crankloop valve FILE`: one elastic valve at constant speed, tick by tick, and what it does in a
// cycle.
//
// What belongs here: options, the rows of the CSV, the run with its files. What does not: printed figures
// (valve_summary.hpp), the drawing (valve_plot.hpp).
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../command_line/operating_point.hpp"
#include "../../command_line/progress.hpp"
#include "../../command_line/results.hpp"
#include "../../command_line/with_real.hpp"
#include "../../files/csv.hpp"
#include "../../files/units.hpp"
#include "../../loops/cam_loads.hpp"
#include "../../loops/flow_lines.hpp"
#include "../../loops/valve_accuracy.hpp"
#include "../../loops/valve_loop.hpp"
#include "valve_plot.hpp"
#include "valve_summary.hpp"

namespace crankloop::program {
namespace {

constexpr double kMaxTicksDrawn = 2e6;  // of 100 bytes

/// Columns of what the cam bears: where the file has the width of the contact.
constexpr const char* kLoadColumns[] = {"contact_stress_MPa", "contact_half_width_um", "sliding_m_s", "entrainment_m_s",
                                        "cam_torque_Nm"};

template <class Real>
void write_row(CsvWriter& csv, const LoneValve& valve, const ValveFlow& flow, const ValveTickOutput<Real>& out,
               const CamLoads& loads) {
  const auto real = [](double value) { return static_cast<Real>(value); };
  const ValveMotionOutput<Real, OneValve>& m = out.motion;
  const ValveForcesOutput<Real>& f = out.forces;
  csv.cell(out.cam_deg);
  for (const Real value :
       {m.theoretical_lift_m * real(1e3), real(valve.lift().at(out.cam_deg * kRadPerDeg).rocker_ratio),
        m.lift_m * real(1e3), m.velocity_m_s, m.acceleration_m_s2, f.train_N, f.seat_N, f.cam_N,
        f.train_compression_m * real(1e3)})
    csv.cell(value);
  csv.cell(static_cast<int>(f.regime));
  if (valve.valve().surge_modes > 0) csv.cell(out.springs.moving_N), csv.cell(out.springs.surge_N);
  if (flow.area) {
    const double lift_m = static_cast<double>(m.lift_m);
    csv.cell(real(flow.area->geometric_m2(lift_m) * 1e6));
    csv.cell(real(flow.area->effective_m2(lift_m) * 1e6));
  }
  if (valve.train().contact.width_m > 0) {
    for (const double value :
         {loads.stress_Pa / 1e6, loads.half_width_m * 1e6, loads.sliding_m_s, loads.entrainment_m_s, loads.torque_Nm})
      csv.cell(real(value));
  }
  csv.end_row();
}

/// Writes the files that are asked for.
template <class Real>
Summary run(const LoneValve& valve, const ValveRequest& request, Results& results,
            const std::function<void()>& after_tick) {
  ValveLoop<Real> loop(valve, request.tick_s, request.method);
  const double ticks = ticks_per_cycle(request.speed_rpm, request.tick_s);
  Output* plot = results["--plot"];
  if (plot != nullptr && ticks > kMaxTicksDrawn) {
    throw UsageError("--plot: a cycle of " + brief(ticks) + " ticks, at most " + brief(kMaxTicksDrawn) +
                     " can be drawn: take a longer --tick-us");
  }
  ValveFlow flow;
  if ((flow.area = flow_area_of(valve.train()))) flow.theory = theoretical_flow(*flow.area, valve.lift());
  std::optional<CsvWriter> csv;
  if (Output* file = results["--csv"]) {
    std::vector<std::string> columns{"cam_deg",      "theoretical_lift_mm",  "rocker_ratio",  "lift_mm",
                                     "velocity_m_s", "acceleration_m_s2",    "train_force_N", "seat_force_N",
                                     "cam_force_N",  "train_compression_mm", "regime"};
    if (valve.valve().surge_modes > 0) columns.insert(columns.end(), {"spring_force_N", "spring_surge_N"});
    if (flow.area) columns.insert(columns.end(), {"flow_area_mm2", "effective_area_mm2"});
    if (valve.train().contact.width_m > 0)
      columns.insert(columns.end(), std::begin(kLoadColumns), std::end(kLoadColumns));
    csv.emplace(*file, columns);
  }
  const double seat_contact_m = valve.body().preload_N / valve.body().seat_N_m;
  std::optional<FlowSum> sum;
  if (flow.area) sum.emplace(*flow.area, seat_contact_m, 2 * std::abs(loop.deg_per_tick(request.speed_rpm)));
  ValveCycleTrace trace;
  const CamContact& contact = valve.train().contact;
  const double cam_rad_s = loop.deg_per_tick(request.speed_rpm) * kRadPerDeg / request.tick_s;
  TicksOfCycle of_cycle{{}, {}, CamLoadsOfCycle(valve.train().stress_limit_Pa)};
  const OnValveTick<Real> on_tick = [&](const ValveTickOutput<Real>& out) {
    const CamLoads loads = cam_loads_at(valve.lift(), contact, out.cam_deg * kRadPerDeg, cam_rad_s,
                                        static_cast<double>(out.forces.train_N));
    of_cycle.loads.add(out.cam_deg, loads);
    if (csv) write_row(*csv, valve, flow, out, loads);
    of_cycle.motion.take(static_cast<double>(out.motion.velocity_m_s),
                         static_cast<double>(out.motion.acceleration_m_s2));
    of_cycle.springs.take(out.springs);
    if (sum) sum->add(static_cast<double>(out.motion.lift_m));
    if (plot != nullptr) trace.ticks.push_back(in_double(out)), trace.loads.push_back(loads);
  };
  const ValveCycle<Real> cycle = run_cycles<Real>(loop, valve, request.speed_rpm, request.cycles, on_tick, after_tick);
  if (sum) flow.elastic = sum->largest();
  const double change_m = largest_change_of_lift_m<Real>(valve, request.speed_rpm, request.tick_s, request.method,
                                                         request.cycles, after_tick);
  if (plot != nullptr) {
    trace.cycle = in_double(cycle);
    trace.redline = valve.static_redline();
    trace.speed_rad_s = request.speed_rpm * kRad_sPerRpm;
    trace.seat_contact_m = seat_contact_m;
    trace.area = flow.area;
    trace.limit_Pa = valve.train().stress_limit_Pa;
    if (!(contact.width_m > 0)) trace.loads.clear();
    const std::string remark = std::filesystem::path(valve.file().path()).filename().string() + ", " +
                               circumstances(request) + "; " + forces_remark(valve);
    report::Sheet sheet = valve_sheet(trace, "Valve train " + title_of(valve, request), remark);
    if (flow.area) add_flow_remarks(sheet.remarks, valve.train());
    plot->write(report::to_svg_file(sheet));
  }
  return summary_of(valve, request, loop, cycle, change_m, flow, of_cycle);
}

ValveRequest request_of(const Arguments& arguments, const EngineFile& file) {
  const std::string& integrator = arguments.text("--integrator");
  const ValveStepping stepping{integrator == "exponential" ? Integrator::exponential : Integrator::rk4,
                               millionths(arguments.number("--accuracy-um"))};
  ValveRequest request{speed_rpm(arguments, file),           millionths(arguments.number("--tick-us")),
                       arguments.whole_number("--cycles"),   integrator,
                       {stepping, integrator == "textbook"}, arguments.text("--real")};
  if (request.speed_rpm == 0) throw UsageError("--rpm 0: the cam would never turn");
  return request;
}

int run_valve(const Arguments& arguments) {
  const EngineFile file = read_engine(arguments, {});
  const ValveRequest request = request_of(arguments, file);
  const std::string name = train_name(arguments, file);
  const LoneValve valve(file, name);
  if (request.method.textbook && valve.valve().surge_modes > 0)
    throw UsageError("--integrator textbook: springs follow their valve there; take surge_modes out of [valve " + name +
                     "]");
  if (!request.method.textbook)
    tell_warnings(arguments, beyond_class(valve, request.speed_rpm, request.tick_s, request.method.stepping));
  Results results(arguments, {"--csv", "--plot"});
  with_real(request.real, [&](auto zero) {
    Progress progress("running", (2.0 * request.cycles + 2) * ticks_per_cycle(request.speed_rpm, request.tick_s));
    results.finish(run<decltype(zero)>(valve, request, results, [&progress] { progress.step(); }).text());
  });
  return kSuccess;
}

Summary figures_of_valve(const Arguments& arguments, const EngineFile& file) {
  const ValveRequest request = request_of(arguments, file);
  const LoneValve valve(file, train_name(arguments, file));
  Results no_files(arguments, {});
  return with_real(request.real, [&](auto zero) { return run<decltype(zero)>(valve, request, no_files, {}); });
}

constexpr Option kValveOptions[] = {
    text("--train", "NAME",
         "valve train: the NAME of its [cam NAME], [rocker NAME] and [valve NAME]; default the only one of the file"),
    kSpeed,
    number("--tick-us", "T", from(1).up_to(2000),
           "length of a tick in us; finer than in other commands, to show each bounce", "20"),
    whole_number("--cycles", "N", from(1).up_to(1000000), "cycles to run from rest; the last is shown", "4"),
    choice("--integrator", "rk4|exponential|textbook",
           "of the tick; textbook: four stages, contact changes not located", "rk4"),
    number("--accuracy-um", "A", from(0.01).up_to(10), "class of lift error: finer ones take finer sub-steps", "0.1"),
    choice("--real", "float|double", "arithmetic of the tick, and digits of the result", "double"),
    text("--csv", "F",
         "file for a row per tick of the last cycle; - is standard output, the summary then goes to stderr"),
    text("--plot", "F.svg",
         "SVG file with a picture of the last cycle: lift, gap, forces, seating, flow area, contact stress, cam "
         "torque; opens "
         "in any browser"),
};

}  // namespace

const Command kValve{
    "valve",
    "one elastic valve at constant speed: lift, forces, float and bounce",
    "FILE [--train NAME] [--rpm N] [--tick-us T] [--cycles N] [--integrator I] [--accuracy-um A] [--real R] [--csv F] "
    "[--plot F.svg]",
    "crankloop valve ohc_125.ini --train intake --rpm 7000 --csv valve.csv --plot valve.svg",
    1,
    kValveOptions,
    run_valve,
    false,
    figures_of_valve};

}  // namespace crankloop::program
