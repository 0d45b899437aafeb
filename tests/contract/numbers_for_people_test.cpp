// How the program's summaries look: numbers of 6 digits at most, the unit once, pressure in kPa. Only CSV has every
// digit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "support/bad_input.hpp"

namespace crankloop::bad_input::numbers_for_people_test {
namespace {

constexpr const char* kEngines = CRANKLOOP_SOURCE_DIR "/tools/engines/";

/// Digits from the first that is not 0, without an exponent.
std::size_t significant_digits(const std::string& number) {
  const std::string mantissa = number.substr(0, number.find('e'));
  const std::size_t first = std::min(mantissa.find_first_of("123456789"), mantissa.size());
  return static_cast<std::size_t>(std::count_if(mantissa.begin() + static_cast<std::ptrdiff_t>(first), mantissa.end(),
                                                [](unsigned char c) { return std::isdigit(c) != 0; }));
}

class NumbersForPeople : public BadInput {
 protected:
  /// Of every line "name = number unit  # remark" that a command prints.
  void expect_readable(const std::vector<std::string>& words, int least_lines) const {
    const Answer answer = run(words);
    EXPECT_EQ(answer.status, 0) << answer.error;
    int lines = 0;
    for (const std::string& line : lines_of(answer.out)) {
      std::istringstream parts(line.substr(0, line.find("  #")));
      std::string name, equals, value, unit;
      parts >> name >> equals >> value >> unit;
      char* end = nullptr;
      std::strtod(value.c_str(), &end);
      if (equals != "=" || value.empty() || *end != '\0') continue;
      ++lines;
      const bool counts = value.find_first_of(".e") == std::string::npos;  // ticks: as many digits as there are
      EXPECT_TRUE(counts || significant_digits(value) <= 6) << line;
      EXPECT_TRUE(unit != "Pa" && unit != "bar" && unit != "MPa") << "pressure is in kPa: " << line;
      for (std::string suffix : {"m/s^2", "m/s", unit.c_str()}) {
        std::replace(suffix.begin(), suffix.end(), '/', '_');
        suffix.erase(std::remove(suffix.begin(), suffix.end(), '^'), suffix.end());
        suffix.insert(0, "_");
        const bool ends = name.size() > suffix.size() && suffix.size() > 1 &&
                          name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0;
        EXPECT_FALSE(ends) << "the unit stands twice: " << line;
      }
    }
    EXPECT_GE(lines, least_lines) << answer.out;
  }
  static std::string engine(const char* name) { return std::string(kEngines) + name; }
};

TEST_F(NumbersForPeople, HaveSixDigitsAndOneUnit) {
  expect_readable({"masses", "--type", "si", "--bore-mm", "76.5", "--speed-rpm", "5500"}, 8);
  expect_readable({"lift", engine("ohc_125.ini"), "--csv", "/dev/null"}, 6);
  expect_readable({"valve", engine("ohc_125.ini"), "--rpm", "12000"}, 15);
  expect_readable({"redline", engine("ohc_125.ini"), "--from", "8500", "--to", "8600"}, 3);
  expect_readable({"run", engine("diesel_495.ini"), "--cycles", "1"}, 60);
  expect_readable({"run", engine("diesel_495.ini"), "--free", "--starter", "--seconds", "0.5"}, 15);
  expect_readable({"live", engine("diesel_495.ini"), "--from-rpm", "800", "--seconds", "0.05"}, 20);
  expect_readable({"stress", "--cases", "3"}, 10);
}

TEST_F(NumbersForPeople, OfAnEngineThatBreathesToo) {
  expect_readable({"run", engine("four_2000.ini"), "--cycles", "1"}, 60);
  expect_readable({"map", engine("four_2000.ini"), "--rpm", "3000:4000:2", "--throttle", "0.5:1:2"}, 3);
}

TEST_F(NumbersForPeople, AreCountedHereAsTheyAreRead) {
  EXPECT_EQ(significant_digits("782.806977777"), 12u);
  EXPECT_EQ(significant_digits("0.00478"), 3u);
  EXPECT_EQ(significant_digits("-1.20e-05"), 3u);
  EXPECT_EQ(significant_digits("0"), 0u);
}

}  // namespace
}  // namespace crankloop::bad_input::numbers_for_people_test
