// `crankloop map`: its points against single runs, its heat maps against its rows, what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "crankloop/engine_file/engine_file.hpp"
#include "support/markup.hpp"
#include "support/run_command.hpp"

namespace crankloop::program::map_command_test {
namespace {

const std::string kFour = CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini";

class MapCommand : public RunCommand {
 protected:
  static std::string map(const std::vector<std::string>& words) {
    testing::internal::CaptureStdout();
    const int status = kMap.run(Arguments(kMap, words));
    const std::string printed = testing::internal::GetCapturedStdout();
    EXPECT_EQ(status, kSuccess);
    return printed;
  }
  static std::string refusal(const std::vector<std::string>& words) {
    try {
      kMap.run(Arguments(kMap, words));
    } catch (const std::exception& refused) {
      return refused.what();
    }
    return "";
  }
};

TEST_F(MapCommand, HasAtEachPointWhatARunOfThatPointHas) {
  const std::string csv = path("map.csv");
  map({kFour, "--rpm", "1500:3000:2", "--throttle", "0.1:0.7:3", "--tick-us", "200", "--fuel-mg", "20",
       "--burn-start-deg", "-15", "--csv", csv});
  const std::vector<std::string> lines = split_at(contents(csv), '\n');
  ASSERT_EQ(lines.size(), 7u);
  const std::vector<std::string> names = split_at(lines[0], ',');
  std::size_t row = 1;
  for (const char* rpm : {"1500", "3000"}) {
    for (const char* throttle : {"0.1", "0.4", "0.7"}) {
      SCOPED_TRACE(lines[row]);
      const std::vector<std::string> cells = split_at(lines[row++], ',');
      EXPECT_EQ(std::stod(cells[0]), std::stod(rpm));
      EXPECT_EQ(static_cast<float>(std::stod(cells[1])), std::stof(throttle));
      const std::string summary = run({kFour, "--rpm", rpm, "--throttle", throttle, "--tick-us", "200", "--fuel-mg",
                                       "20", "--burn-start-deg", "-15", "--cycles", "1"});
      const struct {
        const char* column;
        const char* line;
      } same[] = {{"torque_Nm", "mean_torque"},
                  {"brake_torque_Nm", "brake_torque"},
                  {"pumping_mep_kPa", "pumping_mep"},
                  {"trapped_air_mg", "trapped_air"},
                  {"residual_ratio", "residual_ratio"},
                  {"volumetric_efficiency", "volumetric_efficiency"},
                  {"intake_pressure_kPa", "intake_pressure"}};
      for (const auto& [column, of_run] : same) {
        const auto at = std::find(names.begin(), names.end(), column) - names.begin();
        const double expected = line(summary, of_run).first;
        EXPECT_NEAR(std::stod(cells.at(static_cast<std::size_t>(at))), expected, 1e-5 * std::abs(expected)) << column;
      }
      const double power_kW = line(summary, "brake_power").first;
      if (power_kW <= 0) continue;
      const double fuel_g_h = line(summary, "fuel_burned").first * 1e-3 * 4 * std::stod(rpm) / 2 * 60;
      EXPECT_NEAR(line(summary, "brake_specific_consumption").first, fuel_g_h / power_kW, 1e-4 * fuel_g_h / power_kW);
    }
  }
}

/// Where a real engine would misfire or knock, map and page say so; elsewhere they do not.
TEST_F(MapCommand, SaysWhereARealEngineWouldNotRunSo) {
  const std::string misfires = "1 of 2 points have more than 40 % of residual gas: a real engine misfires";
  const std::string open = map({kFour, "--rpm", "3000:3000:1", "--throttle", "0.5:1:2"});
  EXPECT_EQ(open.find("a real engine"), std::string::npos) << open;
  const std::string closed =
      map({kFour, "--rpm", "6000:6000:1", "--throttle", "0:1:2", "--report", path("closed.html")});
  EXPECT_NE(closed.find("# " + misfires), std::string::npos) << closed;
  EXPECT_NE(contents(path("closed.html")).find(misfires), std::string::npos);
  EXPECT_NE(run({kFour, "--rpm", "6000", "--throttle", "0", "--cycles", "1"}).find("makes a real engine misfire"),
            std::string::npos);

  const std::string runners = CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000_runners.ini";
  const std::string early = map({runners, "--rpm", "2000:2000:1", "--throttle", "1:1:1", "--burn-start-deg", "-40"});
  EXPECT_NE(early.find("# 1 of 1 points have a knock integral of 1 or more"), std::string::npos) << early;
}

/// A diesel is governed by its fuel: more of it, more torque and less air over.
TEST_F(MapCommand, IsOverFuelWhereFuelIsAGrid) {
  const std::string diesel = CRANKLOOP_SOURCE_DIR "/tools/engines/diesel_495_gas.ini", csv = path("fuel.csv");
  const std::string summary =
      map({diesel, "--rpm", "1500:1500:1", "--fuel-mg", "20:40:3", "--csv", csv, "--report", path("fuel.html")});
  EXPECT_EQ(line(summary, "throttle").first, 1);
  EXPECT_NE(summary.find("at 1500 rpm, fuel 40 mg"), std::string::npos) << summary;
  EXPECT_NE(contents(path("fuel.html")).find("varied fuel"), std::string::npos);
  const std::vector<std::string> lines = split_at(contents(csv), '\n');
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0].rfind("speed_rpm,fuel_mg,torque_Nm,", 0), 0u) << lines[0];
  double before_Nm = 0;
  for (std::size_t row = 1; row < lines.size(); ++row) {
    const std::vector<std::string> cells = split_at(lines[row], ',');
    const std::string fuel_mg = std::to_string(10 + 10 * row);
    EXPECT_EQ(std::stod(cells[1]), std::stod(fuel_mg));
    const double torque_Nm = std::stod(cells[2]);
    EXPECT_GT(torque_Nm, before_Nm);
    before_Nm = torque_Nm;
    const std::string point = run({diesel, "--rpm", "1500", "--fuel-mg", fuel_mg, "--cycles", "1"});
    EXPECT_NEAR(torque_Nm, line(point, "mean_torque").first, 1e-5 * torque_Nm);
  }
}

