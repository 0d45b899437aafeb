// The quantities of one cylinder that `run` shows: name, unit, and member of a step's output.
//
// What belongs here: the list, once, for CSV columns, peaks, plots and the comparison with the exact engine. What does
// not: their use.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include <crankloop/scenes.hpp>

#include "../files/units.hpp"

namespace crankloop::program {

/// Whole, or Breathing: all that `run` shows is in both.
template <class Real, class S = scenes::Whole>
using WholeOutput = crankloop::Output<Real, S>;

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

[[nodiscard]] constexpr std::size_t index_of(Quantity quantity) noexcept { return static_cast<std::size_t>(quantity); }
inline constexpr std::size_t kCsvQuantities = index_of(Quantity::rod_angle);

/// Output format of a quantity: value in SI times `per_si`; `suffix` is the unit in CSV names.
template <class Quantity>
struct KindOf {
  Quantity quantity;
  const char* name;
  const char* suffix;
  const char* unit;
  double per_si;
};
using QuantityKind = KindOf<Quantity>;

inline constexpr QuantityKind kQuantityKinds[] = {
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
inline constexpr std::size_t kQuantities = std::size(kQuantityKinds);

template <class Kinds>
[[nodiscard]] constexpr bool in_order(const Kinds& kinds) noexcept {
  std::size_t i = 0;
  for (const auto& kind : kinds) {
    if (index_of(kind.quantity) != i++) return false;
  }
  return true;
}
static_assert(in_order(kQuantityKinds), "each Quantity has its row, in the order of the enumeration");

template <class Real>
using QuantityValues = std::array<Real, kQuantities>;

/// In SI, in the order of Quantity. Crank pin values are those of the whole pin, with all its rods.
template <class Real, class S>
[[nodiscard]] QuantityValues<Real> values_of(const crankloop::Output<Real, S>& out, const Layout& layout,
                                             std::size_t cylinder) noexcept {
  const std::size_t k = cylinder;
  const std::size_t pin = layout.pin[k];
  const CylinderForces<Real>& f = out.cylinder[k];
  const Real values[] = {f.pressure_Pa,
                         out.displacement_m[k],
                         out.velocity_m_s[k],
                         out.acceleration_m_s2[k],
                         f.gas_force_N,
                         f.inertia_force_N,
                         f.total_force_N,
                         f.side_force_N,
                         f.rod_force_N,
                         f.radial_force_N,
                         f.tangential_force_N,
                         f.torque_Nm,
                         f.tilting_moment_Nm,
                         out.pin_load_N[pin],
                         out.rod_angle_rad[k],
                         out.rod_speed_rad_s[k],
                         out.rod_acceleration_rad_s2[k],
                         out.pin_radial_N[pin],
                         out.pin_tangential_N[pin]};
  static_assert(std::size(values) == kQuantities, "each Quantity has its value, in the order of the enumeration");
  QuantityValues<Real> all;
  std::copy(std::begin(values), std::end(values), all.begin());
  return all;
}

}  // namespace crankloop::program
