// Lambda of the exhaust and at its sensor: what goes in comes out, a pipe's length later, as slowly as the sensor is.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <deque>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/variables.hpp>

#include "support/both_reals.hpp"
#include "support/gas_engine.hpp"

namespace crankloop::exhaust_lambda_test {
namespace {

using support::Breathing;
using support::BreathingFour;
using support::rad_s;
using tick_test::RealName;

constexpr double kTick_s = 50e-6;

struct LambdaFour : BreathingFour {
  static constexpr std::uint32_t lambda_parcels = 32;
};
/// With all the ways that gas may go.
struct WholeFour : BreathingFour {
  static constexpr bool crevice = true;
  static constexpr bool runners = true;
  static constexpr bool walls = true;
  static constexpr bool cylinder_cut = true;
};
struct WholeLambdaFour : WholeFour {
  static constexpr std::uint32_t lambda_parcels = 32;
};

[[nodiscard]] EngineDefinition four(double pipe_m3, double lag_s) {
  EngineDefinition engine = support::four_2000();
  engine.lambda_sensor = {true, pipe_m3, lag_s};
  return engine;
}
[[nodiscard]] EngineDefinition whole_four(double pipe_m3, double lag_s) {
  EngineDefinition engine = four(pipe_m3, lag_s);
  engine.gas.crevice.volume_ratio = 0.015;
  engine.gas.intake_runner = {0.35, 0.035, 0.5};
  engine.gas.exhaust_runner = {0.25, 0.035, 0.5};
  return engine;
}

template <class Real, class S>
[[nodiscard]] std::unique_ptr<Breathing<Real, S>> turning(const EngineDefinition& engine, double rpm, double throttle) {
  auto run = std::make_unique<Breathing<Real, S>>(engine, kTick_s);
  run->in.speed_rad_s = static_cast<Real>(rad_s(rpm));
  run->in.throttle_ratio = static_cast<Real>(throttle);
  return run;
}
template <class Run>
void ask_lambda(Run& run, double lambda) {
  for (auto& ratio : run.in.excess_air_ratio) ratio = static_cast<std::decay_t<decltype(ratio)>>(lambda);
}
[[nodiscard]] int ticks_of_cycles(double cycles, double rpm) {
  return static_cast<int>(std::lround(cycles * 120 / rpm / kTick_s));
}

/// What went into the cylinders in their last cycles, from the results of the cycles: lambda of all of it together.
template <class Real, class S>
[[nodiscard]] double lambda_put_in(const Breathing<Real, S>& run, const EngineDefinition& engine) {
  const double swept_m3 =
      support::kPi / 4 * engine.crank.bore_m * engine.crank.bore_m * 2 * engine.crank.crank_radius_m;
  const double full_kg = swept_m3 * engine.gas.ambient_Pa / (287.1 * engine.gas.ambient_K);
  double air_kg = 0, fuel_kg = 0;
  for (const auto& cycle : run.engine.output().gas_cycle) {
    air_kg += static_cast<double>(cycle.volumetric_efficiency) * full_kg;
    fuel_kg += static_cast<double>(cycle.fuel_kg);
  }
  return air_kg / (engine.gas.air_fuel_ratio * fuel_kg);
}

template <class Real>
class ExhaustLambda : public ::testing::Test {};
TYPED_TEST_SUITE(ExhaustLambda, tick_test::BothReals, RealName);

TYPED_TEST(ExhaustLambda, IsThatOfAirAndFuelThatWentIn) {
  using Real = TypeParam;
  const double rpm = 3000;
  for (const double asked : {1.3, 1.0, 0.8}) {
    const EngineDefinition engine = whole_four(500e-6, 0.3);
    const auto run = turning<Real, WholeLambdaFour>(engine, rpm, 0.5);
    ask_lambda(*run, asked);
    for (int tick = 0; tick < ticks_of_cycles(120, rpm); ++tick) ASSERT_EQ(run->step().faults, 0u);
    const double expected = lambda_put_in(*run, engine);
    const auto& out = run->engine.output();
    EXPECT_NEAR(static_cast<double>(out.sensor_excess_air_ratio), expected, 2e-3 * expected) << asked;
    for (const Real& outflow : out.outflow_excess_air_ratio)
      EXPECT_NEAR(static_cast<double>(outflow), expected, 4e-3 * expected) << asked;
    EXPECT_EQ(run->engine.state().any_unburned, asked < 1 ? 1u : 0u);
  }
}

TYPED_TEST(ExhaustLambda, BlowByTakesUnburnedFuelByItsShare) {
  using Real = TypeParam;
  EngineDefinition engine = whole_four(500e-6, 0.3);
  engine.gas.crevice.blow_by_m2 = 2e-6;
  const auto run = turning<Real, WholeLambdaFour>(engine, 3000, 0.5);
  ask_lambda(*run, 0.8);
  for (int tick = 0; tick < ticks_of_cycles(10, 3000); ++tick) ASSERT_EQ(run->step().faults, 0u);
  const auto mass_kg = [&run] {
    const auto& state = run->engine.state();
    return static_cast<double>(state.cylinder_gas.mass_kg[0]) + static_cast<double>(state.crevice_gas.mass_kg[0]);
  };
  double begin_ratio = 0, begin_kg = 0, end_kg = 0;
  for (int tick = 0; tick < ticks_of_cycles(1, 3000); ++tick) {
    run->step();
    const double deg = static_cast<double>(tick_test::deg_of(run->engine.state().phase));
    const double kg = mass_kg(), ratio = static_cast<double>(run->engine.state().unburned_kg[0]) / kg;
    if (deg < 90 || deg > 118) continue;  // burned, and the exhaust valve is closed
    if (begin_kg == 0) begin_ratio = ratio, begin_kg = kg;
    end_kg = kg;
    ASSERT_NEAR(ratio, begin_ratio, 1e-5 * begin_ratio) << deg;
  }
  EXPECT_GT(begin_ratio, 0.005);
  EXPECT_LT(end_kg, 0.999 * begin_kg);
}

TYPED_TEST(ExhaustLambda, MixesUnlikeCylindersByTheirMass) {
  using Real = TypeParam;
  const double rpm = 2400;
  const EngineDefinition engine = four(300e-6, 0.5);
  const auto run = turning<Real, LambdaFour>(engine, rpm, 0.6);
  const double asked[] = {0.75, 0.95, 1.25, 1.6};
  for (int k = 0; k < 4; ++k) run->in.excess_air_ratio[k] = static_cast<Real>(asked[k]);
  for (int tick = 0; tick < ticks_of_cycles(120, rpm); ++tick) ASSERT_EQ(run->step().faults, 0u);
  const auto& out = run->engine.output();
  const double expected = lambda_put_in(*run, engine);
  EXPECT_NEAR(static_cast<double>(out.sensor_excess_air_ratio), expected, 0.01 * expected);
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(static_cast<double>(out.outflow_excess_air_ratio[k]), asked[k], 0.04 * asked[k]) << k;
}

/// A pipe is a queue of what flowed in, each with its volume.
TYPED_TEST(ExhaustLambda, ArrivesBehindThePipeWithinOneParcelOfItsVolume) {
  using Real = TypeParam;
  const double rpm = 2000, pipe_m3 = 1500e-6, parcel_m3 = pipe_m3 / 32;
  const auto run = turning<Real, LambdaFour>(four(pipe_m3, 0), rpm, 0.3);
  ask_lambda(*run, 1.1);
  struct Slice {
    double end_m3, ratio;
  };
  std::vector<Slice> in;
  double volume_m3 = 0, most_m3 = 0, arrives_s = 0, left_s = 0;
  int compared = 0;
  for (int tick = 0; tick < ticks_of_cycles(60, rpm); ++tick) {
    const double time_s = tick * kTick_s;
    if (tick == ticks_of_cycles(40, rpm)) ask_lambda(*run, 0.85);
    const auto& out = run->step();
    const auto& manifold = out.manifold[kExhaust];
    const double kg_m3 =
        static_cast<double>(manifold.pressure_Pa) / (287.1 * static_cast<double>(manifold.temperature_K));
    volume_m3 += static_cast<double>(out.outlet_kg_s) * kTick_s / kg_m3;
    const double ratio = 1 / static_cast<double>(out.exhaust_excess_air_ratio);
    if (volume_m3 > most_m3) most_m3 = volume_m3, in.push_back({most_m3, ratio});
    if (left_s == 0 && tick > ticks_of_cycles(40, rpm) && ratio > 1.05) left_s = time_s;
    const double shown = 1 / static_cast<double>(out.sensor_excess_air_ratio);
    if (arrives_s == 0 && tick > ticks_of_cycles(40, rpm) && shown > 1.05) arrives_s = time_s;
    if (most_m3 < 2 * pipe_m3) continue;
    double least = 1e9, most = 0;  // of what is that far behind, give or take a parcel
    for (auto slice = in.rbegin(); slice != in.rend() && slice->end_m3 > most_m3 - pipe_m3 - 1.01 * parcel_m3;
         ++slice) {
      if (slice->end_m3 > most_m3 - pipe_m3 + 1.01 * parcel_m3) continue;
      least = std::fmin(least, slice->ratio), most = std::fmax(most, slice->ratio);
    }
    ASSERT_GE(shown, least - 1e-4) << time_s;
    ASSERT_LE(shown, most + 1e-4) << time_s;
    ++compared;
  }
  EXPECT_GT(compared, 10000);
  // By hand: the volume by the mean flow of the last cycles.
  const double flow_m3_s =
      (in.back().end_m3 - in[in.size() / 2].end_m3) / (static_cast<double>(in.size() - in.size() / 2) * kTick_s);
  EXPECT_NEAR(arrives_s - left_s, pipe_m3 / flow_m3_s, 0.1 * pipe_m3 / flow_m3_s);
  EXPECT_GT(arrives_s - left_s, 10e-3);
}

/// Where nothing flows, a sensor that knew air before it sees the gas there by its first order.
TYPED_TEST(ExhaustLambda, IsShownTo63PercentAfterTheSensorsLag) {
  using Real = TypeParam;
  const double lag_s = 0.08;
  const auto run = turning<Real, LambdaFour>(four(0, lag_s), 2000, 0.3);
  ask_lambda(*run, 1.0);
  for (int tick = 0; tick < ticks_of_cycles(40, 2000); ++tick) run->step();
  auto state = run->engine.state();
  state.sensor_ratio = state.sensor_rest_ratio = Real{0};
  ASSERT_TRUE(accepted(run->engine.restore(state)));
  run->in.speed_rad_s = Real{0};
  const double there = 1 / static_cast<double>(run->step().exhaust_excess_air_ratio);
  double shown = 0;
  for (int tick = 1; tick < static_cast<int>(std::lround(lag_s / kTick_s)); ++tick)
    shown = 1 / static_cast<double>(run->step().sensor_excess_air_ratio);
  EXPECT_NEAR(shown / there, 0.63212, 2e-3);
  for (int tick = 0; tick < static_cast<int>(std::lround(8 * lag_s / kTick_s)); ++tick) run->step();
  const auto& out = run->engine.output();
  EXPECT_NEAR(static_cast<double>(out.sensor_excess_air_ratio / out.exhaust_excess_air_ratio), 1, 3e-3);
}

TYPED_TEST(ExhaustLambda, IsAirUntilTheEngineFiresAndStaysWhereItStands) {
  using Real = TypeParam;
  const auto run = turning<Real, WholeLambdaFour>(whole_four(500e-6, 0.02), 0, 0.1);
  const auto see = [&run](int ticks, const auto& expect) {
    for (int tick = 0; tick < ticks; ++tick) {
      const auto& out = run->step();
      ASSERT_EQ(out.faults, 0u);
      ASSERT_TRUE(out.exhaust_excess_air_ratio >= static_cast<Real>(0.01) && out.exhaust_excess_air_ratio <= Real{100});
      ASSERT_TRUE(out.sensor_excess_air_ratio >= static_cast<Real>(0.01) && out.sensor_excess_air_ratio <= Real{100});
      expect(out);
    }
  };
  const auto air = [](const auto& out) {
    ASSERT_EQ(out.exhaust_excess_air_ratio, Real{100});
    ASSERT_EQ(out.sensor_excess_air_ratio, Real{100});
  };
  const auto any = [](const auto&) {};
  see(1000, air);
  run->in.speed_rad_s = static_cast<Real>(rad_s(250));
  run->in.cut_cylinders = 15;
  see(40000, air);
  run->in.cut_cylinders = 0;
  ask_lambda(*run, 0.9);
  run->in.speed_rad_s = static_cast<Real>(rad_s(900));
  see(80000, any);
  const double put_in = lambda_put_in(*run, whole_four(0, 0));
  EXPECT_NEAR(static_cast<double>(run->engine.output().sensor_excess_air_ratio), put_in, 0.01);
  run->in.speed_rad_s = Real{0};
  see(4000, any);
  const Real stands = run->engine.output().sensor_excess_air_ratio;
  see(20000, any);
  EXPECT_NEAR(static_cast<double>(run->engine.output().sensor_excess_air_ratio), static_cast<double>(stands), 1e-3);
  run->in.speed_rad_s = static_cast<Real>(rad_s(1800));
  run->in.cut_cylinders = 15;
  run->in.throttle_ratio = Real{1};
  see(120000, any);  // washed out, to the last digit
  EXPECT_EQ(run->engine.output().sensor_excess_air_ratio, Real{100});
  EXPECT_EQ(run->engine.state().any_unburned, 0u);
}

/// A controller's loop by the sensor alone: a correction of all cylinders' fuel.
TYPED_TEST(ExhaustLambda, IsHeldByALoopOnItsSensorOverLoadStepsWithAndWithoutACutCylinder) {
  using Real = TypeParam;
  const double rpm = 2000;
  for (const std::uint32_t cut : {0u, 4u}) {
    const auto run = turning<Real, WholeLambdaFour>(whole_four(500e-6, 0.05), rpm, 0.3);
    run->in.cut_cylinders = cut;
    double integral = 0;
    for (const double throttle : {0.3, 0.6, 0.2}) {
      run->in.throttle_ratio = static_cast<Real>(throttle);
      double sum = 0;
      int counted = 0;
      for (int tick = 0; tick < ticks_of_cycles(100, rpm); ++tick) {
        const auto& out = run->step();
        ASSERT_EQ(out.faults, 0u);
        if (tick > ticks_of_cycles(80, rpm)) sum += static_cast<double>(out.sensor_excess_air_ratio), ++counted;
        if (tick % 200 != 0) continue;                                                  // each 10 ms
        const double error = 1 / static_cast<double>(out.sensor_excess_air_ratio) - 1;  // rich: positive
        integral += 0.02 * std::fmin(0.5, std::fmax(-0.5, error));
        integral = std::fmin(0.5, std::fmax(-0.5, integral));
        ask_lambda(*run, 1 + 0.1 * error + integral);
      }
      EXPECT_NEAR(sum / counted, 1, 0.01) << throttle << " " << cut;
    }
    if (cut != 0) {  // air of the cut cylinder is in it: the others are as much too rich
      EXPECT_NEAR(static_cast<double>(run->engine.output().outflow_excess_air_ratio[0]), 0.75, 0.03);
      EXPECT_GT(run->engine.output().outflow_excess_air_ratio[2], Real{4});  // what came back from the others is in it
    }
  }
}

/// All outputs that a scene has, in their order, but those of lambda.
template <class Real, class S>
[[nodiscard]] std::vector<Real> all_but_lambda(Breathing<Real, S>& run) {
  std::vector<Real> all;
  detail::each_output<S>(
      [&all](const detail::Variable& variable, const auto& value) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Real>) {
          const std::string name = variable.name;
          if (name != "exhaust.excess_air_ratio" && name != "sensor_excess_air_ratio" &&
              name != "outflow_excess_air_ratio[#]")
            all.push_back(value);
        }
      },
      run.engine.state(), run.engine.output(), detail::shape_of<Real, S>(run.storage.tables()));
  return all;
}

