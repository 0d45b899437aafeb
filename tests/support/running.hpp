// Scenes by what they ask for, and tables that hold every section, so that one build serves any scene.
//
// What belongs here: what the tests of the tick share to run an engine. What does not: definitions (engines.hpp),
// expectations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/step.hpp>

#include "support/both_reals.hpp"
#include "support/scenes.hpp"
#include "support/status.hpp"

namespace crankloop::tick_test {

/// Room for the finest gas grid of all: 20 segments in every degree.
inline constexpr int kFinestGrid = static_cast<int>(kMaxGasSegments);

/// Every section of an engine's tables, on the heap.
template <class Real>
class FullTables {
 public:
  Status build(const EngineDefinition& engine, double tick_s, int gas_capacity = kFinestGrid) {
    const auto room = static_cast<std::size_t>(gas_capacity);
    for (auto* segments : {&pressure_full_, &pressure_motored_, &pressure_heat_}) segments->assign(room, {});
    for (auto* segments : {&gas_full_, &gas_motored_, &gas_heat_}) segments->assign(room, {});
    TableTargets<Real> t;
    t.drive = &s_->drive;
    t.body = &s_->body;
    t.stroke = &s_->stroke;
    t.motion = &s_->motion;
    t.lean = &s_->lean;
    t.rod = &s_->rod;
    t.rod_curvature = &s_->rod_curvature;
    t.inertia_torque = &s_->inertia_torque;
    t.bearings = &s_->bearings;
    t.balance = &s_->balance;
    t.gas_grid = &s_->gas_grid;
    t.torque_grid = &s_->torque_grid;
    t.gas_capacity = gas_capacity;
    t.pressure_full = pressure_full_.data();
    t.pressure_motored = pressure_motored_.data();
    t.pressure_heat = pressure_heat_.data();
    t.gas_torque_full = &s_->gas_torque_full;
    t.gas_torque_motored = &s_->gas_torque_motored;
    t.gas_torque_heat = &s_->gas_torque_heat;
    t.gas_full = gas_full_.data();
    t.gas_motored = gas_motored_.data();
    t.gas_heat = gas_heat_.data();
    if (const Status refused = tabulate(engine, {tick_s}, t, &report_); !refused.ok()) return refused;
    sections_.drive = t.drive;
    sections_.body = t.body;
    sections_.stroke = t.stroke;
    sections_.motion = t.motion;
    sections_.lean = t.lean;
    sections_.rod = t.rod;
    sections_.rod_curvature = t.rod_curvature;
    sections_.inertia_torque = t.inertia_torque;
    sections_.gas_grid = t.gas_grid;
    sections_.torque_grid = t.torque_grid;
    sections_.pressure_full = t.pressure_full;
    sections_.pressure_motored = t.pressure_motored;
    sections_.pressure_heat = t.pressure_heat;
    sections_.gas_torque_full = t.gas_torque_full;
    sections_.gas_torque_motored = t.gas_torque_motored;
    sections_.gas_torque_heat = t.gas_torque_heat;
    sections_.bearings = t.bearings;
    sections_.balance = t.balance;
    return {};
  }

  [[nodiscard]] const Sections<Real>& sections() const { return sections_; }
  [[nodiscard]] const TableReport& report() const { return report_; }
  [[nodiscard]] const detail::Drive<Real>& drive() const { return *sections_.drive; }

