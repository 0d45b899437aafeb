// A run that is restored, from a snapshot or from bytes, goes on as if nothing had happened; bytes that are not exactly
// what was written are refused and change nothing; and no bytes at all lead a later step out of its bounds.
#include <crankloop/tick/state/saved_state.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <set>
#include <vector>

#include <crankloop/crankloop.hpp>

#include "support/output_fields.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"

namespace crankloop {

template class Engine<float, tick_test::MeasuredWithValves>;
template class Engine<double, tick_test::MeasuredWithValves>;
template class Engine<float, tick_test::MeasuredWithSprings>;
template class Engine<double, tick_test::MeasuredWithSprings>;
template class Engine<float, tick_test::Elastic<1, 1>>;
template class Engine<double, tick_test::Elastic<1, 1>>;

}  // namespace crankloop

namespace crankloop::saved_state_test {

using namespace detail;

using tick_test::MeasuredWithSprings;
using tick_test::MeasuredWithValves;
using OneValve = tick_test::Elastic<1, 1>;  ///< and nothing besides: where it rests, its output is left as it is

namespace {

using support::Random;
using support::refuses;

/// One cylinder whose valve floats, bounces and is moved by a phaser, in a diesel with a rod inertia where the scene
/// knows of one: every field of a state is in use.
template <class S>
EngineDefinition busy_engine() {
  EngineDefinition engine = tick_test::single_495();
  if (!S::rod_inertia) engine.masses.rod_inertia_correction_kg_m2 = 0;
  engine.train_count = 1;
  engine.trains[0] = valve_test::ohc_125_train();
  engine.trains[0].cam.phase_rate_deg_s = 300;
  if (S::valve_gas) engine.trains[0].valve.head_area_m2 = 6e-4;
  engine.trains[0].valve.surge_modes = static_cast<int>(S::spring_modes);
  engine.friction = {60e3, 100, 0.5};
  engine.machine = {1, 0.01, 1e-3, 0.02};
  engine.starter = {60, 60};
  return engine;
}

template <class Real, class S>
struct Rig {
  explicit Rig(const EngineDefinition& definition = busy_engine<S>(), double tick_s = 100e-6) {
    Status status = storage->build(definition, {tick_s});
    EXPECT_TRUE(accepted(status));
    restart(one, Phase{});
    restart(other, Phase{1});
  }
  void restart(Engine<Real, S>& engine, Phase start) { EXPECT_TRUE(accepted(engine.init(storage->tables(), start))); }

