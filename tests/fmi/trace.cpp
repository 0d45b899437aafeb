// fmu_trace FMU...: the bits of all outputs after each of 400 steps, as one number a line for every 40, of inputs that
// do not depend on a mathematical library. What it prints of an FMU is the same on every platform.
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "fmu.hpp"

namespace {

/// Within the range of an input, where it has one; constant for eight steps. All sums and products here are exact.
double input_at(const fmu::VariableOfFmu& variable, long k) {
  const long part = (k / 8 * 7 + variable.reference * 13) % 32;  // of 64
  const auto number = [&variable](const char* name, double otherwise) {
    const auto found = variable.attributes.find(name);
    if (found == variable.attributes.end()) return otherwise;
    std::from_chars(found->second.data(), found->second.data() + found->second.size(), otherwise);
    return otherwise;
  };
  if (variable.type == "Boolean") return k < 100 ? 1 : 0;
  if (variable.name == "speed_rad_s") return static_cast<double>(k % 250);
  const double least = number("min", 0);
  const double most = std::min(number("max", 2), least + 64);
  return least + (most - least) * static_cast<double>(part) / 64;
}

void trace(const std::string& path) {
  const fmu::Fmu fmu(path);
  const fmu::Unit unit(fmu);
  if (unit.unit == nullptr) {
    std::printf("%s: %s\n", fmu.model.identifier.c_str(), importer_message());
    std::exit(1);
  }
  constexpr double kStart_s = 2;
  constexpr double kStep_s = 0.0009765625;
  bool good = unit_setup(unit.unit, kStart_s) == UNIT_OK && unit_begin(unit.unit) == UNIT_OK &&
              unit_start(unit.unit) == UNIT_OK;
  std::uint64_t bits = 0xCBF29CE484222325;  // FNV-1a
  for (long k = 0; k < 400; ++k) {
    for (const auto& variable : fmu.model.variables)
      if (variable.causality == "input") unit.set(variable.name, input_at(variable, k));
    good = good && unit_step(unit.unit, kStart_s + static_cast<double>(k) * kStep_s, kStep_s) == UNIT_OK;
    for (const double value : unit.all()) {
      std::uint64_t word = 0;
      std::memcpy(&word, &value, sizeof word);
      for (int byte = 0; byte < 8; ++byte) bits = (bits ^ (word >> (8 * byte) & 0xFFu)) * 0x100000001B3;
    }
    if (k % 40 == 39)
      std::printf("%s, FMI %d, step %ld: %08lX%08lX\n", fmu.model.identifier.c_str(), fmu.model.version, k + 1,
                  static_cast<unsigned long>(bits >> 32), static_cast<unsigned long>(bits & 0xFFFF'FFFFu));
  }
  const auto state = unit.saved();
  std::printf("%s: state of %lu bytes, %08lX\n", fmu.model.identifier.c_str(), static_cast<unsigned long>(state.size()),
              static_cast<unsigned long>(fmu::crc32(std::string(state.begin(), state.end()))));
  if (good && !testing::Test::HasFailure()) return;
  std::printf("%s: %s\n", fmu.model.identifier.c_str(), importer_message());
  std::exit(1);
}

}  // namespace

int main(int count, char** words) {
  for (int i = 1; i < count; ++i) trace(words[i]);
  return count > 1 ? 0 : 2;
}
