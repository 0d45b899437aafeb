// A saved state forged field by field, with the right checksum: load_state refuses it, or every number of every later
// output is finite, whatever the inputs.
//
// Each forgery takes a state of an engine under way and gives one to three fields a number within the field's limits:
// at a limit, near zero, of any magnitude between, or a little off what it was. Bytes damaged at random:
// tests/property/saved_state_test.cpp.
#include <crankloop/tick/state/saved_state.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <crankloop/crankloop.hpp>
#include <crankloop/scenes.hpp>

#include "support/both_reals.hpp"
#include "support/engines.hpp"
#include "support/random.hpp"
#include "support/status.hpp"
#include "support/test_valves.hpp"
#include "support/trigger_wheels.hpp"
#include "target/hostile.hpp"
#include "target/output_numbers.hpp"

namespace crankloop::forged_state_test {

/// Cylinders between manifolds whose pressures are inputs.
struct BreathingFromGiven : Scene {
  static constexpr Count cylinders = up_to<4>;
  static constexpr Count trains = up_to<2>;
  static constexpr CrankGiven crank = CrankGiven::phase;
  static constexpr PressureGiven pressure = PressureGiven::by_gas;
  static constexpr Combustion combustion = Combustion::by_input;
  static constexpr ValveModel valves = ValveModel::following;
  static constexpr bool gas_results = true;
  static constexpr bool forces = true;
  static constexpr bool mean_torque = true;
};
/// One valve whose spring surges, under gas.
struct WithSprings : Scene {
  static constexpr Count cylinders = up_to<4>;
  static constexpr PressureGiven pressure = PressureGiven::by_input;
  static constexpr ValveModel valves = ValveModel::elastic;
  static constexpr bool valve_acceleration = true;
  static constexpr bool valve_forces = true;
  static constexpr bool valve_gas = true;
  static constexpr std::uint32_t spring_modes = 3;
};

}  // namespace crankloop::forged_state_test

namespace crankloop {

template class Engine<float, forged_state_test::WithSprings>;
template class Engine<double, forged_state_test::WithSprings>;
template class Engine<float, forged_state_test::BreathingFromGiven>;
template class Engine<double, forged_state_test::BreathingFromGiven>;

}  // namespace crankloop

namespace crankloop::forged_state_test {

namespace {

using support::Random;

/// One field as load_state reads it.
struct Field {
  enum class Kind { number, any_bits, word };
  Kind kind;
  const char* group;
  std::size_t at, bytes;  ///< in the saved state
  double least, most;
};

/// Lists the fields of a saved state in their order.
template <class Real>
class FieldList {
 public:
  std::vector<Field> fields;

  void group(const char* name) noexcept { group_ = name; }
  void number(const Real&, Real least, Real most) {
    add(Field::Kind::number, sizeof(Real), static_cast<double>(least), static_cast<double>(most));
  }
  template <class Base>
  void sum(const Base&, double most) {
    add(sizeof(Base) == 8 ? Field::Kind::number : Field::Kind::any_bits, sizeof(Base), -most, most);
  }
  void wide(const std::uint64_t&) { add(Field::Kind::any_bits, 8, 0, 0); }
  void phase(const Phase&) { add(Field::Kind::any_bits, 8, 0, 0); }
  void signed_wide(const std::uint64_t&, std::uint64_t) { add(Field::Kind::any_bits, 8, 0, 0); }
  template <class Word>
  void word(const Word&, std::uint32_t most) {
    add(Field::Kind::word, 4, 0, most);
  }
  template <class T>
  void spare(const T&) noexcept {}

