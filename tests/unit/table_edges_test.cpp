// The tick's tables at their edges: one unit before, on and after every knot, every end of a lobe and the cycle's own
// end.
//
// Each test is named after a bug that table code of others has had: an index off by one at the last knot, a cast before
// its range check, another answer beyond the end from one table to the next, a NaN that came in with a row.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "support/both_reals.hpp"
#include "support/kept_engines.hpp"
#include "support/status.hpp"

namespace crankloop::table_edges_test {

using namespace detail;
namespace {

using namespace tick_test;

template <class Real>
class TableEdges : public ::testing::Test {
 protected:
  static std::vector<double> outputs_at(std::uint64_t units) {
    static Engine<Real, FourAtAnAngle> engine;
    EXPECT_TRUE(accepted(engine.init(tables_of_four<Real, FourAtAnAngle>().tables(), Phase{units})));
    typename Engine<Real, FourAtAnAngle>::Input in;
    in.crank = Phase{units};
    std::vector<double> all;
    support::each_output(engine.step(in), kAllOfFour,
                         [&all](const char*, std::size_t, auto x) { all.push_back(static_cast<double>(x)); });
    return all;
  }
  static std::vector<std::string> names() {
    std::vector<std::string> all;
    support::each_output(Output<Real, FourAtAnAngle>{}, kAllOfFour, [&all](const char* name, std::size_t i, auto) {
      all.push_back(name + ("[" + std::to_string(i) + "]"));
    });
    return all;
  }

