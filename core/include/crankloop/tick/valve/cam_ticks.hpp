// The cams over a tick: where they stand at its end, how far they turned, and the phasers that turn them against the
// crank.
//
// What belongs here: cams as a whole. What does not: their lift (lift_curve.hpp), the valves (elastic_valves.hpp).
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/assert.hpp>
#include <crankloop/faults.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/valve/valve.hpp>

namespace crankloop::detail {

/// A tick of the cams that turn alike.
template <class Real>
struct CamTick {
  std::uint64_t phase;  ///< at its end, before each cylinder's own lag; 2^64 = 360 cam degrees
  std::int64_t turned;  ///< the same units
  CamTurn<Real> cam;

  /// Of the cams' turn, 0 to 359.
  [[nodiscard]] constexpr std::uint32_t degree() const noexcept { return LiftCurve<Real>::cell(phase).degree; }
  [[nodiscard]] constexpr std::uint64_t phase_in_middle() const noexcept {
    return phase - static_cast<std::uint64_t>(turned / 2);
  }
  [[nodiscard]] constexpr std::uint64_t phase_before() const noexcept {
    return phase - static_cast<std::uint64_t>(turned);
  }
  /// For a call of a function of its own, as ValveAccess::apart(). Member by member: a copy as a whole takes the
  /// address of the original, which costs instructions on a Cortex-M4F (docs/decisions/0019).
  [[nodiscard, gnu::always_inline]] CamTick apart() const noexcept { return {phase, turned, {cam.deg, cam.deg_per_s}}; }
};

/// Where a train's cams stand.
template <class Real, class S>
[[nodiscard]] constexpr std::uint64_t cam_phase(const State<Real, S>& state, std::uint32_t train) noexcept {
  std::uint64_t phase = state.phase.units();
  if constexpr (S::cam_phasing) phase -= state.cam_phase[train];
  (void)train;
  return phase;
}

/// Ticks of an engine's cams: one for all trains, or one for each where phasers turn them.
template <class Real, class S>
class CamTicks {
 public:
  /// The engine has turned; nothing has where a measured phase jumped.
  CamTicks(const Tables<Real, S>& tables, const State<Real, S>& state, Phase turned, bool jumped) noexcept
      : drive_{*tables.drive}, turned_{turned.units()}, jumped_{jumped} {
    if constexpr (!S::cam_phasing) set(0, state.phase.units(), turned_);
  }

  /// Moves a train's cams toward their target.
  void move(const LiftCurve<Real>& curve, State<Real, S>& state, std::uint32_t t, Real target_deg,
            std::uint32_t& faults) noexcept {
    const Real target = checked(target_deg, within_magnitude(target_deg, Real{180}), state.cam_phase_target_deg[t],
                                kFaultCamPhase, faults);
    const auto wanted =
        static_cast<std::int64_t>(Phase::from_cycles(target * static_cast<Real>(1.0 / kDegreesPerCycle)).units());
    const auto max_step = static_cast<std::int64_t>(curve.most_phase_per_tick);
    std::int64_t retard = wanted - static_cast<std::int64_t>(state.cam_phase[t]);
    if (retard > max_step) retard = max_step;
    if (retard < -max_step) retard = -max_step;
    CRANKLOOP_ASSERT(t < kCamGroups<S>);
    CRANKLOOP_ASSERT(retard >= -max_step && retard <= max_step);
    state.cam_phase[t] += static_cast<std::uint64_t>(retard);
    set(t, cam_phase(state, t), turned_ - static_cast<std::uint64_t>(retard));
  }

  /// For a call of a function of its own, as ValveAccess::apart().
  using Apart = std::conditional_t<S::cam_phasing, const CamTicks&, CamTicks>;
  [[nodiscard, gnu::always_inline]] Apart apart() const noexcept {
    if constexpr (S::cam_phasing) {
      return *this;
    } else {
      return CamTicks(*this, ticks_[0]);
    }
  }

  [[nodiscard]] const CamTick<Real>& operator[](std::uint32_t train) const noexcept {
    return ticks_[S::cam_phasing ? train : 0];
  }

 private:
  CamTicks(const CamTicks& other, const CamTick<Real>& tick) noexcept
      : drive_{other.drive_}, turned_{other.turned_}, jumped_{other.jumped_}, ticks_{tick.apart()} {}

  void set(std::uint32_t i, std::uint64_t phase, std::uint64_t turned) noexcept {
    if (jumped_) turned = 0;
    const Real deg = Phase{turned}.template signed_cycles<Real>() * Real{kDegreesPerTurn};
    ticks_[i] = {phase, static_cast<std::int64_t>(turned), {deg, deg * drive_.per_tick_s}};
  }

  const Drive<Real>& drive_;
  std::uint64_t turned_;
  bool jumped_;
  CamTick<Real> ticks_[kCamGroups<S>];
};

}  // namespace crankloop::detail
