// The implementation of Engine: include it in the one translation unit that instantiates a scene, nowhere else.
//
// What belongs here: the order of one tick. What does not: the force algebra (cylinder_forces.hpp), how tables are read (curve.hpp).
//
//     input -> checked -> phase -> torque tables of the whole engine -> output
//                              -> look-ups per mechanism -> pressure, torque, forces per cylinder -> totals -> output
//
// Where forces turn the crank, the phase follows from the speed and the torques of the tick before (tick/crank_step.hpp), and the new speed from
// the work of this one, between the look-ups and the cylinders.
#pragma once

#include <crankloop/tick/angle.hpp>
#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/crank_step.hpp>
#include <crankloop/tick/cylinder_cut.hpp>
#include <crankloop/tick/cylinder_forces.hpp>
#include <crankloop/tick/engine.hpp>
#include <crankloop/tick/valves_step.hpp>

namespace crankloop {

namespace detail {

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
  Pose<Real> pose[N::pose ? S::cylinders.capacity : 1];
  Angle<Real> angle[N::mechanisms ? S::cylinders.capacity : 1];

  Real torque_Nm{};          ///< at the tick; where forces turn the crank that of gas alone, until its speed is known
  Integral<Real> inertia{};  ///< of the torque of masses per w^2
  Integral<Real> gas[2]{};
  Integral<Real> stroke[N::input_pressure ? S::cylinders.capacity : 1]{};
  Step(const Tables<Real, S>& t, State<Real, S>& s, Output<Real, S>& o) noexcept : tables{t}, state{s}, out{o} {}  // pose, angle: filled as needed

  /// Look-ups that cylinders at the same crank angle share.
  void read_mechanisms() noexcept {
    const Drive<Real>& drive = *tables.drive;
    const std::uint32_t mechanisms = drive.mechanisms;
    for (std::uint32_t m = 0; m < mechanisms; ++m) {
      const Angle<Real> at = angle_of<Real>(state.phase.units(), drive.firing_phase[m]);
      const std::uint32_t degree = at.turn_degree();
      [[maybe_unused]] Pose<Real>& p = pose[N::pose ? m : 0];
      angle[m] = at;
      if constexpr (N::stroke) {
        const IntegratedSegment<Real>& s = tables.stroke->at[degree];
        p.slope_m = value(s.slope, at.u);
        if constexpr (N::displacement) {
          const Integral<Real> x = integral_at(s, at.u, Real{0});
          p.displacement_m = total(x, tables.stroke->quantum);
          if constexpr (N::work && N::input_pressure) stroke[m] = x;
        }
      }
      if constexpr (N::acceleration) p.acceleration_m = value(tables.acceleration->at[degree], at.u);
      if constexpr (N::rod_tilt) {
        p.rod_tilt = value(tables.rod_tilt->at[degree], at.u);
        p.radial = value(tables.radial->at[degree], at.u);
      }
      if constexpr (N::rod_angle) {
        const IntegratedSegment<Real>& s = tables.rod_angle->at[degree];
        p.rod_slope = value(s.slope, at.u);
        p.rod_angle_rad = total(integral_at(s, at.u, Real{0}), tables.rod_angle->quantum);
      }
      if constexpr (N::rod_curvature) p.rod_curvature = value(tables.rod_curvature->at[degree], at.u);
    }
  }

