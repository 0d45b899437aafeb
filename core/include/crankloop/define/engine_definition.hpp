// A whole engine, as its designer knows it.
#pragma once

#include <crankloop/define/crank.hpp>
#include <crankloop/define/crank_dynamics.hpp>
#include <crankloop/define/layout.hpp>
#include <crankloop/define/masses.hpp>
#include <crankloop/define/pressure.hpp>
#include <crankloop/define/valve_train.hpp>

namespace crankloop {

struct EngineDefinition {
  Crank crank;
  Masses masses;
  Layout layout;
  Pressure pressure;
  int train_count = 0;  ///< 0 to kMaxTrains
  ValveTrain trains[kMaxTrains];
  Friction friction;
  Load load;
  Starter starter;
};

/// Validates every part and what they demand of one another, in the order above; the first refusal is returned. Valve trains are
/// validated where their lift and motion are worked out (tabulate).
Status validate(const EngineDefinition& engine) noexcept;

}  // namespace crankloop
