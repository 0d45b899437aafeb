// `crankloop valve` and `redline`: CSV, plot and summary of one train, and the search for the onset of float and
// bounce.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "crankloop/command_line/commands.hpp"
#include "crankloop/commands/redline/redline_search.hpp"
#include "crankloop/files/error.hpp"
#include "support/drawing_geometry.hpp"
#include "support/markup.hpp"
#include "support/valve_runs.hpp"

namespace crankloop::program::valve_command_test {
namespace {

// ---- redline ----

TEST(SpeedRange, HasRoundStepsAndAtMostSixty) {
  EXPECT_EQ(speed_range(500, 15000).step_rpm, 250);
  EXPECT_EQ(speed_range(8500, 8560).step_rpm, 1);
  EXPECT_EQ(speed_range(8500, 8561).step_rpm, 2);
  for (const int to : {2, 100, 7777, 100000})
    EXPECT_LE((to - 1 + speed_range(1, to).step_rpm - 1) / speed_range(1, to).step_rpm, 60);
}

TEST(Redline, AnOnsetIsTheFirstWholeSpeedThatHasIt) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  const Sweep sweep = sweep_speeds(valve, speed_range(2000, 11000), 1, {}, {1e-6, 0.5, 0});
  ASSERT_TRUE(sweep.separation.found && sweep.bounce.found && sweep.seating.found);
  EXPECT_FALSE(sweep.separation.at_the_start);
  EXPECT_EQ(run<double>(valve, sweep.separation.speed_rpm).results.separations, 1u);
  EXPECT_EQ(run<double>(valve, sweep.separation.speed_rpm - 1).results.separations, 0u);
  EXPECT_EQ(run<double>(valve, sweep.bounce.speed_rpm).results.bounces, 1u);
  EXPECT_EQ(run<double>(valve, sweep.bounce.speed_rpm - 1).results.bounces, 0u);
  EXPECT_GT(run<double>(valve, sweep.seating.speed_rpm).results.seating_speed_m_s, 0.5);
  EXPECT_LE(run<double>(valve, sweep.seating.speed_rpm - 1).results.seating_speed_m_s, 0.5);
}

/// The valve of the 125 lifts off its seat by micrometres long before it bounces in earnest.
TEST(Redline, ABounceCountsFromTheHeightThatIsAskedFor) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  const auto onset_rpm = [&](double least_m) {
    return sweep_speeds(valve, speed_range(2000, 11000), 1, {}, {least_m, 0.5, 0}).bounce.speed_rpm;
  };
  const int of_any_rpm = onset_rpm(1e-6);
  const int of_high_rpm = onset_rpm(100e-6);
  EXPECT_EQ(onset_rpm(50e-6), sweep_speeds(valve, speed_range(2000, 11000), 1, {}).bounce.speed_rpm);
  EXPECT_GT(of_high_rpm, of_any_rpm + 1000);
  ValveLoop<double> loop(valve, kRedlineTick_s, {});
  const auto height_m = [&](int rpm) {
    return run_cycles<double>(loop, valve, rpm, kRedlineCycles, [](const ValveTickOutput<double>&) {}).bounce_height_m;
  };
  EXPECT_GE(height_m(of_high_rpm), 100e-6);
  EXPECT_LT(height_m(of_high_rpm - 1), 100e-6);
}

TEST(Redline, AnOnsetOutsideTheRangeIsToldAsSuch) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  const Sweep sweep = sweep_speeds(valve, speed_range(7000, 7100), 1, {}, {1e-6, 0.5, 0});
  EXPECT_FALSE(sweep.separation.found);
  EXPECT_TRUE(sweep.bounce.found && sweep.bounce.at_the_start);
  EXPECT_EQ(sweep.bounce.speed_rpm, 7000);
}

/// The published tendencies: docs/model.md "Valve".
TEST(Redline, FloatsLaterWithAStifferSpringAndWithLessMass) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  const auto onset_rpm = [&](const char* option, double factor) {
    return sweep_speeds(valve.with(varied(valve.valve(), option, factor)), speed_range(4000, 14000), factor, {})
        .separation.speed_rpm;
  };
  for (const char* option : {"spring", "preload"}) {
    EXPECT_LT(onset_rpm(option, 0.5), onset_rpm(option, 1)) << option;
    EXPECT_LT(onset_rpm(option, 1), onset_rpm(option, 2)) << option;
  }
  EXPECT_GT(onset_rpm("mass", 0.5), onset_rpm("mass", 1));
  EXPECT_GT(onset_rpm("mass", 1), onset_rpm("mass", 2));
}

TEST(Redline, VariesWhatItSaysAndNothingElse) {
  const EngineFile file = read_engine_file(kOhc125, {});
  const Valve v = LoneValve(file, "intake").valve();
  const Valve mass = varied(v, "mass", 2);
  EXPECT_EQ(mass.valve_kg, 2 * v.valve_kg);
  EXPECT_EQ(mass.spring_kg, 2 * v.spring_kg);
  EXPECT_EQ(mass.rocker_inertia_kg_m2, 2 * v.rocker_inertia_kg_m2);
  EXPECT_EQ(mass.train_N_m, v.train_N_m);
  EXPECT_EQ(varied(v, "train", 3).train_N_m, 3 * v.train_N_m);
  EXPECT_EQ(varied(v, "train", 3).spring_N_m, v.spring_N_m);
  EXPECT_EQ(varied(v, "spring", 3).spring_N_m, 3 * v.spring_N_m);
  EXPECT_EQ(varied(v, "spring", 3).spring_preload_N, v.spring_preload_N);
  EXPECT_EQ(varied(v, "preload", 3).spring_preload_N, 3 * v.spring_preload_N);
  const Valve damped = varied(v, "damping", 0.5);
  EXPECT_EQ(damped.train_damping_ratio, v.train_damping_ratio / 2);
  EXPECT_EQ(damped.guide_damping_ratio, v.guide_damping_ratio / 2);
  EXPECT_EQ(damped.seat_damping_ratio, v.seat_damping_ratio / 2);
}

