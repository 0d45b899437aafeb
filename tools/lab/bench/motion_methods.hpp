// Methods for a piston's displacement, velocity and acceleration from a crank phase: formulas and several kinds of
// tables.
//
// What belongs here: the contestants' code, each written for speed. What does not: timing and errors (kinematics.cpp).
// All leave out a pin offset, as published numbers do. Derivatives are by the crank angle; the speed is multiplied at
// the end, in the same way for all.
//
//     s = sin a, c = cos a, q = cos b = sqrt(1 - (lambda s)^2), lambda = r / l
//     x = r (1 - c) + l (1 - q),  dx/da = r (s + lambda s c / q),
//     d2x/da2 = r (c + lambda (c^2 - s^2) / q + lambda^3 s^2 c^2 / q^3)
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <crankloop/define/crank.hpp>
#include <crankloop/tabulate/tabulate.hpp>

#include "crankloop/files/units.hpp"

namespace crankloop::program::bench {

/// x, v, a; for a table's knots and for exact poses: x, dx/da, d2x/da2.
template <class Real>
struct Motion {
  Real x, v, a;
};

inline constexpr long double kTwoPi = 2 * kWidePi;
inline constexpr double kRadPerUnit =
    static_cast<double>(2 * kTwoPi / 18446744073709551616.0L);  ///< 2^64 phase units are 720 deg

/// The crank angle from -pi to pi: the top bit of a phase only distinguishes the two crank turns of a cycle.
template <class Real>
[[nodiscard]] inline Real turn_rad(std::uint64_t phase) noexcept {
  return static_cast<Real>(static_cast<double>(static_cast<std::int64_t>(phase << 1)) * (kRadPerUnit / 2));
}

/// The sin/cos/sqrt form, from the mathematics library. In long double it is the reference.
template <class Real>
class ExactMotion {
 public:
  explicit ExactMotion(const Crank& crank)
      : r_{static_cast<Real>(crank.crank_radius_m)}, l_{static_cast<Real>(crank.rod_length_m)}, lambda_{r_ / l_} {}

  [[nodiscard]] Motion<Real> at_angle(Real a) const noexcept {
    const Real s = std::sin(a);
    const Real c = std::cos(a);
    const Real ls = lambda_ * s;
    const Real q = std::sqrt(1 - ls * ls);
    const Real per_q = 1 / q;
    const Real lc_q = lambda_ * c * per_q;
    return {r_ * (1 - c) + l_ * (1 - q), r_ * (s + s * lc_q),
            r_ * (c + lambda_ * (c * c - s * s) * per_q + ls * ls * lc_q * c * per_q * per_q)};
  }
  [[nodiscard]] Motion<Real> at(std::uint64_t phase) const noexcept { return at_angle(turn_rad<Real>(phase)); }

 private:
  Real r_, l_, lambda_;
};

/// Exactly the angle of a phase, for the reference.
[[nodiscard]] inline Motion<long double> true_motion(const ExactMotion<long double>& exact,
                                                     std::uint64_t phase) noexcept {
  return exact.at_angle(static_cast<long double>(phase << 1) * (kTwoPi / 18446744073709551616.0L));
}

/// As textbooks print it: b = asin(lambda sin a), and sums of angles.
template <class Real>
class TextbookMotion {
 public:
  explicit TextbookMotion(const Crank& crank)
      : r_{static_cast<Real>(crank.crank_radius_m)}, l_{static_cast<Real>(crank.rod_length_m)}, lambda_{r_ / l_} {}

  [[nodiscard]] Motion<Real> at(std::uint64_t phase) const noexcept {
    const Real a = turn_rad<Real>(phase);
    const Real b = std::asin(lambda_ * std::sin(a));
    const Real cos_a = std::cos(a);
    const Real cos_b = std::cos(b);
    return {r_ * (1 - cos_a) + l_ * (1 - cos_b), r_ * std::sin(a + b) / cos_b,
            r_ * (std::cos(a + b) / cos_b + lambda_ * cos_a * cos_a / (cos_b * cos_b * cos_b))};
  }

 private:
  Real r_, l_, lambda_;
};

/// Segment of a phase among N equal segments of a crank turn, and the fraction: one multiplication, in double a second
/// one for the additional bits.
template <class Real, std::uint32_t N>
struct Place {
  std::uint32_t index;
  Real u;  ///< 0 to below 1

  explicit Place(std::uint64_t phase) noexcept {
    const std::uint64_t turn = phase << 1;
    std::uint64_t product = (turn >> 32) * N;
    if constexpr (sizeof(Real) == 8) product += (turn & 0xFFFF'FFFFu) * N >> 32;
    index = static_cast<std::uint32_t>(product >> 32);
    constexpr int kDropped = sizeof(Real) == 4 ? 8 : 1;  // signed, because that conversion is one instruction
    u = static_cast<Real>(static_cast<std::int32_t>(static_cast<std::uint32_t>(product) >> kDropped)) *
        (Real{1} / static_cast<Real>(std::uint64_t{1} << (32 - kDropped)));
  }
};

/// Motion at a fraction of a turn, exact.
[[nodiscard]] inline Motion<double> motion_at_turn(const Crank& crank, double turn) {
  const Motion<long double> m = ExactMotion<long double>(crank).at_angle(static_cast<long double>(turn) * kTwoPi);
  return {static_cast<double>(m.x), static_cast<double>(m.v), static_cast<double>(m.a)};
}

template <class Real>
[[nodiscard]] Motion<Real> rounded(const Motion<double>& m) {
  return {static_cast<Real>(m.x), static_cast<Real>(m.v), static_cast<Real>(m.a)};
}

/// The nearest of N knots.
template <class Real, std::uint32_t N>
class NearestTable {
 public:
  explicit NearestTable(const Crank& crank) : at_(N + 1) {
    for (std::uint32_t i = 0; i <= N; ++i) at_[i] = rounded<Real>(motion_at_turn(crank, static_cast<double>(i) / N));
  }
  [[nodiscard]] Motion<Real> at(std::uint64_t phase) const noexcept {
    const std::uint64_t half = std::uint64_t{1} << 31;
    return at_[(std::uint64_t{static_cast<std::uint32_t>(phase >> 31)} * N + half) >> 32];
  }

