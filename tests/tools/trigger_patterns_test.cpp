// Wheels by name: that each has the edges of its source, stands where first_tooth_deg says, and is told to users.
#include "crankloop/engine_file/trigger_patterns.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "crankloop/engine_file/engine_file.hpp"

namespace crankloop::program::trigger_patterns_test {
namespace {

constexpr const char* kOneCylinder =
    "[engine]\nname = one\nrated_rpm = 5000\n[crank]\nbore_mm = 80\nstroke_mm = 80\nrod_length_mm = 140\n"
    "compression_ratio = 10\n";

/// Rise and fall of each tooth of a wheel, as an engine file with this pattern has it.
std::vector<std::pair<double, double>> teeth(const std::string& pattern, const std::string& shaft, double first_deg) {
  const std::string wheel = "[trigger a]\non = " + shaft + "\npattern = " + pattern + "\ntooth_ratio = 0.4\n" +
                            "first_tooth_deg = " + std::to_string(first_deg) + "\n";
  const EngineFile engine = read_engine_text(kOneCylinder + wheel, "engine.ini", {});
  const TriggerWheel& w = engine.definition().triggers[0];
  std::vector<std::pair<double, double>> found;
  for (int i = 0; i < w.edge_count; i += 2) found.emplace_back(w.edges_deg[i], w.edges_deg[i + 1]);
  if (w.pattern == TriggerPattern::edges) return found;
  const double step_deg = (w.shaft == TriggerShaft::crank ? 360.0 : 720.0) / w.places;
  int place = 0;
  const auto add = [&](int count) {
    for (int i = 0; i < count; ++i, ++place) {
      const double rise_deg = w.first_tooth_deg + place * step_deg;
      found.emplace_back(rise_deg, rise_deg + w.tooth_ratio * step_deg);
    }
  };
  for (int i = 0; i < w.gap_count; ++i) add(w.gaps[i].teeth), place += w.gaps[i].missing;
  add(w.places - place);
  return found;
}

TEST(NamedWheels, HaveTheTeethThatTheirSourcesCount) {
  const std::map<std::string, std::pair<std::size_t, std::size_t>> teeth_of{
      {"bosch-quick-start", {58, 4}}, {"chrysler-ngc-4", {32, 7}},  {"ford-st170", {35, 5}},
      {"gm-ls-24x", {24, 1}},         {"honda-k", {13, 5}},         {"mazda-miata-na", {2, 2}},
      {"mazda-miata-nb", {4, 3}},     {"mitsubishi-4b11", {33, 1}}, {"nissan-sr20-360", {180, 4}},
      {"subaru-36-2-2-2", {30, 2}},   {"subaru-6-7", {6, 7}},       {"toyota-2jz-vvti", {34, 3}}};
  ASSERT_EQ(teeth_of.size(), kWheelPairs);
  for (const WheelPair& pair : wheel_pairs()) {
    ASSERT_EQ(teeth_of.count(pair.name), 1u) << pair.name;
    EXPECT_EQ(teeth(pair.name, "crank", 0).size(), teeth_of.at(pair.name).first) << pair.name;
    EXPECT_EQ(teeth(pair.name, "cam", 0).size(), teeth_of.at(pair.name).second) << pair.name;
  }
}

using Edges = std::vector<std::pair<double, double>>;

/// Edges typed in from the source, in its own frame: a wheel named `name` has them when its first tooth stands at the
/// first of them.
void expect_edges(const char* name, const char* shaft, const Edges& source) {
  const Edges found = teeth(name, shaft, source[0].first);
  ASSERT_EQ(found.size(), source.size()) << name << ' ' << shaft;
  for (std::size_t i = 0; i < source.size(); ++i) {
    EXPECT_NEAR(found[i].first, source[i].first, 1e-9) << name << ' ' << shaft << ", rise of tooth " << i + 1;
    EXPECT_NEAR(found[i].second, source[i].second, 1e-9) << name << ' ' << shaft << ", fall of tooth " << i + 1;
  }
}

/// Of toothed wheels the sources have places, not widths.
void expect_rises(const char* pattern, const char* shaft, const std::vector<double>& source) {
  const Edges found = teeth(pattern, shaft, source[0]);
  ASSERT_EQ(found.size(), source.size()) << pattern;
  for (std::size_t i = 0; i < source.size(); ++i)
    EXPECT_NEAR(found[i].first, source[i], 1e-9) << pattern << ", tooth " << i + 1;
}

/// Rising edges: Speeduino decoders.cpp, triggerSetup_24X. Falling edges every 15 deg and the cam, high through the
/// second turn: Ardu-Stim wheel_defs.h, gm_ls1_crank_and_cam. rusEFI's code word 0x0A33BE gives the same.
TEST(NamedWheels, OfGeneralMotorsHaveTheEdgesOfThreeDecoders) {
  expect_edges("gm-ls-24x", "crank",
               {{12, 15},   {18, 30},   {33, 45},   {48, 60},   {63, 75},   {78, 90},   {102, 105}, {108, 120},
                {123, 135}, {138, 150}, {162, 165}, {177, 180}, {183, 195}, {198, 210}, {222, 225}, {237, 240},
                {252, 255}, {258, 270}, {282, 285}, {288, 300}, {312, 315}, {327, 330}, {342, 345}, {357, 360}});
  expect_edges("gm-ls-24x", "cam", {{360, 720}});  // 348 deg after the crank's first
}

/// rusEFI trigger_mitsubishi.cpp, initialize36_2_1, as its pull request 4645 left it after comparing it with a running
/// 4B11. The cam, half a moon: rusEFI issue 4013.
TEST(NamedWheels, OfMitsubishiHaveSixteenTeethBeforeTheDoubleGap) {
  expect_rises("mitsubishi-4b11", "crank",
               {15,  25,  35,  45,  55,  65,  75,  85,  95,  105, 115, 125, 135, 145, 155, 165, 195,
                205, 215, 225, 235, 245, 255, 265, 275, 285, 295, 305, 315, 325, 335, 345, 355});
  expect_edges("mitsubishi-4b11", "cam", {{0, 360}});
}

/// Crank: rusEFI trigger_subaru.cpp, initialize36_2_2_2 and initializeSubaruEZ30, their rising edges. Cam: VEMS, pulses
/// 45 deg before and 135 deg after cylinder 1's top dead centre, which is at the fourth tooth after the single gap.
TEST(NamedWheels, OfSubaruHaveTheirGapsInTheSenseOfRotation) {
  const std::vector<double> four{0,   10,  20,  30,  40,  50,  60,  70,  80,  90,  100, 110, 120, 150, 160,
                                 170, 180, 190, 200, 210, 220, 230, 240, 250, 260, 270, 280, 290, 300, 330};
  expect_rises("subaru-36-2-2-2", "crank", four);
  expect_rises("36-2-2-2", "crank", four);
  expect_rises("36-2-2-2-H6", "crank", {0,   10,  20,  30,  40,  50,  60,  70,  80,  90,  100, 110, 120, 130, 140,
                                        150, 160, 170, 180, 210, 220, 230, 240, 250, 260, 270, 280, 290, 300, 330});
  const Edges cam = teeth("subaru-36-2-2-2", "cam", 720 - 45);
  ASSERT_EQ(cam.size(), 2u);
  EXPECT_EQ(cam[1].first, 720 + 135);
}

/// rusEFI trigger_subaru.cpp, initializeSubaru7_6; crank 97, 65 and 10 deg before each top dead centre.
TEST(NamedWheels, OfTheOlderSubaruHaveCamTeethInGroupsOfThreeOneTwoOne) {
  expect_edges("subaru-6-7", "crank", {{58, 63}, {90, 95}, {145, 150}, {238, 243}, {270, 275}, {325, 330}});
  expect_edges("subaru-6-7", "cam", {{10, 15}, {175, 180}, {340, 345}, {355, 360}, {370, 375}, {535, 540}, {715, 720}});
}

/// rusEFI trigger_chrysler.cpp, configureNeon2003TriggerWaveformCrank and ...Cam.
TEST(NamedWheels, OfChryslerHaveSixteenTeethBeforeTheGapAndFifteenBeforeTheWideOne) {
  expect_edges("chrysler-ngc-4", "crank",
               {{30, 35},   {40, 45},   {50, 55},   {60, 65},   {70, 75},   {80, 85},   {90, 95},   {100, 105},
                {110, 115}, {120, 125}, {130, 135}, {140, 145}, {150, 155}, {160, 165}, {170, 175}, {180, 185},
                {210, 215}, {220, 225}, {230, 235}, {240, 245}, {250, 255}, {260, 265}, {270, 275}, {280, 285},
                {290, 295}, {300, 305}, {310, 315}, {320, 325}, {330, 335}, {340, 345}, {350, 355}, {360, 385}});
  expect_edges("chrysler-ngc-4", "cam",
               {{144, 180}, {216, 252}, {288, 324}, {360, 504}, {540, 576}, {612, 648}, {684, 720}});
}

/// Cam: rusEFI, configureFordST170.
TEST(NamedWheels, OfTheFordST170HaveThreeCamTeethNinetyDegreesApart) {
  expect_edges("ford-st170", "cam", {{80, 90}, {170, 180}, {350, 360}, {530, 540}, {710, 720}});
  EXPECT_EQ(teeth("ford-st170", "crank", 18).back().first, 358);  // Ardu-Stim: 35 teeth from 18 deg on, its gap at 8
}

/// rusEFI trigger_universal.cpp, configureQuickStartSenderWheel, whose cam degrees are doubled here.
TEST(NamedWheels, OfBoschsQuickStartHaveTheWideTeethSideBySide) {
  expect_edges("bosch-quick-start", "cam", {{40, 180}, {220, 260}, {400, 440}, {580, 720}});
}

/// rusEFI trigger_honda.cpp, configureHondaK_12_1 and configureHondaK_4_1 (cam degrees doubled).
TEST(NamedWheels, OfHondaHaveTheExtraToothTenDegreesAfterAnother) {
  expect_edges("honda-k", "crank",
               {{6, 10},
                {26, 30},
                {56, 60},
                {86, 90},
                {116, 120},
                {146, 150},
                {176, 180},
                {206, 210},
                {236, 240},
                {266, 270},
                {296, 300},
                {326, 330},
                {356, 360}});
  expect_edges("honda-k", "cam", {{111, 141}, {291, 321}, {471, 501}, {651, 681}, {706, 720}});
}

/// rusEFI trigger_mazda.cpp: initializeMazdaMiataNaShape, measured edges to the degree; initializeMazdaMiataNb2Crank
/// and initializeMazdaMiataVVtCamShape, whose low parts are the teeth.
TEST(NamedWheels, OfMazdaHaveTheMeasuredEdges) {
  expect_edges("mazda-miata-na", "crank", {{53, 123}, {233, 303}});
  expect_edges("mazda-miata-na", "cam", {{217, 289}, {577, 720}});
  expect_edges("mazda-miata-nb", "crank", {{106, 110}, {176, 180}, {286, 290}, {356, 360}});
  expect_edges("mazda-miata-nb", "cam", {{325, 360}, {641, 679}, {700, 720}});
}

/// rusEFI trigger_nissan.cpp, initializeNissanSR20VE_4: 8, 2, 2, 2 slots of the disc.
TEST(NamedWheels, OfNissanHaveOneWideWindow) {
  expect_edges("nissan-sr20-360", "cam", {{164, 180}, {356, 360}, {536, 540}, {716, 720}});
  EXPECT_EQ(teeth("nissan-sr20-360", "crank", 1)[179].first, 359);
}

/// rusEFI trigger_toyota.cpp, initialize2jzGE3_34_simulation_shape.
TEST(NamedWheels, OfToyotaHaveTheirGapBeforeTheFirstTooth) {
  const Edges crank = teeth("toyota-2jz-vvti", "crank", 25);
  EXPECT_EQ(crank[10].first, 125);
  EXPECT_EQ(crank.back().first, 355);
  expect_edges("toyota-2jz-vvti", "cam", {{121, 124}, {361, 364}, {601, 604}});
}

/// First rising edges of crank and cam in one frame of the source, as in the tests above; of Subaru's 36-2-2-2 in
/// degrees after cylinder 1's top dead centre: the pair of gaps ends at cylinder 3's, 180 deg later.
TEST(NamedWheels, SayWhereTheCamStandsBesideTheCrank) {
  const struct {
    const char* name;
    int crank_deg, cam_deg;
    const char* words;
  } pairs[] = {{"chrysler-ngc-4", 30, 144, "; cam 114 deg after crank"},
               {"gm-ls-24x", 12, 360, "; cam 348 deg after crank"},
               {"mazda-miata-na", 53, 217, "; cam 164 deg after crank"},
               {"subaru-36-2-2-2", 180, 720 - 45, "; cam 135 deg after crank"},
               {"subaru-6-7", 58, 10, "; cam 48 deg before crank"},
               {"toyota-2jz-vvti", 25, 121, "; cam 96 deg after crank"}};
  for (const auto& pair : pairs) {
    const int apart_deg = (pair.cam_deg - pair.crank_deg) % 360;
    EXPECT_NE(std::string(pair.words).find(" " + std::to_string(std::abs(apart_deg)) + " deg"), std::string::npos);
    for (const WheelPair& wheel : wheel_pairs()) {
      if (wheel.name == std::string(pair.name)) {
        EXPECT_NE(std::string(wheel.used_by).find(pair.words), std::string::npos) << wheel.used_by;
      }
    }
  }
}

/// A name means nothing else than its teeth: the gap of 36-1 ends at the first tooth, and a list moves as a whole.
TEST(NamedWheels, StandWhereTheirFirstToothIsSaidToBe) {
  for (const WheelPair& pair : wheel_pairs()) {
    for (const char* shaft : {"crank", "cam"}) {
      const auto at_0 = teeth(pair.name, shaft, 0);
      const auto at_700 = teeth(pair.name, shaft, 700);
      const double turn_deg = shaft == std::string("crank") ? 360 : 720;
      ASSERT_EQ(at_0.size(), at_700.size());
      EXPECT_EQ(at_0[0].first, 0);
      EXPECT_LT(at_0.back().second, turn_deg);
      for (std::size_t i = 0; i < at_0.size(); ++i) {
        EXPECT_NEAR(at_700[i].first - at_0[i].first, 700, 1e-9);
        if (i > 0) {
          EXPECT_GT(at_0[i].first, at_0[i - 1].second);
        }
      }
    }
  }
}

TEST(NamedWheels, AreToldWithTheirSourcesByTheProgramAndTheDocument) {
  std::ifstream file(CRANKLOOP_SOURCE_DIR "/docs/model.md");
  std::ostringstream document;
  document << file.rdbuf();
  for (const std::string& text : {describe_patterns(), document.str()}) {
    for (const WheelPair& pair : wheel_pairs()) {
      for (const char* words : {pair.name, pair.crank, pair.cam, pair.used_by, pair.source}) {
        EXPECT_NE(text.find(words), std::string::npos) << words;
      }
    }
  }
}

}  // namespace
}  // namespace crankloop::program::trigger_patterns_test
