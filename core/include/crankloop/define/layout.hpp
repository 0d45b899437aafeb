// How cylinders stand around and along the crankshaft, and when they fire.
//
// What belongs here: angles and positions. What does not: what follows from them at a speed (tabulate/summary.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <crankloop/define/field.hpp>
#include <crankloop/limits.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

/// Places of the cylinders. Cylinder 1 is index 0. Angles in degrees, as they are given and kept exact: 120 deg has no
/// exact radian.
///
/// Engine angle A is 0 at cylinder 1's firing top dead centre when firing_deg[0] = 0; cylinder k's own crank angle is A
/// - firing_deg[k].
struct Layout {
  int cylinders = 1;
  std::array<double, kMaxCylinders> firing_deg{};  ///< engine angle at which the cylinder's own angle is 0
  std::array<double, kMaxCylinders> bank_deg{};  ///< cylinder axis from the vertical, positive in the sense of rotation
  std::array<double, kMaxCylinders> position_m{};  ///< along the crankshaft
  std::array<std::uint8_t, kMaxCylinders> pin{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  ///< which crank pin carries the rod, numbered from 0 without gaps along the shaft; equal numbers share a pin

  /// Direction of the cylinder's throw at A = 0, in degrees from the vertical: bank - firing.
  [[nodiscard]] double throw_deg(int cylinder) const noexcept {
    return bank_deg[static_cast<std::size_t>(cylinder)] - firing_deg[static_cast<std::size_t>(cylinder)];
  }

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    CRANKLOOP_NUMBER(1, layout, cylinders, from(1).up_to(kMaxCylinders));
    CRANKLOOP_NUMBER(self.cylinders, layout, firing_deg, from(0).below(720));
    CRANKLOOP_NUMBER(self.cylinders, layout, bank_deg, from(-360).up_to(360));
    CRANKLOOP_NUMBER(self.cylinders, layout, position_m, from(-100).up_to(100));
    CRANKLOOP_FIELD(self.cylinders, layout, pin);
  }
};

/// Sets firing_deg for even firing over 720 deg in the given order (cylinder numbers from 1); order has `cylinders`
/// entries.
Status set_firing_order(const int* order, int cylinders, Layout& layout) noexcept;

/// Numbers the pins along the shaft: cylinders at one position whose throws point the same way share a pin.
void share_pins_by_position(Layout& layout) noexcept;

/// Field names "layout.*". Cylinders that share a pin must have the same throw direction (within 1e-6 deg).
Status validate(const Layout& layout) noexcept;

}  // namespace crankloop
