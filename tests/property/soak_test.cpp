// A long drive: four cylinders, eight elastic valves, up and down through the speeds over and over; and an engine with
// gas exchange on a dynamometer, fired and motored in turn. Nothing drifts, nothing grows, nothing fades into denormal
// numbers.
//
// 10^7 ticks of the four cylinders, a quarter in each test of each scalar, and 2 * 10^6 with gas;
// CRANKLOOP_LONG_TESTS=1 in the environment: 10^9, and 2 * 10^8.
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <crankloop/scenes.hpp>

#include "support/both_reals.hpp"
#include "support/engine_files.hpp"
#include "support/gas_engine.hpp"
#include "support/kept_engines.hpp"

namespace crankloop::soak_test {
namespace {

using namespace tick_test;

long long ticks_to_soak() { return std::getenv("CRANKLOOP_LONG_TESTS") != nullptr ? 250'000'000LL : 2'500'000LL; }

template <class Real>
class Soak : public ::testing::Test {};
TYPED_TEST_SUITE(Soak, BothReals, RealName);

/// FNV-1a over words: two of them in a row are equal by chance once in 2^64.
class Hash {
 public:
  template <class T>
  void add(T x) {
    std::uint64_t word = 0;
    std::memcpy(&word, &x, sizeof x);
    value_ = (value_ ^ word) * 0x100000001B3u;
    value_ ^= value_ >> 29;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325u;
};

template <class Real>
bool subnormal(Real x) {
  return std::fpclassify(x) == FP_SUBNORMAL;
}

template <class Real, class S>
bool any_subnormal(const State<Real, S>& state) {
  bool found = subnormal(state.speed_rad_s) || subnormal(state.torque_Nm);
  for (const Real x : state.valve_lift_m) found = found || subnormal(x);
  for (const Real x : state.valve_velocity_m_s) found = found || subnormal(x);
  return found;
}

/// Ticks of each engine cycle of a drive from 1000 rpm to 12 000 and back, at 50 us.
std::vector<std::uint32_t> drive_up_and_down() {
  std::vector<std::uint32_t> ticks;
  for (double rpm = 1000; rpm < 12'000; rpm *= 1.17) ticks.push_back(static_cast<std::uint32_t>(120 / rpm / 50e-6));
  for (std::size_t i = ticks.size(); i-- > 0;) ticks.push_back(ticks[i]);
  return ticks;
}

TYPED_TEST(Soak, OnAMeasuredCrankGivesTheSameBitsInEveryDriveUpAndDown) {
  // Each cycle has a whole number of ticks, so that every drive sees the same angles: what differs between two drives
  // is drift. The first begins from rest and does not count.
  using Real = TypeParam;
  using S = MeasuredFourWithValves;
  const auto engine = started_four<Real, S>();
  const std::vector<std::uint32_t> cycles = drive_up_and_down();
  typename Engine<Real, S>::Input in;
  std::uint64_t of_second_drive = 0;
  long long ticks = 0;
  int drives = 0;
  int bounces = 0;
  for (const long long until = ticks_to_soak(); ticks < until; ++drives) {
    Hash hash;
    for (const std::uint32_t in_cycle : cycles) {
      for (std::uint32_t i = 0; i < in_cycle; ++i, ++ticks) {
        // To the last bit back at 0 at the end of the cycle.
        in.crank = Phase{i + 1 == in_cycle ? 0 : (i + 1) * (~std::uint64_t{0} / in_cycle)};
        for (std::uint32_t k = 0; k < 4; ++k) in.pressure_Pa[k] = static_cast<Real>(1e5 + 1e3 * ((i + 100 * k) % 500));
        const auto& out = engine->step(in);
        ASSERT_EQ(out.faults & ~std::uint32_t{kFaultEventBudget}, 0u) << "tick " << ticks;
        ASSERT_EQ(engine->state().phase.units(), in.crank.units());
        hash.add(out.mean_torque_Nm);
        for (const auto& train : out.valve) {
          for (const auto& valve : train) hash.add(valve.lift_m), hash.add(valve.velocity_m_s);
        }
        ASSERT_FALSE(any_subnormal(engine->state())) << "tick " << ticks;
      }
      for (const auto& train : engine->output().valve_cycle) {
        for (const auto& cycle : train)
          hash.add(cycle.largest_lift_m), hash.add(cycle.contact_changes), bounces += cycle.bounces > 0 ? 1 : 0;
      }
    }
    if (drives == 1) of_second_drive = hash.value();
    if (drives > 1) {
      ASSERT_EQ(hash.value(), of_second_drive) << "drive " << drives;
    }
  }
  std::printf("[ figures  ] %lld ticks, %d drives of %zu cycles, the same bits in each but the first\n", ticks, drives,
              cycles.size());
  EXPECT_GT(drives, 3);
  EXPECT_GT(bounces, 0) << "or nothing happened";
  EXPECT_EQ(engine->state().ticks, static_cast<std::uint64_t>(ticks));
}

TYPED_TEST(Soak, AtGivenSpeedsTurnsToTheLastUnitAsIntegersDo) {
  // At a constant speed every tick adds the same integer: after n ticks the phase is n times it, modulo 2^64. Up, down,
  // through standstill and backwards; the angle never leaves that, nor do the valves theirs.
  using Real = TypeParam;
  using S = FourWithValves;
  const auto engine = started_four<Real, S>();
  const long long ticks = ticks_to_soak();
  constexpr long long kTicksPerSpeed = 997;  // prime, so that speeds begin at ever other angles
  typename Engine<Real, S>::Input in;
  double largest_m = 0;
  for (long long done = 0, speeds = 0; done < ticks; done += kTicksPerSpeed, ++speeds) {
    in.speed_rad_s = static_cast<Real>(1000 * std::sin(0.37 * static_cast<double>(speeds)));
    if (speeds % 11 == 0) in.speed_rad_s = Real{0};  // it stalls, wherever its valves are
    const std::uint64_t begin = engine->state().phase.units();
    engine->step(in);
    const std::uint64_t per_tick = engine->state().phase.units() - begin;
    for (long long i = 1; i < kTicksPerSpeed; ++i) {
      const auto& out = engine->step(in);
      for (const auto& train : out.valve) {
        for (const auto& valve : train) largest_m = std::max(largest_m, std::fabs(static_cast<double>(valve.lift_m)));
      }
      ASSERT_FALSE(any_subnormal(engine->state())) << "tick " << done + i;
    }
    ASSERT_EQ(engine->output().faults & ~std::uint32_t{kFaultEventBudget}, 0u);
    ASSERT_EQ(engine->state().phase.units(), begin + static_cast<std::uint64_t>(kTicksPerSpeed) * per_tick)
        << "from tick " << done;
  }
  std::printf("[ figures  ] %lld ticks at changing speeds: largest lift %.4f mm\n", ticks, largest_m * 1e3);
  EXPECT_GT(largest_m, 7e-3);
  EXPECT_LT(largest_m, 15.6e-3) << "twice the cam's 7.8 mm: what a jump of the speed through some thousand rpm throws";
}

/// Whether the crank, a valve, gas or what it carries has faded.
template <class Real, class S>
bool any_gas_subnormal(const State<Real, S>& state, std::uint32_t cylinders) {
  bool found = any_subnormal(state);
  const auto& gas = state.cylinder_gas;
  for (std::uint32_t k = 0; k < cylinders; ++k) {
    for (const Real x : {gas.mass_kg[k], gas.mass_rest_kg[k], gas.energy_J[k], gas.energy_rest_J[k], gas.burned_kg[k],
                         gas.burned_rest_kg[k], gas.burned_ratio[k], state.crevice_gas.mass_kg[k],
                         state.crevice_gas.burned_kg[k], state.unburned_kg[k],
                         state.runner[kIntake][k].contents.burned_kg, state.runner[kExhaust][k].contents.burned_kg,
                         state.runner_unburned_kg[kIntake][k], state.runner_unburned_kg[kExhaust][k]}) {
      found = found || subnormal(x);
    }
  }
  for (const detail::ManifoldGas<Real>& manifold : state.manifold)
    found = found || subnormal(manifold.contents.burned_kg) || subnormal(manifold.contents.mass_kg);
  for (const Real x : state.manifold_unburned_kg) found = found || subnormal(x);
  for (const Real x : state.pipe_ratio) found = found || subnormal(x);
  return found;
}

TYPED_TEST(Soak, OfAFreeCrankWithGasExchangeHasTheSameTorqueInEveryDrive) {
  // Turned by its forces against a dynamometer that holds some 3000 rpm: two seconds rich at a throttle that opens and
  // closes, then three seconds without fuel, some 75 cycles in which burned gas and fuel fade to nothing. Once the
  // walls are warm, drives differ by the angle at which they begin: by 0.4 % of the torque.
  using Real = TypeParam;
  using S = scenes::BreathingFree;
  const EngineDefinition definition =
      program::read_engine_file(CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000_everything.ini", {}).definition();
  constexpr double kTick_s = 100e-6;
  constexpr int kFiredTicks = 20'000, kTicks = 50'000, kWarmDrives = 15;
  constexpr double kApart_Nm = 0.6;
  const auto run = std::make_unique<support::Breathing<Real, S>>(definition, kTick_s);
  struct MeanTorque {
    double fired_Nm = 0, motored_Nm = 0;
  } warm;
  double apart_Nm = 0;
  int drives = 0;
  for (const long long until = ticks_to_soak() * 2 / 5; drives * static_cast<long long>(kTicks) < until; ++drives) {
    MeanTorque drive;
    for (int i = 0; i < kTicks; ++i) {
      const bool fires = i < kFiredTicks;
      run->in.throttle_ratio = static_cast<Real>(fires ? 0.1 + 0.9 * std::fabs(std::sin(1e-3 * i)) : 0.05);
      for (Real& fuel : run->in.fuel_kg) fuel = fires ? static_cast<Real>(30e-6) : Real{0};
      const double above_rad_s = static_cast<double>(run->engine.state().speed_rad_s) - support::rad_s(3000);
      run->in.external_torque_Nm = static_cast<Real>(5 * above_rad_s);
      const auto& out = run->step();
      ASSERT_EQ(out.faults, 0u) << "drive " << drives << ", tick " << i;
      if (fires) {
        drive.fired_Nm += static_cast<double>(out.mean_torque_Nm) / kFiredTicks;
      } else {
        drive.motored_Nm += static_cast<double>(out.mean_torque_Nm) / (kTicks - kFiredTicks);
      }
      ASSERT_FALSE(any_gas_subnormal(run->engine.state(), 4)) << "drive " << drives << ", tick " << i;
    }
    if (drives == kWarmDrives) warm = drive;
    if (drives > kWarmDrives) {
      apart_Nm = std::fmax(apart_Nm, std::fabs(drive.fired_Nm - warm.fired_Nm));
      apart_Nm = std::fmax(apart_Nm, std::fabs(drive.motored_Nm - warm.motored_Nm));
      ASSERT_LT(apart_Nm, kApart_Nm) << "drive " << drives;
    }
  }
  std::printf(
      "[ figures  ] %lld ticks with gas exchange on a free crank: fired %.1f Nm, motored %.1f Nm, %d drives at most "
      "%.2f Nm apart\n",
      static_cast<long long>(drives) * kTicks, warm.fired_Nm, warm.motored_Nm, drives - kWarmDrives, apart_Nm);
  EXPECT_GT(drives, kWarmDrives + 1);
  EXPECT_GT(warm.fired_Nm, 100);
  EXPECT_LT(warm.motored_Nm, -10);
}

}  // namespace
}  // namespace crankloop::soak_test
