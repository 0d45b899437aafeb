// The crank's part of a tick: look-ups, torque and its work, forces of the cylinders.
//
// What belongs here: what is read from the tables at the tick's end, in its order. What does not: inputs and the tick as a whole
// (tick/step.hpp), the force algebra (cylinder_forces.hpp), how tables are read (curve.hpp).
//
//     phase -> torque tables of the whole engine -> output
//           -> look-ups per mechanism -> pressure, torque, forces per cylinder -> totals -> output
#pragma once

#include <crankloop/tables/angle.hpp>
#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/crank/crank_step.hpp>
#include <crankloop/tick/crank/cylinder_cut.hpp>
#include <crankloop/tick/crank/cylinder_forces.hpp>
#include <crankloop/tick/crank/engine_loads.hpp>
#include <crankloop/input.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>

namespace crankloop::detail {

/// Which cylinders do not fire this tick.
struct CutOfTick {
  std::uint32_t cut_cylinders;
};
/// The integration of the crank's motion, between its halves.
template <class Real>
struct MotionOfTick {
  CrankStep<Real>* motion;
};

/// What a tick's crank part takes and gives besides tables, state and output.
template <class Real, class S>
struct CrankTurn : If<Needs<S>::cut, CutOfTick>, If<Needs<S>::crank_dynamics, MotionOfTick<Real>> {
  Phase turned;
  bool jumped;
  const Real* mean_pressure_Pa;  ///< per cylinder, where pressures are given
  Real* head_pressure_Pa;        ///< per cylinder, for the valves
};

/// What a crank that is turned by forces needs of the look-ups.
template <class Real>
struct TurningTorques {
  Real gas_parts_Nm[2]{};      ///< torque of gas: all of it, or motored and heat
  Real inertia_slope_kg_m2{};  ///< torque of masses per w^2
};

/// One tick's work in progress: what is read once per mechanism and added up over cylinders.
template <class Real, class S>
struct Step : If<Needs<S>::crank_dynamics, TurningTorques<Real>> {
  using N = Needs<S>;

  const Tables<Real, S>& tables;
  State<Real, S>& state;
  Output<Real, S>& out;
  Real torque_Nm{};          ///< at the tick; where forces turn the crank that of gas alone, until its speed is known
  Integral<Real> inertia{};  ///< of the torque of masses per w^2
  Integral<Real> gas[2]{};
  Real given_work_J{};  ///< of given pressures, since the last tick
  Step(const Tables<Real, S>& t, State<Real, S>& s, Output<Real, S>& o) noexcept : tables{t}, state{s}, out{o} {}

  /// Of one cylinder the compiler knows.
  [[nodiscard]] std::uint32_t mechanisms() const noexcept { return S::cylinders.capacity == 1 ? 1 : tables.drive->mechanisms; }

  /// Torque of tables: they hold that of all cylinders together. Forces add up to it by themselves.
  void read_torque([[maybe_unused]] std::uint32_t cut_cylinders) noexcept {
    [[maybe_unused]] const auto at = [&] {
      if constexpr (N::gas_torque) {
        return angle_of<Real>(state.phase.units(), 0);
      } else {
        return turn_angle_of<Real>(state.phase.units(), 0);
      }
    }();
    if constexpr (N::inertia_torque) {
      const IntegratedSegment<Real>& s = tables.inertia_torque->at[at.turn_degree()];
      if constexpr (N::crank_dynamics) {
        this->inertia_slope_kg_m2 = value(s.slope, at.u);
      } else if constexpr (!S::forces) {
        torque_Nm = state.speed_rad_s * state.speed_rad_s * value(s.slope, at.u);
      }
      if constexpr (N::work) inertia = integral_at(s, at.u, Real{0});
    }
    if constexpr (N::gas_torque) {
      const std::uint32_t segment = tables.torque_grid->segment(at.cell);
      Real gas_Nm;
      if constexpr (N::load) {
        gas_Nm = gas_torque(*tables.gas_torque_motored, segment, at.u, 0);
        Real heat_Nm = gas_torque(*tables.gas_torque_heat, segment, at.u, 1);
        if constexpr (N::crank_dynamics) this->gas_parts_Nm[0] = gas_Nm, this->gas_parts_Nm[1] = heat_Nm;
        if constexpr (N::cut) heat_Nm -= CutHeat<Real, S>(tables, cut_cylinders).torque_Nm(state.phase);
        gas_Nm += state.load_ratio * heat_Nm;
      } else {
        gas_Nm = gas_torque(*tables.gas_torque_full, segment, at.u, 0);
        if constexpr (N::crank_dynamics) this->gas_parts_Nm[0] = gas_Nm;
      }
      if constexpr (!S::forces || N::crank_dynamics) torque_Nm += gas_Nm;
    }
  }

