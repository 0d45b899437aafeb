// The same bits everywhere: all tables of a 495-like engine, and 2000 ticks of it, have one hash each, whatever
// compiler, optimisation or machine built them, as long as it does not fuse multiply and add (-ffp-contract=off).
//
// A changed hash means that every user's tables or outputs change: count kTableFormat up
// (core/src/tabulate/fingerprint.hpp) and renew it (support/golden.hpp), which says so in the CHANGELOG.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "support/golden.hpp"
#include "support/output_numbers.hpp"
#include "support/running.hpp"
#include "support/status.hpp"

namespace crankloop::same_bits_test {

using namespace detail;
namespace {

using namespace tick_test;

/// FNV-1a over the bytes of numbers, least significant first, so that neither byte order nor padding counts.
class Fnv {
 public:
  void add(std::uint8_t x) { mix(x, 1); }
  void add(std::uint16_t x) { mix(x, 2); }
  void add(std::uint32_t x) { mix(x, 4); }
  void add(std::uint64_t x) { mix(x, 8); }
  void add(float x) {
    std::uint32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    add(bits);
  }
  void add(double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    add(bits);
  }
  template <class T, std::size_t N>
  void add(const T (&row)[N]) {
    for (const T& x : row) add(x);
  }
  template <class Real>
  void add(const Segment<Real>& s) {
    add(s.c);
  }
  template <class Real>
  void add(const IntegratedSegment<Real>& s) {
    add(s.base);
    add(s.slope);
  }
  template <class Real>
  void add(const IntegralSegment<Real>& s) {
    add(s.c);
  }
  template <class Real>
  void add(const MotionSegment<Real>& s) {
    add(s.displacement);
    add(s.slope);
    add(s.acceleration);
  }
  template <class Real>
  void add(const LeanSegment<Real>& s) {
    add(s.tilt);
    add(s.radial);
  }
  template <class Real>
  void add(const RodSegment<Real>& s) {
    add(s.angle);
    add(s.slope);
  }
  template <class Record>
  void add(const Revolution<Record>& curve) {
    add(curve.at);
  }
  template <class Real>
  void add(const IntegratedCurve<Real>& curve) {
    add(curve.quantum);
    add(curve.at);
  }
  template <class Real>
  void add(const RotatingVector<Real>& t) {
    for (const Real x :
         {t.up_cos, t.up_sin, t.lateral_cos, t.lateral_sin, t.pitch_cos, t.pitch_sin, t.yaw_cos, t.yaw_sin})
      add(x);
  }

  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  void mix(std::uint64_t x, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      hash_ ^= (x >> (8 * i)) & 0xFFu;
      hash_ *= 0x100000001B3u;
    }
  }
  std::uint64_t hash_ = 0xCBF29CE484222325u;
};

/// All sections but the fingerprint, which also changes where only the definition gains a field.
template <class Real>
std::uint64_t hash_of(const Sections<Real>& s) {
  Fnv fnv;
  const Drive<Real>& d = *s.drive;
  for (const Real x : {d.tick_s, d.cycles_per_tick_per_rad_s, d.rad_s_per_cycle_per_tick, d.speed_limit_rad_s})
    fnv.add(x);
  fnv.add(d.cylinders);
  fnv.add(d.mechanisms);
  fnv.add(d.firing_phase);
  fnv.add(d.mechanism_of);
  fnv.add(d.turn_of);
  const Body<Real>& b = *s.body;
  for (const Real x : {b.crank_radius_m, b.per_crank_radius, b.per_rod_length, b.pin_offset_m, b.height_at_tdc_m,
                       b.bore_area_m2, b.crankcase_Pa, b.reciprocating_kg, b.rod_inertia_correction_kg_m2}) {
    fnv.add(x);
  }
  fnv.add(*s.stroke);
  fnv.add(*s.motion);
  fnv.add(*s.lean);
  fnv.add(*s.rod);
  fnv.add(*s.rod_curvature);
  fnv.add(*s.inertia_torque);
  fnv.add(s.gas_grid->first);
  const std::size_t segments = s.gas_grid->first[kDegreesPerCycle];
  for (const Segment<Real>* pressures : {s.pressure_full, s.pressure_motored, s.pressure_heat}) {
    for (std::size_t i = 0; i < segments; ++i) fnv.add(pressures[i]);
  }
  fnv.add(s.torque_grid->first);
  const std::size_t torque_segments = s.torque_grid->first[kDegreesPerCycle];
  for (const GasTorque<Real>* torque : {s.gas_torque_full, s.gas_torque_motored, s.gas_torque_heat}) {
    fnv.add(torque->quantum);
    fnv.add(torque->mean_Nm);
    for (std::size_t i = 0; i < torque_segments; ++i) fnv.add(torque->at[i]);
  }
  const Bearings<Real>& bearings = *s.bearings;
  fnv.add(bearings.pins);
  for (std::size_t k = 0; k < d.cylinders; ++k) fnv.add(bearings.pin_of[k]);
  for (std::size_t i = 0; i < bearings.pins; ++i) {
    for (const Real x : {bearings.rods_kg_m[i], bearings.throw_kg_m[i], bearings.throw_cos[i], bearings.throw_sin[i]})
      fnv.add(x);
  }
  for (const RotatingVector<Real>& turning : {s.balance->first, s.balance->second, s.balance->rotating})
    fnv.add(turning);
  fnv.add(s.balance->cosine);
  return fnv.value();
}

/// Four cylinders like the 495's, with a pin offset and a rod inertia so that no term is zero. Numbers as literals: no
/// arithmetic before tabulate.
EngineDefinition like_the_495() {
  EngineDefinition engine;
  engine.crank = {0.095, 0.0575, 0.210, 0.0015, 19.0};
  engine.masses = {0.810, 0.505, 1.382, -0.0042, 3.1, 0.45};
  engine.layout.cylinders = 4;
  engine.layout.firing_deg = {0, 540, 180, 360};
  engine.layout.bank_deg = {2, 2, 2, 2};
  engine.layout.position_m = {0, 0.118, 0.24, 0.36};
  engine.pressure.source = PressureSource::wiebe;
  engine.pressure.crankcase_Pa = 101e3;
  engine.pressure.wiebe.net_mep_Pa = 809.7e3;
  return engine;
}

/// The engine's life: from standstill up to 240 rad/s, down through zero, backwards, with load steps and two bad
/// inputs. Speeds and loads are sums of binary fractions, so they are the same numbers in float and double.
template <class Real, class S>
std::uint64_t hash_of_run(const FullTables<Real>& tables) {
  Running<Real, S> run(tables, Phase{0x1234'5678'9ABC'DEF0u});
  const InUse use = in_use(tables);
  Fnv fnv;
  for (int tick = 0; tick < 2000; ++tick) {
    typename Engine<Real, S>::Input in;
    const int up = tick < 960 ? tick : 1920 - tick;
    in.speed_rad_s = static_cast<Real>(up) * static_cast<Real>(0.25);
    if (tick == 500) in.speed_rad_s = static_cast<Real>(3e9);
    if constexpr (Needs<S>::load) {
      in.load_ratio = static_cast<Real>(tick / 100 % 7) * static_cast<Real>(0.1875);
      if (tick == 700) in.load_ratio = Real{-1};
    }
    if constexpr (Needs<S>::input_pressure) {
      for (int k = 0; k < 4; ++k)
        in.pressure_Pa[k] = static_cast<Real>(100'000 + 1'000 * ((7 * tick + 311 * k) % 5'000));
    }
    const auto& out = run.engine.step(in);
    for (const Real x : numbers<kAllGroups>(out, use)) fnv.add(x);
    fnv.add(out.faults);
    fnv.add(run.engine.state().phase.units());
  }
  return fnv.value();
}

template <class Real>
class SameBits : public ::testing::Test {};
TYPED_TEST_SUITE(SameBits, BothReals, RealName);

template <class Real>
void expect_hash(const char* what, std::uint64_t hash) {
  support::expect_golden(std::string("like_the_495_") + what + (sizeof(Real) == 4 ? "_float" : "_double"),
                         support::hex(hash) + "\n");
}

TYPED_TEST(SameBits, OfAllTables) {
  using Real = TypeParam;
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(like_the_495(), 100e-6)));
  expect_hash<Real>("tables", hash_of(tables.sections()));
  expect_hash<Real>("fingerprint", tables.drive().fingerprint);
}

TYPED_TEST(SameBits, OfTwoThousandTicksOnADiagram) {
  using Real = TypeParam;
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(like_the_495(), 100e-6)));
  const std::uint64_t hash = hash_of_run<Real, Asking<kAllGroups, PressureGiven::by_table, true>>(tables);
  expect_hash<Real>("ticks_by_table", hash);
}

TYPED_TEST(SameBits, OfTwoThousandTicksOnPressuresFromOutsideWithoutForces) {
  using Real = TypeParam;
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(like_the_495(), 100e-6)));
  constexpr unsigned kGroups = kTorque | kMeanTorque | kKinematics;
  const std::uint64_t hash = hash_of_run<Real, Asking<kGroups, PressureGiven::by_input>>(tables);
  expect_hash<Real>("ticks_by_input", hash);
}

