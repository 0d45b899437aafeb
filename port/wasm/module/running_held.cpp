// Engines at a speed that is given.
#include "running_scene.hpp"

#include <algorithm>
#include <cmath>

#include "crankloop/loops/run_hash.hpp"

namespace crankloop::page {
namespace {

template <class Real, class S>
HashedRun hash_run(const program::EngineFile& file, const program::Operation& operation, int cycles) {
  program::FixedStepLoop<Real, S> loop(file.definition(), operation);
  const double span = cycles * loop.ticks_per_cycle();
  program::require_ticks(span, operation.tick_s, program::kFewerTicks);
  std::vector<Probe> outputs;
  list_outputs(loop.engine(), detail::shape_of<Real, S>(*loop.engine().tables()), outputs);
  program::BitHash hash;
  const auto ticks = static_cast<std::uint64_t>(std::max(1.0, std::ceil(span - program::kHairOfATick)));
  for (std::uint64_t i = 0; i < ticks; ++i) {
    loop.step();
    for (const Probe& output : outputs)
      detail::with_value(output.storage, output.at, [&hash](const auto& value) { hash.add(value); });
  }
  return {hash.text(), ticks};
}

template <class S>
HashedRun hash_run(const program::EngineFile& file, const program::Operation& operation, bool in_double, int cycles) {
  return in_double ? hash_run<double, S>(file, operation, cycles) : hash_run<float, S>(file, operation, cycles);
}

}  // namespace

HashedRun hash_held_run(const program::EngineFile& file, const program::Operation& operation, bool in_double,
                        int cycles) {
  return program::breathes(file.definition()) ? hash_run<HeldBreathing>(file, operation, in_double, cycles)
                                              : hash_run<Held>(file, operation, in_double, cycles);
}

std::unique_ptr<Running> start_held(const program::EngineFile& file, const StartRequest& request) {
  return program::breathes(file.definition()) ? running_of<HeldBreathing>(file, request)
                                              : running_of<Held>(file, request);
}

}  // namespace crankloop::page