TYPED_TEST(ExhaustLambda, ChangesNoOtherBit) {
  using Real = TypeParam;
  EngineDefinition engine = whole_four(500e-6, 0.05);
  engine.gas.crevice.blow_by_m2 = 1e-6;
  const auto with = turning<Real, WholeLambdaFour>(engine, 3000, 0.4);
  const auto without = turning<Real, WholeFour>(engine, 3000, 0.4);
  for (auto* asked : {&with->in.excess_air_ratio, &without->in.excess_air_ratio}) {
    for (Real& lambda : *asked) lambda = static_cast<Real>(0.8);
  }
  for (int tick = 0; tick < 8000; ++tick) {
    with->step(), without->step();
    const std::vector<Real> one = all_but_lambda(*with), other = all_but_lambda(*without);
    ASSERT_EQ(one.size(), other.size());
    ASSERT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(Real)), 0) << tick;
  }
  EXPECT_GT(with->engine.output().sensor_excess_air_ratio, Real{0});
}

/// 1e-15 m3 of pipe are no way to go.
TYPED_TEST(ExhaustLambda, BehindAPipeOfNextToNoVolumeIsThatOfTheManifold) {
  using Real = TypeParam;
  const auto in_manifold = turning<Real, LambdaFour>(four(0, 0), 3000, 0.4);
  const auto tiny = turning<Real, LambdaFour>(four(1e-15, 0), 3000, 0.4);
  ask_lambda(*in_manifold, 0.9), ask_lambda(*tiny, 0.9);
  int flowing = 0;
  for (int tick = 0; tick < ticks_of_cycles(12, 3000); ++tick) {
    const auto &a = in_manifold->step(), &b = tiny->step();
    ASSERT_EQ(b.exhaust_excess_air_ratio, a.exhaust_excess_air_ratio);
    if (b.outlet_kg_s <= Real{0}) continue;  // what flows back in comes out of the pipe
    ASSERT_EQ(b.sensor_excess_air_ratio, a.sensor_excess_air_ratio) << tick;
    ++flowing;
  }
  EXPECT_GT(flowing, 1000);
  EXPECT_NEAR(static_cast<double>(tiny->engine.output().sensor_excess_air_ratio), 0.9, 0.05);
}

