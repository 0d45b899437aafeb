// Tables of the contact of cam and follower.
#pragma once

#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// Fills the sections of cams whose lift fill_valves() has accepted and filled.
template <class Real>
void fill_contacts(const EngineDefinition& engine, const TableTargets<Real>& targets) noexcept;

}  // namespace crankloop::detail
