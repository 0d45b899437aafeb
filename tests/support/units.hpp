// Pi and what follows from it, for all tests; the library has its own, and so have the tools.
#pragma once

namespace crankloop::support {

inline constexpr long double kWidePi = 3.141592653589793238462643383279502884L;
inline constexpr double kPi = static_cast<double>(kWidePi);
inline constexpr double kRadPerDeg = kPi / 180;

}  // namespace crankloop::support
