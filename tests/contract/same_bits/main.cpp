// same_bits ENGINE_FILE...: hashes of what each scene answers over 2000 ticks of wild driving, one line for each file,
// scene and scalar. Fails where tables in flash and tables in RAM differ.
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

#include <crankloop/engine.hpp>
#include <crankloop/tabulate/tabulate.hpp>

#include "crankloop/engine_file/engine_file.hpp"
#include "flash_double.hpp"
#include "flash_float.hpp"
#include "scenes.hpp"
#include "valves_exponential_double.hpp"
#include "valves_exponential_float.hpp"
#include "valves_rk4_double.hpp"
#include "valves_rk4_float.hpp"

namespace {

using namespace crankloop;

constexpr int kTicks = 2000;

/// FNV-1a over bytes.
class Hash {
 public:
  void add(const void* data, std::size_t size) noexcept {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) sum_ = (sum_ ^ bytes[i]) * 0x100000001b3u;
  }
  [[nodiscard]] unsigned long long sum() const noexcept { return sum_; }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325u;
};

/// Integers that look random and, turned into floating point by an exact division, are the same everywhere.
class Driver {
 public:
  /// -1 to 1 in steps of 2^-20.
  template <class Real>
  [[nodiscard]] Real between_minus_one_and_one() noexcept {
    const auto steps = static_cast<std::int32_t>(next() >> 43) - (std::int32_t{1} << 20);
    return static_cast<Real>(steps) / static_cast<Real>(std::int32_t{1} << 20);
  }
  [[nodiscard]] std::uint64_t next() noexcept { return state_ = state_ * 6364136223846793005u + 1442695040888963407u; }

 private:
  std::uint64_t state_ = 495;
};

/// Smooth running, standstill, a crawl, reverse, and now and then what no sensor should say.
template <class Real, class Input>
void drive(Input& in, Driver& driver, int tick) {
  const Real x = driver.template between_minus_one_and_one<Real>();
  if constexpr (std::is_base_of_v<group::SpeedInput<Real>, Input>) {
    in.speed_rad_s = tick < 1000 ? Real{200} + 10 * x : tick < 1200 ? Real{0} : tick < 1400 ? x / 1024 : 900 * x;
    if (tick % 97 == 0) in.speed_rad_s = std::numeric_limits<Real>::quiet_NaN();
  } else {
    in.crank += Phase{std::uint64_t{1} << 55} + Phase{driver.next() >> 12};
    if (tick % 97 == 0) in.crank += Phase{driver.next()};
  }
  if constexpr (std::is_base_of_v<group::LoadInput<Real>, Input>) in.load_ratio = (1 + x) / 2;
  if constexpr (std::is_base_of_v<group::CamPhaseInput<Real, ElasticValves>, Input>) {
    for (Real& phase : in.cam_phase_deg) phase = tick / 500 % 2 == 0 ? Real{0} : 20 * x;
  }
  if constexpr (!std::is_base_of_v<group::SpeedInput<Real>, Input>) {
    for (Real& pressure : in.pressure_Pa) pressure = static_cast<Real>(4e6) * (1 + x);
  }
}

/// Up to the faults, that is without the padding behind them.
template <class Output>
void add_output(Hash& hash, const Output& out) {
  const auto* end = reinterpret_cast<const unsigned char*>(&out.faults + 1);
  hash.add(&out, static_cast<std::size_t>(end - reinterpret_cast<const unsigned char*>(&out)));
}

/// There is padding behind each valve's regime too.
template <class Real>
void add_output(Hash& hash, const Output<Real, ElasticValves>& out) {
  hash.add(&out.valve, sizeof out.valve);
  for (const auto& train : out.valve_forces) {
    for (const ValveForcesOutput<Real>& f : train) {
      for (const Real x : {f.train_N, f.seat_N, f.tip_N, f.cam_N, f.train_compression_m}) hash.add(&x, sizeof x);
      hash.add(&f.regime, sizeof f.regime);
    }
  }
  static_assert(sizeof(ValveCycle<Real>) == 9 * sizeof(Real) + 4 * sizeof(std::uint32_t), "no padding");
  hash.add(&out.valve_cycle, sizeof out.valve_cycle);
  hash.add(&out.faults, sizeof out.faults);
}