TEST(ExhaustLambdaSensor, IsRefusedWithItsFieldByTheEngineThatHasIt) {
  const auto refused = [](double pipe_m3, double lag_s) { return validate(four(pipe_m3, lag_s)); };
  EXPECT_TRUE(accepted(refused(1, 100)));
  EXPECT_TRUE(support::refuses(refused(1.01, 0.05), Reason::out_of_range, "lambda_sensor.pipe_m3"));
  EXPECT_TRUE(support::refuses(refused(-1e-6, 0.05), Reason::negative, "lambda_sensor.pipe_m3"));
  EXPECT_TRUE(support::refuses(refused(500e-6, std::nan("")), Reason::not_finite, "lambda_sensor.lag_s"));
  EngineDefinition without = four(-1, -1);
  without.lambda_sensor.in_use = false;
  EXPECT_TRUE(accepted(validate(without))) << "not read";
}

/// Gas of nothing but fuel, or of almost nothing else: the smallest that is shown; half of each is 1 / 14.6.
TYPED_TEST(ExhaustLambda, IsHeldWhereThereIsNextToNoAir) {
  using Real = TypeParam;
  const auto run = turning<Real, LambdaFour>(four(300e-6, 0.5), 0, 0.5);
  const auto& table = *run->storage.tables().lambda;
  const auto lambda = [&table](double fuel_kg) {
    const Real ratio = detail::fuel_by_air_ratio(table, Real{1}, Real{0}, static_cast<Real>(fuel_kg));
    return static_cast<double>(detail::lambda_of(ratio));
  };
  EXPECT_NEAR(lambda(0.5), 1 / 14.6, 1e-7);
  for (const double fuel_kg : {0.999, 1.0, 2.0}) EXPECT_NEAR(lambda(fuel_kg), 0.01, 1e-8) << fuel_kg;
}