// ---- the commands ----

std::vector<std::string> split_at(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

class ValveCommands : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

  static std::string run(const Command& command, const std::vector<std::string>& words) {
    testing::internal::CaptureStdout();
    const int status = command.run(Arguments(command, words));
    const std::string printed = testing::internal::GetCapturedStdout();
    EXPECT_EQ(status, kSuccess);
    return printed;
  }
  /// What the command refuses, or "" if it does not.
  static std::string refusal(const Command& command, const std::vector<std::string>& words) {
    try {
      run(command, words);
    } catch (const InputError& error) {
      testing::internal::GetCapturedStdout();
      return error.what();
    }
    return "";
  }
  /// Lines "name = value unit": value and unit by name.
  static std::map<std::string, std::pair<std::string, std::string>> lines(const std::string& summary) {
    std::map<std::string, std::pair<std::string, std::string>> found;
    for (const std::string& text : split_at(summary, '\n')) {
      std::istringstream stream(text);
      std::string name;
      std::string equals;
      std::pair<std::string, std::string> value;
      stream >> name >> equals >> value.first >> value.second;
      if (equals == "=") found[name] = value;
    }
    return found;
  }

  support::TemporaryFolder folder_;
};

TEST_F(ValveCommands, TheSummaryNamesEverythingWithItsUnit) {
  const auto found = lines(run(kValve, {kOhc125, "--train", "intake", "--rpm", "7000"}));
  const std::map<std::string, std::string> units{{"max_theoretical_lift", "mm"},
                                                 {"max_lift", "mm"},
                                                 {"opening_delay", "deg"},
                                                 {"separations", "#"},
                                                 {"separation_max_gap", "mm"},
                                                 {"separation_duration", "deg"},
                                                 {"seating_speed", "m/s"},
                                                 {"bounces", "#"},
                                                 {"bounce_height", "mm"},
                                                 {"natural_frequency", "Hz"},
                                                 {"seat_frequency", "Hz"},
                                                 {"spring_margin", "#"},
                                                 {"static_redline", "rpm"},
                                                 {"sub_steps", "#"},
                                                 {"events", "#"},
                                                 {"periodic", "#"}};
  for (const auto& [name, unit] : units) {
    ASSERT_TRUE(found.count(name)) << name;
    EXPECT_EQ(found.at(name).second, unit) << name;
  }
  EXPECT_EQ(found.at("max_lift").first, "7.78509");
  EXPECT_EQ(found.at("periodic").first, "yes");
  // sqrt(k / M) by hand: 11765 + 40 N/mm on 33 + 20 g and the rocker's share.
  EXPECT_NEAR(std::stod(found.at("natural_frequency").first), 2216, 1);
}

TEST_F(ValveCommands, ACycleThatRepeatsItselfDiffersByNothing) {
  for (const char* train : {"intake", "exhaust"}) {
    const std::string told = run(kValve, {support::kSample, "--train", train, "--rpm", "2000"});
    EXPECT_NE(told.find("cycle_difference = 0 um  #"), std::string::npos) << told;
  }
}

TEST_F(ValveCommands, TheStaticRedlineIsThatOfTheTrainsForceBalance) {
  // By hand, from differences of the lift at 24.6 deg: tests/unit/spring_margin_test.cpp.
  constexpr double kStatic_rpm = 8954.39;
  const std::string told = run(kValve, {kOhc125, "--train", "intake", "--rpm", "-7000", "--plot", path("v.svg")});
  const auto found = lines(told);
  EXPECT_EQ(found.at("static_redline").first, "8954.39");
  EXPECT_NEAR(std::stod(found.at("spring_margin").first), std::pow(kStatic_rpm / 7000, 2), 1e-5);
  EXPECT_NE(told.find("# least of rigid parts, at 24.6 deg:"), std::string::npos) << told;
  EXPECT_NE(contents(path("v.svg")).find("; spring margin at least 1.64, at 24.6\u00B0"), std::string::npos);
  const std::string shown = run(kShow, {kOhc125});
  EXPECT_NE(shown.find("\n# static redline of train intake: 8954.39 rpm, at 24.6 cam deg from full lift;"),
            std::string::npos)
      << shown;

  const ChangedFile wide(kOhc125, "clearance_mm", "clearance_mm = 9");  // more than the cam lifts
  const std::string shut = run(kValve, {wide.path(), "--train", "intake", "--rpm", "7000", "--plot", path("v.svg")});
  EXPECT_NE(shut.find("\nspring_margin = none  # the valve never opens\nstatic_redline = none\n"), std::string::npos);
  EXPECT_NE(contents(path("v.svg")).find("; no spring margin: the valve never opens"), std::string::npos);
  EXPECT_NE(run(kShow, {wide.path()}).find("\n# static redline of train intake: none, its valve never opens\n"),
            std::string::npos);
  const std::string redline =
      run(kRedline, {wide.path(), "--train", "intake", "--from", "7000", "--to", "7001", "--csv", path("r.csv")});
  EXPECT_NE(redline.find("\nstatic_redline = none  # the valve never opens\n"), std::string::npos) << redline;
  EXPECT_EQ(redline.find("left out"), std::string::npos) << redline;
  EXPECT_EQ(split_at(contents(path("r.csv")), '\n').back(), "1,7001,0,0,0,0,0,0,0,0,0,");
}

