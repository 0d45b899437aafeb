#include "run_trace.hpp"

#include <cmath>

#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tabulate/summary.hpp>

#include "run_limits.hpp"
#include "valve_tick_limit.hpp"

namespace crankloop::program {
namespace {

constexpr double kSpacingDeg = 0.25;

/// A tick of which a whole number gives a spacing that divides 10 deg.
struct Pace {
  double spacing_deg;
  int ticks;
  double tick_s;
};
Pace pace_at(double speed_rpm, double longest_tick_s) {
  const double s_per_deg = 1 / (6 * speed_rpm);
  double spacing_deg = kSpacingDeg;
  while (spacing_deg * s_per_deg < kShortestTick_s) spacing_deg *= 2;
  const double ticks = std::ceil(spacing_deg * s_per_deg / longest_tick_s);
  return {spacing_deg, static_cast<int>(ticks), spacing_deg * s_per_deg / ticks};
}

void append(std::vector<double>& to, double value) { to.push_back(value); }

template <class Real>
void append(std::vector<std::vector<double>>& to, const Real* values) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i].push_back(static_cast<double>(values[i]));
}

template <class Real>
void append(FreeForceTrace& to, const FreeForce<Real>& force) {
  append(to.up_N, static_cast<double>(force.up_N));
  append(to.lateral_N, static_cast<double>(force.lateral_N));
  append(to.pitch_Nm, static_cast<double>(force.pitch_Nm));
  append(to.yaw_Nm, static_cast<double>(force.yaw_Nm));
}

template <class Real, class S>
void append(Trace& trace, const EngineDefinition& definition, double crank_deg, const WholeOutput<Real, S>& out) {
  const QuantityValues<Real> values = values_of(out, definition.layout, 0);
  trace.crank_deg.push_back(crank_deg);
  for (std::size_t i = 0; i < kQuantities; ++i) append(trace.of[i], static_cast<double>(values[i]));
  double tilting_moment_Nm = 0;
  for (std::size_t k = 0; k < trace.cylinder_torque_Nm.size(); ++k) {
    append(trace.cylinder_torque_Nm[k], static_cast<double>(out.cylinder[k].torque_Nm));
    tilting_moment_Nm += static_cast<double>(out.cylinder[k].tilting_moment_Nm);
  }
  append(trace.tilting_moment_Nm, tilting_moment_Nm);
  append(trace.torque_Nm, static_cast<double>(out.torque_Nm));
  append(trace.pin_load_N, out.pin_load_N);
  append(trace.journal_along_N, out.journal_along_N);
  append(trace.journal_across_N, out.journal_across_N);
  append(trace.journal_load_N, out.journal_load_N);
  for (std::size_t j = 0; j < trace.journal_up_N.size(); ++j) {
    const BlockLoad load =
        in_block(definition, crank_deg + definition.layout.firing_deg[0], static_cast<double>(out.journal_along_N[j]),
                 static_cast<double>(out.journal_across_N[j]));
    append(trace.journal_up_N[j], load.up_N);
    append(trace.journal_lateral_N[j], load.lateral_N);
  }
  append(trace.first, out.first);
  append(trace.second, out.second);
  append(trace.rotating, out.rotating);
  if constexpr (detail::Needs<S>::gas) {
    const auto of_gas = values_of(out.cylinder_gas[0]);
    for (std::size_t i = 0; i < kGasQuantities; ++i) append(trace.gas.of[i], static_cast<double>(of_gas[i]));
    for (std::size_t i = 0; i < std::size_t{kPorts}; ++i)
      append(trace.gas.manifold_Pa[i], static_cast<double>(out.manifold[i].pressure_Pa));
    const bool runners[] = {definition.gas.intake_runner.any(), definition.gas.exhaust_runner.any()};
    for (std::size_t i = 0; i < std::size_t{kPorts}; ++i) {
      if (runners[i]) append(trace.gas.port_Pa[i], static_cast<double>(out.runner[0].port_pressure_Pa[i]));
    }
  }
  for (std::size_t t = 0; t < trace.valves.size(); ++t) {
    const auto of_valve = values_of(out, t, 0);
    for (std::size_t i = 0; i < kValveQuantities; ++i) append(trace.valves[t].of[i], static_cast<double>(of_valve[i]));
    trace.valves[t].regime.push_back(out.valve_forces[t][0].regime);
  }
}

}  // namespace

