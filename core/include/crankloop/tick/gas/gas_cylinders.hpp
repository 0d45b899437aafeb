// One step of the gas of all cylinders: four abreast where they can, then one by one, with the same bits.
//
// What belongs here: what goes into a cylinder's step, where what it did goes. What does not: the step
// (cylinder_gas.hpp), the tick (gas_step.hpp).
//
//     prepare: volumes, fuel -> flow: the step -> sums: manifolds, work, results -> show
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/crevice.hpp>
#include <crankloop/tick/gas/gas_cycle.hpp>
#include <crankloop/tick/gas/gas_places.hpp>
#include <crankloop/tick/gas/gas_start.hpp>
#include <crankloop/tick/gas/manifold.hpp>
#include <crankloop/tick/gas/runner.hpp>
#include <crankloop/tick/gas/warm_walls.hpp>
#include <crankloop/tick/lanes.hpp>

namespace crankloop::detail {

template <class Real>
[[gnu::always_inline]] inline void show(const Real (&x)[7], CylinderGasOutput<Real>* shown) noexcept {
  *shown = {x[0], x[1], x[2], x[3], {x[4], x[5]}, x[6]};
}

#if CRANKLOOP_ABREAST
static_assert(offsetof(CylinderGasOutput<float>, flow_kg_s) == 4 * sizeof(float) &&
              offsetof(CylinderGasOutput<float>, wall_heat_W) == 6 * sizeof(float));
[[gnu::always_inline]] inline void show(const Four (&x)[7], CylinderGasOutput<float>* shown) noexcept {
  Four first[4] = {x[0], x[1], x[2], x[3]}, second[4] = {x[4], x[5], x[6], x[6]};
  transpose(first), transpose(second);
#pragma GCC unroll 4
  for (int i = 0; i < 4; ++i) {
    auto* const to = reinterpret_cast<unsigned char*>(shown + i);
    std::memcpy(to, &first[i], 4 * sizeof(float));
    std::memcpy(to + 4 * sizeof(float), &second[i], 3 * sizeof(float));
  }
}
#endif

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
class GasCylindersStep {
  using N = Needs<S>;
  static constexpr std::uint32_t kCylinders = S::cylinders.capacity;

 public:
  GasCylindersStep(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out, Real& work_J) noexcept
      : tables_{tables}, state_{state}, out_{out}, work_J_{work_J} {}

  /// Answers fault bits.
  [[nodiscard, gnu::always_inline]] std::uint32_t run(const Input<Real, S>& input, EngineGasStep<Real>& step,
                                                      const PortAreas<Real, kCylinders>& areas) noexcept {
    Real volume_m3[kCylinders];
    [[maybe_unused]] CycleWay way[kCylinders];
    prepare(step, volume_m3, way);
    std::uint32_t faults = 0;
    const std::uint32_t cylinders = count<S>(tables_.drive->cylinders);
    [[maybe_unused]] const std::uint32_t all = (std::uint32_t{1} << cylinders) - 1;  // a bit of each
    if constexpr (N::knock) {
      if (const std::uint32_t due = state_.knock_due & all; due != 0) begin_knock_on_way(tables_, state_, due, way);
    }
    std::uint32_t k = 0;
#if CRANKLOOP_ABREAST
    if constexpr (sizeof(Real) == 4 && kCylinders >= 4) {
      for (; k + 4 <= cylinders; k += 4) faults |= run_block<Four>(input, step, areas, way + k, k, volume_m3 + k);
    }
#endif
    for (; k < cylinders; ++k) faults |= run_block<Real>(input, step, areas, way + k, k, volume_m3 + k);
    if constexpr (N::knock) {
      const std::uint32_t in_burn = state_.knock_in_burn & all;
      if ((in_burn | ends_) != 0) knock_on_way(tables_, state_, out_, in_burn, ends_, way, step.drive.step_s);
    }
    return faults;
  }

