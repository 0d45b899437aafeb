// The few bounds that every room knows.
#pragma once

namespace crankloop {

inline constexpr int kMaxCylinders = 16;
inline constexpr int kMaxTrains = 4;  ///< valve trains of a cylinder: intake, exhaust, and two more
inline constexpr int kMaxTriggerWheels = 8;
inline constexpr int kMaxTriggerEdges = 720;  ///< of one wheel in a turn of it

}  // namespace crankloop
