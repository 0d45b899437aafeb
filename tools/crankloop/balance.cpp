// `crankloop balance FILE --rpm N`: what the whole engine does to its mounts, bearings and driveline.
#include <algorithm>
#include <string>

#include <crankloop/tabulate/summary.hpp>

#include "commands.hpp"
#include "csv.hpp"
#include "engine_file/engine_file.hpp"
#include "tick_probe.hpp"

namespace crankloop::program {
namespace {

double length(double x, double y) { return square_root(x * x + y * y); }

void write_turning(CsvWriter& csv, const std::string& name, const Turning<double>& t, double w2) {
  csv.row("free_force_" + name + "_N", peak_force_kg_m(t) * w2);
  csv.row("free_force_" + name + "_up_N", length(t.up_cos, t.up_sin) * w2);
  csv.row("free_force_" + name + "_lateral_N", length(t.lateral_cos, t.lateral_sin) * w2);
  csv.row("free_moment_" + name + "_Nm", peak_moment_kg_m2(t) * w2);
  csv.row("free_moment_" + name + "_pitch_Nm", length(t.pitch_cos, t.pitch_sin) * w2);
  csv.row("free_moment_" + name + "_yaw_Nm", length(t.yaw_cos, t.yaw_sin) * w2);
}

/// Largest loads of every crank pin and main journal over the cycle.
void write_bearings(CsvWriter& csv, const EngineDefinition& definition, double speed) {
  TickProbe<double> probe(definition);
  double pins[kMaxCylinders] = {};
  double journals[kMaxCylinders + 1] = {};
  const std::uint32_t count = bearings_of(definition).pins;
  for_each_angle(0.5, 720, [&](double deg) {
    const auto& out = probe.at(deg, speed);
    for (std::uint32_t i = 0; i < count; ++i) pins[i] = std::max(pins[i], out.pin_load_N[i]);
    for (std::uint32_t j = 0; j <= count; ++j) journals[j] = std::max(journals[j], out.journal_load_N[j]);
  });
  for (std::uint32_t i = 0; i < count; ++i) csv.row("crank_pin_" + std::to_string(i + 1) + "_largest_load_N", pins[i]);
  for (std::uint32_t j = 0; j <= count; ++j) csv.row("main_journal_" + std::to_string(j + 1) + "_largest_load_N", journals[j]);
}

int run_balance(const Arguments& arguments) {
  const EngineFile engine = read_engine_file(arguments.file(), {"engine", "crank", "masses"});
  const EngineDefinition& definition = engine.definition();
  const double speed = arguments.number("--rpm") * kRadPerSPerRpm;
  ExactEngine exact;
  if (const Status refused = exact.init(definition); !refused.ok()) throw engine.explain(refused);
  const CycleSummary cycle = summarise(exact, speed);
  const Balance<double> balance = balance_of(definition);

  Output out(arguments.text_or_empty("--csv"));
  CsvWriter csv(out, {"name", "value"});
  csv.row("speed_rpm", arguments.number("--rpm"));
  csv.row("reciprocating_mass_kg", definition.masses.reciprocating_kg());
  csv.row("mean_piston_speed_m_s", mean_piston_speed_m_s(definition.crank, speed));
  csv.row("net_mep_kPa", cycle.net_mep_Pa / 1000);
  csv.row("gross_mep_kPa", cycle.gross_mep_Pa / 1000);
  csv.row("power_kW", cycle.power_W / 1000);
  csv.row("mean_torque_Nm", cycle.mean_torque_Nm);
  csv.row("largest_torque_Nm", cycle.largest_torque_Nm);
  csv.row("largest_torque_deg", cycle.largest_torque_deg);
  csv.row("smallest_torque_Nm", cycle.smallest_torque_Nm);
  csv.row("smallest_torque_deg", cycle.smallest_torque_deg);
  csv.row("torque_fluctuation_ratio", cycle.fluctuation_ratio);
  for (const Harmonic& h : cycle.harmonics) csv.row("torque_order_" + shortest(h.order) + "_Nm", h.amplitude_Nm);
  write_turning(csv, "first", balance.first, speed * speed);
  write_turning(csv, "second", balance.second, speed * speed);
  write_turning(csv, "rotating", balance.rotating, speed * speed);
  write_bearings(csv, definition, speed);
  out.finish();
  return kSuccess;
}

constexpr Option kOptions[] = {
    number("--rpm", "N", from(-100000).up_to(100000), "engine speed in rpm"),
    text("--csv", "F", "file for the table; else standard output"),
};

}  // namespace

const Command kBalance{"balance",
                       "torque harmonics, free forces and moments, bearing loads of the whole engine",
                       "FILE --rpm N [--csv F]",
                       "crankloop balance diesel_495.ini --rpm 2000",
                       1,
                       kOptions,
                       run_balance};

}  // namespace crankloop::program
