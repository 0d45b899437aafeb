// Checks that the numbers of a saved state's gas, each within its limits, also agree with one another and with the
// engine.
//
// What belongs here: checks of several fields together. What does not: limits of single fields
// (tick/state/state_fields.hpp).
//
// If energy or pressure contradicted mass, temperature and volume, a step could compute numbers without bound. The
// factors allow for more than any rounding, so the code may be compiled with a user's own flags.
#pragma once

#include <cstdint>

#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/gas/gas_places.hpp>
#include <crankloop/tick/valve/cam_ticks.hpp>

namespace crankloop::detail {

/// Checks a cylinder or a manifold. e / T is 666 to 1354 J/(kg K) from 100 to 6000 K, R T = p V / m; the rest of a
/// compensated sum is less than its last digit.
template <class Real>
[[nodiscard]] inline bool gas_agrees(const GasContents<Real>& gas, const GasPoint<Real>& point,
                                     Real volume_m3) noexcept {
  const auto c = [](double x) { return static_cast<Real>(x); };
  const Real heat_kg_K = gas.mass_kg * point.temperature_K;
  const Real ideal_J = c(287.1) * heat_kg_K;
  const Real rest = c(1e-3);
  return within(gas.energy_J, c(600) * heat_kg_K, c(1500) * heat_kg_K) &&
         within(point.pressure_Pa * volume_m3, c(0.9) * ideal_J, c(1.1) * ideal_J) &&
         gas.burned_kg <= c(1.001) * gas.mass_kg && within(gas.mass_rest_kg, -rest * gas.mass_kg, rest * gas.mass_kg) &&
         within(gas.burned_rest_kg, -rest * gas.mass_kg, rest * gas.mass_kg) &&
         within(gas.energy_rest_J, -rest * gas.energy_J, rest * gas.energy_J);
}

/// Checks a cylinder's crevices: of no more than a hundred times its gas, whose burned share is one.
template <class Real>
[[nodiscard]] inline bool crevice_agrees(const CreviceGas<Real>& crevice, Real gas_kg) noexcept {
  const Real little_kg = static_cast<Real>(1e-3) * gas_kg;
  return within(crevice.mass_kg, -little_kg, 100 * gas_kg) &&
         within(crevice.burned_kg, -little_kg, crevice.mass_kg + little_kg);
}

/// Checks the sums that a cycle's end divides by one another and multiplies by constants of the engine.
template <class Real>
[[nodiscard]] inline bool record_agrees(const GasRecord<Real>& r, const GasCylinders<Real>& table) noexcept {
  constexpr Real kMax = static_cast<Real>(1e20);  // Pa, and of volumetric efficiency
  return within(r.trapped_air_kg, -r.trapped_kg, r.trapped_kg) && within(r.work_J * table.per_swept_m3, -kMax, kMax) &&
         within(r.pumping_J * table.per_swept_m3, -kMax, kMax) && within(r.air_kg * table.per_full_charge, -kMax, kMax);
}

/// Checks that the ports of valves that follow their cams are closed where these have them closed: the time of a tick
/// rests on how many cylinders can be in valve overlap.
template <class Real, class S>
[[nodiscard]] bool ports_agree(const State<Real, S>& state, const Tables<Real, S>& tables) noexcept {
  PortAreas<Real, S::cylinders.capacity> by_cams;
  read_areas(tables, by_cams, [&](std::uint32_t t, std::uint32_t k) {
    const LiftCurve<Real>& curve = tables.lift_curves[t];
    return curve.read(curve.cell(cam_phase(state, t), k)).lift_m;
  });
  for (std::uint32_t k = 0; k < S::cylinders.capacity; ++k) {
    for (int port = 0; port < kPorts; ++port)
      if (by_cams.of[port][k] == 0 && state.cylinder_gas.area_m2[port][k] != 0) return false;
  }
  return true;
}

/// Checks the runners of a cylinder that the engine has.
template <class Real, class S>
[[nodiscard]] bool runners_agree(const State<Real, S>& state, const GasRunners<Real>& tables,
                                 std::uint32_t k) noexcept {
  for (int port = 0; port < kPorts; ++port) {
    const GasRunner<Real>& table = tables.of[port];
    if (!(table.area_m2 > 0)) continue;
    const RunnerGas<Real>& runner = state.runner[port][k];
    if (!(runner.contents.mass_kg > 0) || !(runner.point.temperature_K >= static_cast<Real>(kLeastGas_K / 2)) ||
        !(runner.point.gas_ratio >= static_cast<Real>(0.14)) ||
        !gas_agrees(runner.contents, runner.point, Real{1} / table.per_volume_m3))
      return false;
  }
  return true;
}

/// Checks all cylinders of the scene's capacity and the manifolds.
template <class Real, class S>
[[nodiscard]] bool gas_agrees(const State<Real, S>& state, const Tables<Real, S>& tables) noexcept {
  const GasCylinders<Real>& table = *tables.gas_cylinders;
  const Real swept_m3 = Real{1} / table.per_swept_m3;
  if (!Needs<S>::elastic_valves && !ports_agree(state, tables)) return false;
  for (std::uint32_t k = 0; k < S::cylinders.capacity; ++k) {
    const CylinderGas<Real> gas = state.cylinder_gas.template at<Real>(k);
    const Real least_m3 = static_cast<Real>(0.99) * table.clearance_m3;
    if (!within(gas.volume_m3, least_m3, static_cast<Real>(1.01) * (table.clearance_m3 + swept_m3))) return false;
    if (!gas_agrees(gas.contents, gas.point, gas.volume_m3)) return false;
    if constexpr (S::crevice) {
      if (!crevice_agrees(state.crevice_gas.template at<Real>(k), gas.contents.mass_kg)) return false;
    }
    if constexpr (S::runners) {
      if (!runners_agree(state, *tables.gas_runners, k)) return false;
    }
    if constexpr (S::gas_results) {
      if (!record_agrees(state.gas_record[k], table)) return false;
    }
  }
  if constexpr (Needs<S>::manifolds) {
    for (int port = 0; port < kPorts; ++port) {
      const ManifoldGas<Real>& manifold = state.manifold[port];
      if (!gas_agrees(manifold.contents, manifold.point, Real{1} / tables.gas_manifolds->per_volume_m3[port]))
        return false;
    }
  }
  return true;
}

}  // namespace crankloop::detail
