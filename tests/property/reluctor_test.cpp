// The variable reluctance sensor and its comparator: against the formula worked out another way, and facts that hold
// whatever the shape of a lobe.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/state/saved_state.hpp>
#include <crankloop/tick/step.hpp>

#include "support/both_reals.hpp"
#include "support/engines.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"

namespace crankloop::reluctor_test {
namespace {

using tick_test::RealName;

constexpr double kPi = 3.14159265358979323846;
constexpr int kPlaces = 60;

struct Turned : Scene {
  static constexpr Count cylinders = exactly<4>;
  static constexpr Count triggers = exactly<1>;
  static constexpr std::uint32_t reluctor_samples = 16;
  static constexpr std::uint32_t trigger_edges = 16;
};
template <std::uint32_t N>
struct Free : Scene {
  static constexpr Count cylinders = exactly<4>;
  static constexpr CrankGiven crank = CrankGiven::torque;
  static constexpr PressureGiven pressure = PressureGiven::by_table;
  static constexpr bool load_ratio = true;
  static constexpr bool starter = true;
  static constexpr Count triggers = exactly<1>;
  static constexpr std::uint32_t trigger_edges = 16;
  static constexpr std::uint32_t reluctor_samples = N;
};
struct Measured : Turned {
  static constexpr CrankGiven crank = CrankGiven::phase;
};
struct OneEdge : Turned {
  static constexpr std::uint32_t trigger_edges = 1;
};
struct Plain : Free<8> {
  static constexpr std::uint32_t reluctor_samples = 0;
};

/// The 495 with 60-2 and a sensor of 10 mV s at it: 2 V at 2000 rpm.
[[nodiscard]] EngineDefinition sensed() {
  EngineDefinition engine = support::diesel_495();
  engine.trigger_count = 1;
  TriggerWheel& wheel = engine.triggers[0];
  wheel = {};
  wheel.places = kPlaces, wheel.gap_count = 1, wheel.gaps[0] = {58, 2};
  wheel.first_tooth_deg = 246;
  engine.reluctor.wheel = 0;
  engine.reluctor.gain_V_s = 0.01;
  return engine;
}

template <class Real, class S>
struct Rig {
  TableStorage<Real, S> storage;
  Engine<Real, S> engine;
  Input<Real, S> in;

  Rig(const EngineDefinition& definition, double tick_s) {
    EXPECT_TRUE(accepted(storage.build(definition, {tick_s})));
    EXPECT_TRUE(accepted(engine.init(storage.tables())));
  }
  [[nodiscard]] const detail::ReluctorTable<Real>& table() const { return *storage.tables().reluctor; }
  [[nodiscard]] double volts(double turns, double speed_rad_s = 1) const {
    const double from_centre = turns - 0.25 / kPlaces, whole = from_centre - std::floor(from_centre);
    const auto angle = static_cast<std::uint64_t>(whole * 4294967296.0) << 32;
    return static_cast<double>(detail::reluctor_V(table(), angle, static_cast<Real>(speed_rad_s)));
  }
};

/// Centre of tooth n, from 0, in turns of the wheel from its first rising edge.
[[nodiscard]] double centre(int tooth) { return (tooth + 0.25) / kPlaces; }

/// The flux by the definition's words alone: lobes of height 1 at the teeth's edges, integrated by trapezoids, and the
/// wheel's distance swung over a turn.
class FluxByHand {
 public:
  FluxByHand(const Reluctor& sensor, int before_gap)
      : sensor_{sensor}, before_gap_{before_gap}, flux_(kSteps + 1, 0.0) {
    for (int i = 0; i < kSteps; ++i)
      flux_[static_cast<std::size_t>(i) + 1] =
          flux_[static_cast<std::size_t>(i)] +
          (slope(at(i)) + 4 * slope(at(i) + 0.5 / kSteps) + slope(at(i + 1))) / 6 / kSteps;
    const double least = *std::min_element(flux_.begin(), flux_.end());
    for (double& flux : flux_) flux -= least;  // counted from that in the gap
  }
  /// d/da ((1 + r cos(a - a0)) flux) of the wheel's angle in turns, by central differences.
  [[nodiscard]] double derivative(int i) const {
    const auto swung = [this](int k) {
      const int step = (k + kSteps) % kSteps;
      return (1 + sensor_.runout_ratio * std::cos(2 * kPi * (at(step) - sensor_.runout_at_deg / 360))) *
             flux_[static_cast<std::size_t>(step)];
    };
    return (swung(i + 1) - swung(i - 1)) * kSteps / 2;
  }
  [[nodiscard]] static double at(int i) { return static_cast<double>(i) / kSteps; }
  static constexpr int kSteps = 240'000;

