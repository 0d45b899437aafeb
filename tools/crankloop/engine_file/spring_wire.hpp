// The wire of a valve spring of the engine file: what its stress depends on.
//
// What belongs here: the dimensions, given or assumed. What does not: rate, mass and stress (loops/spring_stress.hpp).
#pragma once

#include <optional>
#include <string>

#include "engine_file_values.hpp"

namespace crankloop::program {

/// A helical compression spring of round wire.
struct SpringWire {
  double wire_m = 0;        ///< d, diameter
  double coil_m = 0;        ///< D, mean diameter of the coils
  double active_coils = 0;  ///< n
  double shear_Pa = 0;      ///< G
  bool shear_assumed = false;
  double endurance_Pa = 0;  ///< largest amplitude of shear stress about zero that it bears for ever; 0: not known
  double ultimate_Pa = 0;   ///< shear stress at which it breaks; 0: not known

  [[nodiscard]] bool has_limits() const noexcept { return endurance_Pa > 0 && ultimate_Pa > 0; }
};

/// Of spring steel, where the file gives none.
inline constexpr double kUsualShear_Pa = 79e9;
/// The coils of a smaller ratio D / d would touch their axis.
inline constexpr double kLeastCoilIndex = 2;

/// Of a [valve NAME]; none without wire_mm. Throws InputError for keys that lack or contradict each other, and for two
/// nested springs, whose forces the file does not tell apart.
[[nodiscard]] std::optional<SpringWire> build_spring_wire(const SectionValues& valve, const std::string& path);

}  // namespace crankloop::program
