// Heat from the gas of a cylinder to its walls. docs/model.md "Gas".
//
//     q_w = C p^0.8 T^-0.4 (2 A_p + 4 V / bore) (T - T_wall),   C = 130 k_w (v_m + 1.4)^0.8 V_m^-0.06 1e-4 Hohenberg,
//     SAE 790825
//
// p in Pa, v_m the mean piston speed, V_m half the swept volume (the exponent 0.06 is not worth a table). All that
// changes is one power: p^0.8 T^-0.4 (v_m + 1.4)^0.8 = ((p (v_m + 1.4))^2 / T)^0.4.
#pragma once

#include <cstdint>
#include <cstring>

#include <crankloop/tables/gas_tables.hpp>
#include <crankloop/tick/gas/gas_properties.hpp>
#include <crankloop/tick/lanes.hpp>

namespace crankloop::detail {

inline constexpr int kOctavesOfPower = 80;  ///< 1 to 2^80: (1e8 Pa 40 m/s)^2 / 100 K is 2^77

/// 2^(0.4 n)
template <class Real>
struct OctavePowers {
  Real of[kOctavesOfPower]{};

  constexpr OctavePowers() noexcept {
    constexpr double kFirst[5] = {1, 1.3195079107728943, 1.7411011265922483, 2.29739670999407, 3.0314331330207962};
    double fours = 1;
    for (int n = 0; n < kOctavesOfPower; n += 5, fours *= 4) {
      for (int i = 0; i < 5; ++i) of[n + i] = static_cast<Real>(kFirst[i] * fours);
    }
  }
};
template <class Real>
inline constexpr OctavePowers<Real> kOctavePowers{};

/// Of each octave, its power.
template <class T>
[[nodiscard, gnu::always_inline]] inline T powers_of(const BitsOf<T>& octave) noexcept {
  constexpr const OctavePowers<NumberOf<T>>& power = kOctavePowers<NumberOf<T>>;
  if constexpr (kLanesIn<T> == 1) {
    return power.of[octave];
  } else {
    return T{power.of[octave[0]], power.of[octave[1]], power.of[octave[2]], power.of[octave[3]]};
  }
}

/// u^0.4 to 1.4e-5 for 1 <= u < 2^80, beyond as there: its exponent by a table, its fraction 1 <= f < 2 by a polynomial
/// (through the five Chebyshev nodes).
template <class T>
[[nodiscard, gnu::always_inline]] inline T power_two_fifths(T u) noexcept {
  using Real = NumberOf<T>;
  using Bit = BitsOf<Real>;
  constexpr int kFractionBits = sizeof(Real) == 4 ? 23 : 52;
  constexpr Bit kBias = sizeof(Real) == 4 ? 127 : 1023;
  constexpr Real kMax = static_cast<Real>(0x1.fffffep79);
  const T least = T{} + Real{1}, most = T{} + kMax;
  u = u > least ? u : least;  // what is not a number: 1
  u = u < most ? u : most;
  BitsOf<T> bits;
  std::memcpy(&bits, &u, sizeof bits);
  const T octave = powers_of<T>((bits >> kFractionBits) - kBias);
  bits = (bits & ((Bit{1} << kFractionBits) - 1)) | kBias << kFractionBits;
  T f;
  std::memcpy(&f, &bits, sizeof f);
  const auto c = [](double x) { return static_cast<Real>(x); };
  return octave *
         (c(0.431286349) + f * (c(0.803846834) + f * (c(-0.311297372) + f * (c(0.086641469) + f * c(-0.010463891)))));
}

/// (v_m + 1.4 m/s)
template <class Real>
[[nodiscard]] inline Real stirring_m_s(const GasWalls<Real>& walls, Real speed_rad_s) noexcept {
  return magnitude(speed_rad_s) * walls.piston_m + static_cast<Real>(1.4);
}

template <class T>
[[nodiscard, gnu::always_inline]] inline T wall_heat_W(const GasWalls<NumberOf<T>>& walls, const GasPoint<T>& gas,
                                                       const T& volume_m3, NumberOf<T> stirring_m_s) noexcept {
  const T stirred = gas.pressure_Pa * stirring_m_s;
  const T power = power_two_fifths<T>(stirred * stirred / gas.temperature_K);
  return walls.heat_factor * power *
         ((walls.area_m2 + walls.area_per_m3 * volume_m3) * (gas.temperature_K - walls.temperature_K));
}

}  // namespace crankloop::detail