template <class Real, class S>
Trace record_trace(const EngineDefinition& definition, const Operation& operation) {
  const Pace pace = pace_at(operation.speed_rpm, longest_tick_of(definition));
  Operation paced = operation;
  paced.tick_s = pace.tick_s;
  FixedStepLoop<Real, S> loop(definition, paced, definition.layout.firing_deg[0]);

  const std::uint32_t pins = bearings_of(definition).pins;
  Trace trace;
  trace.spacing_deg = pace.spacing_deg;
  trace.tick_s = pace.tick_s;
  trace.cylinder_torque_Nm.resize(static_cast<std::size_t>(definition.layout.cylinders));
  trace.pin_load_N.resize(pins);
  trace.journal_along_N.resize(pins + 1);
  trace.journal_across_N.resize(pins + 1);
  trace.journal_up_N.resize(pins + 1);
  trace.journal_lateral_N.resize(pins + 1);
  trace.journal_load_N.resize(pins + 1);
  trace.valves.resize(static_cast<std::size_t>(definition.train_count));
  const int count = static_cast<int>(std::lround(720 / pace.spacing_deg));
  append<Real, S>(trace, definition, 0, loop.output());
  for (int i = 1; i <= count; ++i) {
    for (int tick = 0; tick < pace.ticks; ++tick) loop.step();
    append<Real, S>(trace, definition, i * pace.spacing_deg, loop.output());
  }
  if (!trace.valves
           .empty()) {  // a lobe's results are there once its cam has passed the base circle: within another cycle
    for (int i = 0; i < count * pace.ticks; ++i) loop.step();
  }
  for (std::size_t t = 0; t < trace.valves.size(); ++t) {
    trace.valves[t].cycle = in_double(loop.output().valve_cycle[t][0]);
  }
  return trace;
}

CycleSummary summarise(const EngineDefinition& definition, double speed_rad_s, const Trace& trace) {
  const std::vector<double>& pressure_Pa = trace[Quantity::pressure];
  const std::vector<double>& displacement_m = trace[Quantity::displacement];
  const std::size_t count = trace.crank_deg.size() - 1;  // the last is the first of the next cycle
  const DeadCentres centres = dead_centres(definition.crank);
  const double bdc_deg = centres.bdc_rad * kDegPerRad;
  double net = 0;
  double gross = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double work = (pressure_Pa[i] + pressure_Pa[i + 1]) / 2 * (displacement_m[i + 1] - displacement_m[i]);
    const double middle_deg = trace.crank_deg[i] + trace.spacing_deg / 2;
    net += work;
    if (middle_deg < bdc_deg || middle_deg > bdc_deg + 360) gross += work;
  }
  const double area_per_swept = 1 / centres.stroke_m;
  CycleSummary s{};
  s.net_mep_Pa = net * area_per_swept;
  s.gross_mep_Pa = gross * area_per_swept;
  for (std::size_t i = 0; i < count; ++i) s.mean_torque_Nm += trace.torque_Nm[i] / static_cast<double>(count);
  s.power_W = s.mean_torque_Nm * speed_rad_s;
  s.brake = brake_figures(definition, s.mean_torque_Nm, speed_rad_s);
  struct Cycle {
    const Trace& trace;
    double begin_deg;  ///< engine angle of its first entry
  };
  const Cycle cycle{trace, definition.layout.firing_deg[0]};
  add_torques(
      s, static_cast<int>(count),
      [](const void* of, double deg) {
        const Cycle& c = *static_cast<const Cycle*>(of);
        const double since_deg = deg < c.begin_deg ? deg - c.begin_deg + 720 : deg - c.begin_deg;
        return c.trace.torque_Nm[static_cast<std::size_t>(std::lround(since_deg / c.trace.spacing_deg))];
      },
      &cycle);
  return s;
}

template Trace record_trace<float, scenes::Whole>(const EngineDefinition&, const Operation&);
template Trace record_trace<double, scenes::Whole>(const EngineDefinition&, const Operation&);
template Trace record_trace<float, scenes::Breathing>(const EngineDefinition&, const Operation&);
template Trace record_trace<double, scenes::Breathing>(const EngineDefinition&, const Operation&);

}  // namespace crankloop::program
