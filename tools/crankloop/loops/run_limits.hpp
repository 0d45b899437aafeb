// Limits of a run: one revolution per tick, the engine's maximum speed, number of ticks.
#pragma once

#include <string>

#include <crankloop/define/crank.hpp>

namespace crankloop::program {

/// Maximum number of ticks of a run: some minutes for four cylinders.
inline constexpr double kMaxTicks = 1e9;

/// Of any engine.
inline constexpr double kShortestTick_s = 1e-6;

/// Fraction of a tick: a cycle's end that is closer than this is not worth another tick, because the phase increment is
/// rounded.
inline constexpr double kHairOfATick = 1e-3;

/// Throws UsageError for more ticks than that; `remedy` names another remedy: "fewer --cycles".
void require_ticks(double ticks, double tick_s, const std::string& remedy);

/// Throws UsageError for a speed, in either sense, beyond the limit of the tables that were made for this tick.
void require_speed(double speed_rpm, double limit_rad_s, double tick_s, const Crank& crank);

}  // namespace crankloop::program
