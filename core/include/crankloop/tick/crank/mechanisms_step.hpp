// The crank's part of a tick: look-ups, torque and its work, forces of the cylinders.
//
// What belongs here: what is read per mechanism at the tick's end, and the order of the crank's part. What does not:
// inputs and the tick as a whole (tick/step.hpp), torque and its work (torque_step.hpp), the force algebra
// (cylinder_forces.hpp), how tables are read (curve.hpp).
//
//     phase -> torque tables of the whole engine -> output
//           -> look-ups per mechanism -> pressure, torque, forces per cylinder -> totals -> output
#pragma once

#include <crankloop/assert.hpp>
#include <crankloop/input.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/angle.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/crank/cylinder_forces.hpp>
#include <crankloop/tick/crank/engine_loads.hpp>
#include <crankloop/tick/crank/misfire_step.hpp>
#include <crankloop/tick/crank/torque_step.hpp>

namespace crankloop::detail {

/// Where forces turn the crank: mean torque of the gas over a cycle as it is at the tick; 0 of given pressures, which
/// are no cycle.
template <class Real, class S>
[[nodiscard]] Real mean_gas_Nm([[maybe_unused]] const Tables<Real, S>& tables,
                               [[maybe_unused]] const State<Real, S>& state,
                               [[maybe_unused]] CutCylinders<S> cut_cylinders) noexcept {
  if constexpr (Needs<S>::gas_torque && Needs<S>::load) {
    Real heat_Nm = tables.gas_torque_heat->mean_Nm;
    if constexpr (Needs<S>::lack) heat_Nm -= CutHeat<Real, S>(tables, state, cut_cylinders).mean_Nm();
    return tables.gas_torque_motored->mean_Nm + state.load_ratio * heat_Nm;
  } else if constexpr (Needs<S>::gas_torque) {
    return tables.gas_torque_full->mean_Nm;
  } else {
    return Real{};
  }
}

/// What is read once per mechanism, and what its cylinders show.
template <class Real, class S>
struct MechanismsStep {
  using N = Needs<S>;

  TorqueStep<Real, S>& torque;

  static constexpr bool kGivenGas = N::given_torque && !N::crank_dynamics;
  static constexpr bool kNeeded = N::shown_by_cylinder || kGivenGas;

  /// What geometry says of a mechanism, as far as the scene shows it.
  [[nodiscard, gnu::always_inline]] Pose<Real> pose_at(std::uint32_t degree, Real u) const noexcept {
    CRANKLOOP_ASSERT(degree < std::uint32_t{kDegreesPerTurn});
    CRANKLOOP_ASSERT(u >= 0 && u < 1);
    Pose<Real> p;  // the others are not read
    if constexpr (N::motion) {
      const MotionSegment<Real>& motion = *address(&torque.tables.motion->at[degree]);
      p.displacement_m = value(motion.displacement, u);
      p.slope_m = value(motion.slope, u);
      p.acceleration_m = value(motion.acceleration, u);
    }
    if constexpr (N::lean) {
      const LeanSegment<Real>& lean = torque.tables.lean->at[degree];
      p.rod_tilt = value(lean.tilt, u);
      p.radial = value(lean.radial, u);
    }
    if constexpr (N::rod) {
      const RodSegment<Real>& rod = torque.tables.rod->at[degree];
      p.rod_angle_rad = value(rod.angle, u);
      p.rod_slope = value(rod.slope, u);
    }
    if constexpr (N::rod_curvature) p.rod_curvature = value(torque.tables.rod_curvature->at[degree], u);
    return p;
  }

  /// In cylinder k, whose mechanism stands at `at`.
  template <class At>
  [[nodiscard, gnu::always_inline]] Real pressure_Pa([[maybe_unused]] std::uint32_t k, [[maybe_unused]] const At& at,
                                                     [[maybe_unused]] CutCylinders<S> cut_cylinders,
                                                     [[maybe_unused]] Real load_ratio) const noexcept {
    if constexpr (N::input_pressure) {
      return torque.state.pressure_Pa[k];
    } else if constexpr (N::gas) {
      return torque.held_pressure_Pa(k);
    } else if constexpr (N::gas_pressure) {
      const std::uint32_t segment = torque.tables.gas_grid->segment(at.delayed(torque.tables.drive->turn_of[k]));
      if constexpr (!N::load) {
        return value(torque.tables.pressure_full[segment], at.u);
      } else {
        const Real motored_Pa = value(torque.tables.pressure_motored[segment], at.u);
        if constexpr (N::misfire_of_table) {
          load_ratio *= heat_share(torque.state, cut_cylinders, k);
        } else {
          if (N::cut && (cut_cylinders >> k & 1u) != 0) return motored_Pa;
        }
        return motored_Pa + load_ratio * value(torque.tables.pressure_heat[segment], at.u);
      }
    } else {
      return torque.tables.body->crankcase_Pa;
    }
  }

