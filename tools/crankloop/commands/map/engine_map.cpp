#include "engine_map.hpp"

#include <algorithm>

#include <crankloop/tabulate/summary.hpp>

#include "../../command_line/shards.hpp"
#include "../../files/number.hpp"
#include "../../files/words.hpp"
#include "../../loops/run_loop.hpp"

namespace crankloop::program {
namespace {

double value_of(MapResult result, const RunFigures& figures, const BrakeFigures& brake) {
  const GasCycle<double>& cycle = figures.gas.cycle;
  switch (result) {
    case MapResult::torque:
      return figures.mean_torque_Nm;
    case MapResult::brake_torque:
      return brake.torque_Nm;
    case MapResult::brake_power:
      return brake.power_W / 1e3;
    case MapResult::net_mep:
      return cycle.net_mep_Pa / 1e3;
    case MapResult::pumping_mep:
      return cycle.pumping_mep_Pa / 1e3;
    case MapResult::trapped_air:
      return cycle.trapped_air_kg * 1e6;
    case MapResult::volumetric_efficiency:
      return cycle.volumetric_efficiency;
    case MapResult::fuel_burned:
      return cycle.fuel_kg * 1e6;
    case MapResult::residual:
      return cycle.residual_ratio;
    case MapResult::excess_air:
      return cycle.excess_air_ratio;
    case MapResult::exhaust_temperature:
      return cycle.exhaust_K;
    case MapResult::exhaust_manifold_temperature:
      return figures.gas.exhaust_manifold_K;
    case MapResult::intake_pressure:
      return figures.gas.intake_Pa / 1e3;
    case MapResult::peak_pressure:
      return cycle.peak_Pa / 1e3;
    case MapResult::faulty_ticks:
      break;
  }
  return static_cast<double>(figures.faulty_ticks);
}

}  // namespace

const MapColumn kMapColumnList[kMapResults] = {
    {"torque_Nm", nullptr, "Nm", MapResult::torque},
    {"brake_torque_Nm", "Brake torque", "Nm", MapResult::brake_torque},
    {"brake_power_kW", nullptr, "kW", MapResult::brake_power},
    {"net_mep_kPa", "Net IMEP", "kPa", MapResult::net_mep},
    {"pumping_mep_kPa", "Pumping mean pressure", "kPa", MapResult::pumping_mep},
    {"trapped_air_mg", "Air charge of a cylinder", "mg", MapResult::trapped_air},
    {"volumetric_efficiency", nullptr, "", MapResult::volumetric_efficiency, true},
    {"fuel_burned_mg", nullptr, "mg", MapResult::fuel_burned},
    {"residual_ratio", "Residual gas", "", MapResult::residual, true},
    {"excess_air_ratio", nullptr, "", MapResult::excess_air},
    {"exhaust_temperature_K", nullptr, "K", MapResult::exhaust_temperature},
    {"exhaust_manifold_temperature_K", "Temperature in the exhaust manifold", "K",
     MapResult::exhaust_manifold_temperature},
    {"intake_pressure_kPa", nullptr, "kPa", MapResult::intake_pressure},
    {"peak_pressure_kPa", nullptr, "kPa", MapResult::peak_pressure},
    {"faulty_ticks", nullptr, "", MapResult::faulty_ticks},
};

std::string EngineMap::place_of(const MapPoint& point) const {
  const MapAxis& axis = *request.axis;
  return "at " + brief(point.speed_rpm) + " rpm, " + axis.word + " " + brief(point.load) +
         (*axis.unit != '\0' ? " " + std::string(axis.unit) : "");
}

const MapPoint& EngineMap::largest(MapResult result) const {
  return *std::max_element(points.begin(), points.end(),
                           [result](const MapPoint& a, const MapPoint& b) { return a.at(result) < b.at(result); });
}

std::string run_point(const EngineDefinition& definition, const MapRequest& request, int point) {
  const int loads = request.load.count;
  Operation operation{request.speed_rpm.at(point / loads), request.tick_s, 1, request.gas};
  operation.gas.*request.axis->varied = request.load.at(point % loads) / request.axis->per_si;
  FixedStepLoop<float, scenes::Breathing> loop(definition, operation);
  const RunFigures figures = run_cycles<float, scenes::Breathing>(loop, definition, operation, 1);
  const BrakeFigures brake = brake_figures(definition, figures.mean_torque_Nm, operation.speed_rad_s());
  std::string text = std::to_string(figures.faults);
  for (const MapColumn& column : kMapColumnList) text += " " + exact_text(value_of(column.result, figures, brake));
  return text;
}

std::vector<MapPoint> points_of(const MapRequest& request, const std::vector<std::string>& texts) {
  std::vector<MapPoint> points;
  for (int i = 0; i < static_cast<int>(texts.size()); ++i) {
    MapPoint point;
    point.speed_rpm = request.speed_rpm.at(i / request.load.count);
    point.load = request.load.at(i % request.load.count);
    const auto words = split(texts[static_cast<std::size_t>(i)], ' ');
    point.faults = static_cast<std::uint32_t>(parse_number(words.at(0)).value);
    for (std::size_t r = 0; r < kMapResults; ++r) point.results[r] = exact_number(words.at(r + 1));
    points.push_back(point);
  }
  return points;
}

}  // namespace crankloop::program
