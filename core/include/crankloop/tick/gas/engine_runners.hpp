// The runners of an engine's cylinders over a step, those of one side of several cylinders abreast.
//
// What belongs here: what goes into a runner's step, where what it did goes. What does not: the step (runner.hpp).
//
//     before the cylinders' step: what their valves see -> after it: the runners, the manifold, heat of the ports
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/engine_manifolds.hpp>
#include <crankloop/tick/gas/runner.hpp>
#include <crankloop/tick/gas/warm_walls.hpp>

namespace crankloop::detail {

/// Of a block of cylinders, from before their step to after it.
template <class T>
struct RunnerSteps {
  RunnerStep<T> step[kPorts];
  GasBeyond<T> seen[kPorts];  ///< of the runner, or of the manifold where there is none
};
template <class T, class S>
using RunnerStepsOf = std::conditional_t<S::runners, RunnerSteps<T>, char>;

/// What a runner may take from its manifold in a step.
template <class Real, class S>
[[nodiscard]] inline Real most_of_manifold_kg([[maybe_unused]] const State<Real, S>& state,
                                              [[maybe_unused]] int port) noexcept {
  if constexpr (Needs<S>::manifolds) {
    return state.manifold[port].contents.mass_kg * static_cast<Real>(0.25);
  } else {
    return static_cast<Real>(1e12);
  }
}

template <class T>
[[nodiscard, gnu::always_inline]] inline GasBeyond<T> spread(const GasBeyond<NumberOf<T>>& far) noexcept {
  return {spread<T>(far.pressure_Pa),   spread<T>(far.choked_per_Pa), spread<T>(far.specific_work_J_kg),
          spread<T>(far.enthalpy_J_kg), spread<T>(far.burned_ratio),  spread<T>(far.response_Pa_kg),
          spread<T>(far.end_Pa),        spread<T>(far.as_was_Pa)};
}

/// What the valves of cylinder `k`, or of lanes, see.
template <class T, class Real, class S>
[[gnu::always_inline]] inline void see_runners(const Tables<Real, S>& tables, const State<Real, S>& state,
                                               const EngineGasStep<Real>& step, std::uint32_t k,
                                               const CylinderGas<T>& gas, RunnerSteps<T>& runners) noexcept {
  for (int port = 0; port < kPorts; ++port) {
    const GasBeyond<Real>& manifold = step.beyond[port];
    if (!has_runner(tables, port)) {
      runners.seen[port] = spread<T>(manifold);
      continue;
    }
    const RunnerGas<T>& runner = take_runners<T>(&state.runner[port][k]);
    // Its own flow of the last step is among those that the manifold's end includes.
    const T own_Pa = manifold.response_Pa_kg * (step.drive.step_s * runner.flow_kg_s);
    const RunnerEnds<T> ends{manifold,
                             manifold.end_Pa + (manifold.as_was_Pa + own_Pa),
                             gas.point.pressure_Pa,
                             gas.point.temperature_K,
                             gas.area_m2[port],
                             most_of_manifold_kg(state, port)};
    runners.seen[port] =
        seen_of_runner<T>(runner, tables.gas_runners->of[port], ends, step.drive.step_s, runners.step[port]);
  }
}

/// Of one side, from cylinder `k` on. Answers fault bits.
template <class T, class Real, class S>
[[nodiscard, gnu::always_inline]] inline std::uint32_t step_runners_of(const Tables<Real, S>& tables,
                                                                       State<Real, S>& state,
                                                                       [[maybe_unused]] Output<Real, S>& out,
                                                                       EngineGasStep<Real>& step, int port,
                                                                       std::uint32_t k, const RunnerSteps<T>& runners,
                                                                       const PortStep<T>& through) noexcept {
  const GasRunner<Real>& table = tables.gas_runners->of[port];
  RunnerGas<Real>* const first = &state.runner[port][k];
  RunnerGas<T> runner = take_runners<T>(first);
  PortStep<T> moves = step_runner<T>(runner, table, runners.step[port], step.beyond[port], runners.seen[port], through,
                                     most_of_manifold_kg(state, port), step.drive.step_s);
  const auto well = is_well_runner<T>(runner, table);
  put_runners<T>(first, runner);
  std::uint32_t faults = 0;
  if (__builtin_expect(!all(well), 0)) {
    for (int i = 0; i < kLanesIn<T>; ++i) {
      if ((holding(well) >> i & 1u) != 0) continue;
      PortStep<Real> one{lane(moves.mass_kg, i), lane(moves.enthalpy_J, i), lane(moves.burned_kg, i)};
      faults |= put_runner_right(first[i], table, one);
      put_lane(moves.mass_kg, i, one.mass_kg), put_lane(moves.enthalpy_J, i, one.enthalpy_J);
      put_lane(moves.burned_kg, i, one.burned_kg);
    }
  }
  if constexpr (S::walls) {
    const WarmWallsTable<Real>& walls = *tables.gas_walls;
    if (walls.port_W_K[port] > 0) {
      for (int i = 0; i < kLanesIn<T>; ++i)
        out.port_heat_W[port] += lose_heat(first[i].contents, first[i].point, table.per_volume_m3, walls.port_W_K[port],
                                           walls.behind_K, step.drive.step_s) *
                                 tables.drive->per_tick_s;
    }
  }
  if constexpr (Needs<S>::manifolds) {
    GasContents<Real> contents = state.manifold[port].contents;
    for (int i = 0; i < kLanesIn<T>; ++i) {
      contents.add(-lane(moves.mass_kg, i), -lane(moves.enthalpy_J, i), -lane(moves.burned_kg, i));
      step.taken_kg[port] += lane(moves.mass_kg, i);
    }
    state.manifold[port].contents = contents;
  }
  return faults;
}

/// After the step of cylinder `k`, or of lanes, which took `through` out of the ports. Answers fault bits.
template <class T, class Real, class S>
[[nodiscard, gnu::always_inline]] inline std::uint32_t step_runners(const Tables<Real, S>& tables,
                                                                    State<Real, S>& state, Output<Real, S>& out,
                                                                    EngineGasStep<Real>& step, std::uint32_t k,
                                                                    const RunnerSteps<T>& runners,
                                                                    const PortStep<T> (&through)[kPorts]) noexcept {
  std::uint32_t faults = 0;
  for (int port = 0; port < kPorts; ++port) {
    if (has_runner(tables, port))
      faults |= step_runners_of<T>(tables, state, out, step, port, k, runners, through[port]);
    for (int i = 0; i < kLanesIn<T>; ++i) {
      const std::uint32_t one = k + static_cast<std::uint32_t>(i);
      const RunnerGas<Real>& runner = state.runner[port][one];
      RunnerOutput<Real>& shown = out.runner[one];
      shown.port_pressure_Pa[port] =
          has_runner(tables, port) ? runner.point.pressure_Pa : step.beyond[port].pressure_Pa;
      shown.flow_kg_s[port] = runner.flow_kg_s;
    }
  }
  return faults;
}

}  // namespace crankloop::detail