TEST_F(ValveCommands, AValveInTheAirHasNoOpeningDelay) {
  // At 16 000 rpm the valve has not come down when its cam lifts it again: neither 0 deg late nor any.
  const std::string told = run(kValve, {kOhc125, "--train", "intake", "--rpm", "16000"});
  EXPECT_NE(told.find("opening_delay = none  # off its seat before its cam lifted it\n"), std::string::npos) << told;
  const ChangedFile wide(kOhc125, "clearance_mm", "clearance_mm = 9");  // more than the cam lifts
  const std::string shut = run(kValve, {wide.path(), "--train", "intake", "--rpm", "7000"});
  EXPECT_NE(shut.find("opening_delay = none  # it does not rise by 0.1 mm\n"), std::string::npos) << shut;
  EXPECT_NE(shut.find("separation_start = none\n"), std::string::npos) << shut;
  run(kValve, {kOhc125, "--train", "intake", "--rpm", "16000", "--plot", path("v.svg")});
  EXPECT_NE(contents(path("v.svg")).find("no opening delay"), std::string::npos);
}

TEST_F(ValveCommands, TheCsvHasARowForEveryTickOfACycle) {
  run(kValve, {kOhc125, "--train", "intake", "--rpm", "6000", "--tick-us", "50", "--csv", path("v.csv")});
  const std::vector<std::string> rows = split_at(contents(path("v.csv")), '\n');
  ASSERT_EQ(rows[0],
            "cam_deg,theoretical_lift_mm,rocker_ratio,lift_mm,velocity_m_s,acceleration_m_s2,train_force_N,seat_force_"
            "N,cam_force_N,train_compression_mm,regime");
  ASSERT_EQ(rows.size(), 1u + 400 + 1);  // 20 ms, both ends shown
  const auto cells = [&](std::size_t row) {
    std::vector<double> values;
    for (const std::string& cell : split_at(rows[row], ',')) values.push_back(std::stod(cell));
    return values;
  };
  EXPECT_EQ(cells(1)[0], -180);
  EXPECT_NEAR(cells(201)[0], 0, 1e-6);
  EXPECT_NEAR(cells(201)[1], 7.815, 1e-4);
  EXPECT_NEAR(cells(401)[0], 180, 1e-6);
  for (std::size_t row = 1; row < rows.size(); ++row) {
    const std::vector<double> c = cells(row);
    ASSERT_EQ(c.size(), 11u);
    if (c[1] > 0) {
      EXPECT_NEAR(c[9], c[1] - c[3], 1e-9) << rows[row];  // gap = Y - y
    }
    EXPECT_NEAR(c[8], c[6] * c[2], 1e-3 + 1e-6 * c[8]) << rows[row];
  }
}

/// The areas of the ticks, summed by hand; the elastic valve opens later and less far than theory, until it floats.
TEST_F(ValveCommands, TellsTheFlowAreaOfTheElasticValveBesideTheory) {
  const ChangedFile sized(kOhc125, "head_area_mm2", "head_diameter_mm = 26\nseat_width_mm = 1");
  const auto found = lines(
      run(kValve, {sized.path(), "--train", "intake", "--rpm", "6000", "--tick-us", "10", "--csv", path("v.csv")}));
  const auto value = [&found](const std::string& name) {
    EXPECT_TRUE(found.count(name)) << name;
    return found.count(name) ? std::stod(found.at(name).first) : 0;
  };
  const std::vector<std::string> rows = split_at(contents(path("v.csv")), '\n');
  EXPECT_NE(rows[0].find(",regime,flow_area_mm2,effective_area_mm2"), std::string::npos) << rows[0];
  struct Opening {
    double open, geometric, effective;
  };
  Opening here{};
  Opening largest{};
  const double contact_mm = 205.8 / 100e6 * 1e3;
  for (std::size_t row = 2; row < rows.size(); ++row) {  // 2000 ticks of 0.36 deg of the crank
    std::vector<double> c;
    for (const std::string& cell : split_at(rows[row], ',')) c.push_back(std::stod(cell));
    ASSERT_EQ(c.size(), 13u);
    if (c[3] <= 0) {
      EXPECT_EQ(c[11], 0) << rows[row];
    }
    if (c[3] <= contact_mm) here = {};
    if (c[3] > contact_mm) here = {here.open + 0.36, here.geometric + 0.36 * c[11], here.effective + 0.36 * c[12]};
    if (here.geometric > largest.geometric) largest = here;  // the opening; what bounces behind it is less
  }
  const auto [open, geometric, effective] = largest;
  EXPECT_NEAR(value("flow_area_integral"), geometric, 1e-5 * geometric);
  EXPECT_NEAR(value("effective_area_integral"), effective, 1e-5 * effective);
  EXPECT_NEAR(value("open_period"), open, 4 * 0.36);
  EXPECT_NEAR(value("flow_area_mean") * value("open_period"), geometric, 1e-5 * geometric);
  EXPECT_EQ(found.at("flow_area_integral").second, "mm^2");
  EXPECT_LT(value("flow_area_integral"), value("theoretical_flow_area_integral"));
  EXPECT_GT(value("flow_area_integral"), 0.97 * value("theoretical_flow_area_integral"));
  EXPECT_LT(value("open_period"), value("theoretical_open_period"));
  EXPECT_NEAR(value("mean_gas_speed") * value("flow_area_mean"), std::acos(-1.0) / 4 * 52.4 * 52.4 * 11.56, 0.2);
  EXPECT_GT(value("inlet_mach_index"), 0);

  const auto floating = lines(run(kValve, {sized.path(), "--train", "intake", "--rpm", "12000"}));
  EXPECT_GT(std::stod(floating.at("flow_area_integral").first), value("theoretical_flow_area_integral"));
  EXPECT_EQ(floating.at("theoretical_flow_area_integral"), found.at("theoretical_flow_area_integral"));
}