 private:
  struct Fixed {
    detail::Drive<Real> drive;
    detail::Body<Real> body;
    detail::IntegratedCurve<Real> stroke;
    detail::Revolution<detail::MotionSegment<Real>> motion;
    detail::Revolution<detail::LeanSegment<Real>> lean;
    detail::Revolution<detail::RodSegment<Real>> rod;
    detail::Curve<Real> rod_curvature;
    detail::IntegratedCurve<Real> inertia_torque;
    detail::Bearings<Real> bearings;
    detail::Balance<Real> balance;
    detail::GasGrid gas_grid;
    detail::GasGrid torque_grid;
    detail::GasTorque<Real> gas_torque_full;
    detail::GasTorque<Real> gas_torque_motored;
    detail::GasTorque<Real> gas_torque_heat;
  };
  std::vector<Fixed> heap_ = std::vector<Fixed>(1);
  Fixed* s_ = heap_.data();
  std::vector<detail::Segment<Real>> pressure_full_, pressure_motored_, pressure_heat_;
  std::vector<detail::IntegratedSegment<Real>> gas_full_, gas_motored_, gas_heat_;
  Sections<Real> sections_{};
  TableReport report_{};
};

/// An engine with the view of its tables that it points to. Fails the test when it does not start.
template <class Real, class S>
struct Running {
  explicit Running(const FullTables<Real>& full, Phase start = Phase{}) : tables(full.sections()) {
    EXPECT_TRUE(accepted(engine.init(tables, start)));
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  Tables<Real, S> tables;
  Engine<Real, S> engine;
};

/// An input that says only where the crank is, or how fast it turns.
template <class Engine>
[[nodiscard]] typename Engine::Input at_phase(Phase crank) {
  typename Engine::Input in;
  in.crank = crank;
  return in;
}
template <class Engine>
[[nodiscard]] typename Engine::Input at_speed(double speed_rad_s) {
  typename Engine::Input in;
  in.speed_rad_s = static_cast<decltype(in.speed_rad_s)>(speed_rad_s);
  return in;
}

/// The phase of an engine angle in degrees of the cycle, to the last bit of long double.
[[nodiscard]] inline Phase phase_at_deg(long double deg) {
  const long double cycles = deg / 720;
  const long double scaled = cycles * 4294967296.0L;
  auto high = static_cast<std::int64_t>(scaled);
  if (static_cast<long double>(high) > scaled) --high;
  const auto low = static_cast<std::uint64_t>((scaled - static_cast<long double>(high)) * 4294967296.0L);
  return Phase{(static_cast<std::uint64_t>(high) << 32) + low};
}

/// Engine angle of a phase in degrees, 0 to 720.
[[nodiscard]] inline long double deg_of(Phase phase) {
  return static_cast<long double>(phase.units()) * (720.0L / 18446744073709551616.0L);
}

/// Angle turned, the short way round, in radians.
[[nodiscard]] inline long double turned_rad(Phase from, Phase to) {
  constexpr long double kRadPerUnit = 12.566370614359172953850573533118L / 18446744073709551616.0L;
  return static_cast<long double>(static_cast<std::int64_t>((to - from).units())) * kRadPerUnit;
}

/// An engine whose crank is turned by forces, with tables of its own. Fails the test when tables or engine are refused.
template <class Real, class S>
class Turned {
 public:
  using Input = typename Engine<Real, S>::Input;

  explicit Turned(const EngineDefinition& definition, double tick_s = 100e-6, double speed_rad_s = 0,
                  Phase start = Phase{}) {
    EXPECT_TRUE(accepted(storage_->build(definition, {tick_s})));
    EXPECT_TRUE(accepted(engine.init(storage_->tables(), start)));
    if (speed_rad_s != 0) {
      EXPECT_TRUE(accepted(engine.restore(turning_at<Real, S>(engine.state(), static_cast<Real>(speed_rad_s)))));
    }
  }

  /// Steps, and counts the angle turned.
  const typename Engine<Real, S>::Output& step(const Input& in) {
    const Phase before = engine.state().phase;
    const auto& out = engine.step(in);
    angle_rad += turned_rad(before, engine.state().phase);
    return out;
  }

  Engine<Real, S> engine;
  long double angle_rad = 0;

 private:
  std::unique_ptr<TableStorage<Real, S>> storage_ = std::make_unique<TableStorage<Real, S>>();
};

}  // namespace crankloop::tick_test