 private:
  [[gnu::always_inline]] void prepare(const EngineGasStep<Real>& step, Real (&volume_m3)[kCylinders],
                                      [[maybe_unused]] CycleWay (&way)[kCylinders]) noexcept {
    const Drive<Real>& drive = *tables_.drive;
    volume_m3[0] = Real{0}, way[0] = {};  // for compilers, which do not know that there is a mechanism
    const std::uint32_t mechanisms = kCylinders == 1 ? 1 : drive.mechanisms;
    const std::uint8_t* next = drive.by_mechanism.cylinder;
    for (std::uint32_t m = 0; m < mechanisms; ++m) {
      const Real volume = gas_volume_m3(tables_, step.phase, m);
      [[maybe_unused]] const std::uint8_t* first = next;
      const std::uint8_t* const end = drive.by_mechanism.cylinder + drive.by_mechanism.end[m];
      const std::uint64_t own = step.phase - drive.firing_phase[m];
      for (; next != end; ++next) {
        volume_m3[*next] = volume;
        if constexpr (N::burn || S::gas_results)
          way[*next] = {own + (std::uint64_t{drive.turn_of[*next]} << 63), step.turned};
      }
      if constexpr (N::burn || S::gas_results) {
        if (__builtin_expect(CycleWay{own, step.turned}.passes_dead_centre(), 0)) {
          for (; first != end; ++first) ends_ |= std::uint32_t{way[*first].passes_end()} << *first;
        }
      }
    }
  }

  /// Steps cylinder `k`, or as many from there abreast as T has lanes.
  template <class T>
  [[nodiscard, gnu::always_inline]] std::uint32_t run_block(const Input<Real, S>& input, EngineGasStep<Real>& step,
                                                            const PortAreas<Real, kCylinders>& areas,
                                                            const CycleWay* way, std::uint32_t k,
                                                            const Real* volumes_m3) noexcept {
    constexpr int kLanes = kLanesIn<T>;
    const GasCylinders<Real>& table = *tables_.gas_cylinders;
    std::uint32_t faults = 0;
    [[maybe_unused]] const std::uint32_t ends = ends_ >> k;  // one bit of each lane
    GasFuel<T> fuel{};
    if constexpr (N::burn) {
      for (int i = 0; i < kLanes; ++i) {
        const GasFuel<Real> one = burn_on_way(tables_, state_, input, k + static_cast<std::uint32_t>(i), way[i],
                                              (ends >> i & 1u) != 0, faults);
        put_lane(fuel.mass_kg, i, one.mass_kg);
        put_lane(fuel.energy_J, i, one.energy_J);
        put_lane(fuel.burned_kg, i, one.burned_kg);
      }
    }
    CylinderGas<T> gas = state_.cylinder_gas.template at<T>(k);
    const T volume_m3 = load<T>(volumes_m3), before_m3 = gas.volume_m3;
    [[maybe_unused]] const T intake_was_m2 = gas.area_m2[kIntake];
    const T to_m2[kPorts] = {load<T>(areas.of[kIntake] + k), load<T>(areas.of[kExhaust] + k)};
    PortStep<T> through[kPorts];
    [[maybe_unused]] CreviceStep<T> crevice_step{};
    [[maybe_unused]] RunnerSteps<T> runners;
    CylinderStep<T> done = step_with_runners<T>(gas, k, volume_m3, fuel, walls_at<T>(table, k), step, to_m2, through,
                                                runners, crevice_step);
    state_.cylinder_gas.put(k, gas);
    if (done.flows) state_.cylinder_gas.put_areas(k, gas);
    const T least_kg = step.drive.least_kg_m3 * volume_m3;
    const auto well = is_well<T>(gas.point, gas.contents.mass_kg, least_kg);
    if (__builtin_expect(!all(well), 0)) {
      for (int i = 0; i < kLanes; ++i) {
        if ((holding(well) >> i & 1u) != 0) continue;
        const Real per_volume_m3 = lane(done.closed.per_volume_m3, i);
        if (!put_cylinder_right(k + static_cast<std::uint32_t>(i), per_volume_m3, lane(least_kg, i))) continue;
        faults |= kFaultGas;
        drop_nonsense<T>(done, through, i);
        if constexpr (S::crevice) drop_nonsense<T>(crevice_step, i);
      }
      gas = state_.cylinder_gas.template at<T>(k);
    }
    const Real per_tick_s = tables_.drive->per_tick_s;
    if constexpr (S::crevice) {
      done.closed.wall_heat_J += crevice_step.wall_heat_J;
      show_crevices(crevice_step, k);
    }
    if constexpr (S::walls) faults |= step_cylinder_walls<T>(k, done.closed.wall_heat_J, step.drive.step_s);
    T shown[7] = {gas.point.pressure_Pa,
                  gas.point.temperature_K,
                  gas.contents.mass_kg,
                  gas.point.burned_ratio,
                  T{},
                  T{},
                  done.closed.wall_heat_J * per_tick_s};
    if (done.flows) {
      for (int port = 0; port < kPorts; ++port) shown[4 + port] = through[port].mass_kg * per_tick_s;
      if constexpr (N::manifolds) take_from_manifolds(step, through);
    }
    if constexpr (S::runners) faults |= step_runners<T>(step, k, runners, through);
    show(shown, &out_.cylinder_gas[k]);
    const T crank_J = done.work_J - table.crankcase_Pa * (volume_m3 - before_m3);
    Real work_J = work_J_;
    for (int i = 0; i < kLanes; ++i) work_J += lane(crank_J, i);
    work_J_ = work_J;
    if constexpr (S::gas_results) {
      std::uint32_t intake_shut = 0;
      if (done.flows)
        intake_shut = holding(both_hold(intake_was_m2 > Real{0}, none_of(gas.area_m2[kIntake] > Real{0})));
      T gained_J = done.gained_J(through);
      if constexpr (S::crevice) gained_J -= crevice_step.lost_J - crevice_step.wall_heat_J;
      record_step<T>(&state_.gas_record[k], done, through, fuel.mass_kg, way);
      for (int i = 0; i < kLanes; ++i) {
        const std::uint32_t one = k + static_cast<std::uint32_t>(i);
        GasRecord<Real>& record = state_.gas_record[one];
        record_end(record, state_.cylinder_gas.pressure_Pa[one], lane(gained_J, i), way[i]);
        if ((intake_shut >> i & 1u) != 0 && before_burn(one, way[i]))
          record_trapped(record, state_.cylinder_gas.template at<Real>(one).contents);
        if ((ends >> i & 1u) != 0) end_cycle(tables_, state_, out_, one);
      }
    }
    return faults;
  }

