// What the compiler can say of the interface: nothing throws, states and tables are plain data, a state has no padding,
// and the sizes that are promised.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

#include <crankloop/crankloop.hpp>

#include "contract/scenes/scenes.hpp"
#include "support/running.hpp"

namespace crankloop::interface_test {

using namespace detail;
namespace {

using namespace tick_test;

// ---- nothing throws -------------------------------------------------------------------------------------------------

template <class Real, class S>
constexpr bool nothing_throws() {
  using E = Engine<Real, S>;
  const E* constant = nullptr;
  E* engine = nullptr;
  const typename E::Tables* tables = nullptr;
  using Storage = TableStorage<Real, S>;
  constexpr bool init = noexcept(engine->init(*tables))&& noexcept(engine->init(*tables, Phase{}));
  constexpr bool step = noexcept(engine->step(std::declval<const typename E::Input&>()));
  constexpr bool output = noexcept(constant->output());
  constexpr bool state = noexcept(constant->state());
  constexpr bool restore = noexcept(engine->restore(constant->state()));
  constexpr bool build =
      noexcept(std::declval<Storage&>().build(std::declval<const EngineDefinition&>(), std::declval<TickOptions>()));
  constexpr bool tables_of = noexcept(std::declval<const Storage&>().tables());
  return init && step && output && state && restore && build && tables_of &&
         std::is_nothrow_default_constructible_v<E> && std::is_nothrow_copy_constructible_v<E> &&
         std::is_nothrow_copy_assignable_v<E> && std::is_nothrow_destructible_v<E>;
}
static_assert(noexcept(validate(std::declval<const EngineDefinition&>())));

/// Plain data: copied by memcpy, compared by memcmp, put anywhere, dropped without a destructor.
template <class Real, class S>
constexpr bool is_plain_data() {
  using E = Engine<Real, S>;
  return std::is_trivially_copyable_v<E> && std::is_trivially_copyable_v<typename E::State> &&
         std::is_trivially_copyable_v<typename E::Input> && std::is_trivially_copyable_v<typename E::Output> &&
         std::is_trivially_copyable_v<typename E::Tables> && std::is_trivially_destructible_v<E> &&
         !std::is_polymorphic_v<E>;
}
static_assert(std::is_trivially_copyable_v<EngineDefinition> && std::is_trivially_copyable_v<Status> &&
              std::is_trivially_copyable_v<Phase>);

template <class S>
constexpr bool keeps_its_promises() {
  return nothing_throws<float, S>() && nothing_throws<double, S>() && is_plain_data<float, S>() &&
         is_plain_data<double, S>();
}
static_assert(keeps_its_promises<PistonMotion>() && keeps_its_promises<TorqueOnly>() &&
              keeps_its_promises<ForcesAndTorque>() && keeps_its_promises<::ValveLift>() &&
              keeps_its_promises<ValveDynamics>() && keeps_its_promises<WholeEngine>() &&
              keeps_its_promises<TriggerSignals>() && keeps_its_promises<scenes::Whole>() &&
              keeps_its_promises<scenes::MeasuredMotion>() && keeps_its_promises<scenes::TorqueByTable>() &&
              keeps_its_promises<scenes::TorqueByPressure>() && keeps_its_promises<scenes::FreeRunning>() &&
              keeps_its_promises<scenes::Breathing>() && keeps_its_promises<scenes::BreathingFree>());

// ---- sizes ----------------------------------------------------------------------------------------------------------

// The promises of README.md and docs/measurements/host.md, on a machine with pointers of eight bytes.
static_assert(sizeof(Engine<float, TorqueOnly>) <= 128);
static_assert(sizeof(Engine<float, ValveDynamics>) <= 1904);  // where a processor has no lanes 1.4 kB less
static_assert(sizeof(Engine<float, WholeEngine>) <= 3840);    // 1.4 kB less

/// An engine is the address of its tables, its state, its output and what its valves' tick remembers, and nothing else.
template <class Real, class S>
constexpr bool has_no_hidden_member() {
  using E = Engine<Real, S>;
  std::size_t parts = sizeof(void*) + sizeof(typename E::State) + sizeof(typename E::Output);
  if (Needs<S>::elastic_valves) parts += sizeof(detail::ValvesWork<Real, S>);
  return sizeof(E) >= parts && sizeof(E) < parts + alignof(E);
}
static_assert(has_no_hidden_member<float, PistonMotion>() && has_no_hidden_member<float, WholeEngine>() &&
              has_no_hidden_member<double, WholeEngine>() && has_no_hidden_member<float, scenes::Whole>());

/// A group that a scene leaves out takes no room.
static_assert(sizeof(Output<float, Nothing>) == sizeof(std::uint32_t));
static_assert(sizeof(Input<float, Nothing>) == sizeof(float));
static_assert(sizeof(State<float, Nothing>) == sizeof(group::StateCore<float>));
static_assert(sizeof(Tables<float, Nothing>) == sizeof(void*));

/// Bytes that the members of a state need: fingerprint, phase, ticks, speed, load; pressures; work.
template <class Real, class S>
constexpr std::size_t state_bytes() {
  using N = Needs<S>;
  std::size_t bytes = 24 + 2 * sizeof(Real);
  const std::size_t even = (S::cylinders.capacity + 1) / 2 * 2;
  if (N::input_pressure) bytes += even * sizeof(Real);
  if (S::mean_torque) {
    const std::size_t integrals = 1 + (N::load ? 2 : 1) + (N::input_pressure ? S::cylinders.capacity : 1);
    bytes += (integrals * 2 + 2) * sizeof(Real);
  }
  return bytes;
}

template <class Real, std::uint32_t N>
constexpr bool kStatesWithoutPadding =
    sizeof(State<Real, Asking<kTorque, PressureGiven::by_table, false, CrankGiven::speed, N>>) ==
        state_bytes<Real, Asking<kTorque, PressureGiven::by_table, false, CrankGiven::speed, N>>() &&
    sizeof(State<Real, Asking<kAllGroups, PressureGiven::by_table, true, CrankGiven::speed, N>>) ==
        state_bytes<Real, Asking<kAllGroups, PressureGiven::by_table, true, CrankGiven::speed, N>>() &&
    sizeof(State<Real, Asking<kMeanTorque, PressureGiven::by_input, false, CrankGiven::phase, N>>) ==
        state_bytes<Real, Asking<kMeanTorque, PressureGiven::by_input, false, CrankGiven::phase, N>>() &&
    sizeof(State<Real, Asking<kForces, PressureGiven::by_input, false, CrankGiven::speed, N>>) ==
        state_bytes<Real, Asking<kForces, PressureGiven::by_input, false, CrankGiven::speed, N>>() &&
    sizeof(State<Real, Asking<kFreeForces, PressureGiven::none, false, CrankGiven::speed, N>>) ==
        state_bytes<Real, Asking<kFreeForces, PressureGiven::none, false, CrankGiven::speed, N>>();
static_assert(kStatesWithoutPadding<float, 1> && kStatesWithoutPadding<double, 1>);
static_assert(kStatesWithoutPadding<float, 3> && kStatesWithoutPadding<double, 3>);
static_assert(kStatesWithoutPadding<float, 4> && kStatesWithoutPadding<double, 4>);
static_assert(kStatesWithoutPadding<float, 15> && kStatesWithoutPadding<double, 15>);
static_assert(kStatesWithoutPadding<float, 16> && kStatesWithoutPadding<double, 16>);

TEST(EngineSize, OfAFourCylinderTorqueEngineInFloatFitsIn128Bytes) {
  using TorqueAlone = Asking<kTorque, PressureGiven::by_table, false, CrankGiven::speed, 4>;
  using TorqueBothWays = Asking<kTorque | kMeanTorque, PressureGiven::by_table, false, CrankGiven::speed, 4>;
  EXPECT_LE(sizeof(Engine<float, TorqueAlone>), 128u);
  EXPECT_LE(sizeof(Engine<float, TorqueBothWays>), 128u);
  // What a scene leaves out takes no room: tables, state, a torque and the faults.
  EXPECT_EQ(sizeof(Output<float, TorqueAlone>), 8u);
  EXPECT_EQ(sizeof(Output<float, TorqueBothWays>), 12u);
  EXPECT_EQ(sizeof(Engine<float, TorqueAlone>), sizeof(void*) + sizeof(State<float, TorqueAlone>) + 8u);
  EXPECT_EQ(sizeof(Input<float, TorqueBothWays>), 4u);
  EXPECT_EQ(sizeof(Output<float, Asking<0, PressureGiven::none>>), 4u);
}

// ---- padding --------------------------------------------------------------------------------------------------------

#if defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 11
#define CRANKLOOP_CAN_CLEAR_PADDING 1
#elif defined(__has_builtin)
#if __has_builtin(__builtin_clear_padding)
#define CRANKLOOP_CAN_CLEAR_PADDING 1
#endif
#endif

#if CRANKLOOP_CAN_CLEAR_PADDING

/// Fills an object with ones, has the compiler clear what belongs to no member, and counts the bytes that it cleared.
/// (The trait has_unique_object_representations is false for every floating-point member.)
template <class T>
std::size_t padding_bytes_of() {
  static T object;
  std::memset(static_cast<void*>(&object), 0xFF, sizeof object);
  __builtin_clear_padding(&object);
  unsigned char bytes[sizeof object];
  std::memcpy(bytes, static_cast<const void*>(&object), sizeof object);
  std::size_t cleared = 0;
  for (const unsigned char byte : bytes) cleared += byte == 0xFF ? 0 : 1;
  return cleared;
}

TEST(Padding, IsCountedWhereItIs) {
  struct Padded {
    std::uint64_t a;
    float b;
  };
  struct Inside {
    std::uint8_t a;
    double b;
  };
  struct Full {
    double a;
    float b, c;
  };
  EXPECT_EQ(padding_bytes_of<Padded>(), 4u);
  EXPECT_EQ(padding_bytes_of<Inside>(), 7u);
  EXPECT_EQ(padding_bytes_of<Full>(), 0u);
}

template <class S>
void expect_state_without_padding(const std::string& name) {
  EXPECT_EQ((padding_bytes_of<State<float, S>>()), 0u) << name << ", float";
  EXPECT_EQ((padding_bytes_of<State<double, S>>()), 0u) << name << ", double";
}

template <std::uint32_t Cylinders, std::uint32_t Trains, bool ByInput>
void expect_states_without_padding() {
  using S = LargeState<Cylinders, Trains, ByInput>;
  const std::string name = std::to_string(Cylinders) + " cylinders, " + std::to_string(Trains) + " trains" +
                           (ByInput ? ", pressure by input" : "");
  expect_state_without_padding<S>(name);
  expect_state_without_padding<WithoutResults<S>>(name + ", without results");
  expect_state_without_padding<WithoutValves<S>>(name + ", without valves");
}

TEST(Padding, IsNotInAnyState) {
  expect_states_without_padding<1, 1, false>();
  expect_states_without_padding<1, 1, true>();
  expect_states_without_padding<2, 3, true>();
  expect_states_without_padding<3, 1, false>();
  expect_states_without_padding<3, 3, true>();
  expect_states_without_padding<5, 4, true>();
  expect_states_without_padding<16, 4, true>();
  expect_state_without_padding<PistonMotion>("piston motion");
  expect_state_without_padding<TorqueOnly>("torque only");
  expect_state_without_padding<ForcesAndTorque>("forces and torque");
  expect_state_without_padding<::ValveLift>("valve lift");
  expect_state_without_padding<ValveDynamics>("valve dynamics");
  expect_state_without_padding<TriggerSignals>("trigger signals");
  expect_state_without_padding<WholeEngine>("the whole engine");
  expect_state_without_padding<scenes::Whole>("the ready-made whole");
}

#endif

}  // namespace
}  // namespace crankloop::interface_test
