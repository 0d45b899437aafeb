#include "gas_curves.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#include <crankloop/tabulate/mechanism.hpp>

#include "curve_fit.hpp"

namespace crankloop::detail {
namespace {

constexpr std::size_t kDivisionCount = 5;
constexpr int kDivisions[kDivisionCount] = {1, 2, 5, 10, 20};  // of a degree; 0.1 deg data has its points on the borders of 10 and 20
constexpr int kFinest = kDivisions[kDivisionCount - 1];
constexpr int kSamplesPerSegment = 10;
constexpr int kSamplesPerFinest = 5;             // nothing is decided by them: there is no finer division
constexpr double kTolerance = 1e-5;              // of the peak pressure, and of the torque that it has on the crank radius
constexpr double kWhateverItIs = 1e300;          // no error is larger
constexpr int kMostDoublings = 20;               // of the tolerance: beyond the peak pressure, so one segment a degree

[[nodiscard]] double size(double x) noexcept { return x < 0 ? -x : x; }

/// What the curves that share a grid are at one angle: pressures in Pa or torques in Nm, in this order everywhere.
enum Part { kFull, kMotored, kHeat };
constexpr int kParts = 3;
using AllParts = std::array<double, kParts>;

/// A cylinder's pressure over its own crank degrees.
class CylinderPressure {
 public:
  explicit CylinderPressure(const IndicatorDiagram& diagram) noexcept : diagram_{diagram} {}

  [[nodiscard]] AllParts at(double deg) const noexcept {
    const IndicatorDiagram::Pressures p = diagram_.pressures(deg);
    return {p.full_Pa, p.motored_Pa, p.heat_Pa};
  }
  [[nodiscard]] static int period_deg() noexcept { return kDegreesPerCycle; }

 private:
  const IndicatorDiagram& diagram_;
};

/// Gas torque of all cylinders over engine degrees.
class EngineTorque {
 public:
  EngineTorque(const EngineDefinition& engine, const IndicatorDiagram& diagram) noexcept
      : engine_{engine}, diagram_{diagram}, area_m2_{bore_area_m2(engine.crank)} {}

  [[nodiscard]] AllParts at(double deg) const noexcept {
    AllParts sum{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(engine_.layout.cylinders); ++k) {
      double own_deg = deg - engine_.layout.firing_deg[k];
      if (own_deg < 0) own_deg += kDegreesPerCycle;
      const auto [displacement_m, slope_m] = exact_stroke(engine_.crank, own_deg * kRadPerDegree);
      const IndicatorDiagram::Pressures p = diagram_.pressures(own_deg, displacement_m);
      const double back_Pa = engine_.pressure.crankcase_Pa;
      sum[kFull] += (p.full_Pa - back_Pa) * area_m2_ * slope_m;
      sum[kMotored] += (p.motored_Pa - back_Pa) * area_m2_ * slope_m;
      sum[kHeat] += p.heat_Pa * area_m2_ * slope_m;  // the heat comes on top of the motored pressure
    }
    return sum;
  }

  /// Whole degrees after which the torque repeats, because each cylinder then stands where another stood: 720 / cylinders of an evenly firing
  /// engine, if that is a whole number.
  [[nodiscard]] int period_deg() const noexcept {
    for (int deg = 1; deg < kDegreesPerCycle; ++deg) {
      if (kDegreesPerCycle % deg == 0 && repeats_after(deg)) return deg;
    }
    return kDegreesPerCycle;
  }

  /// Of a pressure on one piston, with the crank radius as its lever.
  [[nodiscard]] double scale_Nm(double pressure_Pa) const noexcept { return pressure_Pa * area_m2_ * engine_.crank.crank_radius_m; }

 private:
  [[nodiscard]] int firing_at(double deg) const noexcept {
    int count = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(engine_.layout.cylinders); ++k) count += engine_.layout.firing_deg[k] == deg ? 1 : 0;
    return count;
  }
  [[nodiscard]] bool repeats_after(int deg) const noexcept {
    for (std::size_t k = 0; k < static_cast<std::size_t>(engine_.layout.cylinders); ++k) {
      const double here = engine_.layout.firing_deg[k];
      const double there = here + deg < kDegreesPerCycle ? here + deg : here + deg - kDegreesPerCycle;
      if (firing_at(there) != firing_at(here)) return false;
    }
    return true;
  }

