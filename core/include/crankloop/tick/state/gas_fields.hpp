// The list of a state's fields, its part of gas exchange: contents of cylinders, crevices, runners and manifolds,
// walls, burns, knock, and the records of a cycle.
//
// What belongs here: these fields' order and their ranges. What does not: all others, and what a list is for
// (state_fields.hpp); whether the numbers agree with one another (gas_agrees.hpp).
#pragma once

#include <cstdint>

#include <crankloop/input.hpp>
#include <crankloop/state.hpp>

namespace crankloop::detail {

/// Of numbers that are only compared, subtracted and output.
template <class Real>
inline constexpr Real kMaxNoted = static_cast<Real>(1e18);

template <class Real, class S>
struct GasFields {
  template <class AState, class Visitor>
  static constexpr void visit(AState& s, Visitor& v) noexcept {
    using N = Needs<S>;
    const auto numbers = [&v](Real most, auto&... x) { (v.number(x, -most, most), ...); };
    v.group("state.gas");
    for (std::uint32_t k = 0; k < S::cylinders.capacity; ++k) {
      auto& gas = s.cylinder_gas;
      contents(gas.mass_kg[k], gas.mass_rest_kg[k], gas.energy_J[k], gas.energy_rest_J[k], gas.burned_kg[k],
               gas.burned_rest_kg[k], v);
      point(gas.pressure_Pa[k], gas.temperature_K[k], gas.burned_ratio[k], gas.gas_ratio[k], v);
      v.number(gas.volume_m3[k], Real{0}, Real{100});
      for (auto& area : gas.area_m2) v.number(area[k], Real{0}, Real{100});
      numbers(kMaxGas_J, gas.wall_heat_W[k]);
      v.number(gas.pressure_before_Pa[k], Real{0}, static_cast<Real>(1e12));
      v.spare(gas.spare[k]);
    }
    if constexpr (S::crevice) {
      v.group("state.crevice");
      auto& gas = s.crevice_gas;
      for (std::uint32_t k = 0; k < sizeof gas.mass_kg / sizeof gas.mass_kg[0]; ++k) {
        v.number(gas.mass_kg[k], -kMaxGas_kg, kMaxGas_kg);  // below 0 by rounding alone: gas_agrees.hpp
        v.number(gas.burned_kg[k], -kMaxGas_kg, kMaxGas_kg);
        if constexpr (S::gas_results) numbers(kMaxNoted<Real>, s.cycle_blow_by_kg[k]);
      }
      v.group("state.gas");
    }
    if constexpr (S::runners) {
      v.group("state.runner");  // all 0 of a port without one: gas_agrees.hpp
      for (auto& of_port : s.runner) {
        for (auto& r : of_port) {
          auto& c = r.contents;
          auto& p = r.point;
          numbers(kMaxGas_kg, c.mass_kg, c.mass_rest_kg);
          numbers(kMaxGas_J, c.energy_J, c.energy_rest_J);
          numbers(kMaxGas_kg, c.burned_kg, c.burned_rest_kg);
          v.number(p.pressure_Pa, Real{0}, static_cast<Real>(1e12));
          v.number(p.temperature_K, Real{0}, static_cast<Real>(kMaxGas_K * 2));
          v.number(p.burned_ratio, Real{0}, Real{1});
          v.number(p.gas_ratio, Real{0}, static_cast<Real>(0.45));
          numbers(static_cast<Real>(1e6), r.flow_kg_s, r.flow_rest_kg_s);
        }
      }
      v.group("state.gas");
    }
    if constexpr (S::walls) {
      v.group("state.walls");
      for (auto& wall : s.wall_K) v.number(wall, static_cast<Real>(kLeastGas_K), static_cast<Real>(kMaxGas_K));
      for (auto& heat : s.wall_heat_J) numbers(kMaxGas_J, heat);
      v.group("state.gas");
    }
    if constexpr (N::manifolds) {
      for (auto& manifold : s.manifold) {
        auto& c = manifold.contents;
        auto& p = manifold.point;
        contents(c.mass_kg, c.mass_rest_kg, c.energy_J, c.energy_rest_J, c.burned_kg, c.burned_rest_kg, v);
        point(p.pressure_Pa, p.temperature_K, p.burned_ratio, p.gas_ratio, v);
      }
      numbers(kMaxGas_kg_s, s.taken_kg_s[kIntake], s.taken_kg_s[kExhaust]);
      v.number(s.outlet.temperature_K, static_cast<Real>(kLeastGas_K / 2), static_cast<Real>(kMaxGas_K * 2));
      v.number(s.outlet.burned_ratio, Real{0}, Real{1});
      v.number(s.throttle_ratio, Real{0}, Real{1});
      v.spare(s.spare_of_manifolds);
    }
    if constexpr (N::given_gas) {
      for (auto& given : s.given_gas) {
        v.number(given.pressure_Pa, static_cast<Real>(kLeastManifold_Pa), static_cast<Real>(kMaxManifold_Pa));
        v.number(given.temperature_K, static_cast<Real>(kLeastManifold_K), static_cast<Real>(kMaxManifold_K));
      }
    }
    if constexpr (N::burn) {
      v.group("state.burn");
      for (auto& burn : s.burn) {
        v.number(burn.fuel_kg, Real{0}, static_cast<Real>(kMaxFuel_kg));
        v.number(burn.burnt_ratio, Real{0}, Real{1});
        v.number(burn.start_deg, Real{-90}, N::charge_burn ? kLatestBurnEnd_deg<Real> : Real{60});
        v.number(burn.duration_deg, Real{5}, Real{150});
        v.number(burn.per_deg, Real{0}, Real{1});
        v.number(burn.excess_air_ratio, Real{0}, kMaxNoted<Real>);
        v.number(burn.asked_kg, Real{0}, static_cast<Real>(kMaxFuel_kg));
        v.number(burn.asked_excess_air_ratio, Real{0}, static_cast<Real>(kMaxExcessAir_ratio));
        v.word(burn.taken, 1u);
        v.spare(burn.spare);
      }
    }
    if constexpr (N::charge_burn) {
      v.group("state.charge_burn");
      for (auto& burn : s.charge_burn) {
        v.number(burn.spark_deg, Real{-90}, Real{60});
        v.number(burn.ratio, kLeastBurn_ratio<Real>, kMaxBurn_ratio<Real>);
        v.word(burn.due, 1u);
        v.spare(burn.spare);
      }
    }
    if constexpr (N::knock) {
      v.group("state.knock");
      for (auto& knock : s.knock) {
        v.number(knock.integral_ratio, Real{0}, static_cast<Real>(1e6));  // kMaxKnock
        v.number(knock.passes_deg, Real{-kDegreesPerCycle}, Real{kDegreesPerCycle});
        v.number(knock.unburned_K, static_cast<Real>(kLeastGas_K / 2), static_cast<Real>(kMaxGas_K * 2));
        v.number(knock.pressure_Pa, static_cast<Real>(1e-6), static_cast<Real>(1e12));
        v.number(knock.burned_ratio, Real{0}, Real{1});
        v.number(knock.burnt_ratio, Real{0}, Real{1});
      }
      constexpr std::uint32_t kAll = (std::uint32_t{1} << S::cylinders.capacity) - 1;
      v.word(s.knock_due, kAll), v.word(s.knock_in_burn, kAll);
    }
    if constexpr (N::lambda) {
      v.group("state.lambda");
      const auto fuel = [&v](auto& fuels) {
        for (auto& kg : fuels) v.number(kg, Real{0}, kMaxGas_kg);
      };
      fuel(s.unburned_kg), fuel(s.manifold_unburned_kg);
      if constexpr (S::runners) fuel(s.runner_unburned_kg[kIntake]), fuel(s.runner_unburned_kg[kExhaust]);
      if constexpr (S::gas_results) fuel(s.outflow_unburned_kg);
      constexpr Real kMost = static_cast<Real>(kMaxExcessAir_ratio);  // of 1 / lambda, too
      for (auto& ratio : s.pipe_ratio) v.number(ratio, Real{0}, kMost);
      v.number(s.filled_ratio, Real{0}, Real{1});
      v.number(s.filling_ratio, Real{0}, kMost);
      v.number(s.owed_ratio, Real{0}, Real{S::lambda_parcels});
      v.number(s.outlet_unburned_ratio, Real{0}, Real{1});
      v.number(s.sensor_ratio, Real{0}, kMost);
      v.number(s.sensor_rest_ratio, Real{-1}, Real{1});
      v.word(s.oldest_parcel, S::lambda_parcels - 1);
      v.word(s.any_unburned, 1u);
    }
    if constexpr (S::gas_results) {
      v.group("state.gas_record");
      for (auto& r : s.gas_record) {
        numbers(kMaxNoted<Real>, r.work_J, r.pumping_J, r.peak_Pa, r.peak_deg, r.trapped_kg, r.trapped_air_kg, r.air_kg,
                r.exhaust_kg, r.exhaust_J, r.exhaust_burned_kg, r.fuel_kg, r.wall_heat_J, r.begin_J, r.begin_rest_J,
                r.gained_J, r.gained_rest_J);
        v.word(r.whole, 1u);
        v.spare(r.spare);
      }
    }
  }

