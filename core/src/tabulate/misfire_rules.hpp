// Rules of misfiring cycles as the tick reads them.
#pragma once

#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

template <class Real>
void fill_misfires(const EngineDefinition& engine, const TableTargets<Real>& targets) noexcept;

}  // namespace crankloop::detail
