// One step of the gas in a cylinder. docs/model.md "Gas".
//
// What belongs here: heat, compression, what the ports bring and take, in the order in which a step has them. What does
// not: how much flows (port_flow.hpp, port_overlap.hpp), what burns (combustion.hpp), the engine's step (gas_step.hpp).
//
//     half of the heat -> compression -> the other half -> flow at the pressure that this leads to -> sums
#pragma once

#include <cstdint>
#include <cstring>

#include <crankloop/tick/gas/gas_state.hpp>
#include <crankloop/tick/gas/port_overlap.hpp>
#include <crankloop/tick/gas/wall_heat.hpp>

namespace crankloop::detail {

/// What a step is told of the engine.
template <class Real>
struct GasDrive {
  Real step_s;
  Real stirring_m_s;  ///< of the walls' heat
  Real area_per_m3;   ///< most area of a port that matters, per volume: most_area_per_m3()
  Real least_kg_m3;   ///< a cylinder never holds less
};

/// What fuel brings, per kg.
template <class Real>
struct GasFuel {
  Real energy_J_kg;   ///< q_f: heat, and the energies of what burns and what comes of it
  Real burned_kg_kg;  ///< 1 + L
};

template <class T>
[[nodiscard, gnu::always_inline]] inline T held_within(const T& x, const T& most) noexcept {
  const T least = -most;
  const T held = x < most ? x : most;
  return held > least ? held : least;
}

/// A step before anything flows, of a cylinder or of several abreast: half of the heat, compression that is exact for
/// an ideal gas whose G is that of the mean temperature, the other half.
template <class T>
struct ClosedStep {
  using Real = NumberOf<T>;

  T volume_m3;  ///< at its end
  T per_volume_m3;
  T heat_J;         ///< of fuel
  T wall_heat_J;    ///< to the walls
  T work_J;         ///< on the piston, absolute
  T temperature_K;  ///< at its end
  T gas_ratio;      ///< of the mean temperature

  /// The temperature's rise is worked out as such: exp() and a difference would lose a slow crank's.
  [[nodiscard, gnu::always_inline]] static ClosedStep of(CylinderGasNow<T>& gas, const T& volume_m3, const T& heat_J,
                                                         const GasWalls<Real>& walls,
                                                         const GasDrive<Real>& drive) noexcept {
    constexpr Real b = kHeatSlope<Real>;
    const auto c = [](double x) { return static_cast<Real>(x); };
    const T wall_W = wall_heat_W<T>(walls, gas.point, gas.volume_m3, drive.stirring_m_s);
    const T wall_heat_J =
        held_within<T>(drive.step_s * (c(1.5) * wall_W - c(0.5) * gas.wall_heat_W), c(0.25) * gas.contents.energy_J);
    gas.wall_heat_W = wall_W;
    const T g = gas.point.gas_ratio;
    const T mass_kg = gas.contents.mass_kg;
    const T half_K = (heat_J - wall_heat_J) * g * (c(0.5) * kPerGasConstant<Real>) / mass_kg;
    const T from_K = gas.point.temperature_K + half_K;
    const T z = c(2) * (gas.volume_m3 - volume_m3) / (gas.volume_m3 + volume_m3);
    const T z2 = z * z;
    const T logarithm = z * (c(1) + z2 * (c(1.0 / 12) + z2 * c(1.0 / 80)));  // ln(V / V1)
    const T y = b * kPerGasConstant<Real> * g * (from_K * (c(0.5) * g * logarithm) + half_K);
    const T mean_g = g * (c(1) + y * (y - c(1)));
    const T e = mean_g * logarithm;
    const T rise_K = from_K * e / (c(1) + e * (e * c(1.0 / 12) - c(0.5)));
    const T to_K = from_K + rise_K;
    const T end_K = to_K + half_K;
    const T least_K = c(0.5) * to_K;
    const T mean_cv = heat_at_0_K<T>(gas.point.burned_ratio) + b / 2 * (from_K + to_K);
    return {volume_m3,
            c(1) / volume_m3,
            heat_J,
            wall_heat_J,
            -mass_kg * rise_K * mean_cv,
            end_K > least_K ? end_K : least_K,
            mean_g};
  }

  [[nodiscard, gnu::always_inline]] ClosedStep<Real> of_lane(int i) const noexcept {
    return {lane(volume_m3, i), lane(per_volume_m3, i), lane(heat_J, i),   lane(wall_heat_J, i),
            lane(work_J, i),    lane(temperature_K, i), lane(gas_ratio, i)};
  }
};

/// What the sums gain in a step.
template <class T>
struct GasGain {
  T mass_kg, energy_J, burned_kg;

  [[nodiscard, gnu::always_inline]] GasGain<NumberOf<T>> of_lane(int i) const noexcept {
    return {lane(mass_kg, i), lane(energy_J, i), lane(burned_kg, i)};
  }
  [[gnu::always_inline]] void put(int i, const GasGain<NumberOf<T>>& own) noexcept {
    put_lane(mass_kg, i, own.mass_kg), put_lane(energy_J, i, own.energy_J), put_lane(burned_kg, i, own.burned_kg);
  }
};

/// What a step did.
template <class T>
struct CylinderStep {
  ClosedStep<T> closed;
  T work_J;  ///< on the piston, absolute

