// Inputs over time from a CSV file: the values between rows, whose inputs a column drives, what is refused and where;
// and `run --free --inputs` against the same run by its options.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <crankloop/scenes.hpp>

#include "crankloop/files/error.hpp"
#include "crankloop/files/number.hpp"
#include "crankloop/loops/input_option.hpp"
#include "crankloop/loops/input_schedule.hpp"
#include "support/run_command.hpp"

namespace crankloop::program::input_schedule_test {
namespace {

class Inputs : public RunCommand {
 protected:
  [[nodiscard]] std::string file(const std::string& text) const {
    std::ofstream(path("inputs.csv")) << text;
    return path("inputs.csv");
  }
  static detail::EngineShape four() { return {4, 2, 2, 500}; }
  static std::vector<SceneInput> breathing() { return scene_inputs<scenes::BreathingFree>(four()); }
  static std::size_t place_of(const std::vector<SceneInput>& inputs, const std::string& name) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      if (inputs[i].name == name) return i;
    }
    ADD_FAILURE() << name;
    return 0;
  }
  [[nodiscard]] std::string refusal_of(const std::string& text) const {
    try {
      const InputSchedule schedule(file(text), breathing());
    } catch (const InputError& error) {
      std::string message = error.what();
      EXPECT_EQ(message.substr(0, path("inputs.csv").size() + 1), path("inputs.csv") + ":");
      return message.substr(path("inputs.csv").size() + 1);
    }
    return "";
  }
};

TEST_F(Inputs, AreStraightLinesBetweenRowsAndStepsOfSwitches) {
  const std::vector<SceneInput> inputs = breathing();
  std::mt19937 random(20261126);
  std::uniform_real_distribution<double> any(0, 1);
  std::vector<double> times, throttles, cuts, starters;
  std::string text = "# a bench\ntime_s, throttle_ratio,cut_cylinders ,starter\n\n";
  double time = any(random);
  for (int row = 0; row < 40; ++row) {
    times.push_back(time);
    throttles.push_back(any(random));
    cuts.push_back(std::floor(16 * any(random)));
    starters.push_back(any(random) < 0.5 ? 0 : 1);
    text += shortest(time) + "," + shortest(throttles.back()) + "," + shortest(cuts.back()) + "," +
            shortest(starters.back()) + "\r\n";
    time += 0.01 + any(random);
  }
  InputSchedule schedule(file(text), inputs);
  EXPECT_EQ(schedule.rows(), 40u);
  EXPECT_EQ(schedule.columns(), "throttle_ratio, cut_cylinders, starter");
  EXPECT_EQ(schedule.end_s(), times.back());
  std::array<double, kMaxSceneInputs> numbers;
  for (double at = 0; at < times.back() + 1; at += 0.003) {
    numbers.fill(-7);
    schedule.at(at, numbers.data());
    // All rows are looked at: the last one that is not later, and the one after it.
    double throttle = throttles[0], cut = cuts[0], starter = starters[0];
    for (std::size_t i = 0; i < times.size() && times[i] <= at; ++i) {
      cut = cuts[i], starter = starters[i], throttle = throttles[i];
      if (i + 1 < times.size() && times[i + 1] > at)
        throttle =
            (throttles[i] * (times[i + 1] - at) + throttles[i + 1] * (at - times[i])) / (times[i + 1] - times[i]);
    }
    ASSERT_NEAR(numbers[place_of(inputs, "throttle_ratio")], throttle, 1e-12) << at;
    ASSERT_EQ(numbers[place_of(inputs, "cut_cylinders")], cut) << at;
    ASSERT_EQ(numbers[place_of(inputs, "starter")], starter) << at;
    ASSERT_EQ(numbers[place_of(inputs, "fuel_kg[1]")], -7) << "no column, not touched";
  }
}

TEST_F(Inputs, OfOneCylinderOrOfAll) {
  const std::vector<SceneInput> inputs = breathing();
  InputSchedule schedule(file("time_s,fuel_kg,burn_start_deg[3]\n0,2e-5,-11\n"), inputs);
  std::array<double, kMaxSceneInputs> numbers{};
  schedule.at(5, numbers.data());
  for (const char* name : {"fuel_kg[1]", "fuel_kg[2]", "fuel_kg[3]", "fuel_kg[4]"})
    EXPECT_EQ(numbers[place_of(inputs, name)], 2e-5) << name;
  EXPECT_EQ(numbers[place_of(inputs, "burn_start_deg[3]")], -11);
  EXPECT_EQ(numbers[place_of(inputs, "burn_start_deg[4]")], 0);
}