TEST_F(ValveCommands, APlotIsAPictureOfItsOwnInBothThemes) {
  run(kValve, {kOhc125, "--train", "intake", "--rpm", "7000", "--tick-us", "5", "--plot", path("v.svg")});
  const std::string svg = contents(path("v.svg"));
  const support::Markup markup = support::read(svg);
  ASSERT_EQ(markup.fault, "");
  EXPECT_EQ(markup.elements[0].name, "svg");
  EXPECT_EQ(markup.elements[0].attributes.at("xmlns"), "http://www.w3.org/2000/svg");
  EXPECT_EQ(markup.of_class("plot").size(), 4u);
  ASSERT_EQ(markup.of_class("sheet-title").size(), 1u);
  EXPECT_EQ(markup.of_class("sheet-title")[0].text, "Valve train intake at 7000 rpm of the engine");
  EXPECT_NE(svg.find("@media screen and (prefers-color-scheme: dark)"), std::string::npos);
  for (const char* outside : {"href", "src=", "@import", "url(h", "<script"})
    EXPECT_EQ(svg.find(outside), std::string::npos) << outside;
  std::set<std::string> ids;
  for (const support::Element& element : markup.elements) {
    const auto id = element.attributes.find("id");
    if (id == element.attributes.end()) continue;
    EXPECT_TRUE(ids.insert(id->second).second) << id->second;
  }
}

/// The description of the one plot whose title this is.
std::string description_of(const support::Markup& markup, const std::string& title) {
  const std::vector<support::Element> titles = markup.all("title");
  const std::vector<support::Element> descriptions = markup.all("desc");  // one per plot; the sheet has a title only
  for (std::size_t i = 0; i < descriptions.size(); ++i) {
    if (titles.at(i + 1).text == title) return descriptions[i].text;
  }
  return "";
}

/// "from a to b" behind "name: " in a description; -1e9 where the name is missing.
std::pair<double, double> span_in(std::string description, const std::string& name) {
  const auto replace_all = [&](const std::string& from, const std::string& to) {
    for (std::size_t at; (at = description.find(from)) != std::string::npos;) description.replace(at, from.size(), to);
  };
  replace_all("\u2212", "-");
  replace_all("\u202F", "");
  replace_all("\u2009", "");
  const std::size_t at = description.find(" " + name + ": from ");
  if (at == std::string::npos) return {-1e9, -1e9};
  std::istringstream stream(description.substr(at + name.size() + 8));
  std::pair<double, double> span;
  std::string to;
  stream >> span.first >> to >> span.second;
  EXPECT_EQ(to, "to") << description;
  return span;
}

/// The area's largest value is the port's less the stem, the lift's at 6000 rpm lets it through; the effective one is
/// that of the CSV.
TEST_F(ValveCommands, APlotShowsTheFlowAreaWhereTheFileHasADiameterOfTheValve) {
  constexpr const char* kFour = CRANKLOOP_SOURCE_DIR "/tools/engines/four_2000.ini";
  run(kValve, {kFour, "--train", "intake", "--rpm", "6000", "--csv", path("v.csv"), "--plot", path("v.svg")});
  const support::Markup markup = support::read(contents(path("v.svg")));
  EXPECT_EQ(markup.of_class("plot").size(), 5u);
  const std::string area = description_of(markup, "Flow area of one valve");
  EXPECT_NEAR(span_in(area, "geometric").second, std::acos(-1.0) / 4 * (33 * 33 - 6.6 * 6.6), 0.5);  // three digits
  std::ifstream table(path("v.csv"));
  std::string row;
  std::getline(table, row);
  double largest = 0;
  while (std::getline(table, row)) largest = std::max(largest, std::stod(row.substr(row.rfind(',') + 1)));
  EXPECT_NEAR(span_in(area, "effective").second, largest, 0.5);
  run(kValve, {kOhc125, "--train", "intake", "--rpm", "7000", "--plot", path("v.svg")});
  EXPECT_EQ(description_of(support::read(contents(path("v.svg"))), "Flow area of one valve"), "");
}

