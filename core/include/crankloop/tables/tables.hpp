// The tables that a tick reads: plain data, built by tabulate in RAM or printed by the program as constexpr arrays for
// flash.
//
// What belongs here: the list of sections, and the sections of a scene. What does not: their records
// (tables/records.hpp and the headers beside it), how they are filled (tabulate/). One object per section, so that the
// linker drops sections that a scene does not reference.
#pragma once

#include <cstddef>
#include <cstdint>

#include <crankloop/scene.hpp>
#include <crankloop/tables/contact_tables.hpp>
#include <crankloop/tables/curve.hpp>
#include <crankloop/tables/gas_tables.hpp>
#include <crankloop/tables/lift_curve.hpp>
#include <crankloop/tables/misfire_tables.hpp>
#include <crankloop/tables/records.hpp>
#include <crankloop/tables/reluctor_tables.hpp>
#include <crankloop/tables/sensor_tables.hpp>
#include <crankloop/tables/trigger_tables.hpp>
#include <crankloop/tables/valve_tables.hpp>

namespace crankloop::detail {

/// How many records a section has.
enum class SectionRows : std::uint8_t {
  one,
  gas_grid,
  torque_grid,
  cut_grid,
  cylinders,
  trains,
  lobes,
  wheels,
  edges,
  wheel_faults,
  fault_edges
};

// The list of sections. All code that handles every section is generated from it. To add one, add its line here, fill
// it in tabulate and, where its record is new, state in tabulate/table_members.hpp how many members it has.
//
// A line: name, record, number of records, which scenes S need it (N = Needs<S>). The tick reads a SECTION through
// Tables; it reaches one that is BEHIND the next section through pointers in that section's records. A macro, because
// C++17 has no other way to name a member in one place.
#define CRANKLOOP_SECTIONS(SECTION, BEHIND)                                                        \
  SECTION(body, Body<Real>, one, N::body)                                                          \
  /* slope dx/da in m/rad, integral x in m: for torque and work of given pressures */              \
  SECTION(stroke, IntegratedCurve<Real>, one, N::stroke)                                           \
  SECTION(motion, Revolution<MotionSegment<Real>>, one, N::motion)                                 \
  SECTION(lean, Revolution<LeanSegment<Real>>, one, N::lean)                                       \
  SECTION(rod, Revolution<RodSegment<Real>>, one, N::rod)                                          \
  SECTION(rod_curvature, Curve<Real>, one, N::rod_curvature) /* d2b/da2 */                         \
  /* torque of masses per w^2 in kg m^2, all cylinders, over the engine's angle */                 \
  SECTION(inertia_torque, IntegratedCurve<Real>, one, N::inertia_torque)                           \
  SECTION(gas_grid, GasGrid, one, N::gas_pressure)  /* of the pressures: a cylinder's own cycle */ \
  SECTION(torque_grid, GasGrid, one, N::gas_torque) /* of the gas torques: the engine's cycle */   \
  /* Pa. At load ratio q: motored + q heat. A scene without load ratio takes their sum, `full`. */ \
  SECTION(pressure_full, Segment<Real>, gas_grid, N::gas_pressure && !N::load)                     \
  SECTION(pressure_motored, Segment<Real>, gas_grid, N::gas_pressure&& N::load)                    \
  SECTION(pressure_heat, Segment<Real>, gas_grid, N::gas_pressure&& N::load)                       \
  BEHIND(gas_full, IntegratedSegment<Real>, torque_grid, N::gas_torque && !N::load)                \
  SECTION(gas_torque_full, GasTorque<Real>, one, N::gas_torque && !N::load)                        \
  BEHIND(gas_motored, IntegratedSegment<Real>, torque_grid, N::gas_torque&& N::load)               \
  SECTION(gas_torque_motored, GasTorque<Real>, one, N::gas_torque&& N::load)                       \
  BEHIND(gas_heat, IntegratedSegment<Real>, torque_grid, N::gas_torque&& N::load)                  \
  SECTION(gas_torque_heat, GasTorque<Real>, one, N::gas_torque&& N::load)                          \
  /* what a cylinder that is cut lacks: the torque of the heat in one, over its own cycle */       \
  SECTION(cut_grid, GasGrid, one, N::cut_torque)                                                   \
  BEHIND(cut_heat, IntegratedSegment<Real>, cut_grid, N::cut_torque)                               \
  SECTION(cut_torque, GasTorque<Real>, one, N::cut_torque)                                         \
  SECTION(crank_dynamics, CrankDynamics<Real>, one, N::crank_dynamics)                             \
  SECTION(gas_cylinders, GasCylinders<Real>, one, N::gas)                                          \
  SECTION(gas_crevice, GasCrevice<Real>, one, S::crevice)                                          \
  SECTION(gas_runners, GasRunners<Real>, one, S::runners)                                          \
  SECTION(gas_walls, WarmWallsTable<Real>, one, S::walls)                                          \
  SECTION(gas_ports, GasPortCurve<Real>, trains, N::gas)                                           \
  SECTION(gas_manifolds, GasManifolds<Real>, one, N::manifolds)                                    \
  SECTION(burn, BurnTable<Real>, one, N::burn)                                                     \
  SECTION(charge_burn, ChargeBurnTable<Real>, one, N::charge_burn)                                 \
  SECTION(knock, KnockTable<Real>, one, N::knock)                                                  \
  SECTION(lambda, LambdaTable<Real>, one, N::lambda)                                               \
  SECTION(misfires, MisfireRule<Real>, cylinders, S::misfire)                                      \
  SECTION(bearings, Bearings<Real>, one, S::bearing_loads)                                         \
  SECTION(balance, Balance<Real>, one, S::free_forces)                                             \
  BEHIND(lift_segments, LiftSegment<Real>, lobes, N::any_valves)                                   \
  BEHIND(rocker_ratios, Segment<Real>, lobes, N::any_valves)                                       \
  SECTION(lift_curves, LiftCurve<Real>, trains, N::any_valves)                                     \
  SECTION(valve_motions, ValveMotion<Real>, trains, N::elastic_valves)                             \
  SECTION(valve_springs, ValveSprings<Real>, trains, N::surge)                                     \
  /* where a valve at rest becomes active: its cam near; with forces also where its gap changes */ \
  SECTION(near_cams, CamDegrees, trains, N::valves_rest && !S::valve_forces)                       \
  SECTION(near_lobes, CamDegrees, trains, N::valves_rest&& S::valve_forces)                        \
  SECTION(cycle_ends, CamDegrees, trains, N::cycle_ends)  /* within kCycleEndMargin_deg */         \
  BEHIND(cam_sliding, Segment<Real>, lobes, N::cam_loads) /* m, by the cam's speed */              \
  BEHIND(cam_contact_segments, CamContactSegment<Real>, lobes, S::cam_contact)                     \
  SECTION(cam_contacts, CamContactCurve<Real>, trains, S::cam_contact)                             \
  SECTION(cam_torques, CamTorqueTable<Real>, trains, S::cam_torque)                                \
  BEHIND(trigger_edges, std::uint32_t, edges, N::any_triggers)                                     \
  BEHIND(trigger_tracks, TriggerTrack, wheels, N::any_triggers)                                    \
  SECTION(triggers, TriggerWheels, one, N::any_triggers)                                           \
  BEHIND(fault_edges, std::uint32_t, fault_edges, N::faulty_wheels)                                \
  BEHIND(fault_tracks, TriggerTrack, wheel_faults, N::faulty_wheels)                               \
  BEHIND(wheel_fault_rules, WheelFaultRule<Real>, wheel_faults, N::faulty_wheels)                  \
  SECTION(wheel_faults, WheelFaultRules<Real>, one, N::faulty_wheels)                              \
  SECTION(reluctor, ReluctorTable<Real>, one, N::reluctor)                                         \
  SECTION(sensor_faults, SensorFaultRules<Real>, one, S::sensor_faults)                            \
  SECTION(drive, Drive<Real>, one, true)

/// The entries of the list as types, each named like its section.
namespace section {
#define CRANKLOOP_SECTION(name, Type, rows, condition, read)                                         \
  struct name {                                                                                      \
    static constexpr const char* kName = #name;                                                      \
    static constexpr SectionRows kRows = SectionRows::rows;                                          \
    static constexpr bool kRead = read; /* by the tick, through Tables */                            \
    template <class Real>                                                                            \
    using Record = Type;                                                                             \
    template <class S>                                                                               \
    static constexpr bool needed() noexcept {                                                        \
      using N [[maybe_unused]] = Needs<S>;                                                           \
      return condition;                                                                              \
    }                                                                                                \
    template <class Thing>                                                                           \
    struct Address { /* a base with the section's address */                                         \
      Thing* name = nullptr;                                                                         \
    };                                                                                               \
    template <class Thing>                                                                           \
    struct Store { /* a base with the section itself */                                              \
      Thing name;                                                                                    \
    };                                                                                               \
    template <class Holder>                                                                          \
    [[nodiscard]] static constexpr auto& in(Holder& holder) noexcept { /* the member of that name */ \
      return holder.name;                                                                            \
    }                                                                                                \
  };
#define CRANKLOOP_SECTION_READ(name, Type, rows, condition) CRANKLOOP_SECTION(name, Type, rows, condition, true)
#define CRANKLOOP_SECTION_BEHIND(name, Type, rows, condition) CRANKLOOP_SECTION(name, Type, rows, condition, false)
CRANKLOOP_SECTIONS(CRANKLOOP_SECTION_READ, CRANKLOOP_SECTION_BEHIND)
}  // namespace section

namespace part {
template <class...>
struct List {};
#define CRANKLOOP_SECTION_NAME(name, ...) , section::name
using AllSections = List<void CRANKLOOP_SECTIONS(CRANKLOOP_SECTION_NAME, CRANKLOOP_SECTION_NAME)>;

template <class S, class Section>
inline constexpr bool kReadBy = Section::kRead&& Section::template needed<S>();

/// False if the scene reads the section and it is missing.
template <class S, class Section, class Tables>
[[nodiscard]] constexpr bool there(const Tables& tables) noexcept {
  if constexpr (kReadBy<S, Section>) {
    return Section::in(tables) != nullptr;
  } else {
    return true;
  }
}
template <class S, class Tables, class... Each>
[[nodiscard]] constexpr bool all_there(const Tables& tables, List<void, Each...>) noexcept {
  return (there<S, Each>(tables) && ...);
}

template <class Visit, class... Each>
constexpr void visit_each(Visit& visit, List<void, Each...>) {
  (visit(Each{}), ...);
}

// Structs of addresses, one base per section. Read: sections that a tick reads; Targets: all sections; Needed: those of
// a scene.
template <class Real, class All>
struct Read;
template <class Real, class... Each>
struct Read<Real, List<void, Each...>>
    : If<Each::kRead, typename Each::template Address<const typename Each::template Record<Real>>>... {};
template <class Real, class All>
struct Targets;
template <class Real, class... Each>
struct Targets<Real, List<void, Each...>> : Each::template Address<typename Each::template Record<Real>>... {};
template <class Real, class S, class All>
struct Needed;
template <class Real, class S, class... Each>
struct Needed<Real, S, List<void, Each...>>
    : If<kReadBy<S, Each>, typename Each::template Address<const typename Each::template Record<Real>>>... {};
}  // namespace part

/// Calls visit(section::NAME{}) for each section in the order of the list.
template <class Visit>
constexpr void sections(Visit&& visit) {
  part::visit_each(visit, part::AllSections{});
}

#undef CRANKLOOP_SECTIONS
#undef CRANKLOOP_SECTION
#undef CRANKLOOP_SECTION_READ
#undef CRANKLOOP_SECTION_BEHIND
#undef CRANKLOOP_SECTION_NAME

}  // namespace crankloop::detail

namespace crankloop {

/// Addresses of all sections that a tick may read; null if missing. constexpr in flash, so that only sections that a
/// Tables takes from it are linked.
template <class Real>
struct Sections : detail::part::Read<Real, detail::part::AllSections> {};

/// The sections that a scene reads, and no others.
template <class Real, class S>
struct Tables : detail::part::Needed<Real, S, detail::part::AllSections> {
  constexpr Tables() = default;
  constexpr explicit Tables(const Sections<Real>& from) noexcept {
    detail::sections([&](auto section) {
      if constexpr (detail::part::kReadBy<S, decltype(section)>) section.in(*this) = section.in(from);
    });
  }
};

/// True if no section that the scene reads is missing.
template <class Real, class S>
[[nodiscard]] constexpr bool complete(const Tables<Real, S>& tables) noexcept {
  return detail::part::all_there<S>(tables, detail::part::AllSections{});
}

}  // namespace crankloop