 private:
  std::vector<Motion<Real>> at_;
};

/// Straight lines between N knots.
template <class Real, std::uint32_t N>
class LinearTable {
 public:
  explicit LinearTable(const Crank& crank) : at_(N + 1) {
    for (std::uint32_t i = 0; i <= N; ++i) at_[i] = rounded<Real>(motion_at_turn(crank, static_cast<double>(i) / N));
  }
  [[nodiscard]] Motion<Real> at(std::uint64_t phase) const noexcept {
    const Place<Real, N> place(phase);
    const Motion<Real>& from = at_[place.index];
    const Motion<Real>& to = at_[place.index + 1];
    return {from.x + place.u * (to.x - from.x), from.v + place.u * (to.v - from.v), from.a + place.u * (to.a - from.a)};
  }

 private:
  std::vector<Motion<Real>> at_;
};

/// N polynomials of a degree for each of the three, through Chebyshev's points: nearly the best approximation.
template <class Real, std::uint32_t N, std::size_t Degree>
class PolynomialTable {
 public:
  explicit PolynomialTable(const Crank& crank) : at_(N) {
    for (std::uint32_t i = 0; i < N; ++i) at_[i] = fit(crank, i);
  }
  [[nodiscard]] Motion<Real> at(std::uint64_t phase) const noexcept {
    const Place<Real, N> place(phase);
    const Segment& s = at_[place.index];
    return {value(s.x, place.u), value(s.v, place.u), value(s.a, place.u)};
  }

 private:
  using Coefficients = std::array<Real, Degree + 1>;
  struct Segment {
    Coefficients x, v, a;
  };

  [[nodiscard]] static Real value(const Coefficients& c, Real u) noexcept {
    Real sum = c[Degree];
    for (std::size_t i = Degree; i-- > 0;) sum = c[i] + u * sum;
    return sum;
  }

  [[nodiscard]] static Segment fit(const Crank& crank, std::uint32_t segment) {
    std::array<double, Degree + 1> u{};
    std::array<Motion<double>, Degree + 1> here{};
    for (std::size_t j = 0; j <= Degree; ++j) {
      u[j] = 0.5 - 0.5 * std::cos((2 * static_cast<double>(j) + 1) / (2 * static_cast<double>(Degree) + 2) *
                                  static_cast<double>(kTwoPi) / 2);
      here[j] = motion_at_turn(crank, (segment + u[j]) / N);
    }
    return {through(u, here, &Motion<double>::x), through(u, here, &Motion<double>::v),
            through(u, here, &Motion<double>::a)};
  }

  /// Newton's divided differences, multiplied out.
  [[nodiscard]] static Coefficients through(const std::array<double, Degree + 1>& u,
                                            const std::array<Motion<double>, Degree + 1>& here,
                                            double Motion<double>::*quantity) {
    std::array<double, Degree + 1> difference{};
    for (std::size_t j = 0; j <= Degree; ++j) difference[j] = here[j].*quantity;
    for (std::size_t order = 1; order <= Degree; ++order) {
      for (std::size_t j = Degree; j >= order; --j)
        difference[j] = (difference[j] - difference[j - 1]) / (u[j] - u[j - order]);
    }
    std::array<double, Degree + 1> c{};
    for (std::size_t j = Degree + 1; j-- > 0;) {  // c = difference[j] + (u - u_j) c
      for (std::size_t i = Degree; i > 0; --i) c[i] = c[i - 1] - u[j] * c[i];
      c[0] = difference[j] - u[j] * c[0];
    }
    Coefficients out{};
    for (std::size_t i = 0; i <= Degree; ++i) out[i] = static_cast<Real>(c[i]);
    return out;
  }

  std::vector<Segment> at_;
};

/// The library's tables, evaluated as in its tick.
template <class Real>
class LibraryMotion {
 public:
  explicit LibraryMotion(const Crank& crank) : storage_{std::make_unique<Storage>()} {
    EngineDefinition engine;
    engine.crank = crank;
    engine.masses.piston_kg = 1;
    status_ = storage_->build(engine, {100e-6});
    motion_ = storage_->tables().motion;
  }
  [[nodiscard]] const Status& status() const noexcept { return status_; }

  [[nodiscard]] Motion<Real> at(std::uint64_t phase) const noexcept {
    const detail::Cell cell = Phase{phase}.cell<Real>();
    const std::uint32_t degree = cell.degree >= kDegreesPerTurn ? cell.degree - kDegreesPerTurn : cell.degree;
    const Real u = detail::fraction<Real>(cell);
    const detail::MotionSegment<Real>& motion = motion_->at[degree];
    return {value(motion.displacement, u), value(motion.slope, u), value(motion.acceleration, u)};
  }

 private:
  struct Pistons : Scene {
    static constexpr bool kinematics = true;
  };
  using Storage = TableStorage<Real, Pistons>;

  std::unique_ptr<Storage> storage_;
  const detail::Revolution<detail::MotionSegment<Real>>* motion_ = nullptr;
  Status status_;
};

}  // namespace crankloop::program::bench
