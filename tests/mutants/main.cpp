// Runs the tests that judge mutants. With CRANKLOOP_MUTANT_REACH=FILE in the environment it writes, for each test,
// "NAME MILLISECONDS NUMBER...": its processor time, and the places that a mutant may change and that the test came by.
// What ran before the first test has the name "-". Places in shared objects count for the test that unloads them.
#include <cstdio>
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
  explicit Reach(const std::string& path) : file_{path}, of_objects_{path + ".objects"} {
    ::setenv("CRANKLOOP_MUTANT_REACH_OF_OBJECTS", of_objects_.c_str(), 1);
    write("-");
  }
  ~Reach() override {
    ::unsetenv("CRANKLOOP_MUTANT_REACH_OF_OBJECTS");
    std::remove(of_objects_.c_str());
  }

 private:
  void OnTestStart(const ::testing::TestInfo&) override { start_ = std::clock(); }
  void OnTestEnd(const ::testing::TestInfo& test) override {
    write(std::string(test.test_suite_name()) + "." + test.name());
  }
  void write(const std::string& name) {
    int of_object = 0;
    for (std::ifstream objects(of_objects_); objects >> of_object;) mutant::reached[of_object] = true;
    std::remove(of_objects_.c_str());
    file_ << name << ' ' << (std::clock() - start_) / (CLOCKS_PER_SEC / 1000);
    for (int number = 0; number < mutant::kMax; ++number) {
      if (mutant::reached[number]) file_ << ' ' << number;
    }
    file_ << '\n';
    std::memset(mutant::reached, 0, sizeof mutant::reached);
  }

  std::ofstream file_;
  std::string of_objects_;
  std::clock_t start_ = std::clock();
};

}  // namespace

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (const char* path = std::getenv("CRANKLOOP_MUTANT_REACH"))
    ::testing::UnitTest::GetInstance()->listeners().Append(new Reach(path));
  return RUN_ALL_TESTS();
}
