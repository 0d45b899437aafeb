// Fuel that lacked air, as the gas carries it: docs/model.md "Exhaust lambda".
//
// What belongs here: where it comes from and goes in a step. What does not: the gas itself (gas_cylinders.hpp), what is
// shown of it (exhaust_lambda.hpp).
//
// A share beside the burned one, behind the step: gas of a volume takes along the share that the volume had at the
// start of the step. Nothing that the gas does depends on it.
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/combustion.hpp>

namespace crankloop::detail {

/// Less in a volume is none: 1e-10 of the fuel in a cylinder; nor does a step compute with subnormal numbers.
template <class Real>
inline constexpr Real kLeastUnburned_kg = static_cast<Real>(1e-16);

/// Of fuel that burned in a rich mixture, what found no air.
template <class Real, class S>
inline void leave_unburned(const LambdaTable<Real>& table, State<Real, S>& state, std::uint32_t cylinder,
                           Real fuel_kg) noexcept {
  const CylinderBurn<Real>& burn = state.burn[cylinder];
  if (table.in_use == 0 || !(burn.excess_air_ratio < 1) || !(fuel_kg > 0)) return;
  state.unburned_kg[cylinder] += fuel_kg * (Real{1} - burning_ratio(burn)) * table.unburned_ratio;
  state.any_unburned = 1;
}

/// A cylinder, and its runners, that are filled anew from the manifolds.
template <class Real, class S>
inline void refill_unburned(State<Real, S>& state, std::uint32_t cylinder) noexcept {
  const auto share_of = [&state](int port, Real mass_kg) {
    return state.manifold_unburned_kg[port] / state.manifold[port].contents.mass_kg * mass_kg;
  };
  state.unburned_kg[cylinder] = share_of(kIntake, state.cylinder_gas.mass_kg[cylinder]);
  if constexpr (S::runners) {
    for (int port = 0; port < kPorts; ++port)
      state.runner_unburned_kg[port][cylinder] = share_of(port, state.runner[port][cylinder].contents.mass_kg);
  }
  if constexpr (S::gas_results) state.outflow_unburned_kg[cylinder] = Real{0};
}

/// Carries it through one step: made at the step's start, run at its end.
template <class Real, class S>
class UnburnedStep {
  static constexpr std::uint32_t kCylinders = S::cylinders.capacity;

 public:
  /// `outside_kg`: what has come into the manifolds from outside in this tick.
  UnburnedStep(const Tables<Real, S>& tables, State<Real, S>& state, const Output<Real, S>& out,
               const Real (&outside_kg)[kPorts]) noexcept
      : tables_{tables}, state_{state}, out_{out}, outside_kg_{outside_kg}, any_{state.any_unburned != 0} {
    if (__builtin_expect(any_, 0)) begin();
  }

  [[gnu::always_inline]] void run() noexcept {
    if (__builtin_expect(any_, 0)) carry();
  }

 private:
  [[gnu::noinline]] void begin() noexcept {
    for (int port = 0; port < kPorts; ++port)
      manifold_ratio_[port] = state_.manifold_unburned_kg[port] / state_.manifold[port].contents.mass_kg;
    outside_before_kg_[kIntake] = outside_kg_[kIntake], outside_before_kg_[kExhaust] = outside_kg_[kExhaust];
    for (std::uint32_t k = 0; k < cylinders(); ++k) {
      before_kg_[k] = held_kg(k);
      if constexpr (S::crevice) blow_by_kg_s_[k] = out_.crevice[k].blow_by_kg_s;  // of the tick's steps before
      if constexpr (S::runners) {
        for (int port = 0; port < kPorts; ++port) runner_kg_[port][k] = state_.runner[port][k].contents.mass_kg;
      }
    }
  }

