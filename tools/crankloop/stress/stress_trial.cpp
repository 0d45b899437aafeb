#include "stress_trial.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tabulate/valve_lift.hpp>
#include <crankloop/tick/engine_step.hpp>

#include "../number.hpp"
#include "../reference/valve_reference.hpp"

namespace crankloop::program {
namespace {

using valve_test::Reference;
using valve_test::SingleMass;
using valve_test::TurnedCam;

constexpr double kRadPerDeg = 3.14159265358979323846 / 180;

/// One cylinder's one valve, everything that is told of it.
struct StressedValve : Scene {
  static constexpr ValveModel valves = ValveModel::elastic;
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

/// What the tables of a train say of it, found by looking at its lift.
struct LiftFacts {
  double largest_m = 0;
  double fastest_per_rad_m = 0;
  double variation_per_rad_m = 0;  ///< of the slope over a turn: all its rises and falls

  explicit LiftFacts(const ValveLift& lift) : largest_m{lift.largest_lift_m()} {
    double before = 0;
    for (int deg = -180; deg <= 180; ++deg) {
      const double slope = lift.at(deg * kRadPerDeg).per_rad_m;
      fastest_per_rad_m = std::max(fastest_per_rad_m, std::fabs(slope));
      variation_per_rad_m += std::fabs(slope - before);
      before = slope;
    }
  }
};

/// sqrt(2 E / M) of a valve against the most that a train can have given it.
class EnergyBound {
 public:
  EnergyBound(const SingleMass& mass, const LiftFacts& lift, double cam_rad_s)
      : mass_{mass},
        fastest_m_s_{lift.fastest_per_rad_m * std::fabs(cam_rad_s)},
        turned_m_s_{lift.variation_per_rad_m * std::fabs(cam_rad_s)} {
    const double train_N = mass.P + mass.k_s * lift.largest_m;
    const double at_rest_J = energy_J(lift.largest_m, 0) + train_N * train_N / (2 * mass.k);
    allowed_m_s_ = std::sqrt(2 * at_rest_J / mass.M) + fastest_m_s_ + turned_m_s_;
  }

  void tick(double y_m, double v_m_s) { reached_J_ = std::max(reached_J_, energy_J(y_m, v_m_s)); }

  /// True while the cycle that ended kept the bound.
  bool cycle(double contact_changes) {
    allowed_m_s_ += turned_m_s_ + 2 * fastest_m_s_ * contact_changes;
    return std::sqrt(2 * reached_J_ / mass_.M) <= 2 * allowed_m_s_;
  }

 private:
  /// Motion, spring and seat, from the closed valve.
  [[nodiscard]] double energy_J(double y, double v) const {
    const double sink = std::max(0.0, mass_.delta - y);
    return mass_.M * v * v / 2 + mass_.k_s * y * y / 2 + mass_.P * y +
           mass_.k_z * (sink * sink - mass_.delta * mass_.delta) / 2;
  }

  const SingleMass& mass_;
  double fastest_m_s_;
  double turned_m_s_;
  double allowed_m_s_ = 0;
  double reached_J_ = 0;
};

/// The reference and its knocked copies, in step with an engine.
class Comparison {
 public:
  /// `fine_s` and `rounding` of the engine's steps; rounding 0 for double.
  Comparison(const StressCase& drawn, const SingleMass& mass, const ValveLift& lift, double cam_deg, double fine_s,
             double rounding)
      : accuracy_m_{drawn.options.valves.accuracy_m},
        runge_kutta_{drawn.options.valves.integrator == Integrator::rk4},
        tick_s_{drawn.options.tick_s},
        rounding_{rounding * std::sqrt(std::max(1.0, tick_s_ / fine_s))},
        speed_per_lift_{(mass.k + mass.k_s) / mass.M * fine_s},
        cam_deg_{cam_deg},
        draw_{drawn.own_seed} {
    const TurnedCam cam(lift);
    all_.assign(1 + kCopies, Reference(mass, cam));
    // At rest where the cam stands, as the engine begins.
    const double Y = lift.at(cam_deg * kRadPerDeg).lift_m;
    const double open_m = (mass.k * Y - mass.P) / (mass.k + mass.k_s);
    const double pushed_m = mass.k * Y / (mass.k + mass.k_z + mass.k_s);
    for (Reference& one : all_) {
      if (open_m > mass.delta) {
        one.y = open_m, one.regime = kTrainOn;
      } else if (Y > pushed_m) {
        one.y = pushed_m, one.regime = kTrainOn | kSeatOn;
      }
    }
  }