TEST_F(ValveCommands, APlotTellsSeparationFromBounceFromCompression) {
  constexpr double kDigits = 0.005;  // descriptions have three digits
  const auto picture = [&](const char* rpm, std::map<std::string, std::pair<std::string, std::string>>& found) {
    found = lines(run(kValve, {kOhc125, "--train", "intake", "--rpm", rpm, "--tick-us", "2", "--plot", path("v.svg")}));
    return support::read(contents(path("v.svg")));
  };
  const auto um = [](const std::pair<std::string, std::string>& mm) { return 1e3 * std::stod(mm.first); };
  std::map<std::string, std::pair<std::string, std::string>> found;

  const support::Markup at_7000 = picture("7000", found);
  const std::string gap_at_7000 = description_of(at_7000, "Train lift less valve lift");
  EXPECT_EQ(gap_at_7000.find("separation"), std::string::npos) << gap_at_7000;
  EXPECT_GT(span_in(gap_at_7000, "on the train").second, 50);  // compressed by its force, 0.7 kN on 11765 N/mm
  EXPECT_LT(span_in(gap_at_7000, "on the train").second, 70);
  const double contact_um = 205.8 / 100e6 * 1e6;  // delta_0: the closed valve lies that far below the seat's contact
  EXPECT_NEAR(span_in(description_of(at_7000, "Seating, closer"), "bounce").second, um(found.at("bounce_height")),
              kDigits * 20 + 0.1);
  EXPECT_LT(span_in(description_of(at_7000, "Seating, closer"), "on the seat").first, -contact_um);
  EXPECT_EQ(span_in(description_of(at_7000, "Seating, closer"), "seat contact"), std::make_pair(0.0, 0.0));

  const support::Markup at_12000 = picture("12000", found);
  const double widest_um = um(found.at("separation_max_gap"));
  EXPECT_GT(widest_um, 1000);
  EXPECT_NEAR(span_in(description_of(at_12000, "Train lift less valve lift"), "separation").first, -widest_um,
              kDigits * widest_um);
  EXPECT_GT(span_in(description_of(at_12000, "Forces on the valve"), "seat").second, 10);  // it lands at 7.8 m/s
}

TEST_F(ValveCommands, APlotOfAValveThatNeverSeatsOrNeverOpensIsStillOne) {
  const auto plots = [&](const std::string& file, const char* rpm) {
    run(kValve,
        {file, "--train", "intake", "--rpm", rpm, "--tick-us", "50", "--real", "float", "--plot", path("v.svg")});
    const support::Markup markup = support::read(contents(path("v.svg")));
    EXPECT_EQ(markup.fault, "");
    return markup.of_class("plot").size();
  };
  const ChangedFile wide(kOhc125, "clearance_mm", "clearance_mm = 9");  // more than the cam lifts
  EXPECT_EQ(plots(wide.path(), "7000"), 3u);
  EXPECT_EQ(plots(kOhc125, "-7000"), 4u);
  const ChangedFile soft(kOhc125, "spring_preload_N", "spring_preload_N = 0.1");
  EXPECT_GE(plots(soft.path(), "20000"), 3u);
}

/// Rigid parts by differences of the lift that `lift` prints, the valve's by differences of its rows, either way round.
TEST_F(ValveCommands, TheSummaryHasSpeedsOfOpeningAndClosingBesideThoseOfRigidParts) {
  const auto column = [&](const char* name, std::size_t at) {
    std::vector<double> values;
    std::istringstream rows(contents(path(name)));
    std::string row;
    std::getline(rows, row);
    while (std::getline(rows, row)) values.push_back(std::stod(split_at(row, ',').at(at)));
    return values;
  };
  run(kLift, {kOhc125, "--train", "intake", "--step-deg", "0.1", "--csv", path("lift.csv")});
  const std::vector<double> lift_mm = column("lift.csv", 2);
  for (const double rpm : {7000.0, -7000.0}) {
    const std::string text = run(kValve, {kOhc125, "--train", "intake", "--rpm", std::to_string(rpm), "--tick-us", "2",
                                          "--csv", path("valve.csv")});
    double rigid_most = 0, rigid_least = 0, most = 0, least = 0;
    const double row_s = 0.1 / (6 * rpm / 2);  // of 0.1 cam deg; backwards it is negative
    for (std::size_t i = 0; i + 1 < lift_mm.size(); ++i) {
      if (lift_mm[i] < 0.01) continue;
      const double speed_m_s = (lift_mm[i + 1] - lift_mm[i]) / 1e3 / row_s;
      rigid_most = std::max(rigid_most, speed_m_s), rigid_least = std::min(rigid_least, speed_m_s);
    }
    const std::vector<double> elastic_mm = column("valve.csv", 3);
    for (std::size_t i = 0; i + 1 < elastic_mm.size(); ++i) {
      const double speed_m_s = (elastic_mm[i + 1] - elastic_mm[i]) / 1e3 / 2e-6;
      most = std::max(most, speed_m_s), least = std::min(least, speed_m_s);
    }
    const auto found = lines(text);
    EXPECT_NEAR(std::stod(found.at("opening_velocity").first), most, 2e-3 * most) << rpm;
    EXPECT_NEAR(std::stod(found.at("closing_velocity").first), least, -2e-3 * least) << rpm;
    const auto of_rigid_parts = [&](const std::string& name) {
      const std::string words = "# of rigid parts ";
      return std::stod(text.substr(text.find(words, text.find(name)) + words.size()));
    };
    EXPECT_NEAR(of_rigid_parts("opening_velocity"), rigid_most, 2e-3 * rigid_most) << rpm;
    EXPECT_NEAR(of_rigid_parts("closing_velocity"), rigid_least, -2e-3 * rigid_least) << rpm;
  }
}

