// The few bounds that every room knows.
#pragma once

namespace crankloop {

inline constexpr int kMaxCylinders = 16;

}  // namespace crankloop
