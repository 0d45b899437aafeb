// The source of an engine's cylinder pressure in words, for reports and summaries.
#pragma once

#include <string>

#include "engine_file.hpp"
#include "gas_order.hpp"

namespace crankloop::program {

/// How the pressure is synthesised, or the name of its table, or that there is none; and the effect of a load ratio.
/// For an engine with gas exchange: its settings, without the one that a map varies, and what is not modelled.
[[nodiscard]] std::string pressure_in_words(const EngineFile& file, double load_ratio, const GasOrder& gas,
                                            double GasOrder::*varied = nullptr);

/// The source in one line, for a summary.
[[nodiscard]] std::string pressure_in_short(const EngineFile& file);

}  // namespace crankloop::program
