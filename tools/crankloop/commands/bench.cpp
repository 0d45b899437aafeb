// `crankloop bench`: run time against error, all contestants in one process.
#include <string>
#include <utility>
#include <vector>

#include "../command_line/commands.hpp"
#include "../command_line/machine.hpp"
#include "../command_line/progress.hpp"
#include "../command_line/results.hpp"
#include "../files/error.hpp"
#include "lab/bench/bench_report.hpp"
#include "lab/bench/groups.hpp"
#include "lab/bench/kernels.hpp"

namespace crankloop::program {
namespace {

using bench::Row;

std::vector<Row> measure(bench::Effort effort) {
  Progress progress("measuring", bench::kRaces * effort.rounds, Progress::kLogPeriod_ns);
  effort.progress = &progress;
  std::vector<Row> rows;
  for (const auto group :
       {bench::kinematics_rows, bench::valve_rows, bench::tick_rows, bench::growth_rows, bench::skip_rows}) {
    for (Row& row : group(effort)) rows.push_back(std::move(row));
  }
  if (effort.rounds == 0) return rows;  // ratios compare times
  for (Row& row : bench::ratio_rows(rows)) rows.push_back(std::move(row));
  return rows;
}

bench::Effort effort_of(const Arguments& arguments) {
  if (arguments.has("--errors")) return bench::kErrorsOnly;
  return arguments.has("--quick") ? bench::kQuick : bench::kFull;
}

void write(Results& results, const std::vector<Row>& rows, const std::string& command_line) {
  const std::string machine = describe_machine();
  if (Output* json = results["--json"]) json->write(bench::to_json(rows));
  if (Output* csv = results["--csv"]) bench::write_csv(*csv, rows);
  if (Output* page = results["--report"]) page->write(report::to_html(bench::bench_page(rows, machine, command_line)));
  if (Output* plot = results["--plot"]) plot->write(report::to_svg_file(bench::bench_sheet(rows, machine)));
  results.finish("# " + machine + "\n" + bench::to_text(rows));
}

int run_bench(const Arguments& arguments) {
  if (arguments.has("--errors") && (arguments.has("--quick") || arguments.has("--report") || arguments.has("--plot"))) {
    throw UsageError("--errors measures no time: it goes with neither --quick, --report nor --plot");
  }
  arguments.require_with("--ticks", "--kernel");
  arguments.refuse_with("--kernel", {"--quick", "--errors", "--json", "--csv", "--report", "--plot"});
  if (arguments.has("--kernel")) {
    bench::run_kernel(arguments.text("--kernel"), arguments.whole_number("--ticks"));
    return kSuccess;
  }
  Results results(arguments, {"--json", "--csv", "--report", "--plot"});
  write(results, measure(effort_of(arguments)),
        arguments.has("--quick") ? "crankloop bench --quick" : "crankloop bench");
  return kSuccess;
}

constexpr Option kBenchOptions[] = {
    text("--json", "F",
         "file for an array of objects, one per contestant and setting; - is standard output, the rest then goes to "
         "stderr"),
    text("--csv", "F", "the same as a table"),
    text("--report", "F.html", "HTML file with the work-precision diagrams; opens in any browser"),
    text("--plot", "F.svg", "file for the diagrams alone, as a picture"),
    flag("--quick", "half a minute instead of some minutes; the figures scatter more"),
    flag("--errors", "errors only, no timing: the same figures on every machine"),
    text("--kernel", "NAME", "runs one contestant only, for an instruction counter; an unknown name lists them"),
    whole_number("--ticks", "N", from(0).up_to(1000000000), "how many ticks --kernel runs", "1000"),
};

}  // namespace

const Command kBench{
    "bench",
    "run time against error: kinematics, valves, whole ticks; the library against plain code",
    "[--json F] [--csv F] [--report F.html] [--plot F.svg] [--quick | --errors] | --kernel NAME [--ticks N]",
    "crankloop bench --quick --report bench.html",
    0,
    kBenchOptions,
    run_bench,
    true};

}  // namespace crankloop::program
