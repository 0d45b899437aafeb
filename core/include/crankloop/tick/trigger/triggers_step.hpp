// All trigger wheels of an engine over one tick.
//
// What belongs here: how far each wheel turns, with its phaser. What does not: one wheel's edges (trigger_wheel.hpp).
#pragma once

#include <crankloop/faults.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/crank/crank_turn.hpp>
#include <crankloop/tick/trigger/reluctor.hpp>
#include <crankloop/tick/trigger/trigger_wheel.hpp>
#include <crankloop/tick/trigger/wheel_faults.hpp>

namespace crankloop::detail {

/// Positions of the phasers before the tick; the state holds those after it.
template <class S>
struct CamsBefore {
  std::uint64_t cam_phase[S::trains.capacity];
};
template <class Real>
struct SpeedBefore {
  Real speed_rad_s;
};
/// What the wheels need of the state before the tick; empty if they need nothing.
template <class Real, class S>
struct BeforeTick : If<Needs<S>::any_triggers && S::cam_phasing, CamsBefore<S>>,
                    If<Needs<S>::any_triggers && Needs<S>::crank_dynamics, SpeedBefore<Real>> {
  [[gnu::always_inline]] void keep(const State<Real, S>& state) noexcept {
    if constexpr (S::cam_phasing) {
      for (std::uint32_t t = 0; t < S::trains.capacity; ++t) this->cam_phase[t] = state.cam_phase[t];
    }
    if constexpr (Needs<S>::crank_dynamics) this->speed_rad_s = state.speed_rad_s;
    (void)state;
  }
};

template <class Real, class S>
struct TriggersStep {
  const Tables<Real, S>& tables;
  const State<Real, S>& state;
  Output<Real, S>& out;
  const CrankPath<Real>& path;
  const BeforeTick<Real, S>& before;

  [[nodiscard]] std::uint32_t run() noexcept {
    std::uint32_t faults = 0;
    const std::uint32_t wheels = S::triggers.exact ? S::triggers.capacity : tables.triggers->count;
    for (std::uint32_t i = 0; i < wheels; ++i) {
      const TriggerTrack& wheel = tables.triggers->wheel[i];
      TriggerSignal<Real, S>& signal = out.trigger[i];
      TriggerTick<Real, S> tick(wheel, tables.drive->tick_s, signal);
      turn(wheel, tick);
      if (tick.out_of_room()) faults |= kFaultTriggerEdges;
      if constexpr (Needs<S>::faulty_wheels) copy_signal(signal, out.faulty_trigger[i]);
    }
    return faults;
  }

  /// The signals of wheels with a fault that is on, or that was until this tick, anew; the others are healthy.
  [[nodiscard]] std::uint32_t run_faulty(State<Real, S>& spoiled, std::uint32_t input) noexcept {
    const WheelFaultRules<Real>& rules = *tables.wheel_faults;
    std::uint8_t first[S::triggers.capacity];
    out.wheel_faults_on = faults_on<Real, S>(rules, state, input, first);
    std::uint32_t faults = 0;
    const std::uint32_t wheels = S::triggers.exact ? S::triggers.capacity : tables.triggers->count;
    for (std::uint32_t i = 0; i < wheels; ++i) {
      const bool spoils = first[i] < kMaxWheelFaults;
      if (!spoils && (state.wires_differ >> i & 1u) == 0) continue;
      TriggerSignal<Real, S>& signal = out.faulty_trigger[i];
      SignalEdges<Real, S> edges(signal);
      if (spoils) {
        const WheelFaultRule<Real>& fault = rules.fault[first[i]];
        TriggerTick<Real, S> tick(*fault.track, tables.drive->tick_s, signal);
        turn(*fault.track, tick);
        spoil(fault, tables.drive->tick_s, spoiled.noise_random[first[i]], edges);
      }
      join_ticks(spoiled, i, path.jumped, out.trigger[i], edges);
      if (edges.out_of_room()) faults |= kFaultTriggerEdges;
    }
    return faults;
  }

 private:
  [[gnu::always_inline]] void turn(const TriggerTrack& wheel, TriggerTick<Real, S>& tick) const noexcept {
    if (path.jumped) {
      tick.leap(on_wheel(wheel, path.begin + path.turned, phaser_after(wheel)));
    } else if constexpr (Needs<S>::crank_dynamics) {
      const Sweep sweep = sweep_of(wheel);
      tick.turn(sweep, wheel.on_crank != 0 ? 2 * path.bend_cycles : path.bend_cycles);
    } else {
      tick.turn(sweep_of(wheel));
    }
  }
  /// Converts phase units (2^64 = 720 deg) to units of the wheel's turn. By a sum, because a shift by a variable is a
  /// library call on some processors.
  [[nodiscard]] static std::uint64_t in_turns(const TriggerTrack& wheel, std::uint64_t phase) noexcept {
    return wheel.on_crank != 0 ? phase + phase : phase;
  }

