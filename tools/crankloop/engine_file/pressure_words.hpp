// Where an engine's cylinder pressure comes from, in words: what reports and summaries must not leave open.
#pragma once

#include <string>

#include "engine_file.hpp"
#include "gas_order.hpp"

namespace crankloop::program {

/// Synthesised and how, from which table, or none; and what a load ratio makes of it. Of an engine that breathes: what
/// it was told (but for what a map varies), and what is not modelled.
[[nodiscard]] std::string pressure_in_words(const EngineFile& file, double load_ratio, const GasOrder& gas,
                                            double GasOrder::*varied = nullptr);

/// The same in a line of a summary.
[[nodiscard]] std::string pressure_in_short(const EngineFile& file);

}  // namespace crankloop::program
