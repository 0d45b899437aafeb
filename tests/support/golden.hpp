// Committed texts that a run must give again, to the last bit, and how they are renewed on purpose. Of a run's rows
// those of every hundredth tick are committed, and a hash of all rows.
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
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <crankloop/tick/state/saved_bytes.hpp>

namespace crankloop::support {

/// FNV-1a over the bytes of numbers, least significant first, so that neither byte order nor padding counts.
class Fnv {
 public:
  template <class T>
  void add(const T& x) {
    std::uint64_t bits;
    if constexpr (std::is_integral_v<T>)
      bits = static_cast<std::uint64_t>(x);
    else
      bits = detail::word_of(x);
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

/// What is committed of a run: rows that tell a phase or a hash at every hundredth tick, a row without a tick, and the
/// hash of all rows.
inline std::string thinned(const std::string& text) {
  constexpr int kKeptTicks = 100;
  Fnv hash;
  for (const char c : text) hash.add(static_cast<unsigned char>(c));
  std::istringstream rows(text);
  std::string kept;
  int count = 0;
  for (std::string row; std::getline(rows, row); ++count) {
    std::istringstream words(row);
    int tick = 0;
    std::string what;
    const bool has_tick = static_cast<bool>(words >> tick >> what);
    if (!has_tick || (tick % kKeptTicks == 0 && (what == "phase" || what == "hash"))) kept += row + "\n";
  }
  return kept + "all " + std::to_string(count) + " rows hash " + hex(hash.value()) + "\n";
}

/// Compares with tests/golden/runs/NAME.txt; the first line that differs is shown, and where the whole run lies.
inline void expect_golden(const std::string& name, const std::string& run) {
  const std::string text = thinned(run);
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
    const std::filesystem::path whole = std::filesystem::path(::testing::TempDir()) / (name + ".txt");
    std::ofstream(whole, std::ios::binary) << run;
    ADD_FAILURE() << path.string() << ":" << line
                  << ": the bits have changed\n  committed: " << (more_committed ? committed_line : "(end)")
                  << "\n  now:       " << (more_now ? now_line : "(end)") << "\nAll rows of now: " << whole.string()
                  << "\nIf that is meant: tests/golden/renew.sh \"why\"";
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
