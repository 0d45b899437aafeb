// A whole engine, as its designer knows it.
#pragma once

#include <crankloop/define/crank.hpp>
#include <crankloop/define/layout.hpp>
#include <crankloop/define/masses.hpp>
#include <crankloop/define/pressure.hpp>

namespace crankloop {

struct EngineDefinition {
  Crank crank;
  Masses masses;
  Layout layout;
  Pressure pressure;
};

/// Validates every part and what they demand of one another, in the order above; the first refusal is returned.
Status validate(const EngineDefinition& engine) noexcept;

}  // namespace crankloop
