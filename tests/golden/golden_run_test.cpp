// A golden run of each sample engine in each ready-made scene, and in exact scenes of the usual kinds: 2000 ticks of
// one life, committed as text.
//
// Every 20th tick shows some outputs of cylinder 1, every 100th a hash of all outputs of all ticks so far, every 500th
// all outputs. What is committed of these rows, how it is compared and renewed: support/golden.hpp. Any changed bit
// changes a hash, and the first shows where.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include <crankloop/crankloop.hpp>
#include <crankloop/tick/step.hpp>

#include "crankloop/engine_file/engine_file.hpp"
#include "support/engines.hpp"
#include "support/gas_engine.hpp"
#include "support/golden.hpp"
#include "support/output_fields.hpp"
#include "support/scenes.hpp"

namespace crankloop::golden_run_test {

using namespace detail;
namespace {

using namespace tick_test;

// ---- the life -------------------------------------------------------------------------------------------------------

constexpr int kTicks = 2000;
constexpr double kTick_s = 100e-6;

/// Up to one and a half times the rated speed, held there with a ripple, down through standstill, a crawl, backwards.
double speed_rad_s(int tick, double rated_rad_s) {
  if (tick < 800) return rated_rad_s * 1.5 * tick / 800;
  if (tick < 1200) return rated_rad_s * (1.5 - 0.0625 * (tick % 8));
  if (tick < 1700) return rated_rad_s * 1.5 * (1700 - tick) / 500;
  if (tick < 1750) return 0.001 * (tick - 1725);
  return -rated_rad_s * 0.5 * (tick - 1750) / 250;
}

template <class Real, class S>
void drive(int tick, double rated_rad_s, Input<Real, S>& in) {
  const double speed = speed_rad_s(tick, rated_rad_s);
  if constexpr (S::crank == CrankGiven::speed) {
    in.speed_rad_s = tick == 1100 ? static_cast<Real>(1e9) : static_cast<Real>(speed);
  } else if constexpr (S::crank == CrankGiven::torque) {
    // Started, run, thrown back through standstill, stopped.
    in.external_torque_Nm = static_cast<Real>(tick == 1100 ? 1e9 : tick < 1200 ? 0 : tick < 1700 ? 60 : 5);
    in.starter = tick < 800 ? 1 : 0;
    in.cut_cylinders = tick < 900 ? 0 : static_cast<std::uint32_t>(tick / 64);
  } else {
    constexpr double kCyclesPerRad = 0.07957747154594767;  // 1 / (4 pi)
    in.crank += Phase::from_cycles(speed * kTick_s * kCyclesPerRad);
    if (tick == 1100) in.crank += Phase{std::uint64_t{1} << 63};
  }
  if constexpr (detail::Needs<S>::load)
    in.load_ratio = tick == 600 ? Real{-1} : static_cast<Real>(tick / 100 % 6 * 0.25);
  if constexpr (detail::Needs<S>::input_pressure) {
    for (int k = 0; k < static_cast<int>(S::cylinders.capacity); ++k)
      in.pressure_Pa[k] = static_cast<Real>(90'000 + 64 * ((37 * tick + 911 * k) % 60'000));
  }
  if constexpr (detail::Needs<S>::manifolds)
    in.throttle_ratio = tick == 600 ? Real{-1} : static_cast<Real>(0.25 * (tick / 300 % 5));
  if constexpr (detail::Needs<S>::burn_input) {
    for (Real& fuel : in.fuel_kg) fuel = static_cast<Real>(tick / 400 * 10e-6);
    in.burn_start_deg[0] = Real{-25}, in.burn_duration_deg[0] = Real{70};
  }
  if constexpr (S::cam_phasing) {
    for (Real& target : in.cam_phase_deg) target = tick < 500 ? Real{0} : tick < 1500 ? Real{-20} : Real{10};
  }
}

// ---- the text -------------------------------------------------------------------------------------------------------

template <class Number>
std::string text_of(Number x) {
  char text[40];
  if constexpr (std::is_floating_point_v<Number>) {
    std::snprintf(text, sizeof text, "%a", static_cast<double>(x));
  } else {
    std::snprintf(text, sizeof text, "%u", x);
  }
  return text;
}

template <class Real, class S>
std::string life_of(const EngineDefinition& definition, double rated_rad_s) {
  auto storage = std::make_unique<TableStorage<Real, S>>();
  const Status built = storage->build(definition, {kTick_s});
  auto engine = std::make_unique<Engine<Real, S>>();
  const Status status = built.ok() ? engine->init(storage->tables()) : built;
  if (!status.ok()) return std::string("refused: ") + status.field + " " + describe(status.reason) + "\n";

  const Layout& layout = definition.layout;
  std::uint8_t pins = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k)
    pins = std::max<std::uint8_t>(pins, layout.pin[k] + 1);
  const support::Used used{static_cast<std::size_t>(layout.cylinders), pins,
                           static_cast<std::size_t>(definition.train_count)};
  static const std::set<std::string> kKeys{"torque_Nm",   "mean_torque_Nm", "displacement_m",     "rod_angle_rad",
                                           "pressure_Pa", "pin_load_N",     "gas_pressure_Pa",    "manifold_Pa",
                                           "lift_m",      "train_N",        "train_compression_m"};

