// Definitions at and beyond their limits, in any scene: refused with a field that exists, or accepted, and then tables
// that nothing but what the definition says has a part in.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <crankloop/tabulate/tabulate.hpp>

#include "support/gas_engine.hpp"
#include "support/limit_definitions.hpp"
#include "support/scenes.hpp"
#include "support/status.hpp"

namespace crankloop::limit_definitions_test {
namespace {

using support::LimitDefinition;

/// What set-up answers, and the fingerprint of what it accepted.
struct Answer {
  Status status;
  std::uint64_t fingerprint = 0;

  bool operator==(const Answer& other) const {
    return status.reason == other.status.reason && status.index == other.status.index &&
           std::string(status.field) == other.status.field && fingerprint == other.fingerprint;
  }
};

template <class S>
Answer built(const EngineDefinition& definition) {
  static const auto storage = std::make_unique<TableStorage<float, S>>();
  Answer answer{storage->build(definition, {100e-6, {}})};
  if (answer.status.ok()) answer.fingerprint = storage->tables().drive->fingerprint;
  return answer;
}

TEST(DefinitionAtItsLimits, IsRefusedByAFieldOrMeansTheSameWhateverItsUnreadMemoryHolds) {
  // CRANKLOOP_LONG_TESTS=1 in the environment: 100 000 definitions, and tables of all that are accepted.
  const bool long_test = std::getenv("CRANKLOOP_LONG_TESTS") != nullptr;
  const int trials = long_test ? 100'000 : 2000;
  support::Random random;
  int accepted_ones = 0;
  int built_ones = 0;
  std::set<std::string> refused_fields;
  for (int trial = 0; trial < trials; ++trial) {
    SCOPED_TRACE(random.trace(trial));
    const LimitDefinition limit(random);
    const EngineDefinition zeros = support::in_memory_of(0x00, limit.definition);
    const EngineDefinition others = support::in_memory_of(0xA5, limit.definition);
    const Status valid = validate(zeros);
    EXPECT_TRUE((Answer{valid} == Answer{validate(others)})) << testing::PrintToString(valid);
    if (valid.ok()) ++accepted_ones;
    const bool quick = valid.ok() && !long_test && trial % 32 != 0;  // tables of lifts and diagrams take milliseconds
    if (quick && limit.definition.pressure.source == PressureSource::wiebe) continue;
    std::set<std::uint64_t> fingerprints;
    const auto expect_promise = [&](const Answer& one, const Answer& other) {
      EXPECT_TRUE(one == other) << testing::PrintToString(one.status) << ", or "
                                << testing::PrintToString(other.status);
      EXPECT_TRUE(support::is_field(one.status.field) || one.status.ok()) << one.status.field;
      if (one.status.ok()) {
        EXPECT_TRUE(accepted(valid));
        fingerprints.insert(one.fingerprint);
      } else {
        refused_fields.insert(one.status.field);
      }
    };
    expect_promise(built<tick_test::Nothing>(zeros), built<tick_test::Nothing>(others));
    if (!quick) expect_promise(built<tick_test::CamFollowing>(zeros), built<tick_test::CamFollowing>(others));
    EXPECT_LE(fingerprints.size(), 1u) << "the fingerprint is the definition's, whatever the scene";
    if (!fingerprints.empty()) ++built_ones;
  }
  std::printf(
      "[ figures  ] seed %llu: %d of %d definitions at their limits accepted, tables of %d built; %zu fields refused\n",
      static_cast<unsigned long long>(support::test_seed()), accepted_ones, trials, built_ones, refused_fields.size());
  EXPECT_GE(accepted_ones, trials / 20);
  EXPECT_GE(built_ones, trials / 100);
  EXPECT_GE(refused_fields.size(), 80u);
}

}  // namespace
}  // namespace crankloop::limit_definitions_test
