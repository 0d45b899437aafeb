// How the crank comes to its next angle: what a tick's crank part takes and gives besides tables, state and output.
#pragma once

#include <cstdint>

#include <crankloop/phase.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/crank/crank_step.hpp>
#include <crankloop/tick/crank/cylinder_cut.hpp>

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

/// Work of the gas on the crank in the tick, against the crankcase's pressure.
template <class Real>
struct GasWorkOfTick {
  Real gas_work_J;
};

/// What a tick's crank part takes and gives besides tables, state and output.
template <class Real, class S>
struct CrankTurn : If<Needs<S>::cut, CutOfTick>,
                   If<Needs<S>::crank_dynamics, MotionOfTick<Real>>,
                   If<Needs<S>::gas_work, GasWorkOfTick<Real>> {
  Phase turned;         ///< in this tick
  bool jumped = false;  ///< nobody knows how it got there; has_jumped() after the first tick
  Real mean_pressure_Pa[Needs<S>::given_work ? S::cylinders.capacity : 1];  ///< over the tick, where they do work
  Real head_pressure_Pa[S::valve_gas ? S::cylinders.capacity : 1];          ///< at its end, for the valves

  /// Known when compiled where no crank is measured.
  [[nodiscard]] bool has_jumped() const noexcept { return S::crank == CrankGiven::phase && jumped; }
};

/// Where forces turn the crank: mean torque of the gas over a cycle as it is at the tick; 0 of given pressures, which
/// are no cycle.
template <class Real, class S>
[[nodiscard]] Real mean_gas_Nm([[maybe_unused]] const Tables<Real, S>& tables, [[maybe_unused]] Real load_ratio,
                               [[maybe_unused]] std::uint32_t cut_cylinders) noexcept {
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

}  // namespace crankloop::detail