  std::string text = "tables " + support::hex(storage->tables().drive->fingerprint) + "\n";
  support::Fnv hash;
  Input<Real, S> in;
  for (int tick = 1; tick <= kTicks; ++tick) {
    drive<Real, S>(tick, rated_rad_s, in);
    const auto& out = engine->step(in);
    support::each_output(out, used, [&](const char*, std::size_t, auto x) { hash.add(x); });
    const std::string at = std::to_string(tick);
    if (tick % 20 == 0) {
      text += at + " phase " + support::hex(engine->state().phase.units());
      support::each_output(out, used, [&](const std::string& name, std::size_t i, auto x) {
        if (i == 0 && kKeys.count(name) != 0) text += " " + name + " " + text_of(x);
      });
      text += "\n";
    }
    if (tick % 100 == 0) text += at + " hash " + support::hex(hash.value()) + "\n";
    if (tick % 500 == 0) {
      support::each_output(out, used, [&](const std::string& name, std::size_t i, auto x) {
        text += at + " " + name + "[" + std::to_string(i) + "] " + text_of(x) + "\n";
      });
    }
  }
  return text;
}

/// Exact scenes exist for the sizes of the sample engines.
template <class Real, template <std::uint32_t, std::uint32_t> class Exact>
std::string life_in_exact(const EngineDefinition& definition, double rated_rad_s) {
  const int cylinders = definition.layout.cylinders;
  const int trains = definition.train_count;
  if (cylinders == 4 && trains == 2) return life_of<Real, Exact<4, 2>>(definition, rated_rad_s);
  if (cylinders == 1 && trains == 1) return life_of<Real, Exact<1, 1>>(definition, rated_rad_s);
  ADD_FAILURE() << "a sample engine of another size: add its exact scenes here";
  return "";
}

// ---- the tests ------------------------------------------------------------------------------------------------------

