// Elementary functions for set-up time, with the same bits on every machine.
//
// What belongs here: the functions of <cmath> that tabulate needs beyond sqrt, in double. What does not: anything
// specific to engines, anything that a tick calls (a tick needs none of these).
//
// C libraries differ from machine to machine in the last bits of sin, cos, atan, exp, log and pow, and so would tables
// made with them. These functions use only + - * / and sqrt; all they need is -ffp-contract=off (a house flag).
//
//     function     accurate for                   ulp: stated, found   otherwise
//     sin, cos     |angle| <= kLargestAngle_rad        0.58   0.566    beyond: as for angle 0; infinity, NaN: NaN
//     tan          |angle| <= kLargestAngle_rad        0.62   0.583    beyond: as for angle 0; infinity, NaN: NaN
//     asin, acos   [-1, 1]                             0.53   0.519    NaN
//     atan, atan2  all but NaN                         0.53   0.517    NaN
//     exp          results from 2^-1022                0.53   0.523    above the largest double: infinity; NaN: NaN
//                  subnormal results                   0.77   0.754    below half the smallest double: 0
//     log          x > 0                               0.51   0.501    0: -infinity; negative, NaN: NaN
//     pow          x > 0, |y ln x| <= 100              0.53   0.528    x < 0, NaN: NaN; 0 and infinity as std::pow
//                  x > 0, any y                        1      0.931    too large or small a result: as exp
//
// An ulp is the distance between doubles of the exact result's size. "Found" is the largest error among 10 to 30
// million random points in each of several ranges, against x86's long double; the test holds the functions to
// "stated".
//
// Signs are exact: f(-x) is -f(x) for the odd functions, zeros included. Every NaN returned is the same one. The
// processor must round to nearest and keep subnormal numbers during set-up, as it does by default. No
// state, no tables but four arctangents.
#pragma once

namespace crankloop::elementary {

inline constexpr double kPi = 3.14159265358979323846;

/// 2^31: the sine of an angle beyond 340 million revolutions is not computed (one bit of such an angle is already
/// 0.5e-6 rad).
inline constexpr double kLargestAngle_rad = 2147483648.0;

[[nodiscard]] double sin(double angle_rad) noexcept;
[[nodiscard]] double cos(double angle_rad) noexcept;

/// Sine and cosine with the same bits as above, at little more than the cost of one.
struct SinCos {
  double sin;
  double cos;
};
[[nodiscard]] SinCos sin_cos(double angle_rad) noexcept;
[[nodiscard]] double tan(double angle_rad) noexcept;

/// The angle in rad, -pi/2 to pi/2.
[[nodiscard]] double asin(double sine) noexcept;

/// The angle in rad, 0 to pi.
[[nodiscard]] double acos(double cosine) noexcept;

/// The angle in rad, -pi/2 to pi/2.
[[nodiscard]] double atan(double slope) noexcept;

/// The angle of the point (x, y) from the x axis in rad, -pi to pi; zeros and infinities of either sign as in
/// std::atan2.
[[nodiscard]] double atan2(double y, double x) noexcept;

/// atan2 for x >= 0, x and y not both 0, and a ratio in the range of double: accurate to 4 ulp, at a seventh of the
/// cost.
[[nodiscard]] double quick_atan2(double y, double x) noexcept;

[[nodiscard]] double exp(double x) noexcept;

/// Natural logarithm.
[[nodiscard]] double log(double x) noexcept;

/// x to the power y, x >= 0. As in std::pow, pow(x, 0) and pow(1, y) are 1 whatever the other is, NaN included;
/// pow(0, y) is 0 for y > 0, which a Wiebe law needs at its start. A negative x gives NaN for whole y too: multiply
/// instead.
[[nodiscard]] double pow(double x, double y) noexcept;

/// A fixed power from -1 to 1 of many numbers: accurate to 4 ulp, at a fifteenth of the cost.
class FixedPower {
 public:
  FixedPower() = default;  ///< returns 0
  explicit FixedPower(double power) noexcept;
  /// x from 1 to below 128; others: NaN.
  [[nodiscard]] double operator()(double x) const noexcept;

 private:
  static constexpr int kOctaves = 7;
  static constexpr int kParts = 32;  ///< of an octave
  static constexpr int kTerms = 9;
  double octaves_[kOctaves] = {};  ///< powers of their lower ends
  double parts_[kParts] = {};      ///< powers of their midpoints
  double terms_[kTerms] = {};      ///< binomial coefficients of (1 + t)^power
};

}  // namespace crankloop::elementary
