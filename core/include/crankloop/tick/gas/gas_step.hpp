// The gas of an engine over one tick: cylinders, then manifolds. docs/model.md "Gas".
//
// What belongs here: the order of it, what is shown. What does not: a cylinder's step (cylinder_gas.hpp), a manifold's
// (manifold.hpp), fuel (combustion.hpp), inputs (gas_inputs.hpp), where pistons and valves stand (gas_places.hpp).
//
//     inputs -> port areas from the valves' lifts -> in steps of at most 5 deg: cylinders, manifolds -> what is shown
#pragma once

#include <cstdint>

#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/gas/gas_abreast.hpp>
#include <crankloop/tick/gas/gas_cycle.hpp>
#include <crankloop/tick/gas/gas_inputs.hpp>
#include <crankloop/tick/gas/gas_places.hpp>
#include <crankloop/tick/gas/gas_start.hpp>
#include <crankloop/tick/gas/manifold.hpp>
#include <crankloop/tick/valve/valve.hpp>

namespace crankloop::detail {

/// A tick that turns the crank further is cut into equal steps.
inline constexpr int kMaxGasSteps = 8;
inline constexpr std::uint64_t kGasStep = ~std::uint64_t{0} / 144;  ///< 5 deg
template <class Real, class S>
class GasStep {
  using N = Needs<S>;
  static constexpr std::uint32_t kCylinders = S::cylinders.capacity;
  struct Areas {
    Real of[kCylinders][kPorts];
  };

 public:
  GasStep(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out) noexcept
      : tables_{tables}, state_{state}, out_{out} {}

  /// The crank has turned, the valves have moved. Answers fault bits; `work_J`: of all cylinders on the crank, against
  /// the crankcase's pressure.
  [[nodiscard, gnu::noinline]] std::uint32_t run(const Input<Real, S>& input, Phase turned, bool jumped,
                                                 Real& work_J) noexcept {
    std::uint32_t faults = take_gas_inputs<Real, S>(input, state_);
    Areas end;
    read_areas(end, [this](std::uint32_t t, std::uint32_t k) { return out_.valve[t][k].lift_m; });
    work_J = Real{0};
    for (std::uint32_t k = 0; k < cylinders(); ++k) {
      CylinderGasOutput<Real>& shown = out_.cylinder_gas[k];
      shown.flow_kg_s[kIntake] = shown.flow_kg_s[kExhaust] = shown.wall_heat_W = Real{0};
      if constexpr (S::valve_gas) state_.cylinder_gas[k].pressure_before_Pa = state_.cylinder_gas[k].point.pressure_Pa;
    }
    if (jumped) {
      fill_cylinders(tables_, state_);
      for (std::uint32_t k = 0; k < cylinders(); ++k) {
        for (int port = 0; port < kPorts; ++port) state_.cylinder_gas[k].area_m2[port] = end.of[k][port];
        show(state_.cylinder_gas[k], &out_.cylinder_gas[k]);
      }
    } else {
      faults |= run_steps(input, end, static_cast<std::int64_t>(turned.units()), work_J);
    }
    show_manifolds();
    return faults;
  }

 private:
  [[nodiscard]] std::uint32_t cylinders() const noexcept { return count<S>(tables_.drive->cylinders); }
  [[nodiscard]] std::uint32_t trains() const noexcept {
    return S::trains.exact ? S::trains.capacity : tables_.drive->trains;
  }

  /// Of the lifts that `lift_of(train, cylinder)` answers.
  template <class LiftOf>
  void read_areas(Areas& areas, const LiftOf& lift_of) const noexcept {
    areas = {};
    for (std::uint32_t t = 0; t < trains(); ++t) {
      const GasPortCurve<Real>& curve = tables_.gas_ports[t];
      for (std::uint32_t k = 0; k < cylinders(); ++k) {
        areas.of[k][curve.port] += port_area_m2(curve, lift_of(t, k));
      }
    }
  }
  /// As the cams have them where the engine had a phase in this tick.
  void read_cam_areas(std::uint64_t phase, Areas& areas) const noexcept {
    const std::uint64_t back = state_.phase.units() - phase;
    read_areas(areas, [this, back](std::uint32_t t, std::uint32_t k) {
      const LiftCurve<Real>& curve = tables_.lift_curves[t];
      return curve.read(curve.cell(cam_phase(state_, t) - back, k)).lift_m;
    });
  }