/// Those with a diagram: the one that breathes has its own runs, below.
std::vector<std::string> sample_engines() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(CRANKLOOP_SOURCE_DIR "/tools/engines")) {
    if (entry.path().extension() != ".ini") continue;
    const program::EngineFile file = program::read_engine_file(entry.path().string(), {});
    if (file.definition().pressure.source != PressureSource::gas) names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class GoldenRun : public ::testing::TestWithParam<std::string> {
 protected:
  template <class Life>
  void expect(const char* scene, const char* real, const Life& life) {
    const program::EngineFile file = program::read_engine_file(
        CRANKLOOP_SOURCE_DIR "/tools/engines/" + GetParam() + ".ini", {"engine", "crank", "masses"});
    support::expect_golden(GetParam() + "_" + scene + "_" + real,
                           life(file.definition(), file.rated_rpm() * 0.10471975511965977));
  }
};

TEST_P(GoldenRun, Whole) {
  expect("whole", "float", life_of<float, scenes::Whole>);
  expect("whole", "double", life_of<double, scenes::Whole>);
}
TEST_P(GoldenRun, MeasuredMotion) {
  expect("measured_motion", "float", life_of<float, scenes::MeasuredMotion>);
  expect("measured_motion", "double", life_of<double, scenes::MeasuredMotion>);
}
TEST_P(GoldenRun, TorqueByTable) {
  expect("torque_by_table", "float", life_of<float, scenes::TorqueByTable>);
  expect("torque_by_table", "double", life_of<double, scenes::TorqueByTable>);
}
TEST_P(GoldenRun, TorqueByPressure) {
  expect("torque_by_pressure", "float", life_of<float, scenes::TorqueByPressure>);
  expect("torque_by_pressure", "double", life_of<double, scenes::TorqueByPressure>);
}
TEST_P(GoldenRun, FreeRunning) {
  expect("free_running", "float", life_of<float, scenes::FreeRunning>);
  expect("free_running", "double", life_of<double, scenes::FreeRunning>);
}
TEST_P(GoldenRun, ExactForcesAndTorque) {
  expect("exact_forces_and_torque", "float", life_in_exact<float, ExactForcesAndTorque>);
  expect("exact_forces_and_torque", "double", life_in_exact<double, ExactForcesAndTorque>);
}
TEST_P(GoldenRun, ExactValveKinematics) {
  expect("exact_valve_kinematics", "float", life_in_exact<float, ExactValveKinematics>);
  expect("exact_valve_kinematics", "double", life_in_exact<double, ExactValveKinematics>);
}
TEST_P(GoldenRun, ExactValveDynamics) {
  expect("exact_valve_dynamics", "float", life_in_exact<float, ExactValveDynamics>);
  expect("exact_valve_dynamics", "double", life_in_exact<double, ExactValveDynamics>);
}
TEST(GoldenRunOfGas, FourCylindersWithElasticValves) {
  constexpr double kRated_rad_s = 6000 * 0.10471975511965977;
  support::expect_golden("four_2000_breathing_float",
                         life_of<float, support::ElasticBreathingFour>(support::four_2000(), kRated_rad_s));
  support::expect_golden("four_2000_breathing_double",
                         life_of<double, support::ElasticBreathingFour>(support::four_2000(), kRated_rad_s));
}
INSTANTIATE_TEST_SUITE_P(Of, GoldenRun, ::testing::ValuesIn(sample_engines()), [](const auto& of) { return of.param; });

// ---- the changelog --------------------------------------------------------------------------------------------------

constexpr const char* kChangelog = CRANKLOOP_SOURCE_DIR "/CHANGELOG.md";

TEST(GoldenRuns, AreThoseThatTheChangelogNames) {
  if (support::renewal() != nullptr) GTEST_SKIP() << "renewing";
  const std::string line = "golden runs " + support::checksum_of_golden_runs();
  EXPECT_NE(support::contents_of(kChangelog).find(line), std::string::npos)
      << "no \"" << line << "\" in CHANGELOG.md: tests/golden/renew.sh \"why\"";
}

/// After a renewal: its line in the changelog, under those before it.
class NoteRenewal : public ::testing::Environment {
 public:
  void TearDown() override {
    if (support::renewal() == nullptr) return;
    const std::string sum = support::checksum_of_golden_runs();
    std::string text = support::contents_of(kChangelog);
    if (text.find("golden runs " + sum) != std::string::npos) return;
    const std::size_t figures = text.find("\n| flash");  // the newest entry's row of figures ends it
    ASSERT_NE(figures, std::string::npos);
    text.insert(figures, "- Renewed golden runs " + sum + ": " + support::renewal() + "\n");
    std::ofstream(kChangelog, std::ios::binary) << text;
  }
};
[[maybe_unused]] ::testing::Environment* const kNoteRenewal = ::testing::AddGlobalTestEnvironment(new NoteRenewal);

}  // namespace
}  // namespace crankloop::golden_run_test