  // ---- runners ------------------------------------------------------------------------------------------------------

  /// Of a block of cylinders.
  template <class T>
  struct RunnerStepsOf {
    RunnerStep<T> step[kPorts];
    GasBeyond<T> seen[kPorts];  ///< of the runner, or of the manifold where there is none
  };
  template <class T>
  using RunnerSteps = std::conditional_t<S::runners, RunnerStepsOf<T>, char>;

  /// That a runner may take in a step.
  [[nodiscard]] Real most_of_manifold_kg([[maybe_unused]] int port) const noexcept {
    if constexpr (N::manifolds) {
      return state_.manifold[port].contents.mass_kg * static_cast<Real>(0.25);
    } else {
      return static_cast<Real>(1e12);
    }
  }
  [[nodiscard]] bool has_runner(int port) const noexcept { return tables_.gas_runners->of[port].area_m2 > 0; }

  template <class T>
  [[gnu::always_inline]] void see_runners(const EngineGasStep<Real>& step, std::uint32_t k, const CylinderGas<T>& gas,
                                          RunnerStepsOf<T>& runners) noexcept {
    for (int port = 0; port < kPorts; ++port) {
      const GasBeyond<Real>& manifold = step.beyond[port];
      if (!has_runner(port)) {
        runners.seen[port] = of_each<T>(manifold);
        continue;
      }
      const RunnerGas<T> runner = take_runners<T>(&state_.runner[port][k]);
      // Its own flow of the last step is among those that the manifold's end includes.
      const T own_Pa = manifold.response_Pa_kg * (step.drive.step_s * runner.flow_kg_s);
      const RunnerEnds<T> ends{manifold,
                               manifold.end_Pa + (manifold.as_was_Pa + own_Pa),
                               gas.point.pressure_Pa,
                               gas.point.temperature_K,
                               gas.area_m2[port],
                               most_of_manifold_kg(port)};
      runners.seen[port] =
          seen_of_runner<T>(runner, tables_.gas_runners->of[port], ends, step.drive.step_s, runners.step[port]);
    }
  }
  template <class T>
  [[nodiscard, gnu::always_inline]] static GasBeyond<T> of_each(const GasBeyond<Real>& far) noexcept {
    return {spread<T>(far.pressure_Pa),   spread<T>(far.choked_per_Pa), spread<T>(far.specific_work_J_kg),
            spread<T>(far.enthalpy_J_kg), spread<T>(far.burned_ratio),  spread<T>(far.response_Pa_kg),
            spread<T>(far.end_Pa),        spread<T>(far.as_was_Pa)};
  }

