// The table of a variable reluctance sensor.
#pragma once

#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// Of a validated definition.
template <class Real>
void fill_reluctor(const EngineDefinition& engine, const TickOptions& options,
                   const TableTargets<Real>& targets) noexcept;

}  // namespace crankloop::detail
