#include "flow_lines.hpp"

#include <cmath>
#include <memory>

#include <crankloop/tabulate/valve_lift.hpp>

#include "../files/units.hpp"

namespace crankloop::program {
namespace {

constexpr double kMm2PerM2 = 1e6;

}  // namespace

std::optional<FlowArea> flow_area_of(const TrainOfFile& train) {
  if (!train.geometry) return {};
  return FlowArea(*train.geometry, train.port);
}

std::string assumed_of(const TrainOfFile& train) {
  std::string assumed = train.geometry ? train.geometry->assumed : "";
  if (!train.has_flow_curve)
    assumed += (assumed.empty() ? "" : ", ") + std::string("flow coefficients of a usual valve");
  return assumed;
}

bool is_exhaust(const TrainOfFile& train) noexcept {
  return train.port.port == GasPort::none ? train.name == "exhaust" : train.port.port == GasPort::exhaust;
}

std::string flow_remark(const TrainOfFile& train) {
  if (!train.geometry)
    return "no flow area: [valve " + train.name + "] has neither seat_diameter_mm nor head_diameter_mm";
  const std::string assumed = assumed_of(train);
  return "flow area: of one valve, over the crank angle" + (assumed.empty() ? "" : "; assumed: " + assumed);
}

void add_flow_remarks(std::vector<std::string>& remarks, const TrainOfFile& train) {
  const std::string assumed = assumed_of(train);
  if (assumed.empty()) return;
  remarks.push_back("Assumed for the flow area of one valve:");
  remarks.push_back(assumed);
}

void add_flow(Summary& s, const std::string& prefix, const FlowIntegrals& flow) {
  s.line(prefix + "open_period", flow.open_deg, "deg", "crank angle");
  s.line(prefix + "flow_area_integral", flow.geometric_m2_deg * kMm2PerM2, "mm^2 deg", "least geometric area");
  s.line(prefix + "flow_area_mean", flow.mean_geometric_m2() * kMm2PerM2, "mm^2", "while it is open");
  s.line(prefix + "effective_area_integral", flow.effective_m2_deg * kMm2PerM2, "mm^2 deg");
  s.line(prefix + "effective_area_mean", flow.mean_effective_m2() * kMm2PerM2, "mm^2");
}

std::optional<OtherValves> valves_beside(const EngineFile& file, const TrainOfFile& train) {
  OtherValves others;
  const auto lift = std::make_unique<ValveLift>();
  for (const TrainOfFile& other : file.trains()) {
    if (other.name == train.name || is_exhaust(other) != is_exhaust(train)) continue;
    const std::optional<FlowArea> area = flow_area_of(other);
    if (!area || !lift->init(other.definition.cam, other.definition.rocker).ok()) return {};
    others.count += other.definition.valve.per_cylinder;
    others.area.add(theoretical_flow(*area, *lift), other.definition.valve.per_cylinder);
  }
  return others;
}

void add_flow_figures(Summary& s, const FlowIntegrals& flow, const EngineFile& file, const TrainOfFile& train,
                      std::optional<double> speed_rpm) {
  if (!file.has("crank") || !(flow.open_deg > 0)) return;
  std::optional<OtherValves> others = valves_beside(file, train);
  if (!others) return;
  const int valves = train.definition.valve.per_cylinder + others->count;
  others->area.add(flow, train.definition.valve.per_cylinder);
  const FlowFigures figures = flow_figures(others->area, file.definition(), speed_rpm.value_or(0) * kRad_sPerRpm);
  s.line("area_per_displacement", figures.area_per_displacement_per_m, "1/m",
         "mean flow area of " + std::to_string(valves) + (valves == 1 ? " valve" : " valves") +
             " over the displacement of a cylinder");
  if (!speed_rpm) return;
  const std::string at = "at " + brief(std::abs(*speed_rpm)) + " rpm";
  s.line("mean_gas_speed", figures.gas_speed_m_s, "m/s", at + ", through the mean flow area");
  if (!is_exhaust(train))
    s.line("inlet_mach_index", figures.mach_index, "", at + ", Taylor's Z; above 0.6 the charge falls");
}

}  // namespace crankloop::program
