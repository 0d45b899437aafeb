// Engines of all sorts of valve counts, run the same way by two translation units: one steps valves abreast, one steps
// them one by one.
//
// What belongs here: the engines and what is done to them. What does not: the comparison (valve_lanes_test.cpp).
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/step.hpp>

#include "support/engines.hpp"
#include "support/random.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"
#include "support/units.hpp"

namespace crankloop::valve_lanes {

inline EngineDefinition engine_of(int cylinders, int trains, bool gas, int modes) {
  std::vector<double> firing_deg;
  for (int k = 0; k < cylinders; ++k) firing_deg.push_back(720.0 * k / cylinders);
  EngineDefinition engine = support::with_cylinders(valve_test::engine_with(valve_test::ohc_125_train()), firing_deg);
  engine.train_count = trains;
  for (int t = 0; t < trains; ++t) {
    engine.trains[t] = valve_test::ohc_125_train();
    engine.trains[t].cam.full_lift_deg = 450 - 120.0 * t;
    engine.trains[t].cam.phase_rate_deg_s = 3000;
    engine.trains[t].valve.valve_kg *= 1 + 0.3 * t;
    if (t == 1) engine.trains[t].rocker.clearance_m = 0;
    if (gas) engine.trains[t].valve.head_area_m2 = 4e-4 + 1e-4 * t;
    engine.trains[t].valve.surge_modes = modes - t > 0 ? modes - t : 0;
    engine.contacts[t].width_m = 9e-3 + 1e-3 * t;
    if (t != 1) engine.contacts[t].friction_ratio = 0.1;
  }
  return engine;
}

template <class T>
void add_words(const T& of, std::vector<std::uint32_t>& bits) {
  std::uint32_t words[sizeof of / 4];
  static_assert(sizeof words == sizeof of);
  std::memcpy(words, &of, sizeof words);
  bits.insert(bits.end(), words, words + sizeof of / 4);
}

/// Bits of all outputs, the faults and the state, tick by tick: speeds from standstill to a lobe in a tick, both ways,
/// jumps of the crank, moving cams, pressures that press a closed valve into its seat and suck it open.
template <class S>
std::vector<std::uint32_t> bits_of(int cylinders, int trains, double tick_s) {
  const auto tables = std::make_unique<TableStorage<float, S>>();
  EXPECT_TRUE(accepted(tables->build(engine_of(cylinders, trains, S::valve_gas, S::spring_modes), {tick_s, {}})));
  const auto engine = std::make_unique<Engine<float, S>>();
  EXPECT_TRUE(accepted(engine->init(tables->tables(), Phase{12345678901234567u})));
  const double limit_deg = static_cast<double>(tables->tables().drive->speed_limit_rad_s) * tick_s * 180 / support::kPi;
  support::Random random(4711);
  std::vector<std::uint32_t> bits;
  typename Engine<float, S>::Input in;
  double deg_per_tick = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    if (tick % 250 == 0) deg_per_tick = random.between(-1, 1) * limit_deg * (tick % 500 == 0 ? 1 : 0.1);
    in.crank += Phase{static_cast<std::uint64_t>(static_cast<std::int64_t>(deg_per_tick / 720 * 0x1p64))};
    if (random.whole(0, 399) == 0) in.crank = Phase{random.bits()};
    if constexpr (S::cam_phasing) {
      for (float& deg : in.cam_phase_deg) deg = tick % 700 < 350 ? 10.0F : -25.0F;
    }
    if constexpr (S::valve_gas) {
      for (float& pressure : in.pressure_Pa) {
        if (random.whole(0, 19) == 0) pressure = static_cast<float>(random.between(0, random.coin() ? 2e5 : 2e7));
      }
    }
    if (random.whole(0, 99) == 0) {  // what a tick remembers, worked out anew: the same bits
      EXPECT_TRUE(accepted(engine->restore(State<float, S>(engine->state()))));
    }
    const auto& out = engine->step(in);
    bits.push_back(out.faults);
    if constexpr (S::cam_torque) add_words(out.camshaft_Nm, bits);
    for (int t = 0; t < trains; ++t) {
      for (int k = 0; k < cylinders; ++k) {
        add_words(out.valve[t][k], bits);
        if constexpr (S::valve_forces) add_words(out.valve_forces[t][k], bits);
        if constexpr (detail::Needs<S>::spring_forces) add_words(out.valve_spring[t][k], bits);
        if constexpr (S::valve_results) {
          add_words(out.valve_cycle[t][k], bits);
          add_words(engine->state().record[t][k], bits);
        }
        if constexpr (S::cam_contact) {
          add_words(out.cam_contact[t][k], bits);
          add_words(out.cam_contact_cycle[t][k], bits);
          add_words(engine->state().contact_record[t][k], bits);
        }
        if constexpr (S::cam_torque) add_words(out.cam_torque[t][k], bits);
        bits.push_back(engine->state().valve_regime[static_cast<std::size_t>(t) * S::cylinders.capacity +
                                                    static_cast<std::size_t>(k)]);
      }
    }
  }
  return bits;
}

