#include <crankloop/tabulate/tabulate.hpp>

#include <cstddef>

#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tabulate/summary.hpp>

#include "contact_curves.hpp"
#include "crank_dynamics.hpp"
#include "curve_fit.hpp"
#include "cylinder_groups.hpp"
#include "fingerprint.hpp"
#include "gas_curves.hpp"
#include "gas_exchange.hpp"
#include "misfire_rules.hpp"
#include "phase_units.hpp"
#include "reluctor_table.hpp"
#include "rounding.hpp"
#include "sensor_faults.hpp"
#include "trigger_tracks.hpp"
#include "valve_curves.hpp"
#include "wheel_fault_tracks.hpp"

namespace crankloop {

using namespace detail;

using detail::kRadPerCycle;

namespace {

constexpr double kSameAngleDeg = 1e-9;

template <class Real>
void fill_drive(const EngineDefinition& engine, const TickOptions& options, Drive<Real>& drive) noexcept {
  drive = {};
  drive.tick_s = static_cast<Real>(options.tick_s);
  drive.per_tick_s = static_cast<Real>(1 / options.tick_s);
  drive.trains = static_cast<std::uint32_t>(engine.train_count);
  for (int t = 0; t < engine.train_count; ++t) {
    const Valve& valve = engine.trains[t].valve;
    const auto modes = static_cast<std::uint32_t>((valve.inner_spring_N_m > 0 ? 2 : 1) * valve.surge_modes);
    if (modes > drive.spring_modes) drive.spring_modes = modes;
  }
  drive.cycles_per_tick_per_rad_s = static_cast<Real>(options.tick_s / kRadPerCycle);
  drive.rad_s_per_cycle_per_tick = static_cast<Real>(kRadPerCycle / options.tick_s);
  drive.speed_limit_rad_s = static_cast<Real>(detail::speed_limit_rad_s(engine, options));
  const Layout& layout = engine.layout;
  drive.cylinders = static_cast<std::uint32_t>(layout.cylinders);
  double mechanism_deg[kMaxCylinders] = {};
  for (std::size_t k = 0; k < drive.cylinders; ++k) {
    const double firing = layout.firing_deg[k];
    std::uint32_t m = 0;
    std::uint8_t turn = 0;
    for (; m < drive.mechanisms; ++m) {
      const double apart = firing - mechanism_deg[m];
      const auto near = [&](double deg) { return apart > deg - kSameAngleDeg && apart < deg + kSameAngleDeg; };
      turn = near(360) || near(-360) ? 1 : 0;
      if (turn == 1 || near(0)) break;
    }
    if (m == drive.mechanisms) {
      mechanism_deg[m] = firing;
      drive.firing_phase[m] = detail::phase_units(firing);
      if constexpr (sizeof(Real) == 4)
        drive.firing_phase[m] = (drive.firing_phase[m] + 0x8000'0000u) & ~std::uint64_t{0xFFFF'FFFF};
      ++drive.mechanisms;
    }
    drive.mechanism_of[k] = static_cast<std::uint8_t>(m);
    drive.turn_of[k] = turn;
  }
  drive.by_mechanism = detail::grouped(drive.mechanism_of, drive.cylinders, drive.mechanisms);
}

/// Refuses targets that lack a section which another of them needs.
template <class Real>
[[nodiscard]] Status validate(const TableTargets<Real>& t) noexcept {
  const bool pressure = t.pressure_full != nullptr || t.pressure_motored != nullptr || t.pressure_heat != nullptr;
  const bool torque = t.gas_torque_full != nullptr || t.gas_torque_motored != nullptr || t.gas_torque_heat != nullptr;
  if (pressure && t.gas_grid == nullptr) return refuse("targets.gas_grid", Reason::missing_table);
  if (torque && t.torque_grid == nullptr) return refuse("targets.torque_grid", Reason::missing_table);
  if (t.cut_torque != nullptr && t.cut_grid == nullptr) return refuse("targets.cut_grid", Reason::missing_table);
  if ((t.gas_grid != nullptr || t.torque_grid != nullptr || t.cut_grid != nullptr) && t.gas_capacity < kDegreesPerCycle)
    return refuse("targets.gas_capacity", Reason::out_of_range);
  if ((t.gas_torque_full != nullptr) != (t.gas_full != nullptr))
    return refuse("targets.gas_full", Reason::missing_table);
  if ((t.gas_torque_motored != nullptr) != (t.gas_motored != nullptr))
    return refuse("targets.gas_motored", Reason::missing_table);
  if ((t.cut_torque != nullptr) != (t.cut_heat != nullptr)) return refuse("targets.cut_heat", Reason::missing_table);
  const bool all_of_lift = t.lift_segments != nullptr && t.rocker_ratios != nullptr;
  if (t.lift_curves != nullptr && !all_of_lift) return refuse("targets.lift_segments", Reason::missing_table);
  if ((t.near_cams != nullptr || t.near_lobes != nullptr || t.cycle_ends != nullptr) && t.lift_curves == nullptr)
    return refuse("targets.lift_curves", Reason::missing_table);
  if ((t.cam_contacts != nullptr || t.cam_torques != nullptr) && (t.lift_curves == nullptr || t.cam_sliding == nullptr))
    return refuse(t.lift_curves == nullptr ? "targets.lift_curves" : "targets.cam_sliding", Reason::missing_table);
  if (t.cam_contacts != nullptr && t.cam_contact_segments == nullptr)
    return refuse("targets.cam_contact_segments", Reason::missing_table);
  if ((t.gas_torque_heat != nullptr) != (t.gas_heat != nullptr))
    return refuse("targets.gas_heat", Reason::missing_table);
  if (t.triggers != nullptr && t.trigger_tracks == nullptr)
    return refuse("targets.trigger_tracks", Reason::missing_table);
  if (t.triggers != nullptr && t.trigger_edges == nullptr)
    return refuse("targets.trigger_edges", Reason::missing_table);
  const bool all_of_faults = t.fault_edges != nullptr && t.fault_tracks != nullptr && t.wheel_fault_rules != nullptr;
  if (t.wheel_faults != nullptr && !all_of_faults) return refuse("targets.fault_tracks", Reason::missing_table);
  return {};
}

template <class Real>
void fill_mechanism(const EngineDefinition& engine, const TableTargets<Real>& t) noexcept {
  const Crank& crank = engine.crank;
  const auto quantity = [&crank](PoseMember member) {
    return [&crank, member](double angle) { return exact_pose(crank, angle).*member; };
  };
  const auto slope = quantity(&Pose<double>::slope_m);
  const auto displacement = quantity(&Pose<double>::displacement_m);
  if (t.stroke != nullptr) detail::fill(*t.stroke, slope, displacement);
  if (t.motion != nullptr) {
    detail::fill(*t.motion, &MotionSegment<Real>::displacement, &MotionSegment<Real>::slope, slope, displacement);
    detail::fill(*t.motion, &MotionSegment<Real>::acceleration, quantity(&Pose<double>::acceleration_m));
  }
  if (t.lean != nullptr) {
    detail::fill(*t.lean, &LeanSegment<Real>::tilt, quantity(&Pose<double>::rod_tilt));
    detail::fill(*t.lean, &LeanSegment<Real>::radial, quantity(&Pose<double>::radial));
  }
  if (t.rod != nullptr) {
    detail::fill(*t.rod, &RodSegment<Real>::angle, &RodSegment<Real>::slope, quantity(&Pose<double>::rod_slope),
                 quantity(&Pose<double>::rod_angle_rad));
  }
  if (t.rod_curvature != nullptr) detail::fill(*t.rod_curvature, quantity(&Pose<double>::rod_curvature));
  if (t.inertia_torque != nullptr) {
    // The kinetic energy of piston and rod without the big end is 1/2 w^2 (m_j x'^2 + dI b'^2); the torque on the crank
    // is minus its derivative.
    const double m = engine.masses.reciprocating_kg();
    const double inertia = engine.masses.rod_inertia_correction_kg_m2;
    const auto of_all = [&](double angle, const auto& of_one) {
      double sum = 0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(engine.layout.cylinders); ++k) {
        sum += of_one(exact_pose(crank, angle - engine.layout.firing_deg[k] * detail::kRadPerDegree));
      }
      return sum;
    };
    const auto torque = [&](const Pose<double>& p) {
      return -(m * p.slope_m * p.acceleration_m + inertia * p.rod_slope * p.rod_curvature);
    };
    const auto energy_given = [&](const Pose<double>& p) {
      return -(m * p.slope_m * p.slope_m + inertia * p.rod_slope * p.rod_slope) / 2;
    };
    detail::fill(
        *t.inertia_torque, [&](double angle) { return of_all(angle, torque); },
        [&](double angle) { return of_all(angle, energy_given); });
  }
}

}  // namespace

