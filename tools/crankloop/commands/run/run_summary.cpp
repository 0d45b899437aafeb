#include "run_summary.hpp"

#include <cmath>

#include <crankloop/tabulate/mechanism.hpp>

#include "../../command_line/gas_options.hpp"
#include "../../engine_file/plausibility.hpp"
#include "../../engine_file/pressure_words.hpp"
#include "../../loops/run_gas.hpp"
#include "../../loops/run_valves.hpp"

namespace crankloop::program {
namespace {

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

/// What the net mean effective pressure of a trace gains if all its angles are a degree larger.
double mep_per_deg_Pa(const ExactEngine& engine, double load_ratio) {
  constexpr int kPerDeg = 10;
  const Crank& crank = engine.definition().crank;
  const auto slope_m = [&](double deg) { return exact_pose(crank, deg / kDegPerRad).slope_m; };
  double sum_N_m = 0;
  for (int i = 0; i < 720 * kPerDeg; ++i) {
    const double deg = static_cast<double>(i) / kPerDeg;
    const double pressure_Pa = engine.diagram().motored_Pa(deg) + load_ratio * engine.diagram().heat_Pa(deg);
    sum_N_m += pressure_Pa * bore_area_m2(crank) * (slope_m(deg + 0.5) - slope_m(deg - 0.5));
  }
  return sum_N_m / kPerDeg / kDegPerRad / swept_volume_m3(crank);
}

}  // namespace

Summary summary_of(const HeldEngine& engine, const HeldRequest& request, const RunFigures& f,
                   const CycleSummary& summary) {
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
    add_order(s, request.operation.gas, [](const char*) { return true; });
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
      if (definition.pressure.source == PressureSource::angle_table) {
        s.line("net_mep_per_degree", mep_per_deg_Pa(engine.exact, request.operation.load_ratio) / 1e3, "kPa",
               "too much for each degree by which the trace's angles are too large");
      }
    }
  }
  add_peaks(s, "torque", f.torque, 1, "Nm");
  for (const Quantity quantity : {Quantity::pressure, Quantity::gas_force}) {
    const QuantityKind& kind = kQuantityKinds[index_of(quantity)];
    if (engine.has_gas())
      add_peak(s, std::string("max_") + kind.name, f.of[index_of(quantity)].largest, kind.per_si, kind.unit);
  }
  const std::string unusual = unusual_peak(f.of[index_of(Quantity::pressure)].largest.value);
  if (engine.breathes() && !unusual.empty()) s.remark(unusual);
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

}  // namespace crankloop::program
