#include "live_summary.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "../machine.hpp"
#include "../csv.hpp"
#include "../number.hpp"

namespace crankloop::program {
namespace {

using port::LatencyHistogram;

constexpr double kRpmPerRad_s = 30 / 3.14159265358979323846;

// ---- the machine ------------------------------------------------------------------------------------------------------------

std::string first_line(const char* path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// "Linux 6.1.0, PREEMPT_RT": what kind of kernel it is, by its own words. How a PREEMPT_DYNAMIC one was started stands in a file that only root
/// reads; the mode in force is in brackets.
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
    std::snprintf(row.data(), row.size(), "#  %10.3f us and more %10llu", std::ldexp(1e-3, static_cast<int>(octave)),
                  static_cast<unsigned long long>(counts[octave]));
    out.write(row.data() + (bar == 0 ? "" : " " + std::string(bar, '*')) + "\n");
  }
}

std::string granted(const std::string& what, int error) {
  return error == 0 ? what : "not " + what + ": " + std::strerror(error);
}

void write_count(Output& out, const char* name, std::int64_t value) { write_summary(out, name, std::to_string(value)); }
void write_count(Output& out, const char* name, std::uint64_t value) { write_summary(out, name, std::to_string(value)); }

void write_machine(Output& out, const port::RealTimeWish& wish, const LiveFigures& f) {
  const std::string scheduler = "SCHED_FIFO " + std::to_string(wish.priority);
  write_summary(out, "machine", describe_machine());
  write_summary(out, "kernel", kernel());
  write_summary(out, "scheduler", wish.priority == 0 ? "as started" : granted(scheduler, f.priority_error));
  write_summary(out, "memory", granted("locked", f.memory_error));
  write_summary(out, "processor", wish.cpu < 0 ? "any" : std::to_string(wish.cpu));
}

void write_times(Output& out, std::int64_t tick_ns, const LiveFigures& f) {
  const auto tick = static_cast<double>(tick_ns);
  write_summary(out, "tick", in_us(tick));
  write_count(out, "ticks", f.tally.ticks);
  write_summary(out, "wall_time", f.wall_s, "s");
  write_count(out, "late_ticks", f.tally.late);
  write_count(out, "missed_deadlines", f.tally.missed);
  write_summary(out, "longest_backlog", brief(static_cast<double>(f.tally.longest_backlog_ns) / tick) + " ticks");
  write_quantiles(out, "wakeup_latency", f.begin);
  write_quantiles(out, "model_time", f.model);
  write_quantiles(out, "work_time", f.work);
  write_summary(out, "model_share_mean", brief(100 * f.model.mean_ns() / tick) + " %");
  write_summary(out, "model_share_max", brief(100 * static_cast<double>(f.model.longest_ns()) / tick) + " %");
  write_count(out, "page_faults", f.page_faults);
  write_count(out, "preemptions", f.preemptions);
}

void write_engine(Output& out, const LiveFigures& f) {
  write_summary(out, "final_speed", brief(f.speed_rad_s * kRpmPerRad_s) + " rpm");
  write_summary(out, "mean_speed", brief(f.mean_speed_rad_s * kRpmPerRad_s) + " rpm");
  write_summary(out, "mean_torque", brief(f.mean_torque_Nm) + " Nm  # of gas and masses, over the ticks");
  write_count(out, "faulty_ticks", f.faulty_ticks);
  write_count(out, "faults", std::uint64_t{f.faults});
}

}  // namespace

void write_live_summary(Output& out, const EngineFile& file, const LiveRequest& request, const std::string& real, bool shared,
                        const LiveFigures& f) {
  out.write("# " + file.name() + ", its crank free, in " + real + (f.stopped ? ", stopped by a signal" : f.lost_block ? ", until its block was lost" : "") + "\n");
  write_machine(out, request.real_time, f);
  out.write("# a tick is late if it began a whole tick or more after it was due, missed if it was not done when the next was due\n");
  write_times(out, request.tick_ns, f);
  out.write("# wake-up latency, ticks; a bar grows with the logarithm\n");
  write_picture(out, f.begin);
  out.write("# the engine\n");
  write_engine(out, f);
  if (!shared) return;
  write_summary(out, "controller", f.controller_seen ? "seen" : "never seen");
  write_count(out, "controller_silences", std::uint64_t{f.controller_silences});
  write_count(out, "torn_inputs", std::uint64_t{f.torn_inputs});
}

void write_live_histogram(Output& out, const LiveFigures& f) {
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

}  // namespace crankloop::program
