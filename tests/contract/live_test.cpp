// `crankloop live`, run as a user runs it: with the example's controller, with a controller that errs or dies, until a
// signal, with bad arguments. Times are this machine's, which may be busy: they are looked for, never bounded.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <crankloop/faults.hpp>

#include "support/live_bench.hpp"

namespace crankloop::port::live_test {
namespace {

using Live = LiveBench;

TEST_F(Live, StartsAndIdlesUnderTheExamplesController) {
  constexpr double kTarget_rpm = 800;
  // The controller is integral: the mean is off only by what its last disturbance left, the end of the run-up 2 s
  // before.
  constexpr double kMean_rpm = 0.01 * kTarget_rpm;
  // Ignition by ignition the speed swings, and the smoothed one a quarter of that; a controller held up by the machine
  // adds to it.
  constexpr double kPeak_rpm = 0.1 * kTarget_rpm;
  Process engine(live({"--tick-us", "1000", "--seconds", "30", "--shared", block_path(), "--silent-ms", "5000"}),
                 in_folder("live.txt"));
  Process controller({CRANKLOOP_IDLE_CONTROL, block_path(), "--target-rpm", "800", "--seconds", "5"},
                     in_folder("control.txt"));
  EXPECT_EQ(controller.wait(), 0) << controller.output();
  engine.signal(SIGINT);
  EXPECT_EQ(engine.wait(), 0) << engine.output();

  const auto held = values_of(controller.output());
  EXPECT_NEAR(std::stod(held.at("mean_speed")), kTarget_rpm, kMean_rpm) << controller.output();
  EXPECT_LE(std::stod(held.at("peak_error")), kPeak_rpm) << controller.output();
  const auto ran = values_of(engine.output());
  EXPECT_EQ(ran.at("controller"), "seen");
  EXPECT_EQ(ran.at("faulty_ticks"), "0");
}

TEST_F(Live, IdlesByTheThrottleWhereTheEngineBreathes) {
  constexpr double kTarget_rpm = 800;
  // Torque follows the throttle by the time that the manifold takes to fill, so the controller is slow: of its run-up
  // to 1700 rpm a few per cent are left after 6 s.
  constexpr double kMean_rpm = 0.05 * kTarget_rpm;
  constexpr double kPeak_rpm = 0.15 * kTarget_rpm;
  Process engine({CRANKLOOP_PROGRAM, "live", CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini", "--tick-us", "500",
                  "--seconds", "60", "--shared", block_path(), "--silent-ms", "5000"},
                 in_folder("live.txt"));
  Process controller({CRANKLOOP_IDLE_CONTROL, block_path(), "--target-rpm", "800", "--seconds", "12"},
                     in_folder("control.txt"));
  const std::optional<SharedBlock> block = open_running();
  ASSERT_TRUE(block);
  EXPECT_EQ((*block)->breathes, 1u);
  EXPECT_EQ(controller.wait(), 0) << controller.output();
  const LiveOutputs idling = outputs_of(*block);
  engine.signal(SIGINT);
  EXPECT_EQ(engine.wait(), 0) << engine.output();

  const auto held = values_of(controller.output());
  EXPECT_NEAR(std::stod(held.at("mean_speed")), kTarget_rpm, kMean_rpm) << controller.output();
  EXPECT_LE(std::stod(held.at("peak_error")), kPeak_rpm) << controller.output();
  // A throttled engine: a quarter of an atmosphere in the manifold, an eighth of the charge.
  EXPECT_GT(idling.intake_Pa, 15e3);
  EXPECT_LT(idling.intake_Pa, 45e3);
  EXPECT_GT(idling.trapped_air_kg, 40e-6);
  EXPECT_LT(idling.trapped_air_kg, 120e-6);
  EXPECT_EQ(values_of(engine.output()).at("faulty_ticks"), "0");
}

TEST_F(Live, TellsTimesAndDeadlinesOfEveryTick) {
  const std::string csv = in_folder("histogram.csv");
  Process engine(live({"--tick-us", "500", "--seconds", "0.5", "--from-rpm", "900", "--histogram", csv}),
                 in_folder("live.txt"));
  ASSERT_EQ(engine.wait(), 0) << engine.output();
  const auto values = values_of(engine.output());
  for (const char* name : {"machine", "kernel", "scheduler", "memory", "processor", "late_ticks", "missed_deadlines",
                           "longest_backlog", "model_share_mean", "model_share_max", "final_speed", "mean_torque"}) {
    EXPECT_EQ(values.count(name), 1u) << name;
  }
  EXPECT_EQ(values.at("ticks"), "1000");
  EXPECT_GE(std::stod(values.at("wall_time")), 0.5);
  for (const std::string name : {"wakeup_latency", "model_time", "work_time"}) {
    double before_us = 0;
    for (const char* quantile : {"_p50", "_p99", "_p99_9", "_p99_99", "_max"}) {
      const double time_us = std::stod(values.at(name + quantile));
      EXPECT_GE(time_us, before_us) << name << quantile;
      before_us = time_us;
    }
    EXPECT_GT(before_us, 0) << name;
  }

  std::istringstream rows(contents(csv));
  std::string row;
  ASSERT_TRUE(std::getline(rows, row));
  EXPECT_EQ(row, "from_us,below_us,wakeup_ticks,model_ticks,work_ticks");
  std::vector<double> sums(3, 0);
  while (std::getline(rows, row)) {
    std::istringstream cells(row);
    std::string cell;
    for (int column = 0; std::getline(cells, cell, ','); ++column) {
      if (column >= 2) sums[static_cast<std::size_t>(column - 2)] += std::stod(cell);
    }
  }
  EXPECT_EQ(sums, std::vector<double>(3, 1000.0));
}

TEST_F(Live, KeepsEachOfItsRecordingsWhateverBecomesOfTheRest) {
  const std::string trace = in_folder("t.vcd"), histogram = in_folder("h.csv");
  const std::vector<std::string> same{"--seconds", "0.2", "--from-rpm", "900", "--trace", trace, "--histogram"};
  const auto with_histogram = [&](const std::string& path) {
    std::vector<std::string> options = same;
    options.push_back(path);
    return live(options);
  };
  Process untold(with_histogram(histogram), "/dev/full");  // its summary finds no room
  EXPECT_EQ(untold.wait(), 1);
  EXPECT_NE(contents(trace).find("$enddefinitions"), std::string::npos);
  EXPECT_NE(contents(histogram).find("from_us,below_us"), std::string::npos);

  std::filesystem::remove(trace);
  Process lost(with_histogram("/dev/full"), in_folder("live.txt"));
  EXPECT_EQ(lost.wait(), 1);
  EXPECT_NE(contents(trace).find("$enddefinitions"), std::string::npos);
  EXPECT_EQ(values_of(lost.output()).at("ticks"), "200") << lost.output();
  EXPECT_NE(lost.output().find("crankloop: /dev/full cannot be written: "), std::string::npos) << lost.output();
}

TEST_F(Live, TurnsOnWithoutFuelWhenItsControllerFallsSilent) {
  Process engine(live({"--seconds", "600", "--from-rpm", "1000", "--shared", block_path(), "--silent-ms", "50"}),
                 in_folder("live.txt"));
  const std::optional<SharedBlock> block = open_running();
  ASSERT_TRUE(block) << engine.output();
  EXPECT_EQ((*block)->cylinders, 4u);
  EXPECT_EQ((*block)->tick_s, 1e-3);

  LiveInputs in;
  in.load_ratio = 0.3;
  in.external_torque_Nm = 10;
  (*block)->inputs.write(in);
  const std::uint32_t written = (*block)->inputs.sequence();
  EXPECT_TRUE(comes_true([&] { return outputs_of(*block).inputs_sequence == written; }));
  EXPECT_TRUE(comes_true([&] { return outputs_of(*block).flags == (kControllerSeen | kControllerSilent); }));

  // No load either, which would turn an engine without fuel backwards: it comes to rest and stays.
  EXPECT_TRUE(comes_true([&] { return std::abs(outputs_of(*block).speed_rad_s) < 1; }));
  EXPECT_GE(outputs_of(*block).speed_rad_s, -1);

  (*block)->inputs.write(in);
  EXPECT_TRUE(comes_true([&] {
    (*block)->inputs.write(in);
    return outputs_of(*block).flags == kControllerSeen;
  }));
  engine.signal(SIGTERM);
  EXPECT_EQ(engine.wait(), 0);
  EXPECT_GE(std::stoi(values_of(engine.output()).at("controller_silences")), 1);
  EXPECT_EQ((*block)->state, LiveState::ended);
  EXPECT_FALSE(std::filesystem::exists(block_path()));
}

TEST_F(Live, SaysWhichInputsOfAControllerAreNone) {
  Process engine(live({"--seconds", "600", "--from-rpm", "1000", "--shared", block_path(), "--silent-ms", "60000"}),
                 in_folder("live.txt"));
  const std::optional<SharedBlock> block = open_running();
  ASSERT_TRUE(block) << engine.output();
  LiveInputs in;
  in.load_ratio = std::numeric_limits<double>::quiet_NaN();
  in.external_torque_Nm = 1e300;  // more than a float holds
  (*block)->inputs.write(in);
  EXPECT_TRUE(comes_true([&] { return outputs_of(*block).faults == (kFaultLoadRatio | kFaultExternalTorque); }));
  EXPECT_TRUE(std::isfinite(outputs_of(*block).speed_rad_s));
  (*block)->inputs.write(LiveInputs{});
  EXPECT_TRUE(comes_true([&] { return outputs_of(*block).faults == 0; }));
  engine.signal(SIGINT);
  EXPECT_EQ(engine.wait(), 0);
  EXPECT_GT(std::stoi(values_of(engine.output()).at("faulty_ticks")), 0);
}

TEST_F(Live, EndsWithItsFiguresAndALineWhenItsBlockIsTakenAway) {
  const auto truncate = [&] {
    std::filesystem::resize_file(block_path(), 0);
  };  // its pages are gone: who touches them gets SIGBUS
  const auto shorten = [&] {
    std::filesystem::resize_file(block_path(), 100);
  };  // its page stays, and the magic with it
  const auto cut_off = [&] {
    std::filesystem::resize_file(block_path(), 4096);
  };  // the fixed part stays, the ring's last pages are gone
  const auto overwrite = [&] {
    const std::string zeros(std::filesystem::file_size(block_path()), '\0');  // before it is truncated
    std::ofstream(block_path()) << zeros;
  };  // as `cp` would: truncated, then as large again
  for (const std::function<void()>& take_away : {std::function<void()>(truncate), std::function<void()>(shorten),
                                                 std::function<void()>(cut_off), std::function<void()>(overwrite)}) {
    Process engine(live({"--seconds", "600", "--from-rpm", "1000", "--shared", block_path()}), in_folder("live.txt"));
    {
      const std::optional<SharedBlock> block = open_running();
      ASSERT_TRUE(block) << engine.output();
    }
    take_away();
    EXPECT_EQ(engine.wait(), 1);
    const auto values = values_of(engine.output());
    EXPECT_EQ(values.count("ticks"), 1u) << engine.output();
    EXPECT_NE(engine.output().find("crankloop: " + block_path() + ": was truncated or overwritten after "),
              std::string::npos)
        << engine.output();
    EXPECT_FALSE(std::filesystem::exists(block_path()));
  }
}

TEST_F(Live, EndsWithItsFiguresWhenItsTerminalIsClosed) {
  Process engine(live({"--seconds", "600", "--from-rpm", "1000", "--shared", block_path()}), in_folder("live.txt"));
  ASSERT_TRUE(open_running()) << engine.output();
  engine.signal(SIGHUP);
  EXPECT_EQ(engine.wait(), 0);
  EXPECT_EQ(values_of(engine.output()).count("ticks"), 1u) << engine.output();
  EXPECT_FALSE(std::filesystem::exists(block_path()));
}

TEST_F(Live, StartsAgainAfterAnyDeathOnTheSameBlock) {
  std::ofstream(block_path()).close();  // one that died before its block had a size
  for (int i = 0; i < 2; ++i) {
    Process engine(live({"--seconds", "600", "--from-rpm", "1000", "--shared", block_path()}), in_folder("live.txt"));
    ASSERT_TRUE(open_running()) << engine.output();
    engine.signal(SIGKILL);
    EXPECT_EQ(engine.wait(), -SIGKILL);
  }
  Process engine(live({"--seconds", "0.01", "--from-rpm", "1000", "--shared", block_path()}), in_folder("live.txt"));
  EXPECT_EQ(engine.wait(), 0) << engine.output();
}

TEST_F(Live, RefusesWhatCannotBeRunInOneLineAndAUsage) {
  std::ofstream(block_path()) << "somebody's notes\n";
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--tick-us", "3000"}, "crankloop live: --tick-us: 3000 is out of range; allowed: 1 to 2000\n"},
      {{"--tick-us", "33.33333"}, "crankloop live: --tick-us 33.33333 is not a whole number of nanoseconds"},
      {{"--seconds", "0"}, "crankloop live: --seconds: 0 is out of range; allowed: above 0"},
      {{"--from-rpm", "61000"}, "crankloop live: 61000 rpm is beyond the engine's max_rpm of 3000"},
      {{"--cpu", "1023", "--seconds", "0.01"}, "crankloop live: --cpu 1023: this process may not use such a processor"},
      {{"--shared", block_path()}, block_path() + ": exists and is no block of crankloop live"},
  };
  for (const auto& [options, message] : cases) {
    Process refused(live(options), in_folder("refused.txt"));
    EXPECT_EQ(refused.wait(), 2) << message;
    EXPECT_EQ(refused.output().substr(0, message.size()), message);
  }
  EXPECT_EQ(contents(block_path()), "somebody's notes\n");
}

TEST_F(Live, FailsAsAnyOutputWhereItsBlockCannotBeCreated) {
  const std::string path = folder_ / "none/block";
  Process failed(live({"--shared", path}), in_folder("failed.txt"));
  EXPECT_EQ(failed.wait(), 1);
  EXPECT_EQ(failed.output(), "crankloop: " + path + ": cannot be created: No such file or directory\n");
}

}  // namespace
}  // namespace crankloop::port::live_test
