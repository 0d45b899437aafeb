// How the crank comes to its next angle: inputs that a tick takes before anything moves, each checked, and what its
// crank part hands on.
//
// Not here: inputs of the gas (gas/gas_inputs.hpp), of the phasers (valve/cam_ticks.hpp), torques on the crank
// (mechanisms_step.hpp).
#pragma once

#include <cstdint>
#include <cstring>

#include <crankloop/faults.hpp>
#include <crankloop/input.hpp>
#include <crankloop/limits.hpp>
#include <crankloop/phase.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/crank/crank_step.hpp>
#include <crankloop/tick/crank/cylinder_cut.hpp>

namespace crankloop::detail {

/// Which cylinders do not fire this tick, or not with all their heat.
template <class S>
struct CutOfTick {
  CutCylinders<S> cut_cylinders;
};
/// The integration of the crank's motion, between its halves.
template <class Real>
struct MotionOfTick {
  CrankStep<Real>* motion;
};

/// Work of the gas on the crank in the tick, against the crankcase's pressure.
template <class Real>
struct GasWorkOfTick {
  Real gas_work_J;
};

/// What the cams took of the crank at the end of the tick before: they are stepped once it has turned.
template <class Real>
struct CamDragOfTick {
  Real cam_drag_Nm;
};

/// What a tick's crank part takes and gives besides tables, state and output.
template <class Real, class S>
struct CrankTurn : If<Needs<S>::lack, CutOfTick<S>>,
                   If<Needs<S>::crank_dynamics, MotionOfTick<Real>>,
                   If<Needs<S>::gas_work, GasWorkOfTick<Real>>,
                   If<S::cam_drag, CamDragOfTick<Real>> {
  Phase turned;         ///< in this tick
  bool jumped = false;  ///< nobody knows how it got there; has_jumped() after the first tick
  Real mean_pressure_Pa[Needs<S>::given_work ? S::cylinders.capacity : 1];  ///< over the tick, where they do work
  Real head_pressure_Pa[S::valve_gas ? S::cylinders.capacity : 1];          ///< at its end, for the valves

  /// Known when compiled where no crank is measured.
  [[nodiscard]] bool has_jumped() const noexcept { return S::crank == CrankGiven::phase && jumped; }
};

/// The crank to the tick's end, where the scene has its speed or its angle given.
template <class Real, class S>
[[gnu::always_inline]] inline void turn_as_given(const Drive<Real>& drive, State<Real, S>& state,
                                                 const Input<Real, S>& input, CrankTurn<Real, S>& crank,
                                                 std::uint32_t& faults) noexcept {
  if constexpr (S::crank == CrankGiven::speed) {
    const bool good = within_magnitude(input.speed_rad_s, drive.speed_limit_rad_s);
    const Real speed_rad_s = checked(input.speed_rad_s, good, state.speed_rad_s, kFaultSpeed, faults);
    crank.turned = Phase::from_cycles(speed_rad_s * drive.cycles_per_tick_per_rad_s);
    state.phase += crank.turned;
  } else if constexpr (S::crank == CrankGiven::phase) {
    crank.turned = input.crank - state.phase;
    const Real speed_rad_s = crank.turned.template signed_cycles<Real>() * drive.rad_s_per_cycle_per_tick;
    // The first measured angle says nothing of the speed, nor does one that no crankshaft could have reached.
    const bool possible = within(speed_rad_s, -drive.speed_limit_rad_s, drive.speed_limit_rad_s);
    crank.jumped = !possible || state.ticks == 0;
    if (!crank.jumped) state.speed_rad_s = speed_rad_s;
    if (!possible && state.ticks != 0) faults |= kFaultPhaseJump;
    state.phase = input.crank;
  }
  (void)drive, (void)state, (void)input, (void)crank, (void)faults;
}

/// Every cylinder's pressure at the tick's end, and its mean over the tick.
template <class Real, class S>
[[gnu::always_inline]] inline void take_pressures(const Drive<Real>& drive, State<Real, S>& state,
                                                  const Input<Real, S>& input,
                                                  [[maybe_unused]] CrankTurn<Real, S>& crank,
                                                  std::uint32_t& faults) noexcept {
  constexpr Real kMax_Pa = static_cast<Real>(kMaxPressure_Pa);
  const std::uint32_t cylinders = count<S>(drive.cylinders);
  const auto take = [&](std::uint32_t k, Real now_Pa) {
    if constexpr (Needs<S>::given_work) crank.mean_pressure_Pa[k] = (state.pressure_Pa[k] + now_Pa) / 2;
    state.pressure_Pa[k] = now_Pa;
  };
  if (all_within_positive(input.pressure_Pa, cylinders, kMax_Pa)) {
    if constexpr (S::cylinders.exact && !Needs<S>::given_work) {  // in few words, of a length that the compiler knows
      std::memcpy(state.pressure_Pa, input.pressure_Pa, sizeof input.pressure_Pa);
      return;
    }
    for (std::uint32_t k = 0; k < cylinders; ++k) take(k, input.pressure_Pa[k]);
    return;
  }
  for (std::uint32_t k = 0; k < cylinders; ++k) {
    const bool good = within_positive(input.pressure_Pa[k], kMax_Pa);
    take(k, good ? input.pressure_Pa[k] : state.pressure_Pa[k]);
    if (!good) faults |= kFaultPressure;
  }
}

/// Answers fault bits.
template <class Real, class S>
[[nodiscard, gnu::always_inline]] inline std::uint32_t take_crank_inputs(const Drive<Real>& drive,
                                                                         State<Real, S>& state,
                                                                         const Input<Real, S>& input,
                                                                         CrankTurn<Real, S>& crank) noexcept {
  std::uint32_t faults = 0;
  turn_as_given(drive, state, input, crank, faults);
  ++state.ticks;
  if constexpr (Needs<S>::load) {
    (void)checked(input.load_ratio, within_positive(input.load_ratio, Real{2}), state.load_ratio, kFaultLoadRatio,
                  faults);
  }
  if constexpr (Needs<S>::input_pressure) take_pressures(drive, state, input, crank, faults);
  if constexpr (Needs<S>::cut) {
    crank.cut_cylinders = cut_cylinders_of(state, input.cut_cylinders);
  } else if constexpr (Needs<S>::lack) {
    crank.cut_cylinders = cut_cylinders_of(state, 0);
  }
  return faults;
}

}  // namespace crankloop::detail