  /// Where in its cycle a mechanism stands; where no gas is looked up, in its turn.
  [[nodiscard, gnu::always_inline]] auto mechanism_angle(std::uint64_t firing_phase) const noexcept {
    if constexpr (N::gas_pressure) {
      return angle_of<Real>(torque.state.phase.units(), firing_phase);
    } else {
      return turn_angle_of<Real>(torque.state.phase.units(), firing_phase);
    }
  }

  /// Mechanism by mechanism what its cylinders share, then those. Fills crank.head_pressure_Pa where the scene has gas
  /// on its valves' heads.
  void run([[maybe_unused]] CrankTurn<Real, S>& crank, [[maybe_unused]] CutCylinders<S> cut_cylinders) noexcept {
    const Drive<Real>& drive = *torque.tables.drive;
    [[maybe_unused]] typename TorqueStep<Real, S>::Swept swept;
    [[maybe_unused]] const std::uint8_t* k = drive.by_mechanism.cylinder;
    [[maybe_unused]] Real sum_Nm{};
    for (std::uint32_t m = 0; m < torque.mechanisms(); ++m) {
      const auto at = mechanism_angle(drive.firing_phase[m]);
      const std::uint32_t degree = at.turn_degree();
      const Pose<Real> p = pose_at(degree, at.u);
      if constexpr (kGivenGas) torque.read_swept(m, degree, at.u, p, swept);
      if constexpr (N::shown_by_cylinder) {
        const std::uint8_t* const end = drive.by_mechanism.cylinder + drive.by_mechanism.end[m];
        sum_Nm = show_cylinders(k, end, at, p, crank, cut_cylinders, sum_Nm);
        k = end;
      }
    }
    if constexpr (S::forces && !N::crank_dynamics) torque.torque_Nm = sum_Nm;
    if constexpr (kGivenGas) torque.add_given_pressures(swept, crank.mean_pressure_Pa);
  }

