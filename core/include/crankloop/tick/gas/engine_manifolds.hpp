// The manifolds of an engine over a tick: between given ones and its own the choice of the scene.
//
// What belongs here: what cylinders see of them, what cylinders take, what comes in from outside, what is shown. What
// does not: the formulas of one (manifold.hpp), runners between them and the ports (engine_runners.hpp).
#pragma once

#include <cstdint>
#include <type_traits>

#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/gas_places.hpp>
#include <crankloop/tick/gas/manifold.hpp>
#include <crankloop/tick/gas/warm_walls.hpp>

namespace crankloop::detail {

/// What the cylinders of an engine share in a step.
template <class Real>
struct EngineGasStep {
  std::uint64_t phase;  ///< of the engine, at its end
  std::int64_t turned;
  GasDrive<Real> drive;
  GasBeyond<Real> beyond[kPorts];  ///< as at the start of the step, whatever order cylinders go in
  Real taken_kg[kPorts];           ///< from there
};

template <class Real, class S>
[[nodiscard]] inline bool has_runner([[maybe_unused]] const Tables<Real, S>& tables,
                                     [[maybe_unused]] int port) noexcept {
  if constexpr (S::runners) {
    return tables.gas_runners->of[port].area_m2 > 0;
  } else {
    return false;
  }
}

/// The very numbers that the cylinders gained, so that nothing is lost.
template <class T, class Real, class S>
[[gnu::always_inline]] inline void take_from_manifolds(const Tables<Real, S>& tables, State<Real, S>& state,
                                                       EngineGasStep<Real>& step,
                                                       const PortStep<T> (&through)[kPorts]) noexcept {
  for (int port = 0; port < kPorts; ++port) {
    if (has_runner(tables, port)) continue;  // takes from there itself
    const PortStep<T>& all = through[port];
    const std::uint32_t flowing = holding(all.mass_kg != Real{0});
    if (flowing == 0) continue;
    GasContents<Real>& contents = state.manifold[port].contents;
    for (int i = 0; i < kLanesIn<T>; ++i) {
      if ((flowing >> i & 1u) == 0) continue;
      contents.add(-lane(all.mass_kg, i), -lane(all.enthalpy_J, i), -lane(all.burned_kg, i));
      step.taken_kg[port] += lane(all.mass_kg, i);
    }
  }
}

/// A base of the tick of all gas (GasStep), which so has the three references once.
template <class Real, class S>
class EngineManifolds {
  using N = Needs<S>;
  using Areas = PortAreas<Real, S::cylinders.capacity>;

 public:
  EngineManifolds(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out) noexcept
      : tables_{tables}, state_{state}, out_{out} {}

  /// Once a tick, after the inputs.
  void take_boundaries() noexcept {
    if constexpr (S::boundaries) {
      for (int port = 0; port < kPorts; ++port) boundary_[port] = given(port, Real{0});
    }
  }

  [[gnu::always_inline]] void show_to_cylinders(EngineGasStep<Real>& step,
                                                [[maybe_unused]] const Areas& areas) const noexcept {
    [[maybe_unused]] Real outside_m2[kPorts] = {};
    if constexpr (N::manifolds)
      outside_m2[kIntake] = throttle_m2(), outside_m2[kExhaust] = tables_.gas_manifolds->outlet_m2;
    for (int port = 0; port < kPorts; ++port) {
      step.taken_kg[port] = Real{0};
      if constexpr (N::manifolds) {
        const std::uint32_t cylinders = count<S>(tables_.drive->cylinders);
        std::uint32_t open = 0;
        for (std::uint32_t k = 0; k < cylinders; ++k) {
          const auto bits = bits_of(areas.of[port][k]);  // of a number that is not negative
          open += static_cast<std::uint32_t>((0 - bits) >> (8 * sizeof bits - 1));
        }
        if (has_runner(tables_, port)) open = cylinders;
        step.beyond[port] = seen_from_ports(state_.manifold[port], outside(port), outside_m2[port],
                                            tables_.gas_manifolds->per_volume_m3[port], state_.taken_kg_s[port],
                                            static_cast<Real>(open), most_m3(), step.drive.step_s);
      } else {
        step.beyond[port] = given(port, static_cast<Real>(port));
      }
    }
  }

  /// After the cylinders. Answers fault bits.
  [[nodiscard]] std::uint32_t step_manifolds([[maybe_unused]] const EngineGasStep<Real>& step) noexcept {
    bool put_back = false;
    if constexpr (N::manifolds) {
      const GasManifolds<Real>& table = *tables_.gas_manifolds;
      const GasBeyond<Real>& behind = outside(kExhaust);
      (void)exchange_with(outside(kIntake), kIntake, throttle_m2(), left(kIntake, step), step, put_back);
      const GasPoint<Real> before = state_.manifold[kExhaust].point;
      const GasNear<Real> near = left(kExhaust, step);
      const bool flows_back = near.pressure_Pa < behind.pressure_Pa;
      const Real in_kg = exchange_with(flows_back ? behind_outlet(behind.pressure_Pa) : behind, kExhaust,
                                       table.outlet_m2, near, step, put_back);
      if (in_kg < 0) state_.outlet = {before.temperature_K, before.burned_ratio};
      if constexpr (S::walls) {
        if (__builtin_expect(tables_.gas_walls->of_ports != 0, 0)) lose_heat_to_walls(step.drive.step_s);
      }
    }
    return put_back ? std::uint32_t{kFaultGas} : 0;
  }

