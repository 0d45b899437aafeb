// What the gas of an engine reads, from its definition.
#pragma once

#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// Fills cylinders, ports, manifolds and burn of an engine that breathes; of another, zeros. `engine` is valid.
template <class Real>
void fill_gas_exchange(const EngineDefinition& engine, const TableTargets<Real>& targets) noexcept;

}  // namespace crankloop::detail
