// Checks that a scene can step the engine of some tables: init() at run time, the compiler for tables in flash
// (port/cmake/scene.cpp.in).
#pragma once

#include <cstdint>

#include <crankloop/scene.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tables/tables.hpp>

namespace crankloop::detail {

[[nodiscard]] constexpr bool fits(Count capacity, std::uint32_t given) noexcept {
  return capacity.exact ? given == capacity.capacity : given <= capacity.capacity;
}

/// Refuses complete tables that do not fit the scene, with the first mismatch.
template <class Real, class S>
[[nodiscard]] constexpr Status scene_fits(const Tables<Real, S>& tables) noexcept {
  using N = Needs<S>;
  const Drive<Real>& drive = *tables.drive;
  if (drive.cylinders < 1 || !fits(S::cylinders, drive.cylinders))
    return refuse("tables.cylinders", Reason::out_of_range);
  if constexpr (N::body && !S::rod_inertia) {
    if (tables.body->rod_inertia_correction_kg_m2 != Real{0}) return refuse("scene.rod_inertia", Reason::inconsistent);
  }
  if constexpr (N::crank_dynamics) {
    const bool enough = tables.crank_dynamics->least_kg_m2 >= static_cast<Real>(kLeastInertia_kg_m2);
    if (!enough) return refuse("masses.crank_inertia_kg_m2", Reason::not_positive);
  }
  if constexpr (N::any_valves) {
    if (!fits(S::trains, drive.trains)) return refuse("tables.trains", Reason::out_of_range);
  }
  if constexpr (N::elastic_valves && !S::valve_gas) {
    for (std::uint32_t t = 0; t < drive.trains; ++t) {
      if (tables.valve_motions[t].body.head_area_m2 != Real{0})
        return refuse("scene.valve_gas", Reason::inconsistent, static_cast<std::int32_t>(t));
    }
  }
  if constexpr (N::elastic_valves) {
    if (drive.spring_modes > S::spring_modes) return refuse("scene.spring_modes", Reason::inconsistent);
  }
  if constexpr (S::cam_contact) {
    for (std::uint32_t t = 0; t < drive.trains; ++t) {
      if (!(tables.cam_contacts[t].per_width_m > 0))
        return refuse("cam.width_m", Reason::not_positive, static_cast<std::int32_t>(t));
    }
  }
  if constexpr (N::any_triggers) {
    if (!fits(S::triggers, tables.triggers->count)) return refuse("tables.triggers", Reason::out_of_range);
  }
  if constexpr (N::faulty_wheels) {
    if (tables.wheel_faults->count > S::wheel_faults) return refuse("tables.wheel_faults", Reason::out_of_range);
  }
  if constexpr (N::gas) {
    if (!(tables.gas_cylinders->clearance_m3 > 0)) return refuse("pressure.source", Reason::inconsistent);
    if (!S::crevice && (tables.gas_cylinders->parts & kGasCrevice) != 0)
      return refuse("scene.crevice", Reason::inconsistent);
    if (!S::runners && (tables.gas_cylinders->parts & kGasRunners) != 0)
      return refuse("scene.runners", Reason::inconsistent);
    if (!S::walls && (tables.gas_cylinders->parts & kGasWalls) != 0) return refuse("scene.walls", Reason::inconsistent);
    if (Needs<S>::burn && !S::charge_burn && (tables.gas_cylinders->parts & kGasChargeBurn) != 0)
      return refuse("scene.charge_burn", Reason::inconsistent);
  }
  return {};
}

/// Whether a refusal is of this field: for static_assert, whose message must be a literal.
[[nodiscard]] constexpr bool is_of(const Status& refused, const char* field) noexcept {
  const char* of = refused.field;
  for (; *of != 0 && *of == *field; ++of) ++field;
  return !refused.ok() && *of == *field;
}

}  // namespace crankloop::detail