  std::unique_ptr<TableStorage<Real, S>> storage = std::make_unique<TableStorage<Real, S>>();
  std::unique_ptr<Engine<Real, S>> heap = std::make_unique<Engine<Real, S>>();
  std::unique_ptr<Engine<Real, S>> other_heap = std::make_unique<Engine<Real, S>>();
  Engine<Real, S>& one = *heap;
  Engine<Real, S>& other = *other_heap;
};

/// Sometimes smooth, sometimes wild, sometimes wrong.
template <class Real, class S>
void drive(Random& random, typename Engine<Real, S>::Input& in) {
  const bool bad = random.whole(0, 40) == 0;
  if constexpr (S::crank == CrankGiven::speed) {
    in.speed_rad_s = static_cast<Real>(random.between(-200, 1400));
    if (bad) in.speed_rad_s = std::numeric_limits<Real>::quiet_NaN();
  } else if constexpr (S::crank == CrankGiven::torque) {
    in.external_torque_Nm = static_cast<Real>(random.between(-300, 200));
    if (bad) in.external_torque_Nm = std::numeric_limits<Real>::infinity();
    in.starter = random.coin() ? 1 : 0;
    in.cut_cylinders = static_cast<std::uint32_t>(random.bits());
  } else {
    in.crank += Phase{static_cast<std::uint64_t>(static_cast<std::int64_t>(random.between(-1e16, 1.5e17)))};
    if (bad) in.crank = Phase{random.bits()};
  }
  if constexpr (Needs<S>::load) in.load_ratio = static_cast<Real>(random.between(-0.1, 2.1));
  if constexpr (Needs<S>::input_pressure) {
    for (Real& pressure : in.pressure_Pa) pressure = static_cast<Real>(random.between(-1e5, 8e6));
  }
  if constexpr (S::cam_phasing) {
    for (Real& target : in.cam_phase_deg) target = static_cast<Real>(random.between(-190, 190));
  }
}

/// All numbers of an output as bits. Results of the last whole valve cycle belong to the output, not to the state: an
/// engine that was restored shows them from the end of its first cycle, and they are left out here.
template <class Real, class S>
std::vector<std::uint64_t> bits(const Output<Real, S>& out) {
  std::vector<std::uint64_t> all;
  support::each_output(out, {1, 1, Needs<S>::any_valves ? 1u : 0u}, [&all](const char* name, std::size_t, auto x) {
    std::uint64_t word = 0;
    std::memcpy(&word, &x, sizeof x);
    if (std::strncmp(name, "cycle_", 6) != 0) all.push_back(word);
  });
  return all;
}

template <class Real, class S>
void expect_finite(const Output<Real, S>& out) {
  support::each_output(out, {1, 1, Needs<S>::any_valves ? 1u : 0u}, [](const char* name, std::size_t, auto x) {
    EXPECT_TRUE(std::isfinite(static_cast<double>(x))) << name;
  });
}

template <class Real, class S>
[[nodiscard]] bool same(const State<Real, S>& a, const State<Real, S>& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

template <class Real, class S>
[[nodiscard]] std::vector<unsigned char> saved(const Engine<Real, S>& engine) {
  std::vector<unsigned char> bytes(kSavedStateBytes<Real, S>);
  EXPECT_TRUE(accepted(save_state(engine, bytes.data(), bytes.size())));
  return bytes;
}
/// Bytes changed on purpose, with the checksum that belongs to them.
void seal(std::vector<unsigned char>& bytes) {
  const std::uint32_t crc = detail::crc32_of(bytes.data(), bytes.size() - 4);
  for (std::size_t i = 0; i < 4; ++i) bytes[bytes.size() - 4 + i] = static_cast<unsigned char>(crc >> (8 * i));
}

template <class Case>
class SavedState : public ::testing::Test {};

template <class R, class Scene>
struct Of {
  using Real = R;
  using S = Scene;
};
struct CaseName {
  template <class Case>
  static std::string GetName(int) {
    using S = typename Case::S;
    const char* scene = S::spring_modes > 0                ? "MeasuredWithSprings"
                        : S::valve_results                 ? (S::kinematics ? "Whole" : "MeasuredWithValves")
                        : S::rod_motion                    ? "MeasuredMotion"
                        : S::valves == ValveModel::elastic ? "OneValve"
                        : S::starter                       ? "FreeRunning"
                        : S::load_ratio                    ? "TorqueByTable"
                                                           : "TorqueByPressure";
    return std::string(scene) + (sizeof(typename Case::Real) == 4 ? "Float" : "Double");
  }
};
using Cases = ::testing::Types<
    Of<float, scenes::Whole>, Of<double, scenes::Whole>, Of<float, MeasuredWithValves>, Of<double, MeasuredWithValves>,
    Of<float, MeasuredWithSprings>, Of<double, MeasuredWithSprings>, Of<float, OneValve>, Of<double, OneValve>,
    Of<float, scenes::TorqueByTable>, Of<double, scenes::TorqueByTable>, Of<float, scenes::TorqueByPressure>,
    Of<double, scenes::TorqueByPressure>, Of<float, scenes::FreeRunning>, Of<double, scenes::FreeRunning>,
    Of<float, scenes::MeasuredMotion>, Of<double, scenes::MeasuredMotion>>;
TYPED_TEST_SUITE(SavedState, Cases, CaseName);

TYPED_TEST(SavedState, GoesOnWithTheSameBitsFromAnyTick) {
  using Real = typename TypeParam::Real;
  using S = typename TypeParam::S;
  Random random;
  Rig<Real, S> rig;
  auto third = std::make_unique<Engine<Real, S>>();
  for (int draw = 0; draw < 12; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    typename Engine<Real, S>::Input in;
    const int ticks = random.whole(0, 400);
    for (int i = 0; i < ticks; ++i) drive<Real, S>(random, in), rig.one.step(in);

    rig.restart(rig.other, Phase{random.bits()});
    rig.restart(*third, Phase{random.bits()});
    const std::vector<unsigned char> bytes = saved(rig.one);
    ASSERT_TRUE(accepted(rig.other.restore(rig.one.state())));
    ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), *third)));
    ASSERT_TRUE(same(rig.one.state(), third->state()));

