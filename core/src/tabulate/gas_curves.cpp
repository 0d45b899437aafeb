#include "gas_curves.hpp"

#include <cstddef>
#include <initializer_list>

#include <crankloop/tabulate/mechanism.hpp>

#include "curve_fit.hpp"

namespace crankloop::detail {
namespace {

constexpr int kDivisions[] = {1, 2, 5, 10, 20};  // of a degree; 0.1 deg data has its points on the borders of 10 and 20
constexpr int kSamplesPerSegment = 10;
constexpr double kTolerance = 1e-5;              // of the peak pressure, and of the torque that it has on the crank radius
constexpr int kMostDoublings = 20;               // of the tolerance: beyond the peak pressure, so one segment a degree

[[nodiscard]] double size(double x) noexcept { return x < 0 ? -x : x; }

/// One of the curves that share a grid.
enum class Part { full, motored, heat };
constexpr Part kParts[] = {Part::full, Part::motored, Part::heat};

/// Pressure in Pa over crank degrees.
[[nodiscard]] double pressure(const IndicatorDiagram& diagram, Part part, double deg) noexcept {
  switch (part) {
    case Part::full: break;
    case Part::motored: return diagram.motored_Pa(deg);
    case Part::heat: return diagram.heat_Pa(deg);
  }
  return diagram.full_Pa(deg);
}

/// Gas torque of all cylinders in Nm over engine degrees.
class EngineTorque {
 public:
  EngineTorque(const EngineDefinition& engine, const IndicatorDiagram& diagram) noexcept
      : engine_{engine}, diagram_{diagram}, area_m2_{bore_area_m2(engine.crank)} {}

  [[nodiscard]] double torque_Nm(Part part, double deg) const noexcept {
    const double back_Pa = part == Part::heat ? 0 : engine_.pressure.crankcase_Pa;  // the heat comes on top of the motored pressure
    double sum = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(engine_.layout.cylinders); ++k) {
      double own_deg = deg - engine_.layout.firing_deg[k];
      if (own_deg < 0) own_deg += kDegreesPerCycle;
      const double slope_m = exact_pose(engine_.crank, own_deg * kRadPerDegree).slope_m;
      sum += (pressure(diagram_, part, own_deg) - back_Pa) * area_m2_ * slope_m;
    }
    return sum;
  }

  /// Of a pressure on one piston, with the crank radius as its lever.
  [[nodiscard]] double scale_Nm(double pressure_Pa) const noexcept { return pressure_Pa * area_m2_ * engine_.crank.crank_radius_m; }

