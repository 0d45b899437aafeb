// `crankloop balance FILE --rpm N`: free forces, mounts, bearing loads and torque harmonics of the whole engine.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <crankloop/tabulate/summary.hpp>

#include "../command_line/commands.hpp"
#include "../command_line/engine_argument.hpp"
#include "../command_line/gas_options.hpp"
#include "../command_line/operating_point.hpp"
#include "../command_line/summary.hpp"
#include "../engine_report/free_orders.hpp"
#include "../files/csv.hpp"
#include "../files/units.hpp"
#include "../loops/free_forces.hpp"
#include "../loops/run_trace.hpp"
#include "../loops/tick_probe.hpp"

namespace crankloop::program {
namespace {

std::vector<std::string> needed_sections() { return {"engine", "crank", "masses"}; }

/// What cancels leaves rounding: up to this share of the torque's range, or of what a single cylinder's inertia gives,
/// 0 is printed.
constexpr double kRoundingRatio = 1e-9;

/// Of free forces: this share of a cylinder's inertia force.
double rounding_force_N(const EngineDefinition& definition, double speed_rad_s) {
  return kRoundingRatio * definition.masses.reciprocating_kg() * definition.crank.crank_radius_m * speed_rad_s *
         speed_rad_s;
}

double without_rounding(double amplitude, double rounding) { return amplitude > rounding ? amplitude : 0; }

/// Masses alone do no work in a cycle, so nothing is left of it but rounding, of which no efficiency can be made.
void drop_rounding(CycleSummary& cycle, double rounding_Nm, double displacement_m3) {
  if (std::abs(cycle.gross_mep_Pa) * displacement_m3 <= rounding_Nm * kCycle_rad) cycle.gross_mep_Pa = 0;
  if (std::abs(cycle.mean_torque_Nm) > rounding_Nm) return;
  cycle.mean_torque_Nm = cycle.net_mep_Pa = cycle.power_W = 0;
  cycle.brake.efficiency_ratio = 0;
}

/// A component's amplitude and phase; a balanced component has neither.
void write_wave(Summary& s, const std::string& name, const char* unit, double cosine, double sine, double rounding) {
  const Wave wave = wave_of(cosine, sine);
  s.line(name + "_" + unit, without_rounding(wave.amplitude, rounding));
  s.line(name + "_phase_deg", wave.amplitude > rounding ? wave.phase_deg : 0);
}

/// Arm of the moments: between the outermost cylinders, at least the crank's.
double arm_m(const EngineDefinition& definition) {
  const auto first = definition.layout.position_m.begin();
  const auto [front, rear] = std::minmax_element(first, first + definition.layout.cylinders);
  return std::max(*rear - *front, definition.crank.crank_radius_m);
}

/// Amplitudes over a turn at speed w.
class TurningWriter {
 public:
  TurningWriter(Summary& s, const EngineDefinition& definition, double speed_rad_s)
      : s_{s},
        w2_{speed_rad_s * speed_rad_s},
        rounding_N_{rounding_force_N(definition, speed_rad_s)},
        rounding_Nm_{rounding_N_ * arm_m(definition)} {}

  void write(const std::string& name, const TurningForce& t) {
    force("free_force_" + name + "_N", t);
    component("free_force_" + name + "_up", "N", t.up_cos, t.up_sin, rounding_N_);
    component("free_force_" + name + "_lateral", "N", t.lateral_cos, t.lateral_sin, rounding_N_);
    moment("free_moment_" + name + "_Nm", t);
    component("free_moment_" + name + "_pitch", "Nm", t.pitch_cos, t.pitch_sin, rounding_Nm_);
    component("free_moment_" + name + "_yaw", "Nm", t.yaw_cos, t.yaw_sin, rounding_Nm_);
  }