 private:
  [[nodiscard]] double slope(double turns) const {
    double sum = 0;
    for (int tooth = 0; tooth < kPlaces; ++tooth) {
      if (tooth == before_gap_ || tooth == before_gap_ + 1) continue;
      double x = (turns - centre(tooth)) * kPlaces;
      if (x > kPlaces / 2.0) x -= kPlaces;
      if (x < -kPlaces / 2.0) x += kPlaces;
      const bool beside_gap =
          ((tooth - before_gap_ - 2) % kPlaces == 0 && x < 0) || (tooth == before_gap_ - 1 && x > 0);
      const double height = (x < 0 ? 1 : -1) * (beside_gap ? sensor_.gap_lobe_ratio : 1.0);
      const double edge = 0.25, end = sensor_.reach_ratio / 2, far = std::fabs(x);
      if (far < edge) {
        sum += height * (1 - (1 - far / edge) * (1 - far / edge));
      } else if (far < end) {
        const double t = (end - far) / (end - edge);
        sum += height * t * t * (3 - 2 * t);
      }
    }
    return sum;
  }

  Reluctor sensor_;
  int before_gap_;  ///< teeth before the two that are missing
  std::vector<double> flux_;
};

template <class Real>
class ReluctorOf : public ::testing::Test {};
TYPED_TEST_SUITE(ReluctorOf, tick_test::BothReals, RealName);

TYPED_TEST(ReluctorOf, VoltageIsTheDerivativeOfTheFluxUnderRunOut) {
  const struct {
    double runout_ratio;
    int before_gap;  ///< teeth
  } wheels[] = {{0, 58}, {0.15, 58}, {0, 20}, {0.15, 20}, {0.15, 2}};
  for (const auto& wheel : wheels) {
    EngineDefinition engine = sensed();
    engine.triggers[0].gaps[0].teeth = wheel.before_gap;
    engine.reluctor.gain_V_s = 1;
    engine.reluctor.runout_ratio = wheel.runout_ratio, engine.reluctor.runout_at_deg = 70;
    const Rig<TypeParam, Turned> rig(engine, 100e-6);
    const FluxByHand by_hand(engine.reluctor, wheel.before_gap);
    double largest = 0, worst = 0;
    for (int i = 1; i < FluxByHand::kSteps; i += 7) {
      const double expected = by_hand.derivative(i);
      largest = std::fmax(largest, std::fabs(expected));
      worst = std::fmax(worst, std::fabs(rig.volts(FluxByHand::at(i)) - expected));
    }
    EXPECT_NEAR(largest, 1.4, 1.4 * wheel.runout_ratio + 1e-3) << wheel.before_gap;
    // A cell is a seventeenth of a lobe's half, differences a 4000th of a pitch.
    EXPECT_LT(worst, 1.5e-3) << wheel.before_gap << ", " << wheel.runout_ratio;
  }
}

TYPED_TEST(ReluctorOf, CrossesZeroAtTheCentreOfEachToothWithinTwoInTenMillionTurns) {
  const Rig<TypeParam, Turned> rig(sensed(), 100e-6);
  for (int tooth = 0; tooth < 58; ++tooth) {
    double low = centre(tooth) - 1e-3, high = centre(tooth) + 1e-3;
    ASSERT_GT(rig.volts(low), 0);
    ASSERT_LT(rig.volts(high), 0);
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (rig.volts(middle) > 0 ? low : high) = middle;
    }
    ASSERT_NEAR(low, centre(tooth), 2e-7) << tooth;
  }
}

/// Every tooth has two neighbours, so that all have the same lobes.
TYPED_TEST(ReluctorOf, AWheelWithoutAGapHasTheSameVoltageAtEachOfItsTeeth) {
  EngineDefinition engine = sensed();
  engine.triggers[0].gap_count = 0;
  engine.reluctor.gain_V_s = 1;
  const Rig<TypeParam, Turned> rig(engine, 100e-6);
  const Rig<TypeParam, Turned> with_gap(sensed(), 100e-6);
  constexpr double kRounding_V = sizeof(TypeParam) == 4 ? 1e-5 : 1e-7;  // of the angle, to 2^-32 of a turn, too
  for (double of_place = -0.25; of_place < 0.75; of_place += 0.01) {
    // Far from a gap a tooth has the lobes that it has on a wheel with one.
    const double expected_V = 100 * with_gap.volts((20 + of_place) / kPlaces);
    for (int place = 0; place < kPlaces; ++place)
      ASSERT_NEAR(rig.volts((place + of_place) / kPlaces), expected_V, 100 * kRounding_V) << place << ", " << of_place;
  }
  EXPECT_NEAR(rig.volts(0), 1, 1e-3) << "the first tooth's edge: no gap makes it higher";
}

TYPED_TEST(ReluctorOf, TeethBehindTheLastGapAreThere) {
  EngineDefinition engine = sensed();
  engine.triggers[0].gaps[0] = {20, 2};  // and 38 teeth behind it
  engine.reluctor.gain_V_s = 1;
  const Rig<TypeParam, Turned> rig(engine, 100e-6);
  for (int place = 0; place < kPlaces; ++place) {
    const double before_V = rig.volts((place + 0.0) / kPlaces), behind_V = rig.volts((place + 0.5) / kPlaces);
    const bool missing = place == 20 || place == 21;
    EXPECT_NEAR(before_V, missing ? 0 : place == 22 ? 1.4 : 1, 2e-3) << place;
    EXPECT_NEAR(behind_V, missing ? 0 : place == 19 ? -1.4 : -1, 2e-3) << place;
  }
}

/// A camshaft turns at half the speed.
TYPED_TEST(ReluctorOf, OnACamshaftTheSameWheelGivesHalfTheVoltageOverTwiceTheAngle) {
  using Real = TypeParam;
  EngineDefinition on_cam = sensed();
  on_cam.triggers[0].shaft = TriggerShaft::cam;
  const Rig<Real, Turned> crank(sensed(), 100e-6);
  Rig<Real, Turned> cam(on_cam, 100e-6);
  for (double turns = 0; turns < 1; turns += 1e-3) ASSERT_EQ(2 * cam.volts(turns), crank.volts(turns)) << turns;
  // Each rise of the comparator is at the centre of a tooth, by the angle that the crank has turned.
  const double rad_s = 400;
  cam.in.speed_rad_s = static_cast<Real>(rad_s);
  double worst = 0, peak_V = 0;
  int rises = 0;
  for (int tick = 0; tick < 5000; ++tick) {
    const auto& out = cam.engine.step(cam.in);
    ASSERT_EQ(out.faults, 0u);
    for (const Real volts : out.reluctor_V) peak_V = std::fmax(peak_V, static_cast<double>(volts));
    for (std::uint32_t e = 0; e < out.comparator.edge_count; ++e) {
      if (out.comparator.edge[e].level == 0) continue;
      const double crank_deg = (tick * 100e-6 + static_cast<double>(out.comparator.edge[e].time_s)) * rad_s * 180 / kPi;
      const double place = (crank_deg - 246) / 720 * kPlaces - 0.25;
      const double near = std::round(place);
      worst = std::fmax(worst, std::fabs(place - near));
      const int tooth = ((static_cast<int>(near) % kPlaces) + kPlaces) % kPlaces;
      ASSERT_LT(tooth, 58) << "in the gap at " << crank_deg;
      ++rises;
    }
  }
  EXPECT_LT(worst, 2e-3);  // a straight line between two of 16 samples a tick, which are 0.02 places apart
  EXPECT_NEAR(rises, 58 * 0.5 * rad_s / (4 * kPi), 3);
  EXPECT_NEAR(peak_V, 0.01 * 1.4 * rad_s / 2, 0.01) << "beside the gap: gain by the cam's speed by gap_lobe_ratio";
}

TYPED_TEST(ReluctorOf, IntegralOverATurnIsZeroWhateverTheRunOut) {
  for (const double runout : {0.0, 0.05, 0.5}) {
    EngineDefinition engine = sensed();
    engine.reluctor.runout_ratio = runout, engine.reluctor.runout_at_deg = -35;
    const Rig<TypeParam, Turned> rig(engine, 100e-6);
    double sum = 0, magnitudes = 0;
    for (const auto& cell : rig.table().at) {
      const double of_cell =
          static_cast<double>(cell.c[0]) + static_cast<double>(cell.c[1]) / 2 + static_cast<double>(cell.c[2]) / 3;
      sum += of_cell, magnitudes += std::fabs(of_cell);
    }
    EXPECT_LT(std::fabs(sum), (sizeof(TypeParam) == 4 ? 2e-7 : 1e-15) * magnitudes) << runout;
    EXPECT_GT(magnitudes / detail::kReluctorCells, 1e-3);
  }
}

TYPED_TEST(ReluctorOf, VoltageIsProportionalToSpeedToRounding) {
  using Real = TypeParam;
  Rig<Real, Turned> slow(sensed(), 200e-6), fast(sensed(), 100e-6);
  slow.in.speed_rad_s = Real{100}, fast.in.speed_rad_s = Real{200};  // the same angles
  double peak = 0, slow_peak = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const auto &a = slow.engine.step(slow.in), &b = fast.engine.step(fast.in);
    for (std::uint32_t i = 0; i < 16; ++i) {
      ASSERT_NEAR(static_cast<double>(b.reluctor_V[i]), 2 * static_cast<double>(a.reluctor_V[i]),
                  sizeof(Real) == 4 ? 2e-5 : 1e-12)
          << tick;
      slow_peak = std::fmax(slow_peak, static_cast<double>(a.reluctor_V[i]));
      peak = std::fmax(peak, static_cast<double>(b.reluctor_V[i]));
    }
  }
  EXPECT_NEAR(slow_peak, 1.4, 0.01);  // beside the gap: gain times speed times gap_lobe_ratio
  EXPECT_NEAR(peak, 2 * slow_peak, 1e-5);
}

