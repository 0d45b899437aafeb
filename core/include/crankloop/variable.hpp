// One variable of a scene: its name, unit and meaning; what an engine has of each.
//
// What belongs here: how a variable is described. What does not: which there are (variables.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <crankloop/phase.hpp>
#include <crankloop/tables/tables.hpp>

namespace crankloop::detail {

/// How many there are of what is counted, and the range of speed: of the engine, where a scene has only a capacity.
struct EngineShape {
  std::uint32_t cylinders = 1;
  std::uint32_t trains = 0;
  std::uint32_t wheels = 0;
  double speed_limit_rad_s = 0;
};

/// What an engine's tables say of its shape.
template <class Real, class S>
[[nodiscard]] constexpr EngineShape shape_of(const Tables<Real, S>& tables) noexcept {
  EngineShape shape{tables.drive->cylinders, 0, 0, static_cast<double>(tables.drive->speed_limit_rad_s)};
  if constexpr (detail::Needs<S>::any_valves) shape.trains = tables.drive->trains;
  if constexpr (detail::Needs<S>::any_triggers) shape.wheels = tables.triggers->count;
  return shape;
}

enum class VariableKind : std::uint8_t { real, whole, truth };

/// A unit as names end in it and as it is written, in SI base units: one of it is `factor` of them.
struct UnitOfName {
  std::string_view suffix;
  const char* written;
  int kg, m, s, K, rad;  ///< exponents of the base units
  double factor = 1;
  const char* displayed = "";        ///< the unit that engineers like to read; "" this one
  double displayed_per_written = 1;  ///< value in that unit = this * value
};

inline constexpr double kRadSPerRpm = 0.10471975511965977;
inline constexpr double kRadSPer1000Rpm = 104.71975511965977;
inline constexpr UnitOfName kNoUnit{"", "1", 0, 0, 0, 0, 0};
/// Where one suffix ends another, the longer one comes first. Those behind the empty line are of engine files alone.
inline constexpr UnitOfName kUnitsOfNames[] = {
    {"_rad_s2", "rad/s2", 0, 0, -2, 0, 1},
    {"_rad_s", "rad/s", 0, 0, -1, 0, 1, 1, "rpm", 9.549296585513721},
    {"_m_s2", "m/s2", 0, 1, -2, 0, 0},
    {"_m_s", "m/s", 0, 1, -1, 0, 0},
    {"_kg_s", "kg/s", 1, 0, -1, 0, 0},
    {"_kg_m2", "kg.m2", 1, 2, 0, 0, 0},
    {"_Nm", "N.m", 1, 2, -2, 0, 0},
    {"_Pa", "Pa", 1, -1, -2, 0, 0, 1, "bar", 1e-5},
    {"_deg", "deg", 0, 0, 0, 0, 1, kRadPerDegree},
    {"_rad", "rad", 0, 0, 0, 0, 1, 1, "deg", 57.29577951308232},
    {"_kg", "kg", 1, 0, 0, 0, 0},
    {"_m", "m", 0, 1, 0, 0, 0, 1, "mm", 1e3},
    {"_N", "N", 1, 1, -2, 0, 0},
    {"_K", "K", 0, 0, 0, 1, 0},
    {"_J", "J", 1, 2, -2, 0, 0},
    {"_W", "W", 1, 2, -3, 0, 0},
    {"_V", "V", 1, 2, -3, 0, 0},  // and 1/A

    {"_V_s", "V.s", 1, 2, -2, 0, 0},  // and 1/A
    {"_deg_per_s", "deg/s", 0, 0, -1, 0, 1, kRadPerDegree},
    {"_kPa_per_1000rpm", "kPa/krpm", 1, -1, -1, 0, -1, 1e3 / kRadSPer1000Rpm},
    {"_kPa_per_1000rpm2", "kPa/krpm2", 1, -1, 0, 0, -2, 1e3 / kRadSPer1000Rpm / kRadSPer1000Rpm},
    {"_Nm_per_1000rpm", "N.m/krpm", 1, 2, -1, 0, -1, 1 / kRadSPer1000Rpm},
    {"_Nm_per_1000rpm2", "N.m/krpm2", 1, 2, 0, 0, -2, 1 / kRadSPer1000Rpm / kRadSPer1000Rpm},
    {"_rpm", "rpm", 0, 0, -1, 0, 1, kRadSPerRpm},
    {"_N_per_mm", "N/mm", 1, 0, -2, 0, 0, 1e3},
    {"_kg_mm2", "kg.mm2", 1, 2, 0, 0, 0, 1e-6},
    {"_kPa", "kPa", 1, -1, -2, 0, 0, 1e3},
    {"_MPa", "MPa", 1, -1, -2, 0, 0, 1e6},
    {"_GPa", "GPa", 1, -1, -2, 0, 0, 1e9},
    {"_mm2", "mm2", 0, 2, 0, 0, 0, 1e-6},
    {"_mm", "mm", 0, 1, 0, 0, 0, 1e-3},
    {"_um", "um", 0, 1, 0, 0, 0, 1e-6},
    {"_us", "us", 0, 0, 1, 0, 0, 1e-6},
    {"_Hz", "Hz", 0, 0, -1, 0, 0},
    {"_g", "g", 1, 0, 0, 0, 0, 1e-3},

    {"_s", "s", 0, 0, 1, 0, 0},
    {"time", "s", 0, 0, 1, 0, 0},
};

/// The unit that a name ends in, its index left aside; kNoUnit of "load_ratio".
[[nodiscard]] constexpr const UnitOfName& unit_of(std::string_view name) noexcept {
  if (!name.empty() && name.back() == ']') name = name.substr(0, name.rfind('['));
  for (const UnitOfName& unit : kUnitsOfNames) {
    const std::size_t size = unit.suffix.size();
    if (name.size() >= size && name.substr(name.size() - size) == unit.suffix) return unit;
  }
  return kNoUnit;
}

/// A variable beside its value. "valve[#,#].lift_m" is one of several: each # stands for an index, counted from 1 when
/// it is written.
struct Variable {
  VariableKind kind;
  const char* name;
  const char* meaning;
  std::uint32_t first = 0;   ///< index of the first #, from 0
  std::uint32_t second = 0;  ///< of the second
  double least = 0;          ///< of an input; least = most: no range is stated
  double most = 0;
  const UnitOfName* unit = nullptr;  ///< null: that in which the name ends

