// `crankloop run --free`: what it prints, its CSV and VCD against each other and against the angle turned, its bad
// arguments.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "crankloop/engine_file/engine_file.hpp"
#include "crankloop/files/number.hpp"
#include "support/columns.hpp"
#include "support/ripple_theory.hpp"
#include "support/run_command.hpp"
#include "support/units.hpp"
#include "support/vcd_dump.hpp"

namespace crankloop::program::free_run_test {
namespace {

using support::Columns;

/// What a signal did: its level to begin with, and when it changed.
struct Signal {
  bool first = false;
  std::vector<double> times_s;
};

class FreeRunCommand : public RunCommand {
 protected:
  /// Checks along the way that each tick's level is that after its edges.
  static Signal by_csv(const Columns& csv, const std::string& wheel) {
    Signal signal;
    for (std::size_t row = 0; row < csv.rows(); ++row) {
      const std::vector<std::string> times = split_at(csv.text(row, wheel + "_edge_times_s"), ' ');
      EXPECT_EQ(csv.text(row, wheel + "_edges"), std::to_string(times.size()));
      for (const std::string& time : times) signal.times_s.push_back(std::stod(time));
      const bool level = csv.text(row, wheel + "_level") == "1";
      if (row == 0) signal.first = level != (times.size() % 2 == 1);
      EXPECT_EQ(level, signal.first != (signal.times_s.size() % 2 == 1)) << row;
      for (const std::string& time : times) {
        EXPECT_LE(std::stod(time), csv.number(row, "time_s") + 1e-12);
        EXPECT_GE(std::stod(time), csv.number(row, "time_s") - kTick_s - 1e-12);
      }
    }
    return signal;
  }

