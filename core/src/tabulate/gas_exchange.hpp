// What the gas of an engine reads, from its definition.
#pragma once

#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// Refuses manifolds that are too small for the tick: whose openings could let through more than 80 times their volume
/// in one. `engine` is valid else.
Status validate_manifolds(const EngineDefinition& engine, double tick_s) noexcept;

/// Fills cylinders, ports, manifolds and burn of an engine with gas exchange; of another, zeros. `engine` is valid.
template <class Real>
void fill_gas_exchange(const EngineDefinition& engine, const TickOptions& options,
                       const TableTargets<Real>& targets) noexcept;

}  // namespace crankloop::detail
