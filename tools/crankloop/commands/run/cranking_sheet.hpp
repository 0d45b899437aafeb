// `run --free --cranking F.svg`: a start as a controller with a variable reluctance sensor sees it.
//
// What belongs here: the drawing. What does not: the samples (loops/analogue_log.hpp).
#pragma once

#include <string>

#include "../../loops/analogue_log.hpp"
#include "../../report/sheet.hpp"

namespace crankloop::program {

/// Crank speed, voltage with the comparator's threshold, and both with its level around the first edges.
[[nodiscard]] report::Sheet cranking_sheet(const AnalogueTrace& trace, const std::string& title);

}  // namespace crankloop::program
