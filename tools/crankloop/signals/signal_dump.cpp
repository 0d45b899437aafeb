#include "signal_dump.hpp"

namespace crankloop::program {
namespace {

const EngineFile& with_wheels(const EngineFile& engine) {
  if (engine.triggers().empty())
    throw InputError(engine.path() + ": there is no [trigger NAME], so --vcd has no signal to show");
  return engine;
}

}  // namespace

SignalDump::SignalDump(const EngineFile& engine, Output& out, const std::vector<std::string>& numbers)
    : wheels_{with_wheels(engine).triggers().size()}, vcd_{out, engine.name(), names_of_triggers(engine), numbers} {}

}  // namespace crankloop::program
