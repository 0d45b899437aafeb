// What a layout became is told and drawn: throws, banks, firing order, and how rods come to share a pin.
#include "crankloop/engine_file/crankshaft_words.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/bad_input.hpp"

namespace crankloop::program::crankshaft_words_test {
namespace {

using bad_input::contents;
using bad_input::Engine;

class Crankshaft : public bad_input::BadInput {
 protected:
  /// The sample with another layout.
  void write_engine(const std::string& layout) const {
    std::string text = sample_.text();
    const auto from = text.find("[layout]");
    write("engine.ini", text.replace(from, text.find("[pressure]") - from, "[layout]\n" + layout + "\n"));
  }
  std::string shown(const std::string& layout) const {
    write_engine(layout);
    const bad_input::Answer answer = run({"show", path_});
    EXPECT_EQ(answer.status, 0) << answer.error;
    return answer.out;
  }
};

void expect_in(const std::string& text, const std::vector<std::string>& lines) {
  for (const std::string& line : lines)
    EXPECT_NE(text.find(line), std::string::npos) << text << "  should say: " << line;
}
void expect_not_in(const std::string& text, const std::string& line) {
  EXPECT_EQ(text.find(line), std::string::npos) << line;
}

constexpr const char* kVTwin = "cylinders = 2\nfiring_angles_deg = 0,315\nbank_angles_deg = 0,45";

TEST_F(Crankshaft, OfAVTwinThatBecameTwoThrowsIsToldWithWhatWouldMakeThemOne) {
  // A throw points along bank - firing: 0 - 0, and 45 - 315 = -270.
  const std::string text = shown(kVTwin);
  expect_in(text, {"\n# 2 cylinders on 2 crank throws.", "\n#   throw 1 at 0 deg: cylinder 1 (bank 0 deg)\n",
                   "\n#   throw 2 at 90 deg: cylinder 2 (bank 45 deg)\n",
                   "\n# Fires 1-2, at 0, 315 deg: 315, 405 deg apart.\n",
                   "shared_pins = 1-2. Their bank - firing angles must then be equal, and are 0 and 90 deg."});
  const std::string one = shown("cylinders = 2\nfiring_angles_deg = 0,405\nbank_angles_deg = 0,45\nshared_pins = 1-2");
  expect_in(one, {"# 2 cylinders on 1 crank throw.",
                  "#   throw 1 at 0 deg: cylinder 1 (bank 0 deg), cylinder 2 (bank 45 deg)\n"});
  expect_not_in(one, "No two rods share");
}

TEST_F(Crankshaft, OfAVEngineWithEqualThrowsIsToldWhichRodsMayShareAPin) {
  const std::string v8 = "cylinders = 8\nfiring_order = 1-8-4-3-6-5-7-2\nbank_angles_deg = 45,-45,45,-45,45,-45,45,-45";
  expect_in(shown(v8), {"8 cylinders on 8 crank throws", "shared_pins = 1-2,3-4,5-6,7-8\n"});
  const std::string paired = shown(v8 + "\nshared_pins = 1-2,3-4,5-6,7-8");
  expect_in(
      paired,
      {"8 cylinders on 4 crank throws", "throw 2 at 135 deg: cylinder 3 (bank 45 deg), cylinder 4 (bank -45 deg)",
       "Fires 1-8-4-3-6-5-7-2, at 0, 90, 180, 270, 360, 450, 540, 630 deg: 90, 90, 90, 90, 90, 90, 90, 90 deg apart."});
}

TEST_F(Crankshaft, WithoutBanksAtAnAngleAsksForNoSharedPin) {
  expect_in(shown("cylinders = 4\nfiring_order = 1-3-4-2"),
            {"4 cylinders on 4 crank throws", "throw 2 at 180 deg: cylinder 2 (bank 0 deg)"});
  expect_not_in(shown("cylinders = 4\nfiring_order = 1-3-4-2"), "No two rods share");
  expect_not_in(shown("cylinders = 2\nfiring_angles_deg = 0,360\nbank_angles_deg = 90,-90"),
                "No two rods share");  // a boxer
  expect_not_in(shown("cylinders = 1"), "crank throw");
}

TEST_F(Crankshaft, IsShownSoThatItCanBeReadAndShownAgain) {
  const std::string once = shown(kVTwin);
  write("engine.ini", once);
  EXPECT_EQ(run({"show", path_}).out, once);
}

TEST_F(Crankshaft, StandsInTheReportInWordsAndDrawn) {
  write_engine(kVTwin);
  EXPECT_EQ(run({"run", path_, "--cycles", "1", "--report", folder_ / "report.html"}).status, 0);
  const std::string page = contents(folder_ / "report.html");
  expect_in(page, {"2 cylinders on 2 crank throws.", "throw 2 at 90 deg: cylinder 2 (bank 45 deg)",
                   "Fires 1-2, at 0, 315 deg", "No two rods share a crank pin", "Throws and banks at engine angle 0",
                   "Firing order"});
}

}  // namespace
}  // namespace crankloop::program::crankshaft_words_test