TYPED_TEST(SameBits, OfTheTablesOfAMeasuredDiagram) {
  using Real = TypeParam;
  // Rows every 5 deg: whole kPa, a compression, a peak, an expansion. The motored curve retraces it by volume.
  constexpr int kkPa[] = {5900, 7600, 7900, 6800, 5400, 4200, 3300, 2600, 2100, 1750, 1480, 1260,
                          1090, 950,  840,  750,  670,  610,  560,  510,  470,  440,  410,  390,
                          370,  350,  320,  280,  240,  210,  180,  160,  145,  135,  128,  122};
  std::vector<DiagramPoint> rows;
  for (int i = 0; i < 144; ++i) {
    int pressure = 105;                                  // exhaust
    if (i < 36) pressure = kkPa[i];                      // expansion
    if (i >= 72) pressure = 98;                          // intake
    if (i > 108) pressure = 98 + (i - 108) * (i - 108);  // compression: no polytrope, but the same on every machine
    if (i > 136) pressure = 98 + 784 + 600 * (i - 136);
    rows.push_back({5.0 * i, 1000.0 * pressure});
  }
  EngineDefinition engine = like_the_495();
  engine.pressure.source = PressureSource::angle_table;
  engine.pressure.points = rows.data();
  engine.pressure.point_count = 144;
  FullTables<Real> tables;
  ASSERT_TRUE(accepted(tables.build(engine, 50e-6, 2000)));
  expect_hash<Real>("measured_tables", hash_of(tables.sections()));
}

}  // namespace
}  // namespace crankloop::same_bits_test