  /// Where something begins or ends: all degrees of the cycle, and of every lobe.
  static std::vector<std::uint64_t> edges() {
    std::vector<std::uint64_t> all;
    for (unsigned deg = 0; deg < 720; ++deg) all.push_back(phase_at_deg(deg).units());
    for (std::uint32_t t = 0; t < 2; ++t) {
      const LiftCurve<Real>& curve = tables_of_four<Real, FourAtAnAngle>().tables().lift_curves[t];
      for (std::uint32_t k = 0; k < 4; ++k) {
        for (unsigned deg = 0; deg <= curve.segments; ++deg)
          all.push_back(curve.opens[k] + phase_at_deg(2 * deg).units());
      }
    }
    return all;
  }
};
TYPED_TEST_SUITE(TableEdges, BothReals, RealName);

TYPED_TEST(TableEdges, HaveNoIndexOffByOneAtTheLastKnotNorAtAnyOther) {
  // From one unit to the next nothing may change but by rounding, which sixteen operations of float make 1e-6: also the
  // cycle's first and last unit are neighbours. A segment too far would be a degree off, which shows in every curve
  // that is not level there.
  const std::vector<std::string> names = this->names();
  std::vector<double> least = this->outputs_at(0);
  std::vector<double> most = least;
  for (unsigned deg = 0; deg < 720; ++deg) {
    const std::vector<double> now = this->outputs_at(phase_at_deg(deg).units());
    for (std::size_t i = 0; i < now.size(); ++i)
      least[i] = std::min(least[i], now[i]), most[i] = std::max(most[i], now[i]);
  }
  double worst = 0;
  for (const std::uint64_t edge : this->edges()) {
    const std::vector<double> before = this->outputs_at(edge - 1);
    const std::vector<double> on = this->outputs_at(edge);
    const std::vector<double> after = this->outputs_at(edge + 1);
    for (std::size_t i = 0; i < on.size(); ++i) {
      // Contact regimes are no curves, and a valve at rest trembles by rounding.
      if (names[i].rfind("regime", 0) == 0 || names[i].rfind("valve_", 0) == 0 || most[i] == least[i]) continue;
      const double apart = std::max(std::fabs(on[i] - before[i]), std::fabs(after[i] - on[i])) / (most[i] - least[i]);
      worst = std::max(worst, apart);
      EXPECT_LE(apart, 1e-6) << names[i] << " at " << static_cast<double>(deg_of(Phase{edge})) << " deg";
    }
  }
  std::printf("[ figures  ] largest change of any output from one unit to the next: %.1e of its range\n", worst);
}

TYPED_TEST(TableEdges, AnswerTheSameBeyondTheirEndWhateverIsAsked) {
  // One unit beyond the lobe: minus the clearance, level, without curvature, in all three ways to read a lift.
  using Real = TypeParam;
  const auto& tables = tables_of_four<Real, FourAtAnAngle>().tables();
  for (std::uint32_t t = 0; t < 2; ++t) {
    const LiftCurve<Real>& curve = tables.lift_curves[t];
    // 2^64 = 360 cam degrees. The first unit of the next degree that the scalar tells from the last of this: float
    // reads the top word.
    const std::uint64_t last = phase_at_deg(2 * curve.segments).units();
    const std::uint64_t end = last + (sizeof(Real) == 4 ? std::uint64_t{1} << 32 : 1);
    for (const std::uint64_t beyond : {end, end + 1, ~std::uint64_t{0}, end + (~std::uint64_t{0} - end) / 2}) {
      const Cell cell = LiftCurve<Real>::cell(beyond);
      const Lift<Real> lift = curve.read(cell);
      EXPECT_EQ(lift.lift_m, curve.outside_m);
      EXPECT_EQ(lift.per_deg_m, 0);
      EXPECT_EQ(curve.curvature(cell), 0);
      EXPECT_GE(cell.degree - curve.touch_from, curve.touch_degrees);
    }
    // And one unit inside, the last segment: near the same.
    const Lift<Real> inside = curve.read(LiftCurve<Real>::cell(last - 1));
    EXPECT_NEAR(static_cast<double>(inside.lift_m), static_cast<double>(curve.outside_m), 1e-9);
    EXPECT_NEAR(static_cast<double>(inside.per_deg_m), 0, 1e-9);
  }
}

TYPED_TEST(TableEdges, AreNotReachedByACastBeforeItsRangeCheck) {
  // Under the sanitizers a cast of these to an integer ends the test; without them it would be any index.
  using Real = TypeParam;
  using Limits = std::numeric_limits<Real>;
  const auto hurt = started_four<Real, FourWithValves>(phase_at_deg(33));
  const auto sound = started_four<Real, FourWithValves>(phase_at_deg(33));
  for (const Real huge : {Limits::max(), Limits::lowest(), Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(),
                          static_cast<Real>(0x1p31), static_cast<Real>(0x1p32), static_cast<Real>(0x1p63),
                          static_cast<Real>(-0x1p63), static_cast<Real>(0x1p64)}) {
    typename Engine<Real, FourWithValves>::Input in;
    const auto& want = sound->step(in);
    in.speed_rad_s = huge;
    in.load_ratio = huge;
    for (Real& deg : in.cam_phase_deg) deg = huge;
    const auto& out = hurt->step(in);
    EXPECT_EQ(out.faults, std::uint32_t{kFaultSpeed} | std::uint32_t{kFaultLoadRatio} | std::uint32_t{kFaultCamPhase})
        << huge;
    EXPECT_EQ(bits_now(out), bits_now(want)) << huge;
    EXPECT_EQ(hurt->state().phase.units(), sound->state().phase.units()) << huge;
  }
}

TYPED_TEST(TableEdges, OfADiagramAreNotMadeOfNaNRows) {
  using Real = TypeParam;
  for (const PressureSource source : {PressureSource::angle_table, PressureSource::volume_table}) {
    for (const bool in_angle : {true, false}) {
      std::vector<DiagramPoint> rows;
      for (int deg = 0; deg < 720; deg += 5) rows.push_back({static_cast<double>(deg), 1e5});
      (in_angle ? rows[17].at : rows[17].pressure_Pa) = std::numeric_limits<double>::quiet_NaN();
      EngineDefinition engine = four_with_valves();
      engine.pressure = {};
      engine.pressure.source = source;
      engine.pressure.points = rows.data();
      engine.pressure.point_count = static_cast<int>(rows.size());
      const auto tables = std::make_unique<TableStorage<Real, FourWithValves>>();
      EXPECT_TRUE(support::refuses(tables->build(engine, {50e-6, {}}), Reason::not_finite, "pressure.points", 17));
      Engine<Real, FourWithValves> on_them;
      EXPECT_FALSE(on_them.init(tables->tables()).ok()) << "tables of a refused build are none";
    }
  }
}

}  // namespace
}  // namespace crankloop::table_edges_test
