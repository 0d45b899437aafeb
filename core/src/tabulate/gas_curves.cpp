#include "gas_curves.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#include "curve_fit.hpp"
#include "gas_quantities.hpp"

namespace crankloop::detail {
namespace {

constexpr std::size_t kDivisionCount = 5;
constexpr int kDivisions[kDivisionCount] = {
    1, 2, 5, 10, 20};  // segments of a degree; data at 0.1 deg has its points on the borders of 10 and 20
static_assert(kFinest == kDivisions[kDivisionCount - 1]);
constexpr double kTolerance = 1e-5;  // of the peak pressure, and of its torque at a lever of the crank radius
constexpr int kMaxDoublings = 20;  // of the tolerance: then it exceeds the peak pressure, so one segment per degree is
                                   // enough

[[nodiscard]] double size(double x) noexcept { return x < 0 ? -x : x; }
[[nodiscard]] double larger(double a, double b) noexcept { return a < b ? b : a; }

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

/// A gas torque and its segments; null if the caller does not need them.
template <class Real>
struct TorqueTarget {
  GasTorque<Real>* torque = nullptr;
  IntegratedSegment<Real>* segments = nullptr;
};

/// Fills a gas torque from its segments' slopes: bases of the integrals, quantum and mean.
template <class Real>
void fill_work(const GasGrid& grid, const TorqueTarget<Real>& target) noexcept {
  IntegratedSegment<Real>* segments = target.segments;
  // The work of a segment is the integral of its rounded polynomial, so that work and torque agree to rounding.
  const auto work_J = [&](const Segment<Real>& s, double u) {
    double sum = 0;
    for (int i = kCurveDegree<Real>; i >= 0; --i) sum = static_cast<double>(s.c[i]) / (i + 1) + u * sum;
    return kRadPerDegree * u * sum;
  };
  double cycle_J = 0;
  for_each_segment(grid, [&](int index, int, double from, double to) {
    const Segment<Real>& slope = segments[index].slope;
    cycle_J += work_J(slope, to) - work_J(slope, from);
  });
  const double mean = cycle_J / kRadPerCycle;
  // Work less that of the mean torque is periodic. The first pass finds its range, the second sets the bases. The tick
  // integrates a segment from the start of its degree, also where the segment starts later: the base contains the
  // difference.
  const auto for_each_base = [&](const auto& visit) {
    double done_J = 0;
    for_each_segment(grid, [&](int index, int degree, double from, double to) {
      const Segment<Real>& slope = segments[index].slope;
      const double less_mean_J = done_J - mean * kRadPerDegree * (degree + from);
      visit(index, less_mean_J - (work_J(slope, from) - mean * kRadPerDegree * from));
      done_J += work_J(slope, to) - work_J(slope, from);
    });
  };
  double largest = 1e-30;
  for_each_base([&](int, double base_J) { largest = size(base_J) > largest ? size(base_J) : largest; });
  const double quantum = quantum_for<Real>(largest * 1.05);
  for_each_base([&](int index, double base_J) { segments[index].base = base_of<Real>(base_J, quantum); });
  target.torque->at = segments;
  target.torque->quantum = static_cast<Real>(quantum);
  target.torque->mean_Nm = static_cast<Real>(mean);
}

template <class Real>
double fill_torque(const EngineTorque& engine, const GasGrid& grid, Part first,
                   const std::array<TorqueTarget<Real>, kParts>& targets) noexcept {
  const double error = fill_grid<Real>(grid, engine, first, [&](int index, const auto& segment) {
    for (std::size_t part = 0; part < kParts; ++part) {
      if (targets[part].torque != nullptr) targets[part].segments[index].slope = segment[part];
    }
  });
  for (const TorqueTarget<Real>& target : targets) {
    if (target.torque != nullptr) fill_work(grid, target);
  }
  return error;
}

template <class Real>
void fill_pressures(const IndicatorDiagram& diagram, const TableTargets<Real>& targets, TableReport& report) noexcept {
  if (targets.gas_grid == nullptr) return;
  const CylinderPressure pressure(diagram);
  const Chosen chosen =
      choose_grid<Real>(*targets.gas_grid, pressure, kFull, targets.gas_capacity, kTolerance * diagram.peak_Pa());
  report.gas_segments = chosen.segments;
  report.tolerance_doublings = chosen.doublings;
  const std::array<Segment<Real>*, kParts> wanted{targets.pressure_full, targets.pressure_motored,
                                                  targets.pressure_heat};
  const double finest_Pa = fill_grid<Real>(*targets.gas_grid, pressure, kFull, [&](int index, const auto& segment) {
    for (std::size_t part = 0; part < kParts; ++part) {
      if (wanted[part] != nullptr) wanted[part][index] = segment[part];
    }
  });
  report.pressure_error_Pa = larger(chosen.error, finest_Pa);
}

template <class Real>
void fill_torques(const EngineTorque& engine, double peak_Pa, const TableTargets<Real>& targets,
                  TableReport& report) noexcept {
  if (targets.torque_grid == nullptr) return;
  const Chosen chosen = choose_grid<Real>(*targets.torque_grid, engine, kFull, targets.gas_capacity,
                                          kTolerance * engine.scale_Nm(peak_Pa));
  report.torque_segments = chosen.segments;
  report.torque_doublings = chosen.doublings;
  const double finest_Nm = fill_torque<Real>(engine, *targets.torque_grid, kFull,
                                             {{{targets.gas_torque_full, targets.gas_full},
                                               {targets.gas_torque_motored, targets.gas_motored},
                                               {targets.gas_torque_heat, targets.gas_heat}}});
  report.torque_error_Nm = larger(chosen.error, finest_Nm);
}

/// Fills the torque that a cylinder loses when it does not fire: that of its heat, over its own cycle.
template <class Real>
void fill_cut(const EngineDefinition& engine, const IndicatorDiagram& diagram, double peak_Pa,
              const TableTargets<Real>& targets, TableReport& report) noexcept {
  if (targets.cut_grid == nullptr) return;
  EngineDefinition one = engine;
  one.layout.cylinders = 1;
  one.layout.firing_deg[0] = 0;
  const EngineTorque torque(one, diagram);
  const Chosen chosen =
      choose_grid<Real>(*targets.cut_grid, torque, kHeat, targets.gas_capacity, kTolerance * torque.scale_Nm(peak_Pa));
  report.cut_segments = chosen.segments;
  report.cut_doublings = chosen.doublings;
  fill_torque<Real>(torque, *targets.cut_grid, kHeat, {{{}, {}, {targets.cut_torque, targets.cut_heat}}});
}

}  // namespace

template <class Real>
void fill_gas(const EngineDefinition& engine, const IndicatorDiagram& diagram, const TableTargets<Real>& targets,
              TableReport& report) noexcept {
  const double peak_Pa = diagram.peak_Pa();
  fill_pressures(diagram, targets, report);
  fill_torques(EngineTorque(engine, diagram), peak_Pa, targets, report);
  fill_cut(engine, diagram, peak_Pa, targets, report);
}

template void fill_gas(const EngineDefinition&, const IndicatorDiagram&, const TableTargets<float>&,
                       TableReport&) noexcept;
template void fill_gas(const EngineDefinition&, const IndicatorDiagram&, const TableTargets<double>&,
                       TableReport&) noexcept;

}  // namespace crankloop::detail
