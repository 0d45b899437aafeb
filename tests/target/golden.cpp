// The golden runs of the sample engines, with tables in flash: each must give the hash of golden_hashes.inc on every machine.
//
// `tests/target/renew_hashes.sh` writes that file anew where results were meant to change; CHANGELOG.md has to say so.
#include "golden.hpp"

#include <cstddef>

#include "golden_engines.hpp"
#include "report.hpp"

namespace target_check {
namespace {

struct Golden {
  const char* name;
  std::uint64_t hash;
};
constexpr Golden kGolden[] = {
#include "golden_hashes.inc"
};

[[nodiscard]] constexpr bool same(const char* a, const char* b) noexcept {
  for (; *a != '\0' && *a == *b; ++a, ++b) {
  }
  return *a == *b;
}

/// One golden run; top_rad_s is the largest crank speed in it.
template <class Engine>
void run(Report& report, const char* name, int top_rad_s) noexcept {
  static Engine engine;
  const std::uint64_t hash = golden_hash(engine, top_rad_s);
  crankloop::port::Line() << "golden " << name << " 0x" << crankloop::port::Hex{hash};
  bool matches = false;
  for (const Golden& golden : kGolden) matches = matches || (same(golden.name, name) && golden.hash == hash);
  report.check(matches, name);
}

}  // namespace

void check_golden_runs(Report& report) noexcept {
#include "golden_runs.inc"
}

}  // namespace target_check