template <class Real>
Status tabulate(const EngineDefinition& engine, const TickOptions& options, const TableTargets<Real>& targets,
                TableReport* report) noexcept {
  if (!(options.tick_s >= 1e-6 && options.tick_s <= 2e-3)) return refuse("options.tick_s", Reason::out_of_range);
  if (!(options.max_speed_rad_s >= 0 && options.max_speed_rad_s <= kMaxSpeed_rad_s))
    return refuse("options.max_speed_rad_s", Reason::out_of_range);
  if (const Status refused = validate(targets); !refused.ok()) return refused;
  if (const Status refused = validate(engine); !refused.ok()) return refused;
  if (engine.train_count > 0) {
    if (const Status refused = validate(options.valves); !refused.ok()) return refused;
  }
  if (targets.wheel_faults != nullptr) {
    if (const Status refused = detail::validate_wheel_faults(engine, options); !refused.ok()) return refused;
  }
  if (targets.reluctor != nullptr && engine.reluctor.wheel >= 0 && engine.reluctor.delay_s > options.tick_s)
    return refuse("reluctor.delay_s", Reason::out_of_range);
  if (targets.gas_manifolds != nullptr) {
    if (const Status refused = detail::validate_manifolds(engine, options.tick_s); !refused.ok()) return refused;
  }
  IndicatorDiagram diagram;
  if (const Status refused = diagram.init(engine.crank, engine.pressure); !refused.ok()) return refused;

  TableReport found;
  if (const Status refused = detail::fill_valves(engine, options, targets, found); !refused.ok()) return refused;

  detail::fill_contacts(engine, targets);
  if (targets.body != nullptr) detail::round_into(body_of(engine), *targets.body);
  if (targets.crank_dynamics != nullptr) *targets.crank_dynamics = detail::crank_dynamics_of<Real>(engine, options);
  if (targets.bearings != nullptr) detail::round_into(bearings_of(engine), *targets.bearings);
  if (targets.balance != nullptr) {
    const Balance<double> balance = balance_of(engine);
    detail::round_into(balance.first, targets.balance->first);
    detail::round_into(balance.second, targets.balance->second);
    detail::round_into(balance.rotating, targets.balance->rotating);
    detail::fill(targets.balance->cosine, elementary::cos);
  }
  fill_mechanism(engine, targets);
  detail::fill_gas(engine, diagram, targets, found);
  detail::fill_gas_exchange(engine, options, targets);
  detail::fill_misfires(engine, targets);
  detail::fill_triggers(engine, options, targets);
  detail::fill_wheel_faults(engine, options, targets);
  detail::fill_reluctor(engine, options, targets);
  detail::fill_sensor_faults(engine, options, targets);
  if (targets.drive != nullptr) {
    fill_drive(engine, options, *targets.drive);
    targets.drive->fingerprint = detail::fingerprint_of(engine, options, found, static_cast<int>(sizeof(Real)));
  }
  if (report != nullptr) *report = found;
  return {};
}

template Status tabulate(const EngineDefinition&, const TickOptions&, const TableTargets<float>&,
                         TableReport*) noexcept;
template Status tabulate(const EngineDefinition&, const TickOptions&, const TableTargets<double>&,
                         TableReport*) noexcept;

}  // namespace crankloop