  /// Gas torque by a curve, with its work in gas[which].
  [[nodiscard]] Real gas_torque(const GasTorque<Real>& curve, std::uint32_t segment, Real u, int which) noexcept {
    const IntegratedSegment<Real>& s = curve.at[segment];
    if constexpr (N::work) gas[which] = integral_at(s, u, curve.mean_Nm);
    return value(s.slope, u);
  }

  /// What geometry says of a mechanism, as far as the scene shows it.
  [[nodiscard, gnu::always_inline]] Pose<Real> pose_at(std::uint32_t degree, Real u) const noexcept {
    Pose<Real> p;  // the others are not read
    if constexpr (N::motion) {
      const MotionSegment<Real>& motion = tables.motion->at[degree];
      p.displacement_m = value(motion.displacement, u);
      p.slope_m = value(motion.slope, u);
      p.acceleration_m = value(motion.acceleration, u);
    }
    if constexpr (N::lean) {
      const LeanSegment<Real>& lean = tables.lean->at[degree];
      p.rod_tilt = value(lean.tilt, u);
      p.radial = value(lean.radial, u);
    }
    if constexpr (N::rod) {
      const RodSegment<Real>& rod = tables.rod->at[degree];
      p.rod_angle_rad = value(rod.angle, u);
      p.rod_slope = value(rod.slope, u);
    }
    if constexpr (N::rod_curvature) p.rod_curvature = value(tables.rod_curvature->at[degree], u);
    return p;
  }

  /// What the gas above pistons does: dV/da, and the volume swept since the last tick. Per mechanism.
  struct Swept {
    Real slope_m3[N::given_torque ? S::cylinders.capacity : 1];
    Real volume_m3[N::given_work ? S::cylinders.capacity : 1];
  };
  [[gnu::always_inline]] void read_swept(std::uint32_t m, [[maybe_unused]] std::uint32_t degree, [[maybe_unused]] Real u, [[maybe_unused]] const Pose<Real>& p,
                                         Swept& swept) noexcept {
    const Real area_m2 = tables.body->bore_area_m2;
    if constexpr (N::stroke) {
      const IntegratedSegment<Real>& s = tables.stroke->at[degree];
      swept.slope_m3[m] = value(s.slope, u) * area_m2;
      if constexpr (N::given_work) {
        const Integral<Real> x = integral_at(s, u, Real{0});
        swept.volume_m3[m] = difference(state.stroke[m], x, tables.stroke->quantum) * area_m2;
        state.stroke[m] = x;
      }
    } else {
      swept.slope_m3[m] = p.slope_m * area_m2;
    }
  }

  /// Torque and work of gas at given pressures.
  [[gnu::always_inline]] void add_given_pressures(const Swept& swept, [[maybe_unused]] const Real* mean_pressure_Pa) noexcept {
    const Drive<Real>& drive = *tables.drive;
    const Real crankcase_Pa = tables.body->crankcase_Pa;
    for (std::uint32_t k = 0; k < count<S>(drive.cylinders); ++k) {
      const std::uint32_t m = drive.mechanism_of[k];
      if constexpr (N::crank_dynamics || !S::forces) torque_Nm += (state.pressure_Pa[k] - crankcase_Pa) * swept.slope_m3[m];
      if constexpr (N::given_work) given_work_J += (mean_pressure_Pa[k] - crankcase_Pa) * swept.volume_m3[m];
    }
  }