 private:
  void add(Field::Kind kind, std::size_t bytes, double least, double most) {
    fields.push_back({kind, group_, at_, bytes, least, most});
    at_ += bytes;
  }
  const char* group_ = "";
  std::size_t at_ = detail::kSavedHeaderBytes;
};

template <class S>
EngineDefinition engine_of() {
  using support::diesel_495;
  EngineDefinition engine = detail::Needs<S>::gas ? support::four_2000() : diesel_495();
  if (!detail::Needs<S>::gas) {
    engine.train_count = 1;
    engine.trains[0] = valve_test::ohc_125_train();
    if (S::valve_gas) engine.trains[0].valve.head_area_m2 = 6e-4;
    engine.trains[0].valve.surge_modes = static_cast<int>(S::spring_modes);
    if (!S::rod_inertia) engine.masses.rod_inertia_correction_kg_m2 = 0;
  }
  if (S::runners) engine.gas.intake_runner = {0.35, 0.038, 0.8}, engine.gas.exhaust_runner = {0.5, 0.036, 0.8};
  for (int t = 0; t < engine.train_count; ++t) engine.trains[t].cam.phase_rate_deg_s = 300;
  if (detail::Needs<S>::crank_dynamics) {
    engine.friction = {60e3, 100, 0.5};
    engine.machine = {1, 0.01, 1e-3, 0.02};
    engine.starter = {60, 60};
  }
  if (detail::Needs<S>::any_triggers) engine = with_wheels(engine, tick_test::drawn_wheels());
  return engine;
}

template <class Real, class S>
[[nodiscard]] bool finite(const Output<Real, S>& out) {
  target_check::FiniteCheck check;
  target_check::each_number(check, out);
  return check.finite();
}

template <class Case>
class ForgedState : public ::testing::Test {
 protected:
  using Real = typename Case::Real;
  using S = typename Case::S;

  ForgedState() {
    EXPECT_TRUE(accepted(storage_->build(engine_of<S>(), {100e-6, {}})));
    EXPECT_TRUE(accepted(engine_->init(storage_->tables())));
    detail::StateFields<Real, S>::visit(engine_->state(), list_);
  }

  /// Inputs of a usual drive, and now and then any bits at all.
  void drive(typename Engine<Real, S>::Input& in) {
    if (random_.whole(0, 3) == 0) {
      target_check::hurt<Real, S>(in, hostile_);
      return;
    }
    if constexpr (S::crank == CrankGiven::speed) in.speed_rad_s = static_cast<Real>(random_.between(-200, 900));
    if constexpr (S::crank == CrankGiven::phase) in.crank += Phase::from_cycles(random_.between(0, 0.01));
    if constexpr (S::crank == CrankGiven::torque) in.external_torque_Nm = static_cast<Real>(random_.between(-50, 50));
  }

  /// States of the engine under way: started, at speed, thrown about.
  std::vector<std::vector<unsigned char>> states_under_way(int count) {
    std::vector<std::vector<unsigned char>> states;
    for (int i = 0; i < count; ++i) {
      EXPECT_TRUE(accepted(engine_->init(storage_->tables(), Phase{random_.bits()})));
      typename Engine<Real, S>::Input in;
      const bool steady = i % 2 == 0;
      for (int tick = random_.whole(0, 900); tick > 0; --tick) {
        if constexpr (S::crank == CrankGiven::speed) in.speed_rad_s = Real{300};
        if constexpr (S::crank == CrankGiven::phase) in.crank += Phase::from_cycles(0.005);
        if constexpr (S::starter) in.starter = 1;
        if constexpr (detail::Needs<S>::burn_input) {
          for (Real& fuel : in.fuel_kg) fuel = static_cast<Real>(30e-6);
        }
        if (!steady) drive(in);
        engine_->step(in);
      }
      std::vector<unsigned char> bytes(kSavedStateBytes<Real, S>);
      EXPECT_TRUE(accepted(save_state(*engine_, bytes.data(), bytes.size())));
      EXPECT_TRUE(accepted(load_state(bytes.data(), bytes.size(), *engine_)));
      states.push_back(bytes);
    }
    return states;
  }

