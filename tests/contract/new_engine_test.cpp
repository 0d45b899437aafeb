// `crankloop new`: an engine from a few numbers that every command takes, runs and holds together at its rated speed.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/bad_input.hpp"

namespace crankloop {
namespace {

using bad_input::Answer;
using bad_input::lines_of;

double value_of(const std::string& text, const std::string& name) {
  for (const std::string& line : lines_of(text)) {
    if (line.rfind(name + " = ", 0) == 0) return std::stod(line.substr(name.size() + 3));
  }
  ADD_FAILURE() << "no line " << name << " in\n" << text;
  return 0;
}

class NewEngine : public bad_input::BadInput {
 protected:
  /// Words of `new`, and its output as the engine file.
  std::string made(const std::vector<std::string>& options) const {
    std::vector<std::string> words{"new"};
    words.insert(words.end(), options.begin(), options.end());
    const Answer answer = run(words);
    EXPECT_EQ(answer.status, 0) << answer.error;
    EXPECT_EQ(answer.error, "");
    write("engine.ini", answer.out);
    return answer.out;
  }
  std::string output(std::vector<std::string> words) const {
    words.insert(words.begin() + 1, path_);
    const Answer answer = run(words);
    EXPECT_EQ(answer.status, 0) << words[0] << ": " << answer.error;
    EXPECT_EQ(answer.error, "") << words[0];
    return answer.out;
  }
};

const std::vector<std::vector<std::string>> kEngines = {
    {"--cylinders", "1", "--bore-mm", "52.4", "--stroke-mm", "57.8"},
    {"--cylinders", "3", "--bore-mm", "74", "--stroke-mm", "77", "--rated-rpm", "5500"},
    {"--cylinders", "4", "--bore-mm", "95", "--stroke-mm", "115", "--type", "diesel", "--rated-rpm", "2000"},
    {"--cylinders", "6", "--bore-mm", "130", "--stroke-mm", "150", "--type", "tractor"},
    {"--cylinders", "2", "--bore-mm", "80", "--stroke-mm", "60", "--firing-order", "1-2", "--bank-angles-deg", "0,90"},
};

TEST_F(NewEngine, SaysOfEachLineWhetherItIsGivenOrAssumed) {
  const std::string text = made(
      {"--cylinders", "3", "--bore-mm", "74", "--stroke-mm", "77", "--compression-ratio", "10.5", "--name", "three"});
  std::vector<std::string> given;
  for (const std::string& line : lines_of(text)) {
    const std::size_t equals = line.find(" = ");
    if (equals == std::string::npos || line[0] == '#') continue;
    const std::string remark = line.substr(line.find("# ") + 2);
    if (remark == "given") given.push_back(line.substr(0, equals));
    EXPECT_TRUE(remark == "given" || remark.rfind("assumed", 0) == 0) << line;
  }
  EXPECT_EQ(given, (std::vector<std::string>{"name", "bore_mm", "stroke_mm", "compression_ratio", "cylinders"}));
}

TEST_F(NewEngine, GoesThroughEveryCommandAndKeepsItsValvesOnTheirCamsAtRatedSpeed) {
  for (const auto& options : kEngines) {
    const double rated_rpm = value_of(made(options), "rated_rpm");
    SCOPED_TRACE(options[3] + " mm");
    output({"show"});
    output({"balance", "--rpm", std::to_string(rated_rpm)});
    output({"run", "--cycles", "1"});
    for (const char* train : {"intake", "exhaust"}) {
      EXPECT_EQ(value_of(output({"valve", "--train", train, "--rpm", std::to_string(rated_rpm)}), "separations"), 0)
          << train;
    }
  }
}

/// The brake takes what gas and friction leave at rated speed, so that is where full load settles.
TEST_F(NewEngine, StartsAndFindsItsRatedSpeedAtFullLoad) {
  for (const auto& options : kEngines) {
    const double rated_rpm = value_of(made(options), "rated_rpm");
    SCOPED_TRACE(options[3] + " mm");
    const std::string settled =
        output({"run", "--free", "--from-rpm", std::to_string(0.9 * rated_rpm), "--seconds", "8"});
    EXPECT_NEAR(value_of(settled, "cycle_speed"), rated_rpm, 0.02 * rated_rpm);
    const std::string started = output({"run", "--free", "--starter", "--seconds", "4"});
    EXPECT_GT(value_of(started, "cycle_speed"), 0.3 * rated_rpm);
  }
}

TEST_F(NewEngine, RefusesWhatMakesNoEngine) {
  const std::vector<std::string> four{"new", "--cylinders", "4", "--bore-mm", "95", "--stroke-mm", "115"};
  const auto refused = [&](std::vector<std::string> words, const std::vector<std::string>& more, const char* fragment) {
    words.insert(words.end(), more.begin(), more.end());
    const Answer answer = run(words);
    EXPECT_EQ(answer.status, bad_input::kBadInput);
    EXPECT_EQ(answer.out, "");
    EXPECT_NE(answer.error.find(fragment), std::string::npos) << answer.error << "  should say: " << fragment;
  };
  refused({"new", "--cylinders", "4", "--bore-mm", "95"}, {}, "--stroke-mm is missing");
  refused({"new"}, {}, "crankloop new: --cylinders, --bore-mm, --stroke-mm are missing");
  refused(four, {"--rod-length-mm", "50"}, "crankloop new: rod_length_mm: 50 is too short");
  refused(four, {"--firing-order", "1-3-4"}, "crankloop new: firing_order: cylinder 2 does not fire");
  refused(four, {"--bank-angles-deg", "0,0,90,90"}, "--firing-order is missing");
  refused(four, {"--name", "a # b"}, "--name");
  refused({"new", "--cylinders", "7", "--bore-mm", "95", "--stroke-mm", "115"}, {}, "--firing-order is missing");
}

}  // namespace
}  // namespace crankloop
