// How each degree of a cycle is divided into segments, so that a quantity of the gas is within a tolerance.
//
// What belongs here: a segment's fit to a quantity, its error, the choice of the grid. What does not: the quantities
// (gas_quantities.hpp), which curves there are and the work of a torque (gas_curves.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "curve_fit.hpp"
#include "gas_quantities.hpp"

namespace crankloop::detail {

inline constexpr std::size_t kDivisionCount = 5;
inline constexpr int kDivisions[kDivisionCount] = {
    1, 2, 5, 10, 20};  // segments of a degree; data at 0.1 deg has its points on the borders of 10 and 20
static_assert(kFinest == kDivisions[kDivisionCount - 1]);
inline constexpr int kMaxDoublings = 20;  // of the tolerance: then it exceeds the peak pressure, so one segment per
                                          // degree is enough

[[nodiscard]] inline double size(double x) noexcept { return x < 0 ? -x : x; }
[[nodiscard]] inline double larger(double a, double b) noexcept { return a < b ? b : a; }

/// Fit of a segment to a quantity: the angles of its values, and the polynomial.
template <class Real, class Quantity>
struct Fit;

/// A pressure segment passes through both ends, so that the curve has no steps, and through the middle. Where the
/// diagram is monotone, the curvature is limited so that the segment is too: no overshoot between given points.
template <class Real>
struct Fit<Real, CylinderPressure> {
  static constexpr std::size_t kPlaces = kPressurePlaces;
  static constexpr int kSamplesPerFinest = 3;  // between the fitted angles, where the error is small or zero

  [[nodiscard]] static double place(std::size_t i, double from, double to) noexcept {
    const double places[kPlaces] = {from, from + 0.25 * (to - from), (from + to) / 2, from + 0.75 * (to - from), to};
    return places[i];
  }
  [[nodiscard]] static Polynomial<kCoefficients<Real>> fitted(const double (&places)[kPlaces],
                                                              const double (&values)[kPlaces]) noexcept {
    const double from = places[0];
    const double to = places[kPlaces - 1];
    const auto [start, quarter, middle, three_quarters, end] = values;
    const double rise = end - start;
    double bulge = 4 * middle - 2 * (start + end);  // p(t) = start + rise t + bulge t (1 - t), t = 0 to 1
    const double most = size(rise);
    const double sign = rise < 0 ? -1 : 1;
    const auto not_falling = [sign](double a, double b) { return sign * b >= sign * a; };
    const bool monotone = not_falling(start, quarter) && not_falling(quarter, middle) &&
                          not_falling(middle, three_quarters) && not_falling(three_quarters, end);
    if (monotone && size(bulge) > most) bulge = bulge < 0 ? -most : most;
    const double scale = 1 / (to - from);
    const double linear = (rise + bulge) * scale;
    const double square = -bulge * scale * scale;
    Polynomial<kCoefficients<Real>> p;
    p.c[0] = start - from * (linear - square * from);
    p.c[1] = linear - 2 * square * from;
    p.c[2] = square;
    return p;
  }
};

template <class Real>
struct Fit<Real, EngineTorque> {
  static constexpr std::size_t kPlaces = kCoefficients<Real>;
  static constexpr int kSamplesPerFinest =
      sizeof(Real) > 4 ? 2 : 3;  // a cubic has its largest errors at the ends and in the middle, a quadratic at thirds

  [[nodiscard]] static double place(std::size_t i, double from, double to) noexcept { return node<Real>(i, from, to); }
  [[nodiscard]] static Polynomial<kCoefficients<Real>> fitted(const double (&places)[kPlaces],
                                                              const double (&values)[kPlaces]) noexcept {
    return through(places, values);
  }
};

/// One degree in up to kFinest equal segments of all parts (full, motored, heat).
template <class Real>
struct Degree {
  int segments;
  std::array<Segment<Real>, kParts> at[kFinest];
};

template <class Real, class Quantity>
[[nodiscard]] Degree<Real> divided(const Quantity& quantity, int degree, int segments) noexcept {
  using F = Fit<Real, Quantity>;
  Places places;
  for (int s = 0; s < segments; ++s) {
    for (std::size_t i = 0; i < F::kPlaces; ++i)
      places.add(F::place(i, static_cast<double>(s) / segments, static_cast<double>(s + 1) / segments));
  }
  quantity.find(degree, places);
  Degree<Real> result;
  result.segments = segments;
  for (int s = 0; s < segments; ++s) {
    for (std::size_t part = 0; part < kParts; ++part) {
      double at[F::kPlaces];
      double values[F::kPlaces];
      for (std::size_t i = 0; i < F::kPlaces; ++i) {
        at[i] = places.at[static_cast<std::size_t>(s) * F::kPlaces + i];
        values[i] = places.found[static_cast<std::size_t>(s) * F::kPlaces + i][part];
      }
      result.at[s][part] = rounded<Real>(F::fitted(at, values));
    }
  }
  return result;
}

/// Samples of a quantity within one degree, each computed once; all divisions are checked against them.
template <class Real, class Quantity>
class Samples {
 public:
  Samples(const Quantity& quantity, int degree) noexcept : quantity_{quantity}, degree_{degree} {}

