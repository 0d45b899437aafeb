// `crankloop live` as tests start it, with programs beside it and its block open.
//
// What belongs here: starting, waiting, reading what was printed. What does not: expectations.
#pragma once

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "port/linux/shared_block.hpp"
#include "support/files.hpp"

namespace crankloop::port {

inline const std::string kEngine = CRANKLOOP_SOURCE_DIR "/tools/engines/diesel_495.ini";
inline constexpr std::chrono::seconds kPatience{60};  // for what happens at once on a machine that has time

using support::contents;

/// A program that runs beside the test. Ended, if it still runs, with the object.
class Process {
 public:
  Process(const std::vector<std::string>& words, std::string output_path) : output_path_{std::move(output_path)} {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    id_ = ::fork();
    if (id_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves nothing running
    ::signal(SIGHUP, SIG_DFL);           // ignored where the tests run under nohup, and the program would leave it so
    if (std::freopen(output_path_.c_str(), "w", stdout) == nullptr || ::dup2(STDOUT_FILENO, STDERR_FILENO) < 0)
      ::_exit(126);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (id_ > 0) {
      signal(SIGKILL);
      wait();
    }
  }

  void signal(int number) const { ::kill(id_, number); }

  [[nodiscard]] bool has_mapped(const std::string& path) const {
    return contents("/proc/" + std::to_string(id_) + "/maps").find(path) != std::string::npos;
  }

  /// Its exit status, or minus the signal that ended it.
  int wait() {
    int status = 0;
    EXPECT_EQ(::waitpid(id_, &status, 0), id_);
    id_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  [[nodiscard]] std::string output() const { return contents(output_path_); }

 private:
  std::string output_path_;
  ::pid_t id_ = -1;
};

/// The lines "name = value unit".
inline std::map<std::string, std::string> values_of(const std::string& text) {
  std::map<std::string, std::string> values;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t equals = line.find(" = ");
    if (line[0] != '#' && equals != std::string::npos) values[line.substr(0, equals)] = line.substr(equals + 3);
  }
  return values;
}

inline bool comes_true(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

/// The block once the loop runs.
inline std::optional<SharedBlock> running_block(const std::string& path) {
  std::optional<SharedBlock> block;
  comes_true([&] {
    try {
      if (!block) block.emplace(SharedBlock::open(path));
    } catch (const SharedBlockError&) {
      return false;
    }
    return (*block)->state == LiveState::running;
  });
  return block;
}

class LiveBench : public testing::Test {
 protected:
  [[nodiscard]] std::string in_folder(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::string block_path() const { return in_folder("block"); }

  [[nodiscard]] std::vector<std::string> live(const std::vector<std::string>& options) const {
    std::vector<std::string> words{CRANKLOOP_PROGRAM, "live", kEngine};
    words.insert(words.end(), options.begin(), options.end());
    return words;
  }

  [[nodiscard]] std::optional<SharedBlock> open_running() const { return running_block(block_path()); }

  support::TemporaryFolder folder_;
};

/// What `live` shows at the moment.
inline LiveOutputs outputs_of(const SharedBlock& block) {
  LiveOutputs out;
  std::uint32_t sequence = 0;
  while (!block->outputs.read(out, sequence)) {
  }
  return out;
}

}  // namespace crankloop::port
