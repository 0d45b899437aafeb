#include "free_energy.hpp"

#include <algorithm>
#include <cmath>

#include <crankloop/tabulate/mechanism.hpp>

#include "../../engine_file/gas_order.hpp"

namespace crankloop::program {
namespace {

constexpr int kParts = 7200;  ///< of a cycle

bool any_misfires(const EngineDefinition& engine) {
  return std::any_of(engine.misfires, engine.misfires + engine.layout.cylinders,
                     [](const Misfire& rule) { return rule.pattern != MisfirePattern::none; });
}

}  // namespace

double EnergyBalance::missing_ratio() const noexcept {
  double largest = 0;
  for (const double energy_J : {gas_J, starter_J, friction_J, load_J, kinetic_J})
    largest = std::max(largest, std::fabs(energy_J));
  return largest > 0 ? missing_J() / largest : 0;
}

GasWork::GasWork(const ExactEngine& exact, const FreeOperation& operation)
    : cut_{operation.cut_cylinders}, firing_{curve_of(exact, operation.load_ratio)}, motored_{curve_of(exact, 0)} {
  const Layout& layout = exact.definition().layout;
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k)
    firing_deg_.push_back(layout.firing_deg[k]);
}

GasWork::Curve GasWork::curve_of(const ExactEngine& exact, double load_ratio) const {
  constexpr double kPart_deg = 720.0 / kParts;
  const double firing_deg = exact.definition().layout.firing_deg[0];
  const auto torque_Nm = [&](double own_deg) { return exact.forces(0, firing_deg + own_deg, 0, load_ratio).torque_Nm; };
  Curve curve;
  double sum_J = 0;
  double here_Nm = torque_Nm(0);
  for (int i = 0; i < kParts; ++i) {
    curve.work_J.push_back(sum_J);
    curve.torque_Nm.push_back(here_Nm);
    const double next_Nm = torque_Nm((i + 1) * kPart_deg);
    sum_J += kPart_deg * kRadPerDeg / 6 * (here_Nm + 4 * torque_Nm((i + 0.5) * kPart_deg) + next_Nm);  // Simpson's rule
    here_Nm = next_Nm;
  }
  curve.work_J.push_back(sum_J);
  curve.torque_Nm.push_back(here_Nm);
  return curve;
}

double GasWork::Curve::until_J(double own_deg) const {
  const double cycles = std::floor(own_deg / 720);
  const double place = (own_deg / 720 - cycles) * kParts;
  const auto i = static_cast<std::size_t>(std::min(place, kParts - 1.0));
  const double s = place - static_cast<double>(i);
  const double part_rad = 720.0 / kParts * kRadPerDeg;
  const double within_J = part_rad * s * (torque_Nm[i] + (torque_Nm[i + 1] - torque_Nm[i]) * s / 2);
  return cycles * work_J.back() + work_J[i] + within_J;
}

double GasWork::until_J(double angle_deg) const {
  double sum_J = 0;
  for (std::size_t k = 0; k < firing_deg_.size(); ++k) {
    sum_J += ((cut_ >> k & 1u) != 0 ? motored_ : firing_).until_J(angle_deg - firing_deg_[k]);
  }
  return sum_J;
}

double GasWork::backwards_Nm() const {
  const double cycle_J = until_J(720) - until_J(0);
  return cycle_J < 0 ? -2 * cycle_J / kCycle_rad : 0;
}

EnergyBooks::EnergyBooks(const ExactEngine& exact, const FreeOperation& operation, const FreeState& begin)
    : engine_{exact.definition()},
      gas_{exact, operation},
      backwards_Nm_{gas_.backwards_Nm()},
      by_torque_{breathes(engine_) || any_misfires(engine_) ||
                 (operation.schedule &&
                  (operation.schedule->drives("load_ratio") || operation.schedule->drives("cut_cylinders")))},
      begin_{begin} {}

double EnergyBooks::friction_Nm(double speed_rad_s) const noexcept {
  const double own_Nm = -brake_figures(engine_, 0, std::fabs(speed_rad_s)).torque_Nm;
  return speed_rad_s < 0 ? own_Nm + backwards_Nm_ : own_Nm;
}

double EnergyBooks::load_Nm(double speed_rad_s) const noexcept {
  const DrivenMachine& l = engine_.machine;
  const double w = std::fabs(speed_rad_s);
  return l.constant_Nm + w * (l.linear_Nm_s + w * l.quadratic_Nm_s2);
}

double EnergyBooks::inertia_kg_m2(double angle_deg) const noexcept {
  const Masses& m = engine_.masses;
  const double radius_m = engine_.crank.crank_radius_m;
  double sum = m.crank_inertia_kg_m2 + engine_.machine.inertia_kg_m2;
  for (std::size_t k = 0; k < static_cast<std::size_t>(engine_.layout.cylinders); ++k) {
    const Pose<double> p = exact_pose(engine_.crank, (angle_deg - engine_.layout.firing_deg[k]) * kRadPerDeg);
    sum += m.rod_big_end_kg * radius_m * radius_m + m.reciprocating_kg() * p.slope_m * p.slope_m +
           m.rod_inertia_correction_kg_m2 * p.rod_slope * p.rod_slope;
  }
  return sum;
}

double EnergyBooks::kinetic_J(const FreeState& at) const noexcept {
  return inertia_kg_m2(in_cycle_deg(at.angle_deg)) * at.speed_rad_s * at.speed_rad_s / 2;
}

void EnergyBooks::take(const FreeState& before, const FreeState& after, double starter_Nm) {
  const double tick_s = after.time_s - before.time_s;
  const double w0 = before.speed_rad_s;
  const double w1 = after.speed_rad_s;
  // Simpson's rule, with the speed in the middle of the tick by the cubic through both ends.
  const double middle = (w0 + w1) / 2 + tick_s / 8 * (before.acceleration_rad_s2 - after.acceleration_rad_s2);
  const auto work_J = [&](auto torque_Nm) {
    return tick_s / 6 *
           (torque_Nm(w0) * std::fabs(w0) + 4 * torque_Nm(middle) * std::fabs(middle) + torque_Nm(w1) * std::fabs(w1));
  };
  friction_J_ += work_J([this](double w) { return friction_Nm(w); });
  load_J_ += work_J([this](double w) { return load_Nm(w); });
  starter_J_ += tick_s / 2 * (starter_before_Nm_ * w0 + starter_Nm * w1);
  starter_before_Nm_ = starter_Nm;
  slowed_J_ += (inertia_kg_m2(in_cycle_deg(after.angle_deg)) - inertia_kg_m2(in_cycle_deg(before.angle_deg))) *
               (w0 * w0 + w1 * w1) / 4;
}

EnergyBalance EnergyBooks::balance(const FreeState& end) const {
  const double gas_J =
      by_torque_ ? end.work_J - begin_.work_J + slowed_J_ : gas_.between_J(begin_.angle_deg, end.angle_deg);
  return {gas_J, starter_J_, friction_J_, load_J_ + end.external_J - begin_.external_J,
          kinetic_J(end) - kinetic_J(begin_), by_torque_};
}

}  // namespace crankloop::program
