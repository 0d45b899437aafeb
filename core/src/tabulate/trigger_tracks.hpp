// The tick's tables of trigger wheels.
#pragma once

#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// Fills the trigger targets that are not null, from a valid definition.
template <class Real>
void fill_triggers(const EngineDefinition& engine, const TickOptions& options,
                   const TableTargets<Real>& targets) noexcept;

}  // namespace crankloop::detail
