// Gas pressure of a cylinder and gas torque of the engine over the cycle, each on a grid that is fine where the curve
// is steep.
#pragma once

#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// Chooses the grids and fills every gas target that is not null. `diagram` is initialised for `engine`.
template <class Real>
void fill_gas(const EngineDefinition& engine, const IndicatorDiagram& diagram, const TableTargets<Real>& targets,
              TableReport& report) noexcept;

}  // namespace crankloop::detail
