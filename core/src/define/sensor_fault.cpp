// Validation of a fault of a controller's sensor; field names as in the engine file.
#include <crankloop/define/sensor_fault.hpp>

#include "rules.hpp"

namespace crankloop {

Status validate(const SensorFault& fault) noexcept {
  constexpr double kMostSteps = 65536;
  if (const Status refused = detail::out_of_range(fault); !refused.ok()) return refused;
  if (static_cast<int>(fault.sensor) >= kControllerSensors) return refuse("sensor_fault.sensor", Reason::out_of_range);
  if (fault.wire > SensorWire::shorted) return refuse("sensor_fault.wire", Reason::out_of_range);
  if (!fault.timed() && fault.input_bit < 0) return refuse("sensor_fault.end_s", Reason::inconsistent);  // never on
  const bool at_limit = fault.wire == SensorWire::open || fault.wire == SensorWire::shorted;
  if ((at_limit || fault.step > 0) && !fault.has_range()) return refuse("sensor_fault.most", Reason::inconsistent);
  if (fault.step > 0 && fault.most - fault.least > kMostSteps * fault.step)
    return refuse("sensor_fault.step", Reason::out_of_range);
  return {};
}

}  // namespace crankloop
