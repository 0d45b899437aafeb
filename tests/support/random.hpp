// Random numbers for tests: the same on every machine, and their seed is part of every failure.
//
// What belongs here: numbers. What does not: engines made of them (support/engines.hpp).
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

namespace crankloop::support {

/// CRANKLOOP_TEST_SEED in the environment, or a fixed one: a failure is repeated by setting what its message shows.
inline std::uint64_t test_seed() {
  const char* given = std::getenv("CRANKLOOP_TEST_SEED");
  return given != nullptr ? std::strtoull(given, nullptr, 0) : 0x2718'2818'2845'9045u;
}

/// Numbers by splitmix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014); doubles by exact
/// scaling.
class Random {
 public:
  explicit Random(std::uint64_t seed = test_seed()) : seed_{seed}, state_{seed} {}

  std::uint64_t bits() {
    state_ += 0x9E37'79B9'7F4A'7C15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58'476D'1CE4'E5B9u;
    z = (z ^ (z >> 27)) * 0x94D0'49BB'1331'11EBu;
    return z ^ (z >> 31);
  }
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * (1.0 / 9007199254740992.0));
  }
  int whole(int low, int high) { return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1)); }
  bool coin() { return (bits() >> 63) != 0; }

  /// For SCOPED_TRACE: which draw of which seed failed.
  [[nodiscard]] std::string trace(int draw) const {
    return "seed " + std::to_string(seed_) + ", draw " + std::to_string(draw);
  }

 private:
  std::uint64_t seed_;
  std::uint64_t state_;
};

}  // namespace crankloop::support
