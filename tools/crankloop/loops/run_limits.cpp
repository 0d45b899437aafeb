#include "run_limits.hpp"

#include <cmath>

#include "../files/error.hpp"
#include "../files/number.hpp"
#include "../files/units.hpp"

namespace crankloop::program {
namespace {

std::string digits(double value) { return significant(static_cast<float>(value)); }

}  // namespace

void require_ticks(double ticks, double tick_s, const std::string& remedy) {
  if (ticks <= kMaxTicks) return;
  throw UsageError("the run would take " + digits(ticks) + " ticks of " + digits(tick_s * 1e6) + " us, at most " +
                   digits(kMaxTicks) + " are allowed: take a longer --tick-us, " + remedy);
}

void require_speed(double speed_rpm, double limit_rad_s, double tick_s, const Crank& crank) {
  const double limit_rpm = limit_rad_s * 30 / kPi;
  if (std::fabs(speed_rpm) <= limit_rpm) return;
  if (crank.max_speed_rad_s != 0 && limit_rad_s >= 0.999999 * crank.max_speed_rad_s)
    throw UsageError(digits(speed_rpm) + " rpm is beyond the engine's max_rpm of " +
                     digits(crank.max_speed_rad_s * 30 / kPi));
  throw UsageError(digits(speed_rpm) + " rpm is too fast for a tick of " + digits(tick_s * 1e6) +
                   " us: at most one revolution per tick, here " + digits(std::floor(limit_rpm)) + " rpm");
}

}  // namespace crankloop::program
