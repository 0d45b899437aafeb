// What the engine's gas torque lacks where cylinders do not fire, or burn a share: the torque of their heat, and its
// work.
//
// What belongs here: look-ups of cylinders that lack heat, at both ends of a tick, so that a mask that changes from
// tick to tick leaves no jump in the work. What does not: the torque of all cylinders (tick/crank/torque_step.hpp).
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/state.hpp>
#include <crankloop/tables/angle.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/checked.hpp>

namespace crankloop::detail {

/// Cylinders that lack heat: cut ones lack all of it, the others what their cycles do not burn.
struct LackingHeat {
  std::uint32_t lacking;  ///< bit k: cylinder k, for either reason
  std::uint32_t cut;
};
/// What a tick knows of them: in scenes without misfires which are cut.
template <class S>
using CutCylinders = std::conditional_t<Needs<S>::misfire_of_table, LackingHeat, std::uint32_t>;

template <class Real, class S>
[[nodiscard]] CutCylinders<S> cut_cylinders_of([[maybe_unused]] const State<Real, S>& state,
                                               std::uint32_t cut) noexcept {
  if constexpr (Needs<S>::misfire_of_table) {
    return {state.lacking_heat | cut, cut};
  } else {
    return cut;
  }
}

/// Share of its heat that cylinder k has.
template <class Real, class S>
[[nodiscard]] inline Real heat_share(const State<Real, S>& state, LackingHeat lacks, std::uint32_t k) noexcept {
  return (lacks.cut >> k & 1u) != 0 ? Real{0} : state.burning_ratio[k];
}

template <class Real, class S>
class CutHeat {
 public:
  /// Bits of `cut` beyond the engine's cylinders mean nothing.
  CutHeat(const Tables<Real, S>& tables, const State<Real, S>& state, CutCylinders<S> cut) noexcept
      : tables_{tables}, state_{state}, cut_{cut} {}

  /// At load ratio 1, of all that lack heat.
  [[nodiscard]] Real torque_Nm(Phase phase) const noexcept {
    return sum_of_lacking<Real>([this, phase](Real& sum, std::uint32_t k) {
      const Angle<Real> at = own_angle(k, phase);
      sum += lacked(k, value(segment(at).slope, at.u));
    });
  }

  /// Heat work at load ratio 1 of all cylinders that lack heat between two phases: work_J, less that of mean_Nm.
  struct Work {
    Real work_J;
    Real mean_Nm;
  };
  [[nodiscard]] Work work(Phase from, Phase to) const noexcept {
    return sum_of_lacking<Work>([this, from, to](Work& sum, std::uint32_t k) {
      const GasTorque<Real>& heat = *tables_.cut_torque;
      sum.work_J += lacked(k, difference(integral(k, from), integral(k, to), heat.quantum));
      sum.mean_Nm += lacked(k, heat.mean_Nm);
    });
  }

  /// Mean torque over a cycle at load ratio 1, of all that lack heat.
  [[nodiscard]] Real mean_Nm() const noexcept {
    return sum_of_lacking<Real>([this]([[maybe_unused]] Real& sum, [[maybe_unused]] std::uint32_t k) {
      sum += lacked(k, tables_.cut_torque->mean_Nm);
    });
  }

 private:
  /// What cylinder k lacks of `all`: of a cut one that is all of it.
  [[nodiscard, gnu::always_inline]] Real lacked([[maybe_unused]] std::uint32_t k, Real all) const noexcept {
    if constexpr (Needs<S>::misfire_of_table) {
      return (Real{1} - heat_share(state_, cut_, k)) * all;
    } else {
      return all;
    }
  }
  /// Where rules may make cylinders lack heat the sum is a call of its own: ticks without one stay short.
  template <class Sum, class Add>
  [[nodiscard, gnu::always_inline]] Sum sum_of_lacking(const Add& add) const noexcept {
    if constexpr (Needs<S>::misfire_of_table) {
      if (__builtin_expect(cut_.lacking != 0, 0)) return sum_apart<Sum>(add, cut_.lacking);
      return Sum{};
    } else {
      return cut_ == 0 ? Sum{} : sum_over<Sum>(add, cut_);
    }
  }
  template <class Sum, class Add>
  [[nodiscard, gnu::noinline]] Sum sum_apart(Add add, std::uint32_t lacking) const noexcept {
    return sum_over<Sum>(add, lacking);
  }
  template <class Sum, class Add>
  [[nodiscard]] Sum sum_over(const Add& add, std::uint32_t lacking) const noexcept {
    Sum sum{};
    for (std::uint32_t k = 0; k < count<S>(tables_.drive->cylinders); ++k) {
      if ((lacking >> k & 1u) != 0) add(sum, k);
    }
    return sum;
  }
  /// In the cylinder's own cycle.
  [[nodiscard]] Angle<Real> own_angle(std::uint32_t k, Phase phase) const noexcept {
    const Drive<Real>& drive = *tables_.drive;
    const Angle<Real> at = angle_of<Real>(phase.units(), drive.firing_phase[drive.mechanism_of[k]]);
    return {at.delayed(drive.turn_of[k]), at.u};
  }
  [[nodiscard]] const IntegratedSegment<Real>& segment(const Angle<Real>& at) const noexcept {
    return tables_.cut_torque->at[tables_.cut_grid->segment(at.cell)];
  }
  [[nodiscard]] Integral<Real> integral(std::uint32_t k, Phase phase) const noexcept {
    const Angle<Real> at = own_angle(k, phase);
    return integral_at(segment(at), at.u, tables_.cut_torque->mean_Nm);
  }

  const Tables<Real, S>& tables_;
  const State<Real, S>& state_;
  CutCylinders<S> cut_;
};

}  // namespace crankloop::detail
