#include "valve_tick_limit.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tabulate/valve_lift.hpp>

#include "../files/number.hpp"

namespace crankloop::program {
namespace {

constexpr double kLongestTick_s = 2e-3;  // of any engine

}  // namespace

InputError tick_too_long(const EngineFile& file, const TrainOfFile& train, const Valve& valve, double tick_s,
                         const ValveStepping& stepping) {
  const auto lift = std::make_unique<ValveLift>();
  if (const Status refused = lift->init(train.definition.cam, train.definition.rocker); !refused.ok()) {
    return file.explain(refused, train, lift->failed_at_deg());
  }
  const double longest_us =
      std::floor(longest_tick_s(valve_body(valve, *lift), stepping) * 1e7) / 10;  // down, so that it is accepted
  return InputError(file.path() + ": a tick of " + brief(tick_s * 1e6) + " us would take more than " +
                    std::to_string(kMaxFineSteps) + " steps of the valve train " + train.name + " at an accuracy of " +
                    brief(stepping.accuracy_m * 1e6) + " um; the longest tick possible is " + brief(longest_us) +
                    " us");
}

void require_trains(const EngineFile& file, double tick_s, const ValveStepping& stepping) {
  for (const TrainOfFile& train : file.trains()) {
    if (!train.complete()) continue;
    const auto lift = std::make_unique<ValveLift>();
    if (const Status refused = lift->init(train.definition.cam, train.definition.rocker); !refused.ok()) {
      throw file.explain(refused, train, lift->failed_at_deg());
    }
    if (tick_s > longest_tick_s(valve_body(train.definition.valve, *lift), stepping)) {
      throw tick_too_long(file, train, train.definition.valve, tick_s, stepping);
    }
  }
}

double class_deg(const ValveTrain& train, double tick_s, const ValveStepping& stepping) {
  EngineDefinition definition;
  definition.crank = {0.05, 0.025, 0.1};  // any: the valve does not depend on it
  definition.masses.piston_kg = 1;
  definition.train_count = 1;
  definition.trains[0] = train;
  detail::ValveMotion<double> motion;
  TableTargets<double> targets;
  targets.valve_motions = &motion;
  TableReport report;
  const Status refused = tabulate(definition, {tick_s, stepping}, targets, &report);
  return refused.ok() ? report.valve_class_deg : 360;  // the run reports the reason of the refusal
}

std::vector<std::string> ticks_in_words(const EngineFile& file) {
  constexpr double kUsualTick_s = 100e-6;
  std::vector<std::string> lines;
  for (const TrainOfFile& train : file.trains()) {
    if (!train.complete()) continue;
    const auto lift = std::make_unique<ValveLift>();
    if (!lift->init(train.definition.cam, train.definition.rocker).ok()) continue;
    const detail::ValveBody<double> body = valve_body(train.definition.valve, *lift);
    const double longest_us = std::floor(longest_tick_s(body, {}) * 1e6);
    std::string line = "a valve of train " + train.name + " takes ";
    if (detail::ValveMotion<double> motion; motion_of(body, kUsualTick_s, {}, motion).ok()) {
      line += std::to_string(motion.parts) + (motion.parts == 1 ? " step" : " fine steps") + " in the worst tick of " +
              brief(kUsualTick_s * 1e6) + " us and keeps its class of " + brief(ValveStepping{}.accuracy_m * 1e6) +
              " um up to " + brief(std::floor(class_deg(train.definition, kUsualTick_s, {}) / (3 * kUsualTick_s))) +
              " rpm; ";
    }
    if (longest_us < kLongestTick_s * 1e6) {
      line += std::to_string(kMaxFineSteps) + " is the most, in a tick of " + brief(longest_us) + " us";
    } else {
      line += "no tick is too long for it";
    }
    lines.push_back(line);
  }
  return lines;
}

double longest_tick_of(const EngineDefinition& definition) {
  double longest_s = kLongestTick_s;
  const auto lift = std::make_unique<ValveLift>();
  for (int t = 0; t < definition.train_count; ++t) {
    const ValveTrain& train = definition.trains[t];
    if (!lift->init(train.cam, train.rocker).ok()) continue;
    const double of_valve_s = longest_tick_s(valve_body(train.valve, *lift), {});
    const double valves = definition.train_count * definition.layout.cylinders;
    longest_s = std::min({longest_s, of_valve_s, of_valve_s * (kMaxFineStepsOfEngine / valves - 1) / kMaxFineSteps});
  }
  return longest_s;
}

InputError explain_tabulate(const EngineFile& file, const Status& refused, double tick_s,
                            const ValveStepping& stepping) {
  int number = 0;
  for (const TrainOfFile& train : file.trains()) {
    if (!train.complete() || number++ != refused.index) continue;
    if (refused.field == std::string_view("options.tick_s")) {
      const auto own = std::make_unique<ValveLift>();
      if (own->init(train.definition.cam, train.definition.rocker).ok() &&
          tick_s <= longest_tick_s(valve_body(train.definition.valve, *own), stepping)) {
        return InputError(file.path() + ": a tick of " + brief(tick_s * 1e6) + " us would take more than " +
                          std::to_string(kMaxFineStepsOfEngine) + " steps of all valves together: take a shorter one");
      }
      return tick_too_long(file, train, train.definition.valve, tick_s, stepping);
    }
    const auto lift = std::make_unique<ValveLift>();
    const Status of_train = lift->init(train.definition.cam, train.definition.rocker);
    if (!of_train.ok() && of_train.field == std::string_view(refused.field)) {
      return file.explain(of_train, train, lift->failed_at_deg());
    }
  }
  return file.explain(refused);
}

}  // namespace crankloop::program
