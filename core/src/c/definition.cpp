// Definition, options and answers of the C interface. Glue: the rules are validate()'s.
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "arguments.hpp"

namespace crankloop::c {
namespace {

/// Copies one field to C, or from C. An enumerator that C++ does not have is the answer of the latter.
struct ToC {
  template <class C, class Field>
  void operator()(C& c, const Field& field, int = 0, const char* = "") noexcept {
    c = static_cast<C>(field);
  }
};
struct FromC {
  Status status{};

  template <class C, class Field>
  void operator()(const C& c, Field& field, int most = 0, const char* name = "") noexcept {
    if constexpr (std::is_same_v<Field, bool>) {
      field = c != 0;
    } else {
      if constexpr (std::is_enum_v<Field>) {
        if ((c < 0 || c > most) && status.ok()) status = {Reason::out_of_range, -1, name};
      }
      field = static_cast<Field>(c);
    }
  }
};

template <class C, class Cpp, class Copy>
void each_crank(C& c, Cpp& d, Copy& copy) noexcept {
  copy(c.bore_m, d.bore_m);
  copy(c.crank_radius_m, d.crank_radius_m);
  copy(c.rod_length_m, d.rod_length_m);
  copy(c.pin_offset_m, d.pin_offset_m);
  copy(c.compression_ratio, d.compression_ratio);
}
template <class C, class Cpp, class Copy>
void each_mass(C& c, Cpp& d, Copy& copy) noexcept {
  copy(c.piston_kg, d.piston_kg);
  copy(c.rod_small_end_kg, d.rod_small_end_kg);
  copy(c.rod_big_end_kg, d.rod_big_end_kg);
  copy(c.rod_inertia_correction_kg_m2, d.rod_inertia_correction_kg_m2);
  copy(c.crank_pin_equivalent_kg, d.crank_pin_equivalent_kg);
  copy(c.crank_inertia_kg_m2, d.crank_inertia_kg_m2);
}
template <class C, class Cpp, class Copy>
void each_place(C& c, Cpp& d, Copy& copy) noexcept {
  copy(c.cylinders, d.cylinders);
  for (std::size_t k = 0; k < std::size_t{kMaxCylinders}; ++k) {
    copy(c.firing_deg[k], d.firing_deg[k]);
    copy(c.bank_deg[k], d.bank_deg[k]);
    copy(c.position_m[k], d.position_m[k]);
    copy(c.pin[k], d.pin[k]);
  }
}
template <class C, class Cpp, class Copy>
void each_pressure(C& c, Cpp& d, Copy& copy) noexcept {
  copy(c.source, d.source, static_cast<int>(PressureSource::wiebe), "pressure.source");
  copy(c.crankcase_Pa, d.crankcase_Pa);
  copy(c.point_count, d.point_count);
  copy(c.wiebe.intake_Pa, d.wiebe.intake_Pa);
  copy(c.wiebe.exhaust_Pa, d.wiebe.exhaust_Pa);
  copy(c.wiebe.start_of_combustion_deg, d.wiebe.start_of_combustion_deg);
  copy(c.wiebe.combustion_duration_deg, d.wiebe.combustion_duration_deg);
  copy(c.wiebe.wiebe_m, d.wiebe.wiebe_m);
  copy(c.wiebe.compression_exponent, d.wiebe.compression_exponent);
  copy(c.wiebe.expansion_exponent, d.wiebe.expansion_exponent);
  copy(c.wiebe.exhaust_valve_opens_deg, d.wiebe.exhaust_valve_opens_deg);
  copy(c.wiebe.heat_given, d.wiebe.heat_given);
  copy(c.wiebe.net_mep_Pa, d.wiebe.net_mep_Pa);
  copy(c.wiebe.heat_J, d.wiebe.heat_J);
}
template <class C, class Cpp, class Copy>
void each_train(C& c, Cpp& d, Copy& copy) noexcept {
  copy(c.cam.source, d.cam.source, static_cast<int>(CamSource::table), "cam.source");
  copy(c.cam.max_lift_m, d.cam.max_lift_m);
  copy(c.cam.half_angle_deg, d.cam.half_angle_deg);
  copy(c.cam.exponent_count, d.cam.exponent_count);
  for (int i = 0; i < kMostCamExponents; ++i) copy(c.cam.exponents[i], d.cam.exponents[i]);
  copy(c.cam.point_count, d.cam.point_count);
  copy(c.cam.smoothing_m, d.cam.smoothing_m);
  copy(c.cam.full_lift_deg, d.cam.full_lift_deg);
  copy(c.cam.phase_rate_deg_s, d.cam.phase_rate_deg_s);
  copy(c.rocker.kind, d.rocker.kind, static_cast<int>(RockerKind::ratio), "rocker.kind");
  copy(c.rocker.base_circle_m, d.rocker.base_circle_m);
  copy(c.rocker.clearance_m, d.rocker.clearance_m);
  copy(c.rocker.ratio, d.rocker.ratio);
  copy(c.rocker.pivot_to_pad_m, d.rocker.pivot_to_pad_m);
  copy(c.rocker.pivot_to_cam_m, d.rocker.pivot_to_cam_m);
  copy(c.rocker.pad_radius_m, d.rocker.pad_radius_m);
  copy(c.rocker.pivot_to_screw_m, d.rocker.pivot_to_screw_m);
  copy(c.rocker.screw_ball_m, d.rocker.screw_ball_m);
  copy(c.rocker.stem_above_pivot_m, d.rocker.stem_above_pivot_m);
  copy(c.rocker.cam_turns, d.rocker.cam_turns, static_cast<int>(CamTurns::away_from_pivot), "rocker.cam_turns");
  copy(c.valve.per_cylinder, d.valve.per_cylinder);
  copy(c.valve.valve_kg, d.valve.valve_kg);
  copy(c.valve.spring_kg, d.valve.spring_kg);
  copy(c.valve.rocker_inertia_kg_m2, d.valve.rocker_inertia_kg_m2);
  copy(c.valve.spring_N_m, d.valve.spring_N_m);
  copy(c.valve.spring_preload_N, d.valve.spring_preload_N);
  copy(c.valve.train_N_m, d.valve.train_N_m);
  copy(c.valve.train_damping_ratio, d.valve.train_damping_ratio);
  copy(c.valve.guide_damping_ratio, d.valve.guide_damping_ratio);
  copy(c.valve.seat_N_m, d.valve.seat_N_m);
  copy(c.valve.seat_damping_ratio, d.valve.seat_damping_ratio);
  copy(c.valve.head_area_m2, d.valve.head_area_m2);
}
template <class C, class Cpp, class Copy>
void each_torque(C& c, Cpp& d, Copy& copy) noexcept {
  copy(c.friction.constant_Pa, d.friction.constant_Pa);
  copy(c.friction.linear_Pa_s, d.friction.linear_Pa_s);
  copy(c.friction.quadratic_Pa_s2, d.friction.quadratic_Pa_s2);
  copy(c.load.constant_Nm, d.load.constant_Nm);
  copy(c.load.linear_Nm_s, d.load.linear_Nm_s);
  copy(c.load.quadratic_Nm_s2, d.load.quadratic_Nm_s2);
  copy(c.load.inertia_kg_m2, d.load.inertia_kg_m2);
  copy(c.starter.stall_Nm, d.starter.stall_Nm);
  copy(c.starter.no_load_rad_s, d.starter.no_load_rad_s);
}
template <class C, class Cpp, class Copy>
void each_field(C& c, Cpp& d, Copy& copy) noexcept {
  each_crank(c.crank, d.crank, copy);
  each_mass(c.masses, d.masses, copy);
  each_place(c.layout, d.layout, copy);
  each_pressure(c.pressure, d.pressure, copy);
  copy(c.train_count, d.train_count);
  for (int t = 0; t < kMaxTrains; ++t) each_train(c.trains[t], d.trains[t], copy);
  each_torque(c, d, copy);
  copy(c.motored_expansion_exponent, d.pressure.wiebe.motored_expansion_exponent);
}
template <class C, class Cpp, class Copy>
void each_option(C& c, Cpp& d, Copy& copy) noexcept {
  copy(c.tick_s, d.tick_s);
  copy(c.valve_integrator, d.valves.integrator, static_cast<int>(Integrator::exponential), "tick.integrator");
  copy(c.valve_accuracy_m, d.valves.accuracy_m);
}

// Rows are read where they are.
static_assert(sizeof(crankloop_diagram_point) == sizeof(DiagramPoint) && offsetof(crankloop_diagram_point, pressure_Pa) == offsetof(DiagramPoint, pressure_Pa));
static_assert(sizeof(crankloop_cam_point) == sizeof(CamPoint) && offsetof(crankloop_cam_point, lift_m) == offsetof(CamPoint, lift_m));

static_assert(CRANKLOOP_MOST_CYLINDERS == kMaxCylinders && CRANKLOOP_MOST_TRAINS == kMaxTrains && CRANKLOOP_MOST_CAM_EXPONENTS == kMostCamExponents);
static_assert(CRANKLOOP_ALREADY_CREATED == static_cast<int>(Reason::already_created) && CRANKLOOP_ROD_TOO_SHORT == static_cast<int>(Reason::rod_too_short) &&
              CRANKLOOP_NO_SOLUTION == static_cast<int>(Reason::no_solution) && CRANKLOOP_CONTRACTING_BUILD == static_cast<int>(Reason::contracting_build));
static_assert(CRANKLOOP_PRESSURE_WIEBE == static_cast<int>(PressureSource::wiebe) && CRANKLOOP_PRESSURE_NONE == static_cast<int>(PressureSource::none) &&
              CRANKLOOP_PRESSURE_ANGLE_TABLE == static_cast<int>(PressureSource::angle_table));
static_assert(CRANKLOOP_CAM_TABLE == static_cast<int>(CamSource::table) && CRANKLOOP_ROCKER_RATIO == static_cast<int>(RockerKind::ratio) &&
              CRANKLOOP_CAM_TURNS_AWAY_FROM_PIVOT == static_cast<int>(CamTurns::away_from_pivot) &&
              CRANKLOOP_INTEGRATOR_EXPONENTIAL == static_cast<int>(Integrator::exponential));
static_assert(CRANKLOOP_VERSION_MAJOR == CRANKLOOP_PROJECT_MAJOR && CRANKLOOP_VERSION_MINOR == CRANKLOOP_PROJECT_MINOR &&
                  CRANKLOOP_VERSION_PATCH == CRANKLOOP_PROJECT_PATCH,
              "crankloop.h: the version is not the project's");

}  // namespace

crankloop_definition as_c(const EngineDefinition& definition) noexcept {
  crankloop_definition c{};
  ToC copy;
  each_field(c, definition, copy);
  return c;
}
Status from_c(const crankloop_definition& c, EngineDefinition& definition) noexcept {
  FromC copy;
  each_field(c, definition, copy);
  definition.pressure.points = reinterpret_cast<const DiagramPoint*>(c.pressure.points);
  for (int t = 0; t < kMaxTrains; ++t) definition.trains[t].cam.points = reinterpret_cast<const CamPoint*>(c.trains[t].cam.points);
  return copy.status;
}
crankloop_options as_c(const TickOptions& options) noexcept {
  crankloop_options c{};
  ToC copy;
  each_option(c, options, copy);
  return c;
}
Status from_c(const crankloop_options& c, TickOptions& options) noexcept {
  FromC copy;
  each_option(c, options, copy);
  return copy.status;
}

Status take(EngineDefinition& definition, const crankloop_definition* from, std::size_t size) noexcept {
  crankloop_definition full = as_c(EngineDefinition{});
  if (const Status refused = take(full, from, size, "definition"); !refused.ok()) return refused;
  return from_c(full, definition);
}
Status take(TickOptions& options, const crankloop_options* from, std::size_t size) noexcept {
  crankloop_options full = as_c(TickOptions{});
  if (const Status refused = take(full, from, size, "options"); !refused.ok()) return refused;
  return from_c(full, options);
}

namespace {

/// Lets `change` work on the layout of the caller's definition.
template <class Change>
[[nodiscard]] crankloop_status change_layout(crankloop_definition* definition, std::size_t size, const Change& change) noexcept {
  crankloop_definition full = as_c(EngineDefinition{});
  if (const Status refused = take(full, definition, size, "definition"); !refused.ok()) return as_c(refused);
  Layout layout;
  FromC read;
  each_place(full.layout, layout, read);
  if (const Status refused = change(layout); !refused.ok()) return as_c(refused);
  ToC write;
  each_place(full.layout, layout, write);
  std::memcpy(definition, &full, size < sizeof full ? size : sizeof full);
  return as_c(Status{});
}

}  // namespace
}  // namespace crankloop::c