TYPED_TEST(ReluctorOf, FewerSamplesAreSomeOfMoreBitByBitThroughStartsAndReversals) {
  using Real = TypeParam;
  const EngineDefinition engine = sensed();
  const auto by8 = std::make_unique<Rig<Real, Free<8>>>(engine, 100e-6);
  const auto by16 = std::make_unique<Rig<Real, Free<16>>>(engine, 100e-6);
  const auto by32 = std::make_unique<Rig<Real, Free<32>>>(engine, 100e-6);
  const auto plain = std::make_unique<Rig<Real, Plain>>(engine, 100e-6);
  double largest = 0;
  for (int tick = 0; tick < 20'000; ++tick) {
    const auto set = [tick](auto& in) {
      in.starter = tick < 6000 ? 1 : 0;
      in.load_ratio = Real{0};
      in.external_torque_Nm = static_cast<Real>(tick < 9000 ? 0 : 400);  // stops it, and drives it back
    };
    set(by8->in), set(by16->in), set(by32->in), set(plain->in);
    const auto& a = by8->engine.step(by8->in);
    const auto& b = by16->engine.step(by16->in);
    const auto& c = by32->engine.step(by32->in);
    const auto& d = plain->engine.step(plain->in);
    ASSERT_EQ(a.speed_rad_s, d.speed_rad_s);  // who asks for no samples has the same bits
    for (std::uint32_t i = 0; i < 8; ++i) {
      ASSERT_EQ(a.reluctor_V[i], b.reluctor_V[2 * i + 1]) << tick;
      ASSERT_EQ(a.reluctor_V[i], c.reluctor_V[4 * i + 3]) << tick;
      ASSERT_EQ(b.reluctor_V[2 * i], c.reluctor_V[4 * i + 1]) << tick;
      largest = std::fmax(largest, std::fabs(static_cast<double>(a.reluctor_V[i])));
    }
  }
  EXPECT_LT(static_cast<double>(plain->engine.output().speed_rad_s), -10);
  EXPECT_GT(largest, 0.2);
}

