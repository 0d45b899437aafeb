// What no run may request: more than a revolution per tick, a speed the engine cannot have, too many ticks to wait for.
#pragma once

#include <string>

#include <crankloop/define/crank.hpp>

namespace crankloop::program {

/// Most ticks of a run: some minutes for four cylinders.
inline constexpr double kMaxTicks = 1e9;

/// Throws UsageError for more ticks than that; `remedy` states what else would help: "fewer --cycles".
void require_ticks(double ticks, double tick_s, const std::string& remedy);

/// Throws UsageError for a speed, in either sense, beyond the limit of the tables that were made for this tick.
void require_speed(double speed_rpm, double limit_rad_s, double tick_s, const Crank& crank);

}  // namespace crankloop::program
