// `crankloop new`: an engine from a few numbers that every command takes, runs and holds together at its rated speed.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/bad_input.hpp"

namespace crankloop::new_engine_test {
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
    {"--cylinders", "4", "--bore-mm", "67", "--stroke-mm", "42.5", "--rated-rpm", "13500", "--compression-ratio", "12"},
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

/// [gas] of the same engine: charge and work that engines have, and its manifolds hold their runners.
TEST_F(NewEngine, BreathesIfAsked) {
  for (std::vector<std::string> options : kEngines) {
    SCOPED_TRACE(options[3] + " mm");
    const double diagram_kPa = value_of(made(options), "net_mep_kPa");
    options.push_back("--gas");
    made(options);
    const std::string told = output({"run", "--cycles", "1"});
    EXPECT_GT(value_of(told, "volumetric_efficiency"), 0.75);
    EXPECT_LT(value_of(told, "volumetric_efficiency"), 1.1);
    EXPECT_LT(value_of(told, "residual_ratio"), 0.08);
    EXPECT_GT(value_of(told, "net_mep"), 0.7 * diagram_kPa);
    EXPECT_LT(value_of(told, "net_mep"), 1.1 * diagram_kPa);
    output({"run", "--free", "--starter", "--seconds", "3"});
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

/// Of the net work of the gas, friction takes a twelfth in a truck's diesel and a quarter in a small engine that turns
/// fast: Heywood (1988), section 13.2.
TEST_F(NewEngine, HasAMechanicalEfficiencyThatEnginesHave) {
  const std::vector<std::vector<std::string>> kinds = {{"--valves", "4"},
                                                       {"--valves", "2"},
                                                       {"--boost", "1.6"},
                                                       {"--type", "diesel"},
                                                       {"--type", "diesel", "--boost", "2.2"},
                                                       {"--type", "tractor", "--valves", "2"}};
  const char* const orders[] = {"1",
                                "1-2",
                                "1-3-2",
                                "1-3-4-2",
                                "1-2-4-5-3",
                                "1-5-3-6-2-4",
                                "1-3-5-7-2-4-6",
                                "1-6-2-5-8-3-7-4",
                                "1-3-5-7-9-2-4-6-8",
                                "1-6-5-10-2-7-3-8-4-9",
                                "1-2-3-4-5-6-7-8-9-10-11",
                                "1-7-5-11-3-9-6-12-2-8-4-10"};
  std::size_t cylinders = 0;
  for (const double cm3 : {50.0, 230.0, 500.0, 1200.0, 2500.0}) {
    const std::string bore_mm = std::to_string(10 * std::cbrt(4 * cm3 / M_PI));  // the stroke is equal
    for (const std::vector<std::string>& kind : kinds) {
      const char* const order = orders[cylinders++ % 12];
      std::vector<std::string> options{"--cylinders",    std::to_string((cylinders - 1) % 12 + 1),
                                       "--bore-mm",      bore_mm,
                                       "--stroke-mm",    bore_mm,
                                       "--firing-order", order};
      options.insert(options.end(), kind.begin(), kind.end());
      const std::string text = made(options);
      const double krpm = value_of(text, "rated_rpm") / 1000;
      const double lost_kPa = value_of(text, "constant_kPa") + krpm * value_of(text, "linear_kPa_per_1000rpm") +
                              krpm * krpm * value_of(text, "quadratic_kPa_per_1000rpm2");
      const double efficiency = 1 - lost_kPa / value_of(text, "net_mep_kPa");
      EXPECT_GE(efficiency, 0.75) << cm3 << " cm3, " << kind[1];
      EXPECT_LE(efficiency, 0.92) << cm3 << " cm3, " << kind[1];
    }
  }
}

/// 250 cm3 motocross engines have 28 to 32 kW there.
TEST_F(NewEngine, OfASmallSingleThatTurnsFastHasPower) {
  made({"--cylinders", "1", "--bore-mm", "76", "--stroke-mm", "50.7", "--rated-rpm", "12000"});
  for (const std::string& line : lines_of(output({"balance"}))) {
    if (line.rfind("brake_power_kW,", 0) != 0) continue;
    EXPECT_GT(std::stod(line.substr(15)), 20);
    EXPECT_LT(std::stod(line.substr(15)), 32);
    return;
  }
  FAIL() << "no brake_power_kW";
}

TEST_F(NewEngine, LandsItsValvesGentlyAndKeepsThemOnTheirCamsAboveRatedSpeed) {
  for (const auto& options : kEngines) {
    const double rated_rpm = value_of(made(options), "rated_rpm");
    const auto valve = [&](double share) {
      return output({"valve", "--train", "intake", "--rpm", std::to_string(share * rated_rpm)});
    };
    EXPECT_LT(value_of(valve(1), "seating_speed"), 0.5) << options[3] << " mm";
    EXPECT_EQ(value_of(valve(1.15), "separations"), 0) << options[3] << " mm";
    // Where its speed decides how strong the spring is; the others have a usual preload, which is more.
    if (rated_rpm > 10000) {
      EXPECT_GT(value_of(valve(1.4), "separations"), 0) << options[3] << " mm";
    }
  }
}

TEST_F(NewEngine, TakesTwoValvesOrFour) {
  const std::vector<std::string> three{"--cylinders", "3", "--bore-mm", "74", "--stroke-mm", "77"};
  const std::string four_valves = made(three);
  std::vector<std::string> options = three;
  options.insert(options.end(), {"--valves", "2"});
  const std::string two_valves = made(options);
  EXPECT_EQ(value_of(four_valves, "per_cylinder"), 2);
  EXPECT_EQ(value_of(two_valves, "per_cylinder"), 1);
  EXPECT_GT(value_of(two_valves, "valve_g"), value_of(four_valves, "valve_g"));
  EXPECT_LT(value_of(two_valves, "net_mep_kPa"), value_of(four_valves, "net_mep_kPa"));
}

/// A train is as stiff as its size makes it, however slowly the engine turns.
TEST_F(NewEngine, GivesASlowEngineNoSofterTrainThanItsSizeHas) {
  const std::vector<std::string> four{"--cylinders", "4", "--bore-mm", "86", "--stroke-mm", "86"};
  const std::string usual = made(four);
  std::vector<std::string> options = four;
  options.insert(options.end(), {"--rated-rpm", "1500"});
  const std::string slow = made(options);
  EXPECT_EQ(value_of(slow, "train_N_per_mm"), value_of(usual, "train_N_per_mm"));
  options.back() = "9000";
  const std::string fast = made(options);
  const double frequency_rad_s = std::sqrt(value_of(fast, "train_N_per_mm") * 1e3 /
                                           ((value_of(fast, "valve_g") + value_of(fast, "spring_g") / 3) / 1e3));
  EXPECT_NEAR(frequency_rad_s / (9000 / 2 * 2 * 3.14159265358979 / 60), 40, 0.1);  // turns of the cam

  // Full load presses a closed valve into its seat by less than a fifth of a millimetre.
  for (const std::vector<std::string>& engine :
       {options,
        {"--cylinders", "6", "--bore-mm", "126", "--stroke-mm", "155", "--type", "diesel", "--rated-rpm", "1000"}}) {
    const std::string text = made(engine);
    const double peak_MPa = value_of(output({"run", "--cycles", "1"}), "max_pressure") / 1e3;
    EXPECT_LT(peak_MPa * value_of(text, "head_area_mm2") / value_of(text, "seat_N_per_mm"), 0.2) << text;
  }
}

TEST_F(NewEngine, PutsTwoRodsOfAVEngineOnOnePinWhereTheirThrowsAgree) {
  const std::string v8 = made({"--cylinders", "8", "--bore-mm", "100", "--stroke-mm", "80", "--bank-angles-deg",
                               "45,-45,45,-45,45,-45,45,-45", "--firing-order", "1-8-4-3-6-5-7-2"});
  EXPECT_NE(v8.find("\nshared_pins = 1-2,3-4,5-6,7-8 "), std::string::npos) << v8;
  EXPECT_EQ(value_of(v8, "cylinder_spacing_mm"), 120);
  EXPECT_NE(v8.find("# 8 cylinders on 4 crank throws."), std::string::npos);
  const std::string swapped = made({"--cylinders", "8", "--bore-mm", "100", "--stroke-mm", "80", "--bank-angles-deg",
                                    "-45,45,-45,45,-45,45,-45,45", "--firing-order", "1-8-4-3-6-5-7-2"});
  EXPECT_EQ(swapped.find("\nshared_pins"), std::string::npos);
  EXPECT_NE(swapped.find("are the signs of the banks right?"), std::string::npos);
  const std::string boxer = made({"--cylinders", "2", "--bore-mm", "90", "--stroke-mm", "67", "--bank-angles-deg",
                                  "90,-90", "--firing-order", "1-2"});
  EXPECT_EQ(value_of(boxer, "cylinder_spacing_mm"), 54);
}

TEST_F(NewEngine, WarnsOfAPressureThatNoEngineHas) {
  for (const bool gas : {false, true}) {
    std::vector<std::string> words{"new",    "--cylinders", "6",           "--bore-mm", "320",     "--stroke-mm", "400",
                                   "--type", "diesel",      "--rated-rpm", "750",       "--boost", "4.5"};
    if (gas) words.emplace_back("--gas");
    const Answer answer = run(words);
    EXPECT_EQ(answer.status, 0);
    EXPECT_NE(answer.error.find("the largest pressure is 28000 kPa; usual at full load: up to 25000 kPa"),
              std::string::npos)
        << answer.error;
  }
}

/// Boost is the file's ambient pressure, which compression works against at standstill too.
TEST_F(NewEngine, AStarterTurnsABoostedEngineOver) {
  const std::vector<std::string> words{"--cylinders", "6",      "--bore-mm", "144",  "--stroke-mm",
                                       "165",         "--type", "diesel",    "--gas"};
  const double plain_Nm = value_of(made(words), "stall_Nm");
  std::vector<std::string> boosted = words;
  boosted.insert(boosted.end(), {"--boost", "3.5"});
  std::vector<std::string> command = boosted;
  command.insert(command.begin(), "new");
  const Answer answer = run(command);
  EXPECT_NE(answer.error.find("--boost 3.5: what is assumed was compared with engines of up to 2.4"), std::string::npos)
      << answer.error;
  EXPECT_NEAR(value_of(answer.out, "stall_Nm") / plain_Nm, 3.5, 0.01);
  write("engine.ini", answer.out);
  const Answer start = run({"run", path_, "--free", "--starter", "--seconds", "3"});
  EXPECT_NE(start.out.find("\nreversals = 0\n"), std::string::npos) << start.out;
  EXPECT_EQ(start.out.find("no whole cycle"), std::string::npos) << start.out;
}

TEST_F(NewEngine, SaysItsCrankshaftAsShowDoes) {
  const std::string text = made({"--cylinders", "2", "--bore-mm", "90", "--stroke-mm", "70", "--firing-angles-deg",
                                 "0,270", "--bank-angles-deg", "0,90"});
  EXPECT_NE(text.find("firing_angles_deg = 0,270"), std::string::npos);
  EXPECT_EQ(text.find("firing_order"), std::string::npos);
  // Both throws stand at bank - firing: 0 and 90 - 270 = 180 deg.
  const std::string words[] = {"#   throw 2 at 180 deg: cylinder 2 (bank 90 deg)",
                               "# Fires 1-2, at 0, 270 deg: 270, 450 deg apart.", "# No two rods share a crank pin"};
  const std::string shown = output({"show"});
  for (const std::string& line : words) {
    EXPECT_NE(text.find(line), std::string::npos) << line;
    EXPECT_NE(shown.find(line), std::string::npos) << line;
  }
}

/// At the ends of the ranges, with any ratio of bore to stroke that engines have.
TEST_F(NewEngine, IsCompleteForEverySizeThatItTakes) {
  const struct {
    const char* bore_mm;
    const char* stroke_mm;
    bool gas;
  } sizes[] = {{"1", "5", false},  {"800", "400", false}, {"800", "4000", false}, {"13", "5", true},
               {"13", "13", true}, {"400", "200", true},  {"400", "800", true}};
  for (const auto& size : sizes) {
    for (const char* type : {"si", "diesel", "tractor"}) {
      for (const char* valves : {"2", "4"}) {
        std::vector<std::string> words{"new",          "--cylinders", "4",  "--bore-mm", size.bore_mm, "--stroke-mm",
                                       size.stroke_mm, "--type",      type, "--valves",  valves};
        if (size.gas) words.emplace_back("--gas");
        const Answer answer = run(words);  // most of these sizes are unusual, and warned of
        EXPECT_EQ(answer.status, 0) << size.bore_mm << " x " << size.stroke_mm << type << valves << answer.error;
      }
    }
  }
}

/// Its tuned runners would be longer than an engine file takes, and than anybody builds.
TEST_F(NewEngine, ThatIsSlowHasNoTunedRunners) {
  const std::vector<std::string> single{"new", "--cylinders", "1", "--bore-mm", "86", "--stroke-mm", "86", "--gas"};
  const auto with_rpm = [&](const char* rated_rpm) {
    std::vector<std::string> words = single;
    words.insert(words.end(), {"--rated-rpm", rated_rpm});
    const Answer answer = run(words);
    EXPECT_EQ(answer.status, 0) << answer.error;
    return answer.out;
  };
  EXPECT_EQ(with_rpm("1500").find("runner"), std::string::npos);
  EXPECT_GT(value_of(with_rpm("3000"), "intake_runner_mm"), 1000);
}

TEST_F(NewEngine, HasItsNameWithoutTheBlanksAroundIt) {
  made({"--cylinders", "1", "--bore-mm", "80", "--stroke-mm", "80", "--name", "  b "});
  EXPECT_NE(output({"show"}).find("\nname = b "), std::string::npos);
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
  refused(four, {"--bank-angles-deg", "0,0,90,90"}, "--firing-order or --firing-angles-deg is missing");
  refused(four, {"--firing-order", "1-3-4-2", "--firing-angles-deg", "0,540,180,360"}, "exclude each other");
  refused(four, {"--firing-angles-deg", "0,540,180"}, "crankloop new: firing_angles_deg");
  refused(four, {"--net-mep-kPa", "-900"}, "--net-mep-kPa");
  refused(four, {"--net-mep-kPa", "90000"}, "crankloop new: net_mep_kPa");
  refused(four, {"--net-mep-kPa", "600", "--gas"}, "--net-mep-kPa: with --gas the fuel of a spark-ignition engine");
  for (const char* name : {"a # b", "# b", " # b"})
    refused(four, {"--name", name}, "--name: a # at the start or behind a blank starts a comment");
  refused(four, {"--name", "  "}, "--name: the value is missing");
  const auto of_size = [](const char* bore_mm, const char* stroke_mm) {
    return std::vector<std::string>{"new", "--cylinders", "4", "--bore-mm", bore_mm, "--stroke-mm", stroke_mm};
  };
  refused(of_size("2000", "4000"), {}, "--bore-mm: 2000 is out of range; allowed: 1 to 800");
  refused(of_size("0.01", "0.01"), {}, "--bore-mm: 0.01 is out of range; allowed: 1 to 800");
  refused(of_size("80", "4.9"), {}, "--stroke-mm: 4.9 is out of range; allowed: 5 to 4000");
  refused(of_size("12", "12"), {"--gas"}, "--bore-mm: 12 is out of range with --gas; allowed: 13 to 400");
  refused(of_size("500", "500"), {"--gas"}, "--bore-mm: 500 is out of range with --gas; allowed: 13 to 400");
  refused(of_size("380", "475"), {"--gas", "--type", "diesel", "--boost", "4"},
          "--gas: full load takes 10600 mg of fuel in each of such cylinders; gas exchange takes up to 10000 mg");
  refused({"new", "--cylinders", "7", "--bore-mm", "95", "--stroke-mm", "115"}, {},
          "--firing-order or --firing-angles-deg is missing");
}

}  // namespace
}  // namespace crankloop::new_engine_test
