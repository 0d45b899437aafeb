// `crankloop live FILE`: the engine against the machine's clock, its crank free, a controller in the loop; and how well the machine kept time.
#include <sys/utsname.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include "bench/machine.hpp"
#include "commands.hpp"
#include "csv.hpp"
#include "engine_file.hpp"
#include "error.hpp"
#include "live_loop.hpp"
#include "number.hpp"
#include "output.hpp"

namespace crankloop::program {
namespace {

using port::LatencyHistogram;

constexpr double kRadPerRpm_s = 3.14159265358979323846 / 30;

// ---- the machine ------------------------------------------------------------------------------------------------------------

std::string first_line(const char* path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// "Linux 6.1.0, PREEMPT_RT": what kind of kernel it is, from what it says of itself. The way a PREEMPT_DYNAMIC one was started stands in a file
/// that only root reads; the one in force is in brackets.
std::string kernel() {
  utsname names{};
  if (::uname(&names) != 0) return "unknown kernel";
  const std::string version = names.version;
  const std::size_t begin = version.find("PREEMPT");
  const std::string preemption = begin == std::string::npos ? "no PREEMPT" : version.substr(begin, version.find(' ', begin) - begin);
  const std::string mode = first_line("/sys/kernel/debug/sched/preempt");
  return std::string(names.sysname) + " " + names.release + ", " + preemption + (mode.empty() ? "" : " " + mode);
}

// ---- what is told -----------------------------------------------------------------------------------------------------------

std::string in_us(double time_ns) { return brief(time_ns / 1e3) + " us"; }

struct Quantile {
  const char* name;
  std::uint32_t parts;  ///< of 10 000
};
constexpr Quantile kQuantiles[] = {{"p50", 5000}, {"p99", 9900}, {"p99_9", 9990}, {"p99_99", 9999}, {"max", 10000}};

void write_quantiles(Output& out, const std::string& name, const LatencyHistogram& times) {
  for (const Quantile& quantile : kQuantiles) {
    write_summary(out, name + "_" + quantile.name, in_us(static_cast<double>(times.quantile_ns(quantile.parts))));
  }
}

void write_share(Output& out, const std::string& name, double time_ns, std::int64_t tick_ns) {
  write_summary(out, name, brief(100 * time_ns / static_cast<double>(tick_ns)) + " %");
}

/// A row per octave, its bar as long as the logarithm of its count: a single tick is still seen beside a million.
void write_picture(Output& out, const LatencyHistogram& times) {
  constexpr std::size_t kOctaves = 64;
  std::array<std::uint64_t, kOctaves> counts{};
  std::size_t first = kOctaves;
  std::size_t last = 0;
  for (std::size_t i = 0; i < LatencyHistogram::kBuckets; ++i) {
    const LatencyHistogram::Bucket bucket = times.bucket(i);
    if (bucket.count == 0) continue;
    const auto octave = bucket.first_ns == 0 ? std::size_t{0} : static_cast<std::size_t>(std::ilogb(static_cast<double>(bucket.first_ns)));
    counts[octave] += bucket.count;
    first = std::min(first, octave);
    last = octave;
  }
  for (std::size_t octave = first; octave <= last; ++octave) {
    const auto count = static_cast<double>(counts[octave]);
    const auto bar = counts[octave] == 0 ? std::size_t{0} : static_cast<std::size_t>(4 + 8 * std::log10(count));
    std::array<char, 80> row{};
    std::snprintf(row.data(), row.size(), "#  %10.3f us and more %10llu ", std::ldexp(1e-3, static_cast<int>(octave)),
                  static_cast<unsigned long long>(counts[octave]));
    out.write(row.data() + std::string(bar, '*') + "\n");
  }
}

std::string granted(const std::string& what, int error) { return error == 0 ? what : "not " + what + ": " + std::strerror(error); }

/// What the user asked for beside the run itself.
struct Telling {
  std::string real;
  std::string histogram_path;  ///< empty: none
  std::string shared_path;     ///< empty: none
};

void write_figures(Output& out, const EngineFile& file, const LiveRequest& request, const Telling& telling, const LiveFigures& f) {
  const auto count = [&](const char* name, std::uint64_t value) { write_summary(out, name, std::to_string(value)); };
  const port::RealTimeWish& wish = request.real_time;
  out.write("# " + file.name() + ", its crank free, in " + telling.real + (f.stopped ? ", stopped by a signal" : "") + "\n");
  write_summary(out, "machine", bench::describe_machine());
  write_summary(out, "kernel", kernel());
  write_summary(out, "scheduler", wish.priority == 0 ? "as started" : granted("SCHED_FIFO " + std::to_string(wish.priority), f.priority_error));
  write_summary(out, "memory", granted("locked", f.memory_error));
  write_summary(out, "processor", wish.cpu < 0 ? "any" : std::to_string(wish.cpu));

  out.write("# time: a tick is late if it began a whole tick or more after it was due, missed if it was not done when the next was due\n");
  write_summary(out, "tick", in_us(static_cast<double>(request.tick_ns)));
  count("ticks", f.tally.ticks);
  write_summary(out, "wall_time", f.wall_s, "s");
  count("late_ticks", f.tally.late);
  count("missed_deadlines", f.tally.missed);
  write_summary(out, "longest_backlog", brief(static_cast<double>(f.tally.longest_backlog_ns) / static_cast<double>(request.tick_ns)) + " ticks");
  write_quantiles(out, "wakeup_latency", f.begin);
  write_quantiles(out, "model_time", f.model);
  write_quantiles(out, "work_time", f.work);
  write_share(out, "model_share_mean", f.model.mean_ns(), request.tick_ns);
  write_share(out, "model_share_max", static_cast<double>(f.model.longest_ns()), request.tick_ns);
  write_summary(out, "page_faults", std::to_string(f.page_faults));
  write_summary(out, "preemptions", std::to_string(f.preemptions));
  out.write("# wake-up latency, ticks; a bar grows with the logarithm\n");
  write_picture(out, f.begin);

  out.write("# engine\n");
  write_summary(out, "final_speed", brief(f.speed_rad_s / kRadPerRpm_s) + " rpm");
  write_summary(out, "mean_speed", brief(f.mean_speed_rad_s / kRadPerRpm_s) + " rpm");
  write_summary(out, "mean_torque", brief(f.mean_torque_Nm) + " Nm  # of gas and masses, over the ticks");
  count("faulty_ticks", f.faulty_ticks);
  count("faults", f.faults);
  if (!telling.shared_path.empty()) {
    write_summary(out, "controller", f.controller_seen ? "seen" : "never seen");
    count("controller_silences", f.controller_silences);
    count("torn_inputs", f.torn_inputs);
  }
}

void write_histogram(Output& out, const LiveFigures& f) {
  CsvWriter csv(out, {"from_us", "below_us", "wakeup_ticks", "model_ticks", "work_ticks"});
  for (std::size_t i = 0; i < LatencyHistogram::kBuckets; ++i) {
    const LatencyHistogram::Bucket begin = f.begin.bucket(i);
    const LatencyHistogram::Bucket model = f.model.bucket(i);
    const LatencyHistogram::Bucket work = f.work.bucket(i);
    if (begin.count + model.count + work.count == 0) continue;
    csv.row(static_cast<double>(begin.first_ns) / 1e3, static_cast<double>(begin.last_ns + 1) / 1e3, std::to_string(begin.count),
            std::to_string(model.count), std::to_string(work.count));
  }
}

// ---- what was asked for -----------------------------------------------------------------------------------------------------

LiveRequest request_of(const Arguments& arguments, const EngineFile& file) {
  const double tick_us = arguments.number("--tick-us");
  LiveRequest request;
  request.tick_ns = std::llround(tick_us * 1e3);
  request.tick_s = millionths(tick_us);
  if (std::abs(tick_us * 1e3 - static_cast<double>(request.tick_ns)) > 1e-6) {
    throw UsageError("--tick-us " + shortest(tick_us) + " is no whole number of nanoseconds, which the clock counts");
  }
  request.ticks = static_cast<std::uint64_t>(std::max(1.0, std::round(arguments.number("--seconds") / request.tick_s)));
  request.start_rad_s = arguments.number("--from-rpm") * kRadPerRpm_s;
  request.patience_ns = std::llround(arguments.number("--silent-ms") * 1e6);
  request.at_start.load_ratio = arguments.number("--load-ratio");
  request.at_start.load_Nm = arguments.number("--load-Nm");
  request.at_start.starter = arguments.has("--starter") ? 1 : 0;
  request.real_time.priority = arguments.whole_number("--priority");
  if (arguments.has("--cpu")) request.real_time.cpu = arguments.whole_number("--cpu");

  const EngineDefinition& definition = file.definition();
  if (arguments.has("--load-ratio") && definition.pressure.source == PressureSource::none) {
    throw InputError(file.path() + ": there is no pressure source, so --load-ratio has nothing to scale");
  }
  if (arguments.has("--starter") && definition.starter.stall_Nm == 0) {
    throw InputError(file.path() + ": there is no [starter], so --starter has nothing to engage");
  }
  return request;
}

int run_live_command(const Arguments& arguments) {
  const EngineFile file = read_engine_file(arguments.file(), {"engine", "crank", "masses"});
  const LiveRequest request = request_of(arguments, file);
  const Telling telling{arguments.text("--real"), arguments.text_or_empty("--histogram"), arguments.text_or_empty("--shared")};
  std::optional<Output> histogram;
  if (!telling.histogram_path.empty()) histogram.emplace(telling.histogram_path);

  const auto figures = std::make_unique<LiveFigures>();
  try {
    std::optional<port::SharedBlock> shared;
    port::LiveBlock alone;
    if (!telling.shared_path.empty()) {
      shared.emplace(port::SharedBlock::create(telling.shared_path, request.tick_s, static_cast<std::uint32_t>(file.definition().layout.cylinders)));
    }
    port::LiveBlock& block = shared ? **shared : alone;
    if (telling.real == "float") {
      run_live<float>(file, request, block, *figures);
    } else {
      run_live<double>(file, request, block, *figures);
    }
  } catch (const port::SharedBlockError& refused) {
    throw InputError(refused.what());
  }

  if (histogram) {
    write_histogram(*histogram, *figures);
    histogram->finish();
  }
  Output out = Output::standard();
  write_figures(out, file, request, telling, *figures);
  out.finish();
  return kSuccess;
}

constexpr Option kOptions[] = {
    number("--tick-us", "T", from(1).up_to(2000), "length of a tick in us", "1000"),
    number("--seconds", "S", above(0).up_to(1000000), "how long; Ctrl-C ends it earlier, with its figures", "10"),
    text("--shared", "PATH", "block of memory shared with a controller, such as /dev/shm/engine: docs/live.md"),
    number("--silent-ms", "N", above(0).up_to(100000), "a controller that does not write for N ms is gone: no fuel, no load, no starter", "100"),
    number("--load-ratio", "Q", from(0).up_to(2), "0 = motored, 1 = the pressure diagram as it is; until a controller says", "0"),
    number("--load-Nm", "L", from(-1e8).up_to(1e8), "load on the crankshaft in Nm; until a controller says", "0"),
    flag("--starter", "starter engaged; until a controller says"),
    number("--from-rpm", "N", from(-100000).up_to(100000), "speed at the start in rpm", "0"),
    choice("--real", "float|double", "arithmetic of the tick", "float"),
    whole_number("--cpu", "N", from(0).up_to(1023), "the only processor to run on, counted from 0; without it any"),
    whole_number("--priority", "P", from(0).up_to(99), "SCHED_FIFO priority, where allowed; 0 leaves the scheduler as it is", "80"),
    text("--histogram", "F", "CSV file for the histograms of wake-up latency and of times"),
};

}  // namespace

const Command kLive{"live",
                    "the engine against the clock, with a controller in the loop: latencies, missed deadlines",
                    "FILE [--tick-us T] [--seconds S] [--shared PATH] [--from-rpm N] [--load-ratio Q] [--load-Nm L] [--starter] [...]",
                    "crankloop live diesel_495.ini --from-rpm 800 --load-ratio 0.2 --tick-us 100 --seconds 5",
                    1,
                    kOptions,
                    run_live_command};

}  // namespace crankloop::program
