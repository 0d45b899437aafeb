#include "crank_dynamics.hpp"

#include <cstddef>

#include <crankloop/limits.hpp>
#include <crankloop/tabulate/mechanism.hpp>

#include "curve_fit.hpp"

namespace crankloop::detail {
namespace {

/// The part of J_eff that changes with the angle, of all cylinders.
[[nodiscard]] double moving_kg_m2(const EngineDefinition& engine, double engine_rad) noexcept {
  double sum = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(engine.layout.cylinders); ++k) {
    const Pose<double> p = exact_pose(engine.crank, engine_rad - engine.layout.firing_deg[k] * kRadPerDegree);
    sum += engine.masses.reciprocating_kg() * p.slope_m * p.slope_m +
           engine.masses.rod_inertia_correction_kg_m2 * p.rod_slope * p.rod_slope;
  }
  return sum;
}

/// Smallest J_eff; 0 if its ratio to the largest is too small.
[[nodiscard]] double least_inertia_kg_m2(const EngineDefinition& engine, double turning_kg_m2) noexcept {
  double least = turning_kg_m2 + moving_kg_m2(engine, 0);
  double most = least;
  for (int degree = 1; degree < kDegreesPerTurn; ++degree) {
    const double here = turning_kg_m2 + moving_kg_m2(engine, degree * kRadPerDegree);
    if (here < least) least = here;
    if (here > most) most = here;
  }
  return least < kLeastInertia_ratio * most ? 0 : least;
}

}  // namespace

double speed_limit_rad_s(const EngineDefinition& engine, const TickOptions& options) noexcept {
  double limit_rad_s = kMaxSpeed_rad_s;
  // Slightly less than one revolution per tick, so that rounding cannot raise the phase increment to half a cycle.
  const double one_turn_rad_s = 0.4999 * kRadPerCycle / options.tick_s;
  if (one_turn_rad_s < limit_rad_s) limit_rad_s = one_turn_rad_s;
  // The maximum speed itself is a valid input, also when a caller rounds it to float.
  constexpr double kRounding = 1 + 1e-6;
  const double given_rad_s =
      kRounding * (options.max_speed_rad_s != 0 ? options.max_speed_rad_s : engine.crank.max_speed_rad_s);
  return given_rad_s != 0 && given_rad_s < limit_rad_s ? given_rad_s : limit_rad_s;
}

double widest_turn_deg(const EngineDefinition& engine, const TickOptions& options) noexcept {
  constexpr double kRounding = 1 + 1e-6;  // of the limit and of the angle, in float
  return kRounding * speed_limit_rad_s(engine, options) * options.tick_s / kRadPerDegree;
}

template <class Real>
CrankDynamics<Real> crank_dynamics_of(const EngineDefinition& engine, const TickOptions& options) noexcept {
  const Masses& masses = engine.masses;
  const DrivenMachine& machine = engine.machine;
  const Friction& friction = engine.friction;
  const Starter& starter = engine.starter;
  const double radius = engine.crank.crank_radius_m;
  const double cylinders = engine.layout.cylinders;
  const double turning =
      masses.crank_inertia_kg_m2 + machine.inertia_kg_m2 + cylinders * masses.rod_big_end_kg * radius * radius;
  // The work of a mean effective pressure over a cycle is the pressure times the swept volume; the mean torque is that
  // work / (4 pi).
  const double per_Pa = cylinders * swept_volume_m3(engine.crank) / kRadPerCycle;
  const auto to_real = [](double x) { return static_cast<Real>(x); };
  return {to_real(turning),
          to_real(least_inertia_kg_m2(engine, turning)),
          to_real(machine.constant_Nm + friction.constant_Pa * per_Pa),
          to_real(machine.linear_Nm_s + friction.linear_Pa_s * per_Pa),
          to_real(machine.quadratic_Nm_s2 + friction.quadratic_Pa_s2 * per_Pa),
          to_real(starter.stall_Nm),
          to_real(starter.stall_Nm > 0 ? starter.stall_Nm / starter.no_load_rad_s : 0),
          to_real(2 * speed_limit_rad_s(engine, options) / options.tick_s)};
}

template CrankDynamics<float> crank_dynamics_of(const EngineDefinition&, const TickOptions&) noexcept;
template CrankDynamics<double> crank_dynamics_of(const EngineDefinition&, const TickOptions&) noexcept;

}  // namespace crankloop::detail