  template <class T, class Walls>
  [[nodiscard, gnu::always_inline]] CylinderStep<T> step_with_runners(
      CylinderGas<T>& gas, std::uint32_t k, const T& volume_m3, const GasFuel<T>& fuel, const Walls& walls,
      const EngineGasStep<Real>& step, const T (&to_m2)[kPorts], PortStep<T> (&through)[kPorts],
      [[maybe_unused]] RunnerSteps<T>& runners, CreviceStep<T>& crevice_step) noexcept {
    if constexpr (S::runners) {
      see_runners<T>(step, k, gas, runners);
      return step_with_crevices<T>(gas, k, volume_m3, fuel, walls, step, to_m2, runners.seen, through, crevice_step);
    } else {
      return step_with_crevices<T>(gas, k, volume_m3, fuel, walls, step, to_m2, step.beyond, through, crevice_step);
    }
  }

  /// Answers fault bits.
  template <class T>
  [[nodiscard, gnu::always_inline]] std::uint32_t step_runners(EngineGasStep<Real>& step, std::uint32_t k,
                                                               const RunnerStepsOf<T>& runners,
                                                               const PortStep<T> (&through)[kPorts]) noexcept {
    std::uint32_t faults = 0;
    for (int port = 0; port < kPorts; ++port) {
      if (has_runner(port)) faults |= step_runners_of<T>(step, port, k, runners, through[port]);
      for (int i = 0; i < kLanesIn<T>; ++i) {
        const std::uint32_t one = k + static_cast<std::uint32_t>(i);
        const RunnerGas<Real>& runner = state_.runner[port][one];
        RunnerOutput<Real>& shown = out_.runner[one];
        shown.port_pressure_Pa[port] = has_runner(port) ? runner.point.pressure_Pa : step.beyond[port].pressure_Pa;
        shown.flow_kg_s[port] = runner.flow_kg_s;
      }
    }
    return faults;
  }
  template <class T>
  [[nodiscard, gnu::always_inline]] std::uint32_t step_runners_of(EngineGasStep<Real>& step, int port, std::uint32_t k,
                                                                  const RunnerStepsOf<T>& runners,
                                                                  const PortStep<T>& through) noexcept {
    const GasRunner<Real>& table = tables_.gas_runners->of[port];
    RunnerGas<Real>* const first = &state_.runner[port][k];
    RunnerGas<T> runner = take_runners<T>(first);
    PortStep<T> moves = step_runner<T>(runner, table, runners.step[port], step.beyond[port], runners.seen[port],
                                       through, most_of_manifold_kg(port), step.drive.step_s);
    const auto well = is_well_runner<T>(runner, table);
    put_runners<T>(first, runner);
    std::uint32_t faults = 0;
    if (__builtin_expect(!all(well), 0)) {
      for (int i = 0; i < kLanesIn<T>; ++i) {
        if ((holding(well) >> i & 1u) != 0) continue;
        PortStep<Real> one{lane(moves.mass_kg, i), lane(moves.enthalpy_J, i), lane(moves.burned_kg, i)};
        faults |= put_runner_right(first[i], table, one);
        put_lane(moves.mass_kg, i, one.mass_kg), put_lane(moves.enthalpy_J, i, one.enthalpy_J);
        put_lane(moves.burned_kg, i, one.burned_kg);
      }
    }
    if constexpr (S::walls) {
      const WarmWallsTable<Real>& walls = *tables_.gas_walls;
      if (walls.port_W_K[port] > 0) {
        for (int i = 0; i < kLanesIn<T>; ++i)
          out_.port_heat_W[port] += lose_heat(first[i].contents, first[i].point, table.per_volume_m3,
                                              walls.port_W_K[port], walls.behind_K, step.drive.step_s) *
                                    tables_.drive->per_tick_s;
      }
    }
    if constexpr (N::manifolds) {
      GasContents<Real> contents = state_.manifold[port].contents;
      for (int i = 0; i < kLanesIn<T>; ++i) {
        contents.add(-lane(moves.mass_kg, i), -lane(moves.enthalpy_J, i), -lane(moves.burned_kg, i));
        step.taken_kg[port] += lane(moves.mass_kg, i);
      }
      state_.manifold[port].contents = contents;
    }
    return faults;
  }

