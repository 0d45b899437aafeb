// The definition's and the options' C form, and back; refused where an enumerator is none.
#pragma once

#include <cstddef>

#include <crankloop/c/arguments.hpp>
#include <crankloop/define/engine_definition.hpp>
#include <crankloop/tabulate/tabulate.hpp>

namespace crankloop::c {

[[nodiscard]] crankloop_definition as_c(const EngineDefinition& definition) noexcept;
Status from_c(const crankloop_definition& c, EngineDefinition& definition) noexcept;
[[nodiscard]] crankloop_options as_c(const TickOptions& options) noexcept;
Status from_c(const crankloop_options& c, TickOptions& options) noexcept;

/// Both at once, of any version.
Status take(EngineDefinition& definition, const crankloop_definition* from, std::size_t size) noexcept;
Status take(TickOptions& options, const crankloop_options* from, std::size_t size) noexcept;

}  // namespace crankloop::c
