// The gas of an engine over one tick. docs/model.md "Gas".
//
// What belongs here: the order of it. What does not: the cylinders' step (gas_cylinders.hpp), a manifold's
// (manifold.hpp), inputs (gas_inputs.hpp), where pistons and valves stand (gas_places.hpp).
//
//     inputs -> port areas from the valves' lifts -> in steps of at most 5 deg: cylinders, manifolds -> what is shown
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#include <crankloop/assert.hpp>
#include <crankloop/tick/gas/gas_cylinders.hpp>
#include <crankloop/tick/gas/gas_inputs.hpp>
#include <crankloop/tick/gas/gas_start.hpp>
#include <crankloop/tick/valve/valve.hpp>

namespace crankloop::detail {

/// A tick that turns the crank further is cut into equal steps, at most as many as the tables say.
inline constexpr std::uint64_t kGasStep = ~std::uint64_t{0} / 144;  ///< kGasStep_deg
static_assert(144 * kGasStep_deg == kDegreesPerCycle);
template <class Real, class S>
class GasStep {
  using N = Needs<S>;
  static constexpr std::uint32_t kCylinders = S::cylinders.capacity;
  using Areas = PortAreas<Real, kCylinders>;

 public:
  GasStep(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out) noexcept
      : tables_{tables}, state_{state}, out_{out} {}

  /// The crank has turned, the valves have moved. Answers fault bits; `work_J`: of all cylinders on the crank, against
  /// the crankcase's pressure.
  [[nodiscard, gnu::noinline]] std::uint32_t run(const Input<Real, S>& input, Phase turned, bool jumped,
                                                 Real& work_J) noexcept {
    std::uint32_t faults = take_gas_inputs<Real, S>(tables_, input, state_);
    if constexpr (S::boundaries) {
      for (int port = 0; port < kPorts; ++port) boundary_[port] = given(port, Real{0});
    }
    if constexpr (S::crevice) {
      for (CreviceOutput<Real>& shown : out_.crevice) shown.blow_by_kg_s = Real{0};
    }
    if constexpr (S::walls) out_.port_heat_W[kIntake] = out_.port_heat_W[kExhaust] = Real{0};
    Areas end;
    read_areas(tables_, end, [this](std::uint32_t t, std::uint32_t k) { return out_.valve[t][k].lift_m; });
    CylinderGases<Real, kCylinders>& gases = state_.cylinder_gas;
    if constexpr (S::valve_gas) std::memcpy(gases.pressure_before_Pa, gases.pressure_Pa, sizeof gases.pressure_Pa);
    if (jumped) {
      fill_cylinders(tables_, state_);
      std::memcpy(gases.area_m2, end.of, sizeof end.of);
      for (std::uint32_t k = 0; k < cylinders(); ++k) {
        const Real shown[7] = {gases.pressure_Pa[k], gases.temperature_K[k], gases.mass_kg[k], gases.burned_ratio[k]};
        show(shown, &out_.cylinder_gas[k]);
        if constexpr (S::walls) out_.wall_K[k] = state_.wall_K[k];
        if constexpr (S::crevice) out_.crevice[k].mass_kg = state_.crevice_gas.mass_kg[k];
        if constexpr (S::runners) {
          for (int port = 0; port < kPorts; ++port)
            out_.runner[k].port_pressure_Pa[port] = manifold_of(state_, port).pressure_Pa,
            out_.runner[k].flow_kg_s[port] = Real{0};
        }
      }
    } else {
      faults |= run_steps(input, end, static_cast<std::int64_t>(turned.units()));
    }
    show_manifolds();
    work_J = work_J_;
    return faults;
  }

 private:
  [[nodiscard]] std::uint32_t cylinders() const noexcept { return count<S>(tables_.drive->cylinders); }

  /// As the cams have them where the engine had a phase in this tick.
  void read_cam_areas(std::uint64_t phase, Areas& areas) const noexcept {
    const std::uint64_t back = state_.phase.units() - phase;
    read_areas(tables_, areas, [this, back](std::uint32_t t, std::uint32_t k) {
      const LiftCurve<Real>& curve = tables_.lift_curves[t];
      return curve.read(curve.cell(cam_phase(state_, t) - back, k)).lift_m;
    });
  }

  // ---- the steps ----------------------------------------------------------------------------------------------------

