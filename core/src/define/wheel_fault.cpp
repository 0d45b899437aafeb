// Validation of a fault of a trigger wheel; field names as in the engine file. Whether its teeth leave room for one
// another is found where they are placed (tabulate/wheel_fault_tracks.cpp).
#include <crankloop/define/wheel_fault.hpp>

#include "rules.hpp"

namespace crankloop {

Status validate(const WheelFault& fault) noexcept {
  if (const Status refused = detail::out_of_range(fault); !refused.ok()) return refused;
  if (fault.stuck > StuckSignal::high) return refuse("fault.stuck", Reason::out_of_range);
  if (!fault.timed() && fault.input_bit < 0) return refuse("fault.end_s", Reason::inconsistent);  // never on
  if (fault.missing_tooth != 0 && fault.missing_tooth == fault.moved_tooth)
    return refuse("fault.moved_tooth", Reason::inconsistent);
  return {};
}

}  // namespace crankloop
