// A runner over one step: the pipe between a manifold and a port of one cylinder, with the inertia of its gas.
// docs/model.md "Runners".
//
// What belongs here: its flow and its port volume, before and after the cylinder's step. What does not: the flow
// through the valve (port_flow.hpp), the manifold (manifold.hpp).
//
//     dw/dt = (A / l) (P_manifold - p - zeta w |w| / (2 rho A^2)),   port of 4/pi^2 A l:  dm/dt = w - w_valve
//
// One mode: the port's share of the pipe's volume is the one that gives a pipe shut at one end its first frequency,
// a / (4 l). w is positive toward the cylinder.
#pragma once

#include <crankloop/faults.hpp>
#include <crankloop/tick/gas/exchange.hpp>
#include <crankloop/tick/gas/gas_state.hpp>

namespace crankloop::detail {

/// Share of a port's gas, at least, that a step leaves there.
template <class Real>
inline constexpr Real kStays = static_cast<Real>(0.125);

inline constexpr double kMaxRunner_kg_s = 1e6;  ///< more than any runner's

/// What a runner meets in a step; T is a number, or lanes of several cylinders.
template <class T>
struct RunnerEnds {
  const GasBeyond<NumberOf<T>>& manifold;
  T manifold_Pa;              ///< at the step's end if nothing flowed through this runner
  T cylinder_Pa, cylinder_K;  ///< at the start of the step
  T from_m2;                  ///< effective area of the valves then
  NumberOf<T> most_kg;        ///< that the manifold may give
};

template <class T>
[[nodiscard, gnu::always_inline]] inline T larger_of(const T& a, const T& b) noexcept {
  return pick(a > b, a, b);
}
template <class T>
[[nodiscard, gnu::always_inline]] inline T smaller_of(const T& a, const T& b) noexcept {
  return pick(a < b, a, b);
}

/// From before the cylinder's step to after it.
template <class T>
struct RunnerStep {
  T flow_kg_s;  ///< if nothing flows through the valve
  T share;      ///< of the valve's flow that the runner makes good within the step
  T explicit_share, per_implicit_share;
  NumberOf<T> forward_kg_s;  ///< bounds: the speed of sound and a little more
  T backward_kg_s_Pa;
  T begin_kg, begin_J, begin_enthalpy_J_kg, begin_ratio;

