// Definition, options and answers of the C interface. Glue: the rules are validate()'s.
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "definition.hpp"

namespace crankloop::c {
namespace {

/// The largest number of an enumeration that C++ has.
template <class Enum>
inline constexpr Enum kLast{};
template <>
inline constexpr PressureSource kLast<PressureSource> = PressureSource::gas;
template <>
inline constexpr CamSource kLast<CamSource> = CamSource::table;
template <>
inline constexpr RockerKind kLast<RockerKind> = RockerKind::ratio;
template <>
inline constexpr CamTurns kLast<CamTurns> = CamTurns::away_from_pivot;
template <>
inline constexpr GasPort kLast<GasPort> = GasPort::exhaust;
template <>
inline constexpr TriggerShaft kLast<TriggerShaft> = TriggerShaft::cam;
template <>
inline constexpr TriggerPattern kLast<TriggerPattern> = TriggerPattern::edges;
template <>
inline constexpr MisfirePattern kLast<MisfirePattern> = MisfirePattern::listed;
template <>
inline constexpr StuckSignal kLast<StuckSignal> = StuckSignal::high;
template <>
inline constexpr Integrator kLast<Integrator> = Integrator::exponential;

/// Copies one field to C, or from C. The answer of the latter is the first enumerator that C++ does not have, of those
/// that are read.
struct ToC {
  template <class Field, class C>
  void operator()(bool, const char*, const Field& field, C& c) noexcept {
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
  void operator()(bool read, const char* name, Field& field, const C& c) noexcept {
    if constexpr (std::is_pointer_v<Field>) {
      field = reinterpret_cast<Field>(c);
    } else if constexpr (std::is_same_v<Field, bool>) {
      field = c != 0;
    } else {
      if constexpr (std::is_enum_v<Field>) {
        const bool known = !read || (c >= 0 && c <= static_cast<int>(kLast<Field>));
        if (!known && status.ok()) status = refuse(name, Reason::out_of_range);
      }
      field = static_cast<Field>(c);
    }
  }
};

/// A field and its C form: one number or pointer, or all those of a list or a part, whose C form has the same names.
/// What the definition does not read is copied, too.
template <class Copy>
struct EachNumber {
  Copy& copy;

