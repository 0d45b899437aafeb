// Wheels by name: that each pair has the teeth that its source counts, stands where first_tooth_deg says, and is told
// to users.
#include "crankloop/engine_file/trigger_patterns.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "crankloop/engine_file/engine_file.hpp"

namespace crankloop::program {
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

/// Speeduino's wiki: 12 wide teeth of 12 deg, 12 narrow ones of 3, all falling edges 15 deg apart.
TEST(NamedWheels, OfGeneralMotorsFallEvery15Deg) {
  const auto all = teeth("gm-ls-24x", "crank", 3);
  int wide = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double width_deg = all[i].second - all[i].first;
    EXPECT_TRUE(width_deg == 12 || width_deg == 3) << width_deg;
    if (width_deg == 12) ++wide;
    EXPECT_EQ(all[i].second, 15.0 * static_cast<double>(i + 1));
  }
  EXPECT_EQ(wide, 12);
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
}  // namespace crankloop::program
