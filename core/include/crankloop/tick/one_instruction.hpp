// What a tick uses of <cmath>: functions that are one instruction each, with the same bits everywhere.
#pragma once

namespace crankloop {

/// sqrt: IEEE has it correctly rounded.
[[nodiscard]] inline float square_root(float x) noexcept { return __builtin_sqrtf(x); }
[[nodiscard]] inline double square_root(double x) noexcept { return __builtin_sqrt(x); }

/// |x|
[[nodiscard]] constexpr float magnitude(float x) noexcept { return __builtin_fabsf(x); }
[[nodiscard]] constexpr double magnitude(double x) noexcept { return __builtin_fabs(x); }

}  // namespace crankloop
