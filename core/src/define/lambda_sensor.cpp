// Validation of a lambda sensor; field names as in the engine file.
#include <crankloop/define/lambda_sensor.hpp>

#include "rules.hpp"

namespace crankloop {

Status validate(const LambdaSensor& sensor) noexcept { return detail::out_of_range(sensor); }

}  // namespace crankloop
