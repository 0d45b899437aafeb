// The gas of a cylinder where its burn begins, within a step.
//
// What belongs here: that state. What does not: what follows from it (charge_burn.hpp, knock.hpp).
#pragma once

#include <cstdint>

#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/combustion.hpp>
#include <crankloop/tick/gas/gas_places.hpp>
#include <crankloop/tick/gas/octaves.hpp>
#include <crankloop/tick/gas/wall_heat.hpp>

namespace crankloop::detail {

/// What a burn begins with.
template <class Real>
struct BurnCharge {
  Real temperature_K, pressure_Pa, burned_ratio;
  Real excess_air_ratio;  ///< lambda, above 0
};

/// The gas of a cylinder where it passes `deg` on its way, `on_deg` after the start of the step: as it was there,
/// compressed, and cooled by the mean of the heat to its walls there and here.
template <class Real, class S>
[[nodiscard]] inline BurnCharge<Real> charge_at(const Tables<Real, S>& tables, const State<Real, S>& state,
                                                std::uint32_t cylinder, Real deg, Real on_deg) noexcept {
  constexpr Real kHalf = static_cast<Real>(0.5);
  const CylinderGas<Real> gas = state.cylinder_gas.template at<Real>(cylinder);
  const GasPoint<Real>& at = gas.point;
  const GasWalls<Real>& walls = walls_of(tables, state, cylinder);
  const std::uint32_t mechanism = tables.drive->mechanism_of[cylinder];
  const Phase in_cycle = Phase::from_cycles(deg * static_cast<Real>(1.0 / kDegreesPerCycle));
  const Real volume_m3 = gas_volume_m3(tables, in_cycle.units() + tables.drive->firing_phase[mechanism], mechanism);
  const Real by_volume = gas.volume_m3 / volume_m3, octaves = octaves_of(by_volume);
  const Real rise_K = at.temperature_K * (power_of_2(at.gas_ratio * octaves) - Real{1});
  const Real mean_ratio =
      at.gas_ratio / (Real{1} + kHalf * kHeatSlope<Real> * kPerGasConstant<Real> * at.gas_ratio * rise_K);
  Real warmer = power_of_2(mean_ratio * octaves);
  const auto charge = [&] {
    return GasPoint<Real>{at.pressure_Pa * by_volume * warmer, at.temperature_K * warmer, at.burned_ratio,
                          at.gas_ratio};
  };
  const Real speed_rad_s = magnitude(state.speed_rad_s), stirring = stirring_m_s(walls, speed_rad_s);
  const Real wall_W =
      kHalf * (wall_heat_W(walls, at, gas.volume_m3, stirring) + wall_heat_W(walls, charge(), volume_m3, stirring));
  const Real way_s = speed_rad_s > 0 ? on_deg * static_cast<Real>(kRadPerDegree) / speed_rad_s : Real{0};
  warmer *=
      Real{1} - held_within(wall_W * way_s * mean_ratio / (at.pressure_Pa * gas.volume_m3), static_cast<Real>(0.25));
  const GasPoint<Real> there = charge();
  return {there.temperature_K, there.pressure_Pa, there.burned_ratio, state.burn[cylinder].excess_air_ratio};
}

/// Where a cylinder's burn begins on its way.
template <class Real, class S>
[[nodiscard]] inline BurnCharge<Real> charge_at_start(const Tables<Real, S>& tables, const State<Real, S>& state,
                                                      std::uint32_t cylinder, const CycleWay& way) noexcept {
  const Real start_deg = state.burn[cylinder].start_deg, from_deg = way.deg<Real>() - way.turned_deg<Real>();
  const Real deg = start_deg > from_deg ? start_deg : from_deg;
  return charge_at(tables, state, cylinder, deg, deg - from_deg);
}

}  // namespace crankloop::detail
