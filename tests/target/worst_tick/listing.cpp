#include "listing.hpp"

#include <cstdlib>
#include <sstream>

namespace worst_tick {
namespace {

[[nodiscard]] std::uint32_t address_in(const std::string& text) {
  return static_cast<std::uint32_t>(std::strtoul(text.c_str(), nullptr, 16));
}

/// "00001774 <name>:"; the name is empty on any other line.
[[nodiscard]] std::string function_name(const std::string& line) {
  const std::size_t open = line.find(" <");
  if (open == std::string::npos || line.size() < 2 || line.compare(line.size() - 2, 2, ">:") != 0) return "";
  return line.substr(open + 2, line.size() - open - 4);
}

/// "    1774:\tldr.w\tr4, [fp, #144]\t@ 0x90"; data is told by an empty mnemonic.
[[nodiscard]] bool read_instruction(const std::string& line, Instruction& out) {
  const std::size_t colon = line.find(":\t");
  if (colon == std::string::npos || line.find_first_not_of(" 0123456789abcdef") != colon) return false;
  std::string text = line.substr(colon + 2);
  for (const char* comment : {"\t@", "\t;", " @ "}) text = text.substr(0, text.find(comment));
  const std::size_t tab = text.find_first_of("\t ");
  out.address = address_in(line);
  out.mnemonic = text.substr(0, tab);
  out.operands = tab == std::string::npos ? "" : text.substr(tab + 1);
  if (out.mnemonic[0] == '.') out.mnemonic.clear();
  const std::size_t width = out.mnemonic.rfind('.');
  if (width != std::string::npos && (out.mnemonic.substr(width) == ".n" || out.mnemonic.substr(width) == ".w"))
    out.mnemonic.resize(width);
  return true;
}

}  // namespace

Program read_listing(std::istream& listing) {
  Program program;
  Function* function = nullptr;
  bool after_data = false;
  Instruction* before = nullptr;
  for (std::string line; std::getline(listing, line);) {
    const std::string name = function_name(line);
    Instruction instruction;
    if (!name.empty()) {
      function = &program[address_in(line)];
      function->name = name;
      after_data = false;
    } else if (function != nullptr && read_instruction(line, instruction)) {
      if (before != nullptr && instruction.address - before->address == 2) before->size = 2;
      before = nullptr;
      instruction.follows_data = after_data;
      after_data = instruction.mnemonic.empty();
      if (!after_data) {
        function->instructions.push_back(instruction);
        before = &function->instructions.back();
      }
    }
  }
  return program;
}

void read_places(std::istream& places, Program& program) {
  std::map<std::uint32_t, std::vector<Place>> of;
  std::string line;
  std::uint32_t address = 0;
  while (std::getline(places, line)) {
    if (line.compare(0, 2, "0x") == 0) {
      address = address_in(line);
      continue;
    }
    const std::size_t colon = line.rfind(':');
    if (colon != std::string::npos) of[address].push_back({line.substr(0, colon), std::atoi(line.c_str() + colon + 1)});
  }
  for (auto& [begin, function] : program) {
    for (Instruction& instruction : function.instructions) {
      std::vector<Place>& all = of[instruction.address];
      if (all.empty()) continue;
      instruction.place = all.front();
      instruction.calls.assign(all.begin() + 1, all.end());
    }
  }
}

bool matches(const std::string& name, const std::string& pattern) {
  std::istringstream parts(pattern);
  std::size_t at = 0;
  for (std::string part; std::getline(parts, part, '*'); at += part.size()) {
    at = name.find(part, at);
    if (at == std::string::npos) return false;
  }
  return true;
}

std::string hex(std::uint32_t address) {
  std::ostringstream text;
  text << std::hex << address;
  return text.str();
}

}  // namespace worst_tick
