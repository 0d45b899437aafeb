// An engine with gas exchange over speed and throttle: each point run until it has settled, on all processors.
//
// What belongs here: the points and their run. What does not: words, files (map.cpp), drawing (map_report.cpp).
#pragma once

#include <string>
#include <vector>

#include "../../command_line/grid.hpp"
#include "../../engine_file/engine_file.hpp"
#include "../../engine_file/gas_order.hpp"
#include "../../loops/run_gas.hpp"
#include "../../report/page.hpp"

namespace crankloop::program {

/// The quantity that a map varies besides the speed.
struct MapAxis {
  const char* column;     ///< of the CSV file, as in its header
  const char* word;       ///< "throttle"
  const char* positions;  ///< what a value is: "throttle position"
  const char* title;
  const char* unit;  ///< of its numbers
  double GasOrder::*varied;
  double per_si;
};
inline constexpr MapAxis kThrottleAxis{
    "throttle", "throttle", "throttle position", "Throttle", "", &GasOrder::throttle_ratio, 1};
inline constexpr MapAxis kFuelAxis{"fuel_mg",          "fuel", "fuel setting", "Fuel of a cylinder's cycle", "mg",
                                   &GasOrder::fuel_kg, 1e6};

struct MapRequest {
  Grid speed_rpm;
  const MapAxis* axis = &kThrottleAxis;
  Grid load;     ///< in the axis's unit
  GasOrder gas;  ///< all that is not varied
  double tick_s = 100e-6;
  bool best_spark = false;  ///< each point at its burn start of best torque, not at that of `gas`
};

/// Its results, in the order of the columns.
enum class MapResult : std::uint8_t {
  torque,  ///< indicated, all cylinders
  brake_torque,
  brake_power,
  net_mep,
  pumping_mep,
  trapped_air,
  volumetric_efficiency,
  fuel_burned,
  residual,
  excess_air,
  exhaust_temperature,
  exhaust_manifold_temperature,
  intake_pressure,
  peak_pressure,
  specific_consumption,  ///< brake; 0 without power, as the next
  brake_efficiency,
  burn_start,
  knock_integral,
  faulty_ticks,
};
inline constexpr std::size_t kMapResults = 19;

struct MapPoint {
  double speed_rpm = 0;
  double load = 0;  ///< throttle or fuel, in its axis's unit
  double results[kMapResults] = {};
  std::uint32_t faults = 0;  ///< all fault bits that occurred

  [[nodiscard]] double at(MapResult result) const noexcept { return results[static_cast<std::size_t>(result)]; }
};

struct EngineMap {
  const EngineFile& file;
  MapRequest request;
  std::string command_line;
  std::vector<MapPoint> points{};  ///< speed by speed, each with all throttles or all fuels

  /// "at 3000 rpm, throttle 0.5"
  [[nodiscard]] std::string place_of(const MapPoint& point) const;
  /// What a real engine would do otherwise in some points, a sentence each: it misfires, it knocks.
  [[nodiscard]] std::vector<std::string> doubts() const;
  /// The first point with the largest value.
  [[nodiscard]] const MapPoint& largest(MapResult result) const;
};

/// Burn starts among which the one of best torque is found, and how well.
inline constexpr Range kBestStart_deg = from(-60).up_to(20);
inline constexpr double kBestStartWithin_deg = 0.5;

/// One point, counted speed by speed, as text for a part of the map; may be called by several threads at once. Throws
/// what a run throws, as a speed beyond one revolution per tick.
[[nodiscard]] std::string run_point(const EngineDefinition& definition, const MapRequest& request, int point);

/// The points of these texts.
[[nodiscard]] std::vector<MapPoint> points_of(const MapRequest& request, const std::vector<std::string>& texts);

/// How a result is named, in CSV and drawings.
struct MapColumn {
  const char* name;
  const char* title;  ///< of the drawing; nullptr: not drawn
  const char* unit;
  MapResult result;
  bool is_share = false;  ///< pages show it in per cent

  [[nodiscard]] double value(const MapPoint& point) const noexcept { return point.at(result); }
};
extern const MapColumn kMapColumnList[kMapResults];

[[nodiscard]] report::Page map_page(const EngineMap& map);

}  // namespace crankloop::program
