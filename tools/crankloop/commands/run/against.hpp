// `crankloop run A --against B`: two engine files side by side.
//
// What belongs here: how two runs are shown together. What does not: the runs (run.cpp).
#pragma once

#include <string>

#include "../../command_line/summary.hpp"
#include "../../engine_file/engine_file.hpp"
#include "../../loops/run_trace.hpp"
#include "../../report/page.hpp"

namespace crankloop::program {

/// One of the two.
struct Side {
  const EngineFile& file;
  Summary figures;
  Trace trace{};  ///< for the page
};

/// The first's figures, each with the second's and how much that is more.
[[nodiscard]] Summary side_by_side(const Side& first, const Side& second);

[[nodiscard]] report::Page against_page(const Side& first, const Side& second, const std::string& command_line);

}  // namespace crankloop::program
