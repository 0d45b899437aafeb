// The sheet of `crankloop lift --plot`: theoretical lift and its derivatives over the cam angle.
//
// What belongs here: which curves and markers. What does not: the lift (tabulate/valve_lift.hpp), drawing (report/).
#pragma once

#include <optional>

#include <crankloop/tabulate/valve_lift.hpp>

#include "../../files/units.hpp"
#include "../../loops/flow_area.hpp"
#include "../../report/sheet.hpp"

namespace crankloop::program {

struct ShownLift {
  const ValveLift& lift;
  const std::optional<FlowArea>& area;  ///< none: without its panel
  std::optional<double> speed_rpm{};    ///< of the engine: velocity and the like then per second

  [[nodiscard]] double cam_rad_s() const { return speed_rpm.value_or(0) * kRad_sPerRpm / 2; }
};

/// The train's lift, velocity, acceleration and jerk, rocker ratio and flow area. Title and remarks are the caller's.
[[nodiscard]] report::Sheet lift_sheet(const ShownLift& shown);

}  // namespace crankloop::program