using namespace crankloop;

std::uint32_t crankloop_version() { return CRANKLOOP_VERSION; }

const char* crankloop_describe(std::int32_t reason) {
  const bool known = reason >= 0 && reason <= CRANKLOOP_ALREADY_CREATED;
  return known ? describe(static_cast<Reason>(reason)) : "unknown reason";
}

std::size_t crankloop_status_text(crankloop_status status, char* text, std::size_t room) {
  if (text == nullptr) room = 0;
  std::size_t length = 0;
  const auto add = [&](char letter) {
    if (length + 1 < room) text[length] = letter;
    ++length;
  };
  const auto add_all = [&](const char* words) {
    while (words != nullptr && *words != '\0') add(*words++);
  };
  add_all(status.field);
  if (status.index >= 0) {
    char digits[10];
    int count = 0;
    for (std::int32_t rest = status.index; rest > 0 || count == 0; rest /= 10) digits[count++] = static_cast<char>('0' + rest % 10);
    add('[');
    while (count > 0) add(digits[--count]);
    add(']');
  }
  if (length > 0) add(' ');
  add_all(crankloop_describe(status.reason));
  if (room > 0) text[length < room ? length : room - 1] = '\0';
  return length;
}

crankloop_status crankloop_definition_defaults(crankloop_definition* definition, std::size_t size) {
  return c::as_c(c::give(definition, size, c::as_c(EngineDefinition{})));
}
crankloop_status crankloop_options_defaults(crankloop_options* options, std::size_t size) {
  return c::as_c(c::give(options, size, c::as_c(TickOptions{})));
}

crankloop_status crankloop_set_firing_order(crankloop_definition* definition, std::size_t size, const std::int32_t* order, std::int32_t cylinders) {
  if (order == nullptr) return c::refusal(Reason::null_pointer, "order");
  int numbers[kMaxCylinders] = {};  // where int32_t is not int
  for (int k = 0; k < cylinders && k < kMaxCylinders; ++k) numbers[k] = static_cast<int>(order[k]);
  return c::change_layout(definition, size, [&](Layout& layout) { return set_firing_order(numbers, static_cast<int>(cylinders), layout); });
}
crankloop_status crankloop_share_pins_by_position(crankloop_definition* definition, std::size_t size) {
  return c::change_layout(definition, size, [](Layout& layout) { return share_pins_by_position(layout), Status{}; });
}
