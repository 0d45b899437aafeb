// One step of the gas in a cylinder. docs/model.md "Gas".
//
// What belongs here: heat, compression, what the ports bring and take, in the order in which a step has them. What does
// not: how much flows (port_overlap.hpp), what that takes along (exchange.hpp), what burns (combustion.hpp), the
// engine's step (gas_step.hpp), crevices (crevice.hpp). T is a number, or lanes of several cylinders.
//
//     half of the heat -> compression -> the other half -> crevices -> flow at the pressure that this leads to -> sums
#pragma once

#include <type_traits>

#include <crankloop/tick/gas/exchange.hpp>
#include <crankloop/tick/gas/gas_state.hpp>
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

/// What a step's fuel adds to the sums of a cylinder.
template <class T>
struct GasFuel {
  T mass_kg;
  T energy_J;  ///< heat, and the energies of what burns and what comes of it
  T burned_kg;
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
  template <class Walls>
  [[nodiscard, gnu::always_inline]] static ClosedStep of(CylinderGas<T>& gas, const T& volume_m3, const T& heat_J,
                                                         const Walls& walls, const GasDrive<Real>& drive) noexcept {
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
};

/// What a step did, beside what went through its ports: an array of its own, or GCC copies it from one place in memory
/// to another.
template <class T>
struct CylinderStep {
  ClosedStep<T> closed;
  T work_J;    ///< on the piston, absolute
  bool flows;  ///< through any port

  /// What the first law adds to the internal energy.
  [[nodiscard, gnu::always_inline]] T gained_J(const PortStep<T> (&through)[kPorts]) const noexcept {
    return (closed.heat_J - closed.wall_heat_J - work_J) + (through[kIntake].enthalpy_J + through[kExhaust].enthalpy_J);
  }
};

/// A step whose gas had to be put back, by one lane: what is no number in it, or more than any engine's, was nothing.
/// Neither the crank nor a manifold nor a cycle's results keep it.
template <class T>
[[gnu::always_inline]] inline void drop_nonsense(CylinderStep<T>& step, PortStep<T> (&through)[kPorts],
                                                 int i) noexcept {
  using Real = NumberOf<T>;
  constexpr Real kMax = static_cast<Real>(1e12);  // J, kg
  const auto hold = [i](T & x) __attribute__((always_inline)) {
    put_lane(x, i, within_magnitude(lane(x, i), kMax) ? lane(x, i) : Real{0});
  };
  hold(step.closed.heat_J), hold(step.closed.wall_heat_J), hold(step.work_J);
  for (PortStep<T>& port : through) hold(port.mass_kg), hold(port.enthalpy_J), hold(port.burned_kg);
}

/// Lanes that have a port open at either end of a step. No area is negative: one that is not 0 has a bit set.
template <class T>
[[nodiscard, gnu::always_inline]] inline auto any_open(const T& a, const T& b, const T& c, const T& d) noexcept {
  BitsOf<T> bits[4];
  std::memcpy(&bits[0], &a, sizeof a), std::memcpy(&bits[1], &b, sizeof b);
  std::memcpy(&bits[2], &c, sizeof c), std::memcpy(&bits[3], &d, sizeof d);
  return ((bits[0] | bits[1]) | (bits[2] | bits[3])) != 0;
}

/// What the sums of a cylinder gain in a step.
template <class T>
struct GasGain {
  T mass_kg, energy_J, burned_kg;