/// Consumption and efficiency from torque and fuel; the spark of best torque has more of it than sparks around.
TEST_F(MapCommand, FindsTheSparkOfBestTorque) {
  const std::string csv = path("mbt.csv");
  const auto point = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words{kFour, "--rpm", "3000:3000:1", "--throttle", "0.5:0.5:1", "--tick-us", "200"};
    words.insert(words.end(), options.begin(), options.end());
    words.insert(words.end(), {"--csv", csv});
    const std::string summary = map(words);
    EXPECT_GT(line(summary, "max_brake_efficiency").first, 0.15);
    const std::vector<std::string> lines = split_at(contents(csv), '\n');
    const std::vector<std::string> names = split_at(lines.at(0), ','), cells = split_at(lines.at(1), ',');
    return [names, cells](const char* name) {
      const auto at = std::find(names.begin(), names.end(), name) - names.begin();
      return std::stod(cells.at(static_cast<std::size_t>(at)));
    };
  };
  const auto best = point({"--mbt"});
  const double start_deg = best("burn_start_deg");
  EXPECT_GT(start_deg, -45);
  EXPECT_LT(start_deg, -5);
  const double fuel_kg_s = best("fuel_burned_mg") * 1e-6 * 4 * 3000 / 120, power_kW = best("brake_power_kW");
  EXPECT_NEAR(best("brake_specific_consumption_g_per_kWh"), fuel_kg_s * 3.6e6 / power_kW, 0.01);
  EXPECT_NEAR(best("brake_efficiency"), power_kW / (fuel_kg_s * 43e3), 1e-5);
  EXPECT_EQ(best("knock_integral"), 0);
  for (const double off_deg : {-3.0, 3.0}) {
    const auto other = point({"--burn-start-deg", std::to_string(start_deg + off_deg)});
    EXPECT_LT(other("torque_Nm"), best("torque_Nm"));
    EXPECT_NEAR(other("burn_start_deg"), start_deg + off_deg, 1e-4);
  }
  EXPECT_NE(refusal({kFour, "--rpm", "3000:3000:1", "--throttle", "1:1:1", "--mbt", "--burn-start-deg", "-10"})
                .find("--burn-start-deg"),
            std::string::npos);
}

/// Fuel over no work is no number: 0 would be the best of all consumptions.
TEST_F(MapCommand, LeavesTheConsumptionOutWhereTheEngineIsDriven) {
  const std::string csv = path("driven.csv");
  static_cast<void>(map({kFour, "--rpm", "5000:5000:1", "--throttle", "0:1:2", "--tick-us", "200", "--csv", csv}));
  const std::vector<std::string> lines = split_at(contents(csv), '\n'), names = split_at(lines.at(0), ',');
  const auto cell = [&](std::size_t row, const char* name) {
    const auto at = std::find(names.begin(), names.end(), name) - names.begin();
    return split_at(lines.at(row), ',').at(static_cast<std::size_t>(at));
  };
  EXPECT_LT(std::stod(cell(1, "brake_torque_Nm")), 0);
  EXPECT_EQ(cell(1, "brake_specific_consumption_g_per_kWh"), "");
  EXPECT_EQ(cell(1, "brake_efficiency"), "0");
  EXPECT_GT(std::stod(cell(2, "brake_specific_consumption_g_per_kWh")), 200);
}

