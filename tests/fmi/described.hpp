// FMUs by name and version, as those tests have them that look at what an FMU says of itself: of scenes, and of engine
// files.
#pragma once

#include <cstdlib>
#include <map>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "fmu.hpp"

namespace fmu {

/// The FMU of a scene, or "file_NAME": what the program makes of the sample engine NAME, once. Its units are the
/// file's.
inline const Archive& described(const std::string& name, int version) {
  static std::map<std::string, Archive> known;
  const std::string whole = name + "_fmi" + std::to_string(version);
  const auto found = known.find(whole);
  if (found != known.end()) return found->second;
  const std::string path = std::string(FMU_DIR) + "/" + whole + ".fmu";
  if (name.compare(0, 5, "file_") == 0) {
    const std::string make = "'" CRANKLOOP_PROGRAM "' fmu '" ENGINE_DIR "/" + name.substr(5) +
                             ".ini' --crank torque --fmi " + std::to_string(version) + " -o '" + path + "'";
    demand(std::system(make.c_str()) == 0, make);
  }
  return known.emplace(whole, Archive(path)).first->second;
}

/// Tests of each, TEST_P: archive, and the model description in it.
class Described : public testing::TestWithParam<std::tuple<const char*, int>> {
 protected:
  Described() : archive_(described(std::get<0>(GetParam()), std::get<1>(GetParam()))), model_(archive_) {}
  const Archive& archive_;
  Model model_;
};

#define FMU_INSTANTIATE_DESCRIBED(Fixture)                                                                        \
  INSTANTIATE_TEST_SUITE_P(                                                                                       \
      Fmus, Fixture,                                                                                              \
      testing::Combine(testing::Values("whole", "free_running", "breathing_free", "measured_motion",              \
                                       "torque_by_table", "torque_by_pressure", "four_pistons", "trigger_wheels", \
                                       "bouncing_valve", "file_diesel_495", "file_four_2000"),                    \
                       testing::Values(2, 3)),                                                                    \
      [](const auto& info) {                                                                                      \
        return std::string(std::get<0>(info.param)) + "_fmi" + std::to_string(std::get<1>(info.param));           \
      })

}  // namespace fmu
