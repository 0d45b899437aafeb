// verify() of an engine whose memory was changed says what load_state() says of its saved bytes.
#include <crankloop/tick/state/verify.hpp>

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <crankloop/crankloop.hpp>

#include "support/engines.hpp"
#include "support/random.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"

namespace crankloop::verify_test {
namespace {

using support::Random;

template <class R, class Scene>
struct Of {
  using Real = R;
  using S = Scene;
};

template <class Case>
class Verify : public ::testing::Test {
 protected:
  using Real = typename Case::Real;
  using S = typename Case::S;

  Verify() {
    EngineDefinition engine = detail::Needs<S>::gas ? support::four_2000() : support::diesel_495();
    if (!detail::Needs<S>::gas) {
      engine.train_count = 1;
      engine.trains[0] = valve_test::ohc_125_train();
      engine.masses.rod_inertia_correction_kg_m2 = 0;
    }
    if (detail::Needs<S>::crank_dynamics) engine.machine = {1, 0.01, 1e-3, 0.02};
    if (S::starter) engine.starter = {60, 60};
    EXPECT_TRUE(accepted(storage_->build(engine, {100e-6, {}})));
    EXPECT_TRUE(accepted(engine_->init(storage_->tables())));
    run(900);  // more than a cycle
  }
  void run(int ticks) {
    typename Engine<Real, S>::Input in;
    if constexpr (S::crank == CrankGiven::speed) in.speed_rad_s = 200;
    if constexpr (S::starter) in.starter = true;
    if constexpr (detail::Needs<S>::manifolds) in.throttle_ratio = Real(0.5);
    for (int tick = 0; tick < ticks; ++tick) engine_->step(in);
  }
  /// What load_state says of the engine's state.
  Status loaded() {
    std::vector<unsigned char> bytes(kSavedStateBytes<Real, S>);
    EXPECT_TRUE(accepted(save_state(*engine_, bytes.data(), bytes.size())));
    return load_state(bytes.data(), bytes.size(), *engine_);
  }

  std::unique_ptr<TableStorage<Real, S>> storage_ = std::make_unique<TableStorage<Real, S>>();
  std::unique_ptr<Engine<Real, S>> engine_ = std::make_unique<Engine<Real, S>>();
};
struct CaseName {
  template <class Case>
  static std::string GetName(int) {
    using S = typename Case::S;
    const char* scene = !detail::Needs<S>::gas ? (S::valve_results ? "Whole" : "FreeRunning")
                        : S::starter           ? "BreathingFree"
                                               : "Breathing";
    return std::string(scene) + (sizeof(typename Case::Real) == 4 ? "Float" : "Double");
  }
};
using Cases =
    ::testing::Types<Of<float, scenes::Whole>, Of<double, scenes::Whole>, Of<float, scenes::FreeRunning>,
                     Of<double, scenes::FreeRunning>, Of<float, scenes::Breathing>, Of<double, scenes::BreathingFree>>;
TYPED_TEST_SUITE(Verify, Cases, CaseName);

TYPED_TEST(Verify, AcceptsWhatEveryStepLeaves) {
  for (int tick = 0; tick < 2000; ++tick) {
    this->run(1);
    ASSERT_TRUE(accepted(verify(*this->engine_))) << "tick " << tick;
  }
}

TYPED_TEST(Verify, SaysOfAnyFlippedBitWhatLoadStateSays) {
  using State = crankloop::State<typename TypeParam::Real, typename TypeParam::S>;
  Random random;
  int flipped = 0, refused = 0;
  for (int draw = 0; draw < 3000; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const State good = this->engine_->state();
    State bad = good;
    const int bit = random.whole(0, static_cast<int>(8 * sizeof(State)) - 1);
    unsigned char bytes[sizeof(State)];
    std::memcpy(bytes, &bad, sizeof(State));
    bytes[bit / 8] = static_cast<unsigned char>(bytes[bit / 8] ^ 1u << bit % 8);
    std::memcpy(&bad, bytes, sizeof(State));
    if (!this->engine_->restore(bad).ok()) continue;  // with it no engine steps on
    ++flipped;
    const Status said = verify(*this->engine_);
    const Status expected = this->loaded();
    refused += said.ok() ? 0 : 1;
    if (std::strcmp(said.field, "state.misfire") == 0 && expected.ok()) continue;  // which load_state() counts anew
    EXPECT_EQ(said.reason, expected.reason) << said.field << " and " << expected.field << ", bit " << bit;
    EXPECT_STREQ(said.field, expected.field) << "bit " << bit;
    ASSERT_TRUE(accepted(this->engine_->restore(good)));
    if (draw % 10 == 0) this->run(7);
  }
  std::printf("[ figures  ] of %d flipped bits %d are refused\n", flipped, refused);
  EXPECT_GT(flipped, 2000);
  EXPECT_GT(refused, flipped / 50);
}

TYPED_TEST(Verify, NamesTheGroupOfANumberThatIsNone) {
  auto bad = this->engine_->state();
  bad.speed_rad_s = std::numeric_limits<typename TypeParam::Real>::quiet_NaN();
  if (!this->engine_->restore(bad).ok()) return;  // where the crank's speed is given
  EXPECT_TRUE(support::refuses(verify(*this->engine_), Reason::not_finite, "state.drive"));
}

/// restore() takes no state of other tables, so only a memory fault makes one.
TYPED_TEST(Verify, RefusesAStateWhoseFingerprintIsNotThatOfTheTables) {
  auto& state = const_cast<crankloop::State<typename TypeParam::Real, typename TypeParam::S>&>(this->engine_->state());
  for (int bit = 0; bit < 64; ++bit) {
    state.fingerprint ^= std::uint64_t{1} << bit;
    EXPECT_TRUE(support::refuses(verify(*this->engine_), Reason::other_tables, "state.fingerprint")) << bit;
    state.fingerprint ^= std::uint64_t{1} << bit;
    EXPECT_TRUE(accepted(verify(*this->engine_))) << bit;
  }
}

TYPED_TEST(Verify, RefusesAnEngineWithoutTables) {
  const auto engine = std::make_unique<Engine<typename TypeParam::Real, typename TypeParam::S>>();
  EXPECT_TRUE(support::refuses(verify(*engine), Reason::missing_table, "tables"));
}

}  // namespace
}  // namespace crankloop::verify_test
