// The tick's tables of valve lift and motion.
#pragma once

#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::detail {

/// Fills the valve targets that are not null. All trains are computed before the first is written, so a refusal leaves
/// the targets unchanged; its `index` is the train.
template <class Real>
Status fill_valves(const EngineDefinition& engine, const TickOptions& options, const TableTargets<Real>& targets,
                   TableReport& report) noexcept;

}  // namespace crankloop::detail
