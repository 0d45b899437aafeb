// `crankloop valve FILE`: one elastic valve at constant speed, tick by tick, and what it does in a
// cycle.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../command_line/operating_point.hpp"
#include "../../command_line/progress.hpp"
#include "../../command_line/results.hpp"
#include "../../command_line/summary.hpp"
#include "../../command_line/with_real.hpp"
#include "../../engine_file/gas_order.hpp"
#include "../../files/csv.hpp"
#include "../../files/units.hpp"
#include "../../loops/cam_loads.hpp"
#include "../../loops/flow_lines.hpp"
#include "../../loops/spring_stress.hpp"
#include "../../loops/surge_force.hpp"
#include "../../loops/textbook_valve.hpp"
#include "../../loops/valve_accuracy.hpp"
#include "../../loops/valve_loop.hpp"
#include "valve_plot.hpp"

namespace crankloop::program {
namespace {

constexpr double kPeriodicWithin_m = 1e-6;
constexpr double kMaxTicksDrawn = 2e6;  // of 100 bytes

struct Request {
  double speed_rpm;
  double tick_s;
  int cycles;
  std::string integrator;
  ValveMethod method;
  std::string real;
};

/// The flow area where the file has the valve's dimensions.
struct Flow {
  std::optional<FlowArea> area{};
  FlowIntegrals theory{};
  FlowIntegrals elastic{};
};

/// Columns of what the cam bears: where the file has the width of the contact.
constexpr const char* kLoadColumns[] = {"contact_stress_MPa", "contact_half_width_um", "sliding_m_s", "entrainment_m_s",
                                        "cam_torque_Nm"};

template <class Real>
void write_row(CsvWriter& csv, const LoneValve& valve, const Flow& flow, const ValveTickOutput<Real>& out,
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

std::string title(const LoneValve& valve, const Request& request) {
  return valve.train().name + " at " + brief(request.speed_rpm) + " rpm of the engine";
}

std::string circumstances(const Request& request) {
  return "tick " + brief(request.tick_s * 1e6) + " us, " + request.integrator + ", " + request.real + ", cycle " +
         std::to_string(request.cycles);
}

std::string gas_remark(const LoneValve& valve) {
  if (!(valve.valve().head_area_m2 > 0)) return "no gas force: head_area_mm2 is 0";
  if (breathes(valve.file().definition())) return "no gas force: for an engine with gas exchange use `crankloop run`";
  if (valve.definition().pressure.source == PressureSource::none)
    return "no gas force: the file has no [pressure] source";
  return "with the gas force on the head, full load";
}

/// Forces on the valve beside spring and train.
std::string forces_remark(const LoneValve& valve) {
  const int modes = valve.valve().surge_modes;
  if (modes == 0) return gas_remark(valve);
  return gas_remark(valve) + "; springs surge, " + std::to_string(modes) + (modes == 1 ? " mode each" : " modes each");
}

/// Of rigid parts: it does not depend on the run.
void add_margin(Summary& s, const LoneValve& valve, double speed_rpm) {
  const StaticRedline redline = valve.static_redline();
  if (!(redline.crank_rad_s > 0)) {
    s.none("spring_margin", "", "the valve never opens");
    s.none("static_redline", "rpm");
    return;
  }
  s.line("spring_margin", redline.margin(speed_rpm * kRad_sPerRpm), "",
         "least of rigid parts, at " + brief(redline.cam_deg) + " deg: below 1 the valve leaves its train");
  s.line("static_redline", redline.crank_rad_s * kRpmPerRad_s, "rpm", "spring margin 1; no elasticity, damping or gas");
}

/// Forces of the springs over the cycle shown.
struct SpringRange {
  double largest_surge_N = 0;
  double least_N = std::numeric_limits<double>::infinity();
  double largest_N = 0;
  double least_fixed_N = std::numeric_limits<double>::infinity();  ///< at the spring's fixed end
  double largest_fixed_N = 0;

  template <class Real>
  void take(const ValveSpringOutput<Real>& s) {
    const auto moving_N = static_cast<double>(s.moving_N), fixed_N = static_cast<double>(s.fixed_N);
    largest_surge_N = std::max(largest_surge_N, std::abs(static_cast<double>(s.surge_N)));
    least_N = std::min(least_N, moving_N), largest_N = std::max(largest_N, moving_N);
    least_fixed_N = std::min(least_fixed_N, fixed_N), largest_fixed_N = std::max(largest_fixed_N, fixed_N);
  }
};

/// Of the spring's wire, where the file has one: at rest, and over the cycle at the end that swings more.
void add_spring_stress(Summary& s, const LoneValve& valve, const SpringRange& springs) {
  if (!valve.train().wire) return;
  const SpringWire& wire = *valve.train().wire;
  const Valve& v = valve.valve();
  const auto stress_MPa = [&wire](double force_N) { return shear_stress_Pa(wire, force_N) / 1e6; };
  s.line("wire_spring_rate", rate_of_wire_N_m(wire) / 1e3, "N/mm",
         "of the wire" + std::string(wire.shear_assumed ? ", shear modulus assumed" : "") +
             "; spring_N_per_mm = " + brief(v.spring_N_m / 1e3));
  s.line("wire_spring_mass", mass_of_wire_kg(wire) * 1e3, "g",
         "of its active coils, steel; spring_g = " + brief(v.spring_kg * 1e3));
  s.line("wire_stress_closed", stress_MPa(v.spring_preload_N), "MPa", "shear by Wahl, valve closed");
  s.line("wire_stress_open", stress_MPa(v.spring_preload_N + v.spring_N_m * valve.lift().largest_lift_m()), "MPa",
         "at the largest theoretical lift");
  const bool fixed = springs.largest_fixed_N - springs.least_fixed_N > springs.largest_N - springs.least_N;
  const double least_N = fixed ? springs.least_fixed_N : springs.least_N;
  const double largest_N = fixed ? springs.largest_fixed_N : springs.largest_N;
  s.line("wire_stress_largest", stress_MPa(largest_N), "MPa",
         "in the cycle, least " + brief(stress_MPa(least_N)) + " MPa" +
             (v.surge_modes > 0 ? std::string(", with surge, at the spring's ") + (fixed ? "fixed" : "moving") + " end"
                                : ", without surge"));
  if (!wire.has_limits()) return;
  s.line("goodman_factor", goodman_factor(wire, stress_MPa(least_N) * 1e6, stress_MPa(largest_N) * 1e6), "",
         "of that swing against shear_endurance_MPa and shear_ultimate_MPa: below 1 it breaks some time");
}

/// Of springs whose modes are stepped with the valve.
void add_stepped_surge(Summary& s, const LoneValve& valve, const SpringRange& springs, double error_ratio) {
  const Valve& v = valve.valve();
  s.line("spring_surge_force", springs.largest_surge_N, "N",
         "largest, of " + std::to_string(v.surge_modes) + (v.surge_modes == 1 ? " mode" : " modes") +
             (v.inner_spring_N_m > 0 ? " of each spring" : "") +
             ", stepped with the valve; the tick's length may take " + brief(error_ratio * 100) +
             " % of it, bounces apart");
  s.line("least_spring_force", springs.least_N, "N", "with surge; preload " + brief(v.spring_preload_N) + " N");
  s.line("largest_spring_force", springs.largest_N, "N", "with surge");
  if (springs.least_N < 0)
    s.remark("a spring force below 0 is a spring that leaves its retainer, which is not modelled: it holds on");
}

/// Of the spring's own motion.
void add_surge(Summary& s, const LoneValve& valve, double speed_rpm, const SpringRange& springs, double error_ratio) {
  const double cam_rad_s = speed_rpm * kRad_sPerRpm / 2;
  const SpringSurgeCycle surge = surge_over_cycle(valve.lift(), valve.valve(), cam_rad_s);
  if (!(surge.frequency_Hz > 0)) {
    s.none("spring_frequency", "Hz", "spring_g is 0");
    return;
  }
  s.line("spring_frequency", surge.frequency_Hz, "Hz",
         "first of the spring itself, " + brief(surge.frequency_Hz / std::abs(cam_rad_s * kTurnsPerRad)) +
             " times the cam's turns");
  if (valve.valve().surge_modes > 0) return add_stepped_surge(s, valve, springs, error_ratio);
  if (!(surge.largest_N > 0)) {
    s.none("spring_surge_force", "N", "the cam turns too slowly");
    return;
  }
  s.line("spring_surge_force", surge.largest_N, "N",
         "largest, of its first three modes driven by the theoretical lift; damping ratio " +
             brief(valve.valve().surge_damping_ratio) + "; surge_modes of [valve] step them with the valve");
}

/// Largest and smallest speed and acceleration of a valve's lift, m/s and m/s^2.
struct MotionRange {
  double opening_m_s = 0;
  double closing_m_s = 0;
  double rise_m_s2 = 0;
  double fall_m_s2 = 0;

  void take(double velocity_m_s, double acceleration_m_s2) {
    opening_m_s = std::max(opening_m_s, velocity_m_s);
    closing_m_s = std::min(closing_m_s, velocity_m_s);
    rise_m_s2 = std::max(rise_m_s2, acceleration_m_s2);
    fall_m_s2 = std::min(fall_m_s2, acceleration_m_s2);
  }
};

/// Of rigid parts: what the cam gives where its lash is closed. The cam speed has a sign.
MotionRange rigid_range(const ValveLift& lift, double cam_rad_s) {
  MotionRange range;
  for (int i = -18000; i < 18000; ++i) {
    const LiftPose pose = lift.at(i * 0.01 * kRadPerDeg);
    if (pose.lift_m > 0) range.take(pose.per_rad_m * cam_rad_s, pose.per_rad2_m * cam_rad_s * cam_rad_s);
  }
  return range;
}

void add_motion(Summary& s, const MotionRange& elastic, const MotionRange& rigid) {
  const auto line = [&s](const char* name, double of_valve, double of_rigid, const char* unit) {
    s.line(name, of_valve, unit, "of rigid parts " + brief(of_rigid));
  };
  line("opening_velocity", elastic.opening_m_s, rigid.opening_m_s, "m/s");
  line("closing_velocity", elastic.closing_m_s, rigid.closing_m_s, "m/s");
  line("min_acceleration", elastic.fall_m_s2, rigid.fall_m_s2, "m/s^2");
}

/// What the ticks of the cycle shown come to.
struct OfTheCycle {
  MotionRange motion{};
  SpringRange springs{};
  CamLoadsOfCycle loads;
};

template <class Real>
Summary summary(const LoneValve& valve, const Request& request, const ValveLoop<Real>& loop,
                const ValveCycle<Real>& cycle, double change_m, const Flow& flow, const OfTheCycle& ticks) {
  const auto real = [](double value) { return static_cast<Real>(value); };
  const detail::ValveBody<double> body = valve.body();
  const bool separated = cycle.separations > 0;
  Summary s;
  s.remark("valve train " + title(valve, request) + ", " + circumstances(request));
  s.remark("cam angle: 0 at full theoretical lift; " + forces_remark(valve));
  s.line("max_theoretical_lift", real(valve.lift().largest_lift_m() * 1e3), "mm");
  s.line("max_lift", cycle.largest_lift_m * real(1e3), "mm");
  s.line("max_velocity", cycle.largest_speed_m_s, "m/s");
  const double cam_rad_s = loop.deg_per_tick(request.speed_rpm) * kRadPerDeg / request.tick_s;
  const MotionRange rigid = rigid_range(valve.lift(), cam_rad_s);
  s.line("max_acceleration", cycle.largest_acceleration_m_s2, "m/s^2", "of rigid parts " + brief(rigid.rise_m_s2));
  add_motion(s, ticks.motion, rigid);
  add_opening_delay(s, "opening_delay", cycle);
  s.line("separations", cycle.separations, "", "of at least 1 um");
  s.line("separation_max_gap", cycle.separation_clearance_m * real(1e3), "mm");
  if (separated) {
    s.line("separation_start", valve.cam_deg(static_cast<double>(cycle.separation_start_deg)), "deg",
           "cam angle, of the largest");
  } else {
    s.none("separation_start", "deg");
  }
  s.line("separation_duration", cycle.separation_duration_deg, "deg");
  s.line("seating_speed", cycle.seating_speed_m_s, "m/s");
  s.line("bounces", cycle.bounces, "", "of at least 1 um");
  s.line("bounce_height", cycle.bounce_height_m * real(1e3), "mm");
  if (cycle.off_seat_at_end != 0) s.remark("the valve is still off its seat in the middle of the base circle");
  s.line("natural_frequency", real(open_frequency_rad_s(body) / (2 * kPi)), "Hz", "open, on the train");
  s.line("seat_frequency", real(seated_frequency_rad_s(body) / (2 * kPi)), "Hz", "on train and seat");
  add_margin(s, valve, request.speed_rpm);
  add_surge(s, valve, request.speed_rpm, ticks.springs, loop.surge_error_ratio());
  add_spring_stress(s, valve, ticks.springs);
  const TrainOfFile& train = valve.train();
  add_cam_loads(s, train, static_stress(valve.lift(), train.definition, train.contact), ticks.loads, cam_rad_s);
  const std::uint32_t parts = loop.motion().parts;
  s.line("sub_steps", request.method.textbook ? TextbookValve<Real>::steps(loop.motion()) : parts, "",
         request.method.textbook ? "in each tick" : "in a tick, near contact changes; 1 elsewhere");
  s.line("events", cycle.contact_changes, "", "contact changes in the cycle");
  if ((loop.faults() & kFaultEventBudget) != 0)
    s.remark("some ticks had more contact changes than are located: take a shorter --tick-us");
  s.line("cycle_difference", real(change_m * 1e6), "um", "of lift, largest between two consecutive cycles");
  s.line("periodic", change_m <= kPeriodicWithin_m ? "yes" : "no", "", "yes: they agree within 1 um");
  s.remark(flow_remark(valve.train()));
  if (!flow.area) return s;
  add_flow(s, "theoretical_", flow.theory);
  add_flow(s, "", flow.elastic);
  add_flow_figures(s, flow.elastic, valve.file(), valve.train(), request.speed_rpm);
  return s;
}

/// Writes the files that are asked for.
template <class Real>
Summary run(const LoneValve& valve, const Request& request, Results& results, const std::function<void()>& after_tick) {
  ValveLoop<Real> loop(valve, request.tick_s, request.method);
  const double ticks = ticks_per_cycle(request.speed_rpm, request.tick_s);
  Output* plot = results["--plot"];
  if (plot != nullptr && ticks > kMaxTicksDrawn) {
    throw UsageError("--plot: a cycle of " + brief(ticks) + " ticks, at most " + brief(kMaxTicksDrawn) +
                     " can be drawn: take a longer --tick-us");
  }
  Flow flow;
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
  OfTheCycle of_cycle{{}, {}, CamLoadsOfCycle(valve.train().stress_limit_Pa)};
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
    report::Sheet sheet = valve_sheet(trace, "Valve train " + title(valve, request), remark);
    if (flow.area) add_flow_remarks(sheet.remarks, valve.train());
    plot->write(report::to_svg_file(sheet));
  }
  return summary(valve, request, loop, cycle, change_m, flow, of_cycle);
}

Request request_of(const Arguments& arguments, const EngineFile& file) {
  const std::string& integrator = arguments.text("--integrator");
  const ValveStepping stepping{integrator == "exponential" ? Integrator::exponential : Integrator::rk4,
                               millionths(arguments.number("--accuracy-um"))};
  Request request{speed_rpm(arguments, file),           millionths(arguments.number("--tick-us")),
                  arguments.whole_number("--cycles"),   integrator,
                  {stepping, integrator == "textbook"}, arguments.text("--real")};
  if (request.speed_rpm == 0) throw UsageError("--rpm 0: the cam would never turn");
  return request;
}

int run_valve(const Arguments& arguments) {
  const EngineFile file = read_engine(arguments, {});
  const Request request = request_of(arguments, file);
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
  const Request request = request_of(arguments, file);
  const LoneValve valve(file, train_name(arguments, file));
  Results no_files(arguments, {});
  return with_real(request.real, [&](auto zero) { return run<decltype(zero)>(valve, request, no_files, {}); });
}

constexpr Option kOptions[] = {
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
    kOptions,
    run_valve,
    false,
    figures_of_valve};

}  // namespace crankloop::program