template <class Real, class Engine>
unsigned long long run(Engine& engine) {
  Hash hash;
  Driver driver;
  typename Engine::Input in;
  for (int tick = 0; tick < kTicks; ++tick) {
    drive<Real>(in, driver, tick);
    add_output(hash, engine.step(in));
  }
  hash.add(&engine.state(), sizeof engine.state());
  return hash.sum();
}

void print(const std::string& file, const char* scene, const char* tables, std::size_t real_bytes,
           unsigned long long hash) {
  std::printf("%s %s %s %s %016llx\n", file.c_str(), scene, real_bytes == 4 ? "float" : "double", tables, hash);
}

/// With tables built here. Throws where they are refused.
template <class Real, class Scene>
unsigned long long run_from_ram(const std::string& file, const char* scene, const EngineDefinition& definition,
                                const TickOptions& options = {100e-6}) {
  const auto storage = std::make_unique<TableStorage<Real, Scene, kMaxGasSegments>>();
  Engine<Real, Scene> engine;
  if (!storage->build(definition, options).ok() || !engine.init(storage->tables()).ok()) {
    throw std::runtime_error(file + ": refused for " + scene);
  }
  const unsigned long long hash = run<Real>(engine);
  print(file, scene, "ram", sizeof(Real), hash);
  return hash;
}

/// Every scene; FlashEngine is Everything with the 495 diesel's tables as constant data.
template <class Real, class FlashEngine>
bool run_scenes(const std::string& file, const EngineDefinition& definition) {
  const unsigned long long everything = run_from_ram<Real, Everything>(file, "Everything", definition);
  run_from_ram<Real, TorqueOnly>(file, "TorqueOnly", definition);
  run_from_ram<Real, MeasuredPhaseAndPressure>(file, "MeasuredPhaseAndPressure", definition);
  run_from_ram<Real, ElasticValves>(file, "ElasticValves rk4", definition, {100e-6, {Integrator::rk4}});
  run_from_ram<Real, ElasticValves>(file, "ElasticValves exponential", definition, {100e-6, {Integrator::exponential}});
  if (file != "diesel_495.ini") return true;

  FlashEngine in_flash;
  const unsigned long long from_flash = run<Real>(in_flash);
  print(file, "Everything", "flash", sizeof(Real), from_flash);
  return from_flash == everything;
}

/// Elastic valves with tables in flash and in RAM.
template <class Real, class FlashEngine>
bool same_from_flash(const char* scene, const EngineDefinition& definition, Integrator integrator) {
  const std::string file = "diesel_495_phased.ini";
  const unsigned long long from_ram =
      run_from_ram<Real, ElasticValves>(file, scene, definition, {100e-6, {integrator}});
  FlashEngine in_flash;
  const unsigned long long from_flash = run<Real>(in_flash);
  print(file, scene, "flash", sizeof(Real), from_flash);
  return from_flash == from_ram;
}

bool valves_are_same_from_flash() {
  const auto engine = program::read_engine_file(CRANKLOOP_VALVE_ENGINE, {"crank", "masses"});
  const EngineDefinition& d = engine.definition();
  bool same = same_from_flash<float, valves_rk4_float::Engine>("ElasticValves rk4", d, Integrator::rk4);
  same &= same_from_flash<double, valves_rk4_double::Engine>("ElasticValves rk4", d, Integrator::rk4);
  same &=
      same_from_flash<float, valves_exponential_float::Engine>("ElasticValves exponential", d, Integrator::exponential);
  same &= same_from_flash<double, valves_exponential_double::Engine>("ElasticValves exponential", d,
                                                                     Integrator::exponential);
  return same;
}

}  // namespace

int main(int count, char** files) try {
  bool flash_is_ram = true;
  for (int i = 1; i < count; ++i) {
    const std::string path = files[i];
    const std::string file = path.substr(path.rfind('/') + 1);
    const auto engine = program::read_engine_file(path, {"crank", "masses"});
    flash_is_ram &= run_scenes<float, flash_float::Engine>(file, engine.definition());
    flash_is_ram &= run_scenes<double, flash_double::Engine>(file, engine.definition());
  }
  flash_is_ram &= valves_are_same_from_flash();
  if (!flash_is_ram) std::fprintf(stderr, "tables in flash answer other bits than those in RAM\n");
  return flash_is_ram ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