  /// Once a tick.
  void show_manifolds() noexcept {
    if constexpr (N::manifolds) {
      for (int port = 0; port < kPorts; ++port) {
        const GasPoint<Real>& at = state_.manifold[port].point;
        out_.manifold[port] = {at.pressure_Pa, at.temperature_K, at.burned_ratio};
      }
      out_.throttle_kg_s = outside_kg_[kIntake] * tables_.drive->per_tick_s;
      out_.outlet_kg_s = -outside_kg_[kExhaust] * tables_.drive->per_tick_s;
    }
  }

 protected:
  /// What has come in from outside in this tick, of each.
  [[nodiscard]] const auto& outside_kg() const noexcept { return outside_kg_; }

  const Tables<Real, S>& tables_;
  State<Real, S>& state_;
  Output<Real, S>& out_;

 private:
  /// Before the throttle, behind the outlet.
  [[nodiscard]] const GasBeyond<Real>& outside(int port) const noexcept {
    if constexpr (S::boundaries) {
      return boundary_[port];
    } else {
      return tables_.gas_manifolds->outside[port];
    }
  }
  /// As inputs have it.
  [[nodiscard]] GasBeyond<Real> given(int port, Real burned_ratio) const noexcept {
    const GivenGas<Real>& gas = state_.given_gas[port];
    return beyond(GasPoint<Real>{gas.pressure_Pa, gas.temperature_K, burned_ratio, Real{0}}, Real{0});
  }
  /// What flows back through the outlet.
  [[nodiscard]] GasBeyond<Real> behind_outlet(Real pressure_Pa) const noexcept {
    const OutletGas<Real>& gas = state_.outlet;
    return beyond(GasPoint<Real>{pressure_Pa, gas.temperature_K, gas.burned_ratio, Real{0}}, Real{0});
  }
  /// Of a cylinder.
  [[nodiscard]] Real most_m3() const noexcept {
    const GasCylinders<Real>& table = *tables_.gas_cylinders;
    return table.clearance_m3 + Real{1} / table.per_swept_m3;
  }
  [[nodiscard]] Real throttle_m2() const noexcept {
    if constexpr (N::manifolds) {
      const GasManifolds<Real>& table = *tables_.gas_manifolds;
      const Real place = state_.throttle_ratio * Real{kThrottleSteps};
      if (!(place < Real{kThrottleSteps})) return table.throttle_m2[kThrottleSteps];
      const auto row = static_cast<std::int32_t>(place);
      return table.throttle_m2[row] +
             (table.throttle_m2[row + 1] - table.throttle_m2[row]) * (place - static_cast<Real>(row));
    } else {
      return Real{0};
    }
  }

  /// A manifold as the cylinders left it.
  [[nodiscard]] GasNear<Real> left(int port, const EngineGasStep<Real>& step) noexcept {
    state_.taken_kg_s[port] = step.taken_kg[port] / step.drive.step_s;
    return left_by_cylinders(state_.manifold[port], step.beyond[port], step.taken_kg[port],
                             tables_.gas_manifolds->per_volume_m3[port]);
  }
  /// Through throttle or outlet; answers the mass that came in.
  [[gnu::noinline]] Real exchange_with(const GasBeyond<Real>& outside, int port, Real area_m2,
                                       const GasNear<Real>& near, const EngineGasStep<Real>& step,
                                       bool& put_back) noexcept {
    const GasManifolds<Real>& table = *tables_.gas_manifolds;
    const Real in_kg = step_manifold(state_.manifold[port], near, step.beyond[port], outside, area_m2,
                                     table.per_volume_m3[port], table.least_kg[port], step.drive.step_s, put_back);
    outside_kg_[port] += in_kg;
    return in_kg;
  }
  /// Of manifolds; where there are runners, they have it.
  [[gnu::noinline]] void lose_heat_to_walls(Real step_s) noexcept {
    const WarmWallsTable<Real>& walls = *tables_.gas_walls;
    for (int port = 0; port < kPorts; ++port) {
      if (!(walls.port_W_K[port] > 0) || has_runner(tables_, port)) continue;
      ManifoldGas<Real>& manifold = state_.manifold[port];
      out_.port_heat_W[port] += lose_heat(manifold.contents, manifold.point, tables_.gas_manifolds->per_volume_m3[port],
                                          walls.port_W_K[port], walls.behind_K, step_s) *
                                tables_.drive->per_tick_s;
    }
  }

  std::conditional_t<S::boundaries, GasBeyond<Real>[kPorts], char> boundary_;
  Real outside_kg_[kPorts] = {};  ///< into the manifolds from outside, in this tick
};

}  // namespace crankloop::detail