TYPED_TEST(ReluctorOf, SamplesOfACrankThatSpeedsUpAreThoseOfUniformAcceleration) {
  using Real = TypeParam;
  constexpr double kTick_s = 500e-6;
  EngineDefinition engine = sensed();
  engine.masses.crank_inertia_kg_m2 = 0.05;
  Rig<Real, Free<8>> rig(engine, kTick_s);
  rig.in.external_torque_Nm = -300;
  double worst = 0, largest_gain_rad_s = 0;
  for (int tick = 0; tick < 200; ++tick) {
    const auto from_rad_s = static_cast<double>(rig.engine.state().speed_rad_s);
    const std::uint64_t from = rig.engine.state().phase.units();
    const auto& out = rig.engine.step(rig.in);
    const double gain_rad_s = static_cast<double>(rig.engine.state().speed_rad_s) - from_rad_s;
    const double turned_rad = static_cast<double>(rig.engine.state().phase.units() - from) * 0x1p-64 * 4 * kPi;
    largest_gain_rad_s = std::fmax(largest_gain_rad_s, gain_rad_s);
    for (std::uint32_t i = 0; i < 8; ++i) {
      // From rest at the tick's start, and beside it what the tick has turned else.
      const double s = (i + 1) / 8.0;
      const double rad = turned_rad * s - gain_rad_s * kTick_s / 2 * (s - s * s);
      const double turns = static_cast<double>(from) * 0x1p-64 * 2 + rad / (2 * kPi) - 246.0 / 360;
      const double expected_V = rig.volts(turns, from_rad_s + gain_rad_s * s);
      worst = std::fmax(worst, std::fabs(static_cast<double>(out.reluctor_V[i]) - expected_V));
    }
  }
  EXPECT_GT(largest_gain_rad_s, 1);
  EXPECT_LT(worst, 2e-4);  // of some volts
}

