// Engine files of any bytes are read or refused, and nothing else.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>

#include "support/engine_files.hpp"

namespace crankloop::program::hostile_engine_file_test {
namespace {

/// Hostile files: whatever the bytes, the answer is a definition or an InputError; and a file that is accepted is also
/// shown and read again without change.
class HostileEngineFile : public EngineFileTest {
 protected:
  void expect_total(const std::string& text) {
    try {
      const EngineFile engine = read(text);
      const std::string shown = show(engine);
      const EngineFile again = read(shown);
      EXPECT_EQ(show(again), shown) << text;
      expect_same(again.definition(), engine.definition());
      ++accepted_;
    } catch (const InputError& error) {
      const std::string message = error.what();
      std::istringstream lines(message);
      int count = 0;
      for (std::string line; std::getline(lines, line); ++count) {
        EXPECT_EQ(line.find(folder_.path()), 0u) << message;
        EXPECT_LT(line.size(), folder_.path().size() + 800) << message;  // all keys of [valve] take 520
      }
      EXPECT_TRUE(count > 0 && count <= 20) << message;
    }
  }
  int accepted_ = 0;
};

std::string rich_engine() {
  return "[engine]\nname = rich\nrated_rpm = 2e3\n[crank]\nbore_mm = 95\nstroke_mm = 115\nrod_length_mm = 210\n"
         "pin_offset_mm = -1.5\ncompression_ratio = 19\n[masses]\npiston_g = 810\nrod_g = 1887\nrod_com_to_crank_mm = "
         "56\n"
         "crank_inertia_kg_m2 = 0.5\n[layout]\ncylinders = 4\nfiring_angles_deg = 0,90,270,360\n"
         "bank_angles_deg = 45,135,-45,45\ncylinder_positions_mm = 0,100,200,1\nshared_pins = 1-4\n"
         "crank_throws_deg = 45,45,45,45\n[pressure]\nsource = angle_table\nfile = p.csv\n"
         "[cam intake]\nsource = polynomial\nmax_lift_mm = 6.3\nhalf_angle_deg = 74\nexponents = 2,10,18,26\n"
         "full_lift_at_crank_deg = 470\n[rocker intake]\nratio = 1\nbase_circle_mm = 15\nclearance_mm = 0.1\n";
}

TEST_F(HostileEngineFile, CutOffAtAnyByteItIsReadOrRefused) {
  write("p.csv", angle_table());
  for (const std::string& text : {contents(kSample), rich_engine()}) {
    for (std::size_t length = 0; length <= text.size(); ++length) expect_total(text.substr(0, length));
  }
  EXPECT_GT(accepted_, 0);
}

/// One to three small accidents: a byte changed, added or lost, or a piece copied to where it does not belong.
std::string mutated(std::string text, std::mt19937_64& random) {
  const std::string interesting = std::string("0123456789-+.,eE=[]# \t\n\r_abm/\xC3\xBC\x7F") + '\0';
  for (int edits = 1 + static_cast<int>(random() % 3); edits > 0 && !text.empty(); --edits) {
    const std::size_t place = random() % text.size();
    const char c = interesting[random() % interesting.size()];
    switch (random() % 4) {
      case 0:
        text[place] = c;
        break;
      case 1:
        text.insert(place, 1, c);
        break;
      case 2:
        text.erase(place, 1 + random() % 4);
        break;
      default:
        text.insert(place, text.substr(random() % text.size(), 1 + random() % 40));
        break;
    }
  }
  return text;
}

TEST_F(HostileEngineFile, MutatedAtRandomItIsReadOrRefused) {
  const std::uint64_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  write("p.csv", angle_table());
  for (int round = 0; round < 2000 && !HasFailure(); ++round) {
    expect_total(mutated(contents(kSample), random));
    expect_total(mutated(rich_engine(), random));
  }
  EXPECT_GT(accepted_, 100);  // the mutations are not all refused for one and the same reason
}

TEST_F(HostileEngineFile, ItsDiagramMutatedAtRandomIsReadOrRefused) {
  const std::uint64_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  for (int round = 0; round < 500 && !HasFailure(); ++round) {
    write("p.csv", mutated(angle_table(), random));
    expect_total(rich_engine());
  }
  EXPECT_GT(accepted_, 5);
}

}  // namespace
}  // namespace crankloop::program::hostile_engine_file_test
