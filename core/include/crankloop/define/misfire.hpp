// Which cycles of a cylinder misfire: a test pattern for a controller's misfire detection.
//
// What belongs here: the rule of one cylinder. What does not: cylinders that an input cuts (Input::cut_cylinders).
#pragma once

#include <cstdint>

#include <crankloop/define/field.hpp>
#include <crankloop/limits.hpp>
#include <crankloop/status.hpp>

namespace crankloop {

enum class MisfirePattern : std::uint8_t {
  none,    ///< all cycles fire
  spread,  ///< `misfires` of every `of` cycles, evenly spread: every 16th is 1 of 16
  burst,   ///< the last `misfires` of every `of` cycles, in a row
  random,  ///< each cycle with the probability random_ratio, whatever the others did
  listed,  ///< the cycles of a list
};

/// Cycles are counted from 1: the first is the first that takes its fuel. A cycle takes it where the gas does
/// (Gas::latch_deg), under a pressure diagram 90 deg before its firing top dead centre.
struct Misfire {
  MisfirePattern pattern = MisfirePattern::none;
  int misfires = 1;
  int of = 1;
  double random_ratio = 0;
  int seed = 1;                         ///< of the random numbers; two cylinders with one seed draw different numbers
  int cycle_count = 0;                  ///< entries of the list
  int cycles[kMaxListedMisfires] = {};  ///< rising
  double burning_ratio = 0;             ///< share of its heat that a misfiring cycle releases; 0: none

  template <class Visit, class Self, class... Others>
  static constexpr void each_field(Visit&& visit, Self& self, Others&... others) {
    const bool counted = self.pattern == MisfirePattern::spread || self.pattern == MisfirePattern::burst;
    const bool random = self.pattern == MisfirePattern::random;
    const bool listed = self.pattern == MisfirePattern::listed;
    const bool any = counted || random || listed;
    CRANKLOOP_FIELD(1, misfire, pattern);
    CRANKLOOP_NUMBER(counted ? 1 : 0, misfire, misfires, from(0).up_to(kMaxMisfirePeriod));
    CRANKLOOP_NUMBER(counted ? 1 : 0, misfire, of, from(1).up_to(kMaxMisfirePeriod));
    CRANKLOOP_NUMBER(random ? 1 : 0, misfire, random_ratio, from(0).up_to(1));
    CRANKLOOP_NUMBER(random ? 1 : 0, misfire, seed, from(0).up_to(2147483647));
    CRANKLOOP_NUMBER(listed ? 1 : 0, misfire, cycle_count, from(1).up_to(kMaxListedMisfires));
    CRANKLOOP_FIELD(listed ? self.cycle_count : 0, misfire, cycles);
    CRANKLOOP_NUMBER(any ? 1 : 0, misfire, burning_ratio, from(0).below(1));
  }
};

/// Field names "misfire.*", as in the engine file without unit; `index` is the entry of the list.
Status validate(const Misfire& misfire) noexcept;

}  // namespace crankloop
