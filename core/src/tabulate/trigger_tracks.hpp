// Trigger wheels as the tick reads them.
#pragma once

#include <cstdint>

#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// Fills the angles of a wheel's edges, 2^32 = one turn, the first at 0; returns their number.
std::uint32_t fill_edges(const TriggerWheel& wheel, std::uint32_t* edges) noexcept;

/// A wheel with these edges.
[[nodiscard]] TriggerTrack track_of(const EngineDefinition& engine, const TickOptions& options,
                                    const TriggerWheel& wheel, const std::uint32_t* edges,
                                    std::uint32_t count) noexcept;

template <class Real>
void fill_triggers(const EngineDefinition& engine, const TickOptions& options,
                   const TableTargets<Real>& targets) noexcept;

}  // namespace crankloop::detail
