// Validation of a definition; field names as in the engine file.
#include <crankloop/define/engine_definition.hpp>

#include <cstddef>

#include "rules.hpp"

namespace crankloop {

using detail::finite;
using detail::first_refusal;
using detail::in_range;
using detail::out_of_range;

namespace {

/// Whether two angles in degrees are equal modulo 360; false if they differ by 1e6 deg or more.
[[nodiscard]] bool same_direction(double a_deg, double b_deg) noexcept {
  constexpr double kSameAngleDeg = 1e-6;
  const double d = a_deg - b_deg;
  if (!(d > -1e6 && d < 1e6)) return false;
  const double turns = d / 360;
  const double apart = d - 360 * static_cast<double>(static_cast<int>(turns < 0 ? turns - 0.5 : turns + 0.5));
  return apart <= kSameAngleDeg && apart >= -kSameAngleDeg;
}

}  // namespace

Status validate(const Crank& crank) noexcept {
  if (const Status refused = out_of_range(crank); !refused.ok()) return refused;
  if (crank.rod_length_m <= crank.least_rod_length_m()) return refuse("crank.rod_length_m", Reason::rod_too_short);
  return {};
}

void lump_rod(const RigidRod& rod, const Crank& crank, Masses& masses) noexcept {
  const double l_crank = rod.com_to_crank_m;
  const double l_pin = crank.rod_length_m - l_crank;
  masses.rod_small_end_kg = rod.mass_kg * l_crank / crank.rod_length_m;
  masses.rod_big_end_kg = rod.mass_kg * l_pin / crank.rod_length_m;
  masses.rod_inertia_correction_kg_m2 = rod.inertia_kg_m2 - rod.mass_kg * l_pin * l_crank;
}

void reduce_throw(const CrankThrow& crank_throw, const Crank& crank, Masses& masses) noexcept {
  masses.crank_pin_equivalent_kg =
      crank_throw.pin_kg + 2 * crank_throw.web_kg * crank_throw.web_com_m / crank.crank_radius_m;
}

Status validate(const Masses& masses) noexcept {
  if (const Status refused = out_of_range(masses); !refused.ok()) return refused;
  return in_range(masses.reciprocating_kg(), "masses.piston_kg", above(0));
}

Status set_firing_order(const int* order, int cylinders, Layout& layout) noexcept {
  if (cylinders < 1 || cylinders > kMaxCylinders) return refuse("layout.cylinders", Reason::out_of_range);
  unsigned seen = 0;
  for (int i = 0; i < cylinders; ++i) {
    const int cylinder = order[i];
    if (cylinder < 1 || cylinder > cylinders || (seen >> cylinder & 1u) != 0) {
      return refuse("order", Reason::not_a_permutation, i);
    }
    seen |= 1u << cylinder;
  }
  // Angle 0 is where cylinder 1 fires, whichever cylinder the order starts with.
  int first = 0;
  while (order[first] != 1) ++first;
  layout.cylinders = cylinders;
  for (int i = 0; i < cylinders; ++i) {
    const int place = (i - first + cylinders) % cylinders;
    layout.firing_deg[static_cast<std::size_t>(order[i] - 1)] = 720.0 * place / cylinders;
  }
  return {};
}

void share_pins_by_position(Layout& layout) noexcept {
  if (layout.cylinders < 1 || layout.cylinders > kMaxCylinders) return;  // validate() refuses it
  const auto n = static_cast<std::size_t>(layout.cylinders);
  // The first cylinder on a pin identifies the pin; then pins are numbered by position.
  std::array<std::size_t, kMaxCylinders> leader{};
  for (std::size_t k = 0; k < n; ++k) {
    leader[k] = k;
    for (std::size_t other = 0; other < k; ++other) {
      if (layout.position_m[other] == layout.position_m[k] &&
          same_direction(layout.throw_deg(static_cast<int>(k)), layout.throw_deg(static_cast<int>(other)))) {
        leader[k] = leader[other];
        break;
      }
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    std::uint8_t before = 0;
    for (std::size_t other = 0; other < n; ++other) {
      if (leader[other] != other || leader[k] == other) continue;
      const double there = layout.position_m[other];
      const double here = layout.position_m[leader[k]];
      if (there < here || (there == here && other < leader[k])) ++before;
    }
    layout.pin[k] = before;
  }
}

namespace {

/// Mean position of the rods on a pin, which has at least one, as the first rod's position plus the mean distance from
/// it: exact for equal positions.
[[nodiscard]] double pin_position_m(const Layout& layout, std::size_t pin) noexcept {
  double first = 0;
  double beyond = 0;
  int rods = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    if (layout.pin[k] != pin) continue;
    if (rods == 0) first = layout.position_m[k];
    beyond += layout.position_m[k] - first;
    ++rods;
  }
  return first + beyond / rods;
}

}  // namespace

Status validate(const Layout& layout) noexcept {
  if (const Status refused = out_of_range(layout); !refused.ok()) return refused;
  const auto n = static_cast<std::size_t>(layout.cylinders);
  std::uint8_t last_pin = 0;
  unsigned pins_used = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const int index = static_cast<int>(k);
    if (layout.pin[k] >= n) return refuse("layout.pin", Reason::out_of_range, index);
    pins_used |= 1u << layout.pin[k];
    if (layout.pin[k] > last_pin) last_pin = layout.pin[k];
    for (std::size_t other = 0; other < k; ++other) {
      if (layout.pin[other] != layout.pin[k]) continue;
      if (!same_direction(layout.throw_deg(index), layout.throw_deg(static_cast<int>(other)))) {
        return refuse("layout.pin", Reason::inconsistent, index);
      }
    }
  }
  if (pins_used != (2u << last_pin) - 1u) return refuse("layout.pin", Reason::inconsistent);  // pin numbers with a gap
  for (std::size_t pin = 1; pin <= last_pin; ++pin) {
    if (pin_position_m(layout, pin) < pin_position_m(layout, pin - 1))
      return refuse("layout.pin", Reason::inconsistent);
  }
  return {};
}