 private:
  // No cylinder holds a thousand tons.
  static constexpr Real kMaxGas_kg = static_cast<Real>(1e6);
  static constexpr Real kMaxGas_J = static_cast<Real>(1e13);
  static constexpr Real kMaxGas_kg_s = static_cast<Real>(1e21);  ///< a step's bound, 12 times 1e12 kg, in 1/8 us
  static constexpr Real kLeastOfGas = static_cast<Real>(1e-36);  ///< kg and J

  template <class AReal, class Visitor>
  static constexpr void contents(AReal& kg, AReal& kg_rest, AReal& J, AReal& J_rest, AReal& burned_kg,
                                 AReal& burned_rest_kg, Visitor& v) noexcept {
    v.number(kg, kLeastOfGas, kMaxGas_kg);
    v.number(kg_rest, -kMaxGas_kg, kMaxGas_kg);
    v.number(J, kLeastOfGas, kMaxGas_J);
    v.number(J_rest, -kMaxGas_J, kMaxGas_J);
    v.number(burned_kg, Real{0}, kMaxGas_kg);
    v.number(burned_rest_kg, -kMaxGas_kg, kMaxGas_kg);
  }
  template <class AReal, class Visitor>
  static constexpr void point(AReal& pressure_Pa, AReal& temperature_K, AReal& burned_ratio, AReal& gas_ratio,
                              Visitor& v) noexcept {
    v.number(pressure_Pa, static_cast<Real>(1e-6), static_cast<Real>(1e12));
    v.number(temperature_K, static_cast<Real>(kLeastGas_K / 2), static_cast<Real>(kMaxGas_K * 2));
    v.number(burned_ratio, Real{0}, Real{1});
    v.number(gas_ratio, static_cast<Real>(0.14), static_cast<Real>(0.45));
  }
};

}  // namespace crankloop::detail
