// `crankloop run` as tests call it: in this process or as the program itself, with a folder for its files.
//
// What belongs here: calling it, and reading the lines that it prints. What does not: expectations.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "crankloop/command_line/commands.hpp"
#include "crankloop/files/error.hpp"
#include "support/files.hpp"

namespace crankloop::program {

using support::kSample;

using support::contents;

inline std::vector<std::string> split_at(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// Value and unit of a line "name = value unit"; NaN where there is none.
inline std::pair<double, std::string> line(const std::string& summary, const std::string& name) {
  for (const std::string& text : split_at(summary, '\n')) {
    if (text.rfind(name + " = ", 0) != 0) continue;
    std::istringstream stream(text.substr(name.size() + 3));
    std::pair<double, std::string> found;
    stream >> found.first >> found.second;
    return found;
  }
  return {std::numeric_limits<double>::quiet_NaN(), ""};
}

class RunCommand : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::string engine_without_pressure() const {
    std::string text = contents(kSample);
    text.resize(text.find("[pressure]"));
    std::ofstream(path("bare.ini")) << text;
    return path("bare.ini");
  }

  /// The sample with another highest speed.
  [[nodiscard]] std::string engine_up_to(const std::string& rpm) const {
    std::string text = contents(kSample);
    const std::string limit = "max_rpm = 3000 ";
    const std::size_t at = text.find(limit);
    EXPECT_NE(at, std::string::npos);
    if (at != std::string::npos) text.replace(at, limit.size(), "max_rpm = " + rpm + " ");
    std::ofstream(path("fast.ini")) << text;
    return path("fast.ini");
  }

  /// Runs in this process and returns what it printed.
  static std::string run(const std::vector<std::string>& words) {
    testing::internal::CaptureStdout();
    const int status = kRun.run(Arguments(kRun, words));
    const std::string printed = testing::internal::GetCapturedStdout();
    EXPECT_EQ(status, kSuccess);
    return printed;
  }
  /// Exit status of the program itself.
  [[nodiscard]] int status_of(const std::string& options) const {
    const std::string command =
        std::string("'") + CRANKLOOP_PROGRAM + "' run " + options + " >'" + path("out") + "' 2>'" + path("err") + "'";
    return WEXITSTATUS(std::system(command.c_str()));
  }

  support::TemporaryFolder folder_;
};

}  // namespace crankloop::program
