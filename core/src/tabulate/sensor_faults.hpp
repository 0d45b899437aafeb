// Faults of a controller's sensors, for the tick.
#pragma once

#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// Fills the target where it is asked for. The definition is valid.
template <class Real>
void fill_sensor_faults(const EngineDefinition& engine, const TickOptions& options,
                        const TableTargets<Real>& targets) noexcept;

}  // namespace crankloop::detail
