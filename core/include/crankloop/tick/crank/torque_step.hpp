// The torque of a tick: of tables or of given pressures, its work over the angle turned, and the crank that it turns.
//
// What belongs here: what adds up over the whole engine. What does not: what each cylinder shows (mechanisms_step.hpp),
// the integration of the crank's motion (crank_step.hpp).
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/output.hpp>
#include <crankloop/phase.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/angle.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/crank/crank_turn.hpp>
#include <crankloop/tick/crank/cylinder_cut.hpp>
#include <crankloop/tick/crank/cylinder_forces.hpp>

namespace crankloop::detail {

/// What a crank that is turned by forces needs of the look-ups.
template <class Real>
struct TurningTorques {
  Real gas_parts_Nm[2]{};      ///< torque of gas: all of it, or motored and heat
  Real inertia_slope_kg_m2{};  ///< torque of masses per w^2
};

/// The torque of a tick, and its work since the tick before.
template <class Real, class S>
struct TorqueStep : If<Needs<S>::crank_dynamics, TurningTorques<Real>> {
  using N = Needs<S>;

  const Tables<Real, S>& tables;
  State<Real, S>& state;
  Output<Real, S>& out;
  Real torque_Nm{};          ///< at the tick; where forces turn the crank that of gas alone, until its speed is known
  Integral<Real> inertia{};  ///< of the torque of masses per w^2
  Integral<Real> gas[2]{};
  Real given_work_J{};  ///< of given pressures, since the last tick

  TorqueStep(const Tables<Real, S>& t, State<Real, S>& s, Output<Real, S>& o) noexcept : tables{t}, state{s}, out{o} {}

  /// Of one cylinder the compiler knows.
  [[nodiscard]] std::uint32_t mechanisms() const noexcept {
    return S::cylinders.capacity == 1 ? 1 : tables.drive->mechanisms;
  }

  /// Torque of tables: they hold that of all cylinders together. Forces add up to it by themselves. Returns where the
  /// crank stands.
  auto read_torque([[maybe_unused]] CutCylinders<S> cut_cylinders) noexcept {
    const auto at = [&] {
      if constexpr (N::gas_torque) {
        return angle_of<Real>(state.phase.units(), 0);
      } else {
        return turn_angle_of<Real>(state.phase.units(), 0);
      }
    }();
    if constexpr (N::inertia_torque) {
      const IntegratedSegment<Real>& s = *address(&tables.inertia_torque->at[at.turn_degree()]);
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
        if constexpr (N::lack) heat_Nm -= CutHeat<Real, S>(tables, state, cut_cylinders).torque_Nm(state.phase);
        gas_Nm += state.load_ratio * heat_Nm;
      } else {
        gas_Nm = gas_torque(*tables.gas_torque_full, segment, at.u, 0);
        if constexpr (N::crank_dynamics) this->gas_parts_Nm[0] = gas_Nm;
      }
      if constexpr (!S::forces || N::crank_dynamics) torque_Nm += gas_Nm;
    }
    return at;
  }

  /// Gas torque by a curve, with its work in gas[which].
  [[nodiscard]] Real gas_torque(const GasTorque<Real>& curve, std::uint32_t segment, Real u, int which) noexcept {
    const IntegratedSegment<Real>& s = *address(&curve.at[segment]);
    if constexpr (N::work) gas[which] = integral_at(s, u, curve.mean_Nm);
    return value(s.slope, u);
  }

