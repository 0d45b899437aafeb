// Factors between units, and pi, for the program and its laboratories. Tests have their own (tests/support/units.hpp),
// so has core.
#pragma once

namespace crankloop::program {

inline constexpr long double kWidePi = 3.141592653589793238462643383279502884L;
inline constexpr double kPi = static_cast<double>(kWidePi);
inline constexpr double kRadPerDeg = kPi / 180;
inline constexpr double kDegPerRad = 180 / kPi;
inline constexpr double kRad_sPerRpm = kPi / 30;
inline constexpr double kRpmPerRad_s = 30 / kPi;
inline constexpr double kTurnsPerRad = 1 / (2 * kPi);
inline constexpr double kCycle_rad = 4 * kPi;
inline constexpr double kZeroCelsius_K = 273.15;
inline constexpr double kKilo = 1e-3;  ///< how many of a thousand times the unit: kPa of a Pa
inline constexpr double kMilli = 1e3;
inline constexpr double kMicro = 1e6;
inline constexpr double kDegPerUnit = 720 / 0x1p64;  ///< of a phase, whose 2^64 units are a cycle

}  // namespace crankloop::program
