// Plays the trigger edges of `crankloop live` to real lines, each when it is due: a wheel simulator that turns as the
// engine does.
//
//   crankloop live diesel_495.ini --from-rpm 800 --load-ratio 0.2 --shared /dev/shm/engine --seconds 60 &
//   edge_player /dev/shm/engine --chip /dev/gpiochip0 --lines 17,27     crank on line 17, cam on line 27
//   edge_player /dev/shm/engine --record edges.csv                      into a file, to see how late they come
//
//   --seconds S     how long, default until live ends      --spin-us N    the last microseconds before an edge are
//   --priority P    of SCHED_FIFO, default 70; 0: none                    waited for awake, default 60
//   --cpu N         the only processor to run on
//
// Prints how many edges it played and lost, and how late they were: the time from when an edge was due to when its line
// was set. An edge that is overdue is played at once. Where the margin is too small, give live more --lead-ticks.
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "edge_output.hpp"
#include "follow_block.hpp"
#include "port/linux/latency.hpp"
#include "port/linux/real_time.hpp"
#include "port/linux/stop_signal.hpp"

namespace {

using namespace crankloop::port::example;
using crankloop::port::LatencyHistogram;
using crankloop::port::now_ns;
using crankloop::port::RealTime;
using crankloop::port::SharedBlock;
using crankloop::port::SharedBlockError;
using crankloop::port::StopSignal;

struct Options {
  std::string path, chip, record;
  std::vector<std::uint32_t> lines;
  double seconds = 1e6;
  double spin_us = 60;
  int priority = 70;
  int cpu = -1;
};

void sleep_until(std::int64_t time_ns) noexcept {
  timespec time{};
  time.tv_sec = static_cast<time_t>(time_ns / 1'000'000'000);
  time.tv_nsec = static_cast<long>(time_ns % 1'000'000'000);
  static_cast<void>(::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr));  // a signal ends it early
}

/// What became of the edges.
struct Played {
  LatencyHistogram lateness;  ///< some 18 kB
  std::uint64_t overdue = 0;  ///< due before they could be waited for
  std::uint64_t refused = 0;  ///< by the device
  crankloop_live_edge_reader reader{};
};

/// Sleeps until shortly before the edge is due, then looks at the clock.
void play(const crankloop_live_edge& edge, std::int64_t spin_ns, EdgeOutput& output, Played& played) {
  const auto due_ns = static_cast<std::int64_t>(edge.due_ns);
  std::int64_t now = now_ns();
  if (now > due_ns) ++played.overdue;
  if (now < due_ns - spin_ns) sleep_until(due_ns - spin_ns);
  while ((now = now_ns()) < due_ns) {
  }
  if (!output.set(edge.wheel, edge.level != 0)) ++played.refused;
  const std::int64_t set_ns = now_ns();
  played.lateness.add(set_ns - due_ns);
  output.note(edge.wheel, edge.level != 0, edge.due_ns, set_ns);
}

/// Until live ends, a signal comes or the time is over. What ended it.
Pulse::Found play_all(const SharedBlock& block, const Options& options, EdgeOutput& output, Played& played) {
  const StopSignal stop;
  Pulse pulse(block);
  const auto spin_ns = static_cast<std::int64_t>(options.spin_us * 1e3);
  const std::int64_t end_ns = now_ns() + static_cast<std::int64_t>(options.seconds * 1e9);
  const auto pause_ns = std::max(std::int64_t{50'000}, static_cast<std::int64_t>(block->tick_s * 0.25e9));
  Pulse::Found found = Pulse::Found::runs;
  while (!stop.received() && now_ns() < end_ns) {
    crankloop_live_edge edges[64];
    const std::size_t count = crankloop_live_edges_read(&played.reader, edges, 64);
    for (std::size_t i = 0; i < count && !stop.received(); ++i) play(edges[i], spin_ns, output, played);
    if (count > 0) continue;
    if (found != Pulse::Found::runs) return found;  // and no edge is left
    found = pulse.feel();
    if (found == Pulse::Found::runs) sleep_until(now_ns() + pause_ns);
  }
  return Pulse::Found::runs;
}

void print(const Played& played) {
  const LatencyHistogram& late = played.lateness;
  std::printf("edges_played = %llu\n", static_cast<unsigned long long>(late.count()));
  std::printf("edges_lost = %llu  # overwritten before they were read\n",
              static_cast<unsigned long long>(played.reader.lost));
  std::printf("edges_overdue = %llu  # due before they were read, or while another was played\n",
              static_cast<unsigned long long>(played.overdue));
  if (played.refused > 0)
    std::printf("edges_refused = %llu  # by the device\n", static_cast<unsigned long long>(played.refused));
  const struct {
    const char* name;
    std::uint32_t parts;
  } quantiles[] = {{"p50", 5000}, {"p99", 9900}, {"p99_9", 9990}, {"p99_99", 9999}, {"max", 10000}};
  for (const auto& quantile : quantiles)
    std::printf("lateness_%s = %.3f us\n", quantile.name, static_cast<double>(late.quantile_ns(quantile.parts)) / 1e3);
}

Options options_of(const CommandLine& line) {
  Options options;
  options.path = line.path();
  options.chip = line.text("--chip");
  options.record = line.text("--record");
  options.lines = line.whole_numbers("--lines", ',', std::numeric_limits<std::uint32_t>::max());
  options.seconds = line.number("--seconds", options.seconds, 1e-3, 1e6);
  options.spin_us = line.number("--spin-us", options.spin_us, 0, 1e6);
  options.priority = line.whole_number("--priority", options.priority, 99);
  options.cpu = line.whole_number("--cpu", options.cpu, 1023);
  if (options.record.empty() == options.chip.empty()) throw BadCommandLine("--chip or --record: one of them");
  if (options.chip.empty() != options.lines.empty()) throw BadCommandLine("--chip and --lines belong together");
  if (options.lines.size() > GPIO_V2_LINES_MAX) throw BadCommandLine("--lines: there are more than a request may have");
  return options;
}

void say_if_refused(const std::string& what, int error) {
  if (error != 0) std::fprintf(stderr, "edge_player: %s: %s\n", what.c_str(), std::strerror(error));
}

int run(const Options& options) {
  std::unique_ptr<EdgeOutput> output;
  if (!options.chip.empty()) output = std::make_unique<GpioLines>(options.chip, options.lines);
  const SharedBlock block = wait_for(options.path, std::chrono::seconds(10));
  const auto played = std::make_unique<Played>();
  if (crankloop_live_edges_begin(block.data(), &played->reader) == 0)
    throw SharedBlockError(options.path + ": the engine has no trigger wheel");
  if (!output) output = std::make_unique<RecordedLines>(options.record);  // empties a file, so there has to be a block
  const RealTime real_time({options.priority, options.cpu});
  say_if_refused("not SCHED_FIFO " + std::to_string(options.priority), real_time.priority_error());
  say_if_refused("not on processor " + std::to_string(options.cpu), real_time.cpu_error());
  const Pulse::Found found = play_all(block, options, *output, *played);
  print(*played);
  output->finish();
  const std::string problem = Pulse::in_words(found);
  if (!problem.empty()) throw SharedBlockError(options.path + ": " + problem);
  return EXIT_SUCCESS;
}

}  // namespace

int main(int count, char** words) {
  try {
    return run(
        options_of({count, words, {"--chip", "--lines", "--record", "--seconds", "--spin-us", "--priority", "--cpu"}}));
  } catch (const BadCommandLine& bad) {
    std::fprintf(stderr,
                 "edge_player: %s\n"
                 "usage: edge_player PATH --chip /dev/gpiochipN --lines L,.. | --record F.csv\n"
                 "       [--seconds S] [--spin-us N] [--priority P] [--cpu N]\n",
                 bad.what());
    return EXIT_FAILURE;
  } catch (const std::runtime_error& error) {
    std::fprintf(stderr, "edge_player: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
