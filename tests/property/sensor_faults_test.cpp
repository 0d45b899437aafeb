// Faults of a controller's sensors: each against what it says, tick by tick.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <deque>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "support/both_reals.hpp"
#include "support/gas_engine.hpp"
#include "support/status.hpp"

namespace crankloop::sensor_faults_test {
namespace {

using support::Breathing;
using support::BreathingFour;
using support::rad_s;
using tick_test::RealName;

constexpr double kTick_s = 100e-6;
constexpr int kMap = static_cast<int>(ControllerSensor::map);

struct Sensing : BreathingFour {
  static constexpr bool controller_names = true;
  static constexpr bool sensor_faults = true;
  static constexpr bool walls = true;
  static constexpr std::uint32_t lambda_parcels = 8;
};

[[nodiscard]] SensorFault of_map(double start_s, double end_s) {
  SensorFault fault;
  fault.start_s = start_s, fault.end_s = end_s;
  return fault;
}
[[nodiscard]] EngineDefinition with(std::initializer_list<SensorFault> faults) {
  EngineDefinition engine = support::four_2000();
  engine.lambda_sensor.in_use = true;
  engine.gas.walls.capacity_J_K = 600;
  for (const SensorFault& fault : faults) engine.sensor_faults[engine.sensor_fault_count++] = fault;
  return engine;
}
template <class Real>
[[nodiscard]] std::unique_ptr<Breathing<Real, Sensing>> turning(const EngineDefinition& engine) {
  auto run = std::make_unique<Breathing<Real, Sensing>>(engine, kTick_s);
  run->in.speed_rad_s = static_cast<Real>(rad_s(1500));
  run->in.throttle_ratio = static_cast<Real>(0.05);
  return run;
}
/// The healthy value, and what a controller reads, of each tick.
struct Trace {
  std::vector<double> healthy, read;
};
template <class Real>
[[nodiscard]] Trace trace_of_map(const EngineDefinition& engine, int ticks, int bit_from = -1) {
  const auto run = turning<Real>(engine);
  Trace trace;
  for (int tick = 0; tick < ticks; ++tick) {
    run->in.sensor_faults = bit_from >= 0 && tick >= bit_from ? 4 : 0;
    const auto& out = run->step();
    EXPECT_EQ(out.faults, 0u);
    trace.healthy.push_back(static_cast<double>(out.manifold[kIntake].pressure_Pa));
    trace.read.push_back(static_cast<double>(out.faulty_sensor[kMap]));
  }
  return trace;
}

template <class Real>
class SensorFaults : public ::testing::Test {};
TYPED_TEST_SUITE(SensorFaults, tick_test::BothReals, RealName);

TYPED_TEST(SensorFaults, AreNoneWhereNoneIsOn) {
  using Real = TypeParam;
  const auto run = turning<Real>(with({of_map(10, 11)}));
  for (int tick = 0; tick < 2000; ++tick) {
    const auto& out = run->step();
    const Real healthy[] = {out.manifold[kIntake].pressure_Pa, out.manifold[kIntake].temperature_K,
                            run->engine.state().throttle_ratio, out.sensor_excess_air_ratio, out.coolant_K};
    ASSERT_EQ(std::memcmp(healthy, out.faulty_sensor, sizeof healthy), 0) << tick;
    ASSERT_EQ(out.sensor_faults_on, 0u);
  }
  EXPECT_GT(run->engine.output().faulty_sensor[4], Real{300});
}

TYPED_TEST(SensorFaults, WiresHoldOrReadTheEndsOfTheRange) {
  SensorFault stuck = of_map(0.02, 0.04), open = of_map(0.05, 0.06), shorted = of_map(0.07, 0.08);
  stuck.wire = SensorWire::stuck, open.wire = SensorWire::open, shorted.wire = SensorWire::shorted;
  for (SensorFault* fault : {&open, &shorted}) fault->least = 10e3, fault->most = 120e3;
  const Trace trace = trace_of_map<TypeParam>(with({stuck, open, shorted}), 900);
  for (std::size_t tick = 0; tick < 900; ++tick) {
    double expected = trace.healthy[tick];
    if (tick >= 200 && tick < 400) expected = trace.healthy[200];
    if (tick >= 500 && tick < 600) expected = 120e3;
    if (tick >= 700 && tick < 800) expected = 10e3;
    ASSERT_EQ(trace.read[tick], static_cast<double>(static_cast<TypeParam>(expected))) << tick;
  }
  EXPECT_GT(std::fabs(trace.healthy[399] - trace.healthy[200]), 100);
}

TYPED_TEST(SensorFaults, DelayLagAndOffsetAreThoseOfAQueueAndAnEquation) {
  SensorFault late = of_map(0, 1), slow = of_map(0, 1);
  late.delay_s = 2.5e-3, late.offset = -500;
  slow.lag_s = 8e-3;
  const Trace by_delay = trace_of_map<TypeParam>(with({late}), 2000);
  const Trace by_lag = trace_of_map<TypeParam>(with({slow}), 2000);
  double lagged = by_lag.healthy[0];
  for (std::size_t tick = 0; tick < 2000; ++tick) {
    const double behind = by_delay.healthy[tick < 25 ? 0 : tick - 25];
    ASSERT_NEAR(by_delay.read[tick], behind - 500, 1e-6 * behind) << tick;
    for (int part = 0; part < 1000; ++part) lagged += (by_lag.healthy[tick] - lagged) * kTick_s / 1000 / 8e-3;
    ASSERT_NEAR(by_lag.read[tick], lagged, 2e-5 * lagged) << tick;
  }
}

TYPED_TEST(SensorFaults, ALongDelayIsRightWithinA32ndOfIt) {
  SensorFault late = of_map(0, 1);
  late.delay_s = 50e-3;  // 500 ticks: samples of 16
  const Trace trace = trace_of_map<TypeParam>(with({late}), 2000);
  for (std::size_t tick = 600; tick < 2000; ++tick) {
    bool found = false;
    for (std::size_t behind = 484; behind <= 516; ++behind)
      found = found || trace.read[tick] == trace.healthy[tick - behind];
    ASSERT_TRUE(found) << tick;
  }
}

TYPED_TEST(SensorFaults, NoiseIsEvenAndRepeats) {
  SensorFault noisy = of_map(0, 10);
  noisy.noise = 2000, noisy.noise_seed = 7;
  const Trace trace = trace_of_map<TypeParam>(with({noisy}), 20000),
              again = trace_of_map<TypeParam>(with({noisy}), 100);
  double sum = 0, square = 0, most = 0;
  for (std::size_t tick = 0; tick < trace.read.size(); ++tick) {
    const double x = trace.read[tick] - trace.healthy[tick];
    sum += x, square += x * x, most = std::fmax(most, std::fabs(x));
    if (tick < 100) {
      ASSERT_EQ(trace.read[tick], again.read[tick]);
    }
  }
  const double n = static_cast<double>(trace.read.size()), sigma = 2000 / std::sqrt(3.0);
  EXPECT_NEAR(sum / n, 0, 4 * sigma / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(square / n), sigma, 0.02 * sigma);
  EXPECT_LE(most, 2000.1);
  EXPECT_GT(most, 1990);
}

TYPED_TEST(SensorFaults, AConverterCountsStepsOfItsRangeAndAnInputBitSwitches) {
  SensorFault converter;
  converter.input_bit = 2;
  converter.least = 20e3, converter.most = 60e3, converter.step = 40e3 / 255;
  const Trace trace = trace_of_map<TypeParam>(with({converter}), 3000, 1000);
  int held = 0;
  for (std::size_t tick = 0; tick < 3000; ++tick) {
    if (tick < 1000) {
      ASSERT_EQ(trace.read[tick], trace.healthy[tick]);
      continue;
    }
    const double within = std::fmin(60e3, std::fmax(20e3, trace.healthy[tick]));
    ASSERT_NEAR(trace.read[tick], within, 0.501 * converter.step) << tick;
    const double steps = (trace.read[tick] - 20e3) / converter.step;
    ASSERT_NEAR(steps, std::round(steps), 1e-3);
    held += trace.healthy[tick] > 60e3 ? 1 : 0;
  }
  EXPECT_LT(held, 2000);
}

TYPED_TEST(SensorFaults, OfOneSensorTheFirstThatIsOnCountsAndEachSensorHasItsOwn) {
  using Real = TypeParam;
  SensorFault first = of_map(0.01, 1), second = of_map(0, 1), other = of_map(0, 1);
  first.offset = 1000, second.offset = -1000;
  other.sensor = ControllerSensor::lambda, other.offset = 0.25;
  const auto run = turning<Real>(with({first, second, other}));
  for (int tick = 0; tick < 300; ++tick) {
    const auto& out = run->step();
    ASSERT_EQ(out.sensor_faults_on, tick < 100 ? 6u : 7u);
    const Real off = tick < 100 ? Real{-1000} : Real{1000};
    ASSERT_EQ(out.faulty_sensor[kMap], out.manifold[kIntake].pressure_Pa + off);
    ASSERT_EQ(out.faulty_sensor[3], out.sensor_excess_air_ratio + static_cast<Real>(0.25));
  }
}

TYPED_TEST(SensorFaults, ARestoredRunGoesOnTheSame) {
  using Real = TypeParam;
  SensorFault all = of_map(0, 1);
  all.delay_s = 10e-3, all.lag_s = 5e-3, all.noise = 300, all.offset = 100;
  const EngineDefinition engine = with({all});
  const auto run = turning<Real>(engine), other = turning<Real>(engine);
  for (int tick = 0; tick < 777; ++tick) run->step();
  ASSERT_TRUE(accepted(other->engine.restore(run->engine.state())));
  for (int tick = 0; tick < 500; ++tick) {
    const auto &one = run->step(), &two = other->step();
    ASSERT_EQ(std::memcmp(one.faulty_sensor, two.faulty_sensor, sizeof one.faulty_sensor), 0) << tick;
  }
}

/// docs/contract.md "What init refuses": by restore, places in rings that are none.
TYPED_TEST(SensorFaults, APlaceOutsideItsRingIsRefusedByRestoreAndTheRunGoesOn) {
  using Real = TypeParam;
  const auto run = turning<Real>(with({of_map(0, 1)}));
  for (int tick = 0; tick < 100; ++tick) run->step();
  const auto sound = run->engine.state();
  auto forged = sound;
  forged.oldest_parcel = Sensing::lambda_parcels;
  EXPECT_TRUE(support::refuses(run->engine.restore(forged), Reason::out_of_range, "state.lambda"));
  forged = sound;
  forged.sensor[kMap].oldest = detail::kDelayedSamples;
  EXPECT_TRUE(support::refuses(run->engine.restore(forged), Reason::out_of_range, "state.sensor"));
  EXPECT_EQ(std::memcmp(&run->engine.state(), &sound, sizeof sound), 0);
}

TEST(SensorFault, IsRefusedWhereItIsNeverOnOrHasNoRangeToReadFrom) {
  const auto refused = [](const SensorFault& fault, const char* field) {
    const Status status = validate(fault);
    EXPECT_FALSE(status.ok()) << field;
    EXPECT_STREQ(status.field, field);
  };
  SensorFault fault;
  refused(fault, "sensor_fault.end_s");
  fault.end_s = 1;
  EXPECT_TRUE(validate(fault).ok());
  fault.wire = SensorWire::open;
  refused(fault, "sensor_fault.most");
  fault.most = 5;
  EXPECT_TRUE(validate(fault).ok());
  fault.step = 5 / 65537.0;
  refused(fault, "sensor_fault.step");
  fault.step = 5 / 65536.0;
  EXPECT_TRUE(validate(fault).ok());
  fault.delay_s = 11;
  refused(fault, "sensor_fault.delay_s");
}

TEST(SensorFault, IsRefusedWhereNoSensorAndNoWireHasItsNumber) {
  SensorFault fault;
  fault.end_s = 1;
  for (int sensor = 0; sensor < kControllerSensors; ++sensor) {
    fault.sensor = static_cast<ControllerSensor>(sensor);
    EXPECT_TRUE(accepted(validate(fault))) << sensor;
  }
  for (const int none : {kControllerSensors, 255}) {
    fault.sensor = static_cast<ControllerSensor>(none);
    EXPECT_TRUE(support::refuses(validate(fault), Reason::out_of_range, "sensor_fault.sensor")) << none;
  }
  fault.sensor = ControllerSensor::coolant;
  for (const int none : {static_cast<int>(SensorWire::shorted) + 1, 255}) {
    fault.wire = static_cast<SensorWire>(none);
    EXPECT_TRUE(support::refuses(validate(fault), Reason::out_of_range, "sensor_fault.wire")) << none;
  }
}

}  // namespace
}  // namespace crankloop::sensor_faults_test
