// Committed texts that a run must give again, to the last bit, and how they are renewed on purpose.
//
//     build/check/tests/crankloop_golden_tests --renew "why"      (tests/golden/renew.sh builds first)
//
// writes them all anew and adds a line with the reason and their checksum to CHANGELOG.md, which a test demands.
//
// What belongs here: comparing and renewing. What does not: what is run (tests/golden/).
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/tick/saved_bytes.hpp>

namespace crankloop::support {

/// FNV-1a over the bytes of numbers, least significant first, so that neither byte order nor padding counts.
class Fnv {
 public:
  template <class T>
  void add(const T& x) {
    const std::uint64_t bits = detail::word_of(x);
    for (std::size_t i = 0; i < sizeof x; ++i) {
      hash_ ^= (bits >> (8 * i)) & 0xFFu;
      hash_ *= 0x100000001B3u;
    }
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325u;
};

/// 16 hexadecimal digits.
inline std::string hex(std::uint64_t x) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(x));
  return text;
}

/// The reason for renewing, or null: compare. Set by golden/main.cpp alone.
inline const char*& renewal() {
  static const char* why = nullptr;
  return why;
}

inline std::string contents_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline std::filesystem::path golden_runs() { return std::filesystem::path(CRANKLOOP_GOLDEN_DIR) / "runs"; }

/// Compares with tests/golden/runs/NAME.txt; the first line that differs is shown.
inline void expect_golden(const std::string& name, const std::string& text) {
  const std::filesystem::path path = golden_runs() / (name + ".txt");
  if (renewal() != nullptr) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return;
  }
  std::istringstream now(text);
  std::istringstream committed(contents_of(path));
  std::string now_line;
  std::string committed_line;
  for (int line = 1;; ++line) {
    const bool more_now = static_cast<bool>(std::getline(now, now_line));
    const bool more_committed = static_cast<bool>(std::getline(committed, committed_line));
    if (!more_now && !more_committed) return;
    if (more_now && more_committed && now_line == committed_line) continue;
    ADD_FAILURE() << path.string() << ":" << line << ": the bits have changed\n  committed: " << (more_committed ? committed_line : "(end)")
                  << "\n  now:       " << (more_now ? now_line : "(end)") << "\nIf that is meant: tests/golden/renew.sh \"why\"";
    return;
  }
}

/// Eight digits that stand for all committed runs.
inline std::string checksum_of_golden_runs() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(golden_runs())) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  detail::Crc32 crc;
  for (const auto& path : paths) {
    for (const char c : path.filename().string() + contents_of(path)) crc.add(static_cast<unsigned char>(c));
  }
  return hex(crc.value()).substr(8);
}

}  // namespace crankloop::support
