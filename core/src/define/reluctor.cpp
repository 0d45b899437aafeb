// Validation of a variable reluctance sensor; field names as in the engine file. Whether it fits its wheel is found
// where the wheel is known (validate.cpp).
#include <crankloop/define/reluctor.hpp>

#include "rules.hpp"

namespace crankloop {

Status validate(const Reluctor& reluctor) noexcept { return detail::out_of_range(reluctor); }

}  // namespace crankloop
