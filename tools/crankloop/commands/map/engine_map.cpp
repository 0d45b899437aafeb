#include "engine_map.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include <crankloop/tabulate/summary.hpp>

#include "../../files/number.hpp"
#include "../../loops/run_loop.hpp"

namespace crankloop::program {
namespace {

MapPoint run_point(const EngineDefinition& definition, const MapRequest& request, int speed, int load) {
  MapPoint point;
  point.speed_rpm = request.speed_rpm.at(speed);
  point.load = request.load.at(load);
  Operation operation{point.speed_rpm, request.tick_s, 1, request.gas};
  operation.gas.*request.axis->varied = point.load / request.axis->per_si;
  FixedStepLoop<float, scenes::Breathing> loop(definition, operation);
  const RunFigures figures = run_cycles<float, scenes::Breathing>(loop, definition, operation, 1);
  const BrakeFigures brake = brake_figures(definition, figures.mean_torque_Nm, operation.speed_rad_s());
  point.torque_Nm = figures.mean_torque_Nm;
  point.brake_torque_Nm = brake.torque_Nm;
  point.power_W = brake.power_W;
  point.gas = figures.gas;
  point.faulty_ticks = static_cast<double>(figures.faulty_ticks);
  point.faults = figures.faults;
  return point;
}

}  // namespace

const MapColumn kMapColumnList[kMapColumns] = {
    {"torque_Nm", nullptr, "Nm", [](const MapPoint& p) { return p.torque_Nm; }},
    {"brake_torque_Nm", "Brake torque", "Nm", [](const MapPoint& p) { return p.brake_torque_Nm; }},
    {"brake_power_kW", nullptr, "kW", [](const MapPoint& p) { return p.power_W / 1e3; }},
    {"net_mep_kPa", "Net IMEP", "kPa", [](const MapPoint& p) { return p.gas.cycle.net_mep_Pa / 1e3; }},
    {"pumping_mep_kPa", "Pumping mean pressure", "kPa",
     [](const MapPoint& p) { return p.gas.cycle.pumping_mep_Pa / 1e3; }},
    {"trapped_air_mg", "Air charge of a cylinder", "mg",
     [](const MapPoint& p) { return p.gas.cycle.trapped_air_kg * 1e6; }},
    {"volumetric_efficiency", nullptr, "", [](const MapPoint& p) { return p.gas.cycle.volumetric_efficiency; }, true},
    {"fuel_burned_mg", nullptr, "mg", [](const MapPoint& p) { return p.gas.cycle.fuel_kg * 1e6; }},
    {"residual_ratio", "Residual gas", "", [](const MapPoint& p) { return p.gas.cycle.residual_ratio; }, true},
    {"excess_air_ratio", nullptr, "", [](const MapPoint& p) { return p.gas.cycle.excess_air_ratio; }},
    {"exhaust_temperature_K", nullptr, "K", [](const MapPoint& p) { return p.gas.cycle.exhaust_K; }},
    {"exhaust_manifold_temperature_K", "Temperature in the exhaust manifold", "K",
     [](const MapPoint& p) { return p.gas.exhaust_manifold_K; }},
    {"intake_pressure_kPa", nullptr, "kPa", [](const MapPoint& p) { return p.gas.intake_Pa / 1e3; }},
    {"peak_pressure_kPa", nullptr, "kPa", [](const MapPoint& p) { return p.gas.cycle.peak_Pa / 1e3; }},
    {"faulty_ticks", nullptr, "", [](const MapPoint& p) { return p.faulty_ticks; }},
};

std::string EngineMap::place_of(const MapPoint& point) const {
  const MapAxis& axis = *request.axis;
  return "at " + brief(point.speed_rpm) + " rpm, " + axis.word + " " + brief(point.load) +
         (*axis.unit != '\0' ? " " + std::string(axis.unit) : "");
}

void run_map(EngineMap& map, const std::function<void()>& after_point) {
  const MapRequest& request = map.request;
  const int loads = request.load.count;
  const int count = request.speed_rpm.count * loads;
  map.points.resize(static_cast<std::size_t>(count));
  std::atomic<int> next{0};
  std::mutex one_at_a_time;
  std::exception_ptr refused;
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) {
      try {
        map.points[static_cast<std::size_t>(i)] = run_point(map.file.definition(), request, i / loads, i % loads);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(one_at_a_time);
        refused = std::current_exception();
        next = count;
        return;
      }
      const std::lock_guard<std::mutex> lock(one_at_a_time);
      after_point();
    }
  };
  std::vector<std::thread> others;
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  for (int i = 1; i < std::min(processors, count); ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  if (refused) std::rethrow_exception(refused);
}

}  // namespace crankloop::program