TYPED_TEST(ReluctorOf, ComparatorRisesOnceAtEachTooth) {
  using Real = TypeParam;
  Rig<Real, Turned> rig(sensed(), 100e-6);
  rig.in.speed_rad_s = static_cast<Real>(200);
  const double turns_per_s = 200 / (2 * kPi), first = 246.0 / 360;
  std::vector<double> rises;
  double worst = 0;
  for (int tick = 0; tick < 5000; ++tick) {
    const auto& out = rig.engine.step(rig.in);
    ASSERT_EQ(out.faults, 0u);
    for (std::uint32_t e = 0; e < out.comparator.edge_count; ++e) {
      if (out.comparator.edge[e].level == 0) continue;
      const double turns = (tick * 100e-6 + static_cast<double>(out.comparator.edge[e].time_s)) * turns_per_s - first;
      rises.push_back(turns);
      const double place = (turns - std::floor(turns)) * kPlaces - 0.25;
      worst = std::fmax(worst, std::fabs(place - std::round(place)) / kPlaces);
    }
  }
  const double turns = 0.5 * turns_per_s;
  EXPECT_NEAR(static_cast<double>(rises.size()), 58 * turns, 3);
  EXPECT_LT(worst, 2e-5);  // a straight line between two of 16 samples a tick: 2e-4 turns apart
  for (std::size_t i = 1; i < rises.size(); ++i) ASSERT_GT(rises[i], rises[i - 1]);
}

TYPED_TEST(ReluctorOf, EdgesOfAComparatorWithADelayComeLaterByItAndNoneIsLost) {
  using Real = TypeParam;
  struct Edge {
    double time_s;
    std::uint32_t level;
  };
  const auto edges_with = [](double delay_s) {
    EngineDefinition engine = sensed();
    engine.reluctor.delay_s = delay_s;
    Rig<Real, Turned> rig(engine, 100e-6);
    rig.in.speed_rad_s = static_cast<Real>(600);
    std::vector<Edge> edges;
    std::uint32_t level = 0;
    for (int tick = 0; tick < 3000; ++tick) {
      const auto& out = rig.engine.step(rig.in);
      EXPECT_EQ(out.faults, 0u);
      for (std::uint32_t e = 0; e < out.comparator.edge_count; ++e) {
        EXPECT_EQ(out.comparator.edge[e].level, level ^= 1u);
        edges.push_back({tick * 100e-6 + static_cast<double>(out.comparator.edge[e].time_s), level});
      }
      EXPECT_EQ(out.comparator.level, level);
    }
    return edges;
  };
  const std::vector<Edge> prompt = edges_with(0);
  ASSERT_GT(prompt.size(), 3000u);
  for (const double delay_s : {15e-6, 63e-6, 100e-6}) {
    const std::vector<Edge> late = edges_with(delay_s);
    ASSERT_LE(prompt.size() - late.size(), 3u) << "those of the last tick";
    for (std::size_t i = 0; i < late.size(); ++i) {
      ASSERT_NEAR(late[i].time_s, prompt[i].time_s + delay_s, 2e-11) << i;
      ASSERT_EQ(late[i].level, prompt[i].level);
    }
  }
}

TYPED_TEST(ReluctorOf, ReversedWiresCrossUpwardAtTheTeethAndTheComparatorSeesSpaces) {
  using Real = TypeParam;
  EngineDefinition engine = sensed();
  engine.reluctor.reversed = true;
  const Rig<Real, Turned> healthy(sensed(), 100e-6);
  Rig<Real, Turned> rig(engine, 100e-6);
  for (double turns = 0; turns < 1; turns += 1e-3) ASSERT_EQ(rig.volts(turns), -healthy.volts(turns));
  rig.in.speed_rad_s = static_cast<Real>(200);
  double least = 1;
  for (int tick = 0; tick < 3000; ++tick) {
    const auto& out = rig.engine.step(rig.in);
    for (std::uint32_t e = 0; e < out.comparator.edge_count; ++e) {
      if (out.comparator.edge[e].level == 0) continue;
      const double turns =
          (tick * 100e-6 + static_cast<double>(out.comparator.edge[e].time_s)) * 200 / (2 * kPi) - 246.0 / 360;
      const double place = (turns - std::floor(turns)) * kPlaces - 0.25;
      least = std::fmin(least, std::fabs(place - std::round(place)));
    }
  }
  EXPECT_GT(least, 0.3);  // places: between the teeth, not at them
}

TYPED_TEST(ReluctorOf, EdgesAreLostBelowTheComparatorsThreshold) {
  using Real = TypeParam;
  const auto edges_at = [](double speed_rad_s) {
    Rig<Real, Turned> rig(sensed(), 100e-6);
    rig.in.speed_rad_s = static_cast<Real>(speed_rad_s);
    std::uint32_t rises = 0;
    const long ticks = std::lround(4 * 2 * kPi / speed_rad_s / 100e-6);
    for (long tick = 0; tick < ticks; ++tick) {
      const auto& out = rig.engine.step(rig.in);
      for (std::uint32_t e = 0; e < out.comparator.edge_count; ++e) rises += out.comparator.edge[e].level;
    }
    return rises;
  };
  EXPECT_EQ(edges_at(3.4), 0u);                              // 0.034 V; 0.0476 V beside the gap
  EXPECT_NEAR(static_cast<double>(edges_at(4.5)), 4, 1);     // the tooth behind the gap alone: 0.063 V
  EXPECT_NEAR(static_cast<double>(edges_at(6)), 4 * 58, 3);  // all
}

