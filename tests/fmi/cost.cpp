// fmu_cost SCENE 0|2|3 TICKS: so many ticks of a scene's engine, or of its FMU in steps of a tick. What it costs is
// counted from outside (step_cost.sh).
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fmu.hpp"

#include "engines.hpp"

namespace {

constexpr double kSpeed_rad_s = 150;

template <class Of>
bool run(const std::string& scene, int version, long ticks) {
  if (scene != Of::kName) return false;
  if (version == 0) {
    typename Of::Engine engine;
    typename Of::Engine::Input in;
    if constexpr (Of::Scene::crank == crankloop::CrankGiven::speed)
      in.speed_rad_s = static_cast<typename Of::Real>(kSpeed_rad_s);
    std::uint32_t faults = 0;
    for (long k = 0; k < ticks; ++k) faults |= engine.step(in).faults;
    return faults == 0;
  }
  const fmu::Fmu fmu(std::string(FMU_DIR) + "/" + scene + "_fmi" + std::to_string(version) + ".fmu");
  fmu::Unit unit(fmu);
  unit.start();
  if (Of::Scene::crank == crankloop::CrankGiven::speed) unit.set("speed_rad_s", kSpeed_rad_s);
  return unit_step_many(unit.unit, 0, Of::kTick_s, ticks) == UNIT_OK && unit.get("fault_ticks") == 0;
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) return 2;
  const int version = std::atoi(words[2]);
  const long ticks = std::atol(words[3]);
  const std::string scene = words[1];
  const auto runs = [&](auto... of) { return (run<decltype(of)>(scene, version, ticks) || ...); };
  const bool good = runs(fmu::Of_four_pistons{}, fmu::Of_measured_motion{}, fmu::Of_torque_by_table{},
                         fmu::Of_torque_by_pressure{}, fmu::Of_trigger_wheels{}, fmu::Of_bouncing_valve{},
                         fmu::Of_whole{}, fmu::Of_free_running{}, fmu::Of_breathing_free{});
  return good ? 0 : 1;
}
