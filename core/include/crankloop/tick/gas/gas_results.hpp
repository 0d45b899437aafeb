// What the gas of a cylinder did in a cycle.
//
// What belongs here: the record of a cycle, from one top dead centre of gas exchange to the next, and its sums. What
// does not: the gas itself (cylinder_gas.hpp).
#pragma once

#include <cstdint>

#include <crankloop/tick/gas/combustion.hpp>
#include <crankloop/tick/gas/cylinder_gas.hpp>

namespace crankloop {

/// Results of a cycle of one cylinder.
template <class Real>
struct GasCycle {
  Real net_mep_Pa;      ///< work on the piston over the swept volume
  Real pumping_mep_Pa;  ///< that from 180 to 540 deg; negative: a loss
  Real peak_Pa;
  Real peak_deg;    ///< after firing top dead centre
  Real trapped_kg;  ///< when the intake closed
  Real trapped_air_kg;
  Real residual_ratio;         ///< burned share of it
  Real volumetric_efficiency;  ///< air through the intake over what the swept volume holds of ambient air
  Real exhaust_K;              ///< of the gas through the exhaust, by its mean enthalpy
  Real fuel_kg;                ///< that burned
  Real excess_air_ratio;       ///< lambda: air there, over air that the cycle's fuel wanted; 0: no fuel
  Real heat_J;                 ///< of combustion
  Real wall_heat_J;            ///< to the walls
  Real energy_defect_J;        ///< what the first law lacks: rounding, and gas that was put back (kFaultGas)
};

namespace detail {

/// The cycle in progress.
template <class Real>
struct GasRecord {
  Real work_J, pumping_J, peak_Pa, peak_deg, trapped_kg, trapped_air_kg;
  Real air_kg;                                    ///< through the intake
  Real exhaust_kg, exhaust_J, exhaust_burned_kg;  ///< through the exhaust
  Real fuel_kg, wall_heat_J;
  Real begin_J, begin_rest_J;    ///< internal energy
  Real gained_J, gained_rest_J;  ///< what the first law adds to it
  std::uint32_t whole;           ///< 1: from its begin
  std::uint32_t spare;
};

template <class Real>
inline void begin_cycle(GasRecord<Real>& record, const GasContents<Real>& gas) noexcept {
  record = {};
  record.begin_J = gas.energy_J, record.begin_rest_J = gas.energy_rest_J;
  record.whole = 1;
}

/// What any step did: `gained_J`, what the first law adds to the internal energy.
template <class Real>
[[gnu::always_inline]] inline void record_step(GasRecord<Real>& record, Real pressure_Pa, Real work_J, Real wall_heat_J,
                                               Real gained_J, Real fuel_kg, const CycleWay& way) noexcept {
  record.work_J += work_J;
  if (way.in_gas_exchange()) record.pumping_J += work_J;
  if (pressure_Pa > record.peak_Pa) record.peak_Pa = pressure_Pa, record.peak_deg = way.deg<Real>();
  record.fuel_kg += fuel_kg;
  record.wall_heat_J += wall_heat_J;
  add_carried(record.gained_J, record.gained_rest_J, gained_J);
}

/// What came through a port.
template <class Real>
inline void record_flow(GasRecord<Real>& record, int port, const PortStep<Real>& step) noexcept {
  if (port == kIntake) {
    record.air_kg += step.mass_kg - step.burned_kg;
  } else {
    record.exhaust_kg -= step.mass_kg;
    record.exhaust_J -= step.enthalpy_J;
    record.exhaust_burned_kg -= step.burned_kg;
  }
}

/// What the intake shut in.
template <class Real>
inline void record_trapped(GasRecord<Real>& record, const GasContents<Real>& gas) noexcept {
  record.trapped_kg = gas.mass_kg;
  record.trapped_air_kg = gas.mass_kg - gas.burned_kg;
}

template <class Real>
[[nodiscard]] inline GasCycle<Real> finished(const GasRecord<Real>& r, const GasContents<Real>& gas,
                                             const GasCylinders<Real>& table, Real heat_J_kg,
                                             Real excess_air_ratio) noexcept {
  GasCycle<Real> c{};
  c.net_mep_Pa = r.work_J * table.per_swept_m3;
  c.pumping_mep_Pa = r.pumping_J * table.per_swept_m3;
  c.peak_Pa = r.peak_Pa, c.peak_deg = r.peak_deg;
  c.trapped_kg = r.trapped_kg, c.trapped_air_kg = r.trapped_air_kg;
  c.residual_ratio = r.trapped_kg > 0 ? (r.trapped_kg - r.trapped_air_kg) / r.trapped_kg : Real{0};
  c.volumetric_efficiency = r.air_kg * table.per_full_charge;
  if (r.exhaust_kg > 0) {
    const Real per_kg = Real{1} / r.exhaust_kg;
    c.exhaust_K = temperature_of_enthalpy_K(r.exhaust_J * per_kg, r.exhaust_burned_kg * per_kg);
  }
  c.fuel_kg = r.fuel_kg;
  c.excess_air_ratio = excess_air_ratio;
  c.heat_J = r.fuel_kg * heat_J_kg;
  c.wall_heat_J = r.wall_heat_J;
  c.energy_defect_J = (gas.energy_J - r.begin_J - r.gained_J) + (gas.energy_rest_J - r.begin_rest_J - r.gained_rest_J);
  return c;
}

}  // namespace detail
}  // namespace crankloop