  /// What the gas above pistons does: dV/da, and the volume swept since the last tick. Per mechanism.
  struct Swept {
    Real slope_m3[N::given_torque ? S::cylinders.capacity : 1];
    Real volume_m3[N::given_work ? S::cylinders.capacity : 1];
  };
  [[gnu::always_inline]] void read_swept(std::uint32_t m, [[maybe_unused]] std::uint32_t degree,
                                         [[maybe_unused]] Real u, [[maybe_unused]] const Pose<Real>& p,
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

  [[nodiscard]] Real held_pressure_Pa(std::uint32_t k) const noexcept {
    if constexpr (N::gas) {
      return state.cylinder_gas.pressure_Pa[k];
    } else {
      return state.pressure_Pa[k];
    }
  }

  /// Torque and work of gas at given pressures.
  [[gnu::always_inline]] void add_given_pressures(const Swept& swept,
                                                  [[maybe_unused]] const Real* mean_pressure_Pa) noexcept {
    const Drive<Real>& drive = *tables.drive;
    const Real crankcase_Pa = tables.body->crankcase_Pa;
    for (std::uint32_t k = 0; k < count<S>(drive.cylinders); ++k) {
      const std::uint32_t m = drive.mechanism_of[k];
      CRANKLOOP_ASSERT(m < mechanisms());
      if constexpr (N::crank_dynamics || !S::forces)
        torque_Nm += (held_pressure_Pa(k) - crankcase_Pa) * swept.slope_m3[m];
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
      CrankArrival<Real> at{gas_work_J(crank), torque_Nm, inertia_kg_m2(), this->inertia_slope_kg_m2};
      if constexpr (S::cam_drag)
        at.gas_work_J -= crank.cam_drag_Nm * motion.turned_rad(), at.gas_Nm -= crank.cam_drag_Nm;
      motion.arrive(at);
      torque_Nm += this->inertia_slope_kg_m2 * (state.speed_rad_s * state.speed_rad_s);
      out.crank = state.phase;
      motion.show(out);
      if constexpr (S::starter) out.starter_Nm = motion.starter_Nm();
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
  [[nodiscard]] Real add_gas_work([[maybe_unused]] const CrankTurn<Real, S>& crank,
                                  [[maybe_unused]] Real& work_J) noexcept {
    if constexpr (N::gas_torque && N::load) {
      const GasTorque<Real>& motored = *tables.gas_torque_motored;
      const GasTorque<Real>& heat = *tables.gas_torque_heat;
      work_J += difference(state.gas[0], gas[0], motored.quantum);
      Real heat_J = difference(state.gas[1], gas[1], heat.quantum);
      Real heat_mean_Nm = heat.mean_Nm;
      if constexpr (N::lack) {
        const auto lacks =
            CutHeat<Real, S>(tables, state, crank.cut_cylinders).work(state.phase - crank.turned, state.phase);
        heat_J -= lacks.work_J;
        heat_mean_Nm -= lacks.mean_Nm;
      }
      work_J += state.load_ratio * heat_J;
      return motored.mean_Nm + state.load_ratio * heat_mean_Nm;
    } else if constexpr (N::gas_torque) {
      work_J += difference(state.gas[0], gas[0], tables.gas_torque_full->quantum);
      return tables.gas_torque_full->mean_Nm;
    } else if constexpr (N::gas_work) {
      work_J += crank.gas_work_J;
    } else if constexpr (N::given_work) {
      work_J += given_work_J;
    }
    return Real{};
  }

  /// Where forces turn the crank: the gas's work since the last tick.
  [[nodiscard]] Real gas_work_J(const CrankTurn<Real, S>& crank) noexcept {
    const Real turned_rad = crank.motion->turned_rad();
    if constexpr (N::gas_work) return crank.gas_work_J;  // what left the gas, however slow: their energies add up
    if (crawling(crank.turned)) {
      Real before_Nm = crank.motion->gas_before_Nm();
      if constexpr (S::cam_drag) before_Nm += crank.cam_drag_Nm;
      return (before_Nm + torque_Nm) / 2 * turned_rad;
    }
    Real work_J{};
    const Real mean_Nm = add_gas_work(crank, work_J);
    return work_J + mean_Nm * turned_rad;
  }

  /// Work done since the last tick over the angle turned. At a crawl the difference drowns in rounding: there the mean
  /// of the torques at both ends is the better average (docs/decisions/0005-mean-torque.md). After a jump of a measured
  /// phase there is no tick to average over.
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
        if constexpr (N::crank_dynamics)
          w2 = (w2 + crank.motion->speed_before_rad_s() * crank.motion->speed_before_rad_s()) / 2;
        Real work_J = w2 * difference(state.inertia, inertia, tables.inertia_torque->quantum);
        const Real mean_Nm = add_gas_work(crank, work_J);
        out.mean_torque_Nm = work_J * per_rad + mean_Nm;
        CRANKLOOP_ASSERT(is_finite(out.mean_torque_Nm));
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

}  // namespace crankloop::detail
