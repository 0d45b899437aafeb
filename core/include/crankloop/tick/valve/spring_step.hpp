// The surge of valve springs over a tick: how its modes push the valves, and their own step.
//
// What belongs here: predicted force and step of the modes of all valves. What does not: how they are set up
// (tabulate/spring_surge.hpp), the valves' step, which takes their force as it takes a gas force (valve_access.hpp).
//
//     predict the modes with the last tick's mean acceleration -> push the valve, from their force to the predicted
//     -> step the valve -> step the modes with its mean acceleration in this tick
#pragma once

#include <cstdint>

#include <crankloop/tick/lanes.hpp>
#include <crankloop/tick/one_instruction.hpp>
#include <crankloop/tick/valve/valve_access.hpp>

namespace crankloop::detail {

template <class Real, class S>
class SpringStep {
  using Valves = ValveAccess<Real, S>;

 public:
  explicit SpringStep(Valves& valves) noexcept : valves_{valves} {}

  /// Stops all modes: springs that follow their valves.
  [[gnu::cold]] void start() noexcept {
    State<Real, S>& state = valves_.state;
    for (auto& mode : state.spring_mode_m)
      for (Real& q : mode) q = Real{0};
    for (auto& mode : state.spring_mode_m_s)
      for (Real& speed : mode) speed = Real{0};
    for (Real& mean : state.valve_mean_m_s2) mean = Real{0};
  }

  /// Before the valves' step: what the springs push in it.
  void push() noexcept {
    for_rows([this](auto lanes, const ValveSprings<Real>& springs, std::uint32_t first)
                 __attribute__((always_inline)) { this->template push_row<decltype(lanes)>(springs, first); });
  }

  /// After the valves' step.
  void step() noexcept {
    for_rows([this](auto lanes, const ValveSprings<Real>& springs, std::uint32_t first)
                 __attribute__((always_inline)) { this->template step_row<decltype(lanes)>(springs, first); });
  }

 private:
  template <class Lanes>
  [[nodiscard, gnu::always_inline]] static Lanes more(const ModeRow<Real>& row, const Lanes& q, const Lanes& v,
                                                      const Lanes& mean_m_s2) noexcept {
    return spread<Lanes>(row.q) * q + spread<Lanes>(row.v) * v + spread<Lanes>(row.drive) * mean_m_s2;
  }

  /// Calls for the valves of each train, several abreast where there are lanes.
  template <class Call>
  [[gnu::always_inline]] void for_rows(const Call& call) noexcept {
    const std::uint32_t cylinders = count<S>(valves_.tables.drive->cylinders);
    for (std::uint32_t t = 0; t < valves_.trains(); ++t) {
      const ValveSprings<Real>& springs = valves_.tables.valve_springs[t];
      std::uint32_t k = 0;
#if CRANKLOOP_ABREAST
      if constexpr (Valves::kInLanes) {
        for (; k + 4 <= cylinders; k += 4) call(Four{}, springs, t * Valves::kPerTrain + k);
      }
#endif
      for (; k < cylinders; ++k) call(Real{}, springs, t * Valves::kPerTrain + k);
    }
  }

  template <class Lanes>
  [[gnu::always_inline]] void push_row(const ValveSprings<Real>& springs, std::uint32_t first) noexcept {
    const State<Real, S>& state = valves_.state;
    const Lanes mean_m_s2 = load<Lanes>(&state.valve_mean_m_s2[first]);
    Lanes from_N{}, to_N{};
    for (std::uint32_t n = 0; n < S::spring_modes && n < springs.modes; ++n) {
      const ModeStep<Real>& mode = springs.mode[n];
      const Lanes q = load<Lanes>(&state.spring_mode_m[n][first]);
      const Lanes v = load<Lanes>(&state.spring_mode_m_s[n][first]);
      const Lanes per_m = spread<Lanes>(mode.valve_N_m);
      from_N = from_N + per_m * q;
      to_N = to_N + per_m * (q + more(mode.of_q, q, v, mean_m_s2));
    }
    store<Lanes>(&valves_.from_N[first], from_N);
    store<Lanes>(&valves_.to_N[first], to_N);
    store<Lanes>(&valves_.started_m_s[first], load<Lanes>(&state.valve_velocity_m_s[first]));
  }

  template <class Lanes>
  [[gnu::always_inline]] void step_row(const ValveSprings<Real>& springs, std::uint32_t first) noexcept {
    State<Real, S>& state = valves_.state;
    const Lanes end_m_s = load<Lanes>(&state.valve_velocity_m_s[first]);
    const Lanes mean_m_s2 =
        (end_m_s - load<Lanes>(&valves_.started_m_s[first])) * spread<Lanes>(valves_.tables.drive->per_tick_s);
    store<Lanes>(&state.valve_mean_m_s2[first], mean_m_s2);
    Lanes moving_N{}, fixed_N{};
    for (std::uint32_t n = 0; n < S::spring_modes && n < springs.modes; ++n) {
      const ModeStep<Real>& mode = springs.mode[n];
      const Lanes q = load<Lanes>(&state.spring_mode_m[n][first]);
      const Lanes v = load<Lanes>(&state.spring_mode_m_s[n][first]);
      const Lanes end = q + more(mode.of_q, q, v, mean_m_s2);
      const Lanes end_v = v + more(mode.of_v, q, v, mean_m_s2);
      const auto stands =
          both_hold(magnitude(end) < spread<Lanes>(kStill_m), magnitude(end_v) < spread<Lanes>(kStill_m_s));
      const Lanes now = pick<Lanes>(stands, Lanes{}, end);
      store<Lanes>(&state.spring_mode_m[n][first], now);
      store<Lanes>(&state.spring_mode_m_s[n][first], pick<Lanes>(stands, Lanes{}, end_v));
      moving_N = moving_N + spread<Lanes>(mode.valve_N_m) * now;
      fixed_N = fixed_N + spread<Lanes>(magnitude(mode.valve_N_m)) * now;
    }
    for (int i = 0; i < kLanesIn<Lanes>; ++i)
      keep(first + static_cast<std::uint32_t>(i), lane(moving_N, i), lane(fixed_N, i));
  }

  /// What is kept and shown of one valve.
  [[gnu::always_inline]] void keep(std::uint32_t v, Real surge_N, Real at_fixed_N) noexcept {
    if constexpr (Needs<S>::valve_gas_held) valves_.state.valve_gas_N[v] = valves_.gas_now_N(v);
    if constexpr (Needs<S>::spring_forces) {
      const ValveBody<Real>& body = valves_.motion(v).body;
      const Real static_N = body.preload_N + body.spring_N_m * valves_.state.valve_lift_m[v];
      (&valves_.out.valve_spring[0][0])[v] = {surge_N, static_N + surge_N, static_N + at_fixed_N};
    }
    (void)v, (void)surge_N, (void)at_fixed_N;
  }

  // A mode that moves less stands still: its numbers would end too small for the processor's fast path.
  static constexpr Real kStill_m = static_cast<Real>(1e-18);
  static constexpr Real kStill_m_s = static_cast<Real>(1e-15);

  Valves& valves_;
};

}  // namespace crankloop::detail