  /// A tick in which the cam turned on to `cam_deg`, and the lift that the engine has after it.
  void tick(double cam_deg, double lift_m, bool asleep) {
    double turned = cam_deg - cam_deg_;
    turned -= 360 * std::floor(turned / 360 + 0.5);
    const Reference& exact = all_[0];
    bool resting = asleep;
    double apart_m = 0;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      Reference& one = all_[i];
      const Touch before{one.v, one.regime, one.changes};
      if (i > 0 && starts_ && turned != 0) knock(one, kTrainOn & one.regime, before.v_m_s, turned / tick_s_);
      one.advance(tick_s_, cam_deg_, cam_deg_ + turned);
      if (i > 0) {
        apart_m = std::max(apart_m, std::fabs(one.y - exact.y));
        if (one.changes != before.changes) {
          const std::uint32_t seen = one.regime ^ before.regime;
          const std::uint32_t changed = seen != 0 ? seen : kTrainOn | kSeatOn;  // came and went within the tick
          knock(one, changed, std::fabs(before.v_m_s) > std::fabs(one.v) ? before.v_m_s : one.v, turned / tick_s_);
        }
        round(one);
      }
      resting = resting && std::fabs(one.y) < kForgotten_m;
    }
    starts_ = false;
    cam_deg_ = cam_deg;
    magnified_m_ = resting ? 0 : std::max(magnified_m_, apart_m);
    const double error_m = std::fabs(lift_m - exact.y);
    of_class_ = std::max(of_class_, error_m / (accuracy_m_ + kForgotten_m));
    of_allowed_ = std::max(of_allowed_, error_m / (kMagnified * (accuracy_m_ + magnified_m_) + kForgotten_m));
  }

  [[nodiscard]] double of_class() const { return of_class_; }
  [[nodiscard]] double of_allowed() const { return of_allowed_; }

 private:
  static constexpr double kForgotten_m = 2e-9;  ///< what a valve that goes to sleep forgets, and the lift's table

  struct Touch {
    double v_m_s;
    std::uint32_t regime;
    int changes;
  };

  /// By the accuracy asked for, or by what that is worth in a vibration as wide as the speed at a contact makes one. The
  /// cam that starts to turn under an open valve is such a contact too.
  void knock(Reference& one, std::uint32_t contacts, double v_m_s, double cam_deg_per_s) {
    if (contacts == 0) return;
    const SingleMass& m = one.mass();
    double amplitude_m = 0;
    if ((contacts & kTrainOn) != 0) {
      const double apart_m_s = v_m_s - one.cam(cam_deg_, cam_deg_per_s).Yd;
      amplitude_m = std::fabs(apart_m_s) / std::sqrt((m.k + m.k_s) / m.M);
    }
    if ((contacts & kSeatOn) != 0)
      amplitude_m = std::max(amplitude_m, std::fabs(v_m_s) / std::sqrt((m.k_z + m.k_s) / m.M));
    const double knock_m = accuracy_m_ * (runge_kutta_ ? std::max(1.0, amplitude_m / kClassAmplitude_m) : 1);
    one.y += draw_.one_in(2) ? knock_m : -knock_m;
  }

  /// What rounding of lift, speed and the gap times the stiffness does in the fine steps of a tick: a random walk.
  void round(Reference& one) {
    if (rounding_ == 0 || one.regime == kSeatOn) return;
    const double lift_m = rounding_ * std::fabs(one.y);
    one.y += lift_m * draw_.between(-1, 1);
    one.v += (rounding_ * std::fabs(one.v) + lift_m * speed_per_lift_) * draw_.between(-1, 1);
  }

