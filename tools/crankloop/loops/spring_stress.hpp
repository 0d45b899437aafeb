// What the wire of a helical valve spring makes of it: its rate, its mass, the shear stress under a force.
// docs/model.md "Spring stress".
#pragma once

#include "../engine_file/spring_wire.hpp"

namespace crankloop::program {

/// G d^4 / (8 D^3 n).
[[nodiscard]] double rate_of_wire_N_m(const SpringWire& wire) noexcept;

/// Of the active coils, of steel of 7850 kg/m^3: its length pi D n times its area.
[[nodiscard]] double mass_of_wire_kg(const SpringWire& wire) noexcept;

/// Largest shear stress in the wire under a force along the spring's axis, by Wahl: 8 F D K_W / (pi d^3) with
/// K_W = (4 C - 1) / (4 C - 4) + 0.615 / C, C = D / d.
[[nodiscard]] double shear_stress_Pa(const SpringWire& wire, double force_N) noexcept;

/// By how much the stress may be larger before Goodman's line: 1 / (amplitude / endurance + mean / ultimate). The wire
/// must have limits; `least_Pa` counts as 0 where it is below, for a spring only pushes.
[[nodiscard]] double goodman_factor(const SpringWire& wire, double least_Pa, double largest_Pa) noexcept;

}  // namespace crankloop::program
