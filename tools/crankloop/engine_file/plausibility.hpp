// Allowed but unlikely values in an engine file: warnings, after which the command continues.
//
// What belongs here: bounds of the usual. What does not: bounds of the possible (validate(), engine_file_keys.cpp).
#pragma once

#include <string>
#include <vector>

#include "engine_file.hpp"

namespace crankloop::program {

/// One line each: "FILE:LINE: warning: what is unusual; what is usual".
[[nodiscard]] std::vector<std::string> warnings_about(const EngineFile& engine);

/// The same of an engine whose gas makes its speed; `definition` is the file's, with the load it is to run with.
[[nodiscard]] std::vector<std::string> warnings_about_running_free(const EngineFile& engine,
                                                                   const EngineDefinition& definition);

/// Refuses an engine with gas exchange: what this command shows of the gas comes from a diagram.
void demand_a_diagram(const EngineFile& engine);

}  // namespace crankloop::program
