// FMUs at work: the bits of the scene driven directly, whatever the communication step; states that go on; calls in any
// order that do no harm.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

#include <crankloop/fmi/unit.hpp>

#include "fmu.hpp"

#include "engines.hpp"

namespace {

using fmu::Direct;
using fmu::Fmu;
using fmu::Unit;

/// FMU_FOLDER in the environment: FMUs that were made elsewhere.
std::string path_of(const std::string& name, int version) {
  const char* elsewhere = std::getenv("FMU_FOLDER");
  return std::string(elsewhere != nullptr ? elsewhere : FMU_DIR) + "/" + name + "_fmi" + std::to_string(version) +
         ".fmu";
}

template <class Of>
class ScenesFmu : public testing::Test {
 protected:
  template <class Story>
  void in_both_versions(const Story& story) {
    for (const int version : {2, 3}) {
      SCOPED_TRACE(std::string(Of::kName) + ", FMI " + std::to_string(version));
      const Fmu fmu(path_of(Of::kName, version));
      story(fmu);
    }
  }
  static void set_inputs(const Fmu& fmu, const Unit& unit, long k, double step_s) {
    for (const auto& v : fmu.model.variables) {
      if (v.causality == "input") unit.set(v.name, fmu::input_at(v.name, k, step_s));
    }
  }
  static void expect_same(const Fmu& fmu, const Unit& unit, const Direct<Of>& direct) {
    const std::vector<double> values = unit.all();
    const auto expected = direct.outputs();
    std::size_t compared = 0;
    for (const auto& v : fmu.model.variables) {
      const auto found = expected.find(v.name);
      if (v.causality != "output" || found == expected.end()) continue;
      const double is = values[v.reference];
      ++compared;
      if (v.name == "crank_deg") {
        ASSERT_NEAR(is, found->second, 1e-9);
      } else {
        ASSERT_TRUE(fmu::same(is, found->second)) << v.name << " is " << is << ", the engine's " << found->second;
      }
    }
    ASSERT_EQ(compared, expected.size()) << "every output of the scene is a variable";
  }
};
using Scenes = testing::Types<fmu::Of_whole, fmu::Of_free_running, fmu::Of_breathing_free, fmu::Of_measured_motion,
                              fmu::Of_torque_by_table, fmu::Of_torque_by_pressure, fmu::Of_four_pistons,
                              fmu::Of_trigger_wheels, fmu::Of_bouncing_valve>;
struct SceneNames {
  template <class Of>
  static std::string GetName(int) {
    return Of::kName;
  }
};
TYPED_TEST_SUITE(ScenesFmu, Scenes, SceneNames);

TYPED_TEST(ScenesFmu, GivesTheBitsOfTheSceneDrivenDirectly) {
  this->in_both_versions([&](const Fmu& fmu) {
    Unit unit(fmu);
    ASSERT_NO_FATAL_FAILURE(unit.start());
    Direct<TypeParam> direct;
    constexpr int kTicks = 10;
    const double step_s = kTicks * TypeParam::kTick_s;
    double time_s = 0;
    for (long k = 0; k < 10'000; ++k) {
      this->set_inputs(fmu, unit, k, step_s);
      ASSERT_NO_FATAL_FAILURE(unit.step(time_s, step_s));
      time_s += step_s;
      direct.step(k, step_s, kTicks);
      if (k % 97 == 0 || k == 9'999) ASSERT_NO_FATAL_FAILURE(this->expect_same(fmu, unit, direct)) << "step " << k;
    }
    EXPECT_EQ(direct.engine.state().ticks, 100'000u);
  });
}

TYPED_TEST(ScenesFmu, AfterAResetIsAsNew) {
  this->in_both_versions([&](const Fmu& fmu) {
    Unit unit(fmu);
    ASSERT_NO_FATAL_FAILURE(unit.start());
    const double step_s = 10 * TypeParam::kTick_s;
    const auto run = [&] {
      for (long k = 0; k < 300; ++k) {
        this->set_inputs(fmu, unit, k, step_s);
        unit.step(static_cast<double>(k) * step_s, step_s);
      }
      return unit.all();
    };
    const auto first = run();
    ASSERT_EQ(unit_terminate(unit.unit), UNIT_OK);
    ASSERT_EQ(unit_reset(unit.unit), UNIT_OK);
    ASSERT_NO_FATAL_FAILURE(unit.start());
    const auto second = run();
    EXPECT_TRUE(std::equal(first.begin(), first.end(), second.begin(), second.end(), fmu::same));
  });
}

// Where the valve of the bouncing scene is in the air, the free-running engine between edges: a state taken, written,
// read by another instance, goes on with the same bits, also where it is put over a run that has gone elsewhere.
TYPED_TEST(ScenesFmu, GoesOnFromASavedStateWithTheSameBits) {
  this->in_both_versions([&](const Fmu& fmu) {
    Unit unit(fmu);
    ASSERT_NO_FATAL_FAILURE(unit.start(2.5));
    const double step_s = 7 * TypeParam::kTick_s;
    const auto advance = [&](Unit& one, long from, long to) {
      for (long k = from; k < to; ++k) {
        this->set_inputs(fmu, one, k, step_s);
        ASSERT_NO_FATAL_FAILURE(one.step(2.5 + static_cast<double>(k) * step_s, step_s));
      }
    };
    ASSERT_NO_FATAL_FAILURE(advance(unit, 0, 2'113));
    const auto state = unit.saved();
    const auto shown = unit.all();
    ASSERT_NO_FATAL_FAILURE(advance(unit, 2'113, 4'000));
    const auto expected = unit.all();

    ASSERT_EQ(unit.restore(state), UNIT_OK) << importer_message();
    const auto again = unit.all();
    EXPECT_TRUE(std::equal(shown.begin(), shown.end(), again.begin(), again.end(), fmu::same))
        << "shows what it showed";
    EXPECT_EQ(unit.saved(), state);
    ASSERT_NO_FATAL_FAILURE(advance(unit, 2'113, 4'000));
    const auto repeated = unit.all();
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), repeated.begin(), repeated.end(), fmu::same));

    Unit fresh(fmu);  // only instantiated
    ASSERT_NE(fresh.unit, nullptr);
    ASSERT_EQ(fresh.restore(state), UNIT_OK) << importer_message();
    ASSERT_NO_FATAL_FAILURE(advance(fresh, 2'113, 4'000));
    const auto elsewhere = fresh.all();
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), elsewhere.begin(), elsewhere.end(), fmu::same));
  });
}