  /// Torque of tables: they hold that of all cylinders together. Forces add up to it by themselves.
  void read_torque([[maybe_unused]] std::uint32_t cut_cylinders) noexcept {
    [[maybe_unused]] const Angle<Real> at = angle_of<Real>(state.phase.units(), 0);
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

  /// Torque of gas at given pressures: what forces turn the crank with. Other scenes add it up with what they ask of each cylinder.
  void add_given_pressures() noexcept {
    const Drive<Real>& drive = *tables.drive;
    for (std::uint32_t k = 0; k < count<S>(drive.cylinders); ++k) {
      torque_Nm += (state.pressure_Pa[k] - tables.body->crankcase_Pa) * tables.body->bore_area_m2 * pose[drive.mechanism_of[k]].slope_m;
    }
    this->gas_parts_Nm[0] = torque_Nm;
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
      if constexpr (N::input_pressure) add_given_pressures();
      CrankStep<Real>& motion = *crank.motion;
      motion.arrive({gas_work_J(crank), torque_Nm, inertia_kg_m2(), this->inertia_slope_kg_m2});
      torque_Nm += this->inertia_slope_kg_m2 * (state.speed_rad_s * state.speed_rad_s);
      out.crank = state.phase;
      motion.show(out);
      if constexpr (S::starter) out.starter_Nm = motion.starter_Nm();
    }
  }

  [[nodiscard]] Real pressure_Pa(std::uint32_t k, std::uint32_t segment, Real u, [[maybe_unused]] std::uint32_t cut_cylinders) noexcept {
    if constexpr (N::input_pressure) {
      return state.pressure_Pa[k];
    } else if constexpr (N::gas_pressure && N::cut) {
      const Real motored_Pa = value(tables.pressure_motored[segment], u);
      return (cut_cylinders >> k & 1u) != 0 ? motored_Pa : motored_Pa + state.load_ratio * value(tables.pressure_heat[segment], u);
    } else if constexpr (N::gas_pressure && N::load) {
      return value(tables.pressure_motored[segment], u) + state.load_ratio * value(tables.pressure_heat[segment], u);
    } else if constexpr (N::gas_pressure) {
      return value(tables.pressure_full[segment], u);
    } else {
      (void)k, (void)segment, (void)u;
      return tables.body->crankcase_Pa;
    }
  }

  /// Fills head_pressure_Pa, per cylinder, where the scene has gas on its valves' heads.
  void do_cylinders([[maybe_unused]] Real* head_pressure_Pa, std::uint32_t cut_cylinders) noexcept {
    const Drive<Real>& drive = *tables.drive;
    const std::uint32_t cylinders = count<S>(drive.cylinders);
    const Real speed = state.speed_rad_s;
    for (std::uint32_t k = 0; k < cylinders; ++k) {
      const std::uint32_t m = drive.mechanism_of[k];
      [[maybe_unused]] const Pose<Real>& p = pose[N::pose ? m : 0];
      [[maybe_unused]] const Real u = angle[m].u;
      [[maybe_unused]] std::uint32_t segment = 0;
      if constexpr (N::gas_pressure) segment = tables.gas_grid->segment(angle[m].delayed(drive.turn_of[k]));

      if constexpr (S::kinematics) {
        out.displacement_m[k] = p.displacement_m;
        out.velocity_m_s[k] = p.slope_m * speed;
        out.acceleration_m_s2[k] = p.acceleration_m * (speed * speed);
        if constexpr (N::crank_dynamics) out.acceleration_m_s2[k] += p.slope_m * out.acceleration_rad_s2;
      }
      if constexpr (S::rod_motion) {
        out.rod_angle_rad[k] = p.rod_angle_rad;
        out.rod_speed_rad_s[k] = p.rod_slope * speed;
        out.rod_acceleration_rad_s2[k] = p.rod_curvature * (speed * speed);
        if constexpr (N::crank_dynamics) out.rod_acceleration_rad_s2[k] += p.rod_slope * out.acceleration_rad_s2;
      }
      if constexpr (S::valve_gas) head_pressure_Pa[k] = pressure_Pa(k, segment, u, cut_cylinders);
      if constexpr (S::forces && N::crank_dynamics) {
        const CrankRate<Real> rate{speed, out.acceleration_rad_s2};
        out.cylinder[k] = cylinder_forces<S::rod_inertia>(*tables.body, p, pressure_Pa(k, segment, u, cut_cylinders), rate);
      } else if constexpr (S::forces) {
        out.cylinder[k] = cylinder_forces<S::rod_inertia>(*tables.body, p, pressure_Pa(k, segment, u, cut_cylinders), speed);
        torque_Nm += out.cylinder[k].torque_Nm;
      } else if constexpr (N::any_torque && N::input_pressure && !N::crank_dynamics) {
        torque_Nm += (state.pressure_Pa[k] - tables.body->crankcase_Pa) * tables.body->bore_area_m2 * p.slope_m;
      }
    }
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
    } else if constexpr (N::input_pressure) {
      const Drive<Real>& drive = *tables.drive;
      for (std::uint32_t k = 0; k < count<S>(drive.cylinders); ++k) {
        const std::uint32_t m = drive.mechanism_of[k];
        work_J += (crank.mean_pressure_Pa[k] - tables.body->crankcase_Pa) * tables.body->bore_area_m2 *
                  difference(state.stroke[m], stroke[m], tables.stroke->quantum);
      }
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
      if constexpr (N::input_pressure) {
        for (std::uint32_t m = 0; m < tables.drive->mechanisms; ++m) state.stroke[m] = stroke[m];
      }
    }
  }

