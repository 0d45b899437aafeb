// Fault bits of a step: what was wrong with the input, and what the engine did about it.
#pragma once

#include <cstdint>

namespace crankloop {

/// Or-ed into Output::faults for the tick in which it happened; 0 = all well. The output is defined and finite whatever the bits.
enum Fault : std::uint32_t {
  kFaultNotReady = 1u << 0,       ///< no tables, or init refused them: outputs are zero
  kFaultSpeed = 1u << 1,          ///< speed not finite or beyond the limit: the last good one was used
  kFaultLoadRatio = 1u << 2,      ///< load ratio not finite or outside 0 to 2: the last good one was used
  kFaultPressure = 1u << 3,       ///< a pressure not finite or outside 0 to 1e8 Pa: that cylinder's last good one was used
  kFaultPhaseJump = 1u << 4,      ///< the measured phase jumped further than the speed limit allows: the speed is the last good one, the mean
                                ///< torque that at the tick
  kFaultCamPhase = 1u << 5,       ///< a cam phase target not finite or outside -180 to 180 deg: the last good one was used
  kFaultEventBudget = 1u << 6,    ///< more contact changes in a tick than are located: the rest is taken at the end of a fine step
  kFaultLoad = 1u << 7,           ///< load torque not finite or outside +-1e8 Nm: the last good one was used
  kFaultOverspeed = 1u << 8,      ///< the forces would turn the crank faster than the speed limit: it was held there
  kFaultTriggerEdges = 1u << 9,   ///< more edges of a trigger wheel in a tick than the scene has room for: the first are listed, all are counted
};

/// Those that an input causes: the scene's bad_input_count counts ticks with any of them.
inline constexpr std::uint32_t kInputFaults = kFaultSpeed | kFaultLoadRatio | kFaultPressure | kFaultPhaseJump | kFaultCamPhase | kFaultLoad;

}  // namespace crankloop