  static constexpr double kTick_s = 100e-6;
};

/// A run of the sample that is as fast at its end as it began: its brake takes what friction leaves of the mean torque.
void expect_ripple_of_theory(const std::string& summary, const EngineDefinition& engine, double load_ratio,
                             std::uint32_t cut) {
  const tick_test::RippleTheory theory(engine, load_ratio, cut);
  const auto value = [&summary](const std::string& name) { return line(summary, name).first; };
  const double mean_rad_s = value("cycle_speed") * tick_test::kPi / 30;
  double at_firing_rad_s = mean_rad_s;
  for (int i = 0; i < 3; ++i) at_firing_rad_s *= mean_rad_s / theory.by_harmonics(at_firing_rad_s).mean_rad_s;
  const tick_test::Ripple expected = theory.by_harmonics(at_firing_rad_s);
  EXPECT_NEAR(value("cycle_irregularity") / expected.irregularity_ratio, 1, 0.01);
  const double largest = *std::max_element(expected.amplitude_rad_s, expected.amplitude_rad_s + 13);
  for (int i = 1; i < 13; ++i) {
    const std::string name = "speed_order_" + shortest(i / 2.0);
    EXPECT_NEAR(value(name), expected.amplitude_rad_s[i], 0.01 * expected.amplitude_rad_s[i] + 1e-3 * largest) << name;
  }
}

TEST_F(FreeRunCommand, PrintsTheIrregularityAndHarmonicsOfTorqueOverInertia) {
  const EngineFile file = read_engine_file(kSample, {});
  const EngineDefinition& engine = file.definition();
  constexpr double kLoadRatio = 0.3;
  for (const double rpm : {800.0, 2000.0}) {
    for (const std::uint32_t cut : {0u, 1u}) {
      const double w = rpm * tick_test::kPi / 30;
      const Friction& f = engine.friction;
      const double per_Pa = swept_volume_m3(engine.crank) * engine.layout.cylinders / (4 * tick_test::kPi);
      const double friction_Nm = (f.constant_Pa + w * (f.linear_Pa_s + w * f.quadratic_Pa_s2)) * per_Pa;
      const double brake_Nm = tick_test::RippleTheory(engine, kLoadRatio, cut).mean_gas_Nm() - friction_Nm;
      std::vector<std::string> words{
          kSample,        "--free",           "--from-rpm", shortest(rpm), "--load-ratio", shortest(kLoadRatio),
          "--machine-Nm", shortest(brake_Nm), "--seconds",  "0.5",         "--real",       "double"};
      if (cut != 0) words.insert(words.end(), {"--cut", "1"});
      SCOPED_TRACE(shortest(rpm) + " rpm" + (cut != 0 ? ", cylinder 1 cut" : ""));
      const std::string summary = run(words);
      expect_ripple_of_theory(summary, engine, kLoadRatio, cut);
    }
  }
}

TEST_F(FreeRunCommand, StartsThe495AndSaysWhatBecameOfIt) {
  for (const char* real : {"float", "double"}) {
    const std::string summary =
        run({kSample, "--free", "--starter", "--load-ratio", "0.3", "--seconds", "2", "--real", real});
    EXPECT_EQ(line(summary, "ticks").first, 20000);
    EXPECT_EQ(line(summary, "reversals").first, 0);
    EXPECT_EQ(line(summary, "faulty_ticks").first, 0);
    EXPECT_GT(line(summary, "speed_at_end").first, 700);  // beyond what the starter turns
    EXPECT_EQ(line(summary, "cycle_speed").second, "rpm");
    EXPECT_GT(line(summary, "work_of_starter").first, 0);
    // In - out = kept, each figure by its own way; the loop keeps it to rounding, and the figures have six digits.
    const double left_J = line(summary, "work_of_gas").first + line(summary, "work_of_starter").first -
                          line(summary, "lost_to_friction").first - line(summary, "taken_by_load").first -
                          line(summary, "change_of_kinetic_energy").first;
    EXPECT_LT(std::fabs(left_J), 1e-5 * line(summary, "work_of_gas").first);
    EXPECT_LT(std::fabs(line(summary, "energy_defect").first), 1e-6);
    // Order 2 of four cylinders that all fire is the ripple; half orders are what the start has left.
    EXPECT_GT(line(summary, "speed_order_2").first, 50 * line(summary, "speed_order_0.5").first);
    // 58 teeth in a turn of the crank, each with two edges; half a moon's in two turns.
    EXPECT_NEAR(line(summary, "crank_edges").first, line(summary, "turned").first * 116, 8);
    EXPECT_NEAR(line(summary, "cam_edges").first, line(summary, "turned").first, 1);
    EXPECT_EQ(line(summary, "crank_edges_lost").first, 0);
  }
}

TEST_F(FreeRunCommand, SaysWhereItsSpeedLimitTookEnergy) {
  const std::vector<std::string> words = {engine_up_to("2500"), "--free", "--machine-Nm", "0",
                                          "--from-rpm",         "2000",   "--load-ratio", "1",
                                          "--seconds",          "1",      "--report",     path("report.html")};
  const std::string summary = run(words);
  EXPECT_NE(summary.find("  # overspeed\n"), std::string::npos) << summary;
  EXPECT_GT(line(summary, "energy_defect").first, 0.1);
  EXPECT_NE(summary.find("what the speed limit took"), std::string::npos) << summary;
  EXPECT_NE(contents(path("report.html")).find("taken by the speed limit"), std::string::npos);
}

TEST_F(FreeRunCommand, ABrakeOfConstantTorqueTakesThePlaceOfTheFiles) {
  // At rest the brake holds whatever the gas of a cold cylinder pushes: friction 90 kPa and 1000 Nm.
  const std::string held = run({kSample, "--free", "--machine-Nm", "1000", "--starter", "--seconds", "0.2"});
  EXPECT_EQ(line(held, "turned").first, 0);
  const std::string summary =
      run({kSample, "--free", "--from-rpm", "1500", "--machine-Nm", "50", "--load-ratio", "0.5", "--seconds", "1"});
  EXPECT_EQ(line(summary, "cycle_load").first, 50);
  EXPECT_NEAR(line(summary, "taken_by_load").first, 50 * line(summary, "turned").first * 2 * support::kPi,
              1e-4 * line(summary, "taken_by_load").first);
}

/// The books were once those of an engine that never misfires, 8 % off here.
TEST_F(FreeRunCommand, BooksTheWorkOfAnEngineThatMisfires) {
  const std::string report = path("report.html");
  const std::string summary = run({kSample, "--free", "--from-rpm", "2000", "--seconds", "2", "--misfire",
                                   "cylinder=2 every=3", "--report", report});
  const double taken = line(summary, "lost_to_friction").first + line(summary, "taken_by_load").first +
                       line(summary, "change_of_kinetic_energy").first;
  EXPECT_NEAR(line(summary, "work_of_gas").first, taken, 1e-5 * taken);
  EXPECT_LT(std::fabs(line(summary, "energy_defect").first), 1e-6);
  EXPECT_EQ(contents(report).find("independently of the simulation loop"), std::string::npos);
}

TEST_F(FreeRunCommand, SaysThatCyclesWhichAreCutCountAsTheRuleHasThem) {
  const std::vector<std::string> words{kSample,     "--free", "--from-rpm", "1500",
                                       "--seconds", "1",      "--misfire",  "cylinder=2 every=3"};
  const std::string remark = "by the rule: cycles that were cut count too";
  EXPECT_EQ(run(words).find(remark), std::string::npos);
  std::vector<std::string> cut = words;
  cut.insert(cut.end(), {"--cut", "2"});
  EXPECT_NE(run(cut).find("cylinder_2_misfires = 4  # " + remark), std::string::npos) << run(cut);
}

/// 10 Nm move nothing, 80 against gas compress a cylinder and are turned back.
TEST_F(FreeRunCommand, SaysThatAStarterIsTooWeak) {
  const std::string remark = "the starter does not turn the engine over: [starter] stall_Nm is too small";
  const std::pair<const char*, const char*> weak[] = {{kSample, "10"},
                                                      {CRANKLOOP_SOURCE_DIR "/tools/engines/diesel_495_gas.ini", "80"}};
  for (const auto& [sample, torque_Nm] : weak) {
    std::string text = contents(sample);
    const std::size_t at = text.find("stall_Nm");
    text.replace(at, text.find('\n', at) - at, std::string("stall_Nm = ") + torque_Nm);
    std::ofstream(path("weak.ini")) << text;
    const std::string summary = run({path("weak.ini"), "--free", "--starter", "--seconds", "1"});
    EXPECT_NE(summary.find(remark), std::string::npos) << summary;
  }
  EXPECT_EQ(run({kSample, "--free", "--seconds", "1"}).find(remark), std::string::npos);
  EXPECT_EQ(run({kSample, "--free", "--starter", "--seconds", "0.01"}).find(remark), std::string::npos);
}

TEST_F(FreeRunCommand, WarnsOfAFaultThatBeginsAfterTheEnd) {
  std::ofstream(path("late.ini")) << contents(kSample)
                                  << "[fault x]\ntrigger = crank\nstuck = low\nstart_s = 2\nend_s = 3\n";
  const std::vector<std::string> words{path("late.ini"), "--free", "--from-rpm", "1500", "--seconds"};
  const auto warned = [&](const char* seconds) {
    std::vector<std::string> all = words;
    all.emplace_back(seconds);
    testing::internal::CaptureStderr();
    run(all);
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_NE(warned("1").find("[fault x] begins at 2 s, after the end of --seconds 1"), std::string::npos);
  EXPECT_EQ(warned("2.1"), "");
}

/// Twice the same brake: of the options, and of a controller's input.
TEST_F(FreeRunCommand, CountsAnExternalTorqueAsLoad) {
  std::ofstream(path("in.csv")) << "time_s,external_torque_Nm\n0,50\n9,50\n";
  const auto braked = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{kSample, "--free", "--from-rpm", "1500", "--load-ratio", "0.5", "--seconds", "1"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  const std::string by_option = braked({"--machine-Nm", "50"});
  const std::string by_input = braked({"--machine-Nm", "0", "--inputs", path("in.csv")});
  EXPECT_NEAR(line(by_input, "cycle_load").first, 50, 1e-3);
  EXPECT_NEAR(line(by_input, "cycle_torque").first, line(by_option, "cycle_torque").first, 1e-2);
}

TEST_F(FreeRunCommand, ACutCylinderShowsInHalfOrderWhicheverItIs) {
  double amplitude = 0;
  for (const char* cut : {"1", "4"}) {
    const std::string summary = run({kSample, "--free", "--from-rpm", "1500", "--cut", cut, "--seconds", "1"});
    EXPECT_GT(line(summary, "speed_order_0.5").first, line(summary, "speed_order_2").first);
    if (amplitude != 0) {
      EXPECT_NEAR(line(summary, "speed_order_0.5").first, amplitude, 0.02 * amplitude);
    }
    amplitude = line(summary, "speed_order_0.5").first;
  }
  // Two that fire a turn apart leave no half order but order 1.
  const std::string even = run({kSample, "--free", "--from-rpm", "1500", "--cut", "1,4", "--seconds", "1"});
  EXPECT_LT(line(even, "speed_order_0.5").first, 0.02 * amplitude);
  EXPECT_GT(line(even, "speed_order_1").first, amplitude / 2);
}

TEST_F(FreeRunCommand, HashesEveryTickWithWhatAHandDoes) {
  const auto hash_of = [](const std::vector<std::string>& options) {
    std::vector<std::string> words{kSample, "--free", "--from-rpm", "900", "--hash"};
    words.insert(words.end(), options.begin(), options.end());
    for (const std::string& text : split_at(run(words), '\n'))
      if (text.rfind("hash = 0x", 0) == 0) return text.substr(0, 25);
    return std::string();
  };
  const std::string hash = hash_of({"--seconds", "0.1"});
  EXPECT_EQ(hash.size(), 25u);
  EXPECT_EQ(hash_of({"--seconds", "0.1"}), hash);
  EXPECT_NE(hash_of({"--seconds", "0.1001"}), hash);
  EXPECT_NE(hash_of({"--seconds", "0.1", "--cut", "1"}), hash);
  EXPECT_EQ(hash_of({"--seconds", "0.1", "--starter"}), hash);  // it free-wheels at this speed
  EXPECT_NE(hash_of({"--seconds", "0.1", "--load-ratio", "0.5"}), hash);
  EXPECT_NE(hash_of({"--seconds", "0.1", "--real", "double"}), hash);
}

TEST_F(FreeRunCommand, VcdAndCsvTellTheSameSignals) {
  for (const char* from_rpm : {"0", "700", "-90"}) {
    run({kSample, "--free", "--from-rpm", from_rpm, "--starter", "--load-ratio", "0.3", "--seconds", "0.7", "--csv",
         path("run.csv"), "--vcd", path("run.vcd")});
    const Columns csv(path("run.csv"));
    ASSERT_EQ(csv.rows(), 7000u);
    const Dump dump = read_dump(path("run.vcd"));
    EXPECT_EQ(dump.end_ns, 700'000'000);
    std::map<std::string, std::vector<Dump::Change>> changes;
    for (const Dump::Change& change : dump.changes) changes[change.name].push_back(change);
    for (const char* wheel : {"crank", "cam"}) {
      const Signal signal = by_csv(csv, wheel);
      const std::vector<Dump::Change>& seen = changes.at(wheel);
      ASSERT_EQ(seen.size(), signal.times_s.size() + 1) << wheel << " from " << from_rpm;
      EXPECT_EQ(seen[0].value != 0, signal.first);
      for (std::size_t i = 0; i < signal.times_s.size(); ++i) {
        EXPECT_NEAR(static_cast<double>(seen[i + 1].time_ns), signal.times_s[i] * 1e9,
                    0.51 + 1e-3);  // whole ns; CSV has 12 digits
      }
    }
    const std::vector<Dump::Change>& speed = changes.at("speed_rpm");
    EXPECT_FLOAT_EQ(static_cast<float>(speed.back().value),
                    static_cast<float>(csv.number(csv.rows() - 1, "speed_rpm")));
  }
}

TEST_F(FreeRunCommand, SaysHowManyEdgesItHadNoRoomFor) {
  // 2 ms at 20 000 rpm are two thirds of a turn: 77 edges of the crank's wheel, and room for 32.
  const std::string summary =
      run({engine_up_to("30000"), "--free", "--from-rpm", "20000", "--tick-us", "2000", "--seconds", "0.02"});
  EXPECT_EQ(line(summary, "crank_edges_lost").first, line(summary, "crank_edges").first - 10 * 32);
  EXPECT_NEAR(line(summary, "crank_edges").first, line(summary, "turned").first * 116, 8);
  EXPECT_NE(summary.find("\nfaulty_ticks = 10  # trigger edges\n"), std::string::npos) << summary;
}

TEST_F(FreeRunCommand, AReportHasThePartsThatThereAre) {
  run({kSample, "--free", "--starter", "--seconds", "1", "--cut", "3", "--report", path("report.html")});
  const std::string page = contents(path("report.html"));
  for (const char* words :
       {"Over the run", "Over the last cycles", "Harmonics of the speed", "Torque", "where it is still for longest",
        "Energy over the run", "without cylinder 3", "495 diesel, started and running free", "from tooth to tooth",
        "Assumptions", "The cylinder pressure is not measured: it is synthesised"}) {
    EXPECT_NE(page.find(words), std::string::npos) << words;
  }
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_LT(page.find("Mean speed"), page.find("Speed at the end"));            // what a reader asks first
  run({kSample, "--free", "--seconds", "0.1", "--report", path("rest.html")});  // nothing turns it
  EXPECT_NE(contents(path("rest.html")).find("No whole cycle of 720 deg"), std::string::npos);
}

TEST_F(FreeRunCommand, AnEngineWithoutPressureKeepsItsEnergyUntilABrakeTakesIt) {
  const std::string coasting = run({engine_without_pressure(), "--free", "--from-rpm", "500", "--seconds", "3"});
  EXPECT_EQ(line(coasting, "work_of_gas").first, 0);
  EXPECT_LT(std::fabs(line(coasting, "change_of_kinetic_energy").first), 1e-2);  // of some 900 J, in float
  const std::string braked =
      run({engine_without_pressure(), "--free", "--from-rpm", "500", "--machine-Nm", "20", "--seconds", "3"});
  EXPECT_EQ(line(braked, "speed_at_end").first, 0);
  EXPECT_NEAR(line(braked, "taken_by_load").first, -line(braked, "change_of_kinetic_energy").first, 1e-2);
}

TEST_F(FreeRunCommand, OneOutputMayBeStandardOutput) {
  const std::string free = std::string("'") + kSample + "' --free --from-rpm 800 --seconds 0.1 ";
  EXPECT_EQ(status_of(free + "--csv -"), kSuccess);
  EXPECT_EQ(contents(path("out")).rfind("time_s,", 0), 0u);
  EXPECT_NE(contents(path("err")).find("speed_at_end ="), std::string::npos);
  EXPECT_EQ(status_of(free + "--vcd -"), kSuccess);
  EXPECT_EQ(contents(path("out")).rfind("$version", 0), 0u);
  EXPECT_EQ(contents(path("out")).find("speed_at_end"), std::string::npos);
  EXPECT_EQ(status_of(free + "--report -"), kSuccess);
  EXPECT_EQ(contents(path("out")).rfind("<!DOCTYPE html>", 0), 0u);
}

TEST_F(FreeRunCommand, BadOptionsEndWithStatus2AndLeaveNoFile) {
  const std::string files =
      std::string("'") + kSample + "' --csv '" + path("run.csv") + "' --vcd '" + path("run.vcd") + "' ";
  for (const char* bad :
       {"--starter", "--cut 1", "--from-rpm 5", "--seconds 1", "--machine-Nm 3", "--free --rpm 2000",
        "--free --cycles 3", "--free --cut 5", "--free --cut 0", "--free --cut 1.5", "--free --cut 1,,2",
        "--free --cut one", "--free --seconds 0", "--free --machine-Nm -1", "--free --from-rpm 1e6",
        "--free --from-rpm 40000 --tick-us 2000", "--free --seconds 1e6 --tick-us 1"}) {
    EXPECT_EQ(status_of(files + bad), kBadInput) << bad;
    EXPECT_EQ(contents(path("out")), "") << bad;
    EXPECT_NE(contents(path("err")), "") << bad;
    EXPECT_FALSE(std::filesystem::exists(path("run.csv"))) << bad;
    EXPECT_FALSE(std::filesystem::exists(path("run.vcd"))) << bad;
  }
  const std::string bare = "'" + engine_without_pressure() + "' --free ";
  EXPECT_EQ(status_of(bare + "--load-ratio 0.5"), kBadInput);
  EXPECT_EQ(status_of(bare + "--vcd '" + path("run.vcd") + "'"), kBadInput);  // no wheels
}

}  // namespace
}  // namespace crankloop::program::free_run_test