TEST_F(Inputs, AreRefusedAtLineAndColumn) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "1: the file is empty; it needs the header row 'time_s,NAME,...' and rows under it"},
      {"time_s,throttle_ratio\n", "1: no rows stand under the header"},
      {"t,throttle_ratio\n0,1\n", "1: column 1: the header row begins with time_s, then come names of inputs"},
      {"time_s;throttle_ratio\n0;1\n",
       "1: column 1: the header row begins with time_s, then come names of inputs; columns are separated by commas, "
       "and the decimal sign is a point"},
      {"time_s,throttle_ratio,\n0,1,\n", "1: column 3: a comma precedes it, but no name of an input stands there"},
      {"time_s\n0\n", "1: column 1: a name of an input has to follow time_s"},
      {"# x\ntime_s,starter,throttle_rato\n0,0,1\n",
       "2: column 3: 'throttle_rato' is no input of this engine; did you mean throttle_ratio?; its inputs are"},
      {"time_s,starter,starter\n0,0,1\n", "1: column 3, starter: there is such a column already"},
      {"time_s,fuel_kg[2],fuel_kg\n0,0,0\n", "1: column 3, fuel_kg: fuel_kg[2] has the column fuel_kg[2] already"},
      {"time_s,fuel_kg[5]\n0,0\n", "1: column 2: 'fuel_kg[5]' is no input of this engine"},
      {"time_s,load_ratio\n0,0\n", "1: column 2: 'load_ratio' is no input of this engine"},
      {"time_s,throttle_ratio\n0,0\n1\n",
       "3: column 1: the row has 1 column, the header 2; columns are separated by commas"},
      {"time_s,throttle_ratio\n0,0,3\n", "2: column 2: the row has 3 columns, the header 2"},
      {"time_s,throttle_ratio\n0,\n", "2: column 2, throttle_ratio: "},
      {"time_s,throttle_ratio\n0,nan\n", "2: column 2, throttle_ratio: 'nan' is not a finite number"},
      {"time_s,throttle_ratio\n0,0.5\n1,1.5\n", "3: column 2, throttle_ratio: 1.5 is out of range"},
      {"time_s,throttle_ratio\n-1,0.5\n", "2: column 1, time_s: -1 is out of range"},
      {"time_s,throttle_ratio\n1,0.5\n1,0.5\n",
       "3: column 1, time_s: 1 is not after 1 of the row before; times must increase"},
      {"time_s,starter\n0,0.5\n", "2: column 2, starter: '0.5' is not a whole number"},
      {"time_s,starter\n0,2\n", "2: column 2, starter: 2 is out of range"},
      {"time_s,cut_cylinders\n0,16\n", "2: column 2, cut_cylinders: 16 is out of range"},
      {"time_s,throttle_ratio\n0,0.\001\n", "2: not a text file"},
  };
  for (const auto& [text, message] : cases) {
    const std::string refused = refusal_of(text);
    EXPECT_EQ(refused.substr(0, message.size()), message) << refused;
  }
}

TEST_F(Inputs, ThatStayAreTheOptions) {
  run({kSample, "--free", "--from-rpm", "900", "--load-ratio", "0.3", "--starter", "--cut", "2", "--seconds", "0.3",
       "--csv", path("options.csv")});
  run({kSample, "--free", "--from-rpm", "900", "--inputs",
       file("time_s,starter,load_ratio,cut_cylinders\n0,1,0.3,2\n0.1,1,0.3,2\n"), "--seconds", "0.3", "--csv",
       path("inputs_run.csv")});
  EXPECT_EQ(contents(path("options.csv")), contents(path("inputs_run.csv")));
}

TEST_F(Inputs, ExcludeTheOptionsOfTheSameInput) {
  const std::string columns = " --inputs " + file("time_s,load_ratio,cut_cylinders\n0,1,0\n");
  const std::string words = std::string(kSample) + " --free --from-rpm 1000 --seconds 0.01" + columns;
  EXPECT_EQ(status_of(words), 0);
  for (const std::string option : {"--load-ratio 0", "--cut 1,2"}) {
    EXPECT_EQ(status_of(words + " " + option), 2);
    EXPECT_NE(contents(path("err")).find(option.substr(0, option.find(' ')) + " and the column "), std::string::npos)
        << contents(path("err"));
  }
  EXPECT_EQ(status_of(words + " --starter"), 0);
}

/// What goes in comes out or is kept, each figure by a way of its own, while load, cylinders and the torque change.
TEST_F(Inputs, KeepTheBooksOfEnergy) {
  const std::string summary = run(
      {kSample, "--free", "--from-rpm", "1200", "--real", "double", "--seconds", "2", "--inputs",
       file("time_s,load_ratio,cut_cylinders,external_torque_Nm\n0,0.2,0,0\n1,0.9,0,80\n1.2,0.9,5,-30\n2,0.1,0,10\n")});
  EXPECT_LT(std::fabs(line(summary, "energy_defect").first), 1e-6) << summary;
  EXPECT_EQ(line(summary, "faulty_ticks").first, 0);
  EXPECT_NE(summary.find("inputs_from_file = load_ratio, cut_cylinders, external_torque_Nm\n"), std::string::npos);
}

