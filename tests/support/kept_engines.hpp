// Engines whose tables are built once for all tests of a program: the 495, and the four cylinders with eight elastic
// valves that faults are injected into and that run for long.
//
// What belongs here: their scenes, how they are driven, their outputs as bits. What does not: what is done to them.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/step.hpp>

#include "support/both_reals.hpp"
#include "support/engines.hpp"
#include "support/output_fields.hpp"
#include "support/running.hpp"
#include "support/scenes.hpp"
#include "support/status.hpp"

namespace crankloop::tick_test {

constexpr double kTick_s = 100e-6;
constexpr PressureGiven kByTable = PressureGiven::by_table;
constexpr PressureGiven kByInput = PressureGiven::by_input;

using Everything = Asking<kAllGroups, kByTable, true>;
using EverythingByInput = Asking<kAllGroups, kByInput>;
using EverythingByPhase = Asking<kAllGroups, kByTable, true, CrankGiven::phase>;
using EverythingOfFour = Asking<kAllGroups, kByTable, true, CrankGiven::speed, 4>;
using TorqueOfFour = Asking<kTorque | kMeanTorque, kByTable, false, CrankGiven::speed, 4>;

template <class Real>
class DieselEngine : public ::testing::Test {
 protected:
  /// The 495's tables, built once for all tests of a scalar.
  static const FullTables<Real>& diesel() {
    static const std::unique_ptr<FullTables<Real>> tables = [] {
      auto built = std::make_unique<FullTables<Real>>();
      EXPECT_TRUE(accepted(built->build(diesel_495(), kTick_s)));
      return built;
    }();
    return *tables;
  }
};

/// Speed, load and pressures that vary slowly.
template <class Real, class S>
typename Engine<Real, S>::Input drive_of(int tick) {
  typename Engine<Real, S>::Input in;
  in.speed_rad_s = static_cast<Real>(180 + 30 * std::sin(0.01 * tick));
  if constexpr (detail::Needs<S>::load) in.load_ratio = static_cast<Real>(0.5 + 0.4 * std::sin(0.003 * tick));
  if constexpr (detail::Needs<S>::input_pressure) {
    int k = 0;
    for (Real& pressure : in.pressure_Pa) pressure = static_cast<Real>(1e5 + 4e4 * (tick * ++k % 97));
  }
  return in;
}

/// Tables of four_with_valves(), built once for each scalar and scene.
template <class Real, class S>
const TableStorage<Real, S>& tables_of_four(double tick_s = 50e-6) {
  static const std::unique_ptr<TableStorage<Real, S>> tables = [tick_s] {
    auto built = std::make_unique<TableStorage<Real, S>>();
    EXPECT_TRUE(accepted(built->build(four_with_valves(), {tick_s, {}})));
    return built;
  }();
  return *tables;
}

template <class Real, class S>
[[nodiscard]] std::unique_ptr<Engine<Real, S>> started_four(Phase start = {}) {
  auto engine = std::make_unique<Engine<Real, S>>();
  EXPECT_TRUE(accepted(engine->init(tables_of_four<Real, S>().tables(), start)));
  return engine;
}

inline constexpr support::Used kAllOfFour{4, 0, 2};

/// Its numbers as bits, without the results of the last whole valve cycle and without the faults.
template <class Real, class S>
[[nodiscard]] std::vector<std::uint64_t> bits_now(const Output<Real, S>& out) {
  std::vector<std::uint64_t> all;
  support::each_output(out, kAllOfFour, [&all](const char* name, std::size_t, auto x) {
    std::uint64_t word = 0;
    std::memcpy(&word, &x, sizeof x);
    if (std::strncmp(name, "cycle_", 6) != 0 && std::strcmp(name, "faults") != 0) all.push_back(word);
  });
  return all;
}

template <class Real, class S>
[[nodiscard]] bool is_finite(const Output<Real, S>& out) {
  bool finite = true;
  support::each_output(out, kAllOfFour, [&finite](const char*, std::size_t, auto x) {
    finite = finite && std::isfinite(static_cast<double>(x));
  });
  return finite;
}

}  // namespace crankloop::tick_test
