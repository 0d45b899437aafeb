#include "run_signals.hpp"

#include <cmath>
#include <memory>

#include <crankloop/tick/step.hpp>

#include "../../signals/signal_dump.hpp"

namespace crankloop::program {
namespace {

/// Wheels and nothing else; room for a turn of the finest in a tick.
struct Signals : Scene {
  static constexpr Count cylinders = up_to<kMaxCylinders>;
  static constexpr Count triggers = up_to<kMaxTriggerWheels>;
  static constexpr std::uint32_t trigger_edges = kMaxTriggerEdges;
};

struct SignalEngine {
  TableStorage<double, Signals> storage;
  Engine<double, Signals> engine;
};

}  // namespace

void write_signals(const EngineFile& engine_file, const Operation& operation, int cycles, Output& out) {
  SignalDump dump(engine_file, out, {"speed_rpm"});
  const auto made = std::make_unique<SignalEngine>();
  Status status = made->storage.build(engine_file.definition(), {operation.tick_s, {}});
  if (status.ok()) status = made->engine.init(made->storage.tables());
  if (!status.ok()) throw engine_file.explain(status);

  Engine<double, Signals>::Input in;
  in.speed_rad_s = operation.speed_rad_s();
  const auto ticks = static_cast<std::uint64_t>(std::ceil(cycles * 120 / operation.speed_rpm / operation.tick_s));
  dump.number(0, 0, operation.speed_rpm);
  for (std::uint64_t tick = 1; tick <= ticks; ++tick) {
    dump.tick(static_cast<double>(tick) * operation.tick_s, operation.tick_s, made->engine.step(in));
  }
  dump.finish(static_cast<double>(ticks) * operation.tick_s);
}

}  // namespace crankloop::program