  template <class Field, class C>
  void operator()(const ListedField& listed, Field& field, C& c) noexcept {
    if constexpr (std::is_array_v<C>) {
      for (std::size_t i = 0; i < std::extent_v<C>; ++i)
        (*this)({static_cast<int>(i) < listed.read ? 1 : 0, listed.name}, field[i], c[i]);
    } else if constexpr (std::is_class_v<C>) {
      const auto part = [this, read = listed.read > 0](const ListedField& of_part, auto& from, auto& to) {
        (*this)({read ? of_part.read : 0, of_part.name}, from, to);
      };
      std::remove_const_t<Field>::each_field(part, field, c);
    } else {
      copy(listed.read > 0, listed.name, field, c);
    }
  }
};
/// A port is read where there is a train that opens it.
template <class Copy, class Cpp, class C>
void each_of_gas(EachNumber<Copy>& each, bool breathes, int trains, Cpp& gas, C& c) noexcept {
  const auto field_of_gas = [&](const ListedField& listed, auto& field, auto& c_field) {
    using Entry = std::remove_cv_t<std::remove_extent_t<std::remove_reference_t<decltype(field)>>>;
    const int read = std::is_same_v<Entry, PortOfTrain> ? trains : listed.read;
    each({breathes ? read : 0, listed.name}, field, c_field);
  };
  Gas::each_field(field_of_gas, gas, c);
}
template <class Copy, class Cpp, class C>
void each_field(Copy& copy, Cpp& definition, C& c) noexcept {
  // A new part of the definition must be named here, and then visited below unless each_field() lists it.
  auto& [crank, masses, layout, pressure, train_count, trains, friction, machine, starter, trigger_count, triggers, gas,
         contacts, misfires, wheel_fault_count, wheel_faults, reluctor, lambda_sensor, sensor_fault_count,
         sensor_faults] = definition;
  EachNumber<Copy> each{copy};
  each({1, ""}, definition, c);
  copy(true, "trigger_count", trigger_count, c.trigger_count);
  each({trigger_count, ""}, triggers, c.triggers);
  each_of_gas(each, pressure.source == PressureSource::gas, train_count, gas, c.gas);
  each({train_count, ""}, contacts, c.contacts);
  each({layout.cylinders, ""}, misfires, c.misfires);
  copy(true, "wheel_fault_count", wheel_fault_count, c.wheel_fault_count);
  each({wheel_fault_count, ""}, wheel_faults, c.wheel_faults);
  each({1, ""}, reluctor, c.reluctor);
  each({1, ""}, lambda_sensor, c.lambda_sensor);
  copy(true, "sensor_fault_count", sensor_fault_count, c.sensor_fault_count);
  each({sensor_fault_count, ""}, sensor_faults, c.sensor_faults);
}
template <class Copy, class Cpp, class C>
void each_option(Copy& copy, Cpp& options, C& c) noexcept {
  copy(true, "options.tick_s", options.tick_s, c.tick_s);
  copy(true, "options.valves.integrator", options.valves.integrator, c.valve_integrator);
  copy(true, "options.valves.accuracy_m", options.valves.accuracy_m, c.valve_accuracy_m);
  copy(true, "options.valves.event_budget", options.valves.event_budget, c.valve_event_budget);
  copy(true, "options.max_speed_rad_s", options.max_speed_rad_s, c.max_speed_rad_s);
}

// Rows are read where they are.
static_assert(sizeof(crankloop_diagram_point) == sizeof(DiagramPoint) &&
              offsetof(crankloop_diagram_point, pressure_Pa) == offsetof(DiagramPoint, pressure_Pa));
static_assert(sizeof(crankloop_cam_point) == sizeof(CamPoint) &&
              offsetof(crankloop_cam_point, lift_m) == offsetof(CamPoint, lift_m));

static_assert(CRANKLOOP_MAX_TRIGGER_WHEELS == kMaxTriggerWheels && CRANKLOOP_MAX_TOOTH_GAPS == kMaxToothGaps &&
              CRANKLOOP_MAX_LISTED_MISFIRES == kMaxListedMisfires && CRANKLOOP_MAX_WHEEL_FAULTS == kMaxWheelFaults &&
              CRANKLOOP_MAX_SENSOR_FAULTS == kMaxSensorFaults && CRANKLOOP_MAX_FLOW_POINTS == kMaxFlowPoints);
static_assert(CRANKLOOP_MAX_CYLINDERS == kMaxCylinders && CRANKLOOP_MAX_TRAINS == kMaxTrains &&
              CRANKLOOP_MAX_CAM_EXPONENTS == kMaxCamExponents);
static_assert(CRANKLOOP_UNSTABLE == static_cast<int>(Reason::unstable) &&
              CRANKLOOP_TOO_MUCH_HEAT == static_cast<int>(Reason::too_much_heat) &&
              CRANKLOOP_ROD_TOO_SHORT == static_cast<int>(Reason::rod_too_short) &&
              CRANKLOOP_NO_SOLUTION == static_cast<int>(Reason::no_solution) &&
              CRANKLOOP_CONTRACTING_BUILD == static_cast<int>(Reason::contracting_build));
static_assert(CRANKLOOP_PRESSURE_WIEBE == static_cast<int>(PressureSource::wiebe) &&
              CRANKLOOP_PRESSURE_NONE == static_cast<int>(PressureSource::none) &&
              CRANKLOOP_PRESSURE_ANGLE_TABLE == static_cast<int>(PressureSource::angle_table) &&
              CRANKLOOP_PRESSURE_GAS == static_cast<int>(PressureSource::gas) &&
              CRANKLOOP_PORT_EXHAUST == static_cast<int>(GasPort::exhaust));
static_assert(CRANKLOOP_CAM_TABLE == static_cast<int>(CamSource::table) &&
              CRANKLOOP_ROCKER_RATIO == static_cast<int>(RockerKind::ratio) &&
              CRANKLOOP_CAM_TURNS_AWAY_FROM_PIVOT == static_cast<int>(CamTurns::away_from_pivot) &&
              CRANKLOOP_TRIGGER_ON_CAM == static_cast<int>(TriggerShaft::cam) &&
              CRANKLOOP_TRIGGER_EDGES == static_cast<int>(TriggerPattern::edges) &&
              CRANKLOOP_MISFIRE_LISTED == static_cast<int>(MisfirePattern::listed) &&
              CRANKLOOP_STUCK_HIGH == static_cast<int>(StuckSignal::high) &&
              CRANKLOOP_SENSOR_COOLANT == static_cast<int>(ControllerSensor::coolant) &&
              CRANKLOOP_WIRE_SHORTED == static_cast<int>(SensorWire::shorted) &&
              CRANKLOOP_INTEGRATOR_EXPONENTIAL == static_cast<int>(Integrator::exponential));

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
  FromC check;  // which fields are read is known now
  each_field(check, definition, c);
  return check.status;
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

}  // namespace crankloop::c
