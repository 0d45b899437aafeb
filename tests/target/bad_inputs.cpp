// Whatever bits come in, every output is finite and the faults say what was wrong.
#include <crankloop/tick/engine.hpp>

#include "bits.hpp"
#include "diesel_everything.hpp"
#include "diesel_elastic_valves.hpp"
#include "diesel_torque_sensor.hpp"
#include "ohc_125_everything.hpp"
#include "output_numbers.hpp"
#include "report.hpp"

namespace target_check {
namespace {

using crankloop::Input;
using crankloop::Needs;

constexpr int kTicks = 20'000;
constexpr std::uint64_t kSeed = 495;

/// A number to hurt with: random bits, so all magnitudes and some NaN; a special value; or one within its range.
template <class Real>
[[nodiscard]] Real hostile(Random& random, Real largest) noexcept {
  const std::uint64_t bits = random.next();
  const std::uint64_t choice = bits & 3;
  if (choice == 0) return from_bits<Real>(random.next());
  if (choice == 1) {
    const Real infinity = from_bits<Real>(sizeof(Real) == 4 ? 0x7F80'0000'0000'0000u : 0x7FF0'0000'0000'0000u);
    const Real least = from_bits<Real>(sizeof(Real) == 4 ? std::uint64_t{1} << 32 : 1);  // denormal
    const Real special[] = {infinity, -infinity, infinity - infinity, least, -least, Real{0}, -Real{0}, largest, -largest, -largest * 2, 2 * largest};
    return special[bits / 4 % (sizeof special / sizeof special[0])];
  }
  return largest * (static_cast<Real>(static_cast<std::int32_t>(bits >> 40) - (1 << 23)) / static_cast<Real>(1 << 23));
}

/// Every number of the input at once.
template <class Real, class S>
void hurt(Input<Real, S>& in, Random& random) noexcept {
  if constexpr (S::crank == crankloop::CrankGiven::speed) {
    in.speed_rad_s = hostile<Real>(random, 10'000);
  } else {
    in.crank = crankloop::Phase{random.next()};
  }
  if constexpr (Needs<S>::load) in.load_ratio = hostile<Real>(random, 2);
  if constexpr (Needs<S>::input_pressure) {
    for (Real& pressure : in.pressure_Pa) pressure = hostile<Real>(random, static_cast<Real>(1e8));
  }
  if constexpr (S::cam_phasing) {
    for (Real& target : in.cam_phase_deg) target = hostile<Real>(random, 180);
  }
}

template <class Real, class S>
void survive(Report& report, crankloop::Engine<Real, S>& engine, const char* name) noexcept {
  Random random(kSeed);
  Input<Real, S> in;
  FiniteCheck check;
  std::uint32_t faults = 0;
  for (int tick = 0; tick < kTicks; ++tick) {
    hurt<Real>(in, random);
    each_number(check, engine.step(in));
    faults |= engine.output().faults;
  }
  report.check(check.finite(), name);
  report.check(faults != 0 && (faults & crankloop::kFaultNotReady) == 0, "bad input sets fault bits");
  // And back to work: a good input is no fault, whatever came before.
  const Input<Real, S> good;
  engine.step(good);
  engine.step(good);
  report.check((engine.output().faults & ~std::uint32_t{crankloop::kFaultEventBudget}) == 0, "a good input after bad ones sets no fault bit");
}

}  // namespace

void check_bad_inputs(Report& report) noexcept {
  static diesel_everything::Engine everything_engine;
  static diesel_elastic_valves::Engine elastic_valves_engine;
  static diesel_torque_sensor::Engine torque_sensor_engine;
  static ohc_125_everything::Engine ohc_engine;
  survive(report, everything_engine, "diesel_everything: outputs are finite whatever comes in");
  survive(report, elastic_valves_engine, "diesel_elastic_valves: outputs are finite whatever comes in");
  survive(report, torque_sensor_engine, "diesel_torque_sensor: outputs are finite whatever comes in");
  survive(report, ohc_engine, "ohc_125_everything: outputs are finite whatever comes in");

  static crankloop::Engine<float, diesel_elastic_valves::Scene> never_initialised;
  const auto& out = never_initialised.step({});
  report.check(out.faults == crankloop::kFaultNotReady, "an engine without tables says that it is not ready");
  FiniteCheck check;
  each_number(check, out);
  report.check(check.finite(), "an engine without tables answers finite numbers");
}

}  // namespace target_check
