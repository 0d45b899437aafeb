#include "gas_curves.hpp"

#include <array>
#include <cstddef>

#include "gas_grid.hpp"

namespace crankloop::detail {
namespace {

constexpr double kTolerance = 1e-5;  // of the peak pressure, and of its torque at a lever of the crank radius

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
