// What the model of tests/target/worst_tick/costs.hpp counts of this firmware's steps, all of them.
// Written by `cmake --build --preset cortex-m4f --target write_example_cycles`; do not edit.
#pragma once

#include <cstdint>

struct ModelCycles {
  std::uint32_t mean, worst;
};
// arm-none-eabi-g++ 12.2.1 -O3
constexpr ModelCycles kModelCycles{1900, 8067};
constexpr ModelCycles kModelCyclesAt5{7626, 32327};