/// A quarter of a parcel is there; of what flows in, the pipe takes its own volume, which pushes all else out.
TYPED_TEST(ExhaustLambda, FillsItsPipeNoMoreThanOnceInATick) {
  using Real = TypeParam;
  const auto real = [](double x) { return static_cast<Real>(x); };
  const auto run = turning<Real, LambdaFour>(four(300e-6, 0.5), 0, 0.5);
  for (const double parcels : {32.0, 33.0, 1e6}) {
    auto state = run->engine.state();
    state.oldest_parcel = 5, state.filled_ratio = real(0.25), state.filling_ratio = real(0.25 * 0.5);
    detail::flow_into_pipe(state, real(parcels), real(0.75));
    EXPECT_EQ(state.oldest_parcel, 5u);
    for (std::uint32_t i = 0; i < 32; ++i)
      EXPECT_EQ(state.pipe_ratio[i], real(i == 5 ? 0.25 * 0.5 + 0.75 * 0.75 : 0.75)) << i;
    EXPECT_EQ(state.filled_ratio, real(0.25));
    EXPECT_EQ(state.filling_ratio, real(0.25 * 0.75));
    // A parcel that rounding has left full goes in first.
    state.filled_ratio = Real{1}, state.filling_ratio = real(0.5);
    detail::flow_into_pipe(state, real(parcels), real(0.125));
    EXPECT_EQ(state.oldest_parcel, 6u);
    for (const Real ratio : state.pipe_ratio) EXPECT_EQ(ratio, real(0.125));
    EXPECT_EQ(state.filled_ratio, Real{0});
    EXPECT_EQ(state.filling_ratio, Real{0});
  }
}

