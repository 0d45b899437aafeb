// Stress of the contact of cam and follower, by Hertz: docs/model.md "Cam contact".
//
// What belongs here: a line of contact under a force, in double. What does not: where cam and follower touch
// (valve_lift.hpp), the force (tick/valve).
#pragma once

#include <crankloop/define/cam_contact.hpp>

namespace crankloop {

/// E*, 1/E* = (1 - nu1^2) / E1 + (1 - nu2^2) / E2.
[[nodiscard]] double contact_modulus_Pa(const CamContact& contact) noexcept;

/// A line of contact.
struct HertzContact {
  double largest_Pa;    ///< p_max, in its middle
  double half_width_m;  ///< a; pi/2 p_max a b is the force
};

/// Of a normal force, 0 or more, and a reduced curvature 1/R above 0, for a width above 0 [Johnson 1985, 4.42 to 4.45].
[[nodiscard]] HertzContact hertz_contact(const CamContact& contact, double curvature_per_m, double force_N) noexcept;

}  // namespace crankloop