  void load_bearings() noexcept {
    if constexpr (S::bearing_loads) {
      const Bearings<Real>& b = *tables.bearings;
      const Real w2 = state.speed_rad_s * state.speed_rad_s;
      for (std::uint32_t i = 0; i < b.pins; ++i) out.pin_radial_N[i] = out.pin_tangential_N[i] = Real{0};
      for (std::uint32_t k = 0; k < count<S>(tables.drive->cylinders); ++k) {
        out.pin_radial_N[b.pin_of[k]] += out.cylinder[k].radial_force_N;
        out.pin_tangential_N[b.pin_of[k]] += out.cylinder[k].tangential_force_N;
      }
      for (std::uint32_t j = 0; j <= b.pins; ++j) out.journal_along_N[j] = out.journal_across_N[j] = Real{0};
      for (std::uint32_t i = 0; i < b.pins; ++i) {
        const Real tangential = out.pin_tangential_N[i];
        const Real throw_outward = b.throw_kg_m[i] * w2 - out.pin_radial_N[i];
        out.pin_radial_N[i] -= b.rods_kg_m[i] * w2;
        out.pin_load_N[i] = magnitude(out.pin_radial_N[i], tangential);
        // Each throw is simply supported between its two journals: half to either, turned from the throw's frame into that of pin 0.
        const Real half_along = (throw_outward * b.throw_cos[i] - tangential * b.throw_sin[i]) / 2;
        const Real half_across = (throw_outward * b.throw_sin[i] + tangential * b.throw_cos[i]) / 2;
        out.journal_along_N[i] += half_along;
        out.journal_across_N[i] += half_across;
        out.journal_along_N[i + 1] += half_along;
        out.journal_across_N[i + 1] += half_across;
      }
      for (std::uint32_t j = 0; j <= b.pins; ++j) out.journal_load_N[j] = magnitude(out.journal_along_N[j], out.journal_across_N[j]);
    }
  }

  void balance_engine() noexcept {
    if constexpr (S::free_forces) {
      const Balance<Real>& b = *tables.balance;
      const Real w2 = state.speed_rad_s * state.speed_rad_s;
      const Angle<Real> a = angle_of<Real>(state.phase.units(), 0);
      const std::uint32_t degree = a.turn_degree();
      const std::uint32_t quarter_back = degree >= 90 ? degree - 90 : degree + 270;
      const Real cosine = value(b.cosine.at[degree], a.u);
      const Real sine = value(b.cosine.at[quarter_back], a.u);
      out.first = turned(b.first, cosine * w2, sine * w2);
      out.rotating = turned(b.rotating, cosine * w2, sine * w2);
      out.second = turned(b.second, (2 * cosine * cosine - 1) * w2, 2 * sine * cosine * w2);
    }
  }

