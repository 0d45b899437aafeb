// Head, seat, port and stem of a valve of the engine file: what its flow area depends on.
//
// What belongs here: the dimensions, given or assumed. What does not: areas (loops/flow_area.hpp), and the flow curve
// of the gas (PortOfTrain).
#pragma once

#include <optional>
#include <string>

#include "engine_file_values.hpp"

namespace crankloop::program {

/// In Heywood's symbols: docs/model.md "Flow area".
struct PortGeometry {
  double head_m = 0;          ///< D_v, outer diameter of the seat
  double seat_m = 0;          ///< D, inner diameter of the seat
  double seat_width_m = 0;    ///< s, outer less inner radius
  double seat_angle_deg = 0;  ///< beta, from the plane of the head
  double port_m = 0;          ///< D_p
  double stem_m = 0;          ///< D_s
  std::string assumed{};      ///< "seat_width_mm = 1.2, ...": what neither is given nor follows from what is; "": none
};

/// Usual proportions, of the seat's inner diameter D: docs/model.md "Flow area".
inline constexpr double kUsualSeatWidth = 0.04;
inline constexpr double kUsualSeatAngle_deg = 45;
inline constexpr double kUsualPort = 1;
inline constexpr double kUsualStem = 0.2;

/// Of a [valve NAME]; none without seat_diameter_mm and head_diameter_mm. Throws InputError for dimensions that
/// contradict each other.
[[nodiscard]] std::optional<PortGeometry> build_port_geometry(const SectionValues& valve, const std::string& path);

}  // namespace crankloop::program
