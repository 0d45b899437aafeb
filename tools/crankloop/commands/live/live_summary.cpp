#include "live_summary.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "../../command_line/machine.hpp"
#include "../../command_line/summary.hpp"
#include "../../files/csv.hpp"
#include "../../files/number.hpp"
#include "../../files/units.hpp"
#include "../../loops/run_gas.hpp"

namespace crankloop::program {
namespace {

using port::LatencyHistogram;

// ---- the machine ----------------------------------------------------------------------------------------------------

std::string first_line(const char* path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// "Linux 6.1.0, PREEMPT_RT": release and preemption model of the kernel. For PREEMPT_DYNAMIC the mode is in a file
/// that only root can read; the active mode is in brackets.
std::string kernel() {
  utsname names{};
  if (::uname(&names) != 0) return "unknown kernel";
  const std::string version = names.version;
  const std::size_t begin = version.find("PREEMPT");
  const std::string preemption =
      begin == std::string::npos ? "no PREEMPT" : version.substr(begin, version.find(' ', begin) - begin);
  const std::string mode = first_line("/sys/kernel/debug/sched/preempt");
  return std::string(names.sysname) + " " + names.release + ", " + preemption + (mode.empty() ? "" : " " + mode);
}

// ---- the summary ----------------------------------------------------------------------------------------------------

struct Quantile {
  const char* name;
  std::uint32_t parts;  ///< of 10 000
};
constexpr Quantile kQuantiles[] = {{"p50", 5000}, {"p99", 9900}, {"p99_9", 9990}, {"p99_99", 9999}, {"max", 10000}};

void add_quantiles(Summary& s, const std::string& name, const LatencyHistogram& times) {
  for (const Quantile& quantile : kQuantiles) {
    s.line(name + "_" + quantile.name, static_cast<double>(times.quantile_ns(quantile.parts)) / 1e3, "us");
  }
}

/// A row per octave, its bar as long as the logarithm of its count: a single tick is still visible beside a million.
void add_picture(Summary& s, const LatencyHistogram& times) {
  constexpr std::size_t kOctaves = 64;
  std::array<std::uint64_t, kOctaves> counts{};
  std::size_t first = kOctaves;
  std::size_t last = 0;
  for (std::size_t i = 0; i < LatencyHistogram::kBuckets; ++i) {
    const LatencyHistogram::Bucket bucket = times.bucket(i);
    if (bucket.count == 0) continue;
    const auto octave = bucket.first_ns == 0
                            ? std::size_t{0}
                            : static_cast<std::size_t>(std::ilogb(static_cast<double>(bucket.first_ns)));
    counts[octave] += bucket.count;
    first = std::min(first, octave);
    last = octave;
  }
  for (std::size_t octave = first; octave <= last; ++octave) {
    const auto count = static_cast<double>(counts[octave]);
    const auto bar = counts[octave] == 0 ? std::size_t{0} : static_cast<std::size_t>(4 + 8 * std::log10(count));
    std::array<char, 80> row{};
    std::snprintf(row.data(), row.size(), "#  %10.3f us and more %10llu", std::ldexp(1e-3, static_cast<int>(octave)),
                  static_cast<unsigned long long>(counts[octave]));
    s.text(row.data() + (bar == 0 ? "" : " " + std::string(bar, '*')) + "\n");
  }
}

std::string granted(const std::string& what, int error) {
  return error == 0 ? what : "not " + what + ": " + std::strerror(error);
}

void add_machine(Summary& s, const port::RealTimeWish& wish, const LiveFigures& f) {
  const std::string scheduler = "SCHED_FIFO " + std::to_string(wish.priority);
  s.line("machine", describe_machine());
  s.line("kernel", kernel());
  s.line("scheduler", wish.priority == 0 ? "as started" : granted(scheduler, f.priority_error));
  s.line("memory", granted("locked", f.memory_error));
  s.line("processor", wish.cpu < 0 ? "any" : std::to_string(wish.cpu));
}

void add_times(Summary& s, std::int64_t tick_ns, const LiveFigures& f) {
  const auto tick = static_cast<double>(tick_ns);
  s.line("tick", tick / 1e3, "us");
  s.line("ticks", f.tally.ticks);
  s.line("wall_time", f.wall_s, "s");
  s.line("late_ticks", f.tally.late);
  s.line("missed_deadlines", f.tally.missed);
  s.line("longest_backlog", static_cast<double>(f.tally.longest_backlog_ns) / tick, "ticks");
  add_quantiles(s, "wakeup_latency", f.begin);
  add_quantiles(s, "model_time", f.model);
  add_quantiles(s, "work_time", f.work);
  s.line("model_share_mean", 100 * f.model.mean_ns() / tick, "%");
  s.line("model_share_max", 100 * static_cast<double>(f.model.longest_ns()) / tick, "%");
  s.line("page_faults", f.page_faults);
  s.line("preemptions", f.preemptions);
}

void add_engine(Summary& s, const EngineDefinition& engine, double tick_s, const LiveFigures& f) {
  s.line("final_speed", f.speed_rad_s * kRpmPerRad_s, "rpm");
  const double mean_rpm = std::fabs(f.mean_speed_rad_s) * kRpmPerRad_s;
  s.line("mean_speed", f.mean_speed_rad_s * kRpmPerRad_s, "rpm", beyond_steps_of_gas(engine, mean_rpm, tick_s));
  s.line("mean_torque", f.mean_torque_Nm, "Nm", "of gas and masses, over the ticks");
  if (f.intake_Pa > 0) {
    s.line("intake_pressure", f.intake_Pa / 1e3, "kPa", "in the manifold, at the end");
    s.line("trapped_air", f.trapped_air_kg * 1e6, "mg", "of the cylinders' last whole cycles, mean");
  }
  s.line("faulty_ticks", f.faulty_ticks);
  s.line("faults", f.faults);
  if (f.wheel_faults != 0) s.line("wheel_faults", f.wheel_faults, "", "bit i-1: the file's i-th [fault NAME] was on");
}

void add_edges(Summary& s, const LiveFigures& f) {
  s.line("edges", f.edges);
  s.line("edges_lost", f.unlisted_edges, "",
         f.unlisted_edges > 0 ? "more edges in a tick than it can record: use a shorter --tick-us" : "");
}

}  // namespace

std::string live_summary(const EngineFile& file, const LiveRequest& request, const std::string& real,
                         const LiveExtras& extras, const LiveFigures& f) {
  Summary s;
  s.remark(file.name() + ", its crank free, in " + real +
           (f.stopped      ? ", stopped by a signal"
            : f.lost_block ? ", until its block was lost"
                           : ""));
  add_machine(s, request.real_time, f);
  s.remark(
      "a tick is late if it began a whole tick or more after it was due, missed if it was not done when the next was "
      "due");
  add_times(s, request.tick_ns, f);
  s.remark("histogram of the wake-up latency, in ticks; bars are logarithmic");
  add_picture(s, f.begin);
  s.remark("the engine");
  add_engine(s, file.definition(), request.tick_s, f);
  if (!file.triggers().empty()) add_edges(s, f);
  if (extras.schedule != nullptr) {
    s.line("inputs_from_file", extras.schedule->columns());
    if (f.controller_seen) s.remark("the controller wrote inputs; from then on those of the file were not used");
  }
  if (extras.trace != nullptr) {
    s.line("trace_dropped", extras.trace->dropped(), "",
           extras.trace->dropped() > 0 ? "changes that found the queue of --trace full: they are not in the file" : "");
  }
  if (!extras.shared) return s.text();
  s.line("controller", !f.controller_seen ? "never seen" : f.inputs_by_name ? "seen, inputs by name" : "seen");
  if (f.fixed_is_ignored) s.remark("the inputs of the fixed part were written too: not used, the section has them all");
  s.line("controller_silences", f.controller_silences);
  s.line("torn_inputs", f.torn_inputs);
  return s.text();
}

void write_live_histogram(Output& out, const LiveFigures& f) {
  CsvWriter csv(out, {"from_us", "below_us", "wakeup_ticks", "model_ticks", "work_ticks"});
  for (std::size_t i = 0; i < LatencyHistogram::kBuckets; ++i) {
    const LatencyHistogram::Bucket begin = f.begin.bucket(i);
    const LatencyHistogram::Bucket model = f.model.bucket(i);
    const LatencyHistogram::Bucket work = f.work.bucket(i);
    if (begin.count + model.count + work.count == 0) continue;
    csv.row(static_cast<double>(begin.first_ns) / 1e3, static_cast<double>(begin.last_ns + 1) / 1e3,
            std::to_string(begin.count), std::to_string(model.count), std::to_string(work.count));
  }
}

}  // namespace crankloop::program