  /// What the cylinders of one mechanism show, `next` to before `end`. Answers their torques added to `sum_Nm`.
  template <class At>
  [[nodiscard, gnu::always_inline]] Real show_cylinders(const std::uint8_t* next, const std::uint8_t* end,
                                                        [[maybe_unused]] const At& at, const Pose<Real>& p,
                                                        [[maybe_unused]] CrankTurn<Real, S>& crank,
                                                        [[maybe_unused]] CutCylinders<S> cut_cylinders,
                                                        Real sum_Nm) noexcept {
    const Real speed = torque.state.speed_rad_s;
    [[maybe_unused]] Real velocity_m_s, acceleration_m_s2, rod_speed_rad_s, rod_acceleration_rad_s2;
    if constexpr (S::kinematics) {
      velocity_m_s = p.slope_m * speed;
      acceleration_m_s2 = p.acceleration_m * (speed * speed);
      if constexpr (N::crank_dynamics) acceleration_m_s2 += p.slope_m * torque.out.acceleration_rad_s2;
    }
    if constexpr (S::rod_motion) {
      rod_speed_rad_s = p.rod_slope * speed;
      rod_acceleration_rad_s2 = p.rod_curvature * (speed * speed);
      if constexpr (N::crank_dynamics) rod_acceleration_rad_s2 += p.rod_slope * torque.out.acceleration_rad_s2;
    }
    [[maybe_unused]] const auto forces = [&] {
      if constexpr (!S::forces) {
        return 0;
      } else if constexpr (N::crank_dynamics) {
        return MechanismForces<S::rod_inertia, Real>(*torque.tables.body, p,
                                                     CrankRate<Real>{speed, torque.out.acceleration_rad_s2});
      } else {
        return MechanismForces<S::rod_inertia, Real>(*torque.tables.body, p, speed);
      }
    }();
    [[maybe_unused]] const Real load_ratio = torque.state.load_ratio;
    for (; next != end; ++next) {
      const std::uint32_t k = *next;
      CRANKLOOP_ASSERT(k < S::cylinders.capacity);
      if constexpr (S::kinematics) {
        torque.out.displacement_m[k] = p.displacement_m;
        torque.out.velocity_m_s[k] = velocity_m_s;
        torque.out.acceleration_m_s2[k] = acceleration_m_s2;
      }
      if constexpr (S::rod_motion) {
        torque.out.rod_angle_rad[k] = p.rod_angle_rad;
        torque.out.rod_speed_rad_s[k] = rod_speed_rad_s;
        torque.out.rod_acceleration_rad_s2[k] = rod_acceleration_rad_s2;
      }
      if constexpr (N::cylinder_pressure) {
        const Real gas_Pa = pressure_Pa(k, at, cut_cylinders, load_ratio);
        if constexpr (N::valve_gas_held) crank.head_pressure_Pa[k] = gas_Pa;
        if constexpr (S::forces) {
          torque.out.cylinder[k] = forces.at(gas_Pa);
          sum_Nm += torque.out.cylinder[k].torque_Nm;
        }
      }
    }
    return sum_Nm;
  }
};

template <class Real, class S>
inline void run_mechanisms(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out,
                           CrankTurn<Real, S>& crank) noexcept {
  TorqueStep<Real, S> torque(tables, state, out);
  CutCylinders<S> cut_cylinders{};
  if constexpr (Needs<S>::lack) cut_cylinders = crank.cut_cylinders;
  const auto run_each = [&] {
    if constexpr (MechanismsStep<Real, S>::kNeeded) MechanismsStep<Real, S>{torque}.run(crank, cut_cylinders);
    if constexpr (S::bearing_loads) load_bearings(tables, state, out);
  };
  constexpr bool kForcesFirst = S::forces && !Needs<S>::crank_dynamics;  // the torque is their sum
  if constexpr (kForcesFirst) run_each();
  [[maybe_unused]] const auto at = torque.read_torque(cut_cylinders);
  torque.move_crank(crank);
  if constexpr (!kForcesFirst) run_each();
  torque.show_torque();
  torque.average_torque(crank);
  torque.remember_work();
  if constexpr (S::free_forces) balance_engine(tables, state, out, at.turn_degree(), at.u);
}

/// The same as a call of its own: its stack is free again when the valves need theirs.
template <class Real, class S>
[[gnu::noinline]] void run_mechanisms_apart(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out,
                                            CrankTurn<Real, S>& crank) noexcept {
  run_mechanisms(tables, state, out, crank);
}

/// Where forces turn the crank: its motion around the look-ups. Answers fault bits. `once_turned()` makes what the
/// torque at the new angle needs.
template <class Real, class S, class OnceTurned>
[[gnu::always_inline]] inline std::uint32_t turn_by_forces(const Tables<Real, S>& tables, State<Real, S>& state,
                                                           Output<Real, S>& out, CrankTurn<Real, S>& crank,
                                                           const Input<Real, S>& input,
                                                           [[maybe_unused]] OnceTurned once_turned) noexcept {
  std::uint32_t faults = 0;
  (void)checked(input.external_torque_Nm,
                within_magnitude(input.external_torque_Nm, static_cast<Real>(kMaxExternalTorque_Nm)),
                state.external_torque_Nm, kFaultExternalTorque, faults);
  Real gas_Nm = state.gas_Nm[0];
  CutCylinders<S> cut_cylinders{};
  if constexpr (Needs<S>::lack) cut_cylinders = crank.cut_cylinders;
  if constexpr (Needs<S>::load) {
    Real heat_Nm = state.gas_Nm[1];
    if constexpr (Needs<S>::lack) heat_Nm -= CutHeat<Real, S>(tables, state, cut_cylinders).torque_Nm(state.phase);
    gas_Nm += state.load_ratio * heat_Nm;
  }
  if constexpr (S::cam_drag) gas_Nm -= crank.cam_drag_Nm = state.cam_drag_Nm;
  bool starter = false;
  if constexpr (S::starter) starter = input.starter != 0;
  CrankStep<Real> motion(*tables.drive, *tables.crank_dynamics, state, state.speed_rad_s,
                         mean_gas_Nm(tables, state, cut_cylinders));
  crank.turned = motion.turn(gas_Nm, starter);
  crank.motion = &motion;
  state.phase += crank.turned;
  if constexpr (Needs<S>::misfire_of_table) pass_cycles(tables, state, crank.turned);
  if constexpr (Needs<S>::gas) once_turned();
  run_mechanisms(tables, state, out, crank);
  return motion.overspeed() ? faults | kFaultOverspeed : faults;
}
/// A call of its own for the same reason.
template <class Real, class S>
[[gnu::noinline]] std::uint32_t run_turned_by_forces(const Tables<Real, S>& tables, State<Real, S>& state,
                                                     Output<Real, S>& out, CrankTurn<Real, S>& crank,
                                                     const Input<Real, S>& input) noexcept {
  return turn_by_forces(tables, state, out, crank, input, 0);
}

}  // namespace crankloop::detail