TYPED_TEST(ScenesFmu, RefusesADamagedStateAndOneOfAnotherFmu) {
  this->in_both_versions([&](const Fmu& fmu) {
    Unit unit(fmu);
    ASSERT_NO_FATAL_FAILURE(unit.start());
    ASSERT_NO_FATAL_FAILURE(unit.step(0, 20 * TypeParam::kTick_s));
    const auto state = unit.saved();
    std::mt19937 random(5);
    for (int i = 0; i < 700; ++i) {  // 10^4 over scenes and versions
      auto damaged = state;
      damaged[random() % damaged.size()] ^= static_cast<unsigned char>(1 + random() % 255);
      ASSERT_EQ(unit.restore(damaged), UNIT_ERROR);
    }
    for (std::size_t size : {std::size_t{0}, std::size_t{4}, state.size() - 1, state.size() + 1}) {
      auto cut = state;
      cut.resize(size);
      cut.reserve(1);
      ASSERT_EQ(unit.restore(cut), UNIT_ERROR) << size;
    }
    EXPECT_EQ(unit.saved(), state) << "a refused state has changed nothing";
    const bool is_pistons = std::string(TypeParam::kName) == "four_pistons";
    const Fmu other(path_of(is_pistons ? "trigger_wheels" : "four_pistons", fmu.model.version));
    Unit foreign(other);
    ASSERT_NO_FATAL_FAILURE(foreign.start());
    EXPECT_EQ(unit.restore(foreign.saved()), UNIT_ERROR);
  });
}

