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
#include <memory>
#include <string>
#include <vector>

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
  const char* path = nullptr;
  std::string chip, record;
  std::vector<std::uint32_t> lines;
  double seconds = 1e6;
  double spin_us = 60;
  int priority = 70;
  int cpu = -1;

  [[nodiscard]] bool complete() const {
    return path != nullptr && record.empty() != chip.empty() && chip.empty() == lines.empty() && seconds > 0 &&
           spin_us >= 0 && lines.size() <= 64;
  }
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

std::vector<std::uint32_t> numbers_in(const char* text) {
  std::vector<std::uint32_t> numbers;
  for (char* end = nullptr; *text != '\0'; text = *end == ',' ? end + 1 : end) {
    numbers.push_back(static_cast<std::uint32_t>(std::strtoul(text, &end, 10)));
    if (end == text) return {};
  }
  return numbers;
}

Options options_of(int count, char** words) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const bool has_value = i + 1 < count;
    if (has_value && word == "--chip") {
      options.chip = words[++i];
    } else if (has_value && word == "--lines") {
      options.lines = numbers_in(words[++i]);
    } else if (has_value && word == "--record") {
      options.record = words[++i];
    } else if (has_value && word == "--seconds") {
      options.seconds = std::min(1e6, std::atof(words[++i]));
    } else if (has_value && word == "--spin-us") {
      options.spin_us = std::atof(words[++i]);
    } else if (has_value && word == "--priority") {
      options.priority = std::atoi(words[++i]);
    } else if (has_value && word == "--cpu") {
      options.cpu = std::atoi(words[++i]);
    } else {
      options.path = words[i];
    }
  }
  return options;
}

int run(const Options& options) {
  std::unique_ptr<EdgeOutput> output;
  if (options.chip.empty()) {
    output = std::make_unique<RecordedLines>(options.record);
  } else {
    output = std::make_unique<GpioLines>(options.chip, options.lines);
  }
  const SharedBlock block = wait_for(options.path, std::chrono::seconds(10));
  const auto played = std::make_unique<Played>();
  if (crankloop_live_edges_begin(block.data(), &played->reader) == 0)
    throw SharedBlockError(std::string(options.path) + ": the engine has no trigger wheel");
  const RealTime real_time({options.priority, options.cpu});
  if (real_time.priority_error() != 0)
    std::fprintf(stderr, "edge_player: not SCHED_FIFO %d: %s\n", options.priority,
                 std::strerror(real_time.priority_error()));
  const Pulse::Found found = play_all(block, options, *output, *played);
  print(*played);
  const std::string problem = Pulse::in_words(found);
  if (!problem.empty()) throw SharedBlockError(std::string(options.path) + ": " + problem);
  return EXIT_SUCCESS;
}

}  // namespace

int main(int count, char** words) {
  const Options options = options_of(count, words);
  if (!options.complete()) {
    std::fprintf(stderr,
                 "usage: edge_player PATH --chip /dev/gpiochipN --lines L,.. | --record F.csv\n"
                 "       [--seconds S] [--spin-us N] [--priority P] [--cpu N]\n");
    return EXIT_FAILURE;
  }
  try {
    return run(options);
  } catch (const std::runtime_error& error) {
    std::fprintf(stderr, "edge_player: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