  /// Where forces turn the crank: torque and work of gas at given pressures, before the crank's speed is known.
  void read_given_pressures([[maybe_unused]] const Real* mean_pressure_Pa) noexcept {
    if constexpr (N::crank_dynamics && N::given_torque) {
      const Drive<Real>& drive = *tables.drive;
      Swept swept;
      for (std::uint32_t m = 0; m < mechanisms(); ++m) {
        const auto at = turn_angle_of<Real>(state.phase.units(), drive.firing_phase[m]);
        read_swept(m, at.degree, at.u, {}, swept);
      }
      add_given_pressures(swept, mean_pressure_Pa);
      this->gas_parts_Nm[0] = torque_Nm;
    }
  }

  /// J_eff: the integral of the torque of masses per w^2 is minus half of the part that changes.
  [[nodiscard]] Real inertia_kg_m2() const noexcept {
    return tables.crank_dynamics->turning_kg_m2 - 2 * total(inertia, tables.inertia_torque->quantum);
  }

  /// At rest, where the engine starts.
  void start_crank() noexcept {
    if constexpr (N::crank_dynamics) {
      state.per_root_inertia = Real{1} / square_root(inertia_kg_m2());
      state.inertia_slope_kg_m2 = this->inertia_slope_kg_m2;
    }
  }

  /// The second half of the crank's motion, and its output.
  void move_crank([[maybe_unused]] const CrankTurn<Real, S>& crank) noexcept {
    if constexpr (N::crank_dynamics) {
      read_given_pressures(crank.mean_pressure_Pa);
      CrankStep<Real>& motion = *crank.motion;
      motion.arrive({gas_work_J(crank), torque_Nm, inertia_kg_m2(), this->inertia_slope_kg_m2});
      torque_Nm += this->inertia_slope_kg_m2 * (state.speed_rad_s * state.speed_rad_s);
      out.crank = state.phase;
      motion.show(out);
      if constexpr (S::starter) out.starter_Nm = motion.starter_Nm();
    }
  }

  /// In cylinder k, whose mechanism stands at `at`.
  template <class At>
  [[nodiscard, gnu::always_inline]] Real pressure_Pa([[maybe_unused]] std::uint32_t k, [[maybe_unused]] const At& at,
                                                     [[maybe_unused]] std::uint32_t cut_cylinders, [[maybe_unused]] Real load_ratio) const noexcept {
    if constexpr (N::input_pressure) {
      return state.pressure_Pa[k];
    } else if constexpr (N::gas_pressure) {
      const std::uint32_t segment = tables.gas_grid->segment(at.delayed(tables.drive->turn_of[k]));
      if constexpr (!N::load) {
        return value(tables.pressure_full[segment], at.u);
      } else {
        const Real motored_Pa = value(tables.pressure_motored[segment], at.u);
        if (N::cut && (cut_cylinders >> k & 1u) != 0) return motored_Pa;
        return motored_Pa + load_ratio * value(tables.pressure_heat[segment], at.u);
      }
    } else {
      return tables.body->crankcase_Pa;
    }
  }

  /// Where in its cycle a mechanism stands; where no gas is looked up, in its turn.
  [[nodiscard, gnu::always_inline]] auto mechanism_angle(std::uint64_t firing_phase) const noexcept {
    if constexpr (N::gas_pressure) {
      return angle_of<Real>(state.phase.units(), firing_phase);
    } else {
      return turn_angle_of<Real>(state.phase.units(), firing_phase);
    }
  }

