// Implementation of the elementary functions.
//
// At set-up time equal bits and short code matter more than speed (quick_atan2 and FixedPower are for calls by the
// million). There are only five series: sine, cosine, atan, exp, and atanh for log. Each is a Taylor polynomial with
// readable coefficients; its comment states the first dropped term. A second double carries the rounding errors that
// would show in the result: therefore errors are little over 0.5 ulp.
//
// Every operation is + - * / or sqrt, which IEEE 754 rounds in one way only (to nearest), as long as the compiler
// neither fuses (-ffp-contract=off, a house flag) nor reorders nor widens them (build_check.hpp).
#include <crankloop/assert.hpp>
#include <crankloop/tabulate/elementary.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include <crankloop/build_check.hpp>

#include "double_double.hpp"

namespace crankloop::elementary {
namespace {

static_assert(std::numeric_limits<double>::is_iec559 && sizeof(double) == sizeof(std::uint64_t),
              "needs IEEE 754 binary64");

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();  // always this one: processors produce NaNs of
                                                                   // different sign

// ---- Bits -----------------------------------------------------------------------------------------------------------

std::uint64_t bits_of(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

double from_bits(std::uint64_t bits) {
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

constexpr std::uint64_t kSignBit = std::uint64_t{1} << 63;

bool is_nan(double x) { return x != x; }
bool is_negative(double x) { return (bits_of(x) & kSignBit) != 0; }  // true for -0 too
double magnitude(double x) { return from_bits(bits_of(x) & ~kSignBit); }
double flip_sign_if(bool flip, double x) { return flip ? -x : x; }

/// 2^exponent, -1022 <= exponent <= 1023.
double power_of_two(int exponent) {
  CRANKLOOP_ASSERT(exponent > -1023 && exponent < 1024);
  return from_bits(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

/// c[0] + c[1] x + c[2] x^2 + ...
template <std::size_t I = 0, std::size_t N>
[[gnu::always_inline]] inline double polynomial(const double (&c)[N], double x) {
  if constexpr (I + 1 == N) {
    return c[I];
  } else {
    return c[I] + x * polynomial<I + 1>(c, x);
  }
}

// ---- Sine and cosine ------------------------------------------------------------------------------------------------

constexpr Pair kHalfPi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr double kHalfPiRest = -0x1.f1976b7ed8fbcp-110;  // pi/2 - kHalfPi; the remainder is below 2^-163
constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;

struct Reduced {
  Pair angle;    ///< within pi/4 + 2^-20
  int quadrant;  ///< only the last two bits matter
};

/// x = quarter_turns pi/2 + angle, x >= 0.
///
/// No double up to 2^31 is nearer than 2^-60.5 to a multiple of pi/2 (found by trying all; the nearest is beside 29
/// pi/2). With pi/2 to 163 bits, in three doubles, the angle's error is below 2^-129, so at most 2^-68 of the angle.
Reduced reduce(double x) {
  CRANKLOOP_ASSERT(x >= 0);
  if (x > kLargestAngle_rad) return {{0.0, 0.0}, 0};
  const auto quarter_turns = static_cast<std::int64_t>(x * kTwoOverPi + 0.5);
  const auto n = static_cast<double>(quarter_turns);
  const Pair first = product(n, kHalfPi.hi);
  const Pair second = product(n, kHalfPi.lo);
  const Pair a = sum(x - first.hi, -first.lo);  // x - first.hi is exact: the two are close (Sterbenz)
  const Pair b = sum(a.hi, -second.hi);
  return {sum(b.hi, ((a.lo + b.lo) - second.lo) - n * kHalfPiRest), static_cast<int>(quarter_turns & 3)};
}

/// Sine of an angle r within pi/4, with its square. Taylor to r^17; the first dropped term, r^19/19!, is below 2^-62 of
/// the sine. r - r^3/6 is carried in full.
Pair sine_series(Pair r, Pair square) {
  static constexpr double kTerms[] = {
      1.0 / 120.0,        -1.0 / 5040.0,          1.0 / 362880.0,         -1.0 / 39916800.0,
      1.0 / 6227020800.0, -1.0 / 1307674368000.0, 1.0 / 355687428096000.0};
  constexpr Pair kMinusSixth{-0x1.5555555555555p-3, -0x1.5555555555555p-57};
  const Pair head = add(r, multiply(kMinusSixth, multiply(square, r)));
  const double tail = square.hi * square.hi * r.hi * polynomial(kTerms, square.hi);
  return quick_sum(head.hi, head.lo + tail);
}

/// Cosine from the angle's square. Taylor to r^18; the first dropped term, r^20/20!, is below 2^-67 of the cosine. 1 -
/// r^2/2 is carried in full.
Pair cosine_series(Pair square) {
  static constexpr double kTerms[] = {
      1.0 / 24.0,        -1.0 / 720.0,         1.0 / 40320.0,          -1.0 / 3628800.0,
      1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0, -1.0 / 6402373705728000.0};
  const Pair head = add({1.0, 0.0}, {-0.5 * square.hi, -0.5 * square.lo});
  const double tail = square.hi * square.hi * polynomial(kTerms, square.hi);
  return quick_sum(head.hi, head.lo + tail);
}

double sine_at(Reduced r) {
  const Pair square = multiply(r.angle, r.angle);
  const double value = ((r.quadrant & 1) != 0 ? cosine_series(square) : sine_series(r.angle, square)).hi;
  return flip_sign_if((r.quadrant & 2) != 0, value);
}

// ---- Arc functions: all are the direction of a point (x, y) ---------------------------------------------------------

constexpr Pair kAtanOfQuarters[] = {{0.0, 0.0},
                                    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
/// Taylor from t^3 to t^19; for t up to 1/8 the first dropped term, t^21/21, is below 2^-64 of t.
constexpr double kAtanTerms[] = {-1.0 / 3.0, 1.0 / 5.0,   -1.0 / 7.0, 1.0 / 9.0,  -1.0 / 11.0,
                                 1.0 / 13.0, -1.0 / 15.0, 1.0 / 17.0, -1.0 / 19.0};

/// atan(n/d) for 0 <= n <= d, d > 0.
Pair first_octant(Pair n, Pair d) {
  const double ratio = n.hi / d.hi;
  if (ratio < 0x1p-30) return {ratio, 0.0};  // atan(t) = t (1 - t^2/3 + ...): 2^-61 off
  const double scale = d.hi > 0x1p+500 ? 0x1p-600 : d.hi < 0x1p-500 ? 0x1p+600 : 1.0;  // keeps products in range
  n = {n.hi * scale, n.lo * scale};
  d = {d.hi * scale, d.lo * scale};

  // atan(n/d) = atan(c) + atan(t), t = (n - c d)/(d + c n), with c the nearest quarter, so that |t| <= 1/8.
  const int quarters = static_cast<int>(4.0 * ratio + 0.5);
  const Pair c{0.25 * quarters, 0.0};
  const Pair t = divide(subtract(n, multiply(c, d)), add(d, multiply(c, n)));

  const double square = t.hi * t.hi;
  return add(kAtanOfQuarters[quarters], quick_sum(t.hi, t.lo + t.hi * square * polynomial(kAtanTerms, square)));
}

/// Angle of the point (x, y), or of (-x, y) if mirrored, from the x axis: 0 to pi. x, y >= 0, not both 0.
double direction(Pair y, Pair x, bool mirrored) {
  if (y.hi <= x.hi) {
    const Pair angle = first_octant(y, x);
    return mirrored ? subtract({2.0 * kHalfPi.hi, 2.0 * kHalfPi.lo}, angle).hi : angle.hi;
  }
  const Pair angle = first_octant(x, y);
  return (mirrored ? add(kHalfPi, angle) : subtract(kHalfPi, angle)).hi;
}

/// The other leg of a right triangle with hypotenuse 1, 0 <= x <= 1: sqrt((1 - x)(1 + x)), accurate near 1 too.
Pair other_leg(double x) { return square_root(multiply(sum(1.0, -x), sum(1.0, x))); }

// ---- Exponential and logarithm --------------------------------------------------------------------------------------

constexpr double kLn2Hi = 0x1.62e42fefa3800p-1;   // the first 42 bits of ln 2: the product with an exponent of 11 bits
                                                  // is exact
constexpr double kLn2Lo = 0x1.ef35793c76730p-45;  // the rest, to 2^-98
constexpr double kOneOverLn2 = 0x1.71547652b82fep+0;

/// e^(x.hi + x.lo) for any x.hi but NaN.
double exponential(Pair x) {
  CRANKLOOP_ASSERT(!is_nan(x.hi));
  if (x.hi > 710.0) return kInfinity;
  if (x.hi < -746.0) return 0.0;
  const int k = static_cast<int>(x.hi * kOneOverLn2 + (x.hi < 0.0 ? -0.5 : 0.5));
  // |r| <= ln 2 / 2; the first difference is exact, its two numbers being close (Sterbenz).
  const Pair r = sum(x.hi - k * kLn2Hi, x.lo - k * kLn2Lo);

  // Taylor to r^14; the first dropped term, r^15/15!, is below 2^-62 of the result. 1 + r + r^2/2 is carried in full.
  static constexpr double kTerms[] = {1.0 / 6.0,        1.0 / 24.0,        1.0 / 120.0,        1.0 / 720.0,
                                      1.0 / 5040.0,     1.0 / 40320.0,     1.0 / 362880.0,     1.0 / 3628800.0,
                                      1.0 / 39916800.0, 1.0 / 479001600.0, 1.0 / 6227020800.0, 1.0 / 87178291200.0};
  const Pair square = multiply(r, r);
  const Pair head = add({1.0, 0.0}, add(r, {0.5 * square.hi, 0.5 * square.lo}));
  const double tail = r.hi * square.hi * polynomial(kTerms, r.hi);
  // 2^k as a product of two powers: 2^1024 overflows a double, and 2^-1074 would lose bits of the result.
  return quick_sum(head.hi, head.lo + tail).hi * power_of_two(k / 2) * power_of_two(k - k / 2);
}

/// ln x for finite x > 0, to 2^-63 of its value.
Pair logarithm(double x) {
  CRANKLOOP_ASSERT(x > 0 && x < kInfinity);
  int exponent = 0;
  if (x < 0x1p-1022) {  // subnormal: its exponent bits are zero
    x *= 0x1p+54;
    exponent = -54;
  }
  exponent += static_cast<int>(bits_of(x) >> 52) - 1023;
  double m = from_bits((bits_of(x) & 0x000f'ffff'ffff'ffffu) | bits_of(1.0));
  if (m > 0x1.6a09e667f3bcdp+0) {  // sqrt 2
    m *= 0.5;
    ++exponent;
  }

  // ln m = 2 atanh(s) = 2 s + 2/3 s^3 + ..., s = (m - 1)/(m + 1), |s| < 0.1716. Taylor to s^25; the first dropped
  // term, 2/27 s^27, is below 2^-70 of the first. Two terms are carried in full, since pow multiplies the error by up
  // to 745.
  static constexpr double kTerms[] = {2.0 / 5.0,  2.0 / 7.0,  2.0 / 9.0,  2.0 / 11.0, 2.0 / 13.0, 2.0 / 15.0,
                                      2.0 / 17.0, 2.0 / 19.0, 2.0 / 21.0, 2.0 / 23.0, 2.0 / 25.0};
  constexpr Pair kTwoThirds{0x1.5555555555555p-1, 0x1.5555555555555p-55};
  const Pair s = divide({m - 1.0, 0.0}, sum(m, 1.0));
  const Pair square = multiply(s, s);
  const double tail = square.hi * square.hi * s.hi * polynomial(kTerms, square.hi);
  const Pair head = add({2.0 * s.hi, 2.0 * s.lo}, multiply(kTwoThirds, multiply(square, s)));
  return add({exponent * kLn2Hi, exponent * kLn2Lo}, quick_sum(head.hi, head.lo + tail));
}

}  // namespace

// ---- The functions: special values and signs first, then the parts above --------------------------------------------

double sin(double angle_rad) noexcept {
  const double size = magnitude(angle_rad);
  return size < kInfinity ? flip_sign_if(is_negative(angle_rad), sine_at(reduce(size))) : kNaN;
}

double cos(double angle_rad) noexcept {
  const double size = magnitude(angle_rad);
  if (!(size < kInfinity)) return kNaN;
  const Reduced r = reduce(size);
  return sine_at({r.angle, r.quadrant + 1});
}

SinCos sin_cos(double angle_rad) noexcept {
  const double size = magnitude(angle_rad);
  if (!(size < kInfinity)) return {kNaN, kNaN};
  const Reduced r = reduce(size);
  const Pair square = multiply(r.angle, r.angle);
  const double sine = sine_series(r.angle, square).hi;
  const double cosine = cosine_series(square).hi;
  const bool odd = (r.quadrant & 1) != 0;
  const bool backward = is_negative(angle_rad);
  return {flip_sign_if(((r.quadrant & 2) != 0) != backward, odd ? cosine : sine),
          flip_sign_if(((r.quadrant + 1) & 2) != 0, odd ? sine : cosine)};
}

double tan(double angle_rad) noexcept {
  const double size = magnitude(angle_rad);
  if (!(size < kInfinity)) return kNaN;
  const Reduced r = reduce(size);
  const bool odd = (r.quadrant & 1) != 0;  // tan(a + pi/2) = -cos a / sin a; no double is an odd multiple of pi/2
  const Pair square = multiply(r.angle, r.angle);
  const Pair sine = sine_series(r.angle, square);
  const Pair cosine = cosine_series(square);
  const double value = odd ? -divide(cosine, sine).hi : divide(sine, cosine).hi;
  return flip_sign_if(is_negative(angle_rad), value);
}

double asin(double sine) noexcept {
  const double y = magnitude(sine);
  if (!(y <= 1.0)) return kNaN;
  return flip_sign_if(is_negative(sine), direction({y, 0.0}, other_leg(y), false));
}

double acos(double cosine) noexcept {
  const double x = magnitude(cosine);
  if (!(x <= 1.0)) return kNaN;
  return direction(other_leg(x), {x, 0.0}, is_negative(cosine));
}

double atan(double slope) noexcept { return elementary::atan2(slope, 1.0); }

double atan2(double y, double x) noexcept {
  if (is_nan(y) || is_nan(x)) return kNaN;
  double rise = magnitude(y);
  double run = magnitude(x);
  if (rise == kInfinity && run == kInfinity) rise = run = 1.0;  // the diagonal
  if (rise == 0.0 && run == 0.0) run = 1.0;                     // on the x axis, on the side of x's sign
  return flip_sign_if(is_negative(y), direction({rise, 0.0}, {run, 0.0}, is_negative(x)));
}

double quick_atan2(double y, double x) noexcept {
  const double rise = magnitude(y);
  const bool steep = rise > x;
  const double ratio = steep ? x / rise : rise / x;
  const int quarters = static_cast<int>(4.0 * ratio + 0.5);  // as in first_octant()
  const double c = 0.25 * quarters;
  const double t = (ratio - c) / (1.0 + c * ratio);
  const double square = t * t;
  const double angle = kAtanOfQuarters[quarters].hi + (t + t * square * polynomial(kAtanTerms, square));
  return flip_sign_if(is_negative(y), steep ? kHalfPi.hi - angle : angle);
}

double exp(double x) noexcept { return is_nan(x) ? kNaN : exponential({x, 0.0}); }

double log(double x) noexcept {
  if (x == 0.0) return -kInfinity;
  if (!(x > 0.0)) return kNaN;
  return x == kInfinity ? x : logarithm(x).hi;
}

double pow(double x, double y) noexcept {
  if (y == 0.0 || x == 1.0) return 1.0;
  if (is_nan(y) || !(x >= 0.0)) return kNaN;
  if (x == 0.0 || x == kInfinity) return (x == 0.0) == (y > 0.0) ? 0.0 : kInfinity;
  // |ln x| > 2^-54 here, so any y of 2^64 or more gives 0 or infinity.
  const double bounded = magnitude(y) < 0x1p+64 ? y : flip_sign_if(y < 0.0, 0x1p+64);
  const Pair ln_x = logarithm(x);
  return exponential(add(product(bounded, ln_x.hi), {bounded * ln_x.lo, 0.0}));
}

FixedPower::FixedPower(double power) noexcept {
  for (int i = 0; i < kOctaves; ++i) octaves_[i] = elementary::pow(power_of_two(i), power);
  for (int i = 0; i < kParts; ++i) parts_[i] = elementary::pow(1.0 + (i + 0.5) / kParts, power);
  terms_[0] = 1.0;
  for (int i = 1; i < kTerms; ++i) terms_[i] = terms_[i - 1] * (power - (i - 1)) / i;
}

double FixedPower::operator()(double x) const noexcept {
  if (!(x >= 1.0 && x < 128.0)) return kNaN;
  // x = 2^octave c (1 + t), c the middle of a part of [1, 2), |t| <= 1/64. Binomial series: its first dropped term, of
  // t^9, is below 2^-54.
  int octave = 0;
  for (; x >= 2.0; x *= 0.5) ++octave;
  const int part = static_cast<int>((x - 1.0) * kParts);
  const double c = 1.0 + (part + 0.5) / kParts;
  return octaves_[octave] * parts_[part] * polynomial(terms_, (x - c) / c);
}

}  // namespace crankloop::elementary