TEST(Reluctor, ARestoredRunGoesOnWithTheSameEdges) {
  Rig<float, Turned> first(sensed(), 100e-6), second(sensed(), 100e-6);
  first.in.speed_rad_s = second.in.speed_rad_s = 150;
  for (int tick = 0; tick < 777 || first.engine.output().comparator.level == 0; ++tick) first.engine.step(first.in);
  std::vector<unsigned char> bytes(kSavedStateBytes<float, Turned>);
  ASSERT_TRUE(save_state(first.engine, bytes.data(), bytes.size()).ok());
  ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), second.engine)));
  for (int tick = 0; tick < 777; ++tick) {
    const auto &a = first.engine.step(first.in), &b = second.engine.step(second.in);
    ASSERT_EQ(a.comparator.edge_count, b.comparator.edge_count);
    ASSERT_EQ(a.comparator.level, b.comparator.level);
    for (std::uint32_t e = 0; e < a.comparator.edge_count; ++e) {
      ASSERT_EQ(a.comparator.edge[e].time_s, b.comparator.edge[e].time_s);
      ASSERT_EQ(a.comparator.edge[e].level, b.comparator.edge[e].level);
    }
  }
}

/// A cam wheel turns half as fast, and its voltage goes with that: at twice the speed of the crank it is the same
/// wheel.
TEST(Reluctor, AtACamWheelIsThatAtACrankWheelOfTwiceTheSpeed) {
  EngineDefinition on_cam = sensed();
  on_cam.triggers[0].shaft = TriggerShaft::cam;
  on_cam.triggers[0].first_tooth_deg *= 2;
  Rig<double, Turned> crank_wheel(sensed(), 100e-6), cam_wheel(on_cam, 100e-6);
  crank_wheel.in.speed_rad_s = 150, cam_wheel.in.speed_rad_s = 300;
  std::uint32_t edges = 0;
  double largest_V = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const auto &slow = crank_wheel.engine.step(crank_wheel.in), &fast = cam_wheel.engine.step(cam_wheel.in);
    for (std::uint32_t i = 0; i < Turned::reluctor_samples; ++i) {
      ASSERT_NEAR(fast.reluctor_V[i], slow.reluctor_V[i], 1e-6) << tick;
      largest_V = std::fmax(largest_V, slow.reluctor_V[i]);
    }
    ASSERT_EQ(fast.comparator.edge_count, slow.comparator.edge_count) << tick;
    ASSERT_EQ(fast.comparator.level, slow.comparator.level) << tick;
    edges += slow.comparator.edge_count;
  }
  EXPECT_GT(largest_V, 1);
  EXPECT_GT(edges, 500u);
}

/// Where the threshold has fallen below the sample before, as after a long pause, no crossing lies between two samples:
/// the edge still comes between their times.
TEST(Reluctor, AnEdgeLiesBetweenItsSamplesWhateverTheThresholdWasBefore) {
  Rig<double, Turned> rig(sensed(), 100e-6);
  rig.in.speed_rad_s = 300;
  int falls = 0;
  const double arms_V = rig.table().least_V;
  for (int tick = 0; tick < 500; ++tick) {
    auto before = rig.engine.state();
    const double first_V = rig.engine.step(rig.in).reluctor_V[0];
    const auto after = rig.engine.state();
    if (first_V < 2 * arms_V) continue;
    ++falls;
    before.comparator_level = 1, before.comparator_armed = 0, before.sensor_last_peak_V = 0;
    const double spacing_s = 100e-6 / Turned::reluctor_samples;
    const struct {
      double before_V, edge_s;
    } cases[] = {{0, spacing_s * arms_V / first_V},   // rises through the threshold
                 {first_V, spacing_s},                // as high all the time
                 {(arms_V + first_V) / 2, 0},         // beyond it already, and rising
                 {first_V + 2 * arms_V, spacing_s}};  // beyond it, and falling toward it
    for (const auto& c : cases) {
      auto state = before;
      state.sensor_V = c.before_V;
      ASSERT_TRUE(accepted(rig.engine.restore(state)));
      const auto& out = rig.engine.step(rig.in);
      ASSERT_GE(out.comparator.edge_count, 1u);
      EXPECT_EQ(out.comparator.edge[0].level, 0u);
      EXPECT_NEAR(out.comparator.edge[0].time_s, c.edge_s, 1e-15) << c.before_V;
    }
    ASSERT_TRUE(accepted(rig.engine.restore(after)));
  }
  EXPECT_GT(falls, 10);
}

