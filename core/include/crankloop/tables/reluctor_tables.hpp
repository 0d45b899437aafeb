// The table of a variable reluctance sensor, filled at set-up.
//
// What belongs here: the voltage by the wheel's angle. What does not: how it comes about (tabulate/reluctor_table.cpp),
// the step (tick/trigger/reluctor.hpp).
#pragma once

#include <cstdint>

namespace crankloop::detail {

/// Equal parts of a wheel's turn, at most: as many whole ones for each place of the wheel as there is room for.
inline constexpr int kReluctorCells = 4096;

/// Voltage by crank speed in a cell: c[0] + u (c[1] + u c[2]), the derivative of the cubic flux through both ends, so
/// that the integral over a turn is 0.
template <class Real>
struct ReluctorCell {
  Real c[3];
};

/// A sensor and its comparator.
template <class Real>
struct ReluctorTable {
  std::uint64_t starts;    ///< engine phase of the centre of the wheel's first tooth, where the first cell begins
  std::uint32_t on_crank;  ///< as of TriggerTrack
  std::uint32_t in_use;    ///< 0: the engine has no sensor
  std::uint32_t watchdog_ticks;
  std::uint32_t cells;  ///< in use
  Real arm_ratio;
  Real least_V;
  Real hysteresis_V;
  Real delay_s;  ///< of the comparator's edges, at most a tick
  ReluctorCell<Real> at[kReluctorCells];
};

}  // namespace crankloop::detail