  double accuracy_m_;
  bool runge_kutta_;
  double tick_s_;
  double rounding_;
  double speed_per_lift_;
  double cam_deg_;
  Draws draw_;
  std::vector<Reference> all_;  ///< the exact one, then the copies
  bool starts_ = true;
  double magnified_m_ = 0;
  double of_class_ = 0;
  double of_allowed_ = 0;
};

/// Fine steps that a tick needs by docs/decisions/0007: the open valve's rate times a whole step at most 1.5, the fastest
/// times a fine one at most 0.3 for 0.1 um, of fourth order, and 0.9.
double fine_steps_needed(const SingleMass& mass, const TickOptions& options) {
  const double open = std::sqrt((mass.k + mass.k_s) / mass.M);
  const double zeta = (mass.b + mass.c) / (2 * mass.M * open);
  const double open_rate = zeta <= 1 ? open : open * (zeta + std::sqrt(zeta * zeta - 1));
  const double fine_rate = std::min(0.9, 0.3 * std::pow(options.valves.accuracy_m / 0.1e-6, 0.25));
  const double whole = std::ceil(options.tick_s * open_rate / 1.5);
  return options.tick_s * mass.fastest() / fine_rate + whole;
}

/// Whether a refused case could have run, by what this file works out by itself.
bool could_run(const StressCase& drawn, const Status& refused) {
  if (refused.field == std::string_view("rocker.base_circle")) {
    // Smoothing bends a table's contour by some hundredths of the base circle.
    return drawn.smallest_radius_m() > 0.1 * drawn.train.rocker.base_circle_m;
  }
  if (refused.field != std::string_view("tick.tick") || refused.reason != Reason::out_of_range) return true;
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

/// How far a comparison goes: whole ticks of the reference's steps.
int ticks_to_compare(const SingleMass& mass, const TickOptions& options, double cam_rad_s, double ticks_per_cycle) {
  const double turned_deg = std::fabs(cam_rad_s) * options.tick_s / kRadPerDeg;
  const double steps_per_tick = std::max({1.0, options.tick_s * mass.fastest() / 0.4, turned_deg / 0.25});
  return static_cast<int>(
      std::min(kReferenceCycles * ticks_per_cycle, std::max(1.0, kReferenceSteps / steps_per_tick)));
}

template <class Real>
void run_ticks(Rig<Real>& rig, const StressCase& drawn, bool compare, TrialResult& result) {
  ValveLift lift;
  static_cast<void>(lift.init(drawn.train.cam, drawn.train.rocker));  // build() took it
  const SingleMass mass(drawn.train.valve, drawn.train.rocker, lift.largest_lift_m());
  typename Engine<Real, StressedValve>::Input in;
  in.speed_rad_s = static_cast<Real>(drawn.speed_rad_s());
  const double cam_rad_s = static_cast<double>(in.speed_rad_s) / 2;
  const double ticks_per_cycle = 360 * kRadPerDeg / std::max(1e-30, std::fabs(cam_rad_s)) / drawn.options.tick_s;
  const double wanted = kStressCycles * ticks_per_cycle;
  result.all_cycles = wanted < kMostTicks;
  result.ticks = result.all_cycles ? static_cast<int>(wanted) + 1 : kMostTicks;

  auto& engine = rig.engine;
  const auto& curve = rig.tables.tables().lift_curves[0];
  const double full_lift_deg = drawn.train.cam.full_lift_deg;
  EnergyBound energy(mass, LiftFacts(lift), cam_rad_s);
  SingleMass of_reference = mass;
  of_reference.M *= drawn.reference_mass_ratio;
  Comparison comparison(drawn, of_reference, lift, cam_deg_at(engine.state().phase, full_lift_deg),
                        static_cast<double>(rig.tables.tables().valve_motions[0].fine_s),
                        sizeof(Real) == 4 ? 0x1p-24 : 0);
  const int compared_ticks = compare ? ticks_to_compare(mass, drawn.options, cam_rad_s, ticks_per_cycle) : 0;
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
      return diverged(tick, "a fault other than the event budget's");
    result.over_budget = result.over_budget || out.faults != 0;
    for (const Real x : {valve.lift_m, valve.velocity_m_s, valve.acceleration_m_s2, valve.theoretical_lift_m,
                         force.train_N, force.seat_N, force.tip_N, force.cam_N, force.gap_m}) {
      if (!std::isfinite(x)) return diverged(tick, "not finite");
    }
    energy.tick(static_cast<double>(valve.lift_m), static_cast<double>(valve.velocity_m_s));
    if (curve.passes_base_circle(before, engine.state().phase.units() - curve.opens[0]) &&
        !energy.cycle(out.valve_cycle[0][0].contact_changes)) {
      return diverged(tick, "more energy than the train can have given");
    }
    if (tick < compared_ticks) {
      comparison.tick(cam_deg_at(engine.state().phase, full_lift_deg), static_cast<double>(valve.lift_m),
                      engine.state().valve[0][0].asleep != 0);
    }
  }
  constexpr double kMostChangesInACycle = 1000;  // of the cycle that has not ended
  if (!energy.cycle(kMostChangesInACycle)) return diverged(result.ticks, "more energy than the train can have given");
  if (compared_ticks == 0) return;
  result.compared = true;
  result.of_class = comparison.of_class();
  result.of_allowed = comparison.of_allowed();
  if (result.of_allowed > 1 && !result.over_budget) {
    result.verdict = Verdict::inaccurate;
    result.trouble = brief(result.of_class) + " times the accuracy asked for, " + brief(result.of_allowed) +
                     " times what the motion magnifies it to";
  }
}

template <class Real>
TrialResult run_in(Rig<Real>& rig, const StressCase& drawn, bool compare) {
  TrialResult result;
  result.refusal = rig.tables.build(engine_with(drawn.train), drawn.options);
  if (result.refusal.ok()) result.refusal = rig.engine.init(rig.tables.tables(), phase_at(drawn.start_deg));
  if (result.refusal.ok()) {
    run_ticks(rig, drawn, compare, result);
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
  return drawn.in_float ? run_in(engines_->in_float, drawn, compare) : run_in(engines_->in_double, drawn, compare);
}

}  // namespace crankloop::program
