// Faults of trigger wheels as the tick reads them.
#pragma once

#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// Refuses teeth that a wheel does not have or has no room for, and noise beyond one pulse of half a tick.
[[nodiscard]] Status validate_wheel_faults(const EngineDefinition& engine, const TickOptions& options) noexcept;

template <class Real>
void fill_wheel_faults(const EngineDefinition& engine, const TickOptions& options,
                       const TableTargets<Real>& targets) noexcept;

}  // namespace crankloop::detail
