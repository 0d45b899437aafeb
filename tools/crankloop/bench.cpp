// `crankloop bench`: run time against error, all contestants in one process.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lab/bench/bench_report.hpp"
#include "lab/bench/groups.hpp"
#include "lab/bench/kernels.hpp"
#include "machine.hpp"
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

/// Opened before anything is measured: a place that cannot be written to is told at once, not after a minute.
class Files {
 public:
  explicit Files(const Arguments& arguments)
      : json_{opened(arguments, "--json")}, csv_{opened(arguments, "--csv")}, report_{opened(arguments, "--report")}, plot_{opened(arguments, "--plot")} {}

  void write(const std::vector<Row>& rows, const std::string& command_line) {
    const std::string machine = describe_machine();
    if (json_) json_->write(bench::to_json(rows));
    if (csv_) bench::write_csv(*csv_, rows);
    if (report_) report_->write(report::to_html(bench::bench_page(rows, machine, command_line)));
    if (plot_) plot_->write(report::to_svg_file(bench::bench_sheet(rows, machine)));
    for (std::optional<Output>* file : {&json_, &csv_, &report_, &plot_}) {
      if (*file) (*file)->finish();
    }
  }

 private:
  [[nodiscard]] static std::optional<Output> opened(const Arguments& arguments, const char* option) {
    if (!arguments.has(option)) return std::nullopt;
    return std::optional<Output>(std::in_place, arguments.text(option));
  }
  std::optional<Output> json_, csv_, report_, plot_;
};

int run_bench(const Arguments& arguments) {
  if (arguments.has("--errors") && (arguments.has("--quick") || arguments.has("--report") || arguments.has("--plot"))) {
    throw UsageError("--errors measures no time: it goes with neither --quick, --report nor --plot");
  }
  if (arguments.has("--kernel")) {
    bench::run_kernel(arguments.text("--kernel"), arguments.whole_number("--ticks"));
    return kSuccess;
  }
  Files files(arguments);
  const std::vector<Row> rows = measure(effort_of(arguments));
  files.write(rows, arguments.has("--quick") ? "crankloop bench --quick" : "crankloop bench");
  const std::string text = "# " + describe_machine() + "\n" + bench::to_text(rows);
  bool output_taken = false;
  for (const char* option : {"--json", "--csv", "--report", "--plot"}) output_taken = output_taken || arguments.text_or_empty(option) == "-";
  tell(text, output_taken);
  return kSuccess;
}

constexpr Option kOptions[] = {
    text("--json", "F", "file for an array of objects, one per contestant and setting; - is standard output, the rest then goes to stderr"),
    text("--csv", "F", "the same as a table"),
    text("--report", "F.html", "file for the work-precision diagrams, which any browser shows"),
    text("--plot", "F.svg", "file for the diagrams alone, as a picture"),
    flag("--quick", "half a minute instead of some minutes; the figures scatter more"),
    flag("--errors", "errors only, nothing is timed: the same figures everywhere"),
    text("--kernel", "NAME", "only runs one contestant, for an instruction counter; a wrong name lists them"),
    whole_number("--ticks", "N", from(0).up_to(1000000000), "how many ticks --kernel runs", "1000"),
};

}  // namespace

const Command kBench{"bench",
                     "run time against error: kinematics, valves, whole ticks; the library against plain code",
                     "[--json F] [--csv F] [--report F.html] [--plot F.svg] [--quick | --errors] | --kernel NAME [--ticks N]",
                     "crankloop bench --quick --report bench.html",
                     0,
                     kOptions,
                     run_bench};

}  // namespace crankloop::program
