// The flow area of a valve train of an engine file, and its lines in the summaries of `lift` and `valve`.
//
// What belongs here: names and order of the lines. What does not: the figures (flow_area.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../command_line/summary.hpp"
#include "../engine_file/engine_file.hpp"
#include "flow_area.hpp"

namespace crankloop::program {

/// None where the file gives no diameter of the valve.
[[nodiscard]] std::optional<FlowArea> flow_area_of(const TrainOfFile& train);

/// Dimensions and coefficients that the file does not give: "seat_angle_deg = 45, ..."; "": none.
[[nodiscard]] std::string assumed_of(const TrainOfFile& train);

/// By its port, or where the file has none by its name.
[[nodiscard]] bool is_exhaust(const TrainOfFile& train) noexcept;

/// What is assumed, or why there is no flow area.
[[nodiscard]] std::string flow_remark(const TrainOfFile& train);

/// The same as lines of a picture that shows a flow area; none where nothing is assumed.
void add_flow_remarks(std::vector<std::string>& remarks, const TrainOfFile& train);

/// Open period, integrals and means; names start with `prefix`.
void add_flow(Summary& s, const std::string& prefix, const FlowIntegrals& flow);

/// Of the other trains of the port, by their theoretical lift, the valves in a cylinder: their number and area. No
/// value where the file gives too little for the area of one.
struct OtherValves {
  int count = 0;
  PortArea area{};
};
[[nodiscard]] std::optional<OtherValves> valves_beside(const EngineFile& file, const TrainOfFile& train);

/// Area over displacement, gas speed and, of an intake, the Mach index; nothing without [crank], speeds only where the
/// speed is known.
void add_flow_figures(Summary& s, const FlowIntegrals& flow, const EngineFile& file, const TrainOfFile& train,
                      std::optional<double> speed_rpm);

}  // namespace crankloop::program