  /// A number that the field's limits let pass.
  Real forged(const Field& field, Real was) {
    const double least = field.least;
    const double most = field.most;
    const double span = std::fmax(std::fabs(least), std::fabs(most));
    const auto held = [&](double x) { return static_cast<Real>(x < least ? least : x > most ? most : x); };
    const double sign = random_.coin() ? 1 : -1;
    switch (random_.whole(0, 7)) {
      case 0:
        return static_cast<Real>(least);
      case 1:
        return static_cast<Real>(most);
      case 2:
        return held(random_.between(least, most));
      case 3:
        return held(sign * span * std::pow(10, random_.between(-60, 0)));
      case 4:
        return held(sign * static_cast<double>(std::numeric_limits<Real>::denorm_min()));
      case 5:
        return held(0);
      case 6:
        return held(static_cast<double>(was) * random_.between(-2, 2));
      default:
        return held(static_cast<double>(was) * std::pow(10, random_.between(-12, 12)));
    }
  }
  void forge(std::vector<unsigned char>& bytes, const Field& field) {
    std::uint64_t word = random_.bits();
    if (field.kind == Field::Kind::word && field.most < 4e9) word %= static_cast<std::uint64_t>(field.most) + 1;
    if (field.kind == Field::Kind::number) {
      if (field.bytes == sizeof(Real)) {
        Real was;
        std::memcpy(&was, &bytes[field.at], sizeof was);
        word = detail::word_of(forged(field, was));
      } else {
        word = detail::word_of(random_.between(field.least, field.most));
      }
    }
    for (std::size_t i = 0; i < field.bytes; ++i) bytes[field.at + i] = static_cast<unsigned char>(word >> (8 * i));
  }
  static void seal(std::vector<unsigned char>& bytes) {
    const std::uint32_t crc = detail::crc32_of(bytes.data(), bytes.size() - 4);
    for (std::size_t i = 0; i < 4; ++i) bytes[bytes.size() - 4 + i] = static_cast<unsigned char>(crc >> (8 * i));
  }
  Random random_;
  target_check::Random hostile_{support::test_seed()};
  std::unique_ptr<TableStorage<Real, S>> storage_ = std::make_unique<TableStorage<Real, S>>();
  std::unique_ptr<Engine<Real, S>> engine_ = std::make_unique<Engine<Real, S>>();
  FieldList<Real> list_;
};

template <class R, class Scene>
struct Of {
  using Real = R;
  using S = Scene;
};
struct CaseName {
  template <class Case>
  static std::string GetName(int) {
    using S = typename Case::S;
    constexpr bool gas = detail::Needs<S>::gas;
    const char* scene = S::spring_modes > 0       ? "WithSprings"
                        : gas && S::valve_results ? "Breathing"
                        : gas && S::starter       ? "BreathingFree"
                        : gas                     ? "BreathingFromGiven"
                        : S::valve_results        ? "Whole"
                        : S::rod_motion           ? "MeasuredMotion"
                        : S::starter              ? "FreeRunning"
                        : S::load_ratio           ? "TorqueByTable"
                                                  : "TorqueByPressure";
    return std::string(scene) + (sizeof(typename Case::Real) == 4 ? "Float" : "Double");
  }
};
using Cases =
    ::testing::Types<Of<float, scenes::Whole>, Of<double, scenes::Whole>, Of<float, scenes::MeasuredMotion>,
                     Of<double, scenes::MeasuredMotion>, Of<float, scenes::TorqueByTable>,
                     Of<double, scenes::TorqueByTable>, Of<float, scenes::TorqueByPressure>,
                     Of<double, scenes::TorqueByPressure>, Of<float, scenes::FreeRunning>,
                     Of<double, scenes::FreeRunning>, Of<float, scenes::Breathing>, Of<double, scenes::Breathing>,
                     Of<float, scenes::BreathingFree>, Of<double, scenes::BreathingFree>, Of<float, BreathingFromGiven>,
                     Of<double, BreathingFromGiven>, Of<float, WithSprings>, Of<double, WithSprings>>;
TYPED_TEST_SUITE(ForgedState, Cases, CaseName);

TYPED_TEST(ForgedState, WithinItsLimitsIsRefusedOrStepsOnInFiniteNumbers) {
  // 10^5 forgeries over all scenes with CRANKLOOP_LONG_TESTS=1 in the environment.
  const int forgeries = std::getenv("CRANKLOOP_LONG_TESTS") != nullptr ? 6'250 : 100;
  const auto states = this->states_under_way(12);
  const std::vector<Field>& fields = this->list_.fields;
  ASSERT_EQ(fields.back().at + fields.back().bytes + detail::kSavedChecksumBytes, states[0].size());
  int accepted_states = 0;
  for (int draw = 0; draw < forgeries; ++draw) {
    std::string what = this->random_.trace(draw);
    std::vector<unsigned char> bytes = states[static_cast<std::size_t>(draw) % states.size()];
    for (int n = this->random_.whole(1, 3); n > 0; --n) {
      const int number = this->random_.whole(1, static_cast<int>(fields.size()) - 1);  // not the fingerprint
      const Field& field = fields[static_cast<std::size_t>(number)];
      this->forge(bytes, field);
      what += std::string(", ") + field.group + ", field " + std::to_string(number);
    }
    SCOPED_TRACE(what);
    this->seal(bytes);
    ASSERT_TRUE(accepted(this->engine_->init(this->storage_->tables())));
    if (!load_state(bytes.data(), bytes.size(), *this->engine_).ok()) continue;
    ++accepted_states;
    typename Engine<typename TypeParam::Real, typename TypeParam::S>::Input in;
    const int ticks = draw % 40 == 0 ? 2000 : 50;
    for (int tick = 0; tick < ticks; ++tick) {
      if (draw % 2 == 0) this->drive(in);
      ASSERT_TRUE(finite(this->engine_->step(in))) << "tick " << tick;
    }
  }
  std::printf("[ figures  ] of %d forged states %d are accepted, and finite\n", forgeries, accepted_states);
  EXPECT_GT(accepted_states, forgeries / 2);
}

// ---- gas: each number is within its limits, and does not fit the others --------------------------------------------

template <class Real, class S>
class ForgedGasIn : public ::testing::Test {
 protected:
  ForgedGasIn() {
    EXPECT_TRUE(accepted(storage_->build(engine_of<S>(), {100e-6, {}})));
    EXPECT_TRUE(accepted(engine_->init(storage_->tables())));
    typename Engine<Real, S>::Input in;
    in.speed_rad_s = 200;
    for (int tick = 0; tick < 900; ++tick) engine_->step(in);  // more than a cycle
  }
  /// What load_state says of the state as `change` leaves it.
  template <class Change>
  Status load(const Change& change) {
    const State<Real, S> good = engine_->state();
    State<Real, S> bad = good;
    change(bad);
    EXPECT_TRUE(accepted(engine_->restore(bad))) << "which trusts its caller";
    std::vector<unsigned char> bytes(kSavedStateBytes<Real, S>);
    EXPECT_TRUE(accepted(save_state(*engine_, bytes.data(), bytes.size())));
    EXPECT_TRUE(accepted(engine_->restore(good)));
    return load_state(bytes.data(), bytes.size(), *engine_);
  }
  template <class Change>
  [[nodiscard]] bool refused(const Change& change) {
    return support::refuses(load(change), Reason::inconsistent, "state.gas");
  }

