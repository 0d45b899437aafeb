// A four-cylinder diesel with eight elastic valves, all of it told, on a measured crank or at a given speed: the engine
// that faults are injected into and that is run for long.
//
// What belongs here: the engine, and its bits. What does not: what is done to it.
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

#include "support/output_fields.hpp"
#include "support/scenes.hpp"
#include "support/status.hpp"
#include "support/test_engines.hpp"
#include "support/test_valves.hpp"

namespace crankloop::tick_test {

inline EngineDefinition four_with_valves() {
  EngineDefinition engine = diesel_495();
  engine.train_count = 2;
  for (int t = 0; t < 2; ++t) {
    engine.trains[t] = valve_test::ohc_125_train();
    engine.trains[t].cam.full_lift_deg = t == 0 ? 450 : 250;
    engine.trains[t].cam.phase_rate_deg_s = 2000;
  }
  return engine;
}

/// Tables of it, built once for each scalar and scene.
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