  /// Mechanism by mechanism what its cylinders share, then those. Fills crank.head_pressure_Pa where the scene has gas on its valves' heads.
  void do_mechanisms([[maybe_unused]] const CrankTurn<Real, S>& crank, [[maybe_unused]] std::uint32_t cut_cylinders) noexcept {
    constexpr bool kGivenGas = N::given_torque && !N::crank_dynamics;
    if constexpr (N::shown_by_cylinder || kGivenGas) {
      const Drive<Real>& drive = *tables.drive;
      [[maybe_unused]] Swept swept;
      [[maybe_unused]] const std::uint8_t* k = drive.by_mechanism.cylinder;
      [[maybe_unused]] Real sum_Nm{};
      for (std::uint32_t m = 0; m < mechanisms(); ++m) {
        const auto at = mechanism_angle(drive.firing_phase[m]);
        const std::uint32_t degree = at.turn_degree();
        const Pose<Real> p = pose_at(degree, at.u);
        if constexpr (kGivenGas) read_swept(m, degree, at.u, p, swept);
        if constexpr (N::shown_by_cylinder) {
          const std::uint8_t* const end = drive.by_mechanism.cylinder + drive.by_mechanism.end[m];
          sum_Nm = show_cylinders(k, end, at, p, crank, cut_cylinders, sum_Nm);
          k = end;
        }
      }
      if constexpr (S::forces && !N::crank_dynamics) torque_Nm = sum_Nm;
      if constexpr (kGivenGas) add_given_pressures(swept, crank.mean_pressure_Pa);
    }
  }

  /// What the cylinders of one mechanism show, `next` to before `end`. Answers their torques added to `sum_Nm`.
  template <class At>
  [[nodiscard, gnu::always_inline]] Real show_cylinders(const std::uint8_t* next, const std::uint8_t* end, [[maybe_unused]] const At& at,
                                                       const Pose<Real>& p, [[maybe_unused]] const CrankTurn<Real, S>& crank,
                                                       [[maybe_unused]] std::uint32_t cut_cylinders, Real sum_Nm) noexcept {
    const Real speed = state.speed_rad_s;
    [[maybe_unused]] Real velocity_m_s, acceleration_m_s2, rod_speed_rad_s, rod_acceleration_rad_s2;
    if constexpr (S::kinematics) {
      velocity_m_s = p.slope_m * speed;
      acceleration_m_s2 = p.acceleration_m * (speed * speed);
      if constexpr (N::crank_dynamics) acceleration_m_s2 += p.slope_m * out.acceleration_rad_s2;
    }
    if constexpr (S::rod_motion) {
      rod_speed_rad_s = p.rod_slope * speed;
      rod_acceleration_rad_s2 = p.rod_curvature * (speed * speed);
      if constexpr (N::crank_dynamics) rod_acceleration_rad_s2 += p.rod_slope * out.acceleration_rad_s2;
    }
    [[maybe_unused]] const auto forces = [&] {
      if constexpr (!S::forces) {
        return 0;
      } else if constexpr (N::crank_dynamics) {
        return MechanismForces<S::rod_inertia, Real>(*tables.body, p, CrankRate<Real>{speed, out.acceleration_rad_s2});
      } else {
        return MechanismForces<S::rod_inertia, Real>(*tables.body, p, speed);
      }
    }();
    [[maybe_unused]] const Real load_ratio = state.load_ratio;
    for (; next != end; ++next) {
      const std::uint32_t k = *next;
      if constexpr (S::kinematics) {
        out.displacement_m[k] = p.displacement_m;
        out.velocity_m_s[k] = velocity_m_s;
        out.acceleration_m_s2[k] = acceleration_m_s2;
      }
      if constexpr (S::rod_motion) {
        out.rod_angle_rad[k] = p.rod_angle_rad;
        out.rod_speed_rad_s[k] = rod_speed_rad_s;
        out.rod_acceleration_rad_s2[k] = rod_acceleration_rad_s2;
      }
      if constexpr (N::cylinder_pressure) {
        const Real gas_Pa = pressure_Pa(k, at, cut_cylinders, load_ratio);
        if constexpr (S::valve_gas) crank.head_pressure_Pa[k] = gas_Pa;
        if constexpr (S::forces) {
          out.cylinder[k] = forces.at(gas_Pa);
          sum_Nm += out.cylinder[k].torque_Nm;
        }
      }
    }
    return sum_Nm;
  }