  /// An order of the engine alone, and what its balancers leave of it.
  void write_residual(const EngineDefinition& definition, const std::vector<Balancer>& balancers,
                      const FreeOrder& order) {
    const TurningForce bare = free_force(definition, {}, order.order);
    const TurningForce left = free_force(definition, balancers, order.order);
    const std::string name = std::string("_") + order.name + "_";
    force("bare_force" + name + "N", bare);
    force("residual_force" + name + "N", left);
    moment("bare_moment" + name + "Nm", bare);
    moment("residual_moment" + name + "Nm", left);
  }

 private:
  void force(const std::string& name, const TurningForce& t) {
    s_.line(name, without_rounding(peak_force_kg_m(t) * w2_, rounding_N_));
  }
  void moment(const std::string& name, const TurningForce& t) {
    s_.line(name, without_rounding(peak_moment_kg_m2(t) * w2_, rounding_Nm_));
  }
  void component(const std::string& name, const char* unit, double cosine, double sine, double rounding) {
    write_wave(s_, name, unit, cosine * w2_, sine * w2_, rounding);
  }

  Summary& s_;
  double w2_;
  double rounding_N_;
  double rounding_Nm_;
};

struct Range {
  double least = 0;
  double most = 0;
  void take(double value) { least = std::min(least, value), most = std::max(most, value); }
};

/// Largest loads of every crank pin and main journal over the cycle; the journals' also by direction in the block.
struct BearingRanges {
  Range pins[kMaxCylinders];
  Range journals[kMaxCylinders + 1];
  Range up[kMaxCylinders + 1];
  Range lateral[kMaxCylinders + 1];
};

BearingRanges bearings_by_angle(const EngineDefinition& definition, double speed, double load_ratio) {
  TickProbe<double> probe(definition);
  BearingRanges r;
  const std::uint32_t count = bearings_of(definition).pins;
  for_each_angle(0.5, 720, [&](double deg) {
    const auto& out = probe.at(deg, speed, load_ratio);
    for (std::uint32_t i = 0; i < count; ++i) r.pins[i].take(out.pin_load_N[i]);
    for (std::uint32_t j = 0; j <= count; ++j) {
      r.journals[j].take(out.journal_load_N[j]);
      const BlockLoad load = in_block(definition, deg, out.journal_along_N[j], out.journal_across_N[j]);
      r.up[j].take(load.up_N);
      r.lateral[j].take(load.lateral_N);
    }
  });
  return r;
}

/// For an engine with gas exchange, from a recorded cycle.
BearingRanges bearings_of_trace(const Trace& trace) {
  BearingRanges r;
  const auto take = [](Range& range, const std::vector<double>& values) {
    for (const double value : values) range.take(value);
  };
  for (std::size_t i = 0; i < trace.pin_load_N.size(); ++i) take(r.pins[i], trace.pin_load_N[i]);
  for (std::size_t j = 0; j < trace.journal_load_N.size(); ++j) {
    take(r.journals[j], trace.journal_load_N[j]);
    take(r.up[j], trace.journal_up_N[j]);
    take(r.lateral[j], trace.journal_lateral_N[j]);
  }
  return r;
}

void write_bearings(Summary& s, std::uint32_t count, const BearingRanges& r) {
  for (std::uint32_t i = 0; i < count; ++i)
    s.line("crank_pin_" + std::to_string(i + 1) + "_max_load_N", r.pins[i].most);
  for (std::uint32_t j = 0; j <= count; ++j) {
    const std::string journal = "main_journal_" + std::to_string(j + 1) + "_";
    s.line(journal + "max_load_N", r.journals[j].most);
    s.line(journal + "max_up_N", r.up[j].most);
    s.line(journal + "max_down_N", -r.up[j].least);
    s.line(journal + "max_lateral_N", r.lateral[j].most);
    s.line(journal + "min_lateral_N", r.lateral[j].least);
  }
}

/// What each foot presses on its mount over the cycle.
class MountRanges {
 public:
  MountRanges(const EngineFile& engine, const Mounts& mounts, double speed_rad_s)
      : free_(engine.definition(), engine.balancers()),
        mounts_{mounts},
        speed_rad_s_{speed_rad_s},
        rounding_N_{rounding_force_N(engine.definition(), speed_rad_s)} {}