    for (int i = 0; i < 300; ++i) {
      drive<Real, S>(random, in);
      const std::vector<std::uint64_t> expected = bits(rig.one.step(in));
      ASSERT_EQ(expected, bits(rig.other.step(in))) << "by snapshot, tick " << i;
      ASSERT_EQ(expected, bits(third->step(in))) << "by bytes, tick " << i;
      ASSERT_TRUE(same(rig.one.state(), rig.other.state())) << "by snapshot, tick " << i;
      ASSERT_TRUE(same(rig.one.state(), third->state())) << "by bytes, tick " << i;
    }
  }
}

TYPED_TEST(SavedState, ShowsTheSameValveResultsFromTheFirstWholeCycleOn) {
  using Real = typename TypeParam::Real;
  using S = typename TypeParam::S;
  if constexpr (S::valve_results && S::crank == CrankGiven::speed) {
    Rig<Real, S> rig;
    typename Engine<Real, S>::Input in;
    in.speed_rad_s = Real{1300};
    for (int i = 0; i < 137; ++i) rig.one.step(in);
    const std::vector<unsigned char> bytes = saved(rig.one);
    ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), rig.other)));
    for (int i = 0; i < 300; ++i) rig.one.step(in), rig.other.step(in);  // a cycle takes 97 ticks
    EXPECT_GT(rig.one.output().valve_cycle[0][0].separation_clearance_m, Real{0});
    EXPECT_EQ(
        std::memcmp(rig.one.output().valve_cycle, rig.other.output().valve_cycle, sizeof rig.one.output().valve_cycle),
        0);
  }
}

/// Tries bytes that must be refused, on an engine under way.
template <class Real, class S>
class Refuser {
 public:
  explicit Refuser(Engine<Real, S>& engine)
      : engine_{engine}, before_{engine.state()}, output_{bits(engine.output())} {}

  [[nodiscard]] Status operator()(const std::vector<unsigned char>& bytes) { return (*this)(bytes, bytes.size()); }
  [[nodiscard]] Status operator()(const std::vector<unsigned char>& bytes, std::size_t size) {
    const Status status = load_state(bytes.data(), size, engine_);
    EXPECT_FALSE(status.ok());
    EXPECT_TRUE(same(before_, engine_.state())) << "a refusal changed the state";
    EXPECT_EQ(output_, bits(engine_.output())) << "a refusal changed the output";
    return status;
  }

 private:
  Engine<Real, S>& engine_;
  State<Real, S> before_;
  std::vector<std::uint64_t> output_;
};

template <class Real, class S>
void run_some(Engine<Real, S>& engine, int ticks) {
  Random random;
  typename Engine<Real, S>::Input in;
  for (int i = 0; i < ticks; ++i) drive<Real, S>(random, in), engine.step(in);
}

TYPED_TEST(SavedState, OfAnyTickIsTakenWhateverTheInputsWere) {
  using Real = typename TypeParam::Real;
  using S = typename TypeParam::S;
  Random random;
  Rig<Real, S> rig;
  typename Engine<Real, S>::Input in;
  for (int tick = 0; tick < 500; ++tick) {
    drive<Real, S>(random, in), rig.one.step(in);
    const std::vector<unsigned char> bytes = saved(rig.one);
    ASSERT_TRUE(accepted(load_state(bytes.data(), bytes.size(), rig.other))) << random.trace(tick);
  }
}

