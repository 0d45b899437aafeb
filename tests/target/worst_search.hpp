// A seeded search for the dearest tick: from runs with hostile and with steady input, a climb over the inputs of a few
// ticks from the state before them.
//
// What belongs here: what the search changes, and what it keeps. What does not: counting a step (counted_step.hpp), the
// hostile numbers (hostile.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "counted_step.hpp"
#include "hostile.hpp"

namespace {

constexpr std::uint32_t kSearchedTicks = 8;  ///< whose inputs are climbed over
#ifdef COSTS_SHORT_SEARCH                    // a tenth of the ticks, of scenes that stand beside another
constexpr std::uint32_t kSearchRounds = 4;
constexpr std::uint32_t kLastClimbs = 300;
#else
constexpr std::uint32_t kSearchRounds = 24;  ///< climbs, every second one from steady running
constexpr std::uint32_t kLastClimbs = 4000;  ///< and the last climb, from the dearest of all rounds
#endif
constexpr std::uint32_t kRunMoments = 50;  ///< of a round, before its climb from the dearest of them
constexpr std::uint32_t kClimbs = 200;     ///< changes that a round tries

/// The inputs of a few ticks, and where the engine was before them. A measured crank angle is told from the last one.
struct Moment {
  under_test::State state;
  under_test::Output output;
  Input before;  ///< the last input
  Input in[kSearchedTicks];
  std::uint32_t cost;  ///< of the dearest of the ticks
};

class WorstSearch {
 public:
  explicit WorstSearch(std::uint64_t seed) noexcept : random_{seed} {}

  const Moment& dearest() noexcept {
    for (std::uint32_t round = 0; round < kSearchRounds; ++round) {
      run(round % 2 != 0);
      climb(found_, kClimbs);
      if (found_.cost >= dearest_.cost) dearest_ = found_;
    }
    climb(dearest_, kLastClimbs);
    return dearest_;
  }

  /// Takes the ticks of a moment; the cost of the dearest of them.
  std::uint32_t replay(const Moment& moment) noexcept {
    (void)engine.restore(moment.state, moment.output);
    input = moment.before;
    std::uint32_t worst = 0;
    for (const Input& in : moment.in) {
      const Input last = input;
      input = in;
      turn_from(input, last);
      const std::uint32_t cost = cost_of_step() - counting_;
      if (cost > worst) worst = cost;
    }
    return worst;
  }

 private:
  /// Runs on, and finds the dearest moment on the way: with input that is drawn once, or in every tick.
  void run(bool steady) noexcept {
    Input drawn{};
    change(drawn, true);
    found_.cost = 0;
    for (std::uint32_t i = 0; i < kRunMoments; ++i) {
      tried_.state = engine.state();
      tried_.output = engine.output();
      tried_.before = input;
      for (Input& in : tried_.in) {
        if (!steady) change(drawn, true);
        in = drawn;
      }
      tried_.cost = replay(tried_);
      if (tried_.cost > found_.cost) found_ = tried_;
    }
  }

  /// Changes inputs as long as no tick gets cheaper.
  void climb(Moment& best, std::uint32_t tries) noexcept {
    for (std::uint32_t i = 0; i < tries; ++i) {
      tried_ = best;
      do change(tried_.in[random_.next() % kSearchedTicks], false);
      while (random_.next() % 3 == 0);
      tried_.cost = replay(tried_);
      if (tried_.cost >= best.cost) best = tried_;
    }
  }

  /// Changes all of an input's numbers, or some: each to a hostile one, to one near it or to its negative.
  void change(Input& in, bool all) noexcept {
    static_assert(std::is_trivially_copyable_v<Input>);
    Input other = in;
    target_check::hurt<Real, under_test::Scene>(other, random_, engine.tables()->drive->speed_limit_rad_s);
    constexpr std::size_t kNumbers = sizeof(Input) / sizeof(Real);
    Real number[kNumbers], hostile[kNumbers];
    std::memcpy(number, &in, sizeof number);
    std::memcpy(hostile, &other, sizeof hostile);
    for (std::size_t i = 0; i < kNumbers; ++i) {
      const std::uint64_t bits = random_.next();
      const auto part = static_cast<Real>(static_cast<std::int32_t>(bits >> 32)) * static_cast<Real>(5e-11);  // +-10 %
      switch (all ? 0 : bits & 7) {
        case 0:
          number[i] = hostile[i];
          break;
        case 1:
          number[i] += part * number[i];
          break;
        case 2:
          number[i] = -number[i];
          break;
        default:
          break;
      }
    }
    const Input last = in;
    std::memcpy(static_cast<void*>(&in), number, sizeof number);
    turn_changed(in, last);
  }

  /// A measured angle: any turn that the engine can make, its widest, one near the last one, at times a jump.
  template <class In>
  void turn_changed([[maybe_unused]] In& in, [[maybe_unused]] const In& last) noexcept {
    if constexpr (std::is_base_of_v<crankloop::group::PhaseInput, In>) {
      const auto& drive = *engine.tables()->drive;
      const std::uint64_t widest =
          crankloop::Phase::from_cycles(drive.speed_limit_rad_s * drive.cycles_per_tick_per_rad_s).units();
      const std::uint64_t bits = random_.next();
      const std::uint64_t any = random_.next() % (2 * widest) - widest;
      const std::uint64_t turns[] = {any, any, widest, 0 - widest, last.crank.units() + any / 64, bits};
      in.crank = crankloop::Phase{turns[bits % 6]};
    }
  }

  template <class In>
  static void turn_from([[maybe_unused]] In& in, [[maybe_unused]] const In& last) noexcept {
    if constexpr (std::is_base_of_v<crankloop::group::PhaseInput, In>) in.crank += last.crank;
  }

  target_check::Random random_;
  std::uint32_t counting_ = cost_of_counting();
  Moment dearest_{}, found_{}, tried_{};
};

/// The dearest tick that a search finds.
void search_worst() noexcept {
  static WorstSearch search{495};  // large for a stack
  const Moment& dearest = search.dearest();
  crankloop_measures();
  const std::uint32_t worst = search.replay(dearest);
  crankloop_measures();
  port::Line() << "searched " << worst;
}

}  // namespace
