// `crankloop bench`: run time against error, all contestants in one process.
#include <cstdio>
#include <string>
#include <vector>

#include "bench/bench_report.hpp"
#include "bench/groups.hpp"
#include "bench/kernels.hpp"
#include "bench/machine.hpp"
#include "commands.hpp"
#include "error.hpp"
#include "output.hpp"

namespace crankloop::program {
namespace {

using bench::Row;

std::vector<Row> measure(const bench::Effort& effort) {
  std::vector<Row> rows;
  for (const auto group : {bench::kinematics_rows, bench::valve_rows, bench::tick_rows, bench::growth_rows, bench::skip_rows}) {
    for (Row& row : group(effort)) rows.push_back(std::move(row));
  }
  if (effort.rounds == 0) return rows;  // ratios are of times
  for (Row& row : bench::ratio_rows(rows)) rows.push_back(std::move(row));
  return rows;
}

bench::Effort effort_of(const Arguments& arguments) {
  if (arguments.has("--errors")) return bench::kErrorsOnly;
  return arguments.has("--quick") ? bench::kQuick : bench::kFull;
}

int run_bench(const Arguments& arguments) {
  if (arguments.has("--errors") && (arguments.has("--quick") || arguments.has("--report"))) {
    throw UsageError("--errors measures no time: it goes with neither --quick nor --report");
  }
  if (arguments.has("--kernel")) {
    bench::run_kernel(arguments.text("--kernel"), arguments.whole_number("--ticks"));
    return kSuccess;
  }
  const bench::Effort effort = effort_of(arguments);
  const std::vector<Row> rows = measure(effort);
  if (arguments.has("--csv")) bench::write_csv(arguments.text("--csv"), rows);
  if (arguments.has("--json")) {
    Output json(arguments.text("--json"));
    json.write(bench::to_json(rows));
    json.finish();
  }
  if (arguments.has("--report")) {
    Output page(arguments.text("--report"));
    page.write(report::to_html(bench::bench_page(rows, bench::describe_machine(), arguments.has("--quick") ? "crankloop bench --quick" : "crankloop bench")));
    page.finish();
  }
  const std::string text = "# " + bench::describe_machine() + "\n" + bench::to_text(rows);
  const bool text_aside = arguments.text_or_empty("--csv") == "-" || arguments.text_or_empty("--json") == "-" || arguments.text_or_empty("--report") == "-";
  if (text_aside) {
    std::fputs(text.c_str(), stderr);
  } else {
    Output out = Output::standard();
    out.write(text);
    out.finish();
  }
  return kSuccess;
}

constexpr Option kOptions[] = {
    text("--json", "F", "file for an array of objects, one per contestant and setting; - is standard output, the rest then goes to stderr"),
    text("--csv", "F", "the same as a table"),
    text("--report", "F.html", "file for the work-precision diagrams, which any browser shows"),
    flag("--quick", "half a minute instead of some minutes; the figures scatter more"),
    flag("--errors", "errors only, nothing is timed: the same figures everywhere"),
    text("--kernel", "NAME", "only runs one contestant, for an instruction counter; a wrong name lists them"),
    whole_number("--ticks", "N", from(0).up_to(1000000000), "how many ticks --kernel runs", "1000"),
};

}  // namespace

const Command kBench{"bench",
                     "run time against error: kinematics, valves, whole ticks; the library against plain code",
                     "[--json F] [--csv F] [--report F.html] [--quick | --errors] | --kernel NAME [--ticks N]",
                     "crankloop bench --quick --report bench.html",
                     0,
                     kOptions,
                     run_bench};

}  // namespace crankloop::program
