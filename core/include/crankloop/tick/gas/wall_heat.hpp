// Heat from the gas of a cylinder to its walls. docs/model.md "Gas".
//
//     q_w = C V^-0.06 p^0.8 T^-0.4 (2 A_p + 4 V / bore) (T - T_wall),   C = 130 k_w (v_m + 1.4)^0.8 1e-4
//     Hohenberg, SAE 790825
//
// p in Pa, v_m the mean piston speed. Two powers: V^-0.06, and p^0.8 T^-0.4 (v_m + 1.4)^0.8 = ((p (v_m +
// 1.4))^2 / T)^0.4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include <crankloop/tables/gas_tables.hpp>
#include <crankloop/tick/gas/gas_properties.hpp>
#include <crankloop/tick/lanes.hpp>

namespace crankloop::detail {

/// Of octaves 2^n, one after the other.
template <class Real, int kCount>
struct OctavePowers {
  Real of[static_cast<std::size_t>(kCount)]{};
};

/// 2^(0.4 n): 1 to 2^80, (1e8 Pa 40 m/s)^2 / 100 K is 2^77
template <class Real>
[[nodiscard]] constexpr OctavePowers<Real, 80> make_two_fifths() noexcept {
  constexpr double kFirst[5] = {1, 1.3195079107728943, 1.7411011265922483, 2.29739670999407, 3.0314331330207962};
  OctavePowers<Real, 80> power;
  double fours = 1;
  for (int n = 0; n < 80; n += 5, fours *= 4) {
    for (int i = 0; i < 5; ++i) power.of[n + i] = static_cast<Real>(kFirst[i] * fours);
  }
  return power;
}
template <class Real>
inline constexpr OctavePowers<Real, 80> kTwoFifths = make_two_fifths<Real>();

/// 2^(-0.06 n): of volumes from 2^-40 to 2^8 m^3
template <class Real>
[[nodiscard]] constexpr OctavePowers<Real, 48> make_volume_powers() noexcept {
  OctavePowers<Real, 48> power;
  double at = 5.278031643091577;  // 2^(0.06 * 40)
  for (Real& x : power.of) x = static_cast<Real>(at), at *= 0.9592641193252643;
  return power;
}
template <class Real>
inline constexpr OctavePowers<Real, 48> kVolumePowers = make_volume_powers<Real>();

/// A number 2^n f, 1 <= f < 2, its octave n counted from `first`. Beyond `least` and `most` as there.
template <class T>
struct InOctaves {
  using Real = NumberOf<T>;

  T fraction;
  T power;  ///< of its octave

  template <int kCount>
  [[nodiscard, gnu::always_inline]] static InOctaves of(T u, Real least, Real most, int first,
                                                        const OctavePowers<Real, kCount>& powers) noexcept {
    using Bit = BitsOf<Real>;
    constexpr int kFractionBits = sizeof(Real) == 4 ? 23 : 52;
    constexpr Bit kBias = sizeof(Real) == 4 ? 127 : 1023;
    u = u > least ? u : spread<T>(least);  // what is not a number: least
    u = u < most ? u : spread<T>(most);
    BitsOf<T> bits;
    std::memcpy(&bits, &u, sizeof bits);
    const BitsOf<T> octave = (bits >> kFractionBits) - (kBias + static_cast<Bit>(first));
    InOctaves answer;
    if constexpr (kLanesIn<T> == 1) {
      answer.power = powers.of[octave];
    } else {
      answer.power = T{powers.of[octave[0]], powers.of[octave[1]], powers.of[octave[2]], powers.of[octave[3]]};
    }
    bits = (bits & ((Bit{1} << kFractionBits) - 1)) | kBias << kFractionBits;
    std::memcpy(&answer.fraction, &bits, sizeof bits);
    return answer;
  }
};

/// u^0.4 to 1.4e-5 for 1 <= u < 2^80, beyond as there: its exponent by a table, its fraction 1 <= f < 2 by a polynomial
/// (through the five Chebyshev nodes).
template <class T>
[[nodiscard, gnu::always_inline]] inline T power_two_fifths(const T& u) noexcept {
  using Real = NumberOf<T>;
  const auto c = [](double x) { return static_cast<Real>(x); };
  const InOctaves<T> in = InOctaves<T>::of(u, Real{1}, c(0x1.fffffep79), 0, kTwoFifths<Real>);
  const T& f = in.fraction;
  return in.power *
         (c(0.431286349) + f * (c(0.803846834) + f * (c(-0.311297372) + f * (c(0.086641469) + f * c(-0.010463891)))));
}

/// V^-0.06 to 4e-5 for 2^-40 <= V < 2^8 m^3, in the same way (four nodes).
template <class T>
[[nodiscard, gnu::always_inline]] inline T volume_power(const T& volume_m3) noexcept {
  using Real = NumberOf<T>;
  const auto c = [](double x) { return static_cast<Real>(x); };
  const InOctaves<T> in = InOctaves<T>::of(volume_m3, c(0x1p-40), c(0x1.fffffep7), -40, kVolumePowers<Real>);
  const T& f = in.fraction;
  return in.power * (c(1.090346405) + f * (c(-0.1287835385) + f * (c(0.0451832565) + f * c(-0.0067837096))));
}

/// (v_m + 1.4 m/s)
template <class Real>
[[nodiscard]] inline Real stirring_m_s(const GasWalls<Real>& walls, Real speed_rad_s) noexcept {
  return magnitude(speed_rad_s) * walls.piston_m + static_cast<Real>(1.4);
}

/// `walls`: GasWalls, or WarmWalls of T.
template <class T, class Walls>
[[nodiscard, gnu::always_inline]] inline T wall_heat_W(const Walls& walls, const GasPoint<T>& gas, const T& volume_m3,
                                                       NumberOf<T> stirring_m_s) noexcept {
  const T stirred = gas.pressure_Pa * stirring_m_s;
  const T power = power_two_fifths<T>(stirred * stirred / gas.temperature_K);
  return walls.heat_factor * power * volume_power<T>(volume_m3) *
         ((walls.area_m2 + walls.area_per_m3 * volume_m3) * (gas.temperature_K - walls.temperature_K));
}

}  // namespace crankloop::detail
