// The inputs of an engine's gas, checked each tick: throttle and what is outside, or what is in the manifolds. Fuel and
// burn are checked where a cycle takes them (combustion.hpp).
#pragma once

#include <crankloop/input.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/checked.hpp>

namespace crankloop::detail {

/// What holds until inputs say otherwise.
template <class Real, class S>
[[gnu::cold]] void start_gas_inputs([[maybe_unused]] const Tables<Real, S>& tables,
                                    [[maybe_unused]] State<Real, S>& state) noexcept {
  if constexpr (Needs<S>::manifolds) {
    state.throttle_ratio = Real{1};
  }
  if constexpr (S::boundaries) {
    for (int port = 0; port < kPorts; ++port)
      state.given_gas[port] = {tables.gas_manifolds->outside[port].pressure_Pa, tables.gas_cylinders->ambient_K};
  } else if constexpr (Needs<S>::given_gas) {
    const GasCylinders<Real>& table = *tables.gas_cylinders;
    state.given_gas[kIntake] = {table.ambient_Pa, table.ambient_K};
    state.given_gas[kExhaust] = {table.ambient_Pa, table.exhaust_K};
  }
  if constexpr (Needs<S>::burn) {
    const BurnTable<Real>& table = *tables.burn;
    for (CylinderBurn<Real>& burn : state.burn) {
      burn = {};
      burn.asked_kg = table.fuel_kg, burn.asked_excess_air_ratio = table.excess_air_ratio;
      burn.start_deg = table.burn_start_deg, burn.duration_deg = table.burn_duration_deg;
    }
    if constexpr (Needs<S>::knock) {
      for (KnockRecord<Real>& knock : state.knock)
        knock = {Real{0}, Real{0}, Real{300}, Real{100000}, Real{0}, Real{0}};
      state.knock_due = state.knock_in_burn = 0;
    }
    if constexpr (Needs<S>::charge_burn) {
      for (BurnStart<Real>& start : state.charge_burn) start = {table.burn_start_deg, Real{1}, 0, 0};
    }
  }
}

/// Answers fault bits.
template <class Real, class S>
[[nodiscard]] inline std::uint32_t take_gas_inputs([[maybe_unused]] const Tables<Real, S>& tables,
                                                   [[maybe_unused]] const Input<Real, S>& input,
                                                   [[maybe_unused]] State<Real, S>& state) noexcept {
  std::uint32_t faults = 0;
  [[maybe_unused]] const auto take = [&faults](Real x, Real least, Real most, Real& last, Fault fault) {
    (void)checked(x, within(x, least, most), last, fault, faults);
  };
  if constexpr (Needs<S>::manifolds) {
    take(input.throttle_ratio, Real{0}, Real{1}, state.throttle_ratio, kFaultManifold);
  }
  if constexpr (Needs<S>::given_gas) {
    const auto real = [](double x) { return static_cast<Real>(x); };
    const auto given = [&](Real pressure_Pa, Real temperature_K, GivenGas<Real>& last) {
      take(pressure_Pa, real(kLeastManifold_Pa), real(kMaxManifold_Pa), last.pressure_Pa, kFaultManifold);
      take(temperature_K, real(kLeastManifold_K), real(kMaxManifold_K), last.temperature_K, kFaultManifold);
    };
    if constexpr (S::boundaries) {
      const GasBeyond<Real>* const defined = tables.gas_manifolds->outside;
      const auto or_defined = [](Real x, Real as_defined) { return x == 0 ? as_defined : x; };
      const Real ambient_K = or_defined(input.ambient_K, tables.gas_cylinders->ambient_K);
      given(or_defined(input.ambient_Pa, defined[kIntake].pressure_Pa), ambient_K, state.given_gas[kIntake]);
      given(or_defined(input.back_Pa, defined[kExhaust].pressure_Pa), ambient_K, state.given_gas[kExhaust]);
    } else {
      given(input.intake_Pa, input.intake_K, state.given_gas[kIntake]);
      given(input.exhaust_Pa, input.exhaust_K, state.given_gas[kExhaust]);
    }
  }
  return faults;
}

}  // namespace crankloop::detail
