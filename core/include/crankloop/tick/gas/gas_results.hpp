// What the gas of a cylinder did in a cycle.
//
// What belongs here: the record of a cycle, from one top dead centre of gas exchange to the next, and its sums. What
// does not: the gas itself (cylinder_gas.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

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
  Real trapped_kg;  ///< when the intake last closed before firing dead centre and before any fuel burned; 0: it did not
  Real trapped_air_kg;
  Real residual_ratio;         ///< burned share of it
  Real volumetric_efficiency;  ///< air through the intake over what the swept volume holds of ambient air
  Real exhaust_K;  ///< of the gas that flows out through the exhaust, by its mean enthalpy; 0: less than 1e-12 kg
  Real fuel_kg;    ///< that burned, and what is too much for the air beside it
  Real excess_air_ratio;  ///< lambda: air there, over air that the cycle's fuel wanted; 0: no fuel
  Real heat_J;            ///< of combustion
  Real wall_heat_J;       ///< to the walls
  Real energy_defect_J;   ///< what the first law lacks: rounding, and gas that was put back (kFaultGas)
};

namespace detail {

/// The cycle in progress.
template <class Real>
struct GasRecord {
  // Rows of four, which lanes add to at once.
  Real work_J, pumping_J, fuel_kg, wall_heat_J;
  Real air_kg;                                    ///< through the intake
  Real exhaust_kg, exhaust_J, exhaust_burned_kg;  ///< out through the exhaust
  Real peak_Pa, peak_deg, trapped_kg, trapped_air_kg;
  Real begin_J, begin_rest_J;    ///< internal energy
  Real gained_J, gained_rest_J;  ///< what the first law adds to it
  std::uint32_t whole;           ///< 1: from its begin
  std::uint32_t spare;
};

template <class Real>
inline void begin_cycle(GasRecord<Real>& record, const GasContents<Real>& gas) noexcept {
  // One by one: a call of memset would take longer on small processors.
  record.work_J = record.pumping_J = record.fuel_kg = record.wall_heat_J = Real{0};
  record.air_kg = record.exhaust_kg = record.exhaust_J = record.exhaust_burned_kg = Real{0};
  record.peak_Pa = record.peak_deg = record.trapped_kg = record.trapped_air_kg = Real{0};
  record.gained_J = record.gained_rest_J = Real{0};
  record.begin_J = gas.energy_J, record.begin_rest_J = gas.energy_rest_J;
  record.whole = 1;
  record.spare = 0;
}

#if CRANKLOOP_ABREAST
/// Adds four numbers of each lane to row `row` of its record.
[[gnu::always_inline]] inline void add_row(GasRecord<float>* records, int row, const Four& a, const Four& b,
                                           const Four& c, const Four& d) noexcept {
  Four x[4] = {a, b, c, d};
  transpose(x);
#pragma GCC unroll 4
  for (int i = 0; i < 4; ++i) {
    auto* const at = reinterpret_cast<unsigned char*>(records + i) + static_cast<std::size_t>(row) * sizeof x[i];
    Four sum;
    std::memcpy(&sum, at, sizeof sum);
    sum += x[i];
    std::memcpy(at, &sum, sizeof sum);
  }
}
#endif

/// What any step of a cylinder, or of lanes, did.
template <class T>
[[gnu::always_inline]] inline void record_step(GasRecord<NumberOf<T>>* records, const CylinderStep<T>& step,
                                               const PortStep<T> (&through)[kPorts], const T& fuel_kg,
                                               const CycleWay* way) noexcept {
  const PortStep<T>& in = through[kIntake];
  const PortStep<T>& out = through[kExhaust];
  if constexpr (kLanesIn<T> == 1) {
    GasRecord<T>& record = *records;
    record.work_J += step.work_J;
    if (way->in_gas_exchange()) record.pumping_J += step.work_J;
    record.fuel_kg += fuel_kg;
    record.wall_heat_J += step.closed.wall_heat_J;
    if (!step.flows) return;
    if (in.mass_kg != T{0}) record.air_kg += in.mass_kg - in.burned_kg;
    if (!(out.mass_kg < T{0})) return;
    record.exhaust_kg -= out.mass_kg;
    record.exhaust_J -= out.enthalpy_J;
    record.exhaust_burned_kg -= out.burned_kg;
  } else {
    T pumping_J{};
    for (int i = 0; i < kLanesIn<T>; ++i) {
      if (way[i].in_gas_exchange()) put_lane(pumping_J, i, lane(step.work_J, i));
    }
    add_row(records, 0, step.work_J, pumping_J, fuel_kg, step.closed.wall_heat_J);
    if (step.flows) {
      const PortStep<T> leaves = where(out.mass_kg < NumberOf<T>{0}, out);
      add_row(records, 1, in.mass_kg - in.burned_kg, -leaves.mass_kg, -leaves.enthalpy_J, -leaves.burned_kg);
    }
  }
}

/// Where a step of one led; `gained_J`, what the first law adds to the internal energy.
template <class Real>
[[gnu::always_inline]] inline void record_end(GasRecord<Real>& record, Real pressure_Pa, Real gained_J,
                                              const CycleWay& way) noexcept {
  if (pressure_Pa > record.peak_Pa) record.peak_Pa = pressure_Pa, record.peak_deg = way.deg<Real>();
  add_carried(record.gained_J, record.gained_rest_J, gained_J);
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
  if (r.exhaust_kg >= static_cast<Real>(1e-12)) {  // of less, a mean is no number
    const Real per_kg = Real{1} / r.exhaust_kg;
    const Real burned_ratio = r.exhaust_burned_kg * per_kg;  // rounding may leave more, or less than none
    c.exhaust_K = temperature_of_enthalpy_K(r.exhaust_J * per_kg,
                                            burned_ratio > 0 ? (burned_ratio < 1 ? burned_ratio : Real{1}) : Real{0});
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