  // ---- the steps ----------------------------------------------------------------------------------------------------

  /// What all cylinders of a step share.
  struct Step {
    std::uint64_t phase;  ///< of the engine, at its end
    std::int64_t turned;
    GasDrive<Real> drive;
    GasBeyond<Real> beyond[kPorts];
  };

  [[nodiscard]] std::uint32_t run_steps(const Input<Real, S>& input, const Areas& end, std::int64_t turned,
                                        Real& work_J) noexcept {
    const std::uint64_t way =
        turned < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(turned) : static_cast<std::uint64_t>(turned);
    Step step;
    step.drive.stirring_m_s = stirring_m_s(tables_.gas_cylinders->walls, state_.speed_rad_s);
    step.drive.least_kg_m3 = tables_.gas_cylinders->least_kg_m3;
    step.drive.step_s = tables_.drive->tick_s;
    step.turned = turned;
    if (__builtin_expect(way > kGasStep, 0)) return run_parts(input, step, way, end, work_J);
    step.phase = state_.phase.units();
    step.drive.area_per_m3 = most_area_per_m3(step.drive.step_s);
    return run_step(input, step, end, work_J);
  }

  /// A tick in equal parts. Between its ends port areas are as the cams have them, and what the valves are off their
  /// cams goes in a straight line: a straight line of areas alone would be 1 % off in charge at 36 deg.
  [[nodiscard, gnu::noinline]] std::uint32_t run_parts(const Input<Real, S>& input, Step& step, std::uint64_t way,
                                                       const Areas& end, Real& work_J) noexcept {
    int parts = 2;
    while (parts < kMaxGasSteps && way > static_cast<std::uint64_t>(parts) * kGasStep) ++parts;
    constexpr std::uint32_t kPerParts_32[kMaxGasSteps + 1] = {
        0, 0, 0x8000'0000u, 0x5555'5555u, 0x4000'0000u, 0x3333'3333u, 0x2AAA'AAABu, 0x2492'4925u, 0x2000'0000u};
    constexpr Real kPerParts[kMaxGasSteps + 1] = {1,           1,           Real{1} / 2, Real{1} / 3, Real{1} / 4,
                                                  Real{1} / 5, Real{1} / 6, Real{1} / 7, Real{1} / 8};
    std::uint64_t from = state_.phase.units() - static_cast<std::uint64_t>(step.turned);
    Areas areas, off_at_begin, off_at_end;
    read_cam_areas(from, off_at_begin);
    read_cam_areas(state_.phase.units(), off_at_end);
    const auto each_port = [this](const auto& visit) {
      for (std::uint32_t k = 0; k < cylinders(); ++k) {
        for (int port = 0; port < kPorts; ++port) visit(k, port);
      }
    };
    each_port([&](std::uint32_t k, int port) {
      off_at_begin.of[k][port] = state_.cylinder_gas[k].area_m2[port] - off_at_begin.of[k][port];
      off_at_end.of[k][port] = end.of[k][port] - off_at_end.of[k][port];
    });
    const std::uint64_t each = part_of(step.turned, kPerParts_32[parts]);
    step.drive.step_s *= kPerParts[parts];
    step.drive.area_per_m3 = most_area_per_m3(step.drive.step_s);
    std::uint32_t faults = 0;
    for (int i = 1; i < parts; ++i, from = step.phase) {
      step.phase = from + each;
      step.turned = static_cast<std::int64_t>(each);
      read_cam_areas(step.phase, areas);
      const Real done = static_cast<Real>(i) * kPerParts[parts];
      each_port([&](std::uint32_t k, int port) {
        const Real begin = off_at_begin.of[k][port];
        const Real area = areas.of[k][port] + (begin + (off_at_end.of[k][port] - begin) * done);
        areas.of[k][port] = area > 0 ? area : Real{0};
      });
      faults |= run_step(input, step, areas, work_J);
    }
    step.phase = state_.phase.units();
    step.turned = static_cast<std::int64_t>(step.phase - from);
    return faults | run_step(input, step, end, work_J);
  }

  [[nodiscard]] std::uint32_t run_step(const Input<Real, S>& input, Step& step, const Areas& areas,
                                       Real& work_J) noexcept {
    see_manifolds(step);
    const std::uint32_t faults = step_cylinders(input, step, areas, work_J);
    return faults | step_manifolds(step);
  }

  [[gnu::always_inline]] void see_manifolds(Step& step) const noexcept {
    for (int port = 0; port < kPorts; ++port) {
      if constexpr (N::manifolds) {
        step.beyond[port] =
            seen_from_ports(state_.manifold[port], tables_.gas_manifolds->per_volume_m3[port], step.drive.step_s);
      } else {
        const GivenGas<Real>& given = state_.given_gas[port];
        constexpr Real kNoLimit_m2 = static_cast<Real>(1e9);
        step.beyond[port] =
            beyond(GasPoint<Real>{given.pressure_Pa, given.temperature_K, static_cast<Real>(port), Real{0}}, Real{0},
                   kNoLimit_m2);
      }
    }
  }

  [[nodiscard]] std::uint32_t step_cylinders(const Input<Real, S>& input, Step& step, const Areas& areas,
                                             Real& work_J) noexcept {
    const Drive<Real>& drive = *tables_.drive;
    Real volume_m3[kCylinders];
    [[maybe_unused]] CycleWay way[kCylinders];
    volume_m3[0] = Real{0}, way[0] = {};  // for compilers, which do not know that there is a mechanism
    const std::uint32_t mechanisms = kCylinders == 1 ? 1 : drive.mechanisms;
    const std::uint8_t* next = drive.by_mechanism.cylinder;
    for (std::uint32_t m = 0; m < mechanisms; ++m) {
      const Real volume = gas_volume_m3(tables_, step.phase, m);
      const std::uint8_t* const end = drive.by_mechanism.cylinder + drive.by_mechanism.end[m];
      const std::uint64_t own = step.phase - drive.firing_phase[m];
      for (; next != end; ++next) {
        volume_m3[*next] = volume;
        if constexpr (N::burn || S::gas_results)
          way[*next] = {own + (std::uint64_t{drive.turn_of[*next]} << 63), step.turned};
      }
    }
    std::uint32_t faults = 0;
    std::uint32_t k = 0;
#if CRANKLOOP_ABREAST
    if constexpr (sizeof(Real) == 4 && kCylinders >= 4) {
      for (; k + 4 <= cylinders(); k += 4) {
        CylinderGasNow<Four> now;
        load_abreast(&state_.cylinder_gas[k], now);
        faults |= step_block<Four>(input, step, areas, way + k, k, load<Four>(volume_m3 + k), now, work_J);
      }
    }
#endif
    for (; k < cylinders(); ++k) {
      faults |= step_block<Real>(input, step, areas, way + k, k, volume_m3[k], state_.cylinder_gas[k], work_J);
    }
    return faults;
  }

  /// Steps cylinder `first`, or as many from there abreast as T has lanes.
  template <class T>
  [[nodiscard, gnu::always_inline]] std::uint32_t step_block(const Input<Real, S>& input, Step& step,
                                                             const Areas& areas, const CycleWay* way,
                                                             std::uint32_t first, const T& volume_m3,
                                                             CylinderGasNow<T>& now, Real& work_J) noexcept {
    constexpr int kLanes = kLanesIn<T>;
    const GasCylinders<Real>& table = *tables_.gas_cylinders;
    const Real per_tick_s = tables_.drive->per_tick_s;
    CylinderGas<Real>* const gas = &state_.cylinder_gas[first];
    CylinderGasOutput<Real>* const shown = &out_.cylinder_gas[first];
    std::uint32_t faults = 0;
    [[maybe_unused]] std::uint32_t ends = 0;  // one bit of each lane
    if constexpr (N::burn || S::gas_results) {
      for (int i = 0; i < kLanes; ++i) ends |= std::uint32_t{way[i].passes_end()} << i;
    }
    T fuel_kg{};
    GasFuel<Real> fuel{};
    if constexpr (N::burn) {
      for (int i = 0; i < kLanes; ++i) {
        const auto k = first + static_cast<std::uint32_t>(i);
        put_lane(fuel_kg, i, burn_on_way(tables_, state_, input, k, way[i], (ends >> i & 1u) != 0, faults));
      }
      fuel = {tables_.burn->energy_J_kg, tables_.burn->burned_kg_kg};
    }
    const T before_m3 = now.volume_m3;
    [[maybe_unused]] T enthalpy_J{};
    [[maybe_unused]] std::uint32_t intake_shut = 0;
    const auto flow = [&](int i, const ClosedStep<T>& closed, GasGain<T>& gain) __attribute__((always_inline))->Real {
      const auto& to_m2 = areas.of[first + static_cast<std::uint32_t>(i)];
      if (!any_port_open(gas[i], to_m2)) return Real{0};
      const bool intake_was_open = gas[i].area_m2[kIntake] > 0;
      GasGain<Real> own = gain.of_lane(i);
      Real own_J{};
      const Real flow_work_J = flow_through_ports(
          gas[i], closed.of_lane(i), own, to_m2, step.beyond, step.drive, [&](int port, const PortStep<Real>& through) {
            if constexpr (N::manifolds) give_and_take(state_.manifold[port], step.beyond[port], through);
            if constexpr (S::gas_results)
              record_flow(state_.gas_record[first + static_cast<std::uint32_t>(i)], port, through);
            shown[i].flow_kg_s[port] += through.mass_kg * per_tick_s;
            own_J += through.enthalpy_J;
          });
      gain.put(i, own);
      if constexpr (S::gas_results) {
        put_lane(enthalpy_J, i, own_J);
        if (intake_was_open && !(gas[i].area_m2[kIntake] > 0)) intake_shut |= 1u << i;
      }
      return flow_work_J;
    };
    const CylinderStep<T> done = step_gas<T>(now, volume_m3, fuel_kg, fuel, table.walls, step.drive, flow);
    const T least_kg = step.drive.least_kg_m3 * volume_m3;
    if constexpr (kLanes > 1) store_abreast(now, gas);
    show(now, shown);
    if (__builtin_expect(!all_hold(is_well<T>(now.point, now.contents.mass_kg, least_kg)), 0)) {
      for (int i = 0; i < kLanes; ++i) {
        if (put_right(gas[i], lane(done.closed.per_volume_m3, i), lane(least_kg, i))) faults |= kFaultGas;
        show(gas[i], shown + i);
      }
    }
    const T crank_J = done.work_J - table.crankcase_Pa * (volume_m3 - before_m3);
    const T wall_heat_W = done.closed.wall_heat_J * per_tick_s;
    Real sum_J = work_J;
    for (int i = 0; i < kLanes; ++i) {
      sum_J += lane(crank_J, i);
      shown[i].wall_heat_W += lane(wall_heat_W, i);
    }
    work_J = sum_J;
    if constexpr (S::gas_results) {
      const T gained_J = done.gained_J(enthalpy_J);
      for (int i = 0; i < kLanes; ++i) {
        const auto k = first + static_cast<std::uint32_t>(i);
        GasRecord<Real>& record = state_.gas_record[k];
        record_step(record, gas[i].point.pressure_Pa, lane(done.work_J, i), lane(done.closed.wall_heat_J, i),
                    lane(gained_J, i), lane(fuel_kg, i), way[i]);
        if ((intake_shut >> i & 1u) != 0) record_trapped(record, gas[i].contents);
        if ((ends >> i & 1u) != 0) end_cycle(tables_, state_, out_, k);
      }
    }
    return faults;
  }

  [[nodiscard]] std::uint32_t step_manifolds(const Step& step) noexcept {
    bool put_back = false;
    if constexpr (N::manifolds) {
      const GasManifolds<Real>& table = *tables_.gas_manifolds;
      const Real areas[kPorts] = {throttle_m2(), table.outlet_m2};
      for (int port = 0; port < kPorts; ++port) {
        const Real in_kg = step_manifold(state_.manifold[port], step.beyond[port], table.outside[port], areas[port],
                                         table.per_volume_m3[port], table.least_kg[port], step.drive.step_s, put_back);
        outside_kg_[port] += in_kg;
      }
    }
    (void)step;
    return put_back ? std::uint32_t{kFaultGas} : 0;
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

  // ---- what is shown ------------------------------------------------------------------------------------------------

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

  const Tables<Real, S>& tables_;
  State<Real, S>& state_;
  Output<Real, S>& out_;
  Real outside_kg_[kPorts] = {};  ///< into the manifolds from outside, in this tick
};

}  // namespace crankloop::detail