// With the right checksums, of which the engine's stands before the whole's: all that is read back is finite, at once
// and later. 10^5 forgeries over scenes and versions with CRANKLOOP_LONG_TESTS=1 in the environment.
TYPED_TEST(ScenesFmu, ForgedInAnyNumberIsRefusedOrStepsOnInFiniteNumbers) {
  const int forgeries = std::getenv("CRANKLOOP_LONG_TESTS") != nullptr ? 5'600 : 30;
  int taken = 0;
  this->in_both_versions([&](const Fmu& fmu) {
    Unit unit(fmu);
    ASSERT_NO_FATAL_FAILURE(unit.start());
    const double step_s = 10 * TypeParam::kTick_s;
    double time_s = 0;
    const auto advance = [&](long steps) {
      for (long k = 0; k < steps; ++k) {
        this->set_inputs(fmu, unit, k, step_s);
        if (unit_step(unit.unit, time_s, step_s) != UNIT_OK) return;  // its ticks are forged too
        time_s += step_s;
      }
    };
    const auto expect_finite = [&](const char* when) {
      const std::vector<double> values = unit.all();
      for (const auto& v : fmu.model.variables) {
        if (v.causality == "input" || v.causality == "parameter") continue;  // the importer's own
        ASSERT_TRUE(std::isfinite(values[v.reference])) << v.name << " " << when;
      }
    };
    advance(300);
    const auto good = unit.saved();
    const unsigned char head[] = {'C', 'L', 'S', 'T'};
    const auto engine = std::search(good.begin(), good.end(), std::begin(head), std::end(head)) - good.begin();
    std::mt19937_64 random(29);
    for (int i = 0; i < forgeries; ++i) {
      SCOPED_TRACE("forgery " + std::to_string(i));
      auto bytes = good;
      const double numbers[] = {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e308, -1e300, 1e18, -1e9, 1e-18, 5e-324, 0, 3};
      const double number = numbers[random() % std::size(numbers)];
      const auto narrow = static_cast<float>(number);
      const std::uint64_t word = random() % 3 == 0 ? random() : random() % 4;
      const std::size_t at = 32 + random() % ((good.size() - 48) / 4) * 4;  // behind the stage: state_test.cpp
      const std::uint64_t kind = random() % 3;
      if (kind == 0) std::memcpy(&bytes[at], &number, sizeof number);
      if (kind == 1) std::memcpy(&bytes[at], &narrow, sizeof narrow);
      if (kind == 2) std::memcpy(&bytes[at], &word, random() % 2 == 0 ? 4 : 8);
      const auto seal = [&bytes](std::size_t from, std::size_t end) {
        const std::uint32_t crc = crankloop::detail::crc32_of(bytes.data() + from, end - from);
        std::memcpy(&bytes[end], &crc, sizeof crc);
      };
      seal(static_cast<std::size_t>(engine), bytes.size() - 8);
      seal(0, bytes.size() - 4);
      if (unit.restore(bytes) != UNIT_OK) continue;
      ++taken;
      ASSERT_NO_FATAL_FAILURE(expect_finite("at once"));
      const std::uint32_t time = 0;
      ASSERT_EQ(unit_get_real(unit.unit, &time, 1, &time_s), UNIT_OK);
      advance(20);
      ASSERT_NO_FATAL_FAILURE(expect_finite("later"));
    }
  });
  EXPECT_GT(taken, forgeries / 4);
  std::printf("[ figures  ] of %d forged states %d are accepted, and finite\n", 2 * forgeries, taken);
}