TEST_F(ValveCommands, APlotThatCannotBeWrittenLeavesNothingBehind) {
  const std::vector<std::string> words{kOhc125, "--train", "intake", "--rpm", "7000"};
  const auto refused = [&](std::vector<std::string> outputs) {
    outputs.insert(outputs.begin(), words.begin(), words.end());
    EXPECT_THROW(kValve.run(Arguments(kValve, outputs)), OutputError);
  };
  refused({"--csv", path("v.csv"), "--plot", path("nowhere/v.svg")});
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  refused({"--csv", path("nowhere/v.csv"), "--plot", path("v.svg")});
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  std::ofstream(path("v.svg")) << "old";
  refused({"--csv", path("nowhere/v.csv"), "--plot", path("v.svg")});
  EXPECT_EQ(contents(path("v.svg")), "old");
  EXPECT_NE(refusal(kValve, {kOhc125, "--train", "intake", "--rpm", "0.2", "--tick-us", "100", "--cycles", "1",
                             "--plot", path("v.svg")})
                .find("can be drawn"),
            std::string::npos);
  EXPECT_EQ(contents(path("v.svg")), "old");
}

TEST_F(ValveCommands, ARunShowsTheValvesInSummaryAndReport) {
  const auto found = lines(run(kRun, {kOhc125, "--rpm", "12000", "--tick-us", "20", "--report", path("run.html")}));
  EXPECT_EQ(found.at("intake_max_lift").second, "mm");
  EXPECT_EQ(found.at("intake_separations").first, "1");
  EXPECT_GT(std::stod(found.at("intake_separation_max_gap").first), 1);
  EXPECT_GT(std::stod(found.at("intake_bounce_height").first), 2);
  const std::string page = contents(path("run.html"));
  for (const char* words :
       {"Valve train", "theory", "seat contact", "Valve timing", "At this speed the valve leaves its train: intake.",
        "separation", "bounce", "Seating of the intake valve"}) {
    EXPECT_NE(page.find(words), std::string::npos) << words;
  }
}

TEST_F(ValveCommands, ATickTooLongIsRefusedWithTheLongestThatIsAccepted) {
  const ChangedFile stiff(kOhc125, "seat_N_per_mm", "seat_N_per_mm = 10000000");
  const auto refused = [&](const std::string& tick_us) {
    return refusal(kValve,
                   {stiff.path(), "--train", "intake", "--rpm", "7000", "--tick-us", tick_us, "--accuracy-um", "0.01"});
  };
  const std::string message = refused("2000");
  const std::string words = "the longest tick possible is ";
  ASSERT_NE(message.find(words), std::string::npos) << message;
  EXPECT_EQ(message.rfind(stiff.path() + ": ", 0), 0u) << message;
  const std::string longest = split_at(message.substr(message.find(words) + words.size()), ' ')[0];
  EXPECT_EQ(refused(longest), "");
  EXPECT_NE(refused(std::to_string(std::stod(longest) * 1.05)), "");
  EXPECT_EQ(refusal(kTables, {stiff.path(), "--tick-us", "2000", "--accuracy-um", "0.01"}), message);
}

TEST_F(ValveCommands, NothingIsWrittenWhereSomethingIsRefused) {
  const std::vector<std::vector<std::string>> refused{
      {"--train", "intaek", "--rpm", "7000"},
      {"--train", "intake", "--rpm", "0"},
      {"--train", "intake", "--rpm", "40000", "--tick-us", "1900"},
      {"--train", "intake", "--rpm", "0.001"},
      {"--train", "intake", "--rpm", "7000", "--tick-us", "2001"},
  };
  for (std::vector<std::string> words : refused) {
    words.insert(words.begin(), kOhc125);
    words.insert(words.end(), {"--csv", path("v.csv"), "--plot", path("v.svg")});
    EXPECT_NE(refusal(kValve, words), "");
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path())) << words[2] << " " << words[4];
  }
}

TEST_F(ValveCommands, ATrainNeedsNothingOfItsEngine) {
  const std::string text = contents(kOhc125);
  const std::size_t cam = text.find("[cam intake]");
  std::ofstream(path("train.ini")) << text.substr(cam, text.find("# Trigger wheels") - cam);
  const auto alone = lines(run(kValve, {path("train.ini"), "--train", "intake", "--rpm", "9500"}));
  const auto whole = lines(run(kValve, {kOhc125, "--train", "intake", "--rpm", "9500"}));
  EXPECT_EQ(alone, whole);
}

TEST_F(ValveCommands, ATrainThatLacksAPartIsTold) {
  std::string text = contents(kOhc125);
  std::ofstream(path("train.ini")) << text.substr(0, text.find("[valve intake]"));
  EXPECT_NE(
      refusal(kValve, {path("train.ini"), "--train", "intake", "--rpm", "7000"}).find("[valve intake] is missing"),
      std::string::npos);
  EXPECT_NE(refusal(kRedline, {path("train.ini"), "--train", "intake"}).find("[valve intake] is missing"),
            std::string::npos);
}

