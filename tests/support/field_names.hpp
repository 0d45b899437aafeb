// The names that a refusal about a definition may have: those of its fields.
#pragma once

#include <crankloop/define/engine_definition.hpp>

#include <set>
#include <string>
#include <type_traits>

namespace crankloop::support {

/// Collects the names of each_field(): of lists, and of what their entries have.
class FieldNames {
 public:
  FieldNames() {
    (*this)({1, ""}, EngineDefinition{});
    (*this)({1, ""}, Gas{});
    (*this)({1, ""}, TriggerWheel{});
    (*this)({1, ""}, CamContact{});
    (*this)({1, ""}, Misfire{});
    (*this)({1, ""}, WheelFault{});
    (*this)({1, ""}, Reluctor{});
    (*this)({1, ""}, LambdaSensor{});
    (*this)({1, ""}, SensorFault{});
    names_.insert("sensor_fault_count");
    names_.insert("trigger_count");
    names_.insert("wheel_fault_count");
  }
  template <class Field>
  void operator()(const ListedField& listed, const Field& field) {
    if constexpr (kHasFields<Field>) {
      Field::each_field(*this, field);
    } else if constexpr (std::is_array_v<Field>) {
      names_.insert(listed.name);
      (*this)(listed, field[0]);
    } else {
      names_.insert(listed.name);
    }
  }

  /// Whether `field` is one, or not of a definition but of options, tables, states or arguments.
  [[nodiscard]] bool may_be(const std::string& field) const {
    const std::string part = field.substr(0, field.find('.'));
    for (const char* other : {"options", "targets", "tables", "scene", "state", "build", "order", "columns"}) {
      if (part == other) return true;
    }
    return names_.count(field) > 0;
  }

 private:
  std::set<std::string> names_;
};

[[nodiscard]] inline bool is_field(const std::string& field) {
  static const FieldNames names;
  return names.may_be(field);
}

}  // namespace crankloop::support
