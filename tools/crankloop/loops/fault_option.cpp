#include "fault_option.hpp"

#include <string>
#include <string_view>

#include "../files/error.hpp"
#include "../files/number.hpp"
#include "../files/words.hpp"

namespace crankloop::program {

std::uint32_t fault_bits(const Arguments& arguments, const EngineDefinition& definition) {
  if (!arguments.has(kFaultBits.name)) return 0;
  std::uint32_t known = 0, bits = 0;
  for (int i = 0; i < definition.wheel_fault_count; ++i)
    if (definition.wheel_faults[i].input_bit >= 0) known |= 1u << definition.wheel_faults[i].input_bit;
  for (const std::string_view one : split(arguments.text(kFaultBits.name), ',')) {
    const ParsedNumber number = parse_number(one, from(0).up_to(31), "");
    if (!number.ok()) throw UsageError("--fault-bits: " + number.problem);
    const auto bit = static_cast<std::uint32_t>(number.value);
    if (static_cast<double>(bit) != number.value)
      throw UsageError("--fault-bits: " + in_quotes(one) + " is not a whole number");
    if ((known >> bit & 1u) == 0)
      throw UsageError("--fault-bits: no [fault NAME] has input_bit = " + std::to_string(bit));
    bits |= 1u << bit;
  }
  return bits;
}

}  // namespace crankloop::program