  /// At most what gas flows at 1.2 times sqrt(R T). It acts in ticks of several degrees, and on an exhaust runner that
  /// a motored engine at high speed all but empties: docs/model.md "Runners".
  [[nodiscard, gnu::always_inline]] T bounded(const T& flow, const T& port_Pa) const noexcept {
    const T back = -backward_kg_s_Pa * port_Pa, most = spread<T>(forward_kg_s);
    return pick(flow > most, most, pick(flow < back, back, flow));
  }
};

/// What a valve sees of its runner in a step. Implicit by the share theta of the step in the pressures' part, by all of
/// it in the friction.
template <class T>
[[nodiscard]] inline GasBeyond<T> seen_of_runner(const RunnerGas<T>& runner, const GasRunner<NumberOf<T>>& table,
                                                 const RunnerEnds<T>& ends, NumberOf<T> step_s,
                                                 RunnerStep<T>& step) noexcept {
  using Real = NumberOf<T>;
  constexpr auto kBound = static_cast<Real>(1.2 / 0.6778852870696124);  // of psi_c
  const GasPoint<T>& port = runner.point;
  const GasBeyond<Real>& manifold = ends.manifold;
  const T w = runner.flow_kg_s, one = spread<T>(1);
  GasBeyond<T> seen = beyond(port, T{});
  const T per_density = either<T>(
      w >= Real{0}, [&] { return spread<T>(manifold.specific_work_J_kg / manifold.pressure_Pa); },
      [&] { return seen.specific_work_J_kg / port.pressure_Pa; });
  const T own_Pa_kg = (Real{1} + port.gas_ratio) * seen.specific_work_J_kg * table.per_volume_m3;
  const auto open = ends.from_m2 > Real{0};
  const T warmer = either<T>(
      both_hold(open, ends.cylinder_Pa > port.pressure_Pa), [&] { return ends.cylinder_K / port.temperature_K; },
      [&] { return one; });
  const Real pushed = step_s * table.area_per_length_m;
  const T friction = pushed * table.loss_per_m4 * magnitude(w) * per_density;
  const T stiffness = step_s * pushed * (own_Pa_kg + manifold.response_Pa_kg);
  const T per_both = Real{1} / (Real{6} + stiffness);
  const T theta = (Real{3} + stiffness) * per_both;
  step.explicit_share = Real{3} * per_both;
  step.per_implicit_share = (Real{6} + stiffness) / (Real{3} + stiffness);
  const T per_all = Real{1} / (Real{1} + friction + theta * theta * stiffness);
  step.forward_kg_s = kBound * table.area_m2 * manifold.pressure_Pa * manifold.choked_per_Pa;
  step.backward_kg_s_Pa = kBound * table.area_m2 * seen.choked_per_Pa;
  step.flow_kg_s = step.bounded(per_all * (w * (theta + step.explicit_share * (Real{1} + friction)) +
                                           theta * pushed * (ends.manifold_Pa - port.pressure_Pa)),
                                port.pressure_Pa);
  const T follows = theta * theta * step_s * pushed * own_Pa_kg * per_all;
  step.share = smaller_of(T{follows * warmer}, one);
  const T in_kg = step_s * step.flow_kg_s;
  const auto enters = in_kg > Real{0};
  const T rises_Pa =
      in_kg * own_Pa_kg *
      either<T>(
          enters, [&] { return manifold.specific_work_J_kg / seen.specific_work_J_kg; }, [&] { return one; });
  seen.end_Pa = larger_of(T{port.pressure_Pa + rises_Pa}, T{port.pressure_Pa / Real{16}});
  const T mass_kg = runner.contents.mass_kg;
  // A valve takes no more than most of what is there and what may come.
  const Real sound_kg = step_s * step.forward_kg_s;
  const Real comes_kg = sound_kg < ends.most_kg ? sound_kg : ends.most_kg;
  seen.response_Pa_kg = larger_of(T{own_Pa_kg * warmer * (Real{1} - follows)},
                                  T{seen.end_Pa / ((Real{1} - kStays<Real>)*mass_kg + comes_kg)});
  step.begin_kg = mass_kg, step.begin_J = runner.contents.energy_J;
  step.begin_enthalpy_J_kg = seen.enthalpy_J_kg, step.begin_ratio = seen.burned_ratio;
  if (any(enters)) {  // mixes before it flows out
    const T mixes_kg = in_kg * (mass_kg + in_kg) / (Real{2} * mass_kg + in_kg), per_kg = Real{1} / (mass_kg + mixes_kg);
    const auto mixed = [&](T & own, Real comes) __attribute__((always_inline)) {
      own = pick(enters, T{(mass_kg * own + mixes_kg * comes) * per_kg}, own);
    };
    mixed(seen.enthalpy_J_kg, manifold.enthalpy_J_kg), mixed(seen.burned_ratio, manifold.burned_ratio);
  }
  if (any(open)) {  // end_Pa is without the valve's flow, as_was_Pa takes it off
    const Orifice<T> flow = Orifice<T>::at(ends.cylinder_Pa, ends.cylinder_K, seen);
    seen.as_was_Pa = where(open, T{-seen.response_Pa_kg * (step_s * ends.from_m2 * flow.flow_kg_s_m2)});
  }
  return seen;
}

template <class T>
[[nodiscard, gnu::always_inline]] inline auto is_well_runner(const RunnerGas<T>& runner,
                                                             const GasRunner<NumberOf<T>>& table) noexcept {
  return both_hold(is_well<T>(runner.point, runner.contents.mass_kg, spread<T>(table.least_kg)),
                   magnitude(runner.flow_kg_s) <= static_cast<NumberOf<T>>(kMaxRunner_kg_s));
}
/// Puts a runner that is not well back there; what moved and is no number, or more than any engine's, was nothing.
/// Answers fault bits: none where it was off by rounding alone.
template <class Real>
[[gnu::cold, gnu::noinline]] std::uint32_t put_runner_right(RunnerGas<Real>& runner, const GasRunner<Real>& table,
                                                            PortStep<Real>& moves) noexcept {
  const bool still = within_magnitude(runner.flow_kg_s, static_cast<Real>(kMaxRunner_kg_s));
  const bool put_back = put_right(runner.contents, runner.point, table.per_volume_m3, table.least_kg);
  if (still && !put_back) return 0;
  if (!still) runner.flow_kg_s = runner.flow_rest_kg_s = Real{0};
  constexpr Real kMax = static_cast<Real>(1e12);
  for (Real* x : {&moves.mass_kg, &moves.enthalpy_J, &moves.burned_kg})
    if (!within_magnitude(*x, kMax)) *x = Real{0};
  return kFaultGas;
}

/// After the cylinder's step, which took `valve` out of the port: what came from the manifold. `most_kg` is what that
/// may give.
template <class T>
[[nodiscard]] inline PortStep<T> step_runner(RunnerGas<T>& runner, const GasRunner<NumberOf<T>>& table,
                                             const RunnerStep<T>& step, const GasBeyond<NumberOf<T>>& manifold,
                                             const GasBeyond<T>& seen, const PortStep<T>& valve, NumberOf<T> most_kg,
                                             NumberOf<T> step_s) noexcept {
  using Real = NumberOf<T>;
  GasContents<T>& gas = runner.contents;
  gas.add(-valve.mass_kg, -valve.enthalpy_J, -valve.burned_kg);
  const T left_Pa = seen.end_Pa - seen.response_Pa_kg * valve.mass_kg;
  const T wants =
      step.bounded(step.flow_kg_s + step.share * valve.mass_kg / step_s, larger_of(left_Pa, runner.point.pressure_Pa));
  T enthalpy_J_kg = step.begin_enthalpy_J_kg, ratio = step.begin_ratio;
  const auto backs = valve.mass_kg < Real{0};
  if (any(backs)) {
    const T kg = step.begin_kg, in_kg = -valve.mass_kg, mixes = (kg + in_kg) / (Real{2} * kg + in_kg);
    const T per_kg = Real{1} / (kg + mixes * in_kg);
    enthalpy_J_kg = pick(backs, T{(kg * enthalpy_J_kg - mixes * valve.enthalpy_J) * per_kg}, enthalpy_J_kg);
    ratio = pick(backs, T{(kg * ratio - mixes * valve.burned_kg) * per_kg}, ratio);
  }
  const T wants_kg = step_s * wants, manifold_J_kg = spread<T>(manifold.enthalpy_J_kg);
  const T lacks_J = kStays<Real> * step.begin_J - gas.energy_J, lacks_kg = kStays<Real> * step.begin_kg - gas.mass_kg;
  const T for_energy_kg = lacks_J / pick(lacks_J > Real{0}, manifold_J_kg, enthalpy_J_kg);
  const T at_least_kg = larger_of(wants_kg, larger_of(for_energy_kg, lacks_kg));
  const T in_kg = smaller_of(at_least_kg, spread<T>(most_kg));
  const auto in = in_kg > Real{0};
  const T moves_J_kg = pick(in, manifold_J_kg, enthalpy_J_kg),
          moves_ratio = pick(in, spread<T>(manifold.burned_ratio), ratio);
  const PortStep<T> moves{in_kg, in_kg * moves_J_kg, in_kg * moves_ratio};
  gas.add(moves.mass_kg, moves.enthalpy_J, moves.burned_kg);
  const T next = either<T>(
      in_kg == wants_kg, [&] { return (wants - step.explicit_share * runner.flow_kg_s) * step.per_implicit_share; },
      [&] { return in_kg / step_s; });
  add_carried(runner.flow_kg_s, runner.flow_rest_kg_s, T{next - runner.flow_kg_s});
  const auto holds = gas.mass_kg > Real{0};  // else put_runner_right()
  if (any(holds)) {
    const GasPoint<T> now = point_of(gas, spread<T>(table.per_volume_m3));
    GasPoint<T>& point = runner.point;
    point = {pick(holds, now.pressure_Pa, point.pressure_Pa), pick(holds, now.temperature_K, point.temperature_K),
             pick(holds, now.burned_ratio, point.burned_ratio), pick(holds, now.gas_ratio, point.gas_ratio)};
  }
  return moves;
}

}  // namespace crankloop::detail