/// Without fuel no start is the best: the search would end at rounding's choice.
TEST_F(MapCommand, KeepsTheFilesBurnStartWhereNothingBurns) {
  const std::string csv = path("nothing.csv"), diesel = CRANKLOOP_SOURCE_DIR "/tools/engines/diesel_495_gas.ini";
  map({diesel, "--rpm", "1500:1500:1", "--fuel-mg", "0:20:2", "--mbt", "--csv", csv});
  const std::vector<std::string> lines = split_at(contents(csv), '\n');
  ASSERT_EQ(lines.size(), 3u);
  const std::vector<std::string> names = split_at(lines[0], ',');
  const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), "burn_start_deg") - names.begin());
  EXPECT_EQ(std::stod(split_at(lines[1], ',').at(at)), read_engine_file(diesel, {}).definition().gas.burn_start_deg);
  EXPECT_NE(std::stod(split_at(lines[2], ',').at(at)), read_engine_file(diesel, {}).definition().gas.burn_start_deg);
}

TEST_F(MapCommand, TakesItsFuelByTheAirAtEachPoint) {
  const std::string csv = path("air.csv");
  map({kFour, "--rpm", "2000:2000:1", "--throttle", "0.05:1:3", "--csv", csv});
  const std::vector<std::string> lines = split_at(contents(csv), '\n');
  const std::vector<std::string> names = split_at(lines[0], ',');
  const auto column = [&](const std::string& row, const char* name) {
    const auto at = std::find(names.begin(), names.end(), name) - names.begin();
    return std::stod(split_at(row, ',').at(static_cast<std::size_t>(at)));
  };
  for (std::size_t row = 1; row < 4; ++row) {
    EXPECT_NEAR(column(lines[row], "excess_air_ratio"), 1, 1e-5);
    const double air_mg = column(lines[row], "trapped_air_mg");
    EXPECT_NEAR(column(lines[row], "fuel_burned_mg") * 14.6 / air_mg, 1, 0.01) << air_mg;
  }
}

TEST_F(MapCommand, IsOverThrottleOrFuelAndNotBoth) {
  const auto refuses = [](std::vector<std::string> words, const std::string& why) {
    words.insert(words.begin(), {kFour, "--rpm", "1000:2000:2"});
    const std::string told = refusal(words);
    EXPECT_NE(told.find(why), std::string::npos) << told;
  };
  refuses({}, "give FROM:TO:N as --throttle or as --fuel-mg");
  refuses({"--throttle", "0.5", "--fuel-mg", "20"}, "give FROM:TO:N as --throttle or as --fuel-mg");
  refuses({"--throttle", "0:1:3", "--fuel-mg", "10:20:2"}, "--throttle and --fuel-mg are both FROM:TO:N");
  refuses({"--throttle", "0:1:3", "--fuel-mg", "10", "--lambda", "1"}, "give one of them");
  refuses({"--throttle", "2", "--fuel-mg", "10:20:2"}, "--throttle: 2 is out of range");
  refuses({"--throttle", "0:1:3", "--fuel-mg", "-1"}, "--fuel-mg: ");
}

TEST_F(MapCommand, IsTheSameHoweverItsPointsAreShared) {
  const std::vector<std::string> words{kFour, "--rpm", "2000:4000:3", "--throttle", "0.2:1:4", "--csv"};
  const auto once = [&](const char* name) {
    std::vector<std::string> all = words;
    all.push_back(path(name));
    map(all);
    return contents(path(name));
  };
  EXPECT_EQ(once("one.csv"), once("two.csv"));
}

TEST_F(MapCommand, HasTheSameBytesJoinedFromShards) {
  const std::vector<std::string> words{kFour, "--rpm", "2000:4000:2", "--throttle", "0.2:1:3", "--tick-us", "200"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = words;
    all.insert(all.end(), more.begin(), more.end());
    return map(all);
  };
  const auto outputs = [&](std::vector<std::string> how) {
    how.insert(how.end(), {"--csv", path("map.csv"), "--report", path("map.html")});
    const std::string summary = with(how);
    return summary + contents(path("map.csv")) + contents(path("map.html"));
  };
  const std::string whole = outputs({"--threads", "1"});
  EXPECT_EQ(with({"--shard", "1/2", "--part", path("one")}), "");
  EXPECT_EQ(with({"--shard", "2/2", "--part", path("two")}), "");
  EXPECT_TRUE(outputs({"--join", path("two"), path("one")}) == whole);
  std::vector<std::string> other = words;
  other[2] = "2000:5000:2";
  other.insert(other.end(), {"--join", path("one"), path("two")});
  EXPECT_NE(refusal(other).find("is a part of another map"), std::string::npos);
}

