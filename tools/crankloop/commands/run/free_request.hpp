// The request for `crankloop run --free`, from its command line.
#pragma once

#include <string>
#include <vector>

#include "../../command_line/arguments.hpp"
#include "../../engine_file/engine_file.hpp"
#include "../../engine_file/gas_order.hpp"

namespace crankloop::program {

/// Throws UsageError for options of a free run without --free, and for those of a run at constant speed with it.
void require_options_that_fit(const Arguments& arguments);

/// The command, where --free is given; `gas`: with gas exchange; `warnings`: those that the file gave.
int run_free_by(const Arguments& arguments, const EngineFile& file, const GasOrder& gas,
                std::vector<std::string> warnings);

}  // namespace crankloop::program