  [[gnu::noinline]] void carry() noexcept {
    state_.any_unburned = 0;
    for (std::uint32_t k = 0; k < cylinders(); ++k) {
      Real& own_kg = state_.unburned_kg[k];
      const Real own_ratio = own_kg / before_kg_[k];
      for (int port = 0; port < kPorts; ++port) own_kg += through_port(k, port, own_ratio);
      if constexpr (S::crevice) {
        const Real blows_kg = (out_.crevice[k].blow_by_kg_s - blow_by_kg_s_[k]) * tables_.drive->tick_s;
        if (blows_kg > 0) own_kg -= blows_kg * own_ratio;
      }
      hold(own_kg, held_kg(k));
    }
    for (int port = 0; port < kPorts; ++port) {
      const Real in_kg = outside_kg_[port] - outside_before_kg_[port];
      const bool leaves = in_kg < 0;
      const Real comes_ratio = port == kExhaust ? state_.outlet_unburned_ratio : Real{0};
      const Real ratio = leaves ? manifold_ratio_[port] : comes_ratio;
      if (leaves && port == kExhaust) state_.outlet_unburned_ratio = ratio < 1 ? ratio : Real{1};
      state_.manifold_unburned_kg[port] += in_kg * ratio;
      hold(state_.manifold_unburned_kg[port], state_.manifold[port].contents.mass_kg);
    }
  }

  /// From the manifold, through the runner where there is one; answers what comes into the cylinder.
  [[nodiscard]] Real through_port(std::uint32_t k, int port, Real own_ratio) noexcept {
    const Real flow_kg = out_.cylinder_gas[k].flow_kg_s[port] * tables_.drive->tick_s;
    Real& manifold_kg = state_.manifold_unburned_kg[port];
    if constexpr (S::runners) {
      if (tables_.gas_runners->of[port].area_m2 > 0) {
        Real& runner_kg = state_.runner_unburned_kg[port][k];
        const Real was_kg = runner_kg_[port][k], now_kg = state_.runner[port][k].contents.mass_kg;
        const Real ratio = runner_kg / was_kg;
        const Real moves_kg = (now_kg - was_kg) + flow_kg;  // into the runner
        const Real moved_kg = moves_kg * (moves_kg < 0 ? ratio : manifold_ratio_[port]);
        const Real comes_kg = flow_kg * (flow_kg < 0 ? own_ratio : ratio);
        manifold_kg -= moved_kg, runner_kg += moved_kg - comes_kg;
        hold(runner_kg, now_kg);
        note_outflow(k, port, comes_kg);
        return comes_kg;
      }
    }
    const Real comes_kg = flow_kg * (flow_kg < 0 ? own_ratio : manifold_ratio_[port]);
    manifold_kg -= comes_kg;
    note_outflow(k, port, comes_kg);
    return comes_kg;
  }
  void note_outflow([[maybe_unused]] std::uint32_t k, [[maybe_unused]] int port,
                    [[maybe_unused]] Real comes_kg) noexcept {
    if constexpr (S::gas_results) {
      if (port == kExhaust && comes_kg < 0) state_.outflow_unburned_kg[k] -= comes_kg;
    }
  }

  /// No less than none, no more than there is gas.
  void hold(Real& unburned_kg, Real mass_kg) noexcept {
    if (!(unburned_kg >= kLeastUnburned_kg<Real>)) unburned_kg = Real{0};
    if (unburned_kg > mass_kg) unburned_kg = mass_kg;
    if (unburned_kg > 0) state_.any_unburned = 1;
  }

  [[nodiscard]] std::uint32_t cylinders() const noexcept { return count<S>(tables_.drive->cylinders); }
  /// By a cylinder and its crevices, which have one share.
  [[nodiscard]] Real held_kg(std::uint32_t k) const noexcept {
    Real mass_kg = state_.cylinder_gas.mass_kg[k];
    if constexpr (S::crevice) {
      if (state_.crevice_gas.mass_kg[k] > 0) mass_kg += state_.crevice_gas.mass_kg[k];
    }
    return mass_kg;
  }

  const Tables<Real, S>& tables_;
  State<Real, S>& state_;
  const Output<Real, S>& out_;
  const Real (&outside_kg_)[kPorts];
  bool any_;
  // As at the start of the step.
  Real manifold_ratio_[kPorts];
  Real outside_before_kg_[kPorts];
  Real before_kg_[kCylinders];
  std::conditional_t<S::crevice, Real[kCylinders], char> blow_by_kg_s_;
  std::conditional_t<S::runners, Real[kPorts][kCylinders], char> runner_kg_;
};

}  // namespace crankloop::detail