  /// Angle of a wheel since its first edge in units of 2^-64 turns.
  [[nodiscard]] static std::uint64_t on_wheel(const TriggerTrack& wheel, Phase crank, std::uint64_t phaser) noexcept {
    return in_turns(wheel, crank.units() - phaser - wheel.starts);
  }

  /// A phaser retards its wheel at a constant rate over the tick. Crank and phaser may each turn by half a cycle; their
  /// sum overflows a signed number of units.
  [[nodiscard]] Sweep sweep_of(const TriggerTrack& wheel) const noexcept {
    const std::uint64_t stood = phaser_before(wheel);
    const auto crank = static_cast<std::int64_t>(path.turned.units());
    const auto cam = static_cast<std::int64_t>(phaser_after(wheel) - stood);
    const bool forward = (crank < 0) == (cam < 0) ? crank >= cam : crank >= 0;
    const std::uint64_t turned = path.turned.units() - static_cast<std::uint64_t>(cam);
    return {on_wheel(wheel, path.begin, stood), in_turns(wheel, forward ? turned : 0 - turned), forward};
  }

  [[nodiscard]] std::uint64_t phaser_before(const TriggerTrack& wheel) const noexcept {
    if constexpr (S::cam_phasing) {
      if (wheel.train != kNoTrain) return before.cam_phase[wheel.train];
    }
    (void)wheel;
    return 0;
  }
  [[nodiscard]] std::uint64_t phaser_after(const TriggerTrack& wheel) const noexcept {
    if constexpr (S::cam_phasing) {
      if (wheel.train != kNoTrain) return state.cam_phase[wheel.train];
    }
    (void)wheel;
    return 0;
  }
};

template <class Real, class S>
[[nodiscard, gnu::always_inline]] inline CrankPath<Real> path_of(const Tables<Real, S>& tables,
                                                                 const State<Real, S>& state,
                                                                 const BeforeTick<Real, S>& before,
                                                                 const CrankTurn<Real, S>& crank) noexcept {
  CrankPath<Real> path{state.phase - crank.turned, crank.turned, crank.has_jumped(), {}};
  if constexpr (Needs<S>::crank_dynamics)
    path.bend_cycles = (state.speed_rad_s - before.speed_rad_s) * tables.drive->cycles_per_tick_per_rad_s / 2;
  (void)tables, (void)before;
  return path;
}

/// Returns fault bits.
template <class Real, class S>
[[nodiscard]] std::uint32_t read_triggers(const Tables<Real, S>& tables, const State<Real, S>& state,
                                          Output<Real, S>& out, const BeforeTick<Real, S>& before,
                                          const CrankTurn<Real, S>& crank) noexcept {
  const CrankPath<Real> path = path_of(tables, state, before, crank);
  return TriggersStep<Real, S>{tables, state, out, path, before}.run();
}

/// The faulty signals, once they are copies of the healthy ones. Returns fault bits.
template <class Real, class S>
[[nodiscard, gnu::noinline]] std::uint32_t spoil_triggers(const Tables<Real, S>& tables, State<Real, S>& state,
                                                          Output<Real, S>& out, std::uint32_t input,
                                                          const BeforeTick<Real, S>& before,
                                                          const CrankTurn<Real, S>& crank) noexcept {
  const CrankPath<Real> path = path_of(tables, state, before, crank);
  return TriggersStep<Real, S>{tables, state, out, path, before}.run_faulty(state, input);
}

/// An engine without faults has one comparison. Returns fault bits.
template <class Real, class S>
[[nodiscard, gnu::always_inline]] inline std::uint32_t read_faulty_triggers(const Tables<Real, S>& tables,
                                                                            State<Real, S>& state, Output<Real, S>& out,
                                                                            std::uint32_t input,
                                                                            const BeforeTick<Real, S>& before,
                                                                            const CrankTurn<Real, S>& crank) noexcept {
  out.wheel_faults_on = 0;
  if (__builtin_expect((tables.wheel_faults->count | state.wires_differ) == 0, 1)) return 0;
  return spoil_triggers(tables, state, out, input, before, crank);
}

/// The variable reluctance sensor of the definition. Returns fault bits.
template <class Real, class S>
[[nodiscard, gnu::noinline]] std::uint32_t sample_reluctor(const Tables<Real, S>& tables, State<Real, S>& state,
                                                           Output<Real, S>& out, const BeforeTick<Real, S>& before,
                                                           const CrankTurn<Real, S>& crank) noexcept {
  const CrankPath<Real> path = path_of(tables, state, before, crank);
  CrankSample<Real> sample{path, state.speed_rad_s, Real{}};
  if constexpr (Needs<S>::crank_dynamics)
    sample.begin_rad_s = before.speed_rad_s, sample.gain_rad_s = state.speed_rad_s - before.speed_rad_s;
  return read_reluctor<Real, S>(*tables.reluctor, tables.drive->tick_s, state, out, sample);
}

}  // namespace crankloop::detail