  std::unique_ptr<TableStorage<Real, S>> storage_ = std::make_unique<TableStorage<Real, S>>();
  std::unique_ptr<Engine<Real, S>> engine_ = std::make_unique<Engine<Real, S>>();
};
template <class Real>
class ForgedGas : public ForgedGasIn<Real, scenes::Breathing> {};
TYPED_TEST_SUITE(ForgedGas, tick_test::BothReals, tick_test::RealName);

TYPED_TEST(ForgedGas, OfOtherHeatPressureOrVolumeThanItsMassIsRefused) {
  using Real = TypeParam;
  EXPECT_TRUE(accepted(this->load([](auto&) {})));
  // A cylinder of the engine, one that only the scene has room for, a manifold.
  for (const std::uint32_t k : {1u, 11u}) {
    SCOPED_TRACE(k);
    for (const double factor : {0.3, 3.0}) {
      const auto times = [factor](Real& x) { x *= static_cast<Real>(factor); };
      EXPECT_TRUE(this->refused([&](auto& s) { times(s.cylinder_gas.mass_kg[k]); }));
      EXPECT_TRUE(this->refused([&](auto& s) { times(s.cylinder_gas.energy_J[k]); }));
      EXPECT_TRUE(this->refused([&](auto& s) { times(s.cylinder_gas.pressure_Pa[k]); }));
      EXPECT_TRUE(this->refused([&](auto& s) { times(s.cylinder_gas.temperature_K[k]); }));
      EXPECT_TRUE(this->refused([&](auto& s) { times(s.cylinder_gas.volume_m3[k]); }));
    }
    EXPECT_TRUE(this->refused([&](auto& s) {  // as if no gas had ever been so thin
      s.cylinder_gas.mass_kg[k] = static_cast<Real>(1e-18);
    }));
    EXPECT_TRUE(this->refused([&](auto& s) { s.cylinder_gas.burned_kg[k] = 2 * s.cylinder_gas.mass_kg[k]; }));
    EXPECT_TRUE(this->refused([&](auto& s) { s.cylinder_gas.mass_rest_kg[k] = s.cylinder_gas.mass_kg[k] / 2; }));
    EXPECT_TRUE(this->refused([&](auto& s) { s.cylinder_gas.energy_rest_J[k] = -s.cylinder_gas.energy_J[k] / 2; }));
    EXPECT_TRUE(this->refused([&](auto& s) { s.cylinder_gas.burned_rest_kg[k] = -s.cylinder_gas.mass_kg[k] / 2; }));
    // The same gas in a cylinder that no piston leaves so large, or so small.
    for (const double litres : {0.6, 0.05}) {
      EXPECT_TRUE(this->refused([&](auto& s) {
        const Real factor = static_cast<Real>(litres * 1e-3) / s.cylinder_gas.volume_m3[k];
        s.cylinder_gas.volume_m3[k] *= factor, s.cylinder_gas.mass_kg[k] *= factor,
            s.cylinder_gas.energy_J[k] *= factor;
        s.cylinder_gas.burned_kg[k] = 0;
      }));
    }
  }
  EXPECT_TRUE(this->refused([](auto& s) { s.manifold[kIntake].contents.mass_kg *= 3; }));
  EXPECT_TRUE(this->refused([](auto& s) { s.manifold[kExhaust].contents.energy_J /= 3; }));
  EXPECT_TRUE(this->refused([](auto& s) { s.manifold[kIntake].point.pressure_Pa *= 3; }));
}

struct FollowingFromGiven : BreathingFromGiven {
  static constexpr CrankGiven crank = CrankGiven::speed;
};
using ForgedPorts = ForgedGasIn<double, FollowingFromGiven>;

TEST_F(ForgedPorts, OpenWhereTheirCamsHaveThemClosedAreRefused) {
  int closed = 0;
  for (std::uint32_t k = 0; k < 4; ++k) {
    for (const int port : {kIntake, kExhaust}) {
      const bool is_closed = engine_->state().cylinder_gas.area_m2[port][k] == 0;
      closed += is_closed ? 1 : 0;
      const auto open = [&](auto& s) { s.cylinder_gas.area_m2[port][k] = 1e-5; };
      if (is_closed)
        EXPECT_TRUE(refused(open)) << k << ", " << port;
      else
        EXPECT_TRUE(accepted(load(open))) << k << ", " << port;
    }
  }
  EXPECT_GE(closed, 4);
  EXPECT_LE(closed, 6);
}

/// Every state of a run is taken back, its cams' ramps among them.
TEST_F(ForgedPorts, AsARunLeavesThemAreAccepted) {
  Engine<double, FollowingFromGiven>::Input in;
  for (int tick = 0; tick < 2000; ++tick) {
    in.speed_rad_s = tick % 500 < 300 ? 300 : -700;
    engine_->step(in);
    ASSERT_TRUE(accepted(load([](auto&) {}))) << tick;
  }
}

struct RunnersFromGiven : FollowingFromGiven {
  static constexpr bool runners = true;
};
template <class Real>
class ForgedRunners : public ForgedGasIn<Real, RunnersFromGiven> {};
TYPED_TEST_SUITE(ForgedRunners, tick_test::BothReals, tick_test::RealName);

/// All else agrees: nothing, gas colder than any or with a specific heat beyond any gas's.
TYPED_TEST(ForgedRunners, WithNoGasOrWithGasThatNoneIsAreRefused) {
  using Real = TypeParam;
  EXPECT_TRUE(accepted(this->load([](auto&) {})));
  for (const int port : {kIntake, kExhaust}) {
    for (const std::uint32_t k : {0u, 3u}) {
      EXPECT_TRUE(this->refused(
          [&](auto& s) { s.runner[port][k].contents = {}, s.runner[port][k].point.pressure_Pa = Real{0}; }));
      const auto at_K = [&](double kelvin) {
        return [port, k, kelvin](auto& s) {
          auto& runner = s.runner[port][k];
          const Real factor = static_cast<Real>(kelvin) / runner.point.temperature_K;
          runner.point.temperature_K *= factor, runner.point.pressure_Pa *= factor;
          runner.contents.energy_J *= factor, runner.contents.energy_rest_J = Real{0};
        };
      };
      EXPECT_TRUE(this->refused(at_K(49.9)));
      EXPECT_TRUE(accepted(this->load(at_K(50.1))));
      const auto of_ratio = [&](double ratio) {
        return [port, k, ratio](auto& s) { s.runner[port][k].point.gas_ratio = static_cast<Real>(ratio); };
      };
      EXPECT_TRUE(this->refused(of_ratio(0.1399)));
      EXPECT_TRUE(accepted(this->load(of_ratio(0.1401))));
    }
  }
}

TYPED_TEST(ForgedGas, OfARecordThatNoCycleLeavesIsRefused) {
  using Real = TypeParam;
  const auto real = [](double x) { return static_cast<Real>(x); };
  EXPECT_TRUE(this->refused([&](auto& s) { s.gas_record[2].trapped_kg = real(1e-30); }));
  EXPECT_TRUE(this->refused([&](auto& s) { s.gas_record[2].trapped_air_kg = -2 * s.gas_record[2].trapped_kg - 1; }));
  EXPECT_TRUE(this->refused([&](auto& s) { s.gas_record[2].work_J = real(1e18); }));
  EXPECT_TRUE(this->refused([&](auto& s) { s.gas_record[2].pumping_J = real(-1e18); }));
  EXPECT_TRUE(this->refused([&](auto& s) { s.gas_record[2].air_kg = real(1e18); }));
  EXPECT_TRUE(accepted(this->load([&](auto& s) { s.gas_record[2].work_J = real(1e12); })));
}

/// What flows back through the outlet, and what the cylinders took: in the limits of any gas, or refused.
TYPED_TEST(ForgedGas, BehindTheOutletIsRefusedOrFlowsBackInFiniteNumbers) {
  using Real = TypeParam;
  const auto out_of_range = [this](const auto& change) {
    return support::refuses(this->load(change), Reason::out_of_range, "state.gas");
  };
  for (const double kelvin : {49.0, 12001.0}) {
    EXPECT_TRUE(out_of_range([&](auto& s) { s.outlet.temperature_K = static_cast<Real>(kelvin); })) << kelvin;
  }
  for (const double ratio : {-0.001, 1.001}) {
    EXPECT_TRUE(out_of_range([&](auto& s) { s.outlet.burned_ratio = static_cast<Real>(ratio); })) << ratio;
  }
  for (const double kg_s : {-1.1e21, 1.1e21}) {
    for (const int port : {kIntake, kExhaust})
      EXPECT_TRUE(out_of_range([&](auto& s) { s.taken_kg_s[port] = static_cast<Real>(kg_s); })) << kg_s;
  }
  for (const double sign : {-1.0, 1.0}) {
    const Real taken_kg_s = static_cast<Real>(sign * 1e21);
    EXPECT_TRUE(accepted(this->load([&](auto& s) {
      s.outlet = {static_cast<Real>(sign > 0 ? 12000 : 50), static_cast<Real>(sign > 0 ? 1 : 0)};
      s.taken_kg_s[kIntake] = taken_kg_s, s.taken_kg_s[kExhaust] = -taken_kg_s;
    })));
    typename Engine<Real, scenes::Breathing>::Input in;
    in.speed_rad_s = 200, in.throttle_ratio = 0;
    bool flows_back = false;
    for (int tick = 0; tick < 1200; ++tick) {
      const auto& out = this->engine_->step(in);
      flows_back = flows_back || out.outlet_kg_s < 0;
      ASSERT_TRUE(finite(out)) << "tick " << tick;
    }
    EXPECT_TRUE(flows_back);
  }
}

}  // namespace
}  // namespace crankloop::forged_state_test