TYPED_TEST(SavedState, IsRefusedAtEveryLengthButItsOwn) {
  using Real = typename TypeParam::Real;
  using S = typename TypeParam::S;
  Rig<Real, S> rig;
  run_some(rig.one, 200);
  run_some(rig.other, 33);
  std::vector<unsigned char> bytes = saved(rig.one);
  Refuser<Real, S> refused(rig.other);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::vector<unsigned char> part(
        bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));  // read beyond it: ASan tells
    EXPECT_TRUE(refuses(refused(part), Reason::wrong_size, "state.size")) << size;
  }
  bytes.push_back(0);
  EXPECT_TRUE(refuses(refused(bytes), Reason::wrong_size, "state.size"));
  EXPECT_TRUE(refuses(load_state(nullptr, bytes.size(), rig.other), Reason::wrong_size, "state.size"));
  EXPECT_TRUE(refuses(save_state(rig.one, nullptr, bytes.size()), Reason::wrong_size, "state.size"));
  for (const std::size_t room : {std::size_t{0}, bytes.size() - 2}) {
    EXPECT_TRUE(refuses(save_state(rig.one, bytes.data(), room), Reason::wrong_size, "state.size"));
  }
}

TYPED_TEST(SavedState, IsRefusedWithAnyByteChanged) {
  using Real = typename TypeParam::Real;
  using S = typename TypeParam::S;
  Random random;
  Rig<Real, S> rig;
  run_some(rig.one, 200);
  run_some(rig.other, 33);
  std::vector<unsigned char> bytes = saved(rig.one);
  Refuser<Real, S> refused(rig.other);
  const std::size_t stride = bytes.size() > 3000 ? 7 : 1;  // the largest scene's are all alike
  for (std::size_t i = 0; i < bytes.size(); i += i < 64 ? 1 : stride) {
    SCOPED_TRACE("byte " + std::to_string(i));
    const unsigned char before = bytes[i];
    for (const int change : {1, 0x80, random.whole(1, 255)}) {
      bytes[i] = static_cast<unsigned char>(before ^ change);
      (void)refused(bytes);
    }
    bytes[i] = before;
  }
  EXPECT_TRUE(accepted(load_state(bytes.data(), bytes.size(), rig.other)));
}

TYPED_TEST(SavedState, IsRefusedByOtherTablesAndByAnEngineThatIsNotReady) {
  using Real = typename TypeParam::Real;
  using S = typename TypeParam::S;
  Rig<Real, S> rig;
  EngineDefinition heavier = busy_engine<S>();
  heavier.masses.piston_kg += 0.001;
  Rig<Real, S> of_heavier(heavier);
  Rig<Real, S> of_other_tick(busy_engine<S>(), 99e-6);
  run_some(rig.one, 50);
  std::vector<unsigned char> bytes = saved(rig.one);
  EXPECT_TRUE(refuses(Refuser<Real, S>(of_heavier.one)(bytes), Reason::other_tables, "state.fingerprint"));
  EXPECT_TRUE(refuses(Refuser<Real, S>(of_other_tick.one)(bytes), Reason::other_tables, "state.fingerprint"));
  auto idle = std::make_unique<Engine<Real, S>>();
  EXPECT_TRUE(refuses(load_state(bytes.data(), bytes.size(), *idle), Reason::missing_table, "tables"));
  EXPECT_TRUE(refuses(save_state(*idle, bytes.data(), bytes.size()), Reason::missing_table, "tables"));
}

TYPED_TEST(SavedState, SaysWhatIsWrongWithBytesOfAnotherKind) {
  using Real = typename TypeParam::Real;
  using S = typename TypeParam::S;
  Rig<Real, S> rig;
  const std::vector<unsigned char> good = saved(rig.one);
  Refuser<Real, S> refused(rig.other);
  const auto with = [&good](std::size_t at, unsigned char byte) {
    std::vector<unsigned char> bytes = good;
    bytes[at] = byte;
    seal(bytes);
    return bytes;
  };
  EXPECT_TRUE(refuses(refused(with(0, 'X')), Reason::damaged, "state"));
  EXPECT_TRUE(refuses(refused(with(4, 2)), Reason::other_version, "state"));
  EXPECT_TRUE(refuses(refused(with(4, 6)), Reason::other_version, "state"));
  EXPECT_TRUE(refuses(refused(with(6, 12 - sizeof(Real))), Reason::other_scene, "state"));
  EXPECT_TRUE(refuses(refused(with(8, static_cast<unsigned char>(good[8] + 1))), Reason::other_scene, "state"));
  EXPECT_TRUE(refuses(refused(with(12, static_cast<unsigned char>(good[12] + 1))), Reason::wrong_size, "state.size"));
  EXPECT_TRUE(
      refuses(refused(with(16, static_cast<unsigned char>(good[16] + 1))), Reason::other_tables, "state.fingerprint"));
  std::vector<unsigned char> spoilt = good;
  spoilt.back() ^= 1u;
  EXPECT_TRUE(refuses(refused(spoilt), Reason::damaged, "state"));
}

