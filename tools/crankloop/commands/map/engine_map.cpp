#include "engine_map.hpp"

#include <algorithm>
#include <limits>

#include <crankloop/tabulate/summary.hpp>

#include "../../command_line/shards.hpp"
#include "../../files/number.hpp"
#include "../../files/units.hpp"
#include "../../files/words.hpp"
#include "../../loops/run_loop.hpp"

namespace crankloop::program {
namespace {

/// A point as it ran.
struct RunPoint {
  Operation operation;
  RunFigures figures;
  BrakeFigures brake;
};

double value_of(MapResult result, const EngineDefinition& definition, const RunPoint& run) {
  const auto& [operation, figures, brake] = run;
  const GasCycle<double>& cycle = figures.gas.cycle;
  const bool works = brake.power_W > 0 && cycle.fuel_kg > 0;
  const double consumed_kg_s = fuel_kg_s(definition, figures.gas, operation.speed_rad_s());
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
    case MapResult::specific_consumption:
      return works ? consumed_kg_s / brake.power_W * 3.6e9 : std::numeric_limits<double>::quiet_NaN();
    case MapResult::brake_efficiency:
      return works ? brake.power_W / (consumed_kg_s * definition.gas.heating_value_J_kg) : 0;
    case MapResult::burn_start:
      return operation.gas.burn_start_deg;
    case MapResult::knock_integral:
      return figures.gas.knock_integral;
    case MapResult::faulty_ticks:
      break;
  }
  return static_cast<double>(figures.faulty_ticks);
}

RunPoint run_operation(const EngineDefinition& definition, const Operation& operation) {
  FixedStepLoop<float, scenes::Breathing> loop(definition, operation);
  const RunFigures figures = run_cycles<float, scenes::Breathing>(loop, definition, operation, 1);
  return {operation, figures, brake_figures(definition, figures.mean_torque_Nm, operation.speed_rad_s())};
}

/// The burn start of best torque by golden sections: torque over spark has one hump.
RunPoint best_of(const EngineDefinition& definition, const Operation& operation) {
  constexpr double kGolden = 0.6180339887498949;
  const auto at = [&](double start_deg) {
    Operation with = operation;
    with.gas.burn_start_deg = start_deg;
    return run_operation(definition, with);
  };
  const double latest_deg = kLatestBurn_deg - operation.gas.burn_duration_deg * definition.gas.span_ratio();
  double from_deg = kBestStart_deg.least, to_deg = std::min(kBestStart_deg.most, latest_deg);
  RunPoint early = at(to_deg - kGolden * (to_deg - from_deg)), late = at(from_deg + kGolden * (to_deg - from_deg));
  while (to_deg - from_deg > kBestStartWithin_deg) {
    if (early.figures.mean_torque_Nm > late.figures.mean_torque_Nm) {
      to_deg = late.operation.gas.burn_start_deg, late = early, early = at(to_deg - kGolden * (to_deg - from_deg));
    } else {
      from_deg = early.operation.gas.burn_start_deg, early = late, late = at(from_deg + kGolden * (to_deg - from_deg));
    }
  }
  return early.figures.mean_torque_Nm > late.figures.mean_torque_Nm ? early : late;
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
    {"brake_specific_consumption_g_per_kWh", nullptr, "g_per_kWh", MapResult::specific_consumption},
    {"brake_efficiency", "Brake efficiency", "", MapResult::brake_efficiency, true},
    {"burn_start_deg", "Burn start of best torque", "deg", MapResult::burn_start},
    {"knock_integral", "Knock integral", "", MapResult::knock_integral},
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

std::vector<std::string> EngineMap::doubts() const {
  const auto count = [this](const auto& is_so) { return std::count_if(points.begin(), points.end(), is_so); };
  const auto misfiring = count([](const MapPoint& point) {
    return point.at(MapResult::residual) > kMaxResidualThatBurns && point.at(MapResult::fuel_burned) > 0;
  });
  const auto knocking = count([](const MapPoint& point) { return point.at(MapResult::knock_integral) >= 1; });
  const auto of_points = [this](auto some) { return std::to_string(some) + " of " + std::to_string(points.size()); };
  std::vector<std::string> doubts;
  if (misfiring > 0) {
    doubts.push_back(of_points(misfiring) + " points have more than " + brief(100 * kMaxResidualThatBurns) +
                     " % of residual gas: a real engine misfires there. Here all fuel burns, and temperatures are too "
                     "high.");
  }
  if (knocking > 0) {
    doubts.push_back(of_points(knocking) + " points have a knock integral of 1 or more: a real engine knocks there, " +
                     (request.best_spark ? "before it reaches this torque." : "and would burn later."));
  }
  if (const Gas& gas = file.definition().gas; gas.walls.capacity_J_K > 0) {
    doubts.push_back("A point lasts some cycles, so its walls are still near wall_C = " +
                     brief(std::round(gas.wall_K - kZeroCelsius_K)) +
                     ": `crankloop run` at a point says where they settle (wall_temperature).");
  }
  return doubts;
}

std::string run_point(const EngineDefinition& definition, const MapRequest& request, int point) {
  const int loads = request.load.count;
  Operation operation{request.speed_rpm.at(point / loads), request.tick_s, 1, request.gas};
  operation.gas.*request.axis->varied = request.load.at(point % loads) / request.axis->per_si;
  const bool burns = operation.gas.excess_air_ratio > 0 || operation.gas.fuel_kg > 0;  // else no start is the best
  const RunPoint run =
      request.best_spark && burns ? best_of(definition, operation) : run_operation(definition, operation);
  std::string text = std::to_string(run.figures.faults);
  for (const MapColumn& column : kMapColumnList) text += " " + exact_text(value_of(column.result, definition, run));
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