  // ---- walls --------------------------------------------------------------------------------------------------------

  /// Of cylinder `k`, or of lanes.
  template <class T>
  [[nodiscard, gnu::always_inline]] decltype(auto) walls_at(const GasCylinders<Real>& table,
                                                            [[maybe_unused]] std::uint32_t k) const noexcept {
    if constexpr (S::walls) {
      return WarmWalls<T>(table.walls, load<T>(state_.wall_K + k));
    } else {
      return (table.walls);
    }
  }
  [[nodiscard, gnu::always_inline]] static const GasCrevice<Real>& crevice_at(const GasCrevice<Real>& table,
                                                                              const GasWalls<Real>&) noexcept {
    return table;
  }
  template <class T>
  [[nodiscard, gnu::always_inline]] static WarmCrevice<T> crevice_at(const GasCrevice<Real>& table,
                                                                     const WarmWalls<T>& walls) noexcept {
    return WarmCrevice<T>(table, walls.temperature_K);
  }

  /// Answers fault bits.
  template <class T>
  [[nodiscard, gnu::always_inline]] std::uint32_t step_cylinder_walls(std::uint32_t k, const T& heat_J,
                                                                      Real step_s) noexcept {
    const WarmWallsTable<Real>& table = *tables_.gas_walls;
    T wall_K = load<T>(state_.wall_K + k);
    std::uint32_t faults = 0;
    if (table.capacity_J_K > 0) {
      T rest_K = load<T>(state_.wall_rest_K + k);
      bool plain = true;
      if constexpr (S::crevice) {
        if (tables_.gas_crevice->in_use != 0) {
          const CreviceGas<T> crevice = state_.crevice_gas.template at<T>(k);
          const T crevice_J_K =
              crevice.mass_kg * (Real{646} + kHeatSlope<Real> * wall_K) + crevice.burned_kg * Real{93};
          step_walls<T>(wall_K, rest_K, table, heat_J, crevice_J_K, step_s), plain = false;
        }
      }
      if (plain) step_walls<T>(wall_K, rest_K, table, heat_J, step_s);
      const auto well = both_hold(wall_K >= static_cast<Real>(kLeastGas_K), wall_K <= static_cast<Real>(kMaxGas_K));
      if (__builtin_expect(!all(well), 0)) put_walls_right<T>(wall_K, rest_K), faults = kFaultGas;
      store<T>(state_.wall_K + k, wall_K), store<T>(state_.wall_rest_K + k, rest_K);
    }
    store<T>(out_.wall_K + k, wall_K);
    return faults;
  }

  // ---- crevices -----------------------------------------------------------------------------------------------------