TEST_F(ValveCommands, ARedlineSaysWhichOnsetsLieBelowTheRatedSpeed) {
  const std::string page = path("r.html");
  const std::string text =
      run(kRedline, {kOhc125, "--train", "intake", "--from", "5000", "--to", "9000", "--report", page});
  const auto remark_of = [&text](const std::string& name) {
    const std::string from_name = text.substr(text.find(name + " = "));
    return from_name.substr(0, from_name.find('\n'));
  };
  EXPECT_NE(remark_of("seating_limit").find("  # below rated_rpm = 7000"), std::string::npos) << text;
  EXPECT_EQ(remark_of("separation_onset").find('#'), std::string::npos) << text;
  EXPECT_NE(contents(page).find("the engine is rated at 7000"), std::string::npos);
}

TEST_F(ValveCommands, ARedlineTellsBothOnsetsAndWritesItsTableAndPage) {
  const auto found = lines(run(kRedline, {kOhc125, "--train", "intake", "--from", "8000", "--to", "9500", "--vary",
                                          "spring", "--csv", path("r.csv"), "--report", path("r.html")}));
  EXPECT_EQ(found.at("separation_onset").second, "rpm");
  EXPECT_NEAR(std::stod(found.at("separation_onset").first), 8500,
              300);  // spec of the train: floats only from about 8500
  const std::vector<std::string> rows = split_at(contents(path("r.csv")), '\n');
  EXPECT_EQ(rows[0].substr(0, 17), "factor,speed_rpm,");
  EXPECT_EQ(rows.size(), 1u + 7 * 61);
  // Compared at the sweep's first speed above the onset as given, in steps of 25 rpm: not where the motion is
  // aperiodic.
  const double onset_rpm = std::stod(found.at("separation_onset").first);
  const double compared_rpm = 25 * (std::floor(onset_rpm / 25) + 1);
  const std::string table =
      run(kRedline, {kOhc125, "--train", "intake", "--from", "8000", "--to", "9500", "--vary", "spring"});
  EXPECT_NE(table.find("from max_lift_mm on at " + std::to_string(static_cast<int>(compared_rpm)) + " rpm"),
            std::string::npos);
  const std::string page = contents(path("r.html"));
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_NE(page.find("spring_N_per_mm"), std::string::npos);
}

TEST_F(ValveCommands, ARedlineNamesItsCurvesAtTheirEndsAndCutsThemWhereTheValveFloats) {
  for (const char* what : {"spring", "damping"}) {  // ends apart, and together
    run(kRedline, {kOhc125, "--train", "intake", "--vary", what, "--csv", path("r.csv"), "--report", path("r.html")});
    const support::Markup page = support::read(contents(path("r.html")));
    EXPECT_EQ(support::labels_in_the_way(page), std::vector<std::string>{}) << what;
    EXPECT_EQ(page.of_class("leader").size(), 6u * 7);
    for (const support::Element& one : page.all("desc")) {
      if (one.text.find("Lift over") == 0) {
        EXPECT_EQ(one.text.find("to 8."), std::string::npos) << one.text;  // of 7.815 mm
      }
    }
  }
}

/// A sweep that ends below rated speed, or begins far above it, would pass for a clean one.
TEST_F(ValveCommands, ARedlinesRangeHoldsTheRatedSpeedOfSlowAndFastEngines) {
  const auto range_at = [&](const char* rated) {
    const ChangedFile faster(kOhc125, "max_rpm", "max_rpm = 20000");
    const ChangedFile file(faster.path().c_str(), "rated_rpm", std::string("rated_rpm = ") + rated);
    const std::string text = run(kRedline, {file.path(), "--train", "intake", "--no-warnings"});
    const std::size_t at = text.find("train intake, ") + 14;
    return text.substr(at, text.find(" of the engine") - at);
  };
  EXPECT_EQ(range_at("7000"), "500 to 15000 rpm");
  EXPECT_EQ(range_at("18000"), "500 to 36000 rpm");
  EXPECT_EQ(range_at("100"), "25 to 2000 rpm");
}

TEST_F(ValveCommands, ARedlineTellsTheStaticOneBesideTheOnset) {
  const std::vector<std::string> range{"--train", "intake", "--from", "8500", "--to", "9060"};
  const auto told = [&](const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> words{file};
    words.insert(words.end(), range.begin(), range.end());
    words.insert(words.end(), more.begin(), more.end());
    return run(kRedline, words);
  };
  const std::string above = told(kOhc125, {"--csv", path("r.csv")});
  EXPECT_NE(above.find("\nstatic_redline = 8954.39 rpm  # of rigid parts without damping, at 24.6 deg; 4.6 % above the "
                       "onset, which has vibration and the guide's damping too\n"),
            std::string::npos)
      << above;
  const std::vector<std::string> rows = split_at(contents(path("r.csv")), '\n');
  EXPECT_EQ(split_at(rows[0], ',').back(), "spring_margin");
  for (std::size_t row = 1; row < rows.size(); ++row) {
    const std::vector<std::string> cells = split_at(rows[row], ',');
    EXPECT_NEAR(std::stod(cells.back()), std::pow(8954.387 / std::stod(cells[1]), 2), 1e-6) << rows[row];
  }
  // Critically damped, and free in its guide: the vibration that is left loads the train.
  const ChangedFile damped(kOhc125, "train_damping_ratio", "train_damping_ratio = 1");
  const ChangedFile free(damped.path().c_str(), "guide_damping_ratio", "guide_damping_ratio = 0");
  const std::string below = told(free.path(), {});
  EXPECT_NE(below.find(" % below the onset: vibration loads the train"), std::string::npos) << below;
  // What a line blames is in the train.
  const ChangedFile no_guide(kOhc125, "guide_damping_ratio", "guide_damping_ratio = 0");
  EXPECT_NE(told(no_guide.path(), {}).find(" % above the onset, which has vibration too\n"), std::string::npos);
  const ChangedFile with_gas(no_guide.path().c_str(), "head_area_mm2", "head_area_mm2 = 600");
  const std::string by_gas = told(with_gas.path(), {});
  EXPECT_NE(by_gas.find(" % above the onset, which has vibration and gas on the head too\n"), std::string::npos)
      << by_gas;
  EXPECT_NE(by_gas.find("\n# with the gas force on the head, full load\n"), std::string::npos);

  // As 1 / sqrt(mass), whatever the train's stiffness and damping.
  told(kOhc125, {"--vary", "mass", "--report", path("r.html")});
  const std::string page = contents(path("r.html"));
  for (const double factor : {0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0}) {
    char rpm[40];
    std::snprintf(rpm, sizeof rpm, "%.0f rpm", 8954.387 / std::sqrt(factor));
    EXPECT_NE(page.find(rpm), std::string::npos) << factor << ": " << rpm;
  }
  EXPECT_NE(page.find("static redline"), std::string::npos);
}

