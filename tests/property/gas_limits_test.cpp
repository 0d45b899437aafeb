// Engines at the limits of what a definition may say, and beyond those of what an input may: every number that is shown
// is finite, and every state can be saved and loaded.
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/scenes.hpp>
#include <crankloop/tick/state/saved_state.hpp>

#include "support/both_reals.hpp"
#include "support/gas_engine.hpp"
#include "support/output_fields.hpp"
#include "support/random.hpp"

namespace crankloop::gas_limits_test {
namespace {

using support::Breathing;
using support::BreathingFour;
using support::four_2000;
using support::Random;
using tick_test::RealName;

constexpr double kPi = 3.14159265358979323846;

template <class Real, class S>
void expect_finite(const Output<Real, S>& out) {
  support::each_output(out, {4, 4, 2}, [](const char* name, std::size_t i, auto x) {
    EXPECT_TRUE(std::isfinite(static_cast<double>(x))) << name << "[" << i << "]";
  });
}
template <class Real, class S>
[[nodiscard]] Status loads_what_it_saves(Engine<Real, S>& engine) {
  std::vector<unsigned char> bytes(kSavedStateBytes<Real, S>);
  const Status status = save_state(engine, bytes.data(), bytes.size());
  return status.ok() ? load_state(bytes.data(), bytes.size(), engine) : status;
}

template <class Real>
class GasAtItsLimits : public ::testing::Test {};
TYPED_TEST_SUITE(GasAtItsLimits, tick_test::BothReals, RealName);

// ---- a fuel that fades ----------------------------------------------------------------------------------------------

/// A controller that takes fuel away by a hundredth a time never gets to 0.
TYPED_TEST(GasAtItsLimits, LetsFuelFadeWithoutAnExcessOfAirThatGrowsForever) {
  using Real = TypeParam;
  Breathing<Real, BreathingFour> run(four_2000(), 500e-6);
  run.in.speed_rad_s = static_cast<Real>(6000 * kPi / 30);  // 40 ticks a cycle
  double largest = 0;
  for (int tick = 0; tick < 80'000; ++tick) {
    const auto& out = run.step();
    for (std::size_t k = 0; k < 4; ++k) {
      run.in.fuel_kg[k] *= static_cast<Real>(0.99);
      largest = std::fmax(largest, static_cast<double>(out.gas_cycle[k].excess_air_ratio));
    }
    if (tick % 1000 == 0) {
      ASSERT_TRUE(accepted(loads_what_it_saves(run.engine))) << tick;
    }
  }
  EXPECT_GT(largest, 1e6);
  EXPECT_LT(largest, 1e-3 / 14.6 / kLeastFuel_kg);  // a cylinder of half a litre holds less than a gram
  EXPECT_EQ(run.engine.output().gas_cycle[0].excess_air_ratio, Real{0}) << "no fuel";
  EXPECT_EQ(run.engine.output().faults, 0u);
}

/// The ready-made scenes of an engine that breathes, its fuel fading to the smallest numbers there are.
template <class Real, class S>
void saves_what_it_loads() {
  const auto run = std::make_unique<Breathing<Real, S>>(four_2000(), 200e-6);
  if constexpr (S::crank == CrankGiven::speed) {
    run->in.speed_rad_s = static_cast<Real>(6000 * kPi / 30);
  } else {
    run->in.starter = 1;
  }
  for (int tick = 0; tick < 5000; ++tick) {
    expect_finite(run->step());
    for (std::size_t k = 0; k < 4; ++k) run->in.fuel_kg[k] *= static_cast<Real>(0.98);
    if (tick % 50 == 0) {
      ASSERT_TRUE(accepted(loads_what_it_saves(run->engine))) << tick;
    }
  }
}
TYPED_TEST(GasAtItsLimits, IsSavedAndLoadedInEachReadyMadeScene) {
  saves_what_it_loads<TypeParam, scenes::Breathing>();
  saves_what_it_loads<TypeParam, scenes::BreathingFree>();
}

TYPED_TEST(GasAtItsLimits, CallsLessThanTheLeastFuelNone) {
  using Real = TypeParam;
  for (const double share : {1.001, 0.999}) {
    Breathing<Real, BreathingFour> run(four_2000(), 100e-6);
    run.in.speed_rad_s = static_cast<Real>(3000 * kPi / 30);
    for (Real& fuel : run.in.fuel_kg) fuel = static_cast<Real>(share * kLeastFuel_kg);
    for (int tick = 0; tick < 1200; ++tick) run.step();
    const auto& cycle = run.engine.output().gas_cycle[0];
    EXPECT_EQ(cycle.excess_air_ratio > 0, share > 1) << share;
    EXPECT_EQ(cycle.fuel_kg > 0, share > 1) << share;
  }
}

// ---- any accepted definition ----------------------------------------------------------------------------------------

/// Of each number a limit as often as not.
class Limits {
 public:
  explicit Limits(Random& random) : random_{random} {}

  double operator()(double least, double most) {
    const double dice = random_.between(0, 1);
    if (dice < 0.25) return least;
    if (dice < 0.5) return most;
    const double at = random_.between(0, 1);
    return least > 0 ? least * std::pow(most / least, at) : least + at * (most - least);
  }

