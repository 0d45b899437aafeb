// A linked image as its disassembly tells it: functions, instructions, and the source line each comes from.
//
// What belongs here: reading the listings. What does not: what an instruction means (thumb.hpp).
#pragma once

#include <cstdint>
#include <istream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace worst_tick {

/// Thrown where no bound can be proven; says why and where.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A source line. `line` 0: unknown.
struct Place {
  std::string file;
  int line = 0;
};

struct Instruction {
  std::uint32_t address = 0;
  std::string mnemonic;  ///< lower case, without .n or .w
  std::string operands;
  std::uint32_t size = 4;     ///< bytes
  Place place;                ///< of the innermost function, where it was inlined
  std::vector<Place> calls;   ///< the calls that were inlined around that, from inside out
  bool follows_data = false;  ///< rather than the instruction before it
};

struct Function {
  std::string name;
  std::vector<Instruction> instructions;  ///< by rising address; data between them is left out
};

/// By the address of the first instruction.
using Program = std::map<std::uint32_t, Function>;

/// Reads what `objdump -d --no-show-raw-insn` writes.
[[nodiscard]] Program read_listing(std::istream& listing);

/// Adds places from what `addr2line -a -i` answers for addresses of the program.
void read_places(std::istream& places, Program& program);

/// Whether a name has all parts of a pattern in their order: `6EngineI*4stepE` has two.
[[nodiscard]] bool matches(const std::string& name, const std::string& pattern);

/// An address in hexadecimal, for messages.
[[nodiscard]] std::string hex(std::uint32_t address);

}  // namespace worst_tick
