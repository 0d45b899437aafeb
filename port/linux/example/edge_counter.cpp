// A controller for `crankloop live` that knows the engine by its crank wheel alone: counts the ring's edges, measures
// the speed from tooth to tooth and holds the idle speed by it.
//
//   crankloop live diesel_495.ini --shared /dev/shm/engine --seconds 12 &
//   edge_counter /dev/shm/engine --seconds 10
//
//   --target-rpm N   idle speed, default 800          --wheel W      of the crank, counted from 0, default 0
//   --seconds S      how long, default 10             --pattern N-M  its teeth: N places, M missing, default 60-2
//
// Prints how well the speed was held in the second half of its time, how many edges it read and how many it lost.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "idle_law.hpp"

namespace {

using namespace crankloop::port::example;
using crankloop::port::SharedBlock;
using crankloop::port::SharedBlockError;

struct ToothedWheel {
  std::uint32_t index = 0;
  int places = 60;
  int missing = 2;
};

/// From one rising edge to the next a tooth's pitch has passed, or over the gap one more than are missing. The edges'
/// own times count, not when they are read.
class EdgeSpeed {
 public:
  EdgeSpeed(const SharedBlock& block, const ToothedWheel& wheel) : wheel_{wheel} {
    has_ring_ = crankloop_live_edges_begin(block.data(), &reader_) != 0;
  }
  [[nodiscard]] bool has_ring() const noexcept { return has_ring_; }

  /// Mean over the teeth that passed since it was last asked; without one it falls, and is 0 after a third of a second.
  [[nodiscard]] double rad_s(std::int64_t now_ns) {
    const std::int64_t begin_ns = last_ns_;
    int pitches = 0;
    crankloop_live_edge edges[256];
    std::uint64_t lost = reader_.lost;
    for (std::size_t count = 256; count == 256;) {
      count = crankloop_live_edges_read(&reader_, edges, 256);
      if (reader_.lost != lost) {  // teeth are missing that the wheel has: measure anew
        lost = reader_.lost;
        last_ns_ = 0;
      }
      for (std::size_t i = 0; i < count; ++i) {
        if (edges[i].wheel == wheel_.index && edges[i].level == 1)
          pitches += tooth(static_cast<std::int64_t>(edges[i].due_ns));
      }
    }
    const double pitch_rad = 2 * 3.14159265358979323846 / wheel_.places;
    if (pitches > 0 && begin_ns > 0 && last_ns_ > begin_ns) {
      speed_rad_s_ = pitches * pitch_rad * 1e9 / static_cast<double>(last_ns_ - begin_ns);
    } else if (now_ns - last_ns_ > 333'000'000) {
      speed_rad_s_ = 0;
    } else if (now_ns > last_ns_) {
      speed_rad_s_ =
          std::min(speed_rad_s_, (wheel_.missing + 1) * pitch_rad * 1e9 / static_cast<double>(now_ns - last_ns_));
    }
    return speed_rad_s_;
  }

  [[nodiscard]] std::uint64_t read() const noexcept { return reader_.read; }
  [[nodiscard]] std::uint64_t lost() const noexcept { return reader_.lost; }

 private:
  /// Pitches since the tooth before.
  int tooth(std::int64_t time_ns) {
    const std::int64_t period_ns = time_ns - last_ns_;
    const bool measured = last_ns_ > 0 && pitch_ns_ > 0;
    last_ns_ = time_ns;
    // The gap looks like one tooth that takes missing + 1 times as long; no engine slows down so from tooth to tooth.
    const int pitches = measured && 2 * period_ns > (wheel_.missing + 2) * pitch_ns_ ? wheel_.missing + 1 : 1;
    pitch_ns_ = period_ns / pitches;
    return pitches;
  }

  ToothedWheel wheel_;
  crankloop_live_edge_reader reader_{};
  bool has_ring_ = false;
  std::int64_t last_ns_ = 0;   ///< of the tooth read last; 0: none
  std::int64_t pitch_ns_ = 0;  ///< between the two read last
  double speed_rad_s_ = 0;
};

ToothedWheel wheel_of(const CommandLine& line) {
  ToothedWheel wheel;
  wheel.index = static_cast<std::uint32_t>(line.whole_number("--wheel", 0, 1000));
  if (!line.has("--pattern")) return wheel;
  const std::vector<std::uint32_t> pattern = line.whole_numbers("--pattern", '-', 1000);
  if (pattern.size() != 2 || pattern[1] >= pattern[0])
    throw BadCommandLine("--pattern: '" + line.text("--pattern") + "' is no N-M, like 60-2");
  wheel.places = static_cast<int>(pattern[0]);
  wheel.missing = static_cast<int>(pattern[1]);
  return wheel;
}

}  // namespace

int main(int count, char** words) {
  try {
    const CommandLine line(count, words, {"--target-rpm", "--seconds", "--wheel", "--pattern"});
    const double target_rpm = line.number("--target-rpm", 800, 1, 1e5);
    const double seconds = line.number("--seconds", 10, 1e-3, 1e6);  // so many periods are an int
    const ToothedWheel wheel = wheel_of(line);
    const SharedBlock block = wait_for(line.path(), std::chrono::seconds(10));
    EdgeSpeed speed(block, wheel);
    if (!speed.has_ring()) throw SharedBlockError(line.path() + ": the engine has no trigger wheel");
    const int status = hold_idle("edge_counter", block, speed, target_rpm / kRpmPerRad_s, seconds);
    std::printf("edges_read = %llu\n", static_cast<unsigned long long>(speed.read()));
    std::printf("edges_lost = %llu\n", static_cast<unsigned long long>(speed.lost()));
    return status;
  } catch (const BadCommandLine& bad) {
    std::fprintf(stderr,
                 "edge_counter: %s\n"
                 "usage: edge_counter PATH [--target-rpm N] [--seconds S] [--wheel W] [--pattern N-M]\n",
                 bad.what());
    return EXIT_FAILURE;
  } catch (const SharedBlockError& error) {
    std::fprintf(stderr, "edge_counter: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