namespace {

[[nodiscard]] Status validate_wiebe(const WiebeDiagram& w) noexcept {
  if (const Status refused = out_of_range(w); !refused.ok()) return refused;
  if (w.start_of_combustion_deg + w.combustion_duration_deg > w.exhaust_valve_opens_deg) {
    return refuse("pressure.wiebe.combustion_duration_deg", Reason::inconsistent);
  }
  if (w.motored_exponent() < w.compression_exponent)
    return refuse("pressure.wiebe.motored_expansion_exponent",
                  Reason::inconsistent);  // the motored cycle would gain energy
  return {};
}

constexpr int kLeastAnglePoints = 8;
constexpr int kLeastVolumePoints = 16;
constexpr int kMaxPoints = 1 << 20;

[[nodiscard]] Status validate_points(const Pressure& pressure, int least) noexcept {
  if (pressure.points == nullptr || pressure.point_count < least)
    return refuse("pressure.points", Reason::too_few_points);
  if (pressure.point_count > kMaxPoints) return refuse("pressure.points", Reason::too_many_points);
  for (int i = 0; i < pressure.point_count; ++i) {
    const DiagramPoint& point = pressure.points[i];
    if (!finite(point.at)) return refuse("pressure.points", Reason::not_finite, i);
    if (const Status refused = in_range(point.pressure_Pa, "pressure.points", from(0).up_to(kMaxPressure_Pa), i);
        !refused.ok())
      return refused;
  }
  return {};
}

[[nodiscard]] Status validate_angles(const Pressure& pressure) noexcept {
  if (const Status refused = validate_points(pressure, kLeastAnglePoints); !refused.ok()) return refused;
  for (int i = 0; i < pressure.point_count; ++i) {
    const double at = pressure.points[i].at;
    if (at < -kMaxDiagramAngle_deg || at > kMaxDiagramAngle_deg)
      return refuse("pressure.points", Reason::out_of_range, i);
    if (i > 0 && at <= pressure.points[i - 1].at) return refuse("pressure.points", Reason::not_increasing, i);
  }
  // One period without a gap: the rows span at most 720 deg, and at most 60 deg are missing between the last row and
  // the first.
  const double span = pressure.points[pressure.point_count - 1].at - pressure.points[0].at;
  constexpr double kWidestGapDeg = 60;
  if (span > 720 + 1e-9 || span < 720 - kWidestGapDeg) return refuse("pressure.points", Reason::not_one_period);
  return {};
}

}  // namespace

Status validate(const Pressure& pressure, const Crank& crank) noexcept {
  if (const Status refused = out_of_range(pressure); !refused.ok()) return refused;
  switch (pressure.source) {
    case PressureSource::none:
    case PressureSource::gas:
      return {};
    case PressureSource::wiebe:
      return validate_wiebe(pressure.wiebe);
    case PressureSource::angle_table:
      return validate_angles(pressure);
    case PressureSource::volume_table:
      (void)crank;  // tabulate/indicator_diagram.hpp checks the volumes against the dead centres when it converts them
                    // to angles
      return validate_points(pressure, kLeastVolumePoints);
  }
  return refuse("pressure.source", Reason::out_of_range);  // an undefined source
}