  /// Largest error of any of the parts from `first` on.
  [[nodiscard]] double largest_error(const Degree<Real>& divided, Part first) noexcept {
    const int step = divided.segments == 1 ? kFirstStep : 1;  // most degrees need no division and so no more samples
    if (step != found_step_) find(step);
    const int per_segment = kCount / divided.segments;
    double largest = 0;
    for (int s = 0; s < divided.segments; ++s) {
      for (int i = s * per_segment; i <= (s + 1) * per_segment; i += step) {
        for (std::size_t part = first; part < kParts; ++part) {
          const double error =
              size(static_cast<double>(value(divided.at[s][part], static_cast<Real>(place(i)))) - exact_[i][part]);
          largest = larger(largest, error);
        }
      }
    }
    return largest;
  }

 private:
  static constexpr int kCount = kFinest * Fit<Real, Quantity>::kSamplesPerFinest;
  static constexpr int kFirstStep = kCount / 10;
  static_assert(kCount < static_cast<int>(Places::kMax));

  [[nodiscard]] static double place(int i) noexcept { return static_cast<double>(i) / kCount; }

  void find(int step) noexcept {
    const auto for_each_missing = [&](const auto& visit) {
      for (int i = 0; i <= kCount; i += step) {
        if (found_step_ == 0 || i % found_step_ != 0) visit(i);
      }
    };
    Places places;
    for_each_missing([&](int i) { places.add(place(i)); });
    quantity_.find(degree_, places);
    std::size_t next = 0;
    for_each_missing([&](int i) { exact_[i] = places.found[next++]; });
    found_step_ = step;
  }

  const Quantity& quantity_;
  int degree_;
  int found_step_ = 0;  ///< samples at its multiples exist; 0: none
  AllParts exact_[std::size_t{kCount} + 1];
};

/// Result of choose_grid().
struct Chosen {
  int segments;
  int doublings;  ///< of the tolerance
  double error;   ///< largest error of degrees that are not divided most finely
};

/// Divides each degree into the fewest segments that keep the parts from `first` on within the tolerance; the tolerance
/// is doubled until they all fit. A larger tolerance never needs a finer division, so each division is checked at most
/// once. A quantity with a shorter period than the cycle is checked over one period.
template <class Real, class Quantity>
[[nodiscard]] Chosen choose_grid(GasGrid& grid, const Quantity& quantity, Part first, int capacity,
                                 double tolerance) noexcept {
  auto limit = static_cast<float>(tolerance);
  float errors[kDegreesPerCycle][kDivisionCount - 1];
  const int period_deg = quantity.period_deg();
  for (int degree = 0; degree < period_deg; ++degree) {
    Samples<Real, Quantity> samples(quantity, degree);
    for (std::size_t division = 0; division + 1 < kDivisionCount; ++division) {
      errors[degree][division] =
          static_cast<float>(samples.largest_error(divided<Real>(quantity, degree, kDivisions[division]), first));
      if (errors[degree][division] <= limit) break;
    }
  }
  Chosen chosen{};
  for (int doublings = 0; doublings <= kMaxDoublings; ++doublings, limit *= 2) {
    chosen = {0, doublings, 0};
    for (int degree = 0; degree < kDegreesPerCycle; ++degree) {
      const auto& error = errors[degree % period_deg];
      std::size_t division = 0;
      while (division + 1 < kDivisionCount && error[division] > limit) ++division;
      grid.first[degree] = static_cast<std::uint16_t>(chosen.segments);
      chosen.segments += kDivisions[division];
      if (division + 1 < kDivisionCount) chosen.error = larger(chosen.error, static_cast<double>(error[division]));
    }
    grid.first[kDegreesPerCycle] = static_cast<std::uint16_t>(chosen.segments);
    if (chosen.segments <= capacity) break;
  }
  return chosen;
}

/// Calls store(segment index, its parts) for every segment of the grid. Returns the largest error of the most finely
/// divided degrees.
template <class Real, class Quantity, class Store>
double fill_grid(const GasGrid& grid, const Quantity& quantity, Part first, const Store& store) noexcept {
  double largest = 0;
  for (int degree = 0; degree < kDegreesPerCycle; ++degree) {
    const Degree<Real> segments = divided<Real>(quantity, degree, grid.first[degree + 1] - grid.first[degree]);
    for (int s = 0; s < segments.segments; ++s) store(grid.first[degree] + s, segments.at[s]);
    if (segments.segments < kFinest) continue;
    largest = larger(largest, Samples<Real, Quantity>(quantity, degree).largest_error(segments, first));
  }
  return largest;
}

/// Calls visit(segment index, degree, from, to) for every segment of the grid.
template <class Visit>
void for_each_segment(const GasGrid& grid, const Visit& visit) noexcept {
  for (int degree = 0; degree < kDegreesPerCycle; ++degree) {
    const int first = grid.first[degree];
    const int n = grid.first[degree + 1] - first;
    for (int i = 0; i < n; ++i) visit(first + i, degree, static_cast<double>(i) / n, static_cast<double>(i + 1) / n);
  }
}

}  // namespace crankloop::detail
