#include "run_accuracy.hpp"

#include <algorithm>
#include <cmath>

#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tick/crank/cylinder_forces.hpp>

#include "run_limits.hpp"
#include "valve_tick_limit.hpp"

namespace crankloop::program {
namespace {

constexpr int kAngles = 7919;  // a prime: no two angles of a cycle have the same fraction of a degree

double own_angle(const Layout& layout, std::size_t cylinder, double engine_deg) {
  const double deg = engine_deg - layout.firing_deg[cylinder];
  return deg < 0 ? deg + 720 : deg;
}

}  // namespace

void Deviation::take(double loop, double exact, double deg) noexcept {
  const double difference = std::abs(loop - exact);
  if (difference > largest) {
    largest = difference;
    at_deg = deg;
  }
  peak = std::max(peak, std::abs(exact));
}

WholeOutput<double> exact_output(const ExactEngine& engine, double engine_deg, double speed_rad_s, double load_ratio) {
  const EngineDefinition& definition = engine.definition();
  const detail::Bearings<double> bearings = bearings_of(definition);
  WholeOutput<double> out{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(definition.layout.cylinders); ++k) {
    const Pose<double> pose = exact_pose(definition.crank, own_angle(definition.layout, k, engine_deg) / kDegPerRad);
    out.displacement_m[k] = pose.displacement_m;
    out.velocity_m_s[k] = pose.slope_m * speed_rad_s;
    out.acceleration_m_s2[k] = pose.acceleration_m * speed_rad_s * speed_rad_s;
    out.rod_angle_rad[k] = pose.rod_angle_rad;
    out.rod_speed_rad_s[k] = pose.rod_slope * speed_rad_s;
    out.rod_acceleration_rad_s2[k] = pose.rod_curvature * speed_rad_s * speed_rad_s;
    out.cylinder[k] = engine.forces(static_cast<int>(k), engine_deg, speed_rad_s, load_ratio);
    out.torque_Nm += out.cylinder[k].torque_Nm;
    out.pin_radial_N[definition.layout.pin[k]] += out.cylinder[k].radial_force_N;
    out.pin_tangential_N[definition.layout.pin[k]] += out.cylinder[k].tangential_force_N;
  }
  for (std::size_t i = 0; i < bearings.pins; ++i) {
    out.pin_radial_N[i] -= bearings.rods_kg_m[i] * speed_rad_s * speed_rad_s;
    out.pin_load_N[i] = std::hypot(out.pin_radial_N[i], out.pin_tangential_N[i]);
  }
  return out;
}

template <class Real>
Accuracy measure_accuracy(const ExactEngine& engine, const Operation& operation) {
  const EngineDefinition& definition = engine.definition();
  const Layout& layout = definition.layout;
  Operation paced = operation;
  const double apart_s = 120 / operation.speed_rpm / kAngles;
  const double ticks = std::ceil(apart_s / longest_tick_of(definition));
  paced.tick_s = std::max(apart_s / ticks, kShortestTick_s);
  FixedStepLoop<Real> loop(definition, paced);

  Accuracy accuracy;
  accuracy.angles = kAngles;
  for (int i = 0; i < kAngles; ++i) {
    for (int tick = 0; tick < static_cast<int>(ticks); ++tick) loop.step();
    const WholeOutput<Real>& out = loop.output();
    const double engine_deg = loop.crank_deg();
    const WholeOutput<double> exact = exact_output(engine, engine_deg, operation.speed_rad_s(), operation.load_ratio);
    for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
      const QuantityValues<Real> in_loop = values_of(out, layout, k);
      const QuantityValues<double> of_exact = values_of(exact, layout, k);
      const double own_deg = own_angle(layout, k, engine_deg);
      for (std::size_t q = 0; q < kQuantities; ++q)
        accuracy.of[q].take(static_cast<double>(in_loop[q]), of_exact[q], own_deg);
    }
    accuracy.torque.take(static_cast<double>(out.torque_Nm), exact.torque_Nm, engine_deg);
  }
  return accuracy;
}

template Accuracy measure_accuracy<float>(const ExactEngine&, const Operation&);
template Accuracy measure_accuracy<double>(const ExactEngine&, const Operation&);

}  // namespace crankloop::program
