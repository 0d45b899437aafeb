// Walls that warm up: those of each cylinder, a heat capacity between gas and coolant, and those of manifolds or
// runners, at a temperature that is given. docs/model.md "Walls".
//
// What belongs here: temperatures of walls, what crevices at them have, heat of manifolds and runners. What does not:
// the heat of a cylinder's gas to its walls (wall_heat.hpp).
//
//     C dT_w/dt = q_w - G (T_w - T_coolant),   dU/dt = -g (T - T_a)
#pragma once

#include <crankloop/tables/gas_tables.hpp>
#include <crankloop/tick/gas/crevice.hpp>
#include <crankloop/tick/gas/gas_state.hpp>
#include <crankloop/tick/gas/orifice.hpp>

namespace crankloop::detail {

/// As GasWalls, each cylinder at its own temperature.
template <class T>
struct WarmWalls {
  NumberOf<T> heat_factor, area_m2, area_per_m3;
  T temperature_K;

  [[gnu::always_inline]] WarmWalls(const GasWalls<NumberOf<T>>& walls, const T& wall_K) noexcept
      : heat_factor{walls.heat_factor}, area_m2{walls.area_m2}, area_per_m3{walls.area_per_m3}, temperature_K{wall_K} {}
};

/// As GasCrevice, at the temperatures of walls.
template <class T>
struct WarmCrevice {
  using Real = NumberOf<T>;
  T kg_per_Pa, wall_K, specific_work_J_kg, energy_J_kg, burned_more_J_kg, leak_kg_s_Pa;
  Real crankcase_Pa;
  bool leaks;

  [[gnu::always_inline]] WarmCrevice(const GasCrevice<Real>& at, const T& kelvin) noexcept
      : wall_K{kelvin}, crankcase_Pa{at.crankcase_Pa}, leaks{at.leak_kg_s_Pa > 0} {
    // From the table's, so that at the table's temperature they have its very bits.
    const T cooler = at.wall_K / kelvin, warmer = kelvin / at.wall_K;
    kg_per_Pa = at.kg_per_Pa * cooler, leak_kg_s_Pa = at.leak_kg_s_Pa * square_root(cooler);
    specific_work_J_kg = at.specific_work_J_kg * warmer, burned_more_J_kg = at.burned_more_J_kg * warmer;
    energy_J_kg = at.energy_J_kg + (kelvin - at.wall_K) * (Real{646} + kHeatSlope<Real> / 2 * (kelvin + at.wall_K));
  }
};
template <class T>
[[nodiscard, gnu::always_inline]] inline bool leaks(const WarmCrevice<T>& table) noexcept {
  return table.leaks;
}

/// The walls of a cylinder over `time_s` in which its gas gave them `heat_J`; implicit in their heat to the coolant.
/// `crevice_J_K`: what the gas in the crevices adds to their capacity, so that no energy is lost as it warms with them.
/// Leaves in `heat_J` what rounding of the temperature leaves out. Answers false for walls that no engine has, which
/// are put back among the others.
template <class Real>
[[nodiscard]] inline bool step_walls(Real& wall_K, Real& heat_J, const WarmWallsTable<Real>& table,
                                     const Real& crevice_J_K, const Real& time_s) noexcept {
  constexpr Real kLeast_K = static_cast<Real>(kLeastGas_K), kMax_K = static_cast<Real>(kMaxGas_K);
  if (!(table.capacity_J_K > 0)) return heat_J = Real{0}, true;  // fixed
  const Real to_coolant_J_K = time_s * table.to_coolant_W_K;
  const Real capacity_J_K = table.capacity_J_K + crevice_J_K + to_coolant_J_K;
  const Real gets_J = heat_J + to_coolant_J_K * (table.coolant_K - wall_K);
  const Real to_K = wall_K + gets_J / capacity_J_K;
  if (!(to_K >= kLeast_K && to_K <= kMax_K)) {
    wall_K = to_K > kMax_K ? kMax_K : kLeast_K, heat_J = Real{0};
    return false;
  }
  heat_J = gets_J - (to_K - wall_K) * capacity_J_K;
  wall_K = to_K;
  return true;
}

/// Heat of the gas in a manifold or at a port to its walls in a step; implicit, by the specific heat midway to them.
template <class Real>
[[nodiscard]] inline Real lose_heat(GasContents<Real>& gas, GasPoint<Real>& point, const Real& per_volume_m3,
                                    Real wall_W_K, Real wall_K, Real step_s) noexcept {
  const Real warmer_K = point.temperature_K - wall_K;
  const Real own_J_K = gas.mass_kg * (kGasConstant<Real> / point.gas_ratio - kHeatSlope<Real> / 2 * warmer_K);
  const Real passes_J_K = step_s * wall_W_K;
  const Real heat_J = warmer_K * (own_J_K * passes_J_K / (own_J_K + passes_J_K));
  gas.add(Real{0}, -heat_J, Real{0});
  point = point_of(gas, per_volume_m3);
  return heat_J;
}

}  // namespace crankloop::detail
