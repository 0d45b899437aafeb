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

/// What a runner meets in a step.
template <class Real>
struct RunnerEnds {
  const GasBeyond<Real>& manifold;
  Real manifold_Pa;              ///< at the step's end if nothing flowed through this runner
  Real cylinder_Pa, cylinder_K;  ///< at the start of the step
  Real from_m2;                  ///< effective area of the valves then
  Real most_kg;                  ///< that the manifold may give
};

/// From before the cylinder's step to after it.
template <class Real>
struct RunnerStep {
  Real flow_kg_s;  ///< if nothing flows through the valve
  Real share;      ///< of the valve's flow that the runner makes good within the step
  Real explicit_share, per_implicit_share;
  Real forward_kg_s, backward_kg_s_Pa;  ///< bounds: the speed of sound and a little more
  Real begin_kg, begin_J, begin_enthalpy_J_kg, begin_ratio;

  /// At most what gas flows at 1.2 times sqrt(R T). It acts in ticks of several degrees, and on an exhaust runner that
  /// a motored engine at high speed all but empties: docs/model.md "Runners".
  [[nodiscard]] Real bounded(Real flow, Real port_Pa) const noexcept {
    const Real back = -backward_kg_s_Pa * port_Pa;
    return flow > forward_kg_s ? forward_kg_s : (flow < back ? back : flow);
  }
};

/// What a valve sees of its runner in a step. Implicit by the share theta of the step in the pressures' part, by all of
/// it in the friction.
template <class Real>
[[nodiscard]] inline GasBeyond<Real> seen_of_runner(const RunnerGas<Real>& runner, const GasRunner<Real>& table,
                                                    const RunnerEnds<Real>& ends, Real step_s,
                                                    RunnerStep<Real>& step) noexcept {
  constexpr auto kBound = static_cast<Real>(1.2 / 0.6778852870696124);  // of psi_c
  const GasPoint<Real>& port = runner.point;
  const GasBeyond<Real>& manifold = ends.manifold;
  const Real w = runner.flow_kg_s;
  GasBeyond<Real> seen = beyond(port, Real{0});
  const Real per_density =
      w >= 0 ? manifold.specific_work_J_kg / manifold.pressure_Pa : seen.specific_work_J_kg / port.pressure_Pa;
  const Real own_Pa_kg = (Real{1} + port.gas_ratio) * seen.specific_work_J_kg * table.per_volume_m3;
  const bool warms = ends.from_m2 > 0 && ends.cylinder_Pa > port.pressure_Pa;
  const Real warmer = warms ? ends.cylinder_K / port.temperature_K : Real{1};
  const Real pushed = step_s * table.area_per_length_m;
  const Real friction = pushed * table.loss_per_m4 * magnitude(w) * per_density;
  const Real stiffness = step_s * pushed * (own_Pa_kg + manifold.response_Pa_kg);
  const Real per_both = Real{1} / (Real{6} + stiffness);
  const Real theta = (Real{3} + stiffness) * per_both;
  step.explicit_share = Real{3} * per_both;
  step.per_implicit_share = (Real{6} + stiffness) / (Real{3} + stiffness);
  const Real per_all = Real{1} / (Real{1} + friction + theta * theta * stiffness);
  step.forward_kg_s = kBound * table.area_m2 * manifold.pressure_Pa * manifold.choked_per_Pa;
  step.backward_kg_s_Pa = kBound * table.area_m2 * seen.choked_per_Pa;
  step.flow_kg_s = step.bounded(per_all * (w * (theta + step.explicit_share * (Real{1} + friction)) +
                                           theta * pushed * (ends.manifold_Pa - port.pressure_Pa)),
                                port.pressure_Pa);
  const Real follows = theta * theta * step_s * pushed * own_Pa_kg * per_all;
  const Real made_good = follows * warmer;
  step.share = made_good < 1 ? made_good : Real{1};
  seen.response_Pa_kg = own_Pa_kg * warmer * (Real{1} - follows);
  const Real in_kg = step_s * step.flow_kg_s;
  const Real rises_Pa =
      in_kg > 0 ? in_kg * own_Pa_kg * (manifold.specific_work_J_kg / seen.specific_work_J_kg) : in_kg * own_Pa_kg;
  const Real end_Pa = port.pressure_Pa + rises_Pa, least_Pa = port.pressure_Pa / 16;
  seen.end_Pa = end_Pa > least_Pa ? end_Pa : least_Pa;
  const Real mass_kg = runner.contents.mass_kg;
  // A valve takes no more than most of what is there and what may come.
  const Real sound_kg = step_s * step.forward_kg_s;
  const Real comes_kg = sound_kg < ends.most_kg ? sound_kg : ends.most_kg;
  const Real least_Pa_kg = seen.end_Pa / ((Real{1} - kStays<Real>)*mass_kg + comes_kg);
  seen.response_Pa_kg = seen.response_Pa_kg > least_Pa_kg ? seen.response_Pa_kg : least_Pa_kg;
  step.begin_kg = mass_kg, step.begin_J = runner.contents.energy_J;
  step.begin_enthalpy_J_kg = seen.enthalpy_J_kg, step.begin_ratio = seen.burned_ratio;
  if (in_kg > 0) {  // mixes before it flows out
    const Real mixes_kg = in_kg * (mass_kg + in_kg) / (Real{2} * mass_kg + in_kg),
               per_kg = Real{1} / (mass_kg + mixes_kg);
    seen.enthalpy_J_kg = (mass_kg * seen.enthalpy_J_kg + mixes_kg * manifold.enthalpy_J_kg) * per_kg;
    seen.burned_ratio = (mass_kg * seen.burned_ratio + mixes_kg * manifold.burned_ratio) * per_kg;
  }
  if (ends.from_m2 > 0) {  // end_Pa is without the valve's flow, as_was_Pa takes it off
    const Orifice<Real> flow = Orifice<Real>::at(ends.cylinder_Pa, ends.cylinder_K, seen);
    seen.as_was_Pa = -seen.response_Pa_kg * (step_s * ends.from_m2 * flow.flow_kg_s_m2);
  }
  return seen;
}