 private:
  const EngineDefinition& engine_;
  const IndicatorDiagram& diagram_;
  double area_m2_;
};

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

template <class Real>
[[nodiscard]] Segment<Real> pressure_segment(const IndicatorDiagram& diagram, Part part, int degree, double from, double to) noexcept {
  return rounded<Real>(fitted_pressure<Real>(from, to, [&](double u) { return pressure(diagram, part, degree + u); }));
}
template <class Real>
[[nodiscard]] Segment<Real> torque_segment(const EngineTorque& engine, Part part, int degree, double from, double to) noexcept {
  return rounded<Real>(fitted<Real>(from, to, [&](double u) { return engine.torque_Nm(part, degree + u); }));
}

/// Largest error of segment_of(from, to) against f(u) in a degree that is divided into n segments.
template <class Real, class SegmentOf, class Function>
[[nodiscard]] double degree_error(int n, const SegmentOf& segment_of, const Function& f) noexcept {
  double largest = 0;
  for (int i = 0; i < n; ++i) {
    const double from = static_cast<double>(i) / n;
    const double to = static_cast<double>(i + 1) / n;
    const Segment<Real> segment = segment_of(from, to);
    for (int sample = 0; sample <= kSamplesPerSegment; ++sample) {
      const double u = from + (to - from) * sample / kSamplesPerSegment;
      const double error = size(static_cast<double>(value(segment, static_cast<Real>(u))) - f(u));
      if (error > largest) largest = error;
    }
  }
  return largest;
}

/// What a grid came to.
struct Chosen {
  int segments;
  int doublings;  ///< of the tolerance
  double error;   ///< largest
};

/// Divides each degree into the fewest segments that keep error(part, degree, segments) within the tolerance for every part; the tolerance is
/// doubled until they all fit.
template <class Parts, class Error>
[[nodiscard]] Chosen choose_grid(GasGrid& grid, const Parts& parts, int capacity, double tolerance, const Error& error) noexcept {
  Chosen chosen{};
  for (int doublings = 0; doublings <= kMostDoublings; ++doublings, tolerance *= 2) {
    chosen = {0, doublings, 0};
    for (int degree = 0; degree < kDegreesPerCycle; ++degree) {
      grid.first[degree] = static_cast<std::uint16_t>(chosen.segments);
      int segments = 0;
      double worst = 0;
      for (const int n : kDivisions) {
        segments = n;
        worst = 0;
        for (const Part part : parts) {
          const double of_part = error(part, degree, n);
          if (of_part > worst) worst = of_part;
        }
        if (worst <= tolerance) break;
      }
      chosen.segments += segments;
      if (worst > chosen.error) chosen.error = worst;
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

/// Fills a gas torque curve and its work; returns nothing, cannot fail.
template <class Real>
void fill_torque(const EngineTorque& engine, const GasGrid& grid, Part part, GasTorque<Real>& torque,
                 IntegratedSegment<Real>* segments) noexcept {
  // The work of a segment is that of its own rounded polynomial, so that work and torque belong together to rounding.
  const auto work_J = [&](const Segment<Real>& s, double u) {
    double sum = 0;
    for (int i = kCurveDegree<Real>; i >= 0; --i) sum = static_cast<double>(s.c[i]) / (i + 1) + u * sum;
    return kRadPerDegree * u * sum;
  };
  double cycle_J = 0;
  for_each_segment(grid, [&](int index, int degree, double from, double to) {
    Segment<Real>& slope = segments[index].slope;
    slope = torque_segment<Real>(engine, part, degree, from, to);
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
  torque.at = segments;
  torque.quantum = static_cast<Real>(quantum);
  torque.mean_Nm = static_cast<Real>(mean);
}

template <class Real>
void fill_pressures(const IndicatorDiagram& diagram, double peak_Pa, const TableTargets<Real>& targets, TableReport& report) noexcept {
  if (targets.gas_grid == nullptr) return;
  const Chosen chosen = choose_grid(*targets.gas_grid, kParts, targets.gas_capacity, kTolerance * peak_Pa, [&](Part part, int degree, int n) {
    return degree_error<Real>(
        n, [&](double from, double to) { return pressure_segment<Real>(diagram, part, degree, from, to); },
        [&](double u) { return pressure(diagram, part, degree + u); });
  });
  report.gas_segments = chosen.segments;
  report.tolerance_doublings = chosen.doublings;
  report.pressure_error_Pa = chosen.error;
  const auto fill = [&](Segment<Real>* segments, Part part) {
    if (segments == nullptr) return;
    for_each_segment(*targets.gas_grid, [&](int index, int degree, double from, double to) {
      segments[index] = pressure_segment<Real>(diagram, part, degree, from, to);
    });
  };
  fill(targets.pressure_full, Part::full);
  fill(targets.pressure_motored, Part::motored);
  fill(targets.pressure_heat, Part::heat);
}

template <class Real>
void fill_torques(const EngineTorque& engine, double peak_Pa, const TableTargets<Real>& targets, TableReport& report) noexcept {
  if (targets.torque_grid == nullptr) return;
  const Chosen chosen = choose_grid(*targets.torque_grid, kParts, targets.gas_capacity, kTolerance * engine.scale_Nm(peak_Pa), [&](Part part, int degree, int n) {
    return degree_error<Real>(
        n, [&](double from, double to) { return torque_segment<Real>(engine, part, degree, from, to); },
        [&](double u) { return engine.torque_Nm(part, degree + u); });
  });
  report.torque_segments = chosen.segments;
  report.torque_doublings = chosen.doublings;
  report.torque_error_Nm = chosen.error;
  const auto fill = [&](GasTorque<Real>* torque, IntegratedSegment<Real>* segments, Part part) {
    if (torque != nullptr) fill_torque(engine, *targets.torque_grid, part, *torque, segments);
  };
  fill(targets.gas_torque_full, targets.gas_full, Part::full);
  fill(targets.gas_torque_motored, targets.gas_motored, Part::motored);
  fill(targets.gas_torque_heat, targets.gas_heat, Part::heat);
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
  constexpr Part kHeat[] = {Part::heat};
  const Chosen chosen = choose_grid(*targets.cut_grid, kHeat, targets.gas_capacity, kTolerance * torque.scale_Nm(peak_Pa), [&](Part part, int degree, int n) {
    return degree_error<Real>(
        n, [&](double from, double to) { return torque_segment<Real>(torque, part, degree, from, to); },
        [&](double u) { return torque.torque_Nm(part, degree + u); });
  });
  report.cut_segments = chosen.segments;
  report.cut_doublings = chosen.doublings;
  if (targets.cut_torque != nullptr) fill_torque(torque, *targets.cut_grid, Part::heat, *targets.cut_torque, targets.cut_heat);
}

}  // namespace

template <class Real>
void fill_gas(const EngineDefinition& engine, const IndicatorDiagram& diagram, const TableTargets<Real>& targets,
              TableReport& report) noexcept {
  double peak_Pa = 0;
  for (int i = 0; i < 10 * kDegreesPerCycle; ++i) {
    const double p = diagram.full_Pa(i / 10.0);
    if (p > peak_Pa) peak_Pa = p;
  }
  fill_pressures(diagram, peak_Pa, targets, report);
  fill_torques(EngineTorque(engine, diagram), peak_Pa, targets, report);
  fill_cut(engine, diagram, peak_Pa, targets, report);
}

template void fill_gas(const EngineDefinition&, const IndicatorDiagram&, const TableTargets<float>&, TableReport&) noexcept;
template void fill_gas(const EngineDefinition&, const IndicatorDiagram&, const TableTargets<double>&, TableReport&) noexcept;

}  // namespace crankloop::detail