struct LanesRun {
  const char* name;
  std::vector<std::uint32_t> bits;
};

template <class Unit, std::uint32_t Cylinders, std::uint32_t Trains, bool Exact, bool Phasing, bool Gas>
LanesRun told(const char* name, int cylinders, int trains, double tick_s) {
  return {name, bits_of<tick_test::ToldLanes<tick_test::Lanes<Unit, Cylinders, Trains, Exact, Phasing>, Gas>>(
                    cylinders, trains, tick_s)};
}

template <class Unit, std::uint32_t Cylinders, std::uint32_t Trains, bool Exact, bool Gas>
LanesRun surging(const char* name, int cylinders, int trains, double tick_s) {
  using tick_test::Lanes, tick_test::SurgingLanes, tick_test::ToldLanes;
  const double surging_s = tick_s < 100e-6 ? tick_s : 100e-6;  // a longer one is refused
  return {name, bits_of<SurgingLanes<ToldLanes<Lanes<Unit, Cylinders, Trains, Exact, false>, Gas>, 3>>(
                    cylinders, trains, surging_s)};
}

template <class Unit, std::uint32_t Cylinders, std::uint32_t Trains, bool Exact, bool Phasing, bool Gas>
LanesRun loaded(const char* name, int cylinders, int trains, double tick_s) {
  using Told = tick_test::ToldLanes<tick_test::Lanes<Unit, Cylinders, Trains, Exact, Phasing>, Gas>;
  return {name, bits_of<tick_test::CamLoadsAlone<Told>>(cylinders, trains, tick_s)};
}

/// Blocks of eight, of four, what fills none; several trains in a row and each for itself; cams that move.
template <class Unit>
std::vector<LanesRun> all_runs(double tick_s) {
  return {{"one valve", bits_of<tick_test::Lanes<Unit, 1, 1, true, false>>(1, 1, tick_s)},
          {"three cylinders", bits_of<tick_test::Lanes<Unit, 3, 2, true, false>>(3, 2, tick_s)},
          {"four cylinders", bits_of<tick_test::Lanes<Unit, 4, 2, true, false>>(4, 2, tick_s)},
          {"six cylinders, four trains", bits_of<tick_test::Lanes<Unit, 6, 4, true, false>>(6, 4, tick_s)},
          {"five of sixteen cylinders", bits_of<tick_test::Lanes<Unit, 16, 4, false, false>>(5, 3, tick_s)},
          {"sixteen of sixteen cylinders", bits_of<tick_test::Lanes<Unit, 16, 4, false, false>>(16, 4, tick_s)},
          {"phased cams", bits_of<tick_test::Lanes<Unit, 4, 2, true, true>>(4, 2, tick_s)},
          told<Unit, 4, 2, true, true, false>("phased cams, forces and results", 4, 2, tick_s),
          told<Unit, 16, 4, false, false, false>("seven of sixteen cylinders, forces and results", 7, 3, tick_s),
          {"what four cylinders' cams bear, forces and results",
           bits_of<tick_test::WithCamLoads<tick_test::ToldLanes<tick_test::Lanes<Unit, 4, 2, true, false>, false>>>(
               4, 2, tick_s)},
          loaded<Unit, 4, 2, true, true, false>("what phased cams bear", 4, 2, tick_s),
          loaded<Unit, 16, 4, false, false, false>("what seven of sixteen cylinders' cams bear", 7, 3, tick_s),
          loaded<Unit, 6, 3, true, false, true>("what six cylinders' cams bear under gas", 6, 3, tick_s),
          told<Unit, 4, 2, true, false, true>("four cylinders under gas", 4, 2, tick_s),
          told<Unit, 6, 3, true, true, true>("six phased cylinders under gas", 6, 3, tick_s),
          told<Unit, 8, 2, false, false, true>("five of eight cylinders under gas", 5, 2, tick_s),
          surging<Unit, 4, 2, true, false>("four cylinders, springs that surge", 4, 2, tick_s),
          surging<Unit, 16, 4, false, true>("seven of sixteen under gas, springs that surge", 7, 3, tick_s)};
}

std::vector<LanesRun> runs_one_by_one(double tick_s);

}  // namespace crankloop::valve_lanes
