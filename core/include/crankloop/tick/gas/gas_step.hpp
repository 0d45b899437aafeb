// The gas of an engine over one tick. docs/model.md "Gas".
//
// What belongs here: the order of it. What does not: the cylinders' step (gas_cylinders.hpp), the manifolds'
// (engine_manifolds.hpp), inputs (gas_inputs.hpp), where pistons and valves stand (gas_places.hpp).
//
//     inputs -> port areas from the valves' lifts -> in steps of at most 5 deg: cylinders, manifolds -> what is shown
#pragma once

#include <cstdint>
#include <cstring>

#include <crankloop/assert.hpp>
#include <crankloop/tick/gas/engine_manifolds.hpp>
#include <crankloop/tick/gas/engine_walls.hpp>
#include <crankloop/tick/gas/exhaust_lambda.hpp>
#include <crankloop/tick/gas/gas_cylinders.hpp>
#include <crankloop/tick/gas/gas_inputs.hpp>
#include <crankloop/tick/gas/gas_shown.hpp>
#include <crankloop/tick/gas/gas_start.hpp>
#include <crankloop/tick/gas/unburned_fuel.hpp>
#include <crankloop/tick/valve/valve.hpp>

namespace crankloop::detail {

/// A tick that turns the crank further is cut into equal steps, at most as many as the tables say.
inline constexpr std::uint64_t kGasStep = ~std::uint64_t{0} / 144;  ///< kGasStep_deg
static_assert(144 * kGasStep_deg == kDegreesPerCycle);
template <class Real, class S>
class GasStep : EngineManifolds<Real, S> {
  using Manifolds = EngineManifolds<Real, S>;
  using Manifolds::tables_, Manifolds::state_, Manifolds::out_;
  using N = Needs<S>;
  static constexpr std::uint32_t kCylinders = S::cylinders.capacity;
  using Areas = PortAreas<Real, kCylinders>;

 public:
  GasStep(const Tables<Real, S>& tables, State<Real, S>& state, Output<Real, S>& out) noexcept
      : Manifolds(tables, state, out) {}

  /// The crank has turned, the valves have moved. Answers fault bits; `work_J`: of all cylinders on the crank, against
  /// the crankcase's pressure.
  [[nodiscard, gnu::noinline]] std::uint32_t run(const Input<Real, S>& input, Phase turned, bool jumped,
                                                 Real& work_J) noexcept {
    std::uint32_t faults = take_gas_inputs<Real, S>(tables_, input, state_);
    Manifolds::take_boundaries();
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
      show_filled(tables_, state_, out_);
    } else {
      faults |= run_steps(input, end, static_cast<std::int64_t>(turned.units()));
      if constexpr (S::walls) faults |= step_cylinder_walls(tables_, state_, out_);
    }
    Manifolds::show_manifolds();
    if constexpr (N::lambda) {
      if (tables_.lambda->in_use != 0) show_lambda(tables_, state_, out_);
    }
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
    ShownOfSteps<Real, kCylinders> shown{};
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
      shown.add(out_.cylinder_gas, cylinders());
    }
    step.phase = state_.phase.units();
    step.turned = static_cast<std::int64_t>(step.phase - from);
    faults |= run_step(input, step, end);
    shown.add(out_.cylinder_gas, cylinders());
    shown.show(out_.cylinder_gas, cylinders());
    return faults;
  }

  [[nodiscard]] std::uint32_t run_step(const Input<Real, S>& input, EngineGasStep<Real>& step,
                                       const Areas& areas) noexcept {
    Manifolds::show_to_cylinders(step, areas);
    if constexpr (N::lambda) {
      UnburnedStep<Real, S> unburned(tables_, state_, out_, Manifolds::outside_kg());
      std::uint32_t faults = GasCylindersStep<Real, S>(tables_, state_, out_, work_J_).run(input, step, areas);
      faults |= Manifolds::step_manifolds(step);
      unburned.run();
      return faults;
    } else {
      const std::uint32_t faults = GasCylindersStep<Real, S>(tables_, state_, out_, work_J_).run(input, step, areas);
      return faults | Manifolds::step_manifolds(step);
    }
  }

  Real work_J_ = Real{0};
};

}  // namespace crankloop::detail
