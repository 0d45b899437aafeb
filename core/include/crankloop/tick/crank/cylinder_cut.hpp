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
template <class Real>
struct LackingHeat {
  std::uint32_t lacking;  ///< bit k: cylinder k, for either reason
  std::uint32_t cut;
  const Real* burning_ratio;  ///< of each cylinder's cycle

  [[nodiscard]] Real share(std::uint32_t k) const noexcept { return (cut >> k & 1u) != 0 ? Real{0} : burning_ratio[k]; }
};
/// What a tick knows of them: in scenes without misfires which are cut.
template <class Real, class S>
using CutCylinders = std::conditional_t<Needs<S>::misfire_of_table, LackingHeat<Real>, std::uint32_t>;

template <class Real, class S>
[[nodiscard]] CutCylinders<Real, S> cut_cylinders_of([[maybe_unused]] const Drive<Real>& drive,
                                                     [[maybe_unused]] const State<Real, S>& state,
                                                     std::uint32_t cut) noexcept {
  if constexpr (Needs<S>::misfire_of_table) {
    std::uint32_t lacking = cut;
    for (std::uint32_t k = 0; k < count<S>(drive.cylinders); ++k)
      lacking |= std::uint32_t{state.burning_ratio[k] < 1} << k;
    return {lacking, cut, state.burning_ratio};
  } else {
    return cut;
  }
}

template <class Real, class S>
class CutHeat {
 public:
  /// Bits of `cut` beyond the engine's cylinders mean nothing.
  CutHeat(const Tables<Real, S>& tables, CutCylinders<Real, S> cut) noexcept : tables_{tables}, cut_{cut} {}

  /// At load ratio 1, of all that lack heat.
  [[nodiscard]] Real torque_Nm(Phase phase) const noexcept {
    Real sum{};
    for_each([&](std::uint32_t k) {
      const Angle<Real> at = own_angle(k, phase);
      sum += lacked(k, value(segment(at).slope, at.u));
    });
    return sum;
  }

  /// Heat work at load ratio 1 of all cylinders that lack heat between two phases: work_J, less that of mean_Nm.
  struct Work {
    Real work_J;
    Real mean_Nm;
  };
  [[nodiscard]] Work work(Phase from, Phase to) const noexcept {
    const GasTorque<Real>& heat = *tables_.cut_torque;
    Work sum{};
    for_each([&](std::uint32_t k) {
      sum.work_J += lacked(k, difference(integral(k, from), integral(k, to), heat.quantum));
      sum.mean_Nm += lacked(k, heat.mean_Nm);
    });
    return sum;
  }

  /// Mean torque over a cycle at load ratio 1, of all that lack heat.
  [[nodiscard]] Real mean_Nm() const noexcept {
    Real sum{};
    for_each([&]([[maybe_unused]] std::uint32_t k) { sum += lacked(k, tables_.cut_torque->mean_Nm); });
    return sum;
  }

 private:
  /// What cylinder k lacks of `all`: of a cut one that is all of it.
  [[nodiscard, gnu::always_inline]] Real lacked([[maybe_unused]] std::uint32_t k, Real all) const noexcept {
    if constexpr (Needs<S>::misfire_of_table) {
      return (Real{1} - cut_.share(k)) * all;
    } else {
      return all;
    }
  }
  template <class Visit>
  void for_each(const Visit& visit) const noexcept {
    std::uint32_t lacking;
    if constexpr (Needs<S>::misfire_of_table) {
      lacking = cut_.lacking;
    } else {
      lacking = cut_;
    }
    if (lacking == 0) return;
    for (std::uint32_t k = 0; k < count<S>(tables_.drive->cylinders); ++k) {
      if ((lacking >> k & 1u) != 0) visit(k);
    }
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
  CutCylinders<Real, S> cut_;
};

}  // namespace crankloop::detail
