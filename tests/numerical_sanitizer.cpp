// Two engines in float, up through the speeds: what tests/numerical_sanitizer.sh runs. No test: it asserts nothing,
// the sanitizer's findings are read line by line.
#include <cstdio>

#include "support/gas_engine.hpp"
#include "support/kept_engines.hpp"

namespace crankloop {
namespace {

/// Sum of the torque, or nothing would be computed.
template <class S, class Step>
double run_up(Input<float, S>& in, const Step& step) {
  double sum = 0;
  for (const float rpm : {900.0F, 3000.0F, 6000.0F, 9000.0F}) {
    in.speed_rad_s = rpm * 0.10471976F;
    for (int tick = 0; tick < 600; ++tick) sum += static_cast<double>(step(in).mean_torque_Nm);
  }
  return sum;
}

/// Eight elastic valves; four cylinders that burn and breathe through elastic valves.
double run_both() {
  Input<float, tick_test::FourWithValves> in;
  const auto valves = tick_test::started_four<float, tick_test::FourWithValves>();
  support::Breathing<float, support::ElasticBreathingFour> gas{support::four_2000(), 100e-6};
  return run_up(
             in, [&](const auto& now) -> const auto& { return valves->step(now); }) +
         run_up(
             gas.in, [&](const auto&) -> const auto& { return gas.step(); });
}

}  // namespace
}  // namespace crankloop

int main() { return std::printf("%g\n", crankloop::run_both()) < 0; }
