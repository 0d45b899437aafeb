// Crevices of a cylinder (top land, ring pack, gasket, plug) and its leak past the rings, over one step. docs/model.md
// "Crevices and blow-by".
//
// What belongs here: what a crevice takes from its cylinder and gives back, what leaves it for the crankcase. What does
// not: the cylinder's own step (cylinder_gas.hpp).
//
//     m_cr = c p,  c = V_cr / (R T_w);   w = dm_cr/dt + w_bb leaves the cylinder, w_bb the crevice for the crankcase
//     Namazian and Heywood, SAE 820088, with one volume
//
// Implicit: by the pressure at the start of the step a crevice would lag by a step, which is work (1.4 kPa of mean
// pressure at 50 us).
#pragma once

#include <crankloop/tick/gas/cylinder_gas.hpp>

namespace crankloop::detail {

/// What crevices of a cylinder, or of several abreast, did in a step.
template <class T>
struct CreviceStep {
  T blow_by_kg;   ///< into the crankcase
  T lost_J;       ///< enthalpy that the cylinder lost to them
  T wall_heat_J;  ///< what of it their walls took
};

/// A step whose cylinder had to be put back, by one lane: its crevices are filled anew.
template <class T>
[[gnu::always_inline]] inline void drop_nonsense(CreviceStep<T>& step, int i) noexcept {
  for (T* x : {&step.blow_by_kg, &step.lost_J, &step.wall_heat_J}) put_lane(*x, i, NumberOf<T>{0});
}

template <class Real>
[[nodiscard, gnu::always_inline]] inline bool leaks(const GasCrevice<Real>& table) noexcept {
  return table.leak_kg_s_Pa > 0;
}

/// Through the leak in a step, by the conductance at the step's mean pressure: regular where pressures are equal.
template <class T, class Table>
[[nodiscard, gnu::always_inline]] inline T blow_by_kg(const Table& table, const T& mean_Pa, const T& per_kg_Pa,
                                                      NumberOf<T> step_s) noexcept {
  using Real = NumberOf<T>;
  const Real behind_Pa = table.crankcase_Pa;
  const T apart_Pa = mean_Pa - behind_Pa;
  const T up_Pa = mean_Pa > behind_Pa ? mean_Pa : spread<T>(behind_Pa);
  const T relative = magnitude(apart_Pa) / up_Pa;
  const T s = relative * kPerChokedDrop<Real>;
  const T by_drop = either<T>(
      s < Real{1},
      [&] {
        const T left = Real{2} - s;
        return kPerChokedDrop<Real> * left / square_root(s * left + static_cast<Real>(4.3e-4));
      },
      [&]() __attribute__((always_inline, no_sanitize("float-divide-by-zero"))) { return Real{1} / relative; });
  const T conductance = step_s * table.leak_kg_s_Pa * by_drop;
  return conductance * apart_Pa / (Real{1} + conductance * per_kg_Pa);
}

/// Sets a sum; answers by how much that moved it, which is exact: a number as large as half of either.
template <class T>
[[nodiscard, gnu::always_inline]] inline T move_to(T& sum, const T& to) noexcept {
  const T moved = to - sum;
  sum = to;
  return moved;
}

/// The step of a crevice between the closed step of its cylinder and the flow through the ports: moves gas from the
/// sums that the cylinder gains, and its temperature and work. Answers how much of a kilogram that flows through
/// a port goes to the crevice, for each that stays. `table`: GasCrevice, or WarmCrevice of T.
template <class T, bool kLeaks, class Table>
[[nodiscard, gnu::always_inline]] inline T step_crevice(CreviceGas<T>& crevice, const Table& table,
                                                        const CylinderGas<T>& gas, NumberOf<T> step_s,
                                                        ClosedStep<T>& closed, GasGain<T>& gain,
                                                        CreviceStep<T>& step) noexcept {
  using Real = NumberOf<T>;
  constexpr Real b = kHeatSlope<Real>;
  constexpr Real kHalf = static_cast<Real>(0.5);
  const T mass_kg = gas.contents.mass_kg + gain.mass_kg;
  const T hot_K = closed.temperature_K;
  const T end_K = either<T>(
      gain.mass_kg > Real{0},
      [&] {  // of the heat of what burned, what makes its mass and its burned gas as warm as the rest
        const T makes_J_K = gain.mass_kg * (Real{646} + b / 2 * hot_K) + gain.burned_kg * Real{93};
        return hot_K - makes_J_K * closed.gas_ratio * kPerGasConstant<Real> * hot_K / mass_kg;
      },
      [&] { return hot_K; });
  const T per_kg_K_Pa = (Real{1} + closed.gas_ratio) * kGasConstant<Real> * closed.per_volume_m3;
  const T out_Pa_kg = per_kg_K_Pa * end_K, in_Pa_kg = per_kg_K_Pa * table.wall_K;
  const T end_Pa = mass_kg * kGasConstant<Real> * end_K * closed.per_volume_m3;
  T leak_kg{};
  if constexpr (kLeaks) leak_kg = blow_by_kg<T>(table, kHalf * (gas.point.pressure_Pa + end_Pa), out_Pa_kg, step_s);
  // What it lacks.
  T wants_kg = table.kg_per_Pa * end_Pa - crevice.mass_kg;
  if constexpr (kLeaks) wants_kg += leak_kg;
  const auto fills = wants_kg > Real{0};
  const T moves_Pa_kg = pick(fills, out_Pa_kg, in_Pa_kg);
  const T half_kg = kHalf * mass_kg;
  T taken_kg = wants_kg / (Real{1} + table.kg_per_Pa * moves_Pa_kg);
  taken_kg = taken_kg < half_kg ? taken_kg : half_kg;
  const T there_kg = crevice.mass_kg + taken_kg;
  if constexpr (kLeaks) leak_kg = leak_kg < there_kg ? leak_kg : there_kg;
  const T cylinder_ratio = either<T>(
      gain.burned_kg > Real{0}, [&] { return gas.point.burned_ratio + kHalf * gain.burned_kg / mass_kg; },
      [&] { return gas.point.burned_ratio; });  // in the middle of the step
  // What flows in mixes before it flows out.
  const auto mixes = [&]() __attribute__((always_inline)) {
    const T in_kg = where(fills, taken_kg);
    T mixed_kg = crevice.mass_kg + in_kg;
    if constexpr (kLeaks) mixed_kg += where(leak_kg < Real{0}, -leak_kg);
    const T ratio = (crevice.burned_kg + in_kg * cylinder_ratio) / (mixed_kg > Real{0} ? mixed_kg : spread<T>(1));
    const T most = ratio < Real{1} ? ratio : spread<T>(1);
    return most > Real{0} ? most : T{};
  };
  // What mixes keeps the share of the mixture: a crevice that has all but emptied would else show the digits that its
  // sum has lost as burned gas. Masses move by what their sums can show, so that no rest of theirs is to be carried.
  T burned_kg;
  if constexpr (kLeaks) {
    const auto unmixed = both_hold(fills, leak_kg == Real{0});
    const T burned_ratio = short_cut<T>(
        unmixed, [] { return T{}; }, mixes);
    taken_kg = leak_kg + move_to(crevice.mass_kg, there_kg - leak_kg);
    const T keeps_kg = pick(unmixed, crevice.burned_kg + taken_kg * cylinder_ratio, burned_ratio * crevice.mass_kg);
    burned_kg = where(leak_kg > Real{0}, leak_kg) * burned_ratio + move_to(crevice.burned_kg, keeps_kg);
  } else {
    const T burned_ratio = either<T>(
        fills, [] { return T{}; }, mixes);
    taken_kg = move_to(crevice.mass_kg, there_kg);
    const T keeps_kg = pick(fills, crevice.burned_kg + taken_kg * cylinder_ratio, burned_ratio * there_kg);
    burned_kg = move_to(crevice.burned_kg, keeps_kg);
  }
  const T kept_J = taken_kg * table.energy_J_kg + burned_kg * table.burned_more_J_kg;
  const T mean_K = kHalf * (gas.point.temperature_K + end_K);
  const T enthalpy_J = either<T>(
      fills,
      [&] {
        return taken_kg * (mean_K * (heat_at_0_K(cylinder_ratio) + b / 2 * mean_K) + kGasConstant<Real> * mean_K);
      },
      [&] { return kept_J + taken_kg * table.specific_work_J_kg; });
  const T left_kg = mass_kg - taken_kg;
  const T moved_K = pick(fills, closed.gas_ratio * end_K, (Real{1} + closed.gas_ratio) * table.wall_K - end_K);
  closed.temperature_K = end_K - taken_kg * moved_K / left_kg;
  const T work_J = (gas.volume_m3 - closed.volume_m3) * kHalf * (taken_kg * moves_Pa_kg);
  closed.work_J += work_J;
  gain.mass_kg -= taken_kg, gain.energy_J -= enthalpy_J + work_J, gain.burned_kg -= burned_kg;
  step = {leak_kg, enthalpy_J, enthalpy_J - kept_J};
  if constexpr (kLeaks) step.wall_heat_J -= leak_kg * table.specific_work_J_kg;
  return table.kg_per_Pa * per_kg_K_Pa * closed.temperature_K;
}

}  // namespace crankloop::detail