  /// What the first law adds to the internal energy: `enthalpy_J` came with what flowed in.
  [[nodiscard, gnu::always_inline]] T gained_J(const T& enthalpy_J) const noexcept {
    return (closed.heat_J - closed.wall_heat_J - work_J) + enthalpy_J;
  }
};

/// Steps a cylinder, or several abreast. `flow(lane, closed, gain)` lets flow what flows there: adds to the lane's
/// gain, answers the work on its piston. Contents that no engine holds are still to be put right.
template <class T, class Flow>
[[nodiscard, gnu::always_inline]] inline CylinderStep<T> step_gas(CylinderGasNow<T>& gas, const T& volume_m3,
                                                                  const T& fuel_kg, const GasFuel<NumberOf<T>>& fuel,
                                                                  const GasWalls<NumberOf<T>>& walls,
                                                                  const GasDrive<NumberOf<T>>& drive,
                                                                  const Flow& flow) noexcept {
  const ClosedStep<T> closed = ClosedStep<T>::of(gas, volume_m3, fuel.energy_J_kg * fuel_kg, walls, drive);
  GasGain<T> gain{fuel_kg, closed.heat_J - closed.wall_heat_J - closed.work_J, fuel.burned_kg_kg * fuel_kg};
  T flow_work_J{};
  for (int i = 0; i < kLanesIn<T>; ++i) put_lane(flow_work_J, i, flow(i, closed, gain));
  gas.contents.add(gain.mass_kg, gain.energy_J, gain.burned_kg);
  gas.volume_m3 = volume_m3;
  gas.point = point_of<T>(gas.contents, closed.per_volume_m3);
  return {closed, closed.work_J + flow_work_J};
}

/// What came through a port in a step.
template <class Real>
struct PortStep {
  Real mass_kg, enthalpy_J, burned_kg;  ///< into the near side

  /// From the far side.
  [[nodiscard]] static PortStep in(Real mass_kg, const GasBeyond<Real>& far) noexcept {
    return {mass_kg, mass_kg * far.enthalpy_J_kg, mass_kg * far.burned_ratio};
  }
};

/// The gas as it flows out: what there is before it does.
template <class Real>
struct FlowingGas {
  Real mass_kg, energy_J, burned_kg;