  void show_torque() noexcept {
    if constexpr (S::torque) out.torque_Nm = torque_Nm;
  }

  /// Whether so little was turned that a difference of work drowns in rounding.
  [[nodiscard]] static bool crawling(Phase turned) noexcept {
    constexpr std::uint64_t kCrawl = ~std::uint64_t{0} / kDegreesPerCycle >> (sizeof(Real) == 4 ? 4 : 20);
    return turned.units() + kCrawl <= 2 * kCrawl;  // |turned| <= kCrawl, wrapping
  }

  /// Adds the gas's work since the last tick, less that of its mean torque over the cycle, which it answers.
  [[nodiscard]] Real add_gas_work([[maybe_unused]] const CrankTurn<Real, S>& crank, [[maybe_unused]] Real& work_J) noexcept {
    if constexpr (N::gas_torque && N::load) {
      const GasTorque<Real>& motored = *tables.gas_torque_motored;
      const GasTorque<Real>& heat = *tables.gas_torque_heat;
      work_J += difference(state.gas[0], gas[0], motored.quantum);
      Real heat_J = difference(state.gas[1], gas[1], heat.quantum);
      Real heat_mean_Nm = heat.mean_Nm;
      if constexpr (N::cut) {
        const auto lacks = CutHeat<Real, S>(tables, crank.cut_cylinders).work(state.phase - crank.turned, state.phase);
        heat_J -= lacks.work_J;
        heat_mean_Nm -= lacks.mean_Nm;
      }
      work_J += state.load_ratio * heat_J;
      return motored.mean_Nm + state.load_ratio * heat_mean_Nm;
    } else if constexpr (N::gas_torque) {
      work_J += difference(state.gas[0], gas[0], tables.gas_torque_full->quantum);
      return tables.gas_torque_full->mean_Nm;
    } else if constexpr (N::given_work) {
      work_J += given_work_J;
    }
    return Real{};
  }

  /// Where forces turn the crank: the gas's work since the last tick.
  [[nodiscard]] Real gas_work_J(const CrankTurn<Real, S>& crank) noexcept {
    const Real turned_rad = crank.motion->turned_rad();
    if (crawling(crank.turned)) return (crank.motion->gas_before_Nm() + torque_Nm) / 2 * turned_rad;
    Real work_J{};
    const Real mean_Nm = add_gas_work(crank, work_J);
    return work_J + mean_Nm * turned_rad;
  }

  /// Work done since the last tick over the angle turned. At a crawl the difference drowns in rounding: there the mean of the
  /// torques at both ends is the better average (docs/decisions/0005-mean-torque.md).
  /// After a jump of a measured phase there is no tick to average over.
  void average_torque(const CrankTurn<Real, S>& crank) noexcept {
    if constexpr (S::mean_torque) {
      if (crank.jumped) {
        out.mean_torque_Nm = torque_Nm;
      } else if (crawling(crank.turned)) {
        out.mean_torque_Nm = (state.torque_Nm + torque_Nm) / 2;
      } else {
        constexpr Real kRadPerCycle = static_cast<Real>(0x1.921fb54442d18p+3);
        const Real per_rad = Real{1} / (crank.turned.template signed_cycles<Real>() * kRadPerCycle);
        Real w2 = state.speed_rad_s * state.speed_rad_s;
        if constexpr (N::crank_dynamics) w2 = (w2 + crank.motion->speed_before_rad_s() * crank.motion->speed_before_rad_s()) / 2;
        Real work_J = w2 * difference(state.inertia, inertia, tables.inertia_torque->quantum);
        const Real mean_Nm = add_gas_work(crank, work_J);
        out.mean_torque_Nm = work_J * per_rad + mean_Nm;
      }
    }
  }