TEST(Reluctor, AnArmedComparatorThatIsUpAlreadyShowsNoSecondRise) {
  Rig<double, Turned> rig(sensed(), 100e-6);
  rig.in.speed_rad_s = 300;
  for (int tick = 0; tick < 300 || rig.engine.state().comparator_armed == 0; ++tick) rig.engine.step(rig.in);
  auto state = rig.engine.state();
  ASSERT_EQ(state.comparator_level, 0u);
  state.comparator_level = 1;
  ASSERT_TRUE(accepted(rig.engine.restore(state)));
  std::uint32_t level = 1, edges = 0;
  for (int tick = 0; tick < 100; ++tick) {
    const auto& out = rig.engine.step(rig.in);
    for (std::uint32_t e = 0; e < out.comparator.edge_count; ++e, ++edges)
      ASSERT_EQ(out.comparator.edge[e].level, level ^= 1u) << tick;
    ASSERT_EQ(out.comparator.level, level) << tick;
    ASSERT_EQ(rig.engine.state().comparator_level, level) << tick;
  }
  EXPECT_GT(edges, 20u);
}

TEST(Reluctor, ThePauseAtStandstillStaysAtItsLargestCountAndThePeakForgotten) {
  Rig<double, Turned> rig(sensed(), 100e-6);
  rig.in.speed_rad_s = 300;
  for (int tick = 0; tick < 300 || rig.engine.state().comparator_armed != 0; ++tick) rig.engine.step(rig.in);
  auto state = rig.engine.state();
  ASSERT_GT(state.sensor_last_peak_V, rig.table().least_V);
  state.comparator_quiet_ticks = ~std::uint32_t{0} - 1;
  ASSERT_TRUE(accepted(rig.engine.restore(state)));
  rig.in.speed_rad_s = 0;
  for (int tick = 0; tick < 3; ++tick) {
    rig.engine.step(rig.in);
    EXPECT_EQ(rig.engine.state().comparator_quiet_ticks, ~std::uint32_t{0}) << tick;
    EXPECT_EQ(rig.engine.state().sensor_last_peak_V, 0) << tick;
  }
}

TEST(Reluctor, AJumpOfTheMeasuredAngleHasNoVoltageAndNoEdge) {
  Rig<float, Measured> rig(sensed(), 100e-6);
  std::uint32_t edges = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    const bool jumps = tick == 500;
    rig.in.crank += Phase::from_cycles(jumps ? 0.4F : 0.002F);
    const auto& out = rig.engine.step(rig.in);
    edges += out.comparator.edge_count;
    if (!jumps) continue;
    EXPECT_EQ(out.faults, std::uint32_t{kFaultPhaseJump});
    EXPECT_EQ(out.comparator.edge_count, 0u);
    for (const float volts : out.reluctor_V) EXPECT_EQ(volts, 0);
  }
  EXPECT_GT(edges, 200u);
}

TEST(Reluctor, AfterAJumpTheVoltageRisesFromZero) {
  Rig<double, Measured> rig(sensed(), 100e-6);
  int falls = 0;
  for (int jump = 0; jump < 400; ++jump) {
    for (int tick = 0; tick < 20; ++tick) {
      rig.in.crank += Phase::from_cycles(0.002);
      rig.engine.step(rig.in);
    }
    rig.in.crank += Phase::from_cycles(0.3 + jump * 0.0005);
    ASSERT_EQ(rig.engine.step(rig.in).faults, std::uint32_t{kFaultPhaseJump});
    const auto& state = rig.engine.state();
    const double arms_V = std::fmax(rig.table().arm_ratio * state.sensor_last_peak_V, rig.table().least_V);
    const bool high = state.comparator_level != 0;
    rig.in.crank += Phase::from_cycles(0.002);
    const auto& out = rig.engine.step(rig.in);
    if (!high || out.reluctor_V[0] <= arms_V) continue;
    ++falls;
    ASSERT_GE(out.comparator.edge_count, 1u);
    EXPECT_EQ(out.comparator.edge[0].level, 0u);
    EXPECT_NEAR(out.comparator.edge[0].time_s, 100e-6 / 16 * arms_V / out.reluctor_V[0], 1e-12);
  }
  EXPECT_GT(falls, 10);
}

