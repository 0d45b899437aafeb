// same_bits ENGINE_FILE...: hashes of what each scene answers over 2000 ticks of wild driving, one line for each file and scene.
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/engine.hpp>

#include "crankloop/engine_file.hpp"
#include "flash_double.hpp"
#include "flash_float.hpp"
#include "scenes.hpp"

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
  if constexpr (std::is_base_of_v<SpeedInput<Real>, Input>) {
    in.speed_rad_s = tick < 1000 ? Real{200} + 10 * x : tick < 1200 ? Real{0} : tick < 1400 ? x / 1024 : 900 * x;
    if (tick % 97 == 0) in.speed_rad_s = std::numeric_limits<Real>::quiet_NaN();
  } else {
    in.crank += Phase{std::uint64_t{1} << 55} + Phase{driver.next() >> 12};
    if (tick % 97 == 0) in.crank += Phase{driver.next()};
  }
  if constexpr (std::is_base_of_v<LoadInput<Real>, Input>) in.load_ratio = (1 + x) / 2;
  if constexpr (!std::is_base_of_v<SpeedInput<Real>, Input>) {
    for (Real& pressure : in.pressure_Pa) pressure = static_cast<Real>(4e6) * (1 + x);
  }
}

template <class Real, class Engine>
unsigned long long run(Engine& engine) {
  Hash hash;
  Driver driver;
  typename Engine::Input in;
  for (int tick = 0; tick < kTicks; ++tick) {
    drive<Real>(in, driver, tick);
    const auto& out = engine.step(in);
    // Up to the faults, that is without the padding behind them.
    const auto* end = reinterpret_cast<const unsigned char*>(&out.faults + 1);
    hash.add(&out, static_cast<std::size_t>(end - reinterpret_cast<const unsigned char*>(&out)));
  }
  hash.add(&engine.state(), sizeof engine.state());
  return hash.sum();
}

template <class Real, class Scene>
bool run_from_ram(const char* file, const char* scene, const EngineDefinition& definition) {
  const auto storage = std::make_unique<TableStorage<Real, Scene, kMostGasSegments>>();
  Engine<Real, Scene> engine;
  if (!storage->build(definition, {100e-6}).ok() || !engine.init(storage->tables()).ok()) {
    std::fprintf(stderr, "%s: refused for %s\n", file, scene);
    return false;
  }
  std::printf("%s %s %s %016llx\n", file, scene, sizeof(Real) == 4 ? "float" : "double", run<Real>(engine));
  return true;
}

template <class Real>
bool run_scenes(const char* file, const EngineDefinition& definition) {
  return run_from_ram<Real, Everything>(file, "Everything", definition) &
         run_from_ram<Real, TorqueOnly>(file, "TorqueOnly", definition) &
         run_from_ram<Real, MeasuredPhaseAndPressure>(file, "MeasuredPhaseAndPressure", definition);
}

}  // namespace

int main(int count, char** files) {
  bool all = count > 1;
  for (int i = 1; i < count; ++i) {
    const auto engine = program::read_engine_file(files[i], {"crank", "masses"});
    const std::string path = files[i];
    const std::string name = path.substr(path.rfind('/') + 1);
    all = run_scenes<float>(name.c_str(), engine.definition()) & run_scenes<double>(name.c_str(), engine.definition()) & all;
  }
  flash_float::Engine in_float;
  flash_double::Engine in_double;
  std::printf("diesel_495.ini Everything float %016llx\n", run<float>(in_float));
  std::printf("diesel_495.ini Everything double %016llx\n", run<double>(in_double));
  return all ? 0 : 1;
}
