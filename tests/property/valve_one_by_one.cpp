// The runs of valve_lanes_run.hpp, compiled so that valves are stepped one by one whatever the processor has.
#define CRANKLOOP_ABREAST 0
#include "property/valve_lanes_run.hpp"

namespace crankloop::valve_lanes {

struct OneByOne {};
std::vector<LanesRun> runs_one_by_one(double tick_s) { return all_runs<OneByOne>(tick_s); }

}  // namespace crankloop::valve_lanes
