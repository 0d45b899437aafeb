// `--fault-bits B,..` of commands whose crank is free.
//
// What belongs here: the option. What does not: what a fault is (define/wheel_fault.hpp).
#pragma once

#include <cstdint>

#include <crankloop/define/engine_definition.hpp>

#include "../command_line/arguments.hpp"

namespace crankloop::program {

inline constexpr Option kFaultBits =
    text("--fault-bits", "B,..", "input bits of [fault NAME] that are on during the whole run, like 0,3");

/// Input::wheel_faults of --fault-bits; 0 without. Throws UsageError, also of a bit that no fault of the engine has.
[[nodiscard]] std::uint32_t fault_bits(const Arguments& arguments, const EngineDefinition& definition);

}  // namespace crankloop::program
