#include "vcd.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../files/number.hpp"

namespace crankloop::program {
namespace {

/// A variable's short name in the file: printable characters, ! to ~, the lowest digit first.
std::string code_of(std::size_t number) {
  constexpr std::size_t kDigits = '~' - '!' + 1;
  std::string code;
  do {
    code += static_cast<char>('!' + number % kDigits);
    number /= kDigits;
  } while (number > 0);
  return code;
}

std::string reference(std::string name) {
  for (char& c : name) {
    const bool fine = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    if (!fine) c = '_';
  }
  return name.empty() ? "_" : name;
}

}  // namespace

VcdFile::VcdFile(Output& out, const std::string& module, const std::vector<std::string>& wires,
                 const std::vector<std::string>& numbers)
    : out_{out}, wires_{wires.size()} {
  out_.write("$version crankloop $end\n$timescale 1 ns $end\n$scope module " + reference(module) + " $end\n");
  const auto declare = [this](const std::string& type, const std::string& name) {
    variables_.push_back({code_of(variables_.size()), 0, false});
    out_.write("$var " + type + " " + variables_.back().code + " " + reference(name) + " $end\n");
  };
  for (const std::string& name : wires) declare("wire 1", name);
  for (const std::string& name : numbers) declare("real 64", name);
  out_.write("$upscope $end\n$enddefinitions $end\n");
}

std::int64_t VcdFile::nanoseconds(double time_s) { return std::llround(time_s * 1e9); }

void VcdFile::note(Change change) {
  change.time_ns = std::max(change.time_ns, written_ns_);  // times in the file never decrease
  noted_.push_back(change);
}

void VcdFile::write_until(double time_s) {
  const std::int64_t until_ns = nanoseconds(time_s);
  std::stable_sort(noted_.begin(), noted_.end(),
                   [](const Change& a, const Change& b) { return a.time_ns < b.time_ns; });
  const auto rest =
      std::find_if(noted_.begin(), noted_.end(), [until_ns](const Change& c) { return c.time_ns > until_ns; });
  std::for_each(noted_.begin(), rest, [this](const Change& change) { write(change); });
  noted_.erase(noted_.begin(), rest);
}

void VcdFile::write(const Change& change) {
  Variable& variable = variables_.at(change.variable);
  if (variable.known && variable.value == change.value) return;
  variable.known = true;
  variable.value = change.value;
  write_time(change.time_ns);
  if (change.variable < wires_) {
    out_.write((change.value != 0 ? "1" : "0") + variable.code + "\n");
  } else {
    out_.write("r" + shortest(change.value) + " " + variable.code + "\n");
  }
}

void VcdFile::write_time(std::int64_t time_ns) {
  if (time_ns == written_ns_) return;
  out_.write("#" + std::to_string(time_ns) + "\n");
  written_ns_ = time_ns;
}

void VcdFile::finish(double time_s) {
  for (const Change& change : noted_) time_s = std::max(time_s, static_cast<double>(change.time_ns) / 1e9);
  write_until(time_s);
  write_time(std::max(nanoseconds(time_s), written_ns_));
}

}  // namespace crankloop::program
