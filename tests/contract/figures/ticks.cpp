// Steps one engine of crankloop_add_scene: `ticks` prints its RAM in bytes and the time of a tick in ns, `ticks N` only
// makes N steps, so that two runs under an instruction counter tell what one step takes; `ticks ram` prints its RAM
// alone.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <type_traits>

#include FIGURES_ENGINE_HEADER  // namespace the_engine stands for the engine that this program is built for
namespace the_engine = FIGURES_ENGINE;

namespace {

constexpr int kBatches = 1001;
constexpr long kTicksPerBatch =
    600;  // a cycle at 2000 rpm: whole, because valves take more at work; short, so that most are not interrupted

the_engine::Engine engine;
the_engine::Input input;

/// Some 2000 rpm at part load, or pressures that do not stand still, by whichever input the scene has.
template <class Real, class Input>
void drive(Input& in, long tick) {
  if constexpr (std::is_base_of_v<crankloop::group::PhaseInput, Input>) {
    in.crank += crankloop::Phase{std::uint64_t{1} << 55};  // 1.4 deg
  } else {
    in.speed_rad_s = static_cast<Real>(209 + (tick & 1));
  }
  if constexpr (std::is_base_of_v<crankloop::group::LoadInput<Real>, Input>) in.load_ratio = static_cast<Real>(0.75);
  if constexpr (std::is_base_of_v<crankloop::group::PressureInput<Real, the_engine::Scene>, Input>) {
    for (Real& pressure : in.pressure_Pa) pressure = static_cast<Real>(150000 + (tick & 1));
  }
  if constexpr (std::is_base_of_v<crankloop::group::CombustionInput<Real, the_engine::Scene>, Input>) {
    for (Real& fuel_kg : in.fuel_kg) fuel_kg = static_cast<Real>(30e-6);
    for (Real& burn_deg : in.burn_duration_deg) burn_deg = FIGURES_BURN_DEG;
  }
}

std::uint32_t step(long ticks) {
  std::uint32_t faults = 0;
  for (long tick = 0; tick < ticks; ++tick) {
    drive<the_engine::Real>(input, tick);
    faults |= engine.step(input).faults;
  }
  return faults;
}

double median_ns() {
  double ns[kBatches];
  for (double& batch : ns) {
    const auto begin = std::chrono::steady_clock::now();
    if (step(kTicksPerBatch) != 0) std::exit(1);
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
    batch = took.count() / kTicksPerBatch;
  }
  std::sort(ns, ns + kBatches);
  return ns[kBatches / 2];
}

}  // namespace

int main(int count, char** words) {
  if (count > 1 && std::strcmp(words[1], "ram") == 0) return std::printf("%zu\n", sizeof engine) < 0;
  if (count > 1) return step(std::atol(words[1])) == 0 ? 0 : 1;
  std::printf("%zu %.1f\n", sizeof engine, median_ns());
  return 0;
}