TYPED_TEST(ScenesFmu, RunsInterleavedAsItRunsAlone) {
  this->in_both_versions([&](const Fmu& fmu) {
    Unit one(fmu);
    Unit two(fmu);
    Unit alone(fmu);
    const double step_s = 5 * TypeParam::kTick_s;
    for (Unit* unit : {&one, &two, &alone}) ASSERT_NO_FATAL_FAILURE(unit->start());
    const auto advance = [&](Unit& unit, long k, long shift) {
      this->set_inputs(fmu, unit, k + shift, step_s);
      unit.step(static_cast<double>(k) * step_s, step_s);
    };
    for (long k = 0; k < 1'000; ++k) advance(one, k, 0), advance(two, k, 333);
    for (long k = 0; k < 1'000; ++k) advance(alone, k, 0);
    const auto a = one.all();
    const auto b = alone.all();
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end(), fmu::same));
    EXPECT_NE(one.saved(), two.saved());
  });
}

TYPED_TEST(ScenesFmu, RefusesAnotherToken) {
  this->in_both_versions([&](const Fmu& fmu) {
    std::string token = fmu.model.token;
    token[5] = token[5] == '0' ? '1' : '0';
    EXPECT_EQ(Unit(fmu, token).unit, nullptr);
    EXPECT_NE(std::string(importer_message()).find("token"), std::string::npos);
  });
}

