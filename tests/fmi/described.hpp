// FMUs by name and version, as those tests have them that look at what an FMU says of itself: of scenes, and of engine
// files.
#pragma once

#include <cstdlib>
#include <map>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include <crankloop/fmi/description.hpp>

#include "fmu.hpp"
#include "instance.hpp"

namespace fmu {

/// The archive of an FMU whose files about itself are those of a BoreSupply, made here.
inline Archive with_own_description(Archive archive, int version) {
  namespace fmi = crankloop::fmi;
  const auto instance = std::make_unique<fmi::Instance<BoreSupply>>();
  fmi::Message why;
  demand(instance->open(nullptr, why), why.text);
  const std::string identifier = Model(archive).identifier;
  fmi::Description description(fmi::shown(*instance), {identifier, "a diesel whose bore may be set"});
  const fmi::SourceBuild sources{identifier, "-O2", {"include"}, {{"NDEBUG", "1"}}, {"all.cpp"}};
  archive.files["modelDescription.xml"] = description.model(version == 2 ? fmi::Version::two : fmi::Version::three);
  archive.files["documentation/index.html"] = description.page();
  archive.files["sources/README.txt"] = sources.read_me();
  if (version == 3) archive.files["sources/buildDescription.xml"] = sources.description();
  return archive;
}

/// The FMU of a scene; "file_NAME": what the program makes of the sample engine NAME, once, its units are the file's;
/// "bore": with_own_description().
inline const Archive& described(const std::string& name, int version) {
  static std::map<std::string, Archive> known;
  const std::string whole = name + "_fmi" + std::to_string(version);
  if (name == "bore")  // made anew for each test: a mutant's judge sees which of them it needs
    return known.insert_or_assign(whole, with_own_description(described("free_running", version), version))
        .first->second;
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
                                       "bouncing_valve", "file_diesel_495", "file_four_2000", "bore"),            \
                       testing::Values(2, 3)),                                                                    \
      [](const auto& info) {                                                                                      \
        return std::string(std::get<0>(info.param)) + "_fmi" + std::to_string(std::get<1>(info.param));           \
      })

}  // namespace fmu