  [[nodiscard]] static Real magnitude(Real x, Real y) noexcept { return square_root(x * x + y * y); }

  [[nodiscard]] static FreeForce<Real> turned(const Turning<Real>& t, Real cosine, Real sine) noexcept {
    return {t.up_cos * cosine + t.up_sin * sine, t.lateral_cos * cosine + t.lateral_sin * sine,
            t.pitch_cos * cosine + t.pitch_sin * sine, t.yaw_cos * cosine + t.yaw_sin * sine};
  }
};

template <class Real, class S>
inline void run_mechanisms(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out, const CrankTurn<Real, S>& crank) noexcept {
  Step<Real, S> step(tables, state, out);
  std::uint32_t cut_cylinders = 0;
  if constexpr (Needs<S>::cut) cut_cylinders = crank.cut_cylinders;
  step.read_torque(cut_cylinders);
  if constexpr (Needs<S>::mechanisms) step.read_mechanisms();
  step.move_crank(crank);
  if constexpr (Needs<S>::mechanisms) {
    step.do_cylinders(crank.head_pressure_Pa, cut_cylinders);
    step.load_bearings();
  }
  step.show_torque();
  step.average_torque(crank);
  step.remember_work();
  step.balance_engine();
}

/// The same as a call of its own: its stack is free again when the valves need theirs.
template <class Real, class S>
[[gnu::noinline]] void run_mechanisms_apart(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out,
                                            const CrankTurn<Real, S>& crank) noexcept {
  run_mechanisms(tables, state, out, crank);
}

/// Where forces turn the crank: its motion around the look-ups. Answers fault bits. A call of its own for the same reason.
template <class Real, class S>
[[gnu::noinline]] std::uint32_t run_turned_by_forces(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out,
                                                     CrankTurn<Real, S>& crank, const Input<Real, S>& input) noexcept {
  std::uint32_t faults = 0;
  (void)checked(input.load_Nm, within_magnitude(input.load_Nm, static_cast<Real>(kMostLoad_Nm)), state.load_Nm, kFaultLoad, faults);
  Real gas_Nm = state.gas_Nm[0];
  if constexpr (Needs<S>::load) {
    Real heat_Nm = state.gas_Nm[1];
    if constexpr (Needs<S>::cut) heat_Nm -= CutHeat<Real, S>(tables, crank.cut_cylinders).torque_Nm(state.phase);
    gas_Nm += state.load_ratio * heat_Nm;
  }
  bool starter = false;
  if constexpr (S::starter) starter = input.starter != 0;
  CrankStep<Real> motion(*tables.drive, *tables.crank_dynamics, state, state.speed_rad_s);
  crank.turned = motion.turn(gas_Nm, starter);
  crank.motion = &motion;
  state.phase += crank.turned;
  run_mechanisms(tables, state, out, crank);
  return motion.overspeed() ? faults | kFaultOverspeed : faults;
}

