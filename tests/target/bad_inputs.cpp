// Whatever bits come in, every output is finite and the faults say what was wrong.
#include <crankloop/engine.hpp>

#include "diesel_closed_loop.hpp"
#include "diesel_elastic_valves.hpp"
#include "diesel_everything.hpp"
#include "diesel_torque_sensor.hpp"
#include "hostile.hpp"
#include "ohc_125_everything.hpp"
#include "output_numbers.hpp"
#include "report.hpp"

namespace target_check {
namespace {

using crankloop::Input;

constexpr int kTicks = 20'000;
constexpr std::uint64_t kSeed = 495;
/// Not of the input: the engine may still be as fast as it was thrown.
constexpr std::uint32_t kOfTheMotion =
    crankloop::kFaultEventBudget | crankloop::kFaultOverspeed | crankloop::kFaultTriggerEdges;

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
  report.check((engine.output().faults & ~kOfTheMotion) == 0, "a good input after bad ones sets no fault bit");
}

}  // namespace

void check_bad_inputs(Report& report) noexcept {
  static diesel_everything::Engine everything_engine;
  static diesel_elastic_valves::Engine elastic_valves_engine;
  static diesel_torque_sensor::Engine torque_sensor_engine;
  static diesel_closed_loop::Engine closed_loop_engine;
  static ohc_125_everything::Engine ohc_engine;
  survive(report, everything_engine, "diesel_everything: outputs are finite whatever comes in");
  survive(report, elastic_valves_engine, "diesel_elastic_valves: outputs are finite whatever comes in");
  survive(report, torque_sensor_engine, "diesel_torque_sensor: outputs are finite whatever comes in");
  survive(report, closed_loop_engine, "diesel_closed_loop: outputs are finite whatever comes in");
  survive(report, ohc_engine, "ohc_125_everything: outputs are finite whatever comes in");

  static crankloop::Engine<float, diesel_elastic_valves::Scene> never_initialised;
  const auto& out = never_initialised.step({});
  report.check(out.faults == crankloop::kFaultNotReady, "an engine without tables says that it is not ready");
  FiniteCheck check;
  each_number(check, out);
  report.check(check.finite(), "an engine without tables answers finite numbers");
}

}  // namespace target_check
