// What burns in a cylinder's step: fuel and burn taken once in a cycle, by a Wiebe law over the crank angle.
// docs/model.md "Gas".
//
// What belongs here: when a cycle takes its fuel, how much of it burns, what that adds. What does not: what the gas
// makes of it (cylinder_gas.hpp).
#pragma once

#include <cstdint>

#include <crankloop/faults.hpp>
#include <crankloop/input.hpp>
#include <crankloop/phase.hpp>
#include <crankloop/tables/gas_tables.hpp>
#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/crank/cycle_way.hpp>
#include <crankloop/tick/gas/cylinder_gas.hpp>
#include <crankloop/tick/gas/gas_state.hpp>

namespace crankloop::detail {

/// The share of a cycle's fuel that its air can burn: less than 1 in a rich mixture.
template <class Real>
[[nodiscard]] constexpr Real burning_ratio(const CylinderBurn<Real>& burn) noexcept {
  constexpr Real kLeast = static_cast<Real>(kLeastBurning_ratio);
  if (!(burn.excess_air_ratio < 1)) return Real{1};
  return burn.excess_air_ratio > kLeast ? burn.excess_air_ratio : kLeast;
}

/// What the air in a cylinder can burn.
template <class Real>
[[nodiscard]] constexpr Real fuel_for_air_kg(const BurnTable<Real>& table, const Real& mass_kg,
                                             const Real& burned_kg) noexcept {
  const Real air_kg = mass_kg > burned_kg ? mass_kg - burned_kg : Real{0};
  return air_kg * table.per_air_fuel_ratio;
}

/// Takes a cycle's fuel, given or by the air that is there: at most 1 / kLeastBurning_ratio of what that air burns;
/// less than kLeastFuel_kg is none. What is out of range, or a burn that would not end in time, is that of the cycle
/// before. Answers fault bits.
template <class Real>
[[gnu::noinline]] std::uint32_t take_fuel(CylinderBurn<Real>& burn, const BurnTable<Real>& table, const Real& mass_kg,
                                          const Real& burned_kg, const BurnOrder<Real>& order, bool cut) noexcept {
  std::uint32_t faults = 0;
  constexpr Real kMost_kg = static_cast<Real>(kMaxFuel_kg);
  (void)checked(order.fuel_kg, within_positive(order.fuel_kg, kMost_kg), burn.asked_kg, kFaultBurn, faults);
  (void)checked(order.excess_air_ratio, within_positive(order.excess_air_ratio, static_cast<Real>(kMaxExcessAir_ratio)),
                burn.asked_excess_air_ratio, kFaultBurn, faults);
  const bool good = within(order.start_deg, Real{-90}, Real{60}) && within(order.duration_deg, Real{5}, Real{150}) &&
                    order.start_deg + order.duration_deg * table.span_ratio <= kLatestBurnEnd_deg<Real>;
  if (good) {
    burn.start_deg = order.start_deg, burn.duration_deg = order.duration_deg;
  } else {
    faults |= kFaultBurn;
  }
  burn.per_deg = Real{1} / (burn.duration_deg * table.span_ratio);
  const Real most_kg = fuel_for_air_kg(table, mass_kg, burned_kg);
  Real asked_kg = burn.asked_kg;
  if (burn.asked_excess_air_ratio > 0) {
    const bool within_limit = most_kg < kMost_kg * burn.asked_excess_air_ratio;
    asked_kg = within_limit ? most_kg / burn.asked_excess_air_ratio : kMost_kg;
  }
  const bool burns = !cut && asked_kg >= static_cast<Real>(kLeastFuel_kg);
  const Real fuel_kg = burns ? asked_kg : Real{0};
  const Real counts_kg = most_kg * static_cast<Real>(1 / kLeastBurning_ratio);
  burn.fuel_kg = fuel_kg < counts_kg ? fuel_kg : counts_kg;
  burn.excess_air_ratio = fuel_kg > 0 ? most_kg / fuel_kg : Real{0};
  burn.burnt_ratio = Real{0};
  burn.taken = 1;
  return faults;
}

/// Fuel that burns on the way: what is due, no more than there is air for. What has burned does not burn again where
/// the crank turns back; what found no air burns where it finds some. Of a rich mixture what the air cannot burn turns
/// into burned gas of 25 C as the rest burns.
template <class Real>
[[nodiscard]] inline GasFuel<Real> burnt_fuel(CylinderBurn<Real>& burn, const BurnTable<Real>& table,
                                              const Real& mass_kg, const Real& burned_kg,
                                              const CycleWay& way) noexcept {
  if (!(burn.fuel_kg > 0)) return {};
  const Real s = (way.deg<Real>() - burn.start_deg) * burn.per_deg;
  if (!(s > 0)) return {};
  Real burnt = Real{1};
  if (s < 1) {
    const Real place = s * Real{kBurnSteps};
    const auto row = static_cast<std::int32_t>(place);
    burnt = table.burnt[row] + (table.burnt[row + 1] - table.burnt[row]) * (place - static_cast<Real>(row));
  }
  if (!(burnt > burn.burnt_ratio)) return {};
  Real fuel_kg = burn.fuel_kg * (burnt - burn.burnt_ratio);
  const Real burning = burning_ratio(burn);
  const Real most_kg = fuel_for_air_kg(table, mass_kg, burned_kg);
  if (fuel_kg * burning > most_kg) {
    fuel_kg = most_kg / burning;
    const Real reached = burn.burnt_ratio + fuel_kg / burn.fuel_kg;
    if (reached < burnt) burnt = reached;  // more by rounding alone
  }
  burn.burnt_ratio = burnt;
  if (!(s < 1)) burn.fuel_kg = Real{0};
  const Real unburnt = Real{1} - burning;
  return {fuel_kg, fuel_kg * (table.energy_J_kg - unburnt * table.burning_J_kg),
          fuel_kg * (table.burned_kg_kg - unburnt * table.air_fuel_ratio)};
}

template <class Real>
constexpr void end_burn(CylinderBurn<Real>& burn) noexcept {
  burn.taken = 0;
  burn.fuel_kg = Real{0};
}

}  // namespace crankloop::detail
