// Allowed but unlikely values in an engine file: warnings, after which the command continues.
//
// What belongs here: usual ranges. What does not: permitted ranges (validate(), engine_file_key_list.hpp).
#pragma once

#include <string>
#include <vector>

#include "engine_file.hpp"
#include "gas_order.hpp"

namespace crankloop::program {

/// One line each: "FILE:LINE: warning: what is unusual; what is usual".
[[nodiscard]] std::vector<std::string> warnings_about(const EngineFile& engine);

/// Of a cylinder: what is unusual about its largest pressure; "" where nothing is.
[[nodiscard]] std::string unusual_peak(double peak_Pa);

/// Warnings about fuel and spark of the command line, where they are not the file's.
[[nodiscard]] std::vector<std::string> warnings_about_order(const EngineFile& engine, const GasOrder& order);

/// Warnings for a free-running engine; `definition` is the file's with the load of the run.
[[nodiscard]] std::vector<std::string> warnings_about_running_free(const EngineFile& engine,
                                                                   const EngineDefinition& definition);

/// Where a file has misfires, faults of wheels or faults of sensors, for commands whose scenes have none.
[[nodiscard]] std::vector<std::string> warnings_about_misfires_left_out(const EngineFile& engine);

/// Where it has faults of sensors, for commands whose scenes have misfires and faults of wheels alone.
[[nodiscard]] std::vector<std::string> warnings_about_sensor_faults_left_out(const EngineFile& engine);

/// Refuses an engine with gas exchange, for commands that need a pressure diagram.
void demand_a_diagram(const EngineFile& engine);

}  // namespace crankloop::program