TYPED_TEST(ExhaustLambda, IsZeroOfACylinderThatNothingLeft) {
  using Real = TypeParam;
  const auto run = turning<Real, LambdaFour>(support::sealed(four(300e-6, 0.5)), 3000, 0.5);
  ask_lambda(*run, 1.2);
  for (int tick = 0; tick < ticks_of_cycles(3, 3000); ++tick) run->step();
  const auto& out = run->engine.output();
  for (int k = 0; k < 4; ++k) {
    EXPECT_GT(out.gas_cycle[k].peak_Pa, Real{1e6}) << k;  // a whole cycle is shown
    EXPECT_EQ(out.outflow_excess_air_ratio[k], Real{0}) << k;
  }
}

/// A saved state may have more fuel in a volume than gas: what leaves it is fuel alone, and no more of it stays than
/// gas.
TYPED_TEST(ExhaustLambda, HasNoMoreUnburnedFuelThanGas) {
  using Real = TypeParam;
  const auto run = turning<Real, LambdaFour>(support::sealed(four(300e-6, 0.5)), 0, 0.5);
  auto state = run->engine.state();
  auto& gas = state.manifold[kExhaust].contents;
  gas.mass_kg *= 2, gas.energy_J *= 2, gas.burned_kg *= 2;  // so that it flows out
  state.manifold[kExhaust].point.pressure_Pa *= 2;
  state.manifold_unburned_kg[kExhaust] = 3 * gas.mass_kg, state.unburned_kg[1] = Real{1};
  state.any_unburned = 1;
  ASSERT_TRUE(accepted(run->engine.restore(state)));
  const auto& out = run->step();
  EXPECT_EQ(out.faults, 0u);
  EXPECT_GT(out.outlet_kg_s, Real{0});
  const auto& now = run->engine.state();
  EXPECT_EQ(now.outlet_unburned_ratio, Real{1});
  EXPECT_EQ(now.manifold_unburned_kg[kExhaust], now.manifold[kExhaust].contents.mass_kg);
  EXPECT_EQ(now.unburned_kg[1], now.cylinder_gas.mass_kg[1]);
  EXPECT_NEAR(static_cast<double>(out.exhaust_excess_air_ratio), 0.01, 1e-8);
}

