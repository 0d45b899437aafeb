#include "gas_curves.hpp"

#include <initializer_list>

#include <crankloop/tabulate/mechanism.hpp>

#include "curve_fit.hpp"

namespace crankloop::detail {
namespace {

constexpr int kDivisions[] = {1, 2, 5, 10, 20};  // of a degree; 0.1 deg data has its points on the borders of 10 and 20
constexpr int kSamplesPerSegment = 10;
constexpr double kPressureTolerance = 1e-5;      // of the peak pressure
constexpr int kMostDoublings = 20;               // of the tolerance: beyond the peak pressure, so one segment a degree

[[nodiscard]] double size(double x) noexcept { return x < 0 ? -x : x; }

/// One of the curves that share the grid: pressure in Pa over crank degrees.
enum class Part { full, motored, heat };
[[nodiscard]] double pressure(const IndicatorDiagram& diagram, Part part, double deg) noexcept {
  switch (part) {
    case Part::full: break;
    case Part::motored: return diagram.motored_Pa(deg);
    case Part::heat: return diagram.heat_Pa(deg);
  }
  return diagram.full_Pa(deg);
}

/// Pressure within one segment: through both ends, so that the curve has no steps, with the curvature that meets the middle, limited to what
/// keeps the segment monotone where the diagram is: no overshoot between given points.
template <class Real, class Function>
[[nodiscard]] Polynomial<kCoefficients<Real>> fitted_pressure(double from, double to, const Function& f) noexcept {
  const double start = f(from);
  const double end = f(to);
  const double middle = f((from + to) / 2);
  const double rise = end - start;
  double bulge = 4 * middle - 2 * (start + end);  // p(t) = start + rise t + bulge t (1 - t), t = 0 to 1
  const double most = size(rise);
  const double sign = rise < 0 ? -1 : 1;
  const double quarter = f(from + 0.25 * (to - from));
  const double three_quarters = f(from + 0.75 * (to - from));
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

/// Largest error of a pressure curve in one degree when it is divided into n segments.
template <class Real>
[[nodiscard]] double degree_error_Pa(const IndicatorDiagram& diagram, Part part, int degree, int n) noexcept {
  const auto f = [&](double u) { return pressure(diagram, part, degree + u); };
  double largest = 0;
  for (int i = 0; i < n; ++i) {
    const double from = static_cast<double>(i) / n;
    const double to = static_cast<double>(i + 1) / n;
    const Segment<Real> segment = rounded<Real>(fitted_pressure<Real>(from, to, f));
    for (int sample = 0; sample <= kSamplesPerSegment; ++sample) {
      const double u = from + (to - from) * sample / kSamplesPerSegment;
      const double error = size(static_cast<double>(value(segment, static_cast<Real>(u))) - f(u));
      if (error > largest) largest = error;
    }
  }
  return largest;
}

/// How a degree is divided: the fewest segments that keep every pressure within the tolerance, and the largest error then.
struct Division {
  int segments;
  double error_Pa;
};
template <class Real>
[[nodiscard]] Division divide(const IndicatorDiagram& diagram, int degree, double tolerance_Pa) noexcept {
  Division division{1, 0};
  for (const int n : kDivisions) {
    division = {n, 0};
    for (const Part part : {Part::full, Part::motored, Part::heat}) {
      const double error = degree_error_Pa<Real>(diagram, part, degree, n);
      if (error > division.error_Pa) division.error_Pa = error;
    }
    if (division.error_Pa <= tolerance_Pa) break;
  }
  return division;
}

template <class Real>
void choose_grid(const IndicatorDiagram& diagram, GasGrid& grid, int capacity, TableReport& report) noexcept {
  double peak_Pa = 0;
  for (int i = 0; i < 10 * kDegreesPerCycle; ++i) {
    const double p = diagram.full_Pa(i / 10.0);
    if (p > peak_Pa) peak_Pa = p;
  }
  double tolerance_Pa = kPressureTolerance * peak_Pa;
  for (int doublings = 0; doublings <= kMostDoublings; ++doublings) {
    report = {};
    report.tolerance_doublings = doublings;
    for (int degree = 0; degree < kDegreesPerCycle; ++degree) {
      const Division division = divide<Real>(diagram, degree, tolerance_Pa);
      grid.first[degree] = static_cast<std::uint16_t>(report.gas_segments);
      report.gas_segments += division.segments;
      if (division.error_Pa > report.pressure_error_Pa) report.pressure_error_Pa = division.error_Pa;
    }
    grid.first[kDegreesPerCycle] = static_cast<std::uint16_t>(report.gas_segments);
    if (report.gas_segments <= capacity) return;
    tolerance_Pa *= 2;
  }
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

/// Fills a gas torque curve and its work; returns nothing, cannot fail.
template <class Real>
void fill_torque(const EngineDefinition& engine, const IndicatorDiagram& diagram, const GasGrid& grid, Part part, int copies,
                 GasTorque<Real>& torque, IntegratedSegment<Real>* segments) noexcept {
  const double area = bore_area_m2(engine.crank);
  const double back_Pa = part == Part::heat ? 0 : engine.pressure.crankcase_Pa;  // the heat comes on top of the motored pressure
  // The work of a segment is that of its own rounded polynomial, so that work and torque belong together to rounding.
  const auto work_J = [&](const Segment<Real>& s, double u) {
    double sum = 0;
    for (int i = kCurveDegree<Real>; i >= 0; --i) sum = static_cast<double>(s.c[i]) / (i + 1) + u * sum;
    return kRadPerDegree * u * sum;
  };
  double cycle_J = 0;
  for_each_segment(grid, [&](int index, int degree, double from, double to) {
    Segment<Real>& slope = segments[index].slope;
    slope = rounded<Real>(fitted<Real>(from, to, [&](double u) {
      const double deg = degree + u;
      return (pressure(diagram, part, deg) - back_Pa) * area * exact_pose(engine.crank, deg * kRadPerDegree).slope_m;
    }));
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
  const double quantum = quantum_for<Real>(largest * 1.05, copies);
  for_each_base([&](int index, double base_J) { segments[index].base = base_of<Real>(base_J, quantum); });
  torque.at = segments;
  torque.quantum = static_cast<Real>(quantum);
  torque.mean_Nm = static_cast<Real>(mean);
}

}  // namespace

template <class Real>
void fill_gas(const EngineDefinition& engine, const IndicatorDiagram& diagram, const TableTargets<Real>& targets,
              TableReport& report) noexcept {
  if (targets.gas_grid == nullptr) return;
  const GasGrid& grid = *targets.gas_grid;
  choose_grid<Real>(diagram, *targets.gas_grid, targets.gas_capacity, report);

  const auto fill_pressure = [&](Segment<Real>* segments, Part part) {
    if (segments == nullptr) return;
    for_each_segment(grid, [&](int index, int degree, double from, double to) {
      segments[index] = rounded<Real>(fitted_pressure<Real>(from, to, [&](double u) { return pressure(diagram, part, degree + u); }));
    });
  };
  fill_pressure(targets.pressure_full, Part::full);
  fill_pressure(targets.pressure_motored, Part::motored);
  fill_pressure(targets.pressure_heat, Part::heat);

  const int copies = engine.layout.cylinders;
  const auto fill_gas_torque = [&](GasTorque<Real>* torque, IntegratedSegment<Real>* segments, Part part) {
    if (torque != nullptr) fill_torque(engine, diagram, grid, part, copies, *torque, segments);
  };
  fill_gas_torque(targets.gas_torque_full, targets.gas_full, Part::full);
  fill_gas_torque(targets.gas_torque_motored, targets.gas_motored, Part::motored);
  fill_gas_torque(targets.gas_torque_heat, targets.gas_heat, Part::heat);
}

template void fill_gas(const EngineDefinition&, const IndicatorDiagram&, const TableTargets<float>&, TableReport&) noexcept;
template void fill_gas(const EngineDefinition&, const IndicatorDiagram&, const TableTargets<double>&, TableReport&) noexcept;

}  // namespace crankloop::detail
