// How results look on paper, and what becomes of them when something goes wrong on the way.
#include "crankloop/files/csv.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>

#include "crankloop/command_line/summary.hpp"
#include "crankloop/files/error.hpp"
#include "crankloop/files/number.hpp"
#include "crankloop/files/words.hpp"
#include "support/files.hpp"

namespace crankloop::program::csv_test {
namespace {

using support::contents;

class CsvFile : public testing::Test {
 protected:
  CsvFile() { path_ = folder_ / "table.csv"; }

  long files() const {
    return std::distance(std::filesystem::directory_iterator(folder_.path()), std::filesystem::directory_iterator());
  }

  support::TemporaryFolder folder_;
  std::string path_;
};

TEST_F(CsvFile, HoldsTwelveDigitsOfDoubleAndNineOfFloat) {
  Output out(path_);
  CsvWriter csv(out, {"name", "double", "float", "count"});
  csv.row("third", 1.0 / 3.0, 1.0F / 3.0F, 3);
  csv.row("rest", -0.0, -0.0F, -1);
  csv.row("size", 1.5e-12, 2535.75F, 100000);
  out.finish();
  EXPECT_EQ(contents(path_),
            "name,double,float,count\n"
            "third,0.333333333333,0.333333343,3\n"
            "rest,0,0,-1\n"
            "size,1.5e-12,2535.75,100000\n");
}

TEST_F(CsvFile, IsNotThereUntilItIsFinished) {
  {
    Output out(path_);
    CsvWriter csv(out, {"x"});
    for (int i = 0; i < 100'000; ++i) csv.row(i);  // far beyond the buffer
    EXPECT_FALSE(std::filesystem::exists(path_));
  }
  EXPECT_EQ(files(), 0);  // given up: no trace
  Output out(path_);
  CsvWriter csv(out, {"x"});
  for (int i = 0; i < 100'000; ++i) csv.row(i);
  out.finish();
  EXPECT_EQ(files(), 1);
  EXPECT_EQ(contents(path_).size(), 2u + 10 * 2 + 90 * 3 + 900 * 4 + 9000 * 5 + 90'000 * 6);
}

TEST_F(CsvFile, TakesThePlaceAndThePermissionsOfItsPredecessor) {
  std::ofstream(path_) << "old";
  std::filesystem::permissions(path_, std::filesystem::perms(0640));
  std::filesystem::create_symlink("table.csv", folder_ / "link.csv");
  Output out(folder_ / "link.csv");
  out.write("new");
  EXPECT_EQ(contents(path_), "old");
  out.finish();
  EXPECT_EQ(contents(path_), "new");
  EXPECT_EQ(std::filesystem::status(path_).permissions(), std::filesystem::perms(0640));
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link.csv"));
}

TEST_F(CsvFile, RowsThatDoNotFitTheHeaderAreADefect) {
  Output out(path_);
  CsvWriter csv(out, {"x", "y"});
  EXPECT_THROW(csv.row(1.0), std::logic_error);
  EXPECT_THROW(CsvWriter(out, {"a,b"}), std::logic_error);
}

TEST_F(CsvFile, ASummaryLineNamesItsUnit) {
  Summary s;
  s.line("mean_torque", 210.0918468, "Nm");
  s.line("lambda", 0.1F);
  s.line("engine", "495 diesel");
  EXPECT_EQ(s.text(), "mean_torque = 210.092 Nm\nlambda = 0.1\nengine = 495 diesel\n");
}

TEST(Numbers, AreReadTheSameWhereverTheyAreWritten) {
  EXPECT_EQ(parse_number("95").value, 95);
  EXPECT_EQ(parse_number("+.5e1").value, 5);
  EXPECT_EQ(parse_number("-6.").value, -6);
  EXPECT_FALSE(std::signbit(parse_number("-0").value));
  EXPECT_EQ(parse_number("1.7976931348623157e308").value, std::numeric_limits<double>::max());
  for (const char* text :
       {"", "+", "-", ".", "e5", "+-1", " 1", "1 ", "1_000", "0x10", "1,5", "1d3", "inf", "nan", "1e309"}) {
    EXPECT_FALSE(parse_number(text).ok()) << text;
  }
}

TEST(Numbers, NameTheSpaceThatLooksLikeABlank) {
  for (const char* text : {"95\u00A0", "\u00A095", "1\u00A0000", "1\u202F000", "95\u00A0mm"})
    EXPECT_NE(parse_number(text).problem.find("it has a no-break space"), std::string::npos) << text;
  EXPECT_NE(parse_number("95 mm").problem.find("'mm' follows it"), std::string::npos);
}

TEST(Numbers, TellTheirRangeInWords) {
  EXPECT_EQ(describe(above(0).up_to(2000), "mm"), "above 0, at most 2000 mm");
  EXPECT_EQ(describe(from(0).below(720), "deg"), "0 to below 720 deg");
  EXPECT_EQ(describe(from(-90).up_to(90), ""), "-90 to 90");
  EXPECT_EQ(describe(from(0), "g"), "at least 0 g");
  EXPECT_EQ(describe(Range{}, "g"), "");
  EXPECT_EQ(parse_number("0", above(0).up_to(100000), "rpm").problem,
            "0 is out of range; allowed: above 0, at most 100000 rpm");
  EXPECT_EQ(parse_number("2147483648", from(1).up_to(1000000), "").problem,
            "2147483648 is out of range; allowed: 1 to 1000000");
  EXPECT_FALSE(parse_number("720", from(0).below(720), "deg").ok());
}

TEST(Words, AGuessIsMadeOnlyWhereItIsLikely) {
  const std::vector<std::string> keys{"bore_mm", "stroke_mm", "rod_length_mm"};
  EXPECT_EQ(suggestion("Bore_MM", keys), "; did you mean bore_mm?");
  EXPECT_EQ(suggestion("bore", keys), "; did you mean bore_mm?");
  EXPECT_EQ(suggestion("storke_mm", keys), "; did you mean stroke_mm?");
  EXPECT_EQ(suggestion("rod_lenght_mm", keys), "; did you mean rod_length_mm?");
  EXPECT_EQ(suggestion("load", {"friction", "machine"}), "; it is now called machine");
  EXPECT_EQ(suggestion("--load-Nm", {"--load-ratio", "--external-torque-Nm"}),
            "; it is now called --external-torque-Nm");
  EXPECT_EQ(suggestion("colour", keys), "");
  EXPECT_EQ(suggestion("x", keys), "");
  EXPECT_EQ(suggestion(std::string(100'000, 'b'), keys), "");
}

TEST(Words, NearestShareMostPartsThenMostLetters) {
  using Words = std::vector<std::string>;
  const Words names = {"mean_torque", "power", "max_train_force", "max_cam_force", "force", "maximum"};
  EXPECT_EQ(nearest("max_torce_force", names, 3), (Words{"max_train_force", "max_cam_force", "force"}));
  EXPECT_EQ(nearest("POWDER", names, 1), (Words{"power"}));
  EXPECT_EQ(nearest("x", names, 9).size(), names.size()) << "no more than there are";
  EXPECT_TRUE(nearest(std::string(100'000, 'b'), names, 3).empty());
}

TEST(Words, UnitsOfKeysAreReadAsEngineersWriteThem) {
  EXPECT_EQ(unit_in_words("mm"), "mm");
  EXPECT_EQ(unit_in_words("mm2"), "mm^2");
  EXPECT_EQ(unit_in_words("kg_m2"), "kg m^2");
  EXPECT_EQ(unit_in_words("N_per_mm"), "N/mm");
  EXPECT_EQ(unit_in_words("deg_per_s"), "deg/s");
  EXPECT_EQ(unit_in_words(""), "");
}

TEST(Words, AQuoteIsShortAndNeverCutsACharacter) {
  EXPECT_EQ(in_quotes("95 mm"), "'95 mm'");
  std::string long_text(39, 'a');
  for (int i = 0; i < 10; ++i) long_text += "\xC3\xBC";
  EXPECT_EQ(in_quotes(long_text), "'" + std::string(39, 'a') + "...'");
}

TEST(Words, AShellReadsThemBack) {
  EXPECT_EQ(shell_word("engines/v-2.ini"), "engines/v-2.ini");
  EXPECT_EQ(shell_word("my engine.ini"), "'my engine.ini'");
  EXPECT_EQ(shell_word("o'clock"), "'o'\\''clock'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace crankloop::program::csv_test