// Any calls in any order, with any references and numbers: no crash, and a refused call changes nothing.
TYPED_TEST(ScenesFmu, SurvivesHostileCalls) {
  this->in_both_versions([&](const Fmu& fmu) {
    std::mt19937_64 random(20'260);
    const auto any = [&random](std::uint64_t below) { return random() % below; };
    const auto any_real = [&] {
      const double reals[] = {0, 1, -1, 1e-4, 1e300, -1e300, std::nan(""), HUGE_VAL, 5e-324, 720, 0.37};
      return reals[any(std::size(reals))];
    };
    Unit unit(fmu);
    ASSERT_NE(unit.unit, nullptr);
    const auto variables = static_cast<std::uint32_t>(fmu.model.variables.size());
    double time_s = 0;
    constexpr long kCalls = 65'000;  // 10^6 over scenes and versions
    long refused = 0;
    for (long i = 0; i < kCalls; ++i) {
      const bool watched = i % 64 == 0;
      const auto before = watched ? unit.saved() : std::vector<unsigned char>();
      std::uint32_t which[3];
      double reals[3];
      std::uint32_t wholes[3];
      int truths[3];
      const std::size_t n = any(4);
      for (int j = 0; j < 3; ++j) {
        which[j] = static_cast<std::uint32_t>(any(8) == 0 ? random() : any(variables + 2));
        reals[j] = any_real();
        wholes[j] = static_cast<std::uint32_t>(random());
        truths[j] = static_cast<int>(any(3)) - 1;
      }
      int status = UNIT_OK;
      switch (any(18)) {
        case 0:
          status = unit_setup(unit.unit, any(4) == 0 ? any_real() : 0);
          break;
        case 1:
          status = unit_begin(unit.unit);
          break;
        case 2:
          status = unit_start(unit.unit);
          break;
        case 3:
          status = any(20) == 0 ? unit_terminate(unit.unit) : UNIT_OK;
          break;
        case 4:
          status = any(20) == 0 ? unit_reset(unit.unit) : UNIT_OK;
          break;
        case 5:
          status = unit_get_real(unit.unit, which, n, reals);
          break;
        case 6:
          status = unit_get_whole(unit.unit, which, n, wholes);
          break;
        case 7:
          status = unit_get_truth(unit.unit, which, n, truths);
          break;
        case 8:
          status = unit_set_real(unit.unit, which, n, reals);
          break;
        case 9:
          status = unit_set_whole(unit.unit, which, n, wholes);
          break;
        case 10:
          status = unit_set_truth(unit.unit, which, n, truths);
          break;
        case 11:
          status = unit_call_other(unit.unit, static_cast<int>(any(7)));
          break;
        case 12:
          status = unit_get_real(unit.unit, nullptr, n, nullptr);
          break;
        case 13:
          status = unit_set_state(unit.unit, nullptr);
          break;
        case 14:
          status = unit_get_state(unit.unit, nullptr);
          break;
        case 15:
          status = unit_step(unit.unit, any_real(), any_real());
          break;
        case 16:
          status = unit_step(unit.unit, time_s, -TypeParam::kTick_s);
          break;
        case 17:
          status = unit_step(unit.unit, time_s, TypeParam::kTick_s * static_cast<double>(any(5)));
          break;
      }
      ASSERT_TRUE(status == UNIT_OK || status == UNIT_ERROR) << status;
      if (status != UNIT_OK) {
        ++refused;
        if (watched) ASSERT_EQ(unit.saved(), before) << "a refused call changed something";
      }
      std::uint32_t time_reference = 0;
      if (unit_get_real(unit.unit, &time_reference, 1, &time_s) != UNIT_OK) time_s = 0;
    }
    EXPECT_GT(refused, kCalls / 10);
  });
}

// ---- time ------------------------------------------------------------------------------------------------------

/// Ticks that an FMU has run: a trigger wheel's scene tells no ticks, a counted input does.
class Ticks : public testing::TestWithParam<int> {
 protected:
  Ticks() : fmu_(path_of("four_pistons", GetParam())), unit_(fmu_) {}
  /// Every tick with a bad input is counted.
  void start(double start_s) {
    ASSERT_NO_FATAL_FAILURE(unit_.start(start_s));
    unit_.set("speed_rad_s", std::nan(""));
  }
  [[nodiscard]] double ticks() const { return unit_.get("bad_input_ticks"); }
  static constexpr double kTick_s = fmu::Of_four_pistons::kTick_s;

  Fmu fmu_;
  Unit unit_;
};

TEST_P(Ticks, AreCountedWhateverTheStep) {
  for (const double part : {1.0, 7.3, 0.1, 16.0, 0.999999}) {
    SCOPED_TRACE(part);
    ASSERT_EQ(unit_reset(unit_.unit), UNIT_OK);
    ASSERT_NO_FATAL_FAILURE(start(0));
    double time_s = 0;
    for (int k = 1; k <= 20'000; ++k) {
      ASSERT_NO_FATAL_FAILURE(unit_.step(time_s, part * kTick_s));
      time_s += part * kTick_s;
      // Whole ticks that have ended; one that ends within a thousandth of a tick has.
      ASSERT_EQ(ticks(), std::floor(k * part + 1e-3)) << "step " << k;
    }
  }
}

TEST_P(Ticks, StartFarFromZeroAndAreSummedByTheImporter) {
  ASSERT_NO_FATAL_FAILURE(start(1e5));
  double time_s = 1e5;
  for (int k = 1; k <= 1'000; ++k) {
    ASSERT_NO_FATAL_FAILURE(unit_.step(time_s, 1e-3));
    time_s += 1e-3;
    ASSERT_EQ(ticks(), k * 16.0);
  }
}

TEST_P(Ticks, AreNeitherLostNorDoubledInAMillionSteps) {
  ASSERT_NO_FATAL_FAILURE(start(0));
  double time_s = 0;
  for (int k = 0; k < 1'000'000; ++k) {
    ASSERT_EQ(unit_step(unit_.unit, time_s, 1e-4), UNIT_OK);
    time_s += 1e-4;
  }
  ASSERT_NE(time_s, 100.0) << "the importer's sum is not exact: that is the point";
  EXPECT_EQ(ticks(), 1'600'000);
}

TEST_P(Ticks, AreNotRunTwiceByAStepThatIsRepeated) {
  ASSERT_NO_FATAL_FAILURE(start(0));
  ASSERT_NO_FATAL_FAILURE(unit_.step(0, 1e-3));
  EXPECT_EQ(unit_step(unit_.unit, 0, 1e-3), UNIT_ERROR);
  EXPECT_EQ(unit_step(unit_.unit, 2e-3, 1e-3), UNIT_ERROR);
  EXPECT_EQ(unit_step(unit_.unit, 1e-3, 0), UNIT_ERROR);
  EXPECT_EQ(unit_step(unit_.unit, 1e-3, 1e7 * kTick_s * 1.01), UNIT_ERROR);
  const std::string message = importer_message();
  EXPECT_EQ(message.find("fmi" + std::to_string(GetParam()) + "DoStep: "), 0u) << message;
  EXPECT_NE(message.find("ticks"), std::string::npos);
  EXPECT_EQ(ticks(), 16);
  EXPECT_EQ(unit_.get("time"), 1e-3);
}
INSTANTIATE_TEST_SUITE_P(Versions, Ticks, testing::Values(2, 3), testing::PrintToStringParamName());

// ---- the story of an engine ------------------------------------------------------------------------------------

TEST(FreeRunningFmu, StartsTurningWhereItIsTold) {
  for (const int version : {2, 3}) {
    const Fmu fmu(path_of("free_running", version));
    Unit unit(fmu);
    ASSERT_EQ(unit_setup(unit.unit, 0), UNIT_OK);
    unit.set("start.crank_deg", 300);
    unit.set("start.speed_rad_s", 150);
    ASSERT_EQ(unit_begin(unit.unit), UNIT_OK);
    ASSERT_EQ(unit_start(unit.unit), UNIT_OK);
    EXPECT_NEAR(unit.get("crank_deg"), 300, 1e-9);
    EXPECT_EQ(unit.get("torque_Nm"), 0) << "no output before the first tick";
    const std::uint32_t start = fmu.model.by_name.at("start.crank_deg");
    const double angle_deg = 10;
    EXPECT_EQ(unit_set_real(unit.unit, &start, 1, &angle_deg), UNIT_ERROR) << "too late";
    Direct<fmu::Of_free_running> direct(300, 150);
    unit.step(0, 1e-4);
    crankloop::Input<double, FreeRunning> in;
    direct.engine.step(in);
    EXPECT_TRUE(fmu::same(unit.get("speed_rad_s"), direct.engine.output().speed_rad_s));
    EXPECT_NEAR(unit.get("speed_rad_s"), 150, 3);
  }
}

TEST(FreeRunningFmu, RefusesAStartThatNoEngineHas) {
  const Fmu fmu(path_of("free_running", 3));
  Unit unit(fmu);
  unit.set("start.crank_deg", 720.5);
  ASSERT_EQ(unit_begin(unit.unit), UNIT_OK);
  EXPECT_EQ(unit_start(unit.unit), UNIT_ERROR);
  EXPECT_NE(std::string(importer_message()).find("start.crank_deg"), std::string::npos);
  unit.set("start.crank_deg", 720);  // and may be mended
  EXPECT_EQ(unit_start(unit.unit), UNIT_OK) << importer_message();
}

TEST(OfFmi3, EventsAndIntermediateValuesAreRefusedInWords) {
  const Fmu fmu(path_of("four_pistons", 3));
  const char* token = fmu.model.token.c_str();
  EXPECT_FALSE(importer_is_refused(fmu.importer, token, false, 0)) << importer_message();
  const std::pair<bool, std::size_t> wanted[] = {{true, 0}, {false, 1}, {false, 2}};
  for (const auto& [events, intermediate] : wanted) {
    EXPECT_TRUE(importer_is_refused(fmu.importer, token, events, intermediate)) << events << ' ' << intermediate;
    EXPECT_NE(std::string(importer_message()).find("co-simulation"), std::string::npos) << intermediate;
  }
}

TEST(FaultsOfAnFmu, AreLoggedByTheCategoryThatIsSwitchedOn) {
  for (const int version : {2, 3}) {
    SCOPED_TRACE(version);
    const Fmu fmu(path_of("four_pistons", version));
    Unit unit(fmu);
    ASSERT_NO_FATAL_FAILURE(unit.start());
    const auto said_of_faults = [&] {
      unit.set("speed_rad_s", 100);
      const double before_s = unit.get("time");
      unit.step(before_s, 1e-3);
      (void)importer_message();
      unit.set("speed_rad_s", std::nan(""));
      unit.step(unit.get("time"), 1e-3);
      return std::string(importer_message());
    };
    EXPECT_EQ(said_of_faults(), "") << "off at first";
    EXPECT_EQ(unit_log(unit.unit, true, "logStatusError"), UNIT_OK);
    EXPECT_EQ(said_of_faults(), "") << "another category";
    EXPECT_EQ(unit_log(unit.unit, true, "logFaults"), UNIT_OK);
    EXPECT_NE(said_of_faults().find("fault bits 0x2 "), std::string::npos);
    EXPECT_EQ(unit_log(unit.unit, false, nullptr), UNIT_OK);
    EXPECT_EQ(said_of_faults(), "");
    EXPECT_EQ(unit_log(unit.unit, true, nullptr), UNIT_OK);
    EXPECT_NE(said_of_faults(), "");
    EXPECT_EQ(unit_log(unit.unit, true, "logNothing"), UNIT_ERROR);
  }
}

// The names say what the fields are: the list is not compared with itself.
TEST(WholeFmu, NamesAreThoseOfTheFields) {
  const Fmu fmu(path_of("whole", 2));
  Unit unit(fmu);
  ASSERT_NO_FATAL_FAILURE(unit.start());
  whole::Engine engine;
  whole::Input in;
  in.speed_rad_s = 200;
  in.cam_phase_deg[1] = 12;
  unit.set("speed_rad_s", 200);
  unit.set("cam_phase_deg[2]", 12);
  ASSERT_NO_FATAL_FAILURE(unit.step(0, 0.1));
  for (int i = 0; i < 1'000; ++i) engine.step(in);
  const auto& out = engine.output();
  const std::map<std::string, double> expected = {
      {"displacement_m[2]", out.displacement_m[1]},
      {"velocity_m_s[3]", out.velocity_m_s[2]},
      {"acceleration_m_s2[4]", out.acceleration_m_s2[3]},
      {"rod_angle_rad[1]", out.rod_angle_rad[0]},
      {"rod_speed_rad_s[2]", out.rod_speed_rad_s[1]},
      {"rod_acceleration_rad_s2[3]", out.rod_acceleration_rad_s2[2]},
      {"torque_Nm", out.torque_Nm},
      {"mean_torque_Nm", out.mean_torque_Nm},
      {"cylinder[1].pressure_Pa", out.cylinder[0].pressure_Pa},
      {"cylinder[2].gas_force_N", out.cylinder[1].gas_force_N},
      {"cylinder[2].side_force_N", out.cylinder[1].side_force_N},
      {"cylinder[3].rod_force_N", out.cylinder[2].rod_force_N},
      {"cylinder[4].tilting_moment_Nm", out.cylinder[3].tilting_moment_Nm},
      {"pin_load_N[4]", out.pin_load_N[3]},
      {"journal_load_N[5]", out.journal_load_N[4]},
      {"first.pitch_Nm", out.first.pitch_Nm},
      {"second.up_N", out.second.up_N},
      {"rotating.lateral_N", out.rotating.lateral_N},
      {"valve[1,3].lift_m", out.valve[0][2].lift_m},
      {"valve[2,4].velocity_m_s", out.valve[1][3].velocity_m_s},
      {"valve_cycle[2,1].seating_speed_m_s", out.valve_cycle[1][0].seating_speed_m_s},
      {"valve_cycle[1,4].contact_changes", out.valve_cycle[0][3].contact_changes},
  };
  for (const auto& [name, value] : expected) EXPECT_TRUE(fmu::same(unit.get(name), value)) << name;
  EXPECT_GT(unit.get("valve_cycle[2,1].seating_speed_m_s"), 0);
  EXPECT_EQ(fmu.model.by_name.count("displacement_m[5]"), 0u) << "the engine has four cylinders";
}

TEST(ResourceUri, IsAFileOfThisMachine) {
  const auto path_of = [](const char* uri, std::size_t room = 64) {
    char path[64];
    return crankloop::fmi::path_of_uri(uri, path, room) ? std::string(path) : "refused";
  };
  EXPECT_EQ(path_of("file:///tmp/a%20b/%C3%BC"), "/tmp/a b/\xC3\xBC");
  EXPECT_EQ(path_of("file:/tmp/a"), "/tmp/a");
  EXPECT_EQ(path_of("file://localhost/tmp/a"), "/tmp/a");
  EXPECT_EQ(path_of("file:///tmp/100%"), "/tmp/100%");
  EXPECT_EQ(path_of("file:///tmp/%zz%4"), "/tmp/%zz%4");
#if defined(_WIN32)
  EXPECT_EQ(path_of("file:///C:/a%20b"), "C:/a b");
#endif
  for (const char* bad :
       {"file://server/tmp/a", "file://", "file://local", "http:///tmp/a", "/tmp/a", "", "file:///a%00b"})
    EXPECT_EQ(path_of(bad), "refused") << bad;
  EXPECT_EQ(path_of(nullptr), "refused");
  EXPECT_EQ(path_of("file:/123456", 7), "refused") << "its end has no room";
  EXPECT_EQ(path_of("file:/12345", 7), "/12345");
}

// 60 teeth less two at 25 revolutions a second: the wheel's signal, as an importer sees it every 0.5 ms.
TEST(TriggerFmu, ShowsTheLastEightEdges) {
  const Fmu fmu(path_of("trigger_wheels", 3));
  Unit unit(fmu);
  ASSERT_NO_FATAL_FAILURE(unit.start(10));
  unit.set("speed_rad_s", 50 * std::acos(-1.0));
  double time_s = 10;
  double edges_before = 0;
  std::map<double, bool> seen;
  for (int k = 0; k < 2'000; ++k) {
    ASSERT_NO_FATAL_FAILURE(unit.step(time_s, 5e-4));
    time_s = 10 + (k + 1) * 5e-4;
    const double edges = unit.get("trigger[1].edges");
    ASSERT_LE(edges - edges_before, 8);
    double newer_s = time_s + 1e-9;
    for (int e = 1; e <= edges - edges_before; ++e) {
      const std::string index = "[" + std::to_string(e) + "]";
      const double at_s = unit.get("trigger[1].edge_s" + index);
      ASSERT_LE(at_s, newer_s);
      ASSERT_GT(at_s, time_s - 5e-4 - 1e-9);
      newer_s = at_s;
      seen[at_s] = unit.get("trigger[1].edge_rises" + index) != 0;
      if (e == 1) ASSERT_EQ(seen[at_s], unit.get("trigger[1].level") != 0);
    }
    edges_before = edges;
  }
  ASSERT_EQ(static_cast<double>(seen.size()), edges_before);
  EXPECT_NEAR(edges_before, 25 * 58 * 2, 3) << "one second";
  // Edges rise and fall in turn; a tooth and its gap are 6 degrees, two missing ones make 18.
  auto last = seen.begin();
  int gaps = 0;
  for (auto edge = std::next(last); edge != seen.end(); last = edge++) {
    ASSERT_NE(edge->second, last->second);
    const double apart_deg = (edge->first - last->first) * 25 * 360;
    const bool gap = apart_deg > 10;
    ASSERT_NEAR(apart_deg, gap ? 15 : 3, 0.01);
    gaps += gap ? 1 : 0;
  }
  EXPECT_NEAR(gaps, 25, 1);
}

}  // namespace
