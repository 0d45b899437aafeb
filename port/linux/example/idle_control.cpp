// A controller for `crankloop live`: starts the engine and holds its idle speed, by the load ratio alone; by the
// throttle, with gas exchange. An example to start from.
//
//   crankloop live diesel_495.ini --shared /dev/shm/engine --seconds 12 &
//   idle_control /dev/shm/engine --seconds 10
//
//   crankloop live four_2000.ini --shared /dev/shm/engine --seconds 12 &
//   idle_control /dev/shm/engine --seconds 10 --target-rpm 1200
//
//   --target-rpm N   idle speed, default 800          --seconds S   how long, default 10
//
// Prints how well the speed was held in the second half of its time. docs/live.md walks through it.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "command_line.hpp"
#include "idle_law.hpp"

namespace {

using namespace crankloop::port::example;
using crankloop::port::LiveOutputs;
using crankloop::port::SharedBlock;
using crankloop::port::SharedBlockError;

/// As `live` shows it.
class ShownSpeed {
 public:
  explicit ShownSpeed(const SharedBlock& block) : block_{block} {}
  [[nodiscard]] double rad_s(std::int64_t) {
    std::uint32_t sequence = 0;
    static_cast<void>(block_->outputs.read(out_, sequence));  // caught half written: the one before will do
    return out_.speed_rad_s;
  }

 private:
  const SharedBlock& block_;
  LiveOutputs out_;
};

}  // namespace

int main(int count, char** words) {
  try {
    const CommandLine line(count, words, {"--target-rpm", "--seconds"});
    const double target_rpm = line.number("--target-rpm", 800, 1, 1e5);
    const double seconds = line.number("--seconds", 10, 1e-3, 1e6);  // so many periods are an int
    const SharedBlock block = wait_for(line.path(), std::chrono::seconds(10));
    ShownSpeed speed(block);
    return hold_idle("idle_control", block, speed, target_rpm / kRpmPerRad_s, seconds);
  } catch (const BadCommandLine& bad) {
    std::fprintf(stderr, "idle_control: %s\nusage: idle_control PATH [--target-rpm N] [--seconds S]\n", bad.what());
    return EXIT_FAILURE;
  } catch (const SharedBlockError& error) {
    std::fprintf(stderr, "idle_control: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
