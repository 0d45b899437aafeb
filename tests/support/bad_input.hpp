// The program as its users run it, a process of its own, and what it answers to bad input.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "support/files.hpp"

namespace crankloop::bad_input {

inline constexpr int kFailure = 1;
inline constexpr int kBadInput = 2;
using support::kSample;

using support::contents;

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

inline constexpr std::chrono::seconds kPatience{60};  // for what takes a moment on a machine that has time

/// Exit status of a process, or minus the signal that ended it. One that hangs is ended.
inline int status_of(pid_t child) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > deadline) kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

struct Answer {
  int status = -1;
  std::string out;
  std::string error;
};

/// An engine file as lines that are told apart by their key.
class Engine {
 public:
  explicit Engine(const std::string& text) : lines_{lines_of(text)} {}

  std::size_t line_of(const std::string& start) const {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (lines_[i].compare(0, start.size(), start) == 0) return i + 1;
    }
    ADD_FAILURE() << "no line starts with " << start;
    return 1;
  }
  Engine with(const std::string& key, const std::string& value) const { return changed(key, key + " = " + value); }
  Engine without(const std::string& key) const { return changed(key, ""); }
  Engine changed(const std::string& start, const std::string& line) const {
    Engine other = *this;
    other.lines_[line_of(start) - 1] = line;
    return Engine(other.text());  // the new text may be several lines, or none that counts
  }
  Engine plus(const std::string& line) const {
    Engine other = *this;
    other.lines_.push_back(line);
    return other;
  }
  std::size_t size() const { return lines_.size(); }
  std::string text() const {
    std::string text;
    for (const std::string& line : lines_) text += line + "\n";
    return text;
  }

 private:
  std::vector<std::string> lines_;
};

class BadInput : public testing::Test {
 protected:
  BadInput() { path_ = folder_ / "engine.ini"; }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  /// The program as a process. `out` is where standard output goes; "" closes it.
  pid_t start(const std::vector<std::string>& words, const std::string& out) const {
    const std::string error = folder_ / "stderr";
    std::vector<std::string> all = words;
    all.insert(all.begin(), CRANKLOOP_PROGRAM);
    std::vector<char*> arguments;
    for (std::string& word : all) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    if (out.empty()) {
      posix_spawn_file_actions_addclose(&files, STDOUT_FILENO);
    } else {
      posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    }
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, error.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    // A shell's background process ignores some, and so would its children.
    sigset_t by_default;
    sigfillset(&by_default);
    posix_spawnattr_t signals;
    posix_spawnattr_init(&signals);
    posix_spawnattr_setsigdefault(&signals, &by_default);
    posix_spawnattr_setflags(&signals, POSIX_SPAWN_SETSIGDEF);
    pid_t child = 0;
    EXPECT_EQ(posix_spawn(&child, CRANKLOOP_PROGRAM, &files, &signals, arguments.data(), environ), 0);
    posix_spawnattr_destroy(&signals);
    posix_spawn_file_actions_destroy(&files);
    return child;
  }

  Answer run(const std::vector<std::string>& words, const std::string& out) const {
    Answer answer;
    answer.status = status_of(start(words, out));
    answer.error = contents(folder_ / "stderr");
    return answer;
  }

  Answer run(const std::vector<std::string>& words) const {
    Answer answer = run(words, folder_ / "stdout");
    answer.out = contents(folder_ / "stdout");
    return answer;
  }

  /// One line "PLACE: ... FRAGMENT ...", exit status 2, nothing on standard output.
  void expect_refusal(const Answer& answer, const std::string& place, const std::vector<std::string>& fragments) const {
    EXPECT_EQ(answer.status, kBadInput) << answer.error;
    EXPECT_EQ(answer.out, "");
    EXPECT_EQ(answer.error.compare(0, place.size() + 2, place + ": "), 0)
        << answer.error << "  should start with " << place;
    EXPECT_EQ(std::count(answer.error.begin(), answer.error.end(), '\n'), 1) << answer.error;
    for (const std::string& fragment : fragments) {
      EXPECT_NE(answer.error.find(fragment), std::string::npos) << answer.error << "  should say: " << fragment;
    }
  }

  void expect_refused(const Engine& engine, std::size_t line, const std::vector<std::string>& fragments) const {
    write("engine.ini", engine.text());
    expect_refusal(run({"show", path_}), path_ + ":" + std::to_string(line), fragments);
  }
  void expect_refused(const Engine& engine, const std::string& start, const std::vector<std::string>& fragments) const {
    expect_refused(engine, engine.line_of(start), fragments);
  }
  void expect_accepted(const Engine& engine) const {
    write("engine.ini", engine.text());
    const Answer answer = run({"show", path_, "--no-warnings"});
    EXPECT_EQ(answer.status, 0) << answer.error;
    EXPECT_EQ(answer.error, "");
  }

  const Engine sample_{contents(kSample)};
  crankloop::support::TemporaryFolder folder_;
  std::string path_;
};

}  // namespace crankloop::bad_input
