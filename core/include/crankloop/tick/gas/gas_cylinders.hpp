// One step of the gas of all cylinders: four abreast where they can, then one by one, with the same bits.
//
// What belongs here: what goes into a cylinder's step, where what it did goes, in their order. What does not: the step
// (cylinder_gas.hpp), its parts (gas_cycle.hpp, engine_runners.hpp, engine_crevices.hpp, engine_walls.hpp), the tick
// (gas_step.hpp).
//
//     prepare: volumes, fuel -> flow: the step -> sums: manifolds, work, results -> show
#pragma once

#include <cstdint>

#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/engine_crevices.hpp>
#include <crankloop/tick/gas/engine_manifolds.hpp>
#include <crankloop/tick/gas/engine_runners.hpp>
#include <crankloop/tick/gas/engine_walls.hpp>
#include <crankloop/tick/gas/gas_cycle.hpp>
#include <crankloop/tick/gas/gas_places.hpp>
#include <crankloop/tick/gas/gas_shown.hpp>
#include <crankloop/tick/gas/gas_start.hpp>
#include <crankloop/tick/lanes.hpp>

namespace crankloop::detail {

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
    const GasCylinders<Real>& table = *tables_.gas_cylinders;
    const std::uint32_t ends = ends_ >> k;  // one bit of each lane
    std::uint32_t faults = 0;
    const GasFuel<T> fuel = burn_of_block<T>(tables_, state_, input, k, way, ends, faults);
    CylinderGas<T> gas = state_.cylinder_gas.template at<T>(k);
    const T volume_m3 = load<T>(volumes_m3), before_m3 = gas.volume_m3;
    [[maybe_unused]] const T intake_was_m2 = gas.area_m2[kIntake];
    const T to_m2[kPorts] = {load<T>(areas.of[kIntake] + k), load<T>(areas.of[kExhaust] + k)};
    PortStep<T> through[kPorts];
    [[maybe_unused]] CreviceStep<T> crevice_step{};
    [[maybe_unused]] RunnerStepsOf<T, S> runners;
    CylinderStep<T> done = step_with_runners<T>(gas, k, volume_m3, fuel, walls_at<T>(table, state_, k), step, to_m2,
                                                through, runners, crevice_step);
    state_.cylinder_gas.put(k, gas);
    if (done.flows) state_.cylinder_gas.put_areas(k, gas);
    const T least_kg = step.drive.least_kg_m3 * volume_m3;
    const auto well = is_well<T>(gas.point, gas.contents.mass_kg, least_kg);
    if (__builtin_expect(!all(well), 0)) {
      faults |= put_block_right<T>(k, holding(well), least_kg, done, through, crevice_step);
      gas = state_.cylinder_gas.template at<T>(k);
    }
    if constexpr (S::crevice) {
      done.closed.wall_heat_J += crevice_step.wall_heat_J;
      show_crevices(tables_, state_, out_, crevice_step, k);
    }
    if constexpr (S::walls) add_wall_heat<T>(state_, k, done.closed.wall_heat_J);
    const Real per_tick_s = tables_.drive->per_tick_s;
    T shown[7] = {gas.point.pressure_Pa,
                  gas.point.temperature_K,
                  gas.contents.mass_kg,
                  gas.point.burned_ratio,
                  T{},
                  T{},
                  done.closed.wall_heat_J * per_tick_s};
    if (done.flows) {
      for (int port = 0; port < kPorts; ++port) shown[4 + port] = through[port].mass_kg * per_tick_s;
      if constexpr (N::manifolds) take_from_manifolds(tables_, state_, step, through);
    }
    if constexpr (S::runners) faults |= step_runners<T>(tables_, state_, out_, step, k, runners, through);
    show(shown, &out_.cylinder_gas[k]);
    add_work<T>(done.work_J - table.crankcase_Pa * (volume_m3 - before_m3));
    if constexpr (S::gas_results) {
      std::uint32_t shut = 0;
      if (done.flows) shut = holding(both_hold(intake_was_m2 > Real{0}, none_of(gas.area_m2[kIntake] > Real{0})));
      T gained_J = done.gained_J(through);
      if constexpr (S::crevice) gained_J -= crevice_step.lost_J - crevice_step.wall_heat_J;
      record_block<T>(tables_, state_, out_, k, done, through, gained_J, fuel.mass_kg, way, shut, ends);
    }
    return faults;
  }

  template <class T, class Walls>
  [[nodiscard, gnu::always_inline]] CylinderStep<T> step_with_runners(
      CylinderGas<T>& gas, std::uint32_t k, const T& volume_m3, const GasFuel<T>& fuel, const Walls& walls,
      const EngineGasStep<Real>& step, const T (&to_m2)[kPorts], PortStep<T> (&through)[kPorts],
      [[maybe_unused]] RunnerStepsOf<T, S>& runners, CreviceStep<T>& crevice_step) noexcept {
    if constexpr (S::runners) {
      see_runners<T>(tables_, state_, step, k, gas, runners);
      return step_with_crevices<T>(tables_, state_, gas, k, volume_m3, fuel, walls, step, to_m2, runners.seen, through,
                                   crevice_step);
    } else {
      return step_with_crevices<T>(tables_, state_, gas, k, volume_m3, fuel, walls, step, to_m2, step.beyond, through,
                                   crevice_step);
    }
  }

  template <class T>
  [[gnu::always_inline]] void add_work(const T& crank_J) noexcept {
    Real work_J = work_J_;
    for (int i = 0; i < kLanesIn<T>; ++i) work_J += lane(crank_J, i);
    work_J_ = work_J;
  }

  /// Puts those back whose bits `well` lacks. Answers fault bits.
  template <class T>
  [[nodiscard, gnu::always_inline]] std::uint32_t put_block_right(std::uint32_t k, std::uint32_t well,
                                                                  const T& least_kg, CylinderStep<T>& done,
                                                                  PortStep<T> (&through)[kPorts],
                                                                  [[maybe_unused]] CreviceStep<T>& crevices) noexcept {
    std::uint32_t faults = 0;
    for (int i = 0; i < kLanesIn<T>; ++i) {
      if ((well >> i & 1u) != 0) continue;
      const Real per_volume_m3 = lane(done.closed.per_volume_m3, i);
      if (!put_cylinder_right(k + static_cast<std::uint32_t>(i), per_volume_m3, lane(least_kg, i))) continue;
      faults |= kFaultGas;
      drop_nonsense<T>(done, through, i);
      if constexpr (S::crevice) drop_nonsense<T>(crevices, i);
    }
    return faults;
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

  const Tables<Real, S>& tables_;
  State<Real, S>& state_;
  Output<Real, S>& out_;
  std::uint32_t ends_ = 0;  ///< one bit of each cylinder whose cycle does
  Real& work_J_;            ///< of all cylinders on the crank, against the crankcase's pressure
};

}  // namespace crankloop::detail
