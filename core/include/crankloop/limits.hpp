// The few bounds that every room knows.
#pragma once

namespace crankloop {

inline constexpr int kMaxCylinders = 16;
inline constexpr int kMaxTrains = 4;  ///< valve trains of a cylinder: intake, exhaust, and two more

}  // namespace crankloop