template <class Real>
[[nodiscard]] inline bool is_well_runner(const RunnerGas<Real>& runner, const GasRunner<Real>& table) noexcept {
  return is_well(runner.point, runner.contents.mass_kg, table.least_kg) &&
         within_magnitude(runner.flow_kg_s, static_cast<Real>(kMaxRunner_kg_s));
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
template <class Real>
[[nodiscard]] inline PortStep<Real> step_runner(RunnerGas<Real>& runner, const GasRunner<Real>& table,
                                                const RunnerStep<Real>& step, const GasBeyond<Real>& manifold,
                                                const GasBeyond<Real>& seen, const PortStep<Real>& valve, Real most_kg,
                                                Real step_s) noexcept {
  GasContents<Real>& gas = runner.contents;
  gas.add(-valve.mass_kg, -valve.enthalpy_J, -valve.burned_kg);
  const Real left_Pa = seen.end_Pa - seen.response_Pa_kg * valve.mass_kg, port_Pa = runner.point.pressure_Pa;
  const Real wants =
      step.bounded(step.flow_kg_s + step.share * valve.mass_kg / step_s, left_Pa > port_Pa ? left_Pa : port_Pa);
  Real enthalpy_J_kg = step.begin_enthalpy_J_kg, ratio = step.begin_ratio;
  if (valve.mass_kg < 0) {
    const Real kg = step.begin_kg, in_kg = -valve.mass_kg, mixes = (kg + in_kg) / (Real{2} * kg + in_kg);
    const Real per_kg = Real{1} / (kg + mixes * in_kg);
    enthalpy_J_kg = (kg * enthalpy_J_kg - mixes * valve.enthalpy_J) * per_kg;
    ratio = (kg * ratio - mixes * valve.burned_kg) * per_kg;
  }
  Real in_kg = step_s * wants;
  const Real lacks_J = kStays<Real> * step.begin_J - gas.energy_J,
             lacks_kg = kStays<Real> * step.begin_kg - gas.mass_kg;
  const Real for_energy_kg = lacks_J / (lacks_J > 0 ? manifold.enthalpy_J_kg : enthalpy_J_kg);
  const Real least_kg = for_energy_kg > lacks_kg ? for_energy_kg : lacks_kg;
  in_kg = in_kg > least_kg ? in_kg : least_kg;
  in_kg = in_kg < most_kg ? in_kg : most_kg;
  const bool free = in_kg == step_s * wants;
  const PortStep<Real> moves =
      in_kg > 0 ? PortStep<Real>::in(in_kg, manifold) : PortStep<Real>{in_kg, in_kg * enthalpy_J_kg, in_kg * ratio};
  gas.add(moves.mass_kg, moves.enthalpy_J, moves.burned_kg);
  const Real next = free ? (wants - step.explicit_share * runner.flow_kg_s) * step.per_implicit_share : in_kg / step_s;
  add_carried(runner.flow_kg_s, runner.flow_rest_kg_s, next - runner.flow_kg_s);
  if (gas.mass_kg > 0) runner.point = point_of(gas, table.per_volume_m3);  // else put_runner_right()
  return moves;
}

}  // namespace crankloop::detail