/// The layout that saved_state.hpp draws, read by hand.
TYPED_TEST(SavedState, IsWrittenLeastSignificantByteFirstAsDocumented) {
  using Real = typename TypeParam::Real;
  using S = typename TypeParam::S;
  Rig<Real, S> rig;
  rig.restart(rig.one, Phase{0x0123'4567'89AB'CDEFu});
  run_some(rig.one, 3);
  const std::vector<unsigned char> bytes = saved(rig.one);
  const auto read = [&bytes](std::size_t at, int count) {
    std::uint64_t x = 0;
    for (int i = count - 1; i >= 0; --i) x = x * 256 + bytes[at + static_cast<std::size_t>(i)];
    return x;
  };
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 4), "CLST");
  EXPECT_EQ(read(4, 2), kSavedStateForm);
  EXPECT_EQ(kSavedStateForm, 5u);
  EXPECT_EQ(read(6, 2), sizeof(Real));
  EXPECT_EQ(read(12, 4), bytes.size());
  EXPECT_EQ(read(16, 8), rig.one.state().fingerprint);
  EXPECT_EQ(read(24, 8), rig.one.state().phase.units());
  EXPECT_EQ(read(32, 8), 3u);
  Real speed{};
  const std::uint64_t word = read(40, sizeof(Real));
  if constexpr (sizeof(Real) == 4) {
    const auto half = static_cast<std::uint32_t>(word);
    std::memcpy(&speed, &half, sizeof speed);
  } else {
    std::memcpy(&speed, &word, sizeof speed);
  }
  EXPECT_EQ(speed, rig.one.state().speed_rad_s);
}

/// A state that no step leaves, behind the engine's back, since restore() looks at some of it, and bytes that are whole
/// in themselves.
template <class Real, class S>
[[nodiscard]] Status loaded(Rig<Real, S>& rig, const State<Real, S>& bad) {
  const_cast<State<Real, S>&>(rig.one.state()) = bad;
  return Refuser<Real, S>(rig.other)(saved(rig.one));
}

