#include "valve_summary.hpp"

#include "../../engine_file/gas_order.hpp"
#include "../../files/units.hpp"
#include "../../loops/flow_lines.hpp"
#include "../../loops/spring_stress.hpp"
#include "../../loops/surge_force.hpp"
#include "../../loops/textbook_valve.hpp"
#include "../../loops/valve_cycle.hpp"

namespace crankloop::program {
namespace {

constexpr double kPeriodicWithin_m = 1e-6;
constexpr double kRounding_m = 1e-15;  // of a lift in double

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
  if (!(valve.valve().spring_kg > 0)) {
    s.none("spring_frequency", "Hz", "spring_g is 0");
    return;
  }
  const double cam_rad_s = speed_rpm * kRad_sPerRpm / 2;
  const SpringSurgeCycle surge = surge_over_cycle(LiftSlopes(valve.lift()), valve.valve(), cam_rad_s);
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

}  // namespace

std::string title_of(const LoneValve& valve, const ValveRequest& request) {
  return valve.train().name + " at " + brief(request.speed_rpm) + " rpm of the engine";
}

std::string circumstances(const ValveRequest& request) {
  return "tick " + brief(request.tick_s * 1e6) + " us, " + request.integrator + ", " + request.real + ", cycle " +
         std::to_string(request.cycles);
}

std::string forces_remark(const LoneValve& valve) {
  const int modes = valve.valve().surge_modes;
  if (modes == 0) return gas_on_head(valve);
  return gas_on_head(valve) + "; springs surge, " + std::to_string(modes) + (modes == 1 ? " mode each" : " modes each");
}

template <class Real>
Summary summary_of(const LoneValve& valve, const ValveRequest& request, const ValveLoop<Real>& loop,
                   const ValveCycle<Real>& cycle, double change_m, const ValveFlow& flow, const TicksOfCycle& ticks) {
  const auto real = [](double value) { return static_cast<Real>(value); };
  const detail::ValveBody<double> body = valve.body();
  const bool separated = cycle.separations > 0;
  Summary s;
  s.remark("valve train " + title_of(valve, request) + ", " + circumstances(request));
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
  s.line("cycle_difference", real(change_m > kRounding_m ? change_m * 1e6 : 0), "um",
         "of lift, largest between two consecutive cycles");
  s.line("periodic", change_m <= kPeriodicWithin_m ? "yes" : "no", "", "yes: they agree within 1 um");
  s.remark(flow_remark(valve.train()));
  if (!flow.area) return s;
  add_flow(s, "theoretical_", flow.theory);
  add_flow(s, "", flow.elastic);
  add_flow_figures(s, flow.elastic, valve.file(), valve.train(), request.speed_rpm);
  return s;
}

template Summary summary_of(const LoneValve& valve, const ValveRequest& request, const ValveLoop<float>& loop,
                            const ValveCycle<float>& cycle, double change_m, const ValveFlow& flow,
                            const TicksOfCycle& ticks);
template Summary summary_of(const LoneValve& valve, const ValveRequest& request, const ValveLoop<double>& loop,
                            const ValveCycle<double>& cycle, double change_m, const ValveFlow& flow,
                            const TicksOfCycle& ticks);

}  // namespace crankloop::program
