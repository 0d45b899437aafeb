// A train of an engine file whose springs surge: its keys, what `valve` and `redline` say, and commands that step none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "crankloop/command_line/commands.hpp"
#include "crankloop/commands/redline/redline_search.hpp"
#include "crankloop/engine_file/following_springs.hpp"
#include "crankloop/files/units.hpp"
#include "crankloop/loops/run_loop.hpp"
#include "crankloop/loops/surge_force.hpp"
#include "crankloop/loops/valve_accuracy.hpp"
#include "crankloop/loops/valve_loop.hpp"
#include "support/engine_files.hpp"
#include "support/files.hpp"

namespace crankloop::program::surging_train_test {
namespace {

using support::kOhc125;

class SurgingTrain : public EngineFileTest {
 protected:
  /// The 125 with more lines for its valve.
  static std::string with(const std::string& lines) {
    return replaced(contents(kOhc125), "spring_preload_N = 205.8", lines + "\nspring_preload_N = 205.8");
  }
};

TEST_F(SurgingTrain, IsReadWithItsUnits) {
  const EngineFile file =
      read(with("surge_modes = 2\nsurge_damping_ratio = 0.02\nspring_active_g = 30\ninner_spring_N_per_mm = "
                "15\ninner_spring_g = 18"));
  const Valve& valve = file.definition().trains[0].valve;
  EXPECT_EQ(valve.surge_modes, 2);
  EXPECT_DOUBLE_EQ(valve.surge_damping_ratio, 0.02);
  EXPECT_DOUBLE_EQ(valve.spring_active_kg, 0.03);
  EXPECT_DOUBLE_EQ(valve.inner_spring_N_m, 15e3);
  EXPECT_DOUBLE_EQ(valve.inner_spring_kg, 0.018);
  EXPECT_EQ(read(contents(kOhc125)).definition().trains[0].valve.surge_modes, 0);
}

TEST_F(SurgingTrain, IsRefusedAtTheLineOfItsKey) {
  EXPECT_NE(refusal(with("surge_modes = 4")).find("surge_modes"), std::string::npos);
  EXPECT_NE(refusal(with("surge_modes = 1.5")).find("surge_modes"), std::string::npos);
  const std::string inner = refusal(with("surge_modes = 1\ninner_spring_N_per_mm = 50\ninner_spring_g = 10"));
  EXPECT_NE(inner.find("inner_spring_N_per_mm"), std::string::npos) << inner;
  EXPECT_NE(inner.find("contradicts another value"), std::string::npos) << inner;
}

TEST_F(SurgingTrain, FloatsEarlierThanOneWhoseSpringFollows) {
  const auto onset_rpm = [this](int modes) {
    const EngineFile file = read(with("surge_modes = " + std::to_string(modes)));
    return sweep_speeds(LoneValve(file, "intake"), speed_range(5000, 10000), 1, {}, {50e-6, 0.5, 0})
        .separation.speed_rpm;
  };
  const int following_rpm = onset_rpm(0);
  EXPECT_NEAR(following_rpm, 8557, 1);
  EXPECT_NEAR(onset_rpm(2), 6816, 30);  // the seventh harmonic of the lift is at 7000 rpm
}

TEST_F(SurgingTrain, SurgesAsMuchAsItsModesDrivenByTheTheoreticalLift) {
  // Away from resonance and float the valve's own motion hardly matters.
  const EngineFile file = read(with("surge_modes = 3"));
  const LoneValve valve(file, "intake");
  ValveLoop<double> loop(valve, 20e-6, {});
  double largest_N = 0;
  run_cycles<double>(loop, valve, 4500, 8, [&](const ValveTickOutput<double>& out) {
    largest_N = std::max(largest_N, std::abs(out.springs.surge_N));
  });
  const double driven_N = surge_over_cycle(LiftSlopes(valve.lift()), valve.valve(), 4500 * kRad_sPerRpm / 2).largest_N;
  EXPECT_NEAR(largest_N / driven_N, 1, 0.1) << driven_N;
}

TEST_F(SurgingTrain, IsWarnedOfWhereTheTickTakesItOutOfItsClass) {
  const EngineFile file = read(with("surge_modes = 2"));
  const LoneValve valve(file, "intake");
  EXPECT_TRUE(beyond_class(valve, 5000, 10e-6).empty());
  const auto lines = beyond_class(valve, 7000, 100e-6);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("surge of its springs"), std::string::npos) << lines[0];
  EXPECT_GT(expected_error_m(valve, 7000, 100e-6, {}), 0.1e-6);
}

TEST_F(SurgingTrain, IsRefusedForATickInWhichItWouldGrow) {
  const EngineFile file = read(with("surge_modes = 3"));
  try {
    ValveLoop<double> loop(LoneValve(file, "intake"), 200e-6, {});
    FAIL() << "accepted";
  } catch (const InputError& refused) {
    EXPECT_NE(std::string(refused.what()).find("surge_modes"), std::string::npos) << refused.what();
    EXPECT_NE(std::string(refused.what()).find("shorter tick"), std::string::npos) << refused.what();
  }
}

TEST_F(SurgingTrain, IsToldOfInSummaryAndCsv) {
  const auto printed_by = [](std::vector<std::string> words) {
    testing::internal::CaptureStdout();
    EXPECT_EQ(kValve.run(Arguments(kValve, words)), kSuccess);
    return testing::internal::GetCapturedStdout();
  };
  const std::string path =
      write("surging.ini", with("surge_modes = 2\ninner_spring_N_per_mm = 15\ninner_spring_g = 18"));
  const std::string csv = folder_ / "valve.csv";
  const std::string summary = printed_by({path, "--rpm", "6000", "--csv", csv});
  EXPECT_NE(summary.find("springs surge, 2 modes each"), std::string::npos) << summary;
  // The largest and least of the summary are those of the rows.
  std::istringstream rows(contents(csv));
  std::string row;
  std::getline(rows, row);
  ASSERT_NE(row.find(",regime,spring_force_N,spring_surge_N"), std::string::npos) << row;
  double largest_N = 0, least_N = 1e9, most_N = 0;
  while (std::getline(rows, row)) {
    const std::size_t surge = row.rfind(','), force = row.rfind(',', surge - 1);
    most_N = std::max(most_N, std::stod(row.substr(force + 1)));
    least_N = std::min(least_N, std::stod(row.substr(force + 1)));
    largest_N = std::max(largest_N, std::abs(std::stod(row.substr(surge + 1))));
  }
  const auto number = [&summary](const std::string& name) {
    const std::size_t at = summary.find("\n" + name + " = ");
    return at == std::string::npos ? 0 : std::stod(summary.substr(at + name.size() + 4));
  };
  EXPECT_NEAR(number("spring_surge_force"), largest_N, 1e-3 * largest_N);
  EXPECT_NEAR(number("least_spring_force"), least_N, 1e-3 * most_N);
  EXPECT_NEAR(number("largest_spring_force"), most_N, 1e-3 * most_N);
  EXPECT_GT(largest_N, 50);
  EXPECT_THROW(kValve.run(Arguments(kValve, {path, "--integrator", "textbook"})), UsageError);
}

TEST_F(SurgingTrain, HasItsRedlineBesideThatOfSpringsThatFollow) {
  const auto printed_by = [](const std::vector<std::string>& words) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    EXPECT_EQ(kRedline.run(Arguments(kRedline, words)), kSuccess);
    static_cast<void>(testing::internal::GetCapturedStderr());
    return testing::internal::GetCapturedStdout();
  };
  const auto line = [](const std::string& text, const std::string& name) {
    const std::size_t at = text.find("\n" + name + " = ");
    return at == std::string::npos ? "no " + name
                                   : text.substr(at + name.size() + 4, text.find('\n', at + 1) - at - name.size() - 4);
  };
  const std::string report = folder_ / "redline.html";
  const std::vector<std::string> speeds{"--from", "6000", "--to", "9500"};
  const auto redline_of = [&](const std::string& file, std::vector<std::string> more) {
    std::vector<std::string> words{file};
    words.insert(words.end(), speeds.begin(), speeds.end());
    words.insert(words.end(), more.begin(), more.end());
    return printed_by(words);
  };
  const std::string surging = redline_of(write("surging.ini", with("surge_modes = 2")), {"--report", report});
  const std::string plain = redline_of(write("plain.ini", contents(kOhc125)), {});
  EXPECT_EQ(line(surging, "separation_onset_without_surge"), line(plain, "separation_onset"));
  EXPECT_EQ(line(surging, "bounce_onset_without_surge"), line(plain, "bounce_onset"));
  EXPECT_LT(std::stod(line(surging, "separation_onset")), 0.9 * std::stod(line(plain, "separation_onset")));
  EXPECT_EQ(plain.find("without_surge"), std::string::npos);
  const std::string page = contents(report);
  EXPECT_NE(page.find("springs follow"), std::string::npos);
  EXPECT_NE(page.find("Separation without surge"), std::string::npos);
}

