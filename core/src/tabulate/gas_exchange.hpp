// Tables of gas exchange and combustion from a definition.
#pragma once

#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// Refuses manifolds that are too small for the tick: in one tick more than 80 times their volume can flow through
/// their openings. `engine` must be valid otherwise.
Status validate_manifolds(const EngineDefinition& engine, double tick_s) noexcept;

/// Fills cylinders, ports, manifolds and burn; with zeros for an engine without gas exchange. `engine` must be valid.
template <class Real>
void fill_gas_exchange(const EngineDefinition& engine, const TickOptions& options,
                       const TableTargets<Real>& targets) noexcept;

}  // namespace crankloop::detail
