#include "valve_tick_limit.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <string_view>

#include <crankloop/tabulate/valve_lift.hpp>

#include "number.hpp"

namespace crankloop::program {

InputError tick_too_long(const EngineFile& file, const TrainOfFile& train, const Valve& valve, double tick_s,
                         const ValveStepping& stepping) {
  const auto lift = std::make_unique<ValveLift>();
  if (const Status refused = lift->init(train.definition.cam, train.definition.rocker); !refused.ok()) {
    return file.explain(refused, train, lift->failed_at_deg());
  }
  const ValveBody<double> body = valve_body(valve, lift->lever_m() > 0 ? lift->lever_m() : 1);
  const double longest_us = std::floor(longest_tick_s(body, stepping) * 1e7) / 10;  // down, so that it is accepted
  return InputError(file.path() + ": a tick of " + brief(tick_s * 1e6) + " us would take more than " +
                    std::to_string(kMostFineSteps) + " steps of the valve train " + train.name + " at an accuracy of " +
                    brief(stepping.accuracy_m * 1e6) + " um; the longest tick possible is " + brief(longest_us) + " us");
}

InputError explain_tabulate(const EngineFile& file, const Status& refused, double tick_s,
                            const ValveStepping& stepping) {
  int number = 0;
  for (const TrainOfFile& train : file.trains()) {
    if (!train.complete() || number++ != refused.index) continue;
    if (refused.field == std::string_view("tick.tick")) {
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
