#include "spring_stress.hpp"

#include "../files/units.hpp"

namespace crankloop::program {
namespace {

constexpr double kSteel_kg_m3 = 7850;

}  // namespace

double rate_of_wire_N_m(const SpringWire& wire) noexcept {
  const double d2 = wire.wire_m * wire.wire_m;
  return wire.shear_Pa * d2 * d2 / (8 * wire.coil_m * wire.coil_m * wire.coil_m * wire.active_coils);
}

double mass_of_wire_kg(const SpringWire& wire) noexcept {
  return kSteel_kg_m3 * (kPi / 4 * wire.wire_m * wire.wire_m) * (kPi * wire.coil_m * wire.active_coils);
}

double shear_stress_Pa(const SpringWire& wire, double force_N) noexcept {
  const double index = wire.coil_m / wire.wire_m;
  const double wahl = (4 * index - 1) / (4 * index - 4) + 0.615 / index;
  return 8 * force_N * wire.coil_m * wahl / (kPi * wire.wire_m * wire.wire_m * wire.wire_m);
}

double goodman_factor(const SpringWire& wire, double least_Pa, double largest_Pa) noexcept {
  const double low_Pa = least_Pa > 0 ? least_Pa : 0;
  const double amplitude_Pa = (largest_Pa - low_Pa) / 2;
  const double mean_Pa = (largest_Pa + low_Pa) / 2;
  return 1 / (amplitude_Pa / wire.endurance_Pa + mean_Pa / wire.ultimate_Pa);
}

}  // namespace crankloop::program