  [[nodiscard]] std::uint32_t run_steps(const Input<Real, S>& input, const Areas& end, std::int64_t turned) noexcept {
    const std::uint64_t way =
        turned < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(turned) : static_cast<std::uint64_t>(turned);
    EngineGasStep<Real> step;
    step.drive.stirring_m_s = stirring_m_s(tables_.gas_cylinders->walls, state_.speed_rad_s);
    step.drive.least_kg_m3 = tables_.gas_cylinders->least_kg_m3;
    step.drive.step_s = tables_.drive->tick_s;
    step.turned = turned;
    if (__builtin_expect(way > kGasStep || least_parts() > 1, 0) && max_parts() > 1)
      return run_parts(input, step, way, end);
    step.phase = state_.phase.units();
    step.drive.area_per_m3 = most_area_per_m3(step.drive.step_s);
    return run_step(input, step, end);
  }

  /// Of a tick, for small manifolds.
  [[nodiscard]] int least_parts() const noexcept {
    if constexpr (N::manifolds) {
      return static_cast<int>(tables_.gas_manifolds->parts);
    } else {
      return 1;
    }
  }
  /// Of a tick of this engine, whatever input and state.
  [[nodiscard]] int max_parts() const noexcept { return static_cast<int>(tables_.gas_cylinders->max_steps); }
  /// A tick in equal parts. Between its ends port areas are as the cams have them, and what the valves are off their
  /// cams goes in a straight line: a straight line of areas alone would be 1 % off in charge at 36 deg.
  [[nodiscard, gnu::noinline]] std::uint32_t run_parts(const Input<Real, S>& input, EngineGasStep<Real>& step,
                                                       std::uint64_t way, const Areas& end) noexcept {
    int parts = least_parts() > 2 ? least_parts() : 2;
    const int max = max_parts();
    CRANKLOOP_ASSERT(max >= parts && max <= kMaxGasSteps);
    while (parts < max && way > static_cast<std::uint64_t>(parts) * kGasStep) ++parts;
    constexpr std::uint32_t kPerParts_32[kMaxGasSteps + 1] = {
        0, 0, 0x8000'0000u, 0x5555'5555u, 0x4000'0000u, 0x3333'3333u, 0x2AAA'AAABu, 0x2492'4925u, 0x2000'0000u};
    constexpr Real kPerParts[kMaxGasSteps + 1] = {1,           1,           Real{1} / 2, Real{1} / 3, Real{1} / 4,
                                                  Real{1} / 5, Real{1} / 6, Real{1} / 7, Real{1} / 8};
    std::uint64_t from = state_.phase.units() - static_cast<std::uint64_t>(step.turned);
    Areas areas, off_at_begin, off_at_end{};
    read_cam_areas(from, off_at_begin);
    if constexpr (N::elastic_valves) read_cam_areas(state_.phase.units(), off_at_end);
    const auto each_port = [this](const auto& visit) {
      for (std::uint32_t k = 0; k < cylinders(); ++k) {
        for (int port = 0; port < kPorts; ++port) visit(k, port);
      }
    };
    each_port([&](std::uint32_t k, int port) {
      off_at_begin.of[port][k] = state_.cylinder_gas.area_m2[port][k] - off_at_begin.of[port][k];
      if constexpr (N::elastic_valves) off_at_end.of[port][k] = end.of[port][k] - off_at_end.of[port][k];
    });
    const std::uint64_t each = part_of(step.turned, kPerParts_32[parts]);
    step.drive.step_s *= kPerParts[parts];
    step.drive.area_per_m3 = most_area_per_m3(step.drive.step_s);
    CylinderGasOutput<Real> shown[kCylinders] = {};
    std::uint32_t faults = 0;
    for (int i = 1; i < parts; ++i, from = step.phase) {
      step.phase = from + each;
      step.turned = static_cast<std::int64_t>(each);
      read_cam_areas(step.phase, areas);
      const Real done = static_cast<Real>(i) * kPerParts[parts];
      each_port([&](std::uint32_t k, int port) {
        const Real begin = off_at_begin.of[port][k];
        const Real area = areas.of[port][k] + (begin + (off_at_end.of[port][k] - begin) * done);
        areas.of[port][k] = area > 0 ? area : Real{0};
      });
      faults |= run_step(input, step, areas);
      add_shown(shown);
    }
    step.phase = state_.phase.units();
    step.turned = static_cast<std::int64_t>(step.phase - from);
    faults |= run_step(input, step, end);
    add_shown(shown);
    for (std::uint32_t k = 0; k < cylinders(); ++k) {
      CylinderGasOutput<Real>& all = out_.cylinder_gas[k];
      for (int port = 0; port < kPorts; ++port) all.flow_kg_s[port] = shown[k].flow_kg_s[port];
      all.wall_heat_W = shown[k].wall_heat_W;
    }
    return faults;
  }
  /// What a step shows of flow and heat.
  void add_shown(CylinderGasOutput<Real> (&sum)[kCylinders]) const noexcept {
    for (std::uint32_t k = 0; k < cylinders(); ++k) {
      const CylinderGasOutput<Real>& last = out_.cylinder_gas[k];
      for (int port = 0; port < kPorts; ++port) sum[k].flow_kg_s[port] += last.flow_kg_s[port];
      sum[k].wall_heat_W += last.wall_heat_W;
    }
  }

  [[nodiscard]] std::uint32_t run_step(const Input<Real, S>& input, EngineGasStep<Real>& step,
                                       const Areas& areas) noexcept {
    see_manifolds(step, areas);
    const std::uint32_t faults = GasCylindersStep<Real, S>(tables_, state_, out_, work_J_).run(input, step, areas);
    return faults | step_manifolds(step);
  }

  [[gnu::always_inline]] void see_manifolds(EngineGasStep<Real>& step,
                                            [[maybe_unused]] const Areas& areas) const noexcept {
    [[maybe_unused]] Real outside_m2[kPorts] = {};
    if constexpr (N::manifolds)
      outside_m2[kIntake] = throttle_m2(), outside_m2[kExhaust] = tables_.gas_manifolds->outlet_m2;
    for (int port = 0; port < kPorts; ++port) {
      step.taken_kg[port] = Real{0};
      if constexpr (N::manifolds) {
        std::uint32_t open = 0;
        for (std::uint32_t k = 0; k < cylinders(); ++k) {
          const auto bits = bits_of(areas.of[port][k]);  // of a number that is not negative
          open += static_cast<std::uint32_t>((0 - bits) >> (8 * sizeof bits - 1));
        }
        if constexpr (S::runners) {
          if (tables_.gas_runners->of[port].area_m2 > 0) open = cylinders();
        }
        step.beyond[port] = seen_from_ports(state_.manifold[port], outside(port), outside_m2[port],
                                            tables_.gas_manifolds->per_volume_m3[port], state_.taken_kg_s[port],
                                            static_cast<Real>(open), most_m3(), step.drive.step_s);
      } else {
        step.beyond[port] = given(port, static_cast<Real>(port));
      }
    }
  }
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
  /// Of a cylinder.
  [[nodiscard]] Real most_m3() const noexcept {
    const GasCylinders<Real>& table = *tables_.gas_cylinders;
    return table.clearance_m3 + Real{1} / table.per_swept_m3;
  }

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
    }
    return put_back ? std::uint32_t{kFaultGas} : 0;
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
    if constexpr (S::walls) lose_heat_of(state_.manifold[port], port, step.drive.step_s);
    return in_kg;
  }
  /// To the walls of a manifold; where there are runners, they have them.
  void lose_heat_of(ManifoldGas<Real>& manifold, int port, Real step_s) noexcept {
    const WarmWallsTable<Real>& walls = *tables_.gas_walls;
    if (!(walls.port_W_K[port] > 0)) return;
    if constexpr (S::runners) {
      if (tables_.gas_runners->of[port].area_m2 > 0) return;
    }
    const Real heat_J = lose_heat(manifold.contents, manifold.point, tables_.gas_manifolds->per_volume_m3[port],
                                  walls.port_W_K[port], walls.behind_K, step_s);
    out_.port_heat_W[port] += heat_J * tables_.drive->per_tick_s;
  }
  /// What flows back through it.
  [[nodiscard]] GasBeyond<Real> behind_outlet(Real pressure_Pa) const noexcept {
    const OutletGas<Real>& gas = state_.outlet;
    return beyond(GasPoint<Real>{pressure_Pa, gas.temperature_K, gas.burned_ratio, Real{0}}, Real{0});
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
  Real work_J_ = Real{0};
  std::conditional_t<S::boundaries, GasBeyond<Real>[kPorts], char> boundary_;
  Real outside_kg_[kPorts] = {};  ///< into the manifolds from outside, in this tick
};

}  // namespace crankloop::detail