/// A hundredth of the preload: the valve flies through its spring.
TEST_F(ValveCommands, ARedlineLeavesOutLiftsThatNoSpringAllows) {
  const ChangedFile weak(kOhc125, "spring_preload_N", "spring_preload_N = 2");
  const std::vector<std::string> words = {weak.path(), "--train", "intake", "--from", "6000", "--to", "15000"};
  const auto with = [&words](const std::vector<std::string>& more) {
    std::vector<std::string> all = words;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const std::string text = run(kRedline, with({"--csv", path("r.csv"), "--report", path("r.html")}));
  const std::size_t said = text.find("# left out: ");
  ASSERT_NE(said, std::string::npos) << text;
  const EngineFile file = read_engine_file(weak.path(), {});
  const LoneValve valve(file, "intake");
  const double most_mm = 1.5 * 7.815;  // the sample's theoretical lift: README.md
  int left_out = 0;
  for (const std::string& row : split_at(contents(path("r.csv")), '\n')) {
    if (row.empty() || row[0] == 'f') continue;
    const std::vector<std::string> cells = split_at(row, ',');
    ASSERT_EQ(std::count(row.begin(), row.end(), ','), 11) << row;
    const double lift_mm = 1e3 * program::run<double>(valve, std::stod(cells[1])).results.largest_lift_m;
    EXPECT_EQ(cells[2].empty(), lift_mm > most_mm) << row << ": " << lift_mm;
    if (!cells[2].empty()) continue;
    ++left_out;
    for (std::size_t i = 2; i < cells.size(); ++i) EXPECT_EQ(cells[i], "") << row;
  }
  EXPECT_GT(left_out, 0);
  EXPECT_EQ(text.compare(said, 14, "# left out: " + std::to_string(left_out).substr(0, 2)), 0) << text.substr(said, 60);
  EXPECT_NE(contents(path("r.html")).find("1.5 times the theoretical lift"), std::string::npos);
  EXPECT_NE(text.find("  -  "), std::string::npos) << "a masked cell of the table";

  // A stated coil bind masks more, and one below the lift of the cam is a mistake.
  const std::string bound = run(kRedline, with({"--coil-bind-mm", "8.5"}));
  EXPECT_NE(bound.find("beyond 8.5 mm, where its spring binds"), std::string::npos) << bound;
  EXPECT_NE(refusal(kRedline, with({"--coil-bind-mm", "7.5"})).find("--coil-bind-mm must be above"), std::string::npos);
}

TEST_F(ValveCommands, ARedlineTellsWhereTheValveMeetsItsSeatTooFast) {
  const std::vector<std::string> words = {kOhc125, "--train", "intake", "--from", "4000", "--to", "8000"};
  const auto found = lines(run(kRedline, words));
  EXPECT_EQ(found.at("seating_limit").second, "rpm");
  const EngineFile file = read_engine_file(kOhc125, {});
  const LoneValve valve(file, "intake");
  const double rpm = std::stod(found.at("seating_limit").first);
  EXPECT_GT(program::run<double>(valve, rpm).results.seating_speed_m_s, 0.5);
  EXPECT_LE(program::run<double>(valve, rpm - 1).results.seating_speed_m_s, 0.5);
  EXPECT_EQ(found.at("bounce_onset").first, "none") << "micrometres are no bounce";
  std::vector<std::string> slower = words;
  slower.insert(slower.end(), {"--seating-m-s", "0.7"});
  EXPECT_GT(std::stod(lines(run(kRedline, slower)).at("seating_limit").first), rpm + 500);
}

TEST_F(ValveCommands, ARedlineRefusesWhatMakesNoSense) {
  EXPECT_NE(refusal(kRedline, {kOhc125, "--train", "intake", "--from", "5000", "--to", "5000"}), "");
  const ChangedFile changed(kOhc125, "spring_N_per_mm", "spring_N_per_mm = 0");
  EXPECT_NE(refusal(kRedline, {changed.path(), "--train", "intake", "--vary", "spring"}).find("nothing to vary"),
            std::string::npos);
}

}  // namespace
}  // namespace crankloop::program::valve_command_test