  /// Steps the gas of one cylinder, or of lanes, with its crevices where the engine has some.
  template <class T, class Walls, class Far>
  [[nodiscard, gnu::always_inline]] CylinderStep<T> step_with_crevices(
      CylinderGas<T>& gas, [[maybe_unused]] std::uint32_t k, const T& volume_m3, const GasFuel<T>& fuel,
      const Walls& walls, const EngineGasStep<Real>& step, const T (&to_m2)[kPorts], const Far (&beyond)[kPorts],
      PortStep<T> (&through)[kPorts], [[maybe_unused]] CreviceStep<T>& crevice_step) noexcept {
    if constexpr (S::crevice) {
      const GasCrevice<Real>& table = *tables_.gas_crevice;
      const auto crevices = [&](ClosedStep<T> & closed, GasGain<T> & gain) __attribute__((always_inline)) {
        if (table.in_use == 0) return T{};
        CreviceGas<T> crevice = state_.crevice_gas.template at<T>(k);
        const T give_way =
            step_crevice<T>(crevice, crevice_at(table, walls), gas, step.drive.step_s, closed, gain, crevice_step);
        state_.crevice_gas.put(k, crevice);
        return give_way;
      };
      return step_gas<T>(gas, volume_m3, fuel, walls, step.drive, to_m2, beyond, through, crevices);
    } else {
      return step_gas<T>(gas, volume_m3, fuel, walls, step.drive, to_m2, beyond, through);
    }
  }

  /// Shows and records what blew by.
  template <class T>
  [[gnu::always_inline]] void show_crevices(const CreviceStep<T>& step, std::uint32_t k) noexcept {
    for (int i = 0; i < kLanesIn<T>; ++i) {
      const std::uint32_t one = k + static_cast<std::uint32_t>(i);
      const Real blow_by_kg = lane(step.blow_by_kg, i);
      CreviceOutput<Real>& shown = out_.crevice[one];
      shown.mass_kg = state_.crevice_gas.mass_kg[one];
      shown.blow_by_kg_s += blow_by_kg * tables_.drive->per_tick_s;
      if constexpr (S::gas_results) state_.cycle_blow_by_kg[one] += blow_by_kg;
    }
  }

  [[gnu::cold, gnu::noinline]] bool put_cylinder_right(std::uint32_t k, Real per_volume_m3, Real least_kg) noexcept {
    CylinderGas<Real> gas = state_.cylinder_gas.template at<Real>(k);
    const bool put_back = put_right(gas.contents, gas.point, per_volume_m3, least_kg);
    state_.cylinder_gas.put(k, gas.contents, gas.point);
    if constexpr (S::crevice) {
      if (put_back) fill_crevice(tables_, state_, k);
    }
    return put_back;
  }

  /// Of a cylinder before firing dead centre, none of whose fuel has burned.
  [[nodiscard]] bool before_burn([[maybe_unused]] std::uint32_t k, const CycleWay& way) const noexcept {
    if (way.to >> 63 == 0) return false;
    if constexpr (N::burn) {
      return state_.burn[k].taken == 0 || !(state_.burn[k].burnt_ratio > 0);
    } else {
      return true;
    }
  }

  /// The very numbers that the cylinders gained, so that nothing is lost.
  template <class T>
  [[gnu::always_inline]] void take_from_manifolds(EngineGasStep<Real>& step,
                                                  const PortStep<T> (&through)[kPorts]) noexcept {
    for (int port = 0; port < kPorts; ++port) {
      if constexpr (S::runners) {
        if (has_runner(port)) continue;  // takes from there itself
      }
      const PortStep<T>& all = through[port];
      const std::uint32_t flowing = holding(all.mass_kg != Real{0});
      if (flowing == 0) continue;
      GasContents<Real>& contents = state_.manifold[port].contents;
      for (int i = 0; i < kLanesIn<T>; ++i) {
        if ((flowing >> i & 1u) == 0) continue;
        contents.add(-lane(all.mass_kg, i), -lane(all.enthalpy_J, i), -lane(all.burned_kg, i));
        step.taken_kg[port] += lane(all.mass_kg, i);
      }
    }
  }

  const Tables<Real, S>& tables_;
  State<Real, S>& state_;
  Output<Real, S>& out_;
  std::uint32_t ends_ = 0;  ///< one bit of each cylinder whose cycle does
  Real& work_J_;            ///< of all cylinders on the crank, against the crankcase's pressure
};

}  // namespace crankloop::detail
