#include "stress_trial.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tabulate/valve_lift.hpp>
#include <crankloop/tick/step.hpp>

#include "../reference/valve_reference.hpp"
#include "crankloop/files/number.hpp"
#include "crankloop/files/units.hpp"
#include "stress_comparison.hpp"
#include "stress_energy.hpp"

namespace crankloop::program {
namespace {

using valve_reference::SingleMass;

/// One cylinder with one valve and all its outputs.
struct StressedValve : Scene {
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr bool theoretical_lift = true;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_results = true;
};

EngineDefinition engine_with(const ValveTrain& train) {
  EngineDefinition engine;
  engine.crank.bore_m = 0.05;
  engine.crank.crank_radius_m = 0.03;
  engine.crank.rod_length_m = 0.1;
  engine.masses.piston_kg = 0.1;
  engine.train_count = 1;
  engine.trains[0] = train;
  return engine;
}

Phase phase_at(double deg) {
  return Phase{static_cast<std::uint64_t>(static_cast<long double>(deg) / 720 * 18446744073709551616.0L)};
}

/// Fine steps that a tick needs by docs/decisions/0014: the fastest rate times a fine step at most 1 for 0.1 um and
/// coarser classes, and smaller by the fourth root for finer ones.
double fine_steps_needed(const SingleMass& mass, const TickOptions& options) {
  return options.tick_s * mass.fastest() / std::min(1.0, std::pow(options.valves.accuracy_m / 0.1e-6, 0.25));
}

/// Whether a refused case could have run, computed independently of the library.
bool could_run(const StressCase& drawn, const Status& refused) {
  if (refused.field == std::string_view("rocker.base_circle_m")) {
    // Smoothing bends a table's contour by some hundredths of the base circle.
    return drawn.smallest_radius_m() > 0.1 * drawn.train.rocker.base_circle_m;
  }
  if (refused.field != std::string_view("options.tick_s") || refused.reason != Reason::out_of_range) return true;
  ValveLift lift;
  if (!lift.init(drawn.train.cam, drawn.train.rocker).ok()) return true;
  const SingleMass mass(drawn.train.valve, drawn.train.rocker, lift.largest_lift_m());
  return fine_steps_needed(mass, drawn.options) < 512 - 1;
}

template <class Real>
struct Rig {
  TableStorage<Real, StressedValve> tables;
  Engine<Real, StressedValve> engine;
};

double cam_deg_at(Phase engine, double full_lift_deg) {
  const auto of_cam = static_cast<std::int64_t>((engine - phase_at(full_lift_deg)).units());
  return static_cast<double>(static_cast<long double>(of_cam) * (360.0L / 18446744073709551616.0L));
}

/// Number of ticks to compare, limited by the reference's steps.
int ticks_to_compare(const SingleMass& mass, const TickOptions& options, double cam_rad_s, double ticks_per_cycle) {
  const double turned_deg = std::fabs(cam_rad_s) * options.tick_s / kRadPerDeg;
  const double steps_per_tick = std::max({1.0, options.tick_s * mass.fastest() / 0.4, turned_deg / 0.25});
  return static_cast<int>(
      std::min(kReferenceCycles * ticks_per_cycle, std::max(1.0, kReferenceSteps / steps_per_tick)));
}

template <class Real>
void run_ticks(Rig<Real>& rig, const StressCase& drawn, int copies, TrialResult& result) {
  ValveLift lift;
  static_cast<void>(lift.init(drawn.train.cam, drawn.train.rocker));  // build() accepted it
  const SingleMass mass(drawn.train.valve, drawn.train.rocker, lift.largest_lift_m());
  typename Engine<Real, StressedValve>::Input in;
  in.speed_rad_s = static_cast<Real>(drawn.speed_rad_s());
  const double cam_rad_s = static_cast<double>(in.speed_rad_s) / 2;
  const double ticks_per_cycle = 360 * kRadPerDeg / std::max(1e-30, std::fabs(cam_rad_s)) / drawn.options.tick_s;
  const double wanted = kStressCycles * ticks_per_cycle;
  result.all_cycles = wanted < kStressTicks;
  result.ticks = result.all_cycles ? static_cast<int>(wanted) + 1 : kStressTicks;

  auto& engine = rig.engine;
  const auto& curve = rig.tables.tables().lift_curves[0];
  const double full_lift_deg = drawn.train.cam.full_lift_deg;
  EnergyBound energy(mass, LiftFacts(lift), cam_rad_s);
  SingleMass of_reference = mass;
  of_reference.M *= drawn.reference_mass_ratio;
  Comparison comparison(drawn, of_reference, lift, cam_deg_at(engine.state().phase, full_lift_deg),
                        static_cast<double>(rig.tables.tables().valve_motions[0].fine_step_s),
                        sizeof(Real) == 4 ? 0x1p-24 : 0, copies);
  const int compared_ticks = copies > 0 ? ticks_to_compare(mass, drawn.options, cam_rad_s, ticks_per_cycle) : 0;
  const auto diverged = [&](int tick, const char* how) {
    result.verdict = Verdict::diverged;
    result.trouble = std::string(how) + " in tick " + std::to_string(tick);
  };
  for (int tick = 0; tick < result.ticks; ++tick) {
    const std::uint64_t before = engine.state().phase.units() - curve.opens[0];
    const auto& out = engine.step(in);
    const auto& valve = out.valve[0][0];
    const auto& force = out.valve_forces[0][0];
    if ((out.faults & ~std::uint32_t{kFaultEventBudget}) != 0)
      return diverged(tick, "a fault other than the event budget");
    result.over_budget = result.over_budget || out.faults != 0;
    for (const Real x : {valve.lift_m, valve.velocity_m_s, valve.acceleration_m_s2, valve.theoretical_lift_m,
                         force.train_N, force.seat_N, force.tip_N, force.cam_N, force.train_compression_m}) {
      if (!std::isfinite(x)) return diverged(tick, "not finite");
    }
    energy.tick(static_cast<double>(valve.lift_m), static_cast<double>(valve.velocity_m_s));
    if (curve.passes_base_circle(before, engine.state().phase.units() - curve.opens[0]) &&
        !energy.cycle(out.valve_cycle[0][0].contact_changes)) {
      return diverged(tick, "more energy than the train can supply");
    }
    if (tick < compared_ticks) {
      comparison.tick(cam_deg_at(engine.state().phase, full_lift_deg), static_cast<double>(valve.lift_m),
                      engine.state().valve_lift_m[0] == 0 && engine.state().valve_velocity_m_s[0] == 0);
    }
  }
  constexpr double kMaxChangesInACycle = 1000;  // for the cycle that has not ended
  if (!energy.cycle(kMaxChangesInACycle)) return diverged(result.ticks, "more energy than the train can supply");
  if (compared_ticks == 0) return;
  result.compared = true;
  result.landed = comparison.landed();
  result.of_class = comparison.of_class();
  result.of_allowed = comparison.of_allowed();
  if (result.of_allowed > 1 && !result.over_budget) {
    result.verdict = Verdict::inaccurate;
    result.trouble = brief(result.of_class) + " times the requested accuracy, " + brief(result.of_allowed) +
                     " times the permitted error";
  }
}

/// Runs a case; compares it with the reference and this many copies, not at all if 0.
template <class Real>
TrialResult run_in(Rig<Real>& rig, const StressCase& drawn, int copies) {
  TrialResult result;
  result.refusal = rig.tables.build(engine_with(drawn.train), drawn.options);
  if (result.refusal.ok()) result.refusal = rig.engine.init(rig.tables.tables(), phase_at(drawn.start_deg));
  if (result.refusal.ok()) {
    run_ticks(rig, drawn, copies, result);
  } else if (could_run(drawn, result.refusal)) {
    result.verdict = Verdict::wrongly_refused;
    result.trouble = std::string(result.refusal.field) + " " + describe(result.refusal.reason);
  } else {
    result.verdict = Verdict::refused;
  }
  return result;
}

}  // namespace

struct StressTrials::Engines {
  Rig<float> in_float;
  Rig<double> in_double;
};

StressTrials::StressTrials() : engines_{std::make_unique<Engines>()} {}
StressTrials::~StressTrials() = default;

TrialResult StressTrials::run(const StressCase& drawn, bool compare) {
  const auto run = [&](int copies) {
    return drawn.in_float ? run_in(engines_->in_float, drawn, copies) : run_in(engines_->in_double, drawn, copies);
  };
  TrialResult result = run(compare ? kCopies : 0);
  if (result.verdict != Verdict::inaccurate) return result;
  result = run(kMoreCopies);
  result.judged_again = true;
  return result;
}

}  // namespace crankloop::program