TYPED_TEST(SavedState, IsRefusedWhereANumberLiesOutsideWhatAStepCanCompute) {
  using Real = typename TypeParam::Real;
  using S = typename TypeParam::S;
  Rig<Real, S> rig;
  const State<Real, S> good = rig.one.state();
  State<Real, S> bad = good;
  bad.speed_rad_s = std::numeric_limits<Real>::quiet_NaN();
  EXPECT_TRUE(refuses(loaded(rig, bad), Reason::not_finite, "state.drive"));
  bad.speed_rad_s = -std::numeric_limits<Real>::infinity();
  EXPECT_TRUE(refuses(loaded(rig, bad), Reason::not_finite, "state.drive"));
  bad.speed_rad_s = rig.storage->tables().drive->speed_limit_rad_s * static_cast<Real>(1.0001);
  EXPECT_TRUE(refuses(loaded(rig, bad), Reason::out_of_range, "state.drive"));
  bad = good;
  bad.load_ratio = static_cast<Real>(-0.001);
  EXPECT_TRUE(refuses(loaded(rig, bad), Reason::out_of_range, "state.drive"));
  if constexpr (Needs<S>::input_pressure) {
    bad = good;
    bad.pressure_Pa[0] = static_cast<Real>(1.1e8);
    EXPECT_TRUE(refuses(loaded(rig, bad), Reason::out_of_range, "state.pressure"));
  }
  if constexpr (S::mean_torque) {
    bad = good;
    bad.torque_Nm = std::numeric_limits<Real>::max();
    EXPECT_TRUE(refuses(loaded(rig, bad), Reason::out_of_range, "state.work"));
  }
  if constexpr (Needs<S>::crank_dynamics) {
    for (const Real per_root : {Real{0}, static_cast<Real>(-1), static_cast<Real>(1e6)}) {
      bad = good;
      bad.per_root_inertia = per_root;
      EXPECT_TRUE(refuses(loaded(rig, bad), Reason::out_of_range, "state.crank"));
    }
    bad = good;
    bad.reduced_speed = std::numeric_limits<Real>::infinity();
    EXPECT_TRUE(refuses(loaded(rig, bad), Reason::not_finite, "state.crank"));
  }
  if constexpr (Needs<S>::elastic_valves) {
    bad = good;
    bad.valve_regime[0] = kRegimes;  // an index into a table: not even restored
    EXPECT_TRUE(refuses(rig.one.restore(bad), Reason::out_of_range, "state.valve"));
    bad = good;
    bad.cam_turned_deg[0] = Real{361};
    EXPECT_TRUE(refuses(loaded(rig, bad), Reason::out_of_range, "state.valve"));
    bad = good;
    bad.valve_velocity_m_s[0] = std::numeric_limits<Real>::infinity();
    EXPECT_TRUE(refuses(loaded(rig, bad), Reason::not_finite, "state.valve"));
  }
  if constexpr (S::cam_phasing) {
    bad = good;
    bad.cam_phase[0] = (std::uint64_t{1} << 62) + 1;
    EXPECT_TRUE(refuses(loaded(rig, bad), Reason::out_of_range, "state.cam_phase"));
    bad.cam_phase[0] = std::uint64_t{3} << 62;  // -180 deg
    ASSERT_TRUE(accepted(rig.one.restore(bad)));
    const std::vector<unsigned char> bytes = saved(rig.one);
    EXPECT_TRUE(accepted(load_state(bytes.data(), bytes.size(), rig.other)));
  }
  if constexpr (S::bad_input_count) {
    bad = good;
    bad.bad_input_kinds = kInputFaults + 1;
    EXPECT_TRUE(refuses(loaded(rig, bad), Reason::out_of_range, "state.bad_input"));
  }
}

