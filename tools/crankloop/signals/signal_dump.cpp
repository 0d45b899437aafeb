#include "signal_dump.hpp"

namespace crankloop::program {
namespace {

const EngineFile& with_wheels(const EngineFile& engine) {
  if (engine.triggers().empty())
    throw InputError(engine.path() + ": there is no [trigger NAME], so --vcd has no signal to show");
  return engine;
}

}  // namespace

SignalDump::SignalDump(const EngineFile& engine, Output& out, const std::vector<std::string>& signals,
                       const std::vector<std::string>& numbers)
    : wheels_{with_wheels(engine).triggers().size()},
      faulty_{signals.size() - wheels_},
      vcd_{out, engine.name(), signals, numbers} {}

SignalDump::SignalDump(const EngineFile& engine, Output& out, const std::vector<std::string>& numbers)
    : SignalDump(engine, out, names_of_triggers(engine), numbers) {}

SignalDump SignalDump::with_faults(const EngineFile& engine, Output& out, const std::vector<std::string>& numbers) {
  return {engine, out, names_of_signals(engine), numbers};
}

}  // namespace crankloop::program
