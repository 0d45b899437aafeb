// Estimated masses for a first design: [KShM table 2.1].
#pragma once

#include <cstdint>

namespace crankloop {

enum class EngineKind : std::uint8_t { spark_ignition, diesel, tractor_diesel };

struct Interval {
  double least;
  double most;
};

/// Usual values; masses of one cylinder. The rod's mass is for an inline engine.
struct FirstDesign {
  Interval piston_kg;  ///< piston group
  Interval rod_kg;
  Interval pin_share_inline;  ///< l_crank / l, the part of the rod's mass that goes to the piston pin
  Interval pin_share_v;       ///< the same in a V engine
};

/// m' = m / A in kg/m^2 is proportional to the bore in mm; the factor depends on kind and rated speed. Spark-ignition
/// engines have another row from 4500 rpm on, car and truck diesels from 3000 rpm on; tractor diesels have one row.
/// bore > 0.
[[nodiscard]] FirstDesign first_design(EngineKind kind, double bore_m, double speed_rpm) noexcept;

}  // namespace crankloop
