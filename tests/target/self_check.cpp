// The self-check of a target: prints "N passed, M failed" and ends with that as its status.
#include "port/common/machine.hpp"
#include "report.hpp"

// Tables are built in double: minutes in the emulator where double is software, so only where it is hardware.
int main() {
  target_check::Report report;
  target_check::check_golden_runs(report);
#if TARGET_TABULATES
  target_check::check_tables_in_ram(report);
#endif
  target_check::check_bad_inputs(report);
  crankloop::port::finish(report.finish());
}
