// Runs the tests that judge mutants. With CRANKLOOP_MUTANT_REACH=FILE in the environment it writes, for each test,
// "NAME MILLISECONDS NUMBER...": its processor time, and the places that a mutant may change and that the test came by.
// What ran before the first test has the name "-".
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "mutant.hpp"

namespace {

class Reach : public ::testing::EmptyTestEventListener {
 public:
  explicit Reach(const char* path) : file_{path} { write("-"); }

 private:
  void OnTestStart(const ::testing::TestInfo&) override { start_ = std::clock(); }
  void OnTestEnd(const ::testing::TestInfo& test) override {
    write(std::string(test.test_suite_name()) + "." + test.name());
  }
  void write(const std::string& name) {
    file_ << name << ' ' << (std::clock() - start_) / (CLOCKS_PER_SEC / 1000);
    for (int number = 0; number < mutant::kMax; ++number) {
      if (mutant::reached[number]) file_ << ' ' << number;
    }
    file_ << '\n';
    std::memset(mutant::reached, 0, sizeof mutant::reached);
  }

  std::ofstream file_;
  std::clock_t start_ = std::clock();
};

}  // namespace

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (const char* path = std::getenv("CRANKLOOP_MUTANT_REACH"))
    ::testing::UnitTest::GetInstance()->listeners().Append(new Reach(path));
  return RUN_ALL_TESTS();
}