  void take(double engine_deg, double tilting_Nm) {
    const FreeLoad load = free_.at(engine_deg, speed_rad_s_);
    for (std::size_t i = 0; i < kFeet; ++i) {
      const FootForce force = foot_force(mounts_, kFeetOf[i], load, tilting_Nm);
      up_[i].take(force.up_N);
      lateral_[i].take(force.lateral_N);
    }
  }
  void write(Summary& s) const {
    for (std::size_t i = 0; i < kFeet; ++i) {
      const std::string mount = std::string("mount_") + kFeetOf[i].name + "_";
      line(s, mount + "max_up_N", up_[i].most);
      line(s, mount + "max_down_N", -up_[i].least);
      line(s, mount + "max_lateral_N", lateral_[i].most);
      line(s, mount + "min_lateral_N", lateral_[i].least);
    }
  }

 private:
  void line(Summary& s, const std::string& name, double force_N) const {
    s.line(name, std::abs(force_N) > rounding_N_ ? force_N : 0);
  }

  FreeForces free_;
  Mounts mounts_;
  double speed_rad_s_;
  double rounding_N_;
  Range up_[kFeet];
  Range lateral_[kFeet];
};

/// None where the options do not say where the feet are.
std::optional<Mounts> mounts_of(const Arguments& arguments) {
  if (arguments.has("--mount-width-mm") != arguments.has("--mount-length-mm"))
    throw UsageError("--mount-width-mm and --mount-length-mm belong together; give both");
  if (!arguments.has("--mount-width-mm")) return {};
  return Mounts{arguments.number("--mount-width-mm") / 1e3, arguments.number("--mount-length-mm") / 1e3};
}

MountRanges mounts_by_angle(MountRanges ranges, const EngineDefinition& definition, double speed, double load_ratio) {
  TickProbe<double> probe(definition);
  for_each_angle(0.5, 720, [&](double deg) {
    const auto& out = probe.at(deg, speed, load_ratio);
    double tilting_Nm = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(definition.layout.cylinders); ++k)
      tilting_Nm += out.cylinder[k].tilting_moment_Nm;
    ranges.take(deg, tilting_Nm);
  });
  return ranges;
}

MountRanges mounts_of_trace(MountRanges ranges, const Trace& trace) {
  for (std::size_t i = 0; i < trace.crank_deg.size(); ++i) ranges.take(trace.crank_deg[i], trace.tilting_moment_Nm[i]);
  return ranges;
}

/// Names have their units in them: they are printed as CSV.
Summary figures_of_balance(const Arguments& arguments, const EngineFile& engine) {
  const std::optional<Mounts> mounts = mounts_of(arguments);
  engine.require(needed_sections());
  const EngineDefinition& definition = engine.definition();
  const double rpm = speed_rpm(arguments, engine);
  const double speed = rpm * kRad_sPerRpm;
  require_heat_to_scale(arguments, engine);
  ExactEngine exact;
  if (const Status refused = exact.init(definition); !refused.ok()) throw engine.explain(refused);
  const double load_ratio = arguments.number("--load-ratio");
  const GasOrder gas = gas_order(arguments, engine, 1);
  CycleSummary cycle;
  BearingRanges bearings;
  std::optional<MountRanges> feet;
  if (mounts) feet.emplace(engine, *mounts, speed);
  if (breathes(definition)) {
    if (rpm <= 0) throw UsageError("--rpm: an engine with gas exchange runs forward only; the speed must be above 0");
    const Trace trace = record_trace<double, scenes::Breathing>(definition, {rpm, 0, 1, gas});
    cycle = summarise(definition, speed, trace);
    bearings = bearings_of_trace(trace);
    if (feet) feet = mounts_of_trace(*feet, trace);
  } else {
    cycle = summarise(exact, speed, load_ratio);
    bearings = bearings_by_angle(definition, speed, load_ratio);
    if (feet) feet = mounts_by_angle(*feet, definition, speed, load_ratio);
  }

  const double rounding_Nm = kRoundingRatio * (cycle.largest_torque_Nm - cycle.smallest_torque_Nm);
  drop_rounding(cycle, rounding_Nm, swept_volume_m3(definition.crank) * definition.layout.cylinders);

  Summary s;
  s.line("speed_rpm", rpm);
  s.line("reciprocating_mass_kg", definition.masses.reciprocating_kg());
  s.line("mean_piston_speed_m_s", mean_piston_speed_m_s(definition.crank, speed));
  s.line("net_mep_kPa", cycle.net_mep_Pa / 1000);
  s.line("gross_mep_kPa", cycle.gross_mep_Pa / 1000);
  s.line("power_kW", cycle.power_W / 1000);
  if (definition.friction.any()) {
    s.line("friction_mep_kPa", cycle.brake.friction_mep_Pa / 1000);
    s.line("brake_torque_Nm", cycle.brake.torque_Nm);
    s.line("brake_power_kW", cycle.brake.power_W / 1000);
    s.line("mechanical_efficiency_ratio", cycle.brake.efficiency_ratio);
  }
  s.line("mean_torque_Nm", cycle.mean_torque_Nm);
  s.line("max_torque_Nm", cycle.largest_torque_Nm);
  s.line("max_torque_deg", cycle.largest_torque_deg);
  s.line("min_torque_Nm", cycle.smallest_torque_Nm);
  s.line("min_torque_deg", cycle.smallest_torque_deg);
  s.line("torque_fluctuation_ratio", cycle.fluctuation_ratio);
  for (const Harmonic& h : cycle.harmonics)
    write_wave(s, "torque_order_" + shortest(h.order), "Nm", h.cosine_Nm, h.sine_Nm, rounding_Nm);
  TurningWriter turning(s, definition, speed);
  for (const FreeOrder& order : free_orders(definition.crank))
    turning.write(order.name, reciprocating_order(definition, order.order));
  turning.write("rotating", balance_of(definition).rotating);
  if (!engine.balancers().empty()) {
    for (const FreeOrder& order : free_orders(definition.crank))
      turning.write_residual(definition, engine.balancers(), order);
  }
  write_bearings(s, bearings_of(definition).pins, bearings);
  if (feet) feet->write(s);
  return s;
}

int run_balance(const Arguments& arguments) {
  const EngineFile engine = read_engine_for_scenes(arguments, needed_sections());
  const Summary summary = figures_of_balance(arguments, engine);
  Output out(arguments.text_or_empty("--csv"));
  CsvWriter csv(out, {"name", "value"});
  for (const Figure& figure : summary.figures()) csv.row(figure.name, *figure.number);
  out.finish();
  return kSuccess;
}

constexpr Option kBalanceOptions[] = {
    kSpeed,
    kLoadRatio,
    kThrottle,
    kFuel,
    kLambda,
    kBurnStart,
    number("--mount-width-mm", "B", above(0).up_to(1e5),
           "between the left and right feet of four about the middle of the crankshaft: their forces, without weight"),
    number("--mount-length-mm", "L", above(0).up_to(1e5), "between the front and rear feet"),
    text("--csv", "F", "file for the table; default standard output"),
};

}  // namespace

const Command kBalance{"balance",
                       "torque harmonics, free forces and moments, bearing loads of the whole engine",
                       "FILE [--rpm N] [--load-ratio Q] [--throttle R] [--lambda L | --fuel-mg M] [--burn-start-deg A]"
                       " [--mount-width-mm B --mount-length-mm L] [--csv F]",
                       "crankloop balance diesel_495.ini --rpm 2000",
                       1,
                       kBalanceOptions,
                       run_balance,
                       false,
                       figures_of_balance};

}  // namespace crankloop::program
