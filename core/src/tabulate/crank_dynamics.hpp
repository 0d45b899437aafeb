// Tables of the crank's inertia, friction, load and starter.
//
// What belongs here: the numbers of CrankDynamics from a definition. What does not: curves over the angle
// (tabulate.cpp, gas_curves.hpp).
#pragma once

#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// A tick refuses a higher input speed and limits an integrated speed to it.
[[nodiscard]] double speed_limit_rad_s(const EngineDefinition& engine, const TickOptions& options) noexcept;

/// Largest rotation of the crank in a tick, in either direction, including rounding.
[[nodiscard]] double widest_turn_deg(const EngineDefinition& engine, const TickOptions& options) noexcept;

/// `engine` and `options` are valid.
template <class Real>
[[nodiscard]] CrankDynamics<Real> crank_dynamics_of(const EngineDefinition& engine,
                                                    const TickOptions& options) noexcept;

}  // namespace crankloop::detail
