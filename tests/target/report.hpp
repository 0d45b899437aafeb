// How a self-check counts and tells.
#pragma once

#include <cstdint>

#include "port/common/text.hpp"

namespace target_check {

/// Counts checks; a failed one says its name.
class Report {
 public:
  void check(bool well, const char* name) noexcept {
    ++(well ? passed_ : failed_);
    if (!well) crankloop::port::Line() << "FAILED: " << name;
  }
  /// Prints "N passed, M failed"; answers the exit status.
  [[nodiscard]] int finish() const noexcept {
    crankloop::port::Line() << passed_ << " passed, " << failed_ << " failed";
    return failed_ == 0 && passed_ > 0 ? 0 : 1;
  }

 private:
  std::uint32_t passed_ = 0;
  std::uint32_t failed_ = 0;
};

void check_golden_runs(Report& report) noexcept;
void check_tables_in_ram(Report& report) noexcept;
void check_bad_inputs(Report& report) noexcept;

}  // namespace target_check