 private:
  Random& random_;
};

[[nodiscard]] EngineDefinition at_limits(Random& random) {
  Limits of(random);
  EngineDefinition engine = four_2000();
  Gas& gas = engine.gas;
  engine.crank.compression_ratio = random.coin() ? 10.5 : of(1.01, 100);
  const double scale = random.coin() ? 1 : of(0.05, 10);
  for (double* length : {&engine.crank.bore_m, &engine.crank.crank_radius_m, &engine.crank.rod_length_m})
    *length *= scale;
  if (random.coin()) engine.pressure.crankcase_Pa = of(1e3, 1e6);
  if (random.coin()) {
    gas.intake_m3 = of(1e-8, 100), gas.exhaust_m3 = of(1e-8, 100);
    gas.throttle_m2 = of(1e-8, 10), gas.outlet_m2 = of(1e-8, 10);
    gas.throttle_closed_m2 = gas.throttle_m2 * random.between(0, 1);
  }
  if (random.coin())
    gas.ambient_Pa = of(1e3, 1e7), gas.ambient_K = of(150, 3000), gas.exhaust_K = of(150, 3000),
    gas.wall_K = of(150, 2000);
  gas.wall_heat_ratio = random.coin() ? 1 : of(0, 100);
  gas.heating_value_J_kg = of(0, 2e8), gas.air_fuel_ratio = of(1, 100), gas.fuel_kg = of(1e-9, 0.01);
  gas.combustion_efficiency = of(0, 1);
  gas.wiebe_m = of(0, 10);
  gas.burn_start_deg = of(-90, 60), gas.burn_duration_deg = of(5, 150);
  for (int t = 0; t < 2; ++t) {
    if (random.coin()) gas.ports[t].seat_diameter_m = of(1e-4, 1);
    if (random.coin()) engine.trains[t].cam.half_angle_deg = of(40, 150);
  }
  return engine;
}

template <class Real, class S>
struct AnEngine {
  TableStorage<Real, S> storage;
  Engine<Real, S> engine;
  Input<Real, S> in;
};

/// CRANKLOOP_LONG_TESTS=1 in the environment: 1000 engines of 1000 ticks each.
template <class Real, class S>
void shows_numbers_and_saves_what_it_loads() {
  const bool whole = std::getenv("CRANKLOOP_LONG_TESTS") != nullptr;
  const int engines = whole ? 1000 : 25;
  Random random;
  int put_back = 0, refused = 0;
  for (int accepted_ones = 0; accepted_ones < engines;) {
    SCOPED_TRACE(random.trace(accepted_ones));
    const auto run = std::make_unique<AnEngine<Real, S>>();
    const EngineDefinition definition = at_limits(random);
    Limits of(random);
    if (!run->storage.build(definition, {random.coin() ? 1e-3 : of(1e-6, 2e-3), {}}).ok()) {
      ASSERT_LT(++refused, 100 * engines);
      continue;
    }
    ++accepted_ones;
    ASSERT_TRUE(accepted(run->engine.init(run->storage.tables())));
    const Real none[] = {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity(), Real{-1},
                         std::numeric_limits<Real>::max(), std::numeric_limits<Real>::denorm_min()};
    const auto some = [&](double least, double most) {
      return random.whole(0, 19) == 0 ? none[random.whole(0, 4)] : static_cast<Real>(of(least, most));
    };
    const bool steady = random.coin();  // of a steady crank cycles are told
    for (int tick = 0; tick < 1000; ++tick) {
      if (tick % (steady ? 1000 : 10) == 0) run->in.speed_rad_s = some(steady ? 100 : -3000, 3000);
      if (tick % 100 == 0) {
        run->in.throttle_ratio = some(0, 1);
        for (std::size_t k = 0; k < 4; ++k) {
          run->in.fuel_kg[k] = random.coin() ? static_cast<Real>(definition.gas.fuel_kg) : some(0, 0.01);
          run->in.burn_start_deg[k] = some(-90, 60), run->in.burn_duration_deg[k] = some(5, 150);
        }
      }
      const auto& out = run->engine.step(run->in);
      put_back += (out.faults & kFaultGas) != 0 ? 1 : 0;
      expect_finite(out);
      for (const auto& cylinder : out.cylinder_gas) {
        EXPECT_GT(cylinder.pressure_Pa, 0);
        EXPECT_GT(cylinder.mass_kg, 0);
        EXPECT_GE(cylinder.temperature_K, Real{99});
        EXPECT_LE(cylinder.temperature_K, Real{6001});
        EXPECT_GE(cylinder.burned_ratio, 0);
        EXPECT_LE(cylinder.burned_ratio, 1);
      }
      if (tick % 10 == 0) {
        EXPECT_TRUE(accepted(loads_what_it_saves(run->engine)));
      }
      ASSERT_FALSE(::testing::Test::HasFailure()) << "tick " << tick;
    }
  }
  EXPECT_GT(put_back, 0) << "gas that is put right is never seen";
  ::testing::Test::RecordProperty("ticks_with_gas_put_back", put_back);
  ::testing::Test::RecordProperty("definitions_refused", refused);
}
TYPED_TEST(GasAtItsLimits, ShowsNothingButNumbersAndSavesNothingThatItRefuses) {
  shows_numbers_and_saves_what_it_loads<TypeParam, BreathingFour>();
}
TYPED_TEST(GasAtItsLimits, ShowsNothingButNumbersWithElasticValvesToo) {
  shows_numbers_and_saves_what_it_loads<TypeParam, support::ElasticBreathingFour>();
}

}  // namespace
}  // namespace crankloop::gas_limits_test