  /// A negative mass of it, at most half. That cools what stays: (1 + r) F (1 - F/2) / (1 - (1 - r) F/2) of the energy
  /// for a share F of the mass; r = R T / e.
  [[nodiscard]] PortStep<Real> out(Real mass_kg_in, Real specific_work_J_kg) const noexcept {
    Real taken_kg = -mass_kg_in;
    if (__builtin_expect(!(taken_kg <= mass_kg / 2), 0)) taken_kg = mass_kg / 2;
    const Real share = taken_kg / mass_kg;
    const Real half = share / 2;
    const Real work_J = specific_work_J_kg * mass_kg;  // r U
    const Real leaving_J =
        (energy_J + work_J) * energy_J * (share - share * half) / (energy_J - (energy_J - work_J) * half);
    return {-taken_kg, -leaving_J, -share * burned_kg};
  }
};

/// What a port brings or takes.
template <class Real>
[[nodiscard]] inline PortStep<Real> exchange(Real mass_kg, const FlowingGas<Real>& near, Real specific_work_J_kg,
                                             const GasBeyond<Real>& far) noexcept {
  return mass_kg < 0 ? near.out(mass_kg, specific_work_J_kg) : PortStep<Real>::in(mass_kg, far);
}

/// What both ports bring or take. Half of what flows in mixes before what flows out leaves, the other half after: of
/// second order.
template <class Real>
inline void exchange(const PortFlow<Real> (&flow)[kPorts], FlowingGas<Real> near, Real specific_work_J_kg,
                     const GasBeyond<Real> (&far)[kPorts], PortStep<Real> (&step)[kPorts]) noexcept {
  Real in_kg{}, out_kg{};
  for (int i = 0; i < kPorts; ++i) {
    if (flow[i].mass_kg < 0) {
      out_kg += flow[i].mass_kg;
      continue;
    }
    step[i] = PortStep<Real>::in(flow[i].mass_kg, far[i]);
    near.mass_kg += step[i].mass_kg / 2;
    near.energy_J += step[i].enthalpy_J / 2;
    near.burned_kg += step[i].burned_kg / 2;
    in_kg += step[i].mass_kg;
  }
  if (!(out_kg < 0)) return;
  if (in_kg > 0) {
    const Real per_mass = Real{1} / near.mass_kg;
    const Real e = near.energy_J * per_mass;
    const Real a = heat_at_0_K(near.burned_kg * per_mass);
    specific_work_J_kg = 2 * kGasConstant<Real> * e / (a + square_root(a * a + 2 * kHeatSlope<Real> * e));
  }
  const PortStep<Real> both = near.out(out_kg, specific_work_J_kg);
  for (int i = 0; i < kPorts; ++i) {
    if (!(flow[i].mass_kg < 0)) continue;
    const Real part = flow[i].mass_kg / out_kg;
    step[i] = {part * both.mass_kg, part * both.enthalpy_J, part * both.burned_kg};
  }
}

/// No area is negative: one that is not 0 has a bit set.
template <class Real>
[[nodiscard, gnu::always_inline]] inline bool any_port_open(const CylinderGas<Real>& gas,
                                                            const Real (&to_m2)[kPorts]) noexcept {
  std::uint64_t from[sizeof to_m2 / 8], to[sizeof to_m2 / 8];
  std::memcpy(from, gas.area_m2, sizeof from);
  std::memcpy(to, to_m2, sizeof to);
  if constexpr (sizeof(Real) == 4) {
    return (from[0] | to[0]) != 0;
  } else {
    return ((from[0] | to[0]) | (from[1] | to[1])) != 0;
  }
}

/// The flow of a step, where a port is open at either end of it. `far` are the manifolds at the ports, as they stand.
/// Adds to what is gained, tells of each port that flows `took(port, PortStep)`, answers the work on the piston by what
/// flowed.
template <class Real, class Took>
[[nodiscard, gnu::always_inline]] inline Real flow_through_ports(CylinderGas<Real>& gas, const ClosedStep<Real>& closed,
                                                                 GasGain<Real>& gain, const Real (&to_m2)[kPorts],
                                                                 const GasBeyond<Real> (&far)[kPorts],
                                                                 const GasDrive<Real>& drive,
                                                                 const Took& took) noexcept {
  const Real own_m2 = closed.volume_m3 * drive.area_per_m3;
  const auto limited = [&](int port) -> PortAreas<Real> {
    const Real most_m2 = own_m2 < far[port].most_area_m2 ? own_m2 : far[port].most_area_m2;
    const Real from_m2 = gas.area_m2[port];
    gas.area_m2[port] = to_m2[port] < most_m2 ? to_m2[port] : most_m2;
    return {from_m2, gas.area_m2[port]};
  };
  const PortAreas<Real> intake = limited(kIntake), exhaust = limited(kExhaust);
  const FlowingGas<Real> before{gas.contents.mass_kg + gain.mass_kg, gas.contents.energy_J + gain.energy_J,
                                gas.contents.burned_kg + gain.burned_kg};
  const Real response = (Real{1} + closed.gas_ratio) * closed.per_volume_m3;  // Pa per kg and R T
  const Real specific_work_J_kg = kGasConstant<Real> * closed.temperature_K;
  const GasNear<Real> near{before.mass_kg * specific_work_J_kg * closed.per_volume_m3, closed.temperature_K,
                           response * specific_work_J_kg};
  Real moved_Pa;
  const auto take = [&gain, &took](int port, const PortStep<Real>& step) {
    gain.mass_kg += step.mass_kg, gain.energy_J += step.enthalpy_J, gain.burned_kg += step.burned_kg;
    took(port, step);
  };
  if (__builtin_expect(intake.open() && exhaust.open(), 0)) {
    const PortAreas<Real> area[kPorts] = {intake, exhaust};
    const Real in_Pa_kg[kPorts] = {response * far[kIntake].specific_work_J_kg,
                                   response * far[kExhaust].specific_work_J_kg};
    PortFlow<Real> flow[kPorts];
    two_port_flow(area, gas.point, near, in_Pa_kg, far, drive.step_s, flow);
    PortStep<Real> step[kPorts] = {};
    exchange(flow, before, specific_work_J_kg, far, step);
    moved_Pa = flow[kIntake].per_kg_Pa * step[kIntake].mass_kg + flow[kExhaust].per_kg_Pa * step[kExhaust].mass_kg;
    for (int i = 0; i < kPorts; ++i) take(i, step[i]);
  } else {
    const int port = exhaust.open() ? kExhaust : kIntake;
    const GasBeyond<Real>& beyond = far[port];
    const PortFlow<Real> flow = one_port_flow(exhaust.open() ? exhaust : intake, gas.point, near,
                                              response * beyond.specific_work_J_kg, beyond, drive.step_s);
    const PortStep<Real> step = exchange(flow.mass_kg, before, specific_work_J_kg, beyond);
    moved_Pa = flow.per_kg_Pa * step.mass_kg;
    take(port, step);
  }
  // What flows moves the pressure on the way: half of that, over the step, works too.
  const Real left_J = gas.contents.energy_J + gain.energy_J;
  const Real work_J =
      held_within<Real>((closed.volume_m3 - gas.volume_m3) / 2 * moved_Pa, left_J > 0 ? left_J / 4 : Real{0});
  gain.energy_J -= work_J;
  return work_J;
}

}  // namespace crankloop::detail