/// A scene may have room for runners and crevices that the engine has not.
TYPED_TEST(ExhaustLambda, IsTheSameInASceneThatHasRoomForMore) {
  using Real = TypeParam;
  const auto run = turning<Real, LambdaFour>(four(500e-6, 0.05), 3000, 0.5);
  const auto other = turning<Real, WholeLambdaFour>(four(500e-6, 0.05), 3000, 0.5);
  ask_lambda(*run, 0.8), ask_lambda(*other, 0.8);
  for (int tick = 0; tick < ticks_of_cycles(12, 3000); ++tick) {
    const auto& a = run->step();
    const auto& b = other->step();
    ASSERT_EQ(a.exhaust_excess_air_ratio, b.exhaust_excess_air_ratio) << tick;
    ASSERT_EQ(a.sensor_excess_air_ratio, b.sensor_excess_air_ratio) << tick;
    for (int k = 0; k < 4; ++k) ASSERT_EQ(a.outflow_excess_air_ratio[k], b.outflow_excess_air_ratio[k]) << tick;
  }
  EXPECT_LT(run->engine.output().exhaust_excess_air_ratio, static_cast<Real>(0.9));
}

/// What was in the gas, and what came and went: in a definition without a sensor nothing at all.
TYPED_TEST(ExhaustLambda, IsZeroWithoutASensor) {
  using Real = TypeParam;
  const auto run = turning<Real, LambdaFour>(support::four_2000(), 3000, 0.4);
  ask_lambda(*run, 0.8);
  for (int tick = 0; tick < 4000; ++tick) run->step();
  const auto& out = run->engine.output();
  EXPECT_EQ(out.exhaust_excess_air_ratio, Real{0});
  EXPECT_EQ(out.sensor_excess_air_ratio, Real{0});
  EXPECT_EQ(out.outflow_excess_air_ratio[0], Real{0});
  EXPECT_EQ(run->engine.state().any_unburned, 0u);
}

}  // namespace
}  // namespace crankloop::exhaust_lambda_test