TEST(Reluctor, MoreEdgesOfTheComparatorThanThereIsRoomForAreCountedAndTold) {
  Rig<float, OneEdge> rig(sensed(), 100e-6);
  rig.in.speed_rad_s = 800;  // one edge or two in a tick, of the wheel and of the comparator at different times
  std::uint32_t last = 0;
  int of_comparator_alone = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    const auto& out = rig.engine.step(rig.in);
    const bool wheel = out.trigger[0].edge_count > 1, comparator = out.comparator.edge_count > 1;
    ASSERT_EQ(out.faults, wheel || comparator ? std::uint32_t{kFaultTriggerEdges} : 0u) << tick;
    ASSERT_EQ(out.comparator.level, last ^ (out.comparator.edge_count & 1u)) << tick;
    last = out.comparator.level;
    of_comparator_alone += comparator && !wheel ? 1 : 0;
  }
  EXPECT_GT(of_comparator_alone, 100);
}

/// docs/contract.md "What init refuses": by restore, more late edges than there are places.
TEST(Reluctor, MoreLateEdgesThanPlacesAreRefusedByRestoreAndTheRunGoesOn) {
  Rig<float, Turned> rig(sensed(), 100e-6);
  rig.in.speed_rad_s = 300;
  for (int tick = 0; tick < 100; ++tick) rig.engine.step(rig.in);
  const auto sound = rig.engine.state();
  auto forged = sound;
  forged.late_edges = Turned::reluctor_samples + 1;
  EXPECT_TRUE(support::refuses(rig.engine.restore(forged), Reason::out_of_range, "state.comparator"));
  EXPECT_EQ(std::memcmp(&rig.engine.state(), &sound, sizeof sound), 0);
}

TEST(Reluctor, AnEngineWithoutASensorShowsNoVoltage) {
  EngineDefinition engine = sensed();
  engine.reluctor = {};
  Rig<float, Turned> rig(engine, 100e-6);
  rig.in.speed_rad_s = 300;
  for (int tick = 0; tick < 100; ++tick) {
    const auto& out = rig.engine.step(rig.in);
    for (const float volts : out.reluctor_V) ASSERT_EQ(volts, 0);
    ASSERT_EQ(out.comparator.edge_count + out.comparator.level, 0u);
  }
}

TEST(Reluctor, WhatNoWheelCanHaveIsRefusedByName) {
  const auto refusal = [](auto change) {
    EngineDefinition engine = sensed();
    change(engine);
    return validate(engine);
  };
  using E = EngineDefinition;
  EXPECT_TRUE(refusal([](E&) {}).ok());
  EXPECT_TRUE(support::refuses(refusal([](E& e) { e.reluctor.wheel = 1; }), Reason::out_of_range, "reluctor.wheel"));
  EXPECT_TRUE(support::refuses(refusal([](E& e) { e.triggers[0].places = 121, e.triggers[0].gap_count = 0; }),
                               Reason::inconsistent, "reluctor.wheel"));
  EXPECT_TRUE(support::refuses(refusal([](E& e) {
                                 static constexpr double kEdges_deg[] = {10, 20, 100, 110};
                                 e.triggers[0].pattern = TriggerPattern::edges;
                                 e.triggers[0].edges_deg = kEdges_deg, e.triggers[0].edge_count = 4;
                               }),
                               Reason::inconsistent, "reluctor.wheel"));
  const auto on_cam = [](E& e, int train) {
    e.train_count = 1;
    e.trains[0] = valve_test::ohc_125_train();
    e.triggers[0].shaft = TriggerShaft::cam, e.triggers[0].train = train;
  };
  EXPECT_TRUE(refusal([&](E& e) { on_cam(e, -1); }).ok());
  EXPECT_TRUE(support::refuses(refusal([&](E& e) { on_cam(e, 0); }), Reason::inconsistent, "reluctor.wheel"))
      << "a phaser moves it";
  EXPECT_TRUE(support::refuses(refusal([](E& e) { e.triggers[0].tooth_ratio = 0.85; }), Reason::inconsistent,
                               "reluctor.reach_ratio"));
  EXPECT_TRUE(
      support::refuses(refusal([](E& e) { e.reluctor.gain_V_s = 0; }), Reason::not_positive, "reluctor.gain_V_s"));
  EXPECT_TRUE(support::refuses(refusal([](E& e) { e.reluctor.gap_lobe_ratio = 2.5; }), Reason::out_of_range,
                               "reluctor.gap_lobe_ratio"));
}

TEST(Reluctor, ADelayOfMoreThanATickIsRefused) {
  EngineDefinition engine = sensed();
  engine.reluctor.delay_s = 100e-6;
  TableStorage<float, Turned> storage;
  EXPECT_TRUE(accepted(storage.build(engine, {100e-6})));
  EXPECT_TRUE(support::refuses(storage.build(engine, {99e-6}), Reason::out_of_range, "reluctor.delay_s"));
  engine.reluctor.wheel = -1;
  EXPECT_TRUE(accepted(storage.build(engine, {99e-6}))) << "no sensor, nothing is late";
}

}  // namespace
}  // namespace crankloop::reluctor_test
