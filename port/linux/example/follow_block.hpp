// What every example needs of a running `live`: its block, and whether it is still there.
//
// What belongs here: waiting for it, and noticing its end. What does not: what an example does with it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

#include "port/linux/shared_block.hpp"
#include "port/linux/stopwatch.hpp"

namespace crankloop::port::example {

using Clock = std::chrono::steady_clock;

/// Waits for `live` to run. Throws where it does not within the patience.
inline SharedBlock wait_for(const std::string& path, std::chrono::seconds patience) {
  for (const auto deadline = Clock::now() + patience;;) {
    const bool last_try = Clock::now() > deadline;
    try {
      SharedBlock block = SharedBlock::open(path);
      if (block->state == LiveState::running) return block;
      if (last_try) throw SharedBlockError(path + ": does not run");
    } catch (const SharedBlockError&) {
      if (last_try) throw;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/// Whether `live` still writes its block.
class Pulse {
 public:
  enum class Found { runs, has_ended, has_died, block_is_lost };

  explicit Pulse(const SharedBlock& block) : block_{block}, seen_ns_{now_ns()} {}

  /// To be asked now and then. `has_died`: no tick for a second, of at most 2 ms each.
  [[nodiscard]] Found feel() {
    constexpr std::int64_t kPatience_ns = 1'000'000'000;
    LiveOutputs out;
    std::uint32_t sequence = 0;
    const bool read = block_->outputs.read(out, sequence);
    if (!block_.is_whole()) return Found::block_is_lost;
    if (block_->state == LiveState::ended) return Found::has_ended;
    if (read && out.ticks != ticks_) {
      ticks_ = out.ticks;
      seen_ns_ = now_ns();
    }
    return now_ns() - seen_ns_ > kPatience_ns ? Found::has_died : Found::runs;
  }

  /// One line for the user; "" where all is well.
  [[nodiscard]] static std::string in_words(Found found) {
    if (found == Found::has_died) return "live has written nothing for 1 s: it has died or hangs";
    return found == Found::block_is_lost ? "the block was truncated or overwritten" : "";
  }

 private:
  const SharedBlock& block_;
  std::uint64_t ticks_ = 0;
  std::int64_t seen_ns_;
};

}  // namespace crankloop::port::example
