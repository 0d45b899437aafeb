// The golden runs of the sample engines, with tables in flash: each must give the hash of golden_hashes.inc on every machine.
//
// `tests/target/renew_hashes.sh` writes that file anew where results were meant to change; CHANGELOG.md has to say so.
#include "golden.hpp"

#include <cstddef>

#include "diesel_everything.hpp"
#include "diesel_following_valves.hpp"
#include "diesel_forces.hpp"
#include "diesel_mean_torque.hpp"
#include "diesel_torque_of_pressures.hpp"
#include "diesel_torque_of_tables.hpp"
#include "diesel_torque_sensor.hpp"
#include "diesel_elastic_valves.hpp"
#include "ohc_125_everything.hpp"
#include "ohc_125_exponential.hpp"
#include "report.hpp"
#include "diesel_everything_double.hpp"
#include "ohc_125_everything_double.hpp"

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

/// 240 rad/s are 2300 rpm, beyond the diesel's speed; 1400 rad/s 13 400 rpm, where the 125's valve floats and bounces.
constexpr int kDieselTop_rad_s = 240;
constexpr int kOhcTop_rad_s = 1400;

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
  run<diesel_torque_of_pressures::Engine>(report, "diesel_torque_of_pressures", kDieselTop_rad_s);
  run<diesel_torque_of_tables::Engine>(report, "diesel_torque_of_tables", kDieselTop_rad_s);
  run<diesel_mean_torque::Engine>(report, "diesel_mean_torque", kDieselTop_rad_s);
  run<diesel_torque_sensor::Engine>(report, "diesel_torque_sensor", kDieselTop_rad_s);
  run<diesel_forces::Engine>(report, "diesel_forces", kDieselTop_rad_s);
  run<diesel_following_valves::Engine>(report, "diesel_following_valves", kDieselTop_rad_s);
  run<diesel_elastic_valves::Engine>(report, "diesel_elastic_valves", kDieselTop_rad_s);
  run<diesel_everything::Engine>(report, "diesel_everything", kDieselTop_rad_s);
  run<ohc_125_everything::Engine>(report, "ohc_125_everything", kOhcTop_rad_s);
  run<ohc_125_exponential::Engine>(report, "ohc_125_exponential", kOhcTop_rad_s);
  run<diesel_everything_double::Engine>(report, "diesel_everything_double", kDieselTop_rad_s);
  run<ohc_125_everything_double::Engine>(report, "ohc_125_everything_double", kOhcTop_rad_s);
}

}  // namespace target_check
