#include "free_forces.hpp"

#include <cstdlib>

#include <crankloop/tabulate/elementary.hpp>

#include "../files/units.hpp"

namespace crankloop::program {
namespace {

void add(TurningForce& sum, const TurningForce& more) {
  sum.up_cos += more.up_cos;
  sum.up_sin += more.up_sin;
  sum.lateral_cos += more.lateral_cos;
  sum.lateral_sin += more.lateral_sin;
  sum.pitch_cos += more.pitch_cos;
  sum.pitch_sin += more.pitch_sin;
  sum.yaw_cos += more.yaw_cos;
  sum.yaw_sin += more.yaw_sin;
}

/// Per w^2, of an unbalance that turns at `turns` w.
TurningForce force_of(const Balancer& balancer, double arm_m) {
  const auto [sine, cosine] = elementary::sin_cos(balancer.angle_deg * kRadPerDeg);
  const double along = balancer.unbalance_kg_m * balancer.turns * balancer.turns;
  const double sense = balancer.turns < 0 ? -1 : 1;
  TurningForce force{};
  force.up_cos = along * cosine;
  force.up_sin = -sense * along * sine;
  force.lateral_cos = along * sine;
  force.lateral_sin = sense * along * cosine;
  force.pitch_cos = arm_m * force.up_cos;
  force.pitch_sin = arm_m * force.up_sin;
  force.yaw_cos = arm_m * force.lateral_cos;
  force.yaw_sin = arm_m * force.lateral_sin;
  return force;
}

}  // namespace

TurningForce balancer_order(const EngineDefinition& engine, const std::vector<Balancer>& balancers, int order) {
  const double middle_m = crankshaft_middle_m(engine.layout);
  TurningForce sum{};
  for (const Balancer& balancer : balancers) {
    if (std::abs(balancer.turns) == order) add(sum, force_of(balancer, balancer.position_m - middle_m));
  }
  return sum;
}

TurningForce free_force(const EngineDefinition& engine, const std::vector<Balancer>& balancers, int order) {
  TurningForce sum = reciprocating_order(engine, order);
  if (order == 1) add(sum, balance_of(engine).rotating);
  add(sum, balancer_order(engine, balancers, order));
  return sum;
}

FreeForces::FreeForces(const EngineDefinition& engine, const std::vector<Balancer>& balancers) {
  for (int order = 1; order <= kHighestFreeOrder; ++order) orders_[order - 1] = free_force(engine, balancers, order);
}

FreeLoad FreeForces::at(double engine_deg, double speed_rad_s) const {
  const double w2 = speed_rad_s * speed_rad_s;
  FreeLoad load;
  for (int order = 1; order <= kHighestFreeOrder; ++order) {
    const TurningForce& t = orders_[order - 1];
    const auto [sine, cosine] = elementary::sin_cos(order * engine_deg * kRadPerDeg);
    load.up_N += w2 * (t.up_cos * cosine + t.up_sin * sine);
    load.lateral_N += w2 * (t.lateral_cos * cosine + t.lateral_sin * sine);
    load.pitch_Nm += w2 * (t.pitch_cos * cosine + t.pitch_sin * sine);
    load.yaw_Nm += w2 * (t.yaw_cos * cosine + t.yaw_sin * sine);
  }
  return load;
}

FootForce foot_force(const Mounts& mounts, const Foot& foot, const FreeLoad& load, double tilting_Nm) {
  FootForce force{load.up_N / kFeet, load.lateral_N / kFeet};
  force.up_N -= foot.lateral * tilting_Nm / (2 * mounts.width_m);
  force.up_N += foot.along * load.pitch_Nm / (2 * mounts.length_m);
  force.lateral_N += foot.along * load.yaw_Nm / (2 * mounts.length_m);
  return force;
}

}  // namespace crankloop::program
