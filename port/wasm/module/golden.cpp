// The golden runs of tests/target for a page: the same engines, scenes and inputs, their tables made here and not taken
// out of flash, whose constants would be three times the page. Prints "golden NAME 0xHASH" for each, and last "N
// passed, M failed".
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <string>

#include <crankloop/crankloop.hpp>
#include <crankloop/tick/step.hpp>

#include "crankloop/engine_file/engine_file.hpp"
#include "golden_files.hpp"
#include "tests/target/golden.hpp"
#include "tests/target/scenes.hpp"

namespace {

using namespace target_scenes;  // NOLINT: a list of them
using crankloop::Integrator;

struct Golden {
  const char* name;
  std::uint64_t hash;
};
constexpr Golden kGolden[] = {
#include "tests/target/golden_hashes.inc"
};

unsigned passed = 0, failed = 0;

template <class Real, class S>
std::uint64_t hash_of(const crankloop::EngineDefinition& definition, int top_rad_s, double tick_s,
                      Integrator integrator) {
  const auto tables = std::make_unique<crankloop::TableStorage<Real, S, crankloop::kMaxGasSegments>>();
  const auto engine = std::make_unique<crankloop::Engine<Real, S>>();
  crankloop::TickOptions options{tick_s};
  options.valves.integrator = integrator;
  if (!tables->build(definition, options).ok() || !engine->init(tables->tables()).ok()) return 0;
  return target_check::golden_hash(*engine, top_rad_s);
}

/// One run; `name` is that of golden_hashes.inc.
template <class Real, class S>
void run(const std::string& name, const char* file, int top_rad_s, int tick_us,
         Integrator integrator = Integrator::rk4) {
  const auto engine = crankloop::program::read_engine_text(file, name + ".ini", {});
  const std::uint64_t hash = hash_of<Real, S>(engine.definition(), top_rad_s, tick_us / 1e6, integrator);
  std::printf("golden %s 0x%08X%08X\n", name.c_str(), static_cast<unsigned>(hash >> 32), static_cast<unsigned>(hash));
  bool is_same = false;
  for (const Golden& golden : kGolden) is_same = is_same || (name == golden.name && golden.hash == hash);
  ++(is_same ? passed : failed);
}

template <class S>
void run_both(const std::string& scene) {
  run<float, ShowingValves<S>>("diesel_" + scene, kDiesel495, 240, 100);
  run<float, OfTheSingle<ShowingValves<S>>>("ohc_125_" + scene, kOhc125, 1400, 20);
}

void run_all() {
  run_both<TorqueOfPressures>("torque_of_pressures");
  run_both<TorqueOfTables>("torque_of_tables");
  run_both<MeanTorque>("mean_torque");
  run_both<TorqueSensor>("torque_sensor");
  run_both<ClosedLoop>("closed_loop");
  run_both<Forces>("forces");
  run_both<FollowingValves>("following_valves");
  run_both<ElasticValves>("elastic_valves");
  run_both<Everything>("everything");
  run<float, ShowingValves<Breathing>>("four_2000_breathing", kFour2000, 840, 100);
  run<double, ShowingValves<Breathing>>("four_2000_breathing_double", kFour2000, 840, 100);
  run<float, ShowingValves<Motored>>("four_2000_motored", kFour2000, 840, 500);
  run<float, OfTheSingle<ShowingValves<Everything>>>("ohc_125_exponential", kOhc125, 1400, 100,
                                                     Integrator::exponential);
  run<double, ShowingValves<Everything>>("diesel_everything_double", kDiesel495, 240, 100);
  run<double, OfTheSingle<ShowingValves<Everything>>>("ohc_125_everything_double", kOhc125, 1400, 20);
}

}  // namespace

int main() {
  try {
    run_all();
  } catch (const std::exception& error) {
    std::printf("%s\n", error.what());
    ++failed;
  }
  if (passed + failed != sizeof kGolden / sizeof kGolden[0]) ++failed;  // a run that the table has is not here
  std::printf("%u passed, %u failed\n", passed, failed);
  return failed == 0 ? 0 : 1;
}
