// Definition, options and answers of the C interface. Glue: the rules are validate()'s.
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "arguments.hpp"

namespace crankloop::c {
namespace {

/// The largest number of an enumeration that C++ has.
template <class Enum>
inline constexpr Enum kLast{};
template <>
inline constexpr PressureSource kLast<PressureSource> = PressureSource::wiebe;
template <>
inline constexpr CamSource kLast<CamSource> = CamSource::table;
template <>
inline constexpr RockerKind kLast<RockerKind> = RockerKind::ratio;
template <>
inline constexpr CamTurns kLast<CamTurns> = CamTurns::away_from_pivot;
template <>
inline constexpr Integrator kLast<Integrator> = Integrator::exponential;

/// Copies one field to C, or from C. An enumerator that C++ does not have is the answer of the latter.
struct ToC {
  template <class Field, class C>
  void operator()(const char*, const Field& field, C& c) noexcept {
    if constexpr (std::is_pointer_v<Field>) {
      c = reinterpret_cast<C>(field);
    } else {
      c = static_cast<C>(field);
    }
  }
};
struct FromC {
  Status status{};

  template <class Field, class C>
  void operator()(const char* name, Field& field, const C& c) noexcept {
    if constexpr (std::is_pointer_v<Field>) {
      field = reinterpret_cast<Field>(c);
    } else if constexpr (std::is_same_v<Field, bool>) {
      field = c != 0;
    } else {
      if constexpr (std::is_enum_v<Field>) {
        if ((c < 0 || c > static_cast<int>(kLast<Field>)) && status.ok()) status = {Reason::out_of_range, -1, name};
      }
      field = static_cast<Field>(c);
    }
  }
};

/// A field and its C form: one number or pointer, or all those of a list or a part, whose C form has the same names.
template <class Copy>
struct EachNumber {
  Copy& copy;

  template <class Field, class C>
  void operator()(int, const char* name, Field& field, C& c) noexcept {
    if constexpr (std::is_array_v<C>) {
      for (std::size_t i = 0; i < std::extent_v<C>; ++i) (*this)(1, name, field[i], c[i]);
    } else if constexpr (std::is_class_v<C>) {
      std::remove_const_t<Field>::each_field(*this, field, c);
    } else {
      copy(name, field, c);
    }
  }
};
template <class Copy, class Cpp, class C>
void each_field(Copy& copy, Cpp& definition, C& c) noexcept {
  EachNumber<Copy>{copy}(1, "", definition, c);
}
template <class Copy, class Cpp, class C>
void each_option(Copy& copy, Cpp& options, C& c) noexcept {
  copy("tick.tick", options.tick_s, c.tick_s);
  copy("tick.integrator", options.valves.integrator, c.valve_integrator);
  copy("tick.accuracy", options.valves.accuracy_m, c.valve_accuracy_m);
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
  each_field(copy, definition, c);
  return c;
}
Status from_c(const crankloop_definition& c, EngineDefinition& definition) noexcept {
  FromC copy;
  each_field(copy, definition, c);
  return copy.status;
}
crankloop_options as_c(const TickOptions& options) noexcept {
  crankloop_options c{};
  ToC copy;
  each_option(copy, options, c);
  return c;
}
Status from_c(const crankloop_options& c, TickOptions& options) noexcept {
  FromC copy;
  each_option(copy, options, c);
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
  each_field(read, layout, full.layout);
  if (const Status refused = change(layout); !refused.ok()) return as_c(refused);
  ToC write;
  each_field(write, layout, full.layout);
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
