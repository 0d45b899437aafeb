// What an instruction costs: one, or the cycles of a Cortex-M4 with floating-point unit.
//
// What belongs here: the cycle model, which the bound and the measured cycles share. What does not: paths
// (longest_path.hpp).
//
// The model takes the worst of what the "Cortex-M4 Technical Reference Manual" (Arm DDI 0439, 3.3 and 7.2.3) states:
//
//   - nothing is pipelined: a load or store always takes its whole time; VDIV and VSQRT do so too;
//   - a branch that is taken refills the pipeline in 3 cycles, the most there are; an instruction whose condition fails
//     takes what it takes otherwise;
//   - a floating-point result that the next instruction uses costs a cycle more, an addend of VMLA too;
//   - data lie where their size asks.
//
// At wait states, code and constant data come from a flash that reads 32 bits at a time, without cache and prefetch:
// each word of code costs the wait states when its first instruction comes, each word of data when it is loaded; a
// branch that is taken waits for the fetch that is under way, the only one ahead, and once more for the word in which
// it arrives. RAM has no wait states. A load counts as one from flash unless its base is the stack pointer; counters
// that see addresses take those.
#pragma once

#include <cstdint>

#include "listing.hpp"

namespace worst_tick {

class Costs {
 public:
  virtual ~Costs() = default;
  /// Of an instruction that goes on to the next one; null where none is known. Refuses one that it does not know.
  [[nodiscard]] virtual std::int64_t going_on(const Instruction& instruction, const Instruction* next) const = 0;
  /// Besides, of one that goes elsewhere: a taken branch, a call, a return.
  [[nodiscard]] virtual std::int64_t leaving() const = 0;
};

class InstructionCosts : public Costs {
 public:
  [[nodiscard]] std::int64_t going_on(const Instruction&, const Instruction*) const override { return 1; }
  [[nodiscard]] std::int64_t leaving() const override { return 0; }
};

/// What an instruction takes of a Cortex-M4, unless it branches.
struct CortexM4Time {
  std::int64_t cycles;   ///< at zero wait states
  std::int64_t fetched;  ///< words of code that begin in it
  std::int64_t loaded;   ///< words that it may load from flash
};
[[nodiscard]] CortexM4Time cortex_m4_time(const Instruction& instruction, const Instruction* next);

constexpr std::int64_t kCortexM4Refill = 3;           ///< P of the manual: 1 to 3
constexpr std::int64_t kCortexM4RefillFetches = 2;    ///< under way, and that of the word in which a branch arrives
constexpr std::int64_t kCortexM4FlashWaitStates = 5;  ///< of the second column: usual at 168 to 180 MHz

class CortexM4Costs : public Costs {
 public:
  explicit CortexM4Costs(std::int64_t wait_states) : wait_states_{wait_states} {}
  [[nodiscard]] std::int64_t going_on(const Instruction& instruction, const Instruction* next) const override {
    const CortexM4Time time = cortex_m4_time(instruction, next);
    return time.cycles + wait_states_ * (time.fetched + time.loaded);
  }
  [[nodiscard]] std::int64_t leaving() const override {
    return kCortexM4Refill + wait_states_ * kCortexM4RefillFetches;
  }

 private:
  std::int64_t wait_states_;
};

}  // namespace worst_tick