TEST_F(SurgingTrain, FollowsItsValveInReadyMadeScenesWithAWarning) {
  const EngineFile file = read(with("surge_modes = 2"));
  const auto lines = warnings_about_springs_that_follow(file);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("[valve intake] surge_modes: springs follow their valves"), std::string::npos) << lines[0];
  EXPECT_TRUE(warnings_about_springs_that_follow(read(contents(kOhc125))).empty());
  const Operation operation{7000, 100e-6};
  FixedStepLoop<float> surging(file.definition(), operation);
  FixedStepLoop<float> following(with_springs_that_follow(file.definition()), operation);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(surging.step().valve[0][0].lift_m, following.step().valve[0][0].lift_m);
}

TEST_F(SurgingTrain, IsWarnedOfWhereAStudyOrAComparisonLetsItsSpringFollow) {
  const auto told_by = [](const Command& command, const std::vector<std::string>& words) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    EXPECT_EQ(command.run(Arguments(command, words)), kSuccess);
    static_cast<void>(testing::internal::GetCapturedStdout());
    return testing::internal::GetCapturedStderr();
  };
  const std::string plain = write("plain.ini", contents(kOhc125));
  const std::string surging = write("surging.ini", with("surge_modes = 2"));
  const std::string varied = "valve.surge_modes=0:1:2";
  EXPECT_NE(told_by(kStudy, {plain, "--vary", varied, "--of", "balance.power_kW"}).find("changes nothing that run"),
            std::string::npos);
  EXPECT_EQ(told_by(kStudy, {plain, "--vary", varied, "--of", "valve.max_lift"}).find("changes nothing"),
            std::string::npos);
  EXPECT_NE(told_by(kRun, {plain, "--against", surging}).find("surging.ini: warning: [valve intake] surge_modes"),
            std::string::npos);
}

}  // namespace
}  // namespace crankloop::program::surging_train_test
