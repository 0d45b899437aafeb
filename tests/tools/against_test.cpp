// `crankloop run A --against B`: its figures against two single runs, its page, its refusals.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "support/markup.hpp"
#include "support/run_command.hpp"

namespace crankloop::program::against_test {
namespace {

const std::string k125 = CRANKLOOP_SOURCE_DIR "/tools/engines/ohc_125.ini";

class RunAgainst : public RunCommand {
 protected:
  [[nodiscard]] std::string longer_stroke() const {
    std::string text = contents(k125);
    text.replace(text.find("stroke_mm = 57.8"), 16, "stroke_mm = 60.0");
    std::ofstream(path("long.ini")) << text;
    return path("long.ini");
  }
  static std::string refusal(const std::vector<std::string>& words) {
    try {
      kRun.run(Arguments(kRun, words));
    } catch (const InputError& refused) {
      return refused.what();
    }
    return "";
  }
};

TEST_F(RunAgainst, PrintsTheFiguresOfBothRuns) {
  const std::string other = longer_stroke();
  const std::string both = run({k125, "--against", other, "--rpm", "5000"});
  const std::string first = run({k125, "--rpm", "5000"}), second = run({other, "--rpm", "5000"});
  int compared = 0;
  for (const std::string& one : split_at(both, '\n')) {
    if (one[0] == '#') continue;
    const std::string name = one.substr(0, one.find(" = "));
    const std::string behind = one.substr(one.find("# against ") + 10);
    const auto value = [&name](const std::string& summary) {
      const std::size_t at = ("\n" + summary).find("\n" + name + " = ");
      const std::string rest = summary.substr(at + name.size() + 3);
      return rest.substr(0, rest.find_first_of(" \n"));
    };
    EXPECT_EQ(value(both), value(first)) << one;
    EXPECT_EQ(behind.substr(0, behind.find(',')), value(second)) << one;
    ++compared;
  }
  EXPECT_GT(compared, 60);
  // The swept volume goes with the stroke: 60 / 57.8.
  EXPECT_NE(both.find("# against 129.391, +3.81 %"), std::string::npos) << both;
}

TEST_F(RunAgainst, DrawsBothInOneDrawing) {
  const std::string other = longer_stroke();
  run({k125, "--against", other, "--report", path("both.html")});
  const std::string text = contents(path("both.html"));
  const support::Markup page = support::read(text);
  EXPECT_EQ(page.fault, "");
  EXPECT_GE(page.all("svg").size(), 7u);
  EXPECT_NE(text.find("swept volume, cm\u00B3"), std::string::npos);
}

TEST_F(RunAgainst, RefusesWhatIsOfOneEngine) {
  const auto refuses = [&](const std::vector<std::string>& more, const std::string& why) {
    std::vector<std::string> words{k125, "--against"};
    words.insert(words.end(), more.begin(), more.end());
    const std::string told = refusal(words);
    EXPECT_NE(told.find(why), std::string::npos) << told;
  };
  refuses({k125, "--csv", path("x")}, "--csv is of one engine");
  refuses({k125, "--free"}, "--free is of one engine");
  refuses({path("none.ini")}, "none.ini: cannot be read");
  std::ofstream(path("bare.ini")) << "[engine]\nname = bare\nrated_rpm = 1000\n";
  refuses({path("bare.ini")}, "section [crank] is missing");
  refuses({kSample, "--rpm", "7000"},
          std::string(kSample) + ": 7000 rpm is beyond the engine's max_rpm of 3000");  // the 125's is higher
}

}  // namespace
}  // namespace crankloop::program::against_test