  [[gnu::always_inline]] void add(const PortStep<T>& step) noexcept {
    mass_kg += step.mass_kg, energy_J += step.enthalpy_J, burned_kg += step.burned_kg;
  }
};

/// The flow of a step through the ports that are `open` at either end of it. `far` are the manifolds at the ports,
/// `give_way` how much of a kilogram goes to crevices, for each that stays. Adds to what is gained; answers the work on
/// the piston by what flowed.
template <class T, class Far, class Holds, class GiveWay>
[[nodiscard, gnu::always_inline]] inline T flow_through_ports(const Holds& open, const CylinderGas<T>& gas,
                                                              const ClosedStep<T>& closed,
                                                              [[maybe_unused]] const GiveWay& give_way,
                                                              const T (&to_m2)[kPorts], const Far (&far)[kPorts],
                                                              NumberOf<T> step_s, GasGain<T>& gain,
                                                              PortStep<T> (&through)[kPorts]) noexcept {
  using Real = NumberOf<T>;
  T response = (Real{1} + closed.gas_ratio) * closed.per_volume_m3;  // Pa per kg and R T
  if constexpr (std::is_same_v<GiveWay, T>) response = response / (Real{1} + give_way);
  const T specific_work_J_kg = kGasConstant<Real> * closed.temperature_K;
  const FlowingGas<T> before{gas.contents.mass_kg + gain.mass_kg, gas.contents.energy_J + gain.energy_J,
                             gas.contents.burned_kg + gain.burned_kg, specific_work_J_kg};
  const GasNear<T> near{before.mass_kg * specific_work_J_kg * closed.per_volume_m3, closed.temperature_K,
                        response * specific_work_J_kg, closed.gas_ratio / (Real{1} + closed.gas_ratio)};
  const T intake_m2 = gas.area_m2[kIntake] + to_m2[kIntake], exhaust_m2 = gas.area_m2[kExhaust] + to_m2[kExhaust];
  const auto exhaust = exhaust_m2 > intake_m2;
  const auto both = both_hold(intake_m2 > Real{0}, exhaust_m2 > Real{0});
  const auto opening = [&](const auto& at_exhaust) __attribute__((always_inline))->Opening<T> {
    const BeyondOf<T> there = beyond_port<T>(far, at_exhaust);
    return {pick(at_exhaust, gas.area_m2[kExhaust], gas.area_m2[kIntake]),
            pick(at_exhaust, to_m2[kExhaust], to_m2[kIntake]), there, response * there.specific_work_J_kg};
  };
  PortStep<T> larger{}, other{};
  T larger_Pa_kg{}, other_Pa_kg{};
  const bool overlap = any(both);
  if (!all(both)) {
    const Opening<T> at = opening(exhaust);
    const PortFlow<T> flow = one_port_flow(at, gas.point, near, step_s);
    larger = exchange(where(open, flow.mass_kg), before, at.far), larger_Pa_kg = flow.per_kg_Pa;
  }
  if (__builtin_expect(overlap, 0)) {
    const Opening<T> at[2] = {opening(exhaust), opening(none_of(exhaust))};
    const GasPoint<T> begin = gas.point;
    const GasNear<T> of_both = near;
    PortFlow<T> flow[2];
    PortStep<T> step[2];
    flow_in_overlap(at, begin, of_both, before, step_s, flow, step);
    larger = pick(both, step[0], larger), larger_Pa_kg = pick(both, flow[0].per_kg_Pa, larger_Pa_kg);
    other = where(both, step[1]), other_Pa_kg = flow[1].per_kg_Pa;
  }
  // What flows moves the pressure on the way: half of that, over the step, works too. What flows out leaves with the
  // enthalpy that it has on the way, not at the step's end: less by as much, and without half of the step's heat.
  const T half_m3 = (closed.volume_m3 - gas.volume_m3) * static_cast<Real>(0.5);
  const T left_J = before.energy_J + (larger.enthalpy_J + other.enthalpy_J);
  const T most_J = where(left_J > Real{0}, left_J * static_cast<Real>(0.25));
  const T warmer_J_kg =
      static_cast<Real>(0.5) * (Real{1} + closed.gas_ratio) * (closed.wall_heat_J - closed.heat_J) / before.mass_kg;
  const auto let_work = [&](PortStep<T> & step, const T& per_kg_Pa) __attribute__((always_inline)) {
    const T work_J = held_within<T>(half_m3 * per_kg_Pa * step.mass_kg, most_J);
    step.enthalpy_J += where(step.mass_kg < Real{0}, work_J + warmer_J_kg * step.mass_kg);
    gain.add(step);
    gain.energy_J -= work_J;
    return work_J;
  };
  T work_J = let_work(larger, larger_Pa_kg);
  if (overlap) work_J += let_work(other, other_Pa_kg);
  through[kIntake] = pick(exhaust, other, larger), through[kExhaust] = pick(exhaust, larger, other);
  return work_J;
}

/// Of a cylinder without crevices nothing comes between the closed step and the flow.
struct NoCrevices {
  template <class T>
  constexpr NoCrevices operator()(ClosedStep<T>&, GasGain<T>&) const noexcept {
    return {};
  }
};

/// Steps a cylinder, or several abreast. Contents that no engine holds are still to be put right. `crevices(closed,
/// gain)` takes what goes into crevices from the cylinder and answers how much they give way to flow through the ports.
template <class T, class Walls, class Far, class Crevices = NoCrevices>
[[nodiscard, gnu::always_inline]] inline CylinderStep<T> step_gas(CylinderGas<T>& gas, const T& volume_m3,
                                                                  const GasFuel<T>& fuel, const Walls& walls,
                                                                  const GasDrive<NumberOf<T>>& drive,
                                                                  const T (&to_m2)[kPorts], const Far (&far)[kPorts],
                                                                  PortStep<T> (&through)[kPorts],
                                                                  const Crevices& crevices = {}) noexcept {
  ClosedStep<T> closed = ClosedStep<T>::of(gas, volume_m3, fuel.energy_J, walls, drive);
  through[kIntake] = through[kExhaust] = PortStep<T>{};
  GasGain<T> gain{fuel.mass_kg, closed.heat_J - closed.wall_heat_J - closed.work_J, fuel.burned_kg};
  const auto give_way = crevices(closed, gain);
  T work_J = closed.work_J;
  const auto open = any_open(gas.area_m2[kIntake], gas.area_m2[kExhaust], to_m2[kIntake], to_m2[kExhaust]);
  const bool flows = any(open);
  if (flows) {
    const T own_m2 = volume_m3 * drive.area_per_m3;
    T limited_m2[kPorts];
    for (int port = 0; port < kPorts; ++port) {
      limited_m2[port] = to_m2[port] < own_m2 ? to_m2[port] : own_m2;
    }
    work_J += flow_through_ports(open, gas, closed, give_way, limited_m2, far, drive.step_s, gain, through);
    for (int port = 0; port < kPorts; ++port) gas.area_m2[port] = limited_m2[port];
  } else {
    gain.add(PortStep<T>{});  // as lanes have it beside one that is open: -0 becomes 0
  }
  gas.contents.add(gain.mass_kg, gain.energy_J, gain.burned_kg);
  gas.volume_m3 = volume_m3;
  gas.point = point_of<T>(gas.contents, closed.per_volume_m3);
  return {closed, work_J, flows};
}

}  // namespace crankloop::detail