  void remember_work() noexcept {
    if constexpr (N::work) {
      state.inertia = inertia;
      state.torque_Nm = torque_Nm;
      if constexpr (N::crank_dynamics) state.gas_Nm[0] = this->gas_parts_Nm[0], state.gas_Nm[1] = this->gas_parts_Nm[1];
      if constexpr (N::gas_torque) {
        state.gas[0] = gas[0];
        if constexpr (N::load) state.gas[1] = gas[1];
      }
    }
  }
};

template <class Real, class S>
inline void run_mechanisms(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out, const CrankTurn<Real, S>& crank) noexcept {
  Step<Real, S> step(tables, state, out);
  std::uint32_t cut_cylinders = 0;
  if constexpr (Needs<S>::cut) cut_cylinders = crank.cut_cylinders;
  step.read_torque(cut_cylinders);
  step.move_crank(crank);
  step.do_mechanisms(crank, cut_cylinders);
  load_bearings(tables, state, out);
  step.show_torque();
  step.average_torque(crank);
  step.remember_work();
  balance_engine(tables, state, out);
}

/// The same as a call of its own: its stack is free again when the valves need theirs.
template <class Real, class S>
[[gnu::noinline]] void run_mechanisms_apart(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out,
                                            const CrankTurn<Real, S>& crank) noexcept {
  run_mechanisms(tables, state, out, crank);
}

/// Where forces turn the crank: mean torque of the gas over a cycle as it is at the tick; 0 of given pressures, which are no cycle.
template <class Real, class S>
[[nodiscard]] Real mean_gas_Nm([[maybe_unused]] const Tables<Real, S>& tables, [[maybe_unused]] Real load_ratio, [[maybe_unused]] std::uint32_t cut_cylinders) noexcept {
  if constexpr (Needs<S>::gas_torque && Needs<S>::load) {
    Real heat_Nm = tables.gas_torque_heat->mean_Nm;
    if constexpr (Needs<S>::cut) heat_Nm -= CutHeat<Real, S>(tables, cut_cylinders).mean_Nm();
    return tables.gas_torque_motored->mean_Nm + load_ratio * heat_Nm;
  } else if constexpr (Needs<S>::gas_torque) {
    return tables.gas_torque_full->mean_Nm;
  } else {
    return Real{};
  }
}

/// Where forces turn the crank: its motion around the look-ups. Answers fault bits. A call of its own for the same reason.
template <class Real, class S>
[[gnu::noinline]] std::uint32_t run_turned_by_forces(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out,
                                                     CrankTurn<Real, S>& crank, const Input<Real, S>& input) noexcept {
  std::uint32_t faults = 0;
  (void)checked(input.load_Nm, within_magnitude(input.load_Nm, static_cast<Real>(kMostLoad_Nm)), state.load_Nm, kFaultLoad, faults);
  Real gas_Nm = state.gas_Nm[0];
  std::uint32_t cut_cylinders = 0;
  if constexpr (Needs<S>::cut) cut_cylinders = crank.cut_cylinders;
  if constexpr (Needs<S>::load) {
    Real heat_Nm = state.gas_Nm[1];
    if constexpr (Needs<S>::cut) heat_Nm -= CutHeat<Real, S>(tables, cut_cylinders).torque_Nm(state.phase);
    gas_Nm += state.load_ratio * heat_Nm;
  }
  bool starter = false;
  if constexpr (S::starter) starter = input.starter != 0;
  CrankStep<Real> motion(*tables.drive, *tables.crank_dynamics, state, state.speed_rad_s, mean_gas_Nm(tables, state.load_ratio, cut_cylinders));
  crank.turned = motion.turn(gas_Nm, starter);
  crank.motion = &motion;
  state.phase += crank.turned;
  run_mechanisms(tables, state, out, crank);
  return motion.overspeed() ? faults | kFaultOverspeed : faults;
}

}  // namespace crankloop::detail