  [[nodiscard]] constexpr Variable at(std::uint32_t i, std::uint32_t j = 0) const noexcept {
    return {kind, name, meaning, i, j, least, most, unit};
  }
  [[nodiscard]] constexpr Variable within(double from, double to) const noexcept {
    return {kind, name, meaning, first, second, from, to, unit};
  }
};

[[nodiscard]] constexpr Variable real(const char* name, const char* meaning) noexcept {
  return {VariableKind::real, name, meaning};
}
[[nodiscard]] constexpr Variable whole(const char* name, const char* meaning) noexcept {
  return {VariableKind::whole, name, meaning};
}
[[nodiscard]] constexpr Variable truth(const char* name, const char* meaning) noexcept {
  return {VariableKind::truth, name, meaning};
}

[[nodiscard]] constexpr const UnitOfName& unit_of(const Variable& variable) noexcept {
  return variable.unit != nullptr ? *variable.unit : unit_of(variable.name);
}

/// Whether that is its name, with its indices counted from 1: "valve[2,1].lift_m".
[[nodiscard]] constexpr bool is_named(const Variable& variable, const char* name) noexcept {
  std::uint32_t index = variable.first;
  for (const char* c = variable.name; *c != '\0'; ++c) {
    if (*c != '#') {
      if (*name++ != *c) return false;
      continue;
    }
    std::uint32_t digits = 1;
    for (std::uint32_t rest = (index + 1) / 10; rest > 0; rest /= 10) digits *= 10;
    for (; digits > 0; digits /= 10) {
      if (*name++ != static_cast<char>('0' + (index + 1) / digits % 10)) return false;
    }
    index = variable.second;
  }
  return *name == '\0';
}

}  // namespace crankloop::detail