TEST_F(Inputs, OfTheFileHaveNoValueInTheSummary) {
  const std::string engine = CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini";
  const auto told = [&](const std::string& rows) {
    const std::string summary =
        run({engine, "--free", "--from-rpm", "1000", "--seconds", "0.01", "--inputs", file(rows)});
    std::string lines;
    for (const std::string name : {"throttle", "lambda", "fuel", "burn_start"})
      if (summary.find("\n" + name + " = ") != std::string::npos) lines += name + " ";
    return lines;
  };
  EXPECT_EQ(told("time_s,starter\n0,0\n"), "throttle lambda burn_start ");
  EXPECT_EQ(told("time_s,throttle_ratio\n0,0.2\n"), "lambda burn_start ");
  EXPECT_EQ(told("time_s,excess_air_ratio,burn_start_deg\n0,1,-9\n"), "throttle ");
  EXPECT_EQ(told("time_s,burn_start_deg[3]\n0,-9\n"), "throttle lambda burn_start ") << "of the other cylinders";
  EXPECT_EQ(told("time_s,spark_advance_deg,by_spark_advance\n0,20,1\n"), "throttle lambda ") << "the spark sets it";
  const std::string one = run(
      {kSample, "--free", "--from-rpm", "1000", "--seconds", "0.01", "--inputs", file("time_s,load_ratio\n0,0.5\n")});
  EXPECT_EQ(one.find("\nload_ratio = "), std::string::npos) << one;
}

TEST_F(Inputs, AWarningNamesAColumnThatAnotherInputOverrides) {
  const auto told = [this](const std::string& text, double excess_air_ratio) {
    return warnings_about_inputs(InputSchedule(file(text), breathing()), excess_air_ratio);
  };
  const std::vector<std::string> fuel = told("time_s,fuel_kg[2]\n0,1e-5\n", 0.9);
  ASSERT_EQ(fuel.size(), 1u);
  EXPECT_EQ(fuel[0], path("inputs.csv") +
                         ": warning: column fuel_kg has no effect: excess_air_ratio = 0.9 sets the fuel; add a column "
                         "excess_air_ratio with 0, or give --fuel-mg");
  EXPECT_TRUE(told("time_s,fuel_kg\n0,1e-5\n", 0).empty());
  EXPECT_TRUE(told("time_s,fuel_kg,excess_air_ratio\n0,1e-5,0\n", 0.9).empty());
  const std::vector<std::string> spark = told("time_s,spark_advance_deg\n0,20\n", 0.9);
  ASSERT_EQ(spark.size(), 1u);
  EXPECT_NE(spark[0].find("spark_advance_deg has no effect"), std::string::npos) << spark[0];
  EXPECT_EQ(told("time_s,spark_advance_deg,by_spark_advance\n0,20,0\n", 0).size(), 1u);
  EXPECT_TRUE(told("time_s,spark_advance_deg,by_spark_advance\n0,20,0\n1,20,1\n", 0).empty());
}

TEST_F(Inputs, AWarningStandsOnStderr) {
  const std::string engine = CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini";
  const std::string words = engine + " --free --from-rpm 1000 --seconds 0.01 --inputs " + file("time_s,fuel_kg\n0,0\n");
  EXPECT_EQ(status_of(words), 0);
  EXPECT_NE(contents(path("err")).find("warning: column fuel_kg has no effect"), std::string::npos);
  EXPECT_EQ(status_of(words + " --fuel-mg 10"), 0);
  EXPECT_EQ(contents(path("err")).find("fuel_kg"), std::string::npos) << contents(path("err"));
}

TEST_F(Inputs, AreOfAFreeRunOfAnEngineThatHasThem) {
  static_cast<void>(file("time_s,starter\n0,1\n"));
  EXPECT_EQ(status_of(std::string(kSample) + " --inputs " + path("inputs.csv")), 2);
  EXPECT_EQ(contents(path("err")).substr(0, 52), "crankloop run: --inputs is for a run with --free\nusa");
  EXPECT_EQ(status_of(std::string(kSample) + " --free --inputs " + path("none.csv") + " --csv " + path("x.csv")), 2);
  EXPECT_NE(contents(path("err")).find("none.csv: cannot be read: No such file"), std::string::npos);
  EXPECT_TRUE(contents(path("x.csv")).empty()) << "nothing half-run";
  EXPECT_EQ(status_of(engine_without_pressure() + " --free --inputs " + path("inputs.csv")), 2);
  EXPECT_NE(contents(path("err")).find("column starter: "), std::string::npos) << contents(path("err"));
}

}  // namespace
}  // namespace crankloop::program::input_schedule_test