/// True when every section the scene reads is there.
template <class Real, class S>
[[nodiscard]] constexpr bool complete(const Tables<Real, S>& t) noexcept {
  using N = Needs<S>;
  bool all = t.drive != nullptr;
  if constexpr (N::body) all = all && t.body != nullptr;
  if constexpr (N::stroke) all = all && t.stroke != nullptr;
  if constexpr (N::acceleration) all = all && t.acceleration != nullptr;
  if constexpr (N::rod_tilt) all = all && t.rod_tilt != nullptr && t.radial != nullptr;
  if constexpr (N::rod_angle) all = all && t.rod_angle != nullptr;
  if constexpr (N::rod_curvature) all = all && t.rod_curvature != nullptr;
  if constexpr (N::inertia_torque) all = all && t.inertia_torque != nullptr;
  if constexpr (N::gas_pressure) all = all && t.gas_grid != nullptr;
  if constexpr (N::gas_torque) all = all && t.torque_grid != nullptr;
  if constexpr (N::gas_pressure && !N::load) all = all && t.pressure_full != nullptr;
  if constexpr (N::gas_pressure && N::load) all = all && t.pressure_motored != nullptr && t.pressure_heat != nullptr;
  if constexpr (N::gas_torque && !N::load) all = all && t.gas_torque_full != nullptr;
  if constexpr (N::gas_torque && N::load) all = all && t.gas_torque_motored != nullptr && t.gas_torque_heat != nullptr;
  if constexpr (N::cut_torque) all = all && t.cut_grid != nullptr && t.cut_torque != nullptr;
  if constexpr (N::crank_dynamics) all = all && t.crank_dynamics != nullptr;
  if constexpr (S::bearing_loads) all = all && t.bearings != nullptr;
  if constexpr (S::free_forces) all = all && t.balance != nullptr;
  if constexpr (N::any_valves) all = all && t.lift_curves != nullptr;
  if constexpr (N::elastic_valves) all = all && t.valve_motions != nullptr;
  return all;
}

}  // namespace detail

template <class Real, class S>
Status Engine<Real, S>::init(const Tables& tables, Phase start) noexcept {
  tables_ = nullptr;
  state_ = State{};
  output_ = Output{};
  if (build_contracts<Real>()) return {Reason::contracting_build, -1, "build"};
  if (!detail::complete<Real, S>(tables)) return {Reason::missing_table, -1, "tables"};
  const Drive<Real>& drive = *tables.drive;
  const std::uint32_t capacity = S::cylinders.capacity;
  if (drive.cylinders < 1 || drive.cylinders > capacity || (S::cylinders.exact && drive.cylinders != capacity)) {
    return {Reason::out_of_range, -1, "tables.cylinders"};
  }
  if constexpr (Needs<S>::body && !S::rod_inertia) {
    if (tables.body->rod_inertia_correction_kg_m2 != Real{0}) return {Reason::inconsistent, -1, "scene.rod_inertia"};
  }
  if constexpr (Needs<S>::crank_dynamics) {
    const bool enough = tables.crank_dynamics->least_kg_m2 >= static_cast<Real>(kLeastInertia_kg_m2);
    if (!enough) return {Reason::not_positive, -1, "masses.crank_inertia"};
  }
  if constexpr (Needs<S>::any_valves) {
    if (drive.trains > S::trains.capacity || (S::trains.exact && drive.trains != S::trains.capacity)) {
      return {Reason::out_of_range, -1, "tables.trains"};
    }
  }
  if constexpr (Needs<S>::elastic_valves && !S::valve_gas) {
    for (std::uint32_t t = 0; t < drive.trains; ++t) {
      if (tables.valve_motions[t].body.head_area_m2 != Real{0}) return {Reason::inconsistent, static_cast<std::int32_t>(t), "scene.valve_gas"};
    }
  }
  tables_ = &tables;
  state_.fingerprint = drive.fingerprint;
  state_.phase = start;
  if constexpr (Needs<S>::input_pressure) {
    for (Real& pressure : state_.pressure_Pa) pressure = tables.body->crankcase_Pa;
  }
  if constexpr (Needs<S>::work) {  // the first tick's work counts from here
    detail::Step<Real, S> step(tables, state_, output_);
    step.read_torque(0);
    if constexpr (Needs<S>::mechanisms) {
      Real unused[S::cylinders.capacity];
      step.read_mechanisms();
      step.do_cylinders(unused, 0);
    }
    step.start_crank();
    step.remember_work();
    output_ = Output{};
  }
  if constexpr (Needs<S>::elastic_valves) detail::ValvesStep<Real, S>{tables, state_, output_, start, false, nullptr}.settle();
  return {};
}

