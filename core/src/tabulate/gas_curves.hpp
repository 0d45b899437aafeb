// Gas pressure and gas torque over the cycle, on a grid that is fine where the pressure is steep.
#pragma once

#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// Chooses the grid and fills every gas target that is there. `diagram` is initialised for `engine`.
template <class Real>
void fill_gas(const EngineDefinition& engine, const IndicatorDiagram& diagram, const TableTargets<Real>& targets,
              TableReport& report) noexcept;

}  // namespace crankloop::detail