TEST_F(MapCommand, DrawsAHeatMapOfEachResultWithItsPointsAndContours) {
  const std::string summary =
      map({kFour, "--rpm", "1000:5000:5", "--throttle", "0:1:4", "--tick-us", "200", "--report", path("map.html")});
  const std::string text = contents(path("map.html"));
  const support::Markup page = support::read(text);
  EXPECT_EQ(page.fault, "");
  EXPECT_EQ(page.all("svg").size(), 7u);
  std::size_t maps = 0;
  for (const auto& group : page.all("g")) {
    const auto field = group.attributes.find("data-field");
    if (field == group.attributes.end()) continue;
    EXPECT_EQ(split_at(field->second, ' ').size(), 5u * 4) << group.attributes.at("data-name");
    ++maps;
  }
  EXPECT_EQ(maps, 7u);
  EXPECT_GE(page.of_class("contour").size(), 3 * maps);
  EXPECT_NE(text.find("data-name=\"Residual gas\" data-unit=\"%\""), std::string::npos);
  EXPECT_NE(text.find("Not modelled: pressure waves"), std::string::npos);
  EXPECT_EQ(line(summary, "points").first, 20);
  EXPECT_EQ(line(summary, "faulty_ticks").first, 0);
}

/// The words of data-x, "0 1 FROM TO": the range of an axis.
std::string range_of_x(const support::Element& svg) {
  const std::vector<std::string> words = split_at(svg.attributes.at("data-x"), ' ');
  return words.at(0) + ' ' + words.at(1);
}

TEST_F(MapCommand, DrawsCurvesWhereThereIsOneSpeedOrOneThrottle) {
  const struct {
    const char* rpm;
    const char* throttle;
    const char* range;
    const char* title;
    std::size_t points;
  } cases[] = {{"2000:2000:1", "0:1:3", "0 1", "over throttle at 2000 rpm", 3},
               {"1000:2000:2", "0.5:0.5:1", "1000 2000", "over speed at throttle 0.5", 2}};
  for (const auto& one : cases) {
    map({kFour, "--rpm", one.rpm, "--throttle", one.throttle, "--tick-us", "200", "--report", path("map.html")});
    const std::string text = contents(path("map.html"));
    const support::Markup page = support::read(text);
    EXPECT_EQ(page.fault, "");
    EXPECT_NE(text.find(std::string("<h1>four-cylinder 2000 ") + one.title), std::string::npos);
    const auto drawings = page.all("svg");
    EXPECT_EQ(drawings.size(), 7u);
    for (const support::Element& svg : drawings) EXPECT_EQ(range_of_x(svg), one.range);
    for (const support::Element& dots : page.of_class("dot"))
      EXPECT_EQ(split_at(dots.attributes.at("d"), 'M').size(), 1 + one.points);
  }
}

TEST_F(MapCommand, DrawsALonePointToo) {
  map({kFour, "--rpm", "2000:2000:1", "--throttle", "1:1:1", "--tick-us", "200", "--report", path("map.html")});
  const support::Markup page = support::read(contents(path("map.html")));
  EXPECT_EQ(page.fault, "");
  EXPECT_EQ(page.all("svg").size(), 7u);
}

TEST_F(MapCommand, RefusesWhatIsNoMap) {
  const auto refuses = [](const std::string& rpm, const std::string& throttle, const std::string& why) {
    const std::string told = refusal({kFour, "--rpm", rpm, "--throttle", throttle});
    EXPECT_NE(told.find(why), std::string::npos) << told;
  };
  refuses("1000:6000", "0:1:3", "--rpm: give FROM:TO:N");
  refuses("6000:1000:3", "0:1:3", "--rpm: FROM must be less than TO");
  refuses("1000:6000:1", "0:1:3", "--rpm: FROM must be less than TO, or the same with N = 1");
  refuses("1000:6000:2.5", "0:1:3", "--rpm: N, the number of values: '2.5' is not a whole number");
  refuses("1000:6000:0", "0:1:2", "--rpm: N, the number of values: 0 is out of range; allowed: 1 to 1000");
  refuses("0:6000:2", "0:1:2", "--rpm: FROM: 0 is out of range");
  refuses("1000:6000:3", "0:1.5:3", "--throttle: TO: 1.5 is out of range");
  refuses("1000:6000:1000", "0:1:1000", "a map of 1e+06 points");
  refuses("1000:500000:2", "1:1:1", "--rpm: TO: 500000 is out of range");
  EXPECT_NE(refusal({kSample, "--rpm", "1000:2000:2", "--throttle", "0:1:2"}).find("has no [pressure] source = gas"),
            std::string::npos);
  EXPECT_NE(refusal({kFour, "--rpm", "8000:10000:2", "--throttle", "1:1:1"})
                .find("10000 rpm is beyond the engine's max_rpm of 9000"),
            std::string::npos);
}

}  // namespace
}  // namespace crankloop::program::map_command_test