template <class Real, class S>
const typename Engine<Real, S>::Output& Engine<Real, S>::step(const Input& input) noexcept {
  if (tables_ == nullptr) {
    output_.faults = kFaultNotReady;
    return output_;
  }
  const Tables& tables = *tables_;
  const Drive<Real>& drive = *tables.drive;
  std::uint32_t faults = 0;

  [[maybe_unused]] const Phase phase_before = state_.phase;
  Phase turned;
  bool jumped = false;
  if constexpr (S::crank == CrankGiven::speed) {
    const Real limit = drive.speed_limit_rad_s;
    const Real speed = detail::checked(input.speed_rad_s, detail::within_magnitude(input.speed_rad_s, limit), state_.speed_rad_s, kFaultSpeed, faults);
    turned = Phase::from_cycles(speed * drive.cycles_per_tick_per_rad_s);
    state_.phase += turned;
  } else if constexpr (S::crank == CrankGiven::phase) {
    turned = input.crank - state_.phase;
    const Real speed = turned.template signed_cycles<Real>() * drive.rad_s_per_cycle_per_tick;
    // The first measured angle says nothing of the speed, nor does one that no crankshaft could have reached.
    const bool possible = detail::within(speed, -drive.speed_limit_rad_s, drive.speed_limit_rad_s);
    jumped = !possible || state_.ticks == 0;
    if (!jumped) state_.speed_rad_s = speed;
    if (!possible && state_.ticks != 0) faults |= kFaultPhaseJump;
    state_.phase = input.crank;
  }
  ++state_.ticks;
  if constexpr (Needs<S>::load) {
    (void)detail::checked(input.load_ratio, detail::within_positive(input.load_ratio, Real{2}), state_.load_ratio, kFaultLoadRatio, faults);
  }
  [[maybe_unused]] Real mean_pressure_Pa[Needs<S>::input_pressure ? S::cylinders.capacity : 1];
  if constexpr (Needs<S>::input_pressure) {
    for (std::uint32_t k = 0; k < detail::count<S>(drive.cylinders); ++k) {
      const Real before = state_.pressure_Pa[k];
      const bool good = detail::within_positive(input.pressure_Pa[k], static_cast<Real>(1e8));
      const Real now = detail::checked(input.pressure_Pa[k], good, state_.pressure_Pa[k], kFaultPressure, faults);
      mean_pressure_Pa[k] = (before + now) / 2;
    }
  }

  [[maybe_unused]] Real head_pressure_Pa[S::valve_gas ? S::cylinders.capacity : 1];
  detail::CrankTurn<Real, S> crank{{}, {}, turned, jumped, mean_pressure_Pa, head_pressure_Pa};
  if constexpr (Needs<S>::cut) crank.cut_cylinders = input.cut_cylinders;
  if constexpr (Needs<S>::crank_dynamics) {
    faults |= detail::run_turned_by_forces(tables, state_, output_, crank, input);
  } else if constexpr (Needs<S>::elastic_valves) {
    detail::run_mechanisms_apart(tables, state_, output_, crank);
  } else {
    detail::run_mechanisms(tables, state_, output_, crank);
  }
  if constexpr (Needs<S>::any_valves) {
    faults |= detail::ValvesStep<Real, S>{tables, state_, output_, phase_before, jumped, head_pressure_Pa}.run(input);
  }
  output_.faults = faults;
  return output_;
}

template <class Real, class S>
Status Engine<Real, S>::restore(const State& state) noexcept {
  if (tables_ == nullptr) return {Reason::missing_table, -1, "tables"};
  if (state.fingerprint != state_.fingerprint) return {Reason::other_tables, -1, "state.fingerprint"};
  state_ = state;
  // A sleeping valve's output is zero since it fell asleep; the state may hold others asleep than this engine did.
  if constexpr (Needs<S>::elastic_valves) static_cast<crankloop::Valves<Real, S>&>(output_) = {};
  return {};
}

}  // namespace crankloop
