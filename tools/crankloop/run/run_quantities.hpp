// The quantities of one cylinder that `run` shows: name, unit, and where they stand in the output of a step.
//
// What belongs here: the list, once, for CSV columns, peaks, plots and the comparison with the exact engine.
// What does not: what is done with them.
#pragma once

#include <cstddef>
#include <cstdint>

#include <crankloop/tick/scenes.hpp>

namespace crankloop::program {

template <class Real>
using WholeOutput = crankloop::Output<Real, scenes::Whole>;

/// In the order of the CSV columns; those from rod_angle on are not in the CSV.
enum class Quantity : std::uint8_t {
  pressure,
  displacement,
  velocity,
  acceleration,
  gas_force,
  inertia_force,
  total_force,
  side_force,
  rod_force,
  radial_force,
  tangential_force,
  torque,
  tilting_moment,
  crank_pin_load,
  rod_angle,
  rod_speed,
  rod_acceleration,
  pin_radial,
  pin_tangential,
};
inline constexpr std::size_t kCsvQuantities = 14;
inline constexpr std::size_t kQuantities = 19;

[[nodiscard]] constexpr std::size_t index_of(Quantity quantity) noexcept { return static_cast<std::size_t>(quantity); }

/// How a quantity is written: value in SI times `per_si`, in a unit that stands in CSV names as `suffix`.
struct QuantityKind {
  Quantity quantity;
  const char* name;
  const char* suffix;
  const char* unit;
  double per_si;
};

inline constexpr double kDegPerRad = 180 / 3.14159265358979323846;

inline constexpr QuantityKind kQuantityKinds[kQuantities] = {
    {Quantity::pressure, "pressure", "kPa", "kPa", 1e-3},
    {Quantity::displacement, "displacement", "mm", "mm", 1e3},
    {Quantity::velocity, "velocity", "m_s", "m/s", 1},
    {Quantity::acceleration, "acceleration", "m_s2", "m/s^2", 1},
    {Quantity::gas_force, "gas_force", "N", "N", 1},
    {Quantity::inertia_force, "inertia_force", "N", "N", 1},
    {Quantity::total_force, "total_force", "N", "N", 1},
    {Quantity::side_force, "side_force", "N", "N", 1},
    {Quantity::rod_force, "rod_force", "N", "N", 1},
    {Quantity::radial_force, "radial_force", "N", "N", 1},
    {Quantity::tangential_force, "tangential_force", "N", "N", 1},
    {Quantity::torque, "torque", "Nm", "Nm", 1},
    {Quantity::tilting_moment, "tilting_moment", "Nm", "Nm", 1},
    {Quantity::crank_pin_load, "crank_pin_load", "N", "N", 1},
    {Quantity::rod_angle, "rod_angle", "deg", "deg", kDegPerRad},
    {Quantity::rod_speed, "rod_speed", "rad_s", "rad/s", 1},
    {Quantity::rod_acceleration, "rod_acceleration", "rad_s2", "rad/s^2", 1},
    {Quantity::pin_radial, "pin_radial", "N", "N", 1},
    {Quantity::pin_tangential, "pin_tangential", "N", "N", 1},
};

/// A cylinder and the crank pin that carries its rod, both from 0.
struct CylinderPlace {
  std::size_t cylinder = 0;
  std::size_t pin = 0;
};

[[nodiscard]] inline CylinderPlace place_of(const Layout& layout, std::size_t cylinder) noexcept {
  return {cylinder, layout.pin[cylinder]};
}

/// In SI. Crank pin values are those of the whole pin, with all its rods.
template <class Real>
[[nodiscard]] Real value_of(const WholeOutput<Real>& out, Quantity quantity, CylinderPlace place) noexcept {
  const CylinderForces<Real>& forces = out.cylinder[place.cylinder];
  switch (quantity) {
    case Quantity::pressure:
      return forces.pressure_Pa;
    case Quantity::displacement:
      return out.displacement_m[place.cylinder];
    case Quantity::velocity:
      return out.velocity_m_s[place.cylinder];
    case Quantity::acceleration:
      return out.acceleration_m_s2[place.cylinder];
    case Quantity::gas_force:
      return forces.gas_force_N;
    case Quantity::inertia_force:
      return forces.inertia_force_N;
    case Quantity::total_force:
      return forces.total_force_N;
    case Quantity::side_force:
      return forces.side_force_N;
    case Quantity::rod_force:
      return forces.rod_force_N;
    case Quantity::radial_force:
      return forces.radial_force_N;
    case Quantity::tangential_force:
      return forces.tangential_force_N;
    case Quantity::torque:
      return forces.torque_Nm;
    case Quantity::tilting_moment:
      return forces.tilting_moment_Nm;
    case Quantity::crank_pin_load:
      return out.pin_load_N[place.pin];
    case Quantity::rod_angle:
      return out.rod_angle_rad[place.cylinder];
    case Quantity::rod_speed:
      return out.rod_speed_rad_s[place.cylinder];
    case Quantity::rod_acceleration:
      return out.rod_acceleration_rad_s2[place.cylinder];
    case Quantity::pin_radial:
      return out.pin_radial_N[place.pin];
    case Quantity::pin_tangential:
      return out.pin_tangential_N[place.pin];
  }
  return Real{0};
}

}  // namespace crankloop::program
