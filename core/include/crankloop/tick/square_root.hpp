// The one function of <cmath> that a tick uses.
#pragma once

namespace crankloop {

/// sqrt as the one instruction it is (IEEE: correctly rounded, so the same bits everywhere).
[[nodiscard]] inline float square_root(float x) noexcept { return __builtin_sqrtf(x); }
[[nodiscard]] inline double square_root(double x) noexcept { return __builtin_sqrt(x); }

}  // namespace crankloop
