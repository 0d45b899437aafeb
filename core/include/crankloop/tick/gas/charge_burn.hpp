// How long a cylinder's gas burns, by its state where the burn begins. docs/model.md "Burn by charge".
//
// What belongs here: the law, and when a cycle is asked for it. What does not: how much burns on the way
// (combustion.hpp).
//
//     duration / ordered = (n / n_0)^(1/3) (S_0 / S)^(2/3),   start = spark + delay (duration / ordered of the cycle
//     before)
//     S = (0.305 - 0.549 (phi - 1.21)^2) (T / 298 K)^(2.4 - 0.271 phi^3.51) (p / 1 atm)^(-0.357 + 0.14 phi^2.77)
//         (1 - 2.06 x^0.77)   m/s
//     Metghalchi and Keck 1982; Rhodes and Keck, SAE 850047; exponents 1/3 and 2/3: Hires, Tabaczynski and Novak, SAE
//     780232
#pragma once

#include <cstdint>

#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/burn_start.hpp>

namespace crankloop::detail {

/// log2 of S in m/s. lambda is held to 1/1.4..1/0.7 and the burned share to 0..0.3: beyond, the law is none.
template <class Real>
[[nodiscard]] inline Real flame_octaves(const BurnCharge<Real>& charge) noexcept {
  const auto c = [](double x) { return static_cast<Real>(x); };
  const auto held = [](Real x, Real least, Real most) { return x > least ? (x < most ? x : most) : least; };
  const Real phi = c(1) / held(charge.excess_air_ratio, c(1 / 1.4), c(1 / 0.7)), off = phi - c(1.21);
  const Real x = held(charge.burned_ratio, c(1e-6), c(0.3));
  const Real richness = octaves_of(phi);
  const Real by_K = c(2.4) - c(0.271) * power_of_2(c(3.51) * richness);
  const Real by_Pa = c(-0.357) + c(0.14) * power_of_2(c(2.77) * richness);
  const Real unspoiled = c(1) - c(2.06) * power_of_2(c(0.77) * octaves_of(x));
  return octaves_of((c(0.305) - c(0.549) * off * off) * unspoiled) +
         by_K * octaves_of(charge.temperature_K * c(1.0 / 298)) +
         by_Pa * octaves_of(charge.pressure_Pa * c(1.0 / 101325));
}

/// Duration of a burn over the one ordered.
template <class Real>
[[nodiscard]] inline Real burn_ratio(const ChargeBurnTable<Real>& table, const BurnCharge<Real>& charge,
                                     Real speed_rad_s) noexcept {
  constexpr Real kThird = static_cast<Real>(1.0 / 3), kLeast_rad_s = static_cast<Real>(1e-3);
  const Real speed = magnitude(speed_rad_s);
  const Real by_speed = octaves_of(speed > kLeast_rad_s ? speed : kLeast_rad_s);
  const Real ratio = power_of_2(table.reference + kThird * (by_speed - 2 * flame_octaves(charge)));
  const Real least = kLeastBurn_ratio<Real>, most = kMaxBurn_ratio<Real>;
  return ratio > least ? (ratio < most ? ratio : most) : least;
}

/// Where the burn starts whose fuel a cycle has taken; at most so late that half of the duration ordered is left.
template <class Real>
inline void order_start(BurnStart<Real>& start, CylinderBurn<Real>& burn, const BurnTable<Real>& table,
                        const ChargeBurnTable<Real>& charge_table) noexcept {
  const Real latest_deg = kLatestBurnEnd_deg<Real> - burn.duration_deg * table.span_ratio * kLeastBurn_ratio<Real>;
  const Real wanted_deg = burn.start_deg + charge_table.spark_to_start_deg * start.ratio;
  start.spark_deg = burn.start_deg;
  if (charge_table.in_use != 0) burn.start_deg = wanted_deg < latest_deg ? wanted_deg : latest_deg;
  start.due = charge_table.in_use != 0 && burn.fuel_kg > 0 ? 1 : 0;
}

/// Gives the burn that begins on a cylinder's way its duration. One that would not end in time ends
/// there; none of a state that order_start() made is shorter than 1 deg.
template <class Real, class S>
[[gnu::noinline]] void begin_burn(const Tables<Real, S>& tables, State<Real, S>& state, std::uint32_t cylinder,
                                  const CycleWay& way) noexcept {
  BurnStart<Real>& start = state.charge_burn[cylinder];
  CylinderBurn<Real>& burn = state.burn[cylinder];
  start.due = 0;
  start.ratio = burn_ratio(*tables.charge_burn, charge_at_start(tables, state, cylinder, way), state.speed_rad_s);
  const Real wanted_deg = burn.duration_deg * start.ratio;
  const Real most_deg = (kLatestBurnEnd_deg<Real> - burn.start_deg) / tables.burn->span_ratio;
  const Real held_deg = wanted_deg < most_deg ? wanted_deg : most_deg, duration_deg = held_deg > 1 ? held_deg : Real{1};
  burn.per_deg = Real{1} / (duration_deg * tables.burn->span_ratio);
}

/// As a cycle had it; 0 where nothing burned.
template <class Real, class S>
[[nodiscard]] inline ChargeBurnOutput<Real> burn_of_cycle(const Tables<Real, S>& tables, const State<Real, S>& state,
                                                          std::uint32_t cylinder) noexcept {
  const CylinderBurn<Real>& burn = state.burn[cylinder];
  const BurnStart<Real>& start = state.charge_burn[cylinder];
  if (!(burn.excess_air_ratio > 0) || !(burn.per_deg > 0) || start.due != 0) return {};
  return {burn.start_deg, Real{1} / (burn.per_deg * tables.burn->span_ratio)};
}

}  // namespace crankloop::detail
