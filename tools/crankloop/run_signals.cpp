#include "run_signals.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include <crankloop/tick/engine_step.hpp>

#include "vcd.hpp"

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

void write_signals(const EngineFile& engine_file, const Operation& operation, int cycles, const std::string& path) {
  const EngineDefinition& definition = engine_file.definition();
  if (definition.trigger_count == 0) throw InputError(engine_file.path() + ": there is no [trigger NAME], so --vcd has no signal to show");
  const auto made = std::make_unique<SignalEngine>();
  Status status = made->storage.build(definition, {operation.tick_s, {}});
  if (status.ok()) status = made->engine.init(made->storage.tables());
  if (!status.ok()) throw engine_file.explain(status);

  std::vector<std::string> names;
  for (const TriggerOfFile& trigger : engine_file.triggers()) names.push_back(trigger.name);
  VcdFile vcd(Output(path), engine_file.name(), names, {"speed_rpm"});
  Engine<double, Signals>::Input in;
  in.speed_rad_s = 0;  // a tick at standstill tells the levels to begin with
  for (std::size_t w = 0; w < names.size(); ++w) vcd.level(w, 0, made->engine.step(in).trigger[w].level != 0);
  vcd.number(0, 0, operation.speed_rpm);
  in.speed_rad_s = operation.speed_rad_s();
  const auto ticks = static_cast<std::uint64_t>(std::ceil(cycles * 120 / operation.speed_rpm / operation.tick_s));
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    const double begin_s = static_cast<double>(tick) * operation.tick_s;
    const auto& out = made->engine.step(in);
    for (std::size_t w = 0; w < names.size(); ++w) {
      for (std::uint32_t e = 0; e < out.trigger[w].edge_count; ++e) {
        vcd.level(w, begin_s + out.trigger[w].edge[e].time_s, out.trigger[w].edge[e].level != 0);
      }
    }
    vcd.write_until(begin_s + operation.tick_s);
  }
  vcd.finish(static_cast<double>(ticks) * operation.tick_s);
}

}  // namespace crankloop::program
