// Runs of one valve for the tests of its loop and of the commands.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "crankloop/loops/valve_loop.hpp"
#include "support/files.hpp"

namespace crankloop::program {

using support::kOhc125;
inline constexpr double kTick_s = 20e-6;
inline constexpr ValveMethod kRk4{};

using support::contents;

/// An engine file with one line of another changed.
class ChangedFile {
 public:
  ChangedFile(const char* from, const std::string& key, const std::string& line) {
    std::string text = contents(from);
    const std::size_t at = text.find("\n" + key + " = ");
    EXPECT_NE(at, std::string::npos) << key;
    text.replace(at + 1, text.find('\n', at + 1) - at - 1, line);
    std::ofstream(path()) << text;
  }
  [[nodiscard]] std::string path() const { return folder_ / "engine.ini"; }

 private:
  support::TemporaryFolder folder_;
};

/// A whole run's last cycle.
template <class Real>
struct LastCycle {
  std::vector<ValveTickOutput<Real>> ticks;
  ValveCycle<Real> results;
};

template <class Real>
LastCycle<Real> run(const LoneValve& valve, double rpm, const ValveMethod& method = kRk4, double tick_s = kTick_s,
                    int cycles = 4) {
  ValveLoop<Real> loop(valve, tick_s, method);
  LastCycle<Real> last;
  last.results =
      run_cycles<Real>(loop, valve, rpm, cycles, [&](const ValveTickOutput<Real>& out) { last.ticks.push_back(out); });
  EXPECT_EQ(loop.faults(), 0u);
  return last;
}

}  // namespace crankloop::program
