// The self-check of a target: prints "N passed, M failed" and ends with that as its status.
#include "port/common/machine.hpp"
#include "report.hpp"

int main() {
  target_check::Report report;
  target_check::check_golden_runs(report);
  target_check::check_tables_in_ram(report);
  target_check::check_bad_inputs(report);
  crankloop::port::finish(report.finish());
}