/// A steady crank, whoever gives it.
template <class Real, class S>
void turn_steadily(typename Engine<Real, S>::Input& in) {
  if constexpr (S::crank == CrankGiven::speed) in.speed_rad_s = Real{300};
  if constexpr (S::crank == CrankGiven::phase) in.crank += Phase::from_cycles(0.0024);  // of 100 us
  if constexpr (S::crank == CrankGiven::torque) in.starter = 1;
  if constexpr (Needs<S>::input_pressure) {
    for (Real& pressure : in.pressure_Pa) pressure = Real{100'000};
  }
}

/// One engine saw its valves rest, the other stopped with them open: what it showed last must not show through what it
/// is restored to.
TYPED_TEST(SavedState, GoesOnWithTheSameBitsInAnEngineWhoseValvesStoodOpen) {
  using Real = typename TypeParam::Real;
  using S = typename TypeParam::S;
  Rig<Real, S> rig;
  typename Engine<Real, S>::Input in;
  if constexpr (Needs<S>::elastic_valves) {
    typename Engine<Real, S>::Input other_in;
    const auto open = [&] { return rig.other.output().valve[0][0].lift_m > static_cast<Real>(0.005); };
    for (int i = 0; i < 2000 && !open(); ++i) turn_steadily<Real, S>(other_in), rig.other.step(other_in);
    ASSERT_TRUE(open());
  } else {
    run_some(rig.other, 100);
  }
  const Engine<Real, S> stopped = rig.other;
  for (int at = 0; at < 840; ++at) {  // two cycles
    turn_steadily<Real, S>(in);
    if (at % 12 == 0) {
      rig.other = stopped;
      ASSERT_TRUE(accepted(rig.other.restore(rig.one.state())));
      ASSERT_EQ(bits(rig.one.step(in)), bits(rig.other.step(in))) << "tick " << at;
    } else {
      rig.one.step(in);
    }
  }
}

TYPED_TEST(SavedState, OfAnEngineAtItsFastestEitherWayRoundIsTaken) {
  using Real = typename TypeParam::Real;
  using S = typename TypeParam::S;
  Rig<Real, S> rig(busy_engine<S>(), 10e-6);
  const Real fastest = rig.storage->tables().drive->speed_limit_rad_s;
  EXPECT_NEAR(static_cast<double>(fastest), 10472, 1) << "100 000 rpm";
  for (const Real speed : {fastest, -fastest}) {
    State<Real, S> state = rig.one.state();
    state.speed_rad_s = speed;
    ASSERT_TRUE(accepted(rig.one.restore(state)));
    const std::vector<unsigned char> bytes = saved(rig.one);
    EXPECT_TRUE(accepted(load_state(bytes.data(), bytes.size(), rig.other))) << speed;
    EXPECT_EQ(rig.other.state().speed_rad_s, speed);
    state.speed_rad_s = speed * static_cast<Real>(1.0001);
    EXPECT_TRUE(refuses(loaded(rig, state), Reason::out_of_range, "state.drive")) << speed;
  }
}

/// Whoever forges bytes with a right checksum may get wrong numbers, but no infinite ones, and no step out of bounds
/// (the sanitizers look).
TYPED_TEST(SavedState, ForgedInAnyFieldIsRefusedOrStepsOnWithinBounds) {
  using Real = typename TypeParam::Real;
  using S = typename TypeParam::S;
  Random random;
  Rig<Real, S> rig;
  run_some(rig.one, 150);
  const std::vector<unsigned char> good = saved(rig.one);
  int taken = 0;
  int refused = 0;
  const int forgeries = 400;
  for (int draw = 0; draw < forgeries; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    std::vector<unsigned char> bytes = good;
    // Fields in use come first within their groups: most forgeries go there, two at a time.
    for (int change = 0; change < 2; ++change) {
      const int words = static_cast<int>((good.size() - 28) / 4);
      const std::size_t at =
          24 + 4 * static_cast<std::size_t>(random.whole(0, random.coin() && words > 100 ? 100 : words - 1));
      const Real numbers[] = {static_cast<Real>(1e6), std::numeric_limits<Real>::max(), static_cast<Real>(-999.5),
                              std::numeric_limits<Real>::denorm_min()};
      const std::uint64_t bits_of_number = detail::word_of(numbers[random.whole(0, 3)]);
      const std::uint64_t word = random.coin()   ? random.bits()
                                 : random.coin() ? bits_of_number
                                                 : static_cast<std::uint64_t>(random.whole(0, 4));
      for (std::size_t i = 0; i < sizeof(Real) && at + i + 4 < bytes.size(); ++i)
        bytes[at + i] = static_cast<unsigned char>(word >> (8 * i));
    }
    seal(bytes);
    if (!load_state(bytes.data(), bytes.size(), rig.other).ok()) {
      ++refused;
      continue;
    }
    ++taken;
    typename Engine<Real, S>::Input in;
    for (int i = 0; i < 60; ++i) {
      drive<Real, S>(random, in);
      expect_finite(rig.other.step(in));
    }
  }
  EXPECT_GT(taken, forgeries / 20);
  EXPECT_GT(refused, forgeries / 20);
}

template <class... Scenes>
std::set<std::uint32_t> codes_of() {
  return {detail::scene_code<Scenes>()...};
}

TEST(SceneCode, TellsScenesApartByEveryAnswerThatTheirStatesDependOn) {
  using namespace tick_test::otherwise;
  const auto codes =
      codes_of<Plain, TwoCylinders, TwoTrains, ByPhase, ByLoad, TablePressure, InputPressure, Following, Elastic,
               WithLoadRatio, WithRodInertia, WithTorque, WithMeanTorque, WithForces, WithValveResults, WithValveGas,
               WithCamContact, WithCamDrag, WithSpringModes, WithCamPhasing, WithBadInputCount, WithStarter,
               WithCylinderCut, WithWheelFaults, Burning, BetweenGivenManifolds, WithoutCombustion, WithGasResults,
               WithBoundaries, WithCrevice, WithRunners, WithWalls, WithChargeBurn, WithKnock, WithLambda,
               WithMoreParcels, WithSensorFaults, WithMisfire>();
  EXPECT_EQ(codes.size(), 38u);
}

TEST(Crc32, HasTheCheckValueOfItsStandard) {
  const unsigned char digits[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(detail::crc32_of(digits, sizeof digits), 0xCBF43926u);
}

}  // namespace
}  // namespace crankloop::saved_state_test
