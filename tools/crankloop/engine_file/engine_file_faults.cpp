// Faults and sensors of an engine file: [fault NAME], [sensor_fault NAME], [reluctor], [lambda_sensor] as definitions,
// and messages for their errors.
#include <algorithm>
#include <string>
#include <vector>

#include "../files/words.hpp"
#include "engine_file.hpp"
#include "engine_file_parts.hpp"

namespace crankloop::program {
namespace {

WheelFault build_fault(const SectionValues& values) {
  WheelFault fault;
  fill(values, fault);
  fault.inverted = values.text("inverted") == "yes";
  const std::string& stuck = values.text("stuck");
  fault.stuck = stuck == "low" ? StuckSignal::low : stuck == "high" ? StuckSignal::high : StuckSignal::no;
  return fault;
}

SensorFault build_sensor_fault(const SectionValues& values) {
  SensorFault fault;
  fill(values, fault);
  const std::string& sensor = values.text("sensor");
  fault.sensor = sensor == "map"          ? ControllerSensor::map
                 : sensor == "intake_air" ? ControllerSensor::intake_air
                 : sensor == "tps"        ? ControllerSensor::tps
                 : sensor == "lambda"     ? ControllerSensor::lambda
                                          : ControllerSensor::coolant;
  const std::string& wire = values.text("wire");
  fault.wire = wire == "stuck"   ? SensorWire::stuck
               : wire == "open"  ? SensorWire::open
               : wire == "short" ? SensorWire::shorted
                                 : SensorWire::good;
  return fault;
}

/// The key of a field whose part of a Status tells what is wrong, and why.
std::string why(const Status& status) {
  const std::string_view field = status.field;
  if (field == "fault.end_s" || field == "sensor_fault.end_s")
    return "is never on: give end_s above start_s, or an input_bit";
  if (field == "sensor_fault.most")
    return "is not above least: a wire that is open or shorted, and steps, need a range";
  if (field == "sensor_fault.step") return "makes more than 65536 steps of the range";
  if (field == "fault.moved_tooth" && status.reason == Reason::inconsistent) return "is the tooth that is missing";
  if (field == "fault.missing_tooth" && status.reason == Reason::too_few_points) return "leaves the wheel no tooth";
  if (status.reason == Reason::out_of_range && (field == "fault.missing_tooth" || field == "fault.moved_tooth"))
    return "is more than the wheel has teeth";
  if (field == "fault.noise_Hz") return "is more than one pulse in a tick";
  if (field == "fault.noise_pulse_s" && status.reason == Reason::out_of_range) return "is more than half a tick";
  if (status.reason == Reason::inconsistent) return "leaves edges closer than 0.001 deg, or in another order";
  return describe(status.reason);
}

}  // namespace

int EngineFile::wheel_of(const SectionValues& section) const {
  const std::string& name = section.text("trigger");
  const auto wheel = std::find_if(triggers_.begin(), triggers_.end(),
                                  [&name](const TriggerOfFile& trigger) { return trigger.name == name; });
  if (wheel == triggers_.end()) {
    std::vector<std::string> names;
    for (const TriggerOfFile& trigger : triggers_) names.push_back(trigger.name);
    refuse(section, "trigger",
           in_quotes(name) + (names.empty() ? " is none: the file has no [trigger NAME]"
                                            : " is not one of " + join(names) + suggestion(name, names)),
           path_);
  }
  return static_cast<int>(wheel - triggers_.begin());
}

void EngineFile::build_reluctor() {
  const SectionValues* section = find("reluctor");
  if (section == nullptr) return;
  Reluctor sensor;
  fill(*section, sensor);
  sensor.wheel = wheel_of(*section);
  sensor.reversed = section->text("reversed") == "yes";
  definition_.reluctor = sensor;
  const TriggerWheel& wheel = definition_.triggers[sensor.wheel];
  if (wheel.pattern != TriggerPattern::teeth || wheel.train >= 0 || wheel.places > kMaxReluctorPlaces) {
    refuse(*section, "trigger",
           in_quotes(section->text("trigger")) + " is no wheel of up to " + std::to_string(kMaxReluctorPlaces) +
               " evenly spaced teeth that no phaser moves",
           path_);
  }
  if (sensor.reach_ratio < wheel.tooth_ratio + 0.1)
    refuse(*section, "reach_ratio", "must exceed the wheel's tooth_ratio by 0.1", path_);
}

void EngineFile::build_lambda_sensor() {
  const SectionValues* section = find("lambda_sensor");
  if (section == nullptr) return;
  if (definition_.pressure.source != PressureSource::gas)
    throw InputError(path_, section->line, section->title() + " needs [pressure] source = gas: without, no gas flows");
  fill(*section, definition_.lambda_sensor);
  definition_.lambda_sensor.in_use = true;
}

void EngineFile::build_sensor_faults() {
  for (const SectionValues& section : sections_) {
    if (section.kind != "sensor_fault") continue;
    if (definition_.pressure.source != PressureSource::gas)
      throw InputError(path_, section.line, section.title() + " needs [pressure] source = gas: without, no gas flows");
    if (definition_.sensor_fault_count == kMaxSensorFaults) {
      throw InputError(path_, section.line,
                       section.title() + " makes one fault too many; allowed: " + std::to_string(kMaxSensorFaults));
    }
    const SensorFault& fault = definition_.sensor_faults[definition_.sensor_fault_count++] =
        build_sensor_fault(section);
    if (const Status status = validate(fault); !status.ok()) throw explain_fault(status, section);
    if (fault.sensor == ControllerSensor::lambda && !definition_.lambda_sensor.in_use)
      throw InputError(path_, section.line_of("sensor"), section.title() + " sensor: lambda needs a [lambda_sensor]");
  }
}

void EngineFile::build_faults() {
  for (const SectionValues& section : sections_) {
    if (section.kind != "fault") continue;
    if (definition_.wheel_fault_count == kMaxWheelFaults) {
      throw InputError(path_, section.line,
                       section.title() + " makes one fault too many; allowed: " + std::to_string(kMaxWheelFaults));
    }
    WheelFault fault = build_fault(section);
    fault.wheel = wheel_of(section);
    definition_.wheel_faults[definition_.wheel_fault_count++] = fault;
    if (const Status status = validate(fault); !status.ok()) throw explain_fault(status, section);
  }
}

InputError EngineFile::explain_fault(const Status& status, const SectionValues& section) const {
  const Key& key = *key_of_field(status.field);
  return {path_, section.line_of(key.name), section.title() + " " + in_words(section, key, Reason::ok, why(status))};
}

const SectionValues* EngineFile::fault_to_blame(const Key& key, int index) const {
  if (std::string_view(key.section) != "fault") return nullptr;
  int number = 0;
  for (const SectionValues& section : sections_) {
    if (section.kind == "fault" && number++ == index) return &section;
  }
  return nullptr;
}

}  // namespace crankloop::program
