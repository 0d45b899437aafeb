// An engine with gas exchange over speed and throttle: each point run until it has settled, on all processors.
//
// What belongs here: the points and their run. What does not: words, files (map.cpp), drawing (map_report.cpp).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "../../engine_file/engine_file.hpp"
#include "../../engine_file/gas_order.hpp"
#include "../../loops/run_gas.hpp"
#include "../../report/page.hpp"

namespace crankloop::program {

/// `count` numbers from `from` to `to`, evenly spaced.
struct Grid {
  double from = 0;
  double to = 0;
  int count = 1;

  [[nodiscard]] double at(int i) const noexcept { return count > 1 ? from + (to - from) * i / (count - 1) : from; }
};

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
};

struct MapPoint {
  double speed_rpm = 0;
  double load = 0;             ///< throttle or fuel, in its axis's unit
  double torque_Nm = 0;        ///< indicated, all cylinders
  double brake_torque_Nm = 0;  ///< less the file's [friction]
  double power_W = 0;          ///< of the brake torque
  GasFigures gas;
  double faulty_ticks = 0;
  std::uint32_t faults = 0;  ///< all fault bits that occurred
};

struct EngineMap {
  const EngineFile& file;
  MapRequest request;
  std::string command_line;
  std::vector<MapPoint> points{};  ///< speed by speed, each with all throttles or all fuels

  /// "at 3000 rpm, throttle 0.5"
  [[nodiscard]] std::string place_of(const MapPoint& point) const;
};

/// All points, on one thread per processor; results do not depend on their number. `after_point` is called after each,
/// by one thread at a time. Throws what a run throws, as a speed beyond one revolution per tick.
void run_map(EngineMap& map, const std::function<void()>& after_point);

/// How a result is named, in CSV and drawings.
struct MapColumn {
  const char* name;
  const char* title;  ///< of the drawing; nullptr: not drawn
  const char* unit;
  double (*value)(const MapPoint&);
  bool is_share = false;  ///< pages show it in per cent
};
inline constexpr std::size_t kMapColumns = 15;
extern const MapColumn kMapColumnList[kMapColumns];

[[nodiscard]] report::Page map_page(const EngineMap& map);

}  // namespace crankloop::program
