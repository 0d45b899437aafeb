// How far the unburned gas of a cylinder has come to igniting by itself. docs/model.md "Knock".
//
// What belongs here: the integral and the temperature that it needs. What does not: where a burn begins
// (burn_start.hpp).
//
//     K = integral of dt / tau from the burn's start to a burned fraction of 0.95
//     tau = 17.68 ms (ON / 100)^3.402 p^-1.7 exp(3800 K / T_u), p in atm: Douaud and Eyzat, SAE 780080
//     d ln T_u = R / (cv(T_u, x) + R) d ln p                            unburned gas, without heat to walls
#pragma once

#include <crankloop/tables/gas_tables.hpp>
#include <crankloop/tick/gas/burn_start.hpp>
#include <crankloop/tick/gas/combustion.hpp>
#include <crankloop/tick/gas/gas_state.hpp>
#include <crankloop/tick/gas/octaves.hpp>

namespace crankloop::detail {

template <class Real>
inline constexpr Real kKnockEnd_ratio = static_cast<Real>(0.95);  ///< burned fraction
template <class Real>
inline constexpr Real kMaxKnock = static_cast<Real>(1e6);

/// For a cycle that has taken its fuel.
template <class Real>
constexpr void reset_knock(KnockRecord<Real>& knock) noexcept {
  knock.integral_ratio = knock.passes_deg = knock.burnt_ratio = Real{0};
}

template <class Real>
constexpr void begin_knock(KnockRecord<Real>& knock, const BurnCharge<Real>& charge) noexcept {
  knock.unburned_K = charge.temperature_K, knock.pressure_Pa = charge.pressure_Pa;
  knock.burned_ratio = charge.burned_ratio;
}

/// Compresses the unburned gas to `to_Pa`; answers its mean temperature meanwhile.
template <class Real>
[[nodiscard]] inline Real compress_unburned(KnockRecord<Real>& knock, const Real& to_Pa) noexcept {
  const auto c = [](double x) { return static_cast<Real>(x); };
  const Real heat = heat_at_0_K(knock.burned_ratio) + kGasConstant<Real>, from_K = knock.unburned_K;
  const Real z = c(2) * (to_Pa - knock.pressure_Pa) / (to_Pa + knock.pressure_Pa), z2 = z * z;
  const Real half = c(0.5) * z * (c(1) + z2 * (c(1.0 / 12) + z2 * c(1.0 / 80)));  // of ln(p1 / p)
  const auto share = [&heat](const Real& kelvin) { return kGasConstant<Real> / (heat + kHeatSlope<Real> * kelvin); };
  const Real by_mean = half * share(from_K * (c(1) + half * share(from_K)));
  const Real wanted_K = from_K * (c(1) + by_mean) / (c(1) - by_mean);
  const Real least_K = c(kLeastGas_K), most_K = c(kMaxGas_K);
  const Real to_K = wanted_K > least_K ? (wanted_K < most_K ? wanted_K : most_K) : least_K;
  knock.unburned_K = to_K;
  return c(0.5) * (from_K + to_K);
}

/// A step of a cylinder in its burn, at whose end it is at `to_Pa`. Answers whether the burn goes on.
template <class Real>
[[nodiscard]] inline bool step_knock(KnockRecord<Real>& knock, const KnockTable<Real>& table,
                                     const CylinderBurn<Real>& burn, const Real& to_Pa, const Real& step_s,
                                     const CycleWay& way) noexcept {
  const auto c = [](double x) { return static_cast<Real>(x); };
  const Real mean_Pa = c(0.5) * (knock.pressure_Pa + to_Pa), mean_K = compress_unburned(knock, to_Pa);
  knock.pressure_Pa = to_Pa;
  const Real per_s = power_of_2(table.rate + c(1.7) * octaves_of(mean_Pa) - table.hot_K / mean_K);
  // Which part of the step is in the burn.
  const auto to_deg = [&way] { return way.deg<Real>(); };
  const auto turned_deg = [&way] { return way.turned_deg<Real>(); };
  Real begins{}, ends = c(1);
  const Real was = knock.burnt_ratio, end = kKnockEnd_ratio<Real>;
  if (!(was > 0) && burn.start_deg > to_deg() - turned_deg() && burn.start_deg < to_deg())
    begins = c(1) - (to_deg() - burn.start_deg) / turned_deg();
  if (!(burn.burnt_ratio < end)) ends = burn.burnt_ratio > was ? (end - was) / (burn.burnt_ratio - was) : Real{0};
  const bool goes_on = burn.burnt_ratio < end && burn.fuel_kg > 0;
  knock.burnt_ratio = burn.burnt_ratio;
  if (!(ends > begins)) return goes_on;
  const Real rises = per_s * step_s * (ends - begins), before = knock.integral_ratio;
  const Real after = before + rises;
  knock.integral_ratio = after < kMaxKnock<Real> ? after : kMaxKnock<Real>;
  if (before < 1 && !(after < 1))
    knock.passes_deg = to_deg() - turned_deg() * (c(1) - begins - (ends - begins) * ((c(1) - before) / rises));
  return goes_on;
}

}  // namespace crankloop::detail
