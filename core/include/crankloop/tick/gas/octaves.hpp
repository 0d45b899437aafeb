// Powers of any exponent, x^y = 2^(y log2 x), of numbers one by one.
//
// What belongs here: the logarithm and the power of 2. What does not: powers of fixed exponents that every step needs
// (wall_heat.hpp), set-up's functions (tabulate/elementary.hpp).
//
// Exponents of 2 are taken from and put into the bits; the rest is a series: relative errors of the power below 1e-6
// in float, 1e-8 in double.
#pragma once

#include <cstdint>
#include <cstring>

#include <crankloop/tick/lanes.hpp>

namespace crankloop::detail {

template <class Real>
struct FloatBits {
  static constexpr int kFractionBits = sizeof(Real) == 4 ? 23 : 52;
  static constexpr int kBias = sizeof(Real) == 4 ? 127 : 1023;
};

/// log2 x of a normal number above 0: 2 / ln 2 artanh s of its fraction f, 0.75 <= f < 1.5, s = (f - 1) / (f + 1).
template <class Real>
[[nodiscard]] inline Real octaves_of(Real x) noexcept {
  using Bits = BitsOf<Real>;
  using F = FloatBits<Real>;
  const auto c = [](double number) { return static_cast<Real>(number); };
  constexpr Bits kFraction = (Bits{1} << F::kFractionBits) - 1, kHalf = Bits{1} << (F::kFractionBits - 1);
  Bits bits;
  std::memcpy(&bits, &x, sizeof bits);
  const Bits upper = (bits & kHalf) << 1;  // a fraction of at least 1.5 is halved
  const auto octave = static_cast<std::int32_t>((bits + upper) >> F::kFractionBits) - F::kBias;
  const Bits of_fraction = ((Bits{F::kBias} << F::kFractionBits) - upper) | (bits & kFraction);
  Real f;
  std::memcpy(&f, &of_fraction, sizeof f);
  const Real s = (f - c(1)) / (f + c(1)), s2 = s * s;
  constexpr double kTwice = 2.8853900817779268;
  const Real series =
      c(kTwice) + s2 * (c(kTwice / 3) + s2 * (c(kTwice / 5) + s2 * (c(kTwice / 7) + s2 * c(kTwice / 9))));
  return static_cast<Real>(octave) + s * series;
}

/// 2^y; beyond -120 and 120 as there, of what is not a number as of -120.
template <class Real>
[[nodiscard]] inline Real power_of_2(Real y) noexcept {
  using Bits = BitsOf<Real>;
  using F = FloatBits<Real>;
  const auto c = [](double number) { return static_cast<Real>(number); };
  constexpr Real kMost = 120;
  y = y > -kMost ? y : -kMost;
  y = y < kMost ? y : kMost;
  const auto octave = static_cast<std::int32_t>(y + (y < 0 ? c(-0.5) : c(0.5)));
  const Real r = y - static_cast<Real>(octave);  // -1/2 to 1/2
  const Bits bits = static_cast<Bits>(octave + F::kBias) << F::kFractionBits;
  Real power;
  std::memcpy(&power, &bits, sizeof power);
  const auto upper = r * (c(1.5403530393381609e-4) + r * c(1.5252733804059841e-5));
  const auto lower = r * (c(9.6181291076284772e-3) + r * (c(1.3333558146428443e-3) + upper));
  return power *
         (c(1) + r * (c(0.69314718055994531) + r * (c(0.24022650695910071) + r * (c(5.5504108664821580e-2) + lower))));
}

}  // namespace crankloop::detail
