// An engine that breathes over speed and throttle: each point run until it has settled, on all processors.
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
  [[nodiscard]] double step() const noexcept { return count > 1 ? (to - from) / (count - 1) : 1; }
};

struct MapRequest {
  Grid speed_rpm;
  Grid throttle_ratio;
  GasOrder gas;  ///< all but the throttle
  double tick_s = 100e-6;
};

struct MapPoint {
  double speed_rpm = 0;
  double throttle_ratio = 0;
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
  std::vector<MapPoint> points{};  ///< speed by speed, each with all throttles
};

/// All points, on as many threads as there are processors; the same whatever their number. `after_point` is called
/// after each, by one thread at a time. Throws what a run throws, as a speed beyond one revolution per tick.
void run_map(EngineMap& map, const std::function<void()>& after_point);

/// How a result is named, in CSV and drawings.
struct MapColumn {
  const char* name;
  const char* title;  ///< of the drawing; nullptr: not drawn
  const char* unit;
  double (*value)(const MapPoint&);
};
inline constexpr std::size_t kMapColumns = 14;
extern const MapColumn kMapColumnList[kMapColumns];

[[nodiscard]] report::Page map_page(const EngineMap& map);

}  // namespace crankloop::program
