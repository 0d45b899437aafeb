#include "thumb.hpp"

#include <cstdlib>
#include <set>

namespace worst_tick {
namespace {

const std::set<std::string> kConditions = {"eq", "ne", "cs", "hs", "cc", "lo", "mi", "pl",
                                           "vs", "vc", "hi", "ls", "ge", "lt", "gt", "le"};

/// Whether `mnemonic` is `name`, alone or with a condition (in an IT block).
[[nodiscard]] bool is(const std::string& mnemonic, const std::string& name, bool& conditional) {
  if (mnemonic.compare(0, name.size(), name) != 0) return false;
  const std::string rest = mnemonic.substr(name.size());
  conditional = is_condition(rest);
  return rest.empty() || conditional;
}

/// The address that a branch names last: "r3, 1774 <step+0x12>".
[[nodiscard]] std::uint32_t named_target(const Instruction& i) {
  const std::size_t name = i.operands.find(" <");
  const std::string until = i.operands.substr(0, name);
  const std::size_t space = until.rfind(' ');
  const std::string digits = space == std::string::npos ? until : until.substr(space + 1);
  char* end = nullptr;
  const unsigned long address = std::strtoul(digits.c_str(), &end, 16);
  if (digits.empty() || *end != '\0') throw Refusal(hex(i.address) + ": a branch to '" + i.operands + "'");
  return static_cast<std::uint32_t>(address);
}

/// Whether the instruction loads or computes the program counter.
[[nodiscard]] bool writes_pc(const Instruction& i) {
  const std::string& m = i.mnemonic;
  if (m.compare(0, 3, "ldm") == 0 || m.compare(0, 3, "pop") == 0) return i.operands.find("pc}") != std::string::npos;
  if (m.compare(0, 3, "cmp") == 0 || m.compare(0, 3, "cmn") == 0 || m.compare(0, 3, "tst") == 0 ||
      m.compare(0, 3, "str") == 0)
    return false;
  return i.operands.compare(0, 2, "pc") == 0 && (i.operands.size() == 2 || i.operands[2] == ',');
}

[[nodiscard]] bool returns_from_stack(const Instruction& i) {
  bool conditional = false;
  if (is(i.mnemonic, "pop", conditional)) return true;
  if (is(i.mnemonic, "ldmia", conditional)) return i.operands.compare(0, 3, "sp!") == 0;
  return is(i.mnemonic, "ldr", conditional) && i.operands.compare(0, 8, "pc, [sp]") == 0;
}

}  // namespace

bool is_condition(const std::string& text) { return kConditions.count(text) != 0; }

Flow flow_of(const Instruction& i) {
  const std::string& m = i.mnemonic;
  bool conditional = false;
  if (is(m, "b", conditional)) return {conditional, true, false, false, named_target(i)};
  if (m == "cbz" || m == "cbnz") return {true, true, false, false, named_target(i)};
  if (is(m, "bl", conditional)) return {true, false, true, false, named_target(i)};
  if (is(m, "bx", conditional) && i.operands == "lr") return {conditional, false, false, true, 0};
  if (writes_pc(i)) {
    if (!returns_from_stack(i))
      throw Refusal(hex(i.address) + ": a jump to an address that was computed: " + m + " " + i.operands);
    for (const std::string& c : kConditions)
      conditional = conditional || (m.size() > 4 && m.compare(m.size() - 2, 2, c) == 0);
    return {conditional, false, false, true, 0};
  }
  // What else begins with b changes bits; tbb and tbh are jump tables, le, wls and dls loops of Armv8.1-M.
  const bool harmless_b = m.compare(0, 3, "bic") == 0 || m.compare(0, 3, "bfi") == 0 || m.compare(0, 3, "bfc") == 0;
  for (const char* leaves : {"tbb", "tbh", "svc", "udf", "le", "wls", "wlstp", "dls", "dlstp", "letp", "rfe"}) {
    if (m == leaves) throw Refusal(hex(i.address) + ": not known where it leads: " + m + " " + i.operands);
  }
  if (m[0] == 'b' && !harmless_b) throw Refusal(hex(i.address) + ": not known where it leads: " + m + " " + i.operands);
  return {};
}

}  // namespace worst_tick
