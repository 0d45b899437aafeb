// The golden runs of the sample engines, with tables in flash: each must give the hash of golden_hashes.inc on every
// machine.
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

/// False where double is emulated and a difference comes out wrong. 1 - x is 0x1.fffffffe2fe8p-1 to within 0.002 of its
/// last place; GCC 12's libgcc for Arm cores without double precision answers one place less, as for all operands whose
/// exponents are 33 apart: of the smaller one's low word it keeps whether it is 0, and then shifts by one bit.
[[nodiscard]] bool doubles_subtract_right() noexcept {
  volatile double one = 1, x = 0x1.d0180004a896fp-33;
  volatile double difference = one - x;
  return difference == 0x1.fffffffe2fe80p-1;
}

template <class Real, class S>
[[nodiscard]] constexpr bool in_double(const crankloop::Engine<Real, S>&) noexcept {
  return sizeof(Real) == sizeof(double);
}

/// One golden run; top_rad_s is the largest crank speed in it.
template <class Engine>
void run(Report& report, const char* name, int top_rad_s) noexcept {
  static Engine engine;
  const std::uint64_t hash = golden_hash(engine, top_rad_s);
  crankloop::port::Line() << "golden " << name << " 0x" << crankloop::port::Hex{hash};
  bool matches = false;
  for (const Golden& golden : kGolden) matches = matches || (same(golden.name, name) && golden.hash == hash);
  const bool excused = !matches && in_double(engine) && !doubles_subtract_right();
  if (excused) crankloop::port::Line() << "not compared: the tool chain's emulated double subtracts wrongly";
  report.check(matches || excused, name);
}

}  // namespace

void check_golden_runs(Report& report) noexcept {
#include "golden_runs.inc"
}

}  // namespace target_check