namespace {

/// A sensor has to fit its wheel: spaces long enough for its lobes, and for the table.
[[nodiscard]] Status validate_reluctor(const EngineDefinition& engine) noexcept {
  const Reluctor& sensor = engine.reluctor;
  if (const Status refused = validate(sensor); !refused.ok() || sensor.wheel < 0) return refused;
  if (sensor.wheel >= engine.trigger_count) return refuse("reluctor.wheel", Reason::out_of_range);
  const TriggerWheel& wheel = engine.triggers[sensor.wheel];
  if (wheel.pattern != TriggerPattern::teeth || wheel.train >= 0 || wheel.places > kMaxReluctorPlaces)
    return refuse("reluctor.wheel", Reason::inconsistent);
  if (sensor.reach_ratio < wheel.tooth_ratio + 0.1) return refuse("reluctor.reach_ratio", Reason::inconsistent);
  return {};
}

}  // namespace

Status validate(const EngineDefinition& engine) noexcept {
  const Status answers[] = {validate(engine.crank),    validate(engine.masses),
                            validate(engine.layout),   validate(engine.pressure, engine.crank),
                            validate(engine.friction), validate(engine.machine),
                            validate(engine.starter)};
  if (engine.train_count < 0 || engine.train_count > kMaxTrains) return refuse("train_count", Reason::out_of_range);
  if (const Status refused = first_refusal(answers); !refused.ok()) return refused;
  for (int t = 0; t < engine.train_count; ++t) {
    if (const Status refused = validate(engine.trains[t]); !refused.ok())
      return refuse(refused.field, refused.reason, t);
    if (const Status refused = validate(engine.contacts[t]); !refused.ok())
      return refuse(refused.field, refused.reason, t);
  }
  // No rod has a negative moment of inertia: J_rod = dI + m_rod l_pin l_crank.
  const Masses& m = engine.masses;
  const double rod_kg = m.rod_small_end_kg + m.rod_big_end_kg;
  const double ends_kg_m2 = rod_kg > 0 ? m.rod_small_end_kg * m.rod_big_end_kg / rod_kg * engine.crank.rod_length_m *
                                             engine.crank.rod_length_m
                                       : 0;
  if (m.rod_inertia_correction_kg_m2 < -ends_kg_m2 * (1 + 1e-9))
    return refuse("masses.rod_inertia_correction_kg_m2", Reason::negative);

  if (engine.pressure.source == PressureSource::gas) {
    if (const Status refused = validate(engine.gas, engine.train_count); !refused.ok()) return refused;
  }
  for (int k = 0; k < engine.layout.cylinders; ++k) {
    if (const Status refused = validate(engine.misfires[k]); !refused.ok())
      return refuse(refused.field, refused.reason, k);
  }
  if (engine.trigger_count < 0 || engine.trigger_count > kMaxTriggerWheels)
    return refuse("trigger_count", Reason::out_of_range);
  for (int i = 0; i < engine.trigger_count; ++i) {
    const TriggerWheel& wheel = engine.triggers[i];
    if (const Status refused = validate(wheel); !refused.ok()) return refuse(refused.field, refused.reason, i);
    if (wheel.train >= engine.train_count) return refuse("trigger.train", Reason::out_of_range, i);
  }
  if (engine.wheel_fault_count < 0 || engine.wheel_fault_count > kMaxWheelFaults)
    return refuse("wheel_fault_count", Reason::out_of_range);
  for (int i = 0; i < engine.wheel_fault_count; ++i) {
    const WheelFault& fault = engine.wheel_faults[i];
    if (const Status refused = validate(fault); !refused.ok()) return refuse(refused.field, refused.reason, i);
    if (fault.wheel >= engine.trigger_count) return refuse("fault.wheel", Reason::out_of_range, i);
  }
  if (const Status refused = validate_reluctor(engine); !refused.ok()) return refused;
  if (const Status refused = validate(engine.lambda_sensor); !refused.ok()) return refused;
  if (engine.sensor_fault_count < 0 || engine.sensor_fault_count > kMaxSensorFaults)
    return refuse("sensor_fault_count", Reason::out_of_range);
  for (int i = 0; i < engine.sensor_fault_count; ++i) {
    if (const Status refused = validate(engine.sensor_faults[i]); !refused.ok())
      return refuse(refused.field, refused.reason, i);
  }
  return {};
}

}  // namespace crankloop