  const EngineDefinition& engine_;
  const IndicatorDiagram& diagram_;
  double area_m2_;
};

constexpr std::size_t kPressurePlaces = 5;  // ends and quarters

/// A pressure within one segment, of which `values` are those at its ends and quarters: through both ends, so that the curve has no steps, with
/// the curvature that meets the middle, limited to what keeps the segment monotone where the diagram is: no overshoot between given points.
template <class Real>
[[nodiscard]] Polynomial<kCoefficients<Real>> fitted_pressure(double from, double to, const double (&values)[kPressurePlaces]) noexcept {
  const auto [start, quarter, middle, three_quarters, end] = values;
  const double rise = end - start;
  double bulge = 4 * middle - 2 * (start + end);  // p(t) = start + rise t + bulge t (1 - t), t = 0 to 1
  const double most = size(rise);
  const double sign = rise < 0 ? -1 : 1;
  const auto not_falling = [sign](double a, double b) { return sign * b >= sign * a; };
  const bool monotone = not_falling(start, quarter) && not_falling(quarter, middle) && not_falling(middle, three_quarters) &&
                        not_falling(three_quarters, end);
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

/// All parts' segments between two parts of a degree.
template <class Real>
using AllSegments = std::array<Segment<Real>, kParts>;

template <class Real>
[[nodiscard]] AllSegments<Real> segments_of(const CylinderPressure& pressure, int degree, double from, double to) noexcept {
  const double places[kPressurePlaces] = {from, from + 0.25 * (to - from), (from + to) / 2, from + 0.75 * (to - from), to};
  double values[kParts][kPressurePlaces];
  for (std::size_t i = 0; i < kPressurePlaces; ++i) {
    const AllParts p = pressure.at(degree + places[i]);
    for (std::size_t part = 0; part < kParts; ++part) values[part][i] = p[part];
  }
  AllSegments<Real> segments;
  for (std::size_t part = 0; part < kParts; ++part) segments[part] = rounded<Real>(fitted_pressure<Real>(from, to, values[part]));
  return segments;
}
template <class Real>
[[nodiscard]] AllSegments<Real> segments_of(const EngineTorque& torque, int degree, double from, double to) noexcept {
  double places[kCoefficients<Real>];
  double values[kParts][kCoefficients<Real>];
  for (std::size_t i = 0; i < kCoefficients<Real>; ++i) {
    places[i] = node<Real>(i, from, to);
    const AllParts t = torque.at(degree + places[i]);
    for (std::size_t part = 0; part < kParts; ++part) values[part][i] = t[part];
  }
  AllSegments<Real> segments;
  for (std::size_t part = 0; part < kParts; ++part) segments[part] = rounded<Real>(through(places, values[part]));
  return segments;
}

/// Largest error of any of the parts from `first` on in a degree that is divided into n segments; the first that exceeds `limit` is answer enough.
template <class Real, class Quantity>
[[nodiscard]] double degree_error(const Quantity& quantity, Part first, int degree, int n, double limit) noexcept {
  const int samples = n < kFinest ? kSamplesPerSegment : kSamplesPerFinest;
  double largest = 0;
  for (int i = 0; i < n; ++i) {
    const double from = static_cast<double>(i) / n;
    const double to = static_cast<double>(i + 1) / n;
    const AllSegments<Real> segments = segments_of<Real>(quantity, degree, from, to);
    for (int sample = 0; sample <= samples; ++sample) {
      const double u = from + (to - from) * sample / samples;
      const AllParts exact = quantity.at(degree + u);
      for (std::size_t part = first; part < kParts; ++part) {
        const double error = size(static_cast<double>(value(segments[part], static_cast<Real>(u))) - exact[part]);
        if (error > largest) largest = error;
      }
      if (largest > limit) return largest;
    }
  }
  return largest;
}

/// degree_error() of each degree and division, as far as it was asked for: the search for a tolerance asks again and again, and a quantity that
/// repeats within the cycle has the same errors in each of its periods. 29 kB.
template <class Real, class Quantity>
class GridErrors {
 public:
  GridErrors(const Quantity& quantity, Part first) noexcept : quantity_{quantity}, first_{first}, period_deg_{quantity.period_deg()} {}

  /// The error, or a smaller number that exceeds `limit` as well.
  [[nodiscard]] double operator()(int degree, std::size_t division, double limit) noexcept {
    const int in_period = degree % period_deg_;
    double& known = errors_[in_period][division];
    if (known <= 0 && -known <= limit) {
      const double error = degree_error<Real>(quantity_, first_, in_period, kDivisions[division], limit);
      known = error > limit ? -error : error;
    }
    return size(known);
  }

 private:
  const Quantity& quantity_;
  Part first_;
  int period_deg_;
  double errors_[kDegreesPerCycle][kDivisionCount] = {};  ///< negative: at least this much; 0: not yet known, or none
};

/// What a grid came to.
struct Chosen {
  int segments;
  int doublings;  ///< of the tolerance
  double error;   ///< largest
};

/// Divides each degree into the fewest segments that keep the parts from `first` on within the tolerance; the tolerance is doubled until they
/// all fit.
template <class Real, class Quantity>
[[nodiscard]] Chosen choose_grid(GasGrid& grid, const Quantity& quantity, Part first, int capacity, double tolerance) noexcept {
  GridErrors<Real, Quantity> error(quantity, first);
  Chosen chosen{};
  for (int doublings = 0; doublings <= kMostDoublings; ++doublings, tolerance *= 2) {
    chosen = {0, doublings, 0};
    for (int degree = 0; degree < kDegreesPerCycle; ++degree) {
      grid.first[degree] = static_cast<std::uint16_t>(chosen.segments);
      std::size_t division = 0;
      while (division + 1 < kDivisionCount && error(degree, division, tolerance) > tolerance) ++division;
      chosen.segments += kDivisions[division];
      const double left = error(degree, division, kWhateverItIs);
      if (left > chosen.error) chosen.error = left;
    }
    grid.first[kDegreesPerCycle] = static_cast<std::uint16_t>(chosen.segments);
    if (chosen.segments <= capacity) break;
  }
  return chosen;
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

/// A gas torque and its segments, where the caller wants them.
template <class Real>
struct TorqueTarget {
  GasTorque<Real>* torque = nullptr;
  IntegratedSegment<Real>* segments = nullptr;
};

/// Fills a gas torque from its segments' slopes: their integrals; cannot fail.
template <class Real>
void fill_work(const GasGrid& grid, const TorqueTarget<Real>& target) noexcept {
  IntegratedSegment<Real>* segments = target.segments;
  // The work of a segment is that of its own rounded polynomial, so that work and torque belong together to rounding.
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
  // Work less that of the mean torque repeats from cycle to cycle. First its range, then the counts.
  // The tick adds a segment's integral from the whole degree's start, where a steep segment's polynomial may be far away: the base is
  // what is missing to it.
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
void fill_torque(const EngineTorque& engine, const GasGrid& grid, const std::array<TorqueTarget<Real>, kParts>& targets) noexcept {
  for_each_segment(grid, [&](int index, int degree, double from, double to) {
    const AllSegments<Real> segments = segments_of<Real>(engine, degree, from, to);
    for (std::size_t part = 0; part < kParts; ++part) {
      if (targets[part].torque != nullptr) targets[part].segments[index].slope = segments[part];
    }
  });
  for (const TorqueTarget<Real>& target : targets) {
    if (target.torque != nullptr) fill_work(grid, target);
  }
}

template <class Real>
void fill_pressures(const IndicatorDiagram& diagram, const TableTargets<Real>& targets, TableReport& report) noexcept {
  if (targets.gas_grid == nullptr) return;
  const CylinderPressure pressure(diagram);
  const Chosen chosen = choose_grid<Real>(*targets.gas_grid, pressure, kFull, targets.gas_capacity, kTolerance * diagram.peak_Pa());
  report.gas_segments = chosen.segments;
  report.tolerance_doublings = chosen.doublings;
  report.pressure_error_Pa = chosen.error;
  const std::array<Segment<Real>*, kParts> wanted{targets.pressure_full, targets.pressure_motored, targets.pressure_heat};
  if (wanted == std::array<Segment<Real>*, kParts>{}) return;
  for_each_segment(*targets.gas_grid, [&](int index, int degree, double from, double to) {
    const AllSegments<Real> segments = segments_of<Real>(pressure, degree, from, to);
    for (std::size_t part = 0; part < kParts; ++part) {
      if (wanted[part] != nullptr) wanted[part][index] = segments[part];
    }
  });
}

template <class Real>
void fill_torques(const EngineTorque& engine, double peak_Pa, const TableTargets<Real>& targets, TableReport& report) noexcept {
  if (targets.torque_grid == nullptr) return;
  const Chosen chosen = choose_grid<Real>(*targets.torque_grid, engine, kFull, targets.gas_capacity, kTolerance * engine.scale_Nm(peak_Pa));
  report.torque_segments = chosen.segments;
  report.torque_doublings = chosen.doublings;
  report.torque_error_Nm = chosen.error;
  fill_torque<Real>(engine, *targets.torque_grid,
                    {{{targets.gas_torque_full, targets.gas_full},
                      {targets.gas_torque_motored, targets.gas_motored},
                      {targets.gas_torque_heat, targets.gas_heat}}});
}

/// What a cylinder that does not fire lacks: the torque of its heat, over its own cycle.
template <class Real>
void fill_cut(const EngineDefinition& engine, const IndicatorDiagram& diagram, double peak_Pa, const TableTargets<Real>& targets,
              TableReport& report) noexcept {
  if (targets.cut_grid == nullptr) return;
  EngineDefinition one = engine;
  one.layout.cylinders = 1;
  one.layout.firing_deg[0] = 0;
  const EngineTorque torque(one, diagram);
  const Chosen chosen = choose_grid<Real>(*targets.cut_grid, torque, kHeat, targets.gas_capacity, kTolerance * torque.scale_Nm(peak_Pa));
  report.cut_segments = chosen.segments;
  report.cut_doublings = chosen.doublings;
  fill_torque<Real>(torque, *targets.cut_grid, {{{}, {}, {targets.cut_torque, targets.cut_heat}}});
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

template void fill_gas(const EngineDefinition&, const IndicatorDiagram&, const TableTargets<float>&, TableReport&) noexcept;
template void fill_gas(const EngineDefinition&, const IndicatorDiagram&, const TableTargets<double>&, TableReport&) noexcept;

}  // namespace crankloop::detail
