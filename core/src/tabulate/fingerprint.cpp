#include "fingerprint.hpp"

#include <cstddef>
#include <type_traits>

#include "../define/every_field.hpp"

namespace crankloop::detail {

static_assert(kListsEveryField<Crank> && kListsEveryField<Masses> && kListsEveryField<Layout> &&
                  kListsEveryField<WiebeDiagram> && kListsEveryField<Pressure> && kListsEveryField<Cam> &&
                  kListsEveryField<Rocker> && kListsEveryField<Valve> && kListsEveryField<ValveTrain> &&
                  kListsEveryField<CamContact> && kListsEveryField<PortOfTrain> && kListsEveryField<Crevice> &&
                  kListsEveryField<Runner> && kListsEveryField<ChargeBurn> && kListsEveryField<Walls> &&
                  kListsEveryField<Gas> && kListsEveryField<Friction> && kListsEveryField<DrivenMachine> &&
                  kListsEveryField<Starter> && kListsEveryField<ToothGap> && kListsEveryField<TriggerWheel> &&
                  kListsEveryField<Misfire> && kListsEveryField<WheelFault> && kListsEveryField<Reluctor> &&
                  kListsEveryField<LambdaSensor> && kListsEveryField<SensorFault>,
              "each_field() lists every field, for the tables' fingerprint and for C, and the range of every number");
static_assert(values_listed<EngineDefinition>() + 2 + kMaxTriggerWheels + kMaxTrains + kMaxCylinders + 1 +
                      kMaxWheelFaults + 3 + kMaxSensorFaults ==
                  values_taken<EngineDefinition>(),
              "all but the gas, trigger wheels and their faults, the cams' contacts, misfires and sensors are listed");

namespace {

/// Adds the fields that the tables depend on: numbers, entries of lists, whole parts.
struct AddRead {
  Fingerprint& f;

  template <class Field>
  void operator()(const ListedField& listed, const Field& field) noexcept {
    if constexpr (std::is_pointer_v<Field> || std::is_array_v<Field>) {
      for (int i = 0; i < listed.read; ++i) (*this)({1, ""}, field[i]);
    } else if constexpr (std::is_same_v<Field, DiagramPoint> || std::is_same_v<Field, CamPoint>) {
      const auto& [at, value] = field;
      f.add(at), f.add(value);
    } else if constexpr (std::is_class_v<Field>) {
      if (listed.read > 0) Field::each_field(*this, field);
    } else if constexpr (std::is_enum_v<Field>) {
      if (listed.read > 0) f.add(static_cast<int>(field));
    } else {
      if (listed.read > 0) f.add(field);
    }
  }
};

/// Adds all fields of a rocker, with the default for those that its kind does not use.
void add_rocker(AddRead& add, const Rocker& rocker) noexcept {
  Rocker used;
  Rocker::each_field([](const ListedField& listed, const auto& from, auto& to) { to = listed.read > 0 ? from : to; },
                     rocker, used);
  Rocker::each_field([&add](const ListedField&, const auto& field) { add({1, ""}, field); }, used);
}

/// Adds the fields of a valve, that its springs surge only if they do: other engines keep the fingerprint of earlier
/// releases.
void add_valve(AddRead& add, const Valve& valve) noexcept {
  Valve::each_field(
      [&](const ListedField& listed, const auto& field) {
        if constexpr (std::is_same_v<decltype(field), const int&>) {
          if (&field == &valve.surge_modes && field == 0) return;
        }
        add(listed, field);
      },
      valve);
}

}  // namespace

std::uint64_t fingerprint_of(const EngineDefinition& engine, const TickOptions& options, const TableReport& report,
                             int scalar_bytes) noexcept {
  // A new part of the definition must be named here, and then added below.
  const auto& [crank, masses, layout, pressure, train_count, trains, friction, load, starter, trigger_count, triggers,
               gas, contacts, misfires, wheel_fault_count, wheel_faults, reluctor, lambda_sensor, sensor_fault_count,
               sensor_faults] = engine;
  Fingerprint f;
  AddRead add{f};
  f.add(kTableFormat);
  f.add(scalar_bytes);
  f.add(options.tick_s);
  f.add(report.tolerance_doublings);
  f.add(report.torque_doublings);
  add({1, ""}, crank);
  add({1, ""}, masses);
  f.add(layout.cylinders);
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    Layout::each_field(
        [&f, k](const ListedField&, const auto& field) {
          if constexpr (!std::is_arithmetic_v<std::remove_reference_t<decltype(field)>>) f.add(+field[k]);
        },
        layout);
  }
  Pressure diagram = pressure;
  if (diagram.source == PressureSource::none || diagram.source == PressureSource::gas) diagram.point_count = 0;
  diagram.wiebe.motored_expansion_exponent = diagram.wiebe.motored_exponent();
  add({1, ""}, diagram);
  if (train_count > 0) {
    add({1, ""}, options.valves.integrator);
    f.add(options.valves.accuracy_m);
    for (int t = 0; t < train_count; ++t) {
      const auto& [cam, rocker, valve] = trains[t];
      add({1, ""}, cam);
      add_rocker(add, rocker);
      add_valve(add, valve);
    }
  }
  // Parts of later releases are added only if they are in use: other engines keep the fingerprint of earlier releases.
  if (report.cut_doublings > 0) f.add(report.cut_doublings);
  if (options.max_speed_rad_s != 0) f.add(options.max_speed_rad_s);
  if (train_count > 0 && options.valves.event_budget != 0) f.add(options.valves.event_budget);
  bool any = false;
  const auto look = [&any](const ListedField&, double x) { any = any || x != 0; };
  Friction::each_field(look, friction);
  DrivenMachine::each_field(look, load);
  Starter::each_field(look, starter);
  if (any) {
    add({1, ""}, friction);
    add({1, ""}, load);
    add({1, ""}, starter);
  }
  if (pressure.source == PressureSource::gas) {
    Gas read = gas;
    for (int t = train_count; t < kMaxTrains; ++t) read.ports[t] = {};
    Gas::each_field(
        [&add, &read](const ListedField& listed, const auto& field) {
          using Field = std::decay_t<decltype(field)>;
          if constexpr (std::is_same_v<Field, Crevice>) {
            if (!field.any()) return;
          }
          if constexpr (std::is_same_v<Field, double>) {
            if (&field == &read.octane_number && field == 0) return;
          }
          if constexpr (!std::is_same_v<Field, Runner> && !std::is_same_v<Field, ChargeBurn> &&
                        !std::is_same_v<Field, Walls>)
            add(listed, field);
        },
        read);
    if (gas.intake_runner.any() || gas.exhaust_runner.any()) {
      add({1, ""}, gas.intake_runner);
      add({1, ""}, gas.exhaust_runner);
    }
    if (gas.charge_burn.in_use) add({1, ""}, gas.charge_burn);
    if (gas.walls.any()) add({1, ""}, gas.walls);
    for (int t = 0; t < train_count; ++t) f.add(trains[t].valve.per_cylinder);  // the port's area counts them
  }
  return f.value();
}

}  // namespace crankloop::detail
