// Assertions that fire: each is asked what does not hold, and is to say which condition failed.
//
// In the other tests they are on too where the preset has them (sanitize, debug, thread), and none may fire there.
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include <crankloop/assert.hpp>
#include <crankloop/phase.hpp>
#include <crankloop/tables/angle.hpp>
#include <crankloop/tables/curve.hpp>
#include <crankloop/tables/lift_curve.hpp>
#include <crankloop/tables/trigger_tables.hpp>
#include <crankloop/tables/valve_tables.hpp>
#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/crank/crank_step.hpp>
#include <crankloop/tick/crank/starter.hpp>
#include <crankloop/tick/state/saved_bytes.hpp>
#include <crankloop/tick/trigger/trigger_wheel.hpp>
#include <crankloop/tick/valve/event_location.hpp>
#include <crankloop/tick/valve/smooth_segment.hpp>
#include <crankloop/tick/valve/valves_work.hpp>
#include <tabulate/curve_fit.hpp>
#include <tabulate/monotone_cubic.hpp>
#include <tabulate/quadrature.hpp>

namespace crankloop::detail::assert_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Asked {
  const char* name;
  const char* condition;
  void (*ask)();
};
void PrintTo(const Asked& asked, std::ostream* out) { *out << asked.name; }

template <class T>
void use(const T& x) {
  volatile unsigned char first = *reinterpret_cast<const unsigned char*>(&x);
  (void)first;
}

// A valve of 0.1 kg on a train of 1e6 N/m, its tick of one part.
ValveMotion<double> valve_motion() {
  ValveMotion<double> m{};
  m.body = {0.1, 1e6, 0, 1e7, 0, 2e4, 0, 200, 2e-5, 0, 0, 10};
  m.tick_s = m.fine_step_s = 1e-5;
  m.per_fine_step_s = 1e5;
  m.parts = 1;
  m.per_parts = 1;
  m.cubic_deg = m.widest_step_deg = 360;
  return m;
}
using NoGas = NoGasForce<double>;
using Locator = EventLocator<double, NoGas, NoRecord<double>>;

void run_valve(const ValveInRegime<double>& start, const ValveMotion<double>& motion) {
  LiftCurve<double> curve{};
  EventBudget budget{4, false};
  NoRecord<double> none;
  use(Locator(motion, curve, budget, none).run(start, {start.state, 0}, {{}, {}, {}, {}, 0, 0}, 0, 0));
}

// A crank of 1 kg m^2 that stands, without friction.
struct Crank {
  Drive<double> drive{};
  CrankDynamics<double> dynamics{};
  group::CrankState<double> state{};
  double speed_rad_s = 0;
  Crank() {
    drive.tick_s = 1e-4;
    drive.speed_limit_rad_s = 1e3;
    drive.cycles_per_tick_per_rad_s = 1e-4 / 12.566;
    dynamics.turning_kg_m2 = 1;
    dynamics.most_rad_s2 = 1e6;
  }
  CrankStep<double> step() { return {drive, dynamics, state, speed_rad_s, 0}; }
};

TriggerTrack half_moon(const std::uint32_t* edges) {
  TriggerTrack wheel{};
  wheel.edges = edges;
  wheel.edge_count = 2;
  for (int part = 0; part < kTriggerParts; ++part)
    wheel.edges_before[part] = static_cast<std::uint16_t>(part == 0 ? 0 : part <= kTriggerParts / 2 ? 1 : 2);
  wheel.edges_before[kTriggerParts] = 2;
  return wheel;
}

const Asked kAsked[] = {
    {"ATurnPerTick", "cycles > -1 && cycles < 1", [] { use(Phase::from_cycles(1.5)); }},
    {"ATurnPerTickOfNoNumber", "cycles > -1 && cycles < 1", [] { use(Phase::from_cycles(kNaN)); }},
    {"ADegreeBeyondTheCycle", "cell.degree < std::uint32_t{kDegreesPerCycle}",
     [] {
       use(Angle<float>{{720, 0, 0}, 0}.turn_degree());
     }},
    {"ACylinderTwoTurnsLate", "turns <= 1",
     [] {
       use(Angle<float>{{0, 0, 0}, 0}.delayed(2));
     }},
    {"ASegmentOfADegreeWithoutAny", "count >= 1 && count <= 0xFFFF",
     [] {
       static const GasGrid kEmpty{};
       use(kEmpty.segment({5, 0, 0}));
     }},
    {"ACamBeyondItsTurn", "cell.degree < std::uint32_t{kDegreesPerTurn}",
     [] {
       use(LiftCurve<double>{}.read({360, 0, 0}));
     }},
    {"TheLobeOfACylinderTooMany", "cylinder < std::uint32_t{kMaxCylinders}",
     [] { use(LiftCurve<double>{}.cell(0, kMaxCylinders)); }},
    {"ALobeLongerThanATurn", "segments <= std::uint32_t{kDegreesPerTurn}",
     [] {
       LiftCurve<double> curve{};
       curve.segments = 361;
       use(curve.base_middle());
     }},
    {"ALimitThatIsNone", "most >= 0 && is_finite(most)", [] { use(within_magnitude(1.0, kInfinity)); }},
    {"AValveWithoutItsTrain", "b.train_N_m > 0 && b.seat_N_m > 0",
     [] { use(in_equilibrium(ValveMotion<double>{}, 0.0, 0.0)); }},
    {"ACamOfNoNumber", "is_finite(lift_m) && is_finite(gas_N)", [] { use(in_equilibrium(valve_motion(), kNaN, 0.0)); }},
    {"ARegimeThatIsNone", "start.regime < std::uint32_t{kRegimes}",
     [] {
       run_valve({{0, 0}, 5}, valve_motion());
     }},
    {"AValveOfNoLift", "is_finite(start.state.lift_m) && is_finite(start.state.velocity_m_s)",
     [] {
       run_valve({{kInfinity, 0}, 0}, valve_motion());
     }},
    {"AValveOfNoSpeed", "is_finite(start.state.lift_m) && is_finite(start.state.velocity_m_s)",
     [] {
       run_valve({{0, kNaN}, 0}, valve_motion());
     }},
    {"ATickOfNoParts", "motion_.parts >= 1",
     [] {
       ValveMotion<double> motion = valve_motion();
       motion.parts = 0;
       run_valve({{0, 0}, 0}, motion);
     }},
    {"TheQuietRegimeInAChange", "regime < kQuiet",
     [] {
       use(by_series(valve_motion(), kQuiet, {0, 0}, {0, 0, 0, 0}, 1.0, NoGas{}));
     }},
    {"BeyondTheEndOfASegment", "x >= 0 && x <= 1",
     [] {
       SmoothSegment<double> segment{};
       segment.d_s = 1;
       use(segment.at(1.5));
     }},
    {"ASegmentOfNoTime", "d_s > 0", [] { use(SmoothSegment<double>{}.at(0.5)); }},
    {"APieceOfNothing", "x > 0 && x <= 1", [] { Cubic<double>(0, 0, 1, 0).shrink(0); }},
    {"AnOpeningThatHasNoMoment", "from < kOpened_m && to >= kOpened_m",
     [] {
       ValveRecord<double> record;
       // The theory passes 0.1 mm, and the valve is there at both ends: no moment at which it opened.
       record.step({{kNaN, 0}, {1e-3, 0}, 0, 1e-3, 1, 1, 0, 0, 1e-4, kTrainOn}, 0, [](double) { return 0.0; });
     }},
    {"ACrankWithoutInertia", "at.inertia_kg_m2 > 0",
     [] {
       Crank crank;
       CrankStep<double> step = crank.step();
       use(step.turn(1, false));
       step.arrive({0, 0, 0, 0});
     }},
    {"GasOfNoNumber", "is_finite(gas_Nm)",
     [] {
       Crank crank;
       use(crank.step().turn(kNaN, false));
     }},
    {"WorkOfNoNumber", "is_finite(work_J)",
     [] {
       Crank crank;
       CrankStep<double> step = crank.step();
       use(step.turn(1, false));
       step.arrive({kInfinity, 0, 1, 0});
     }},
    {"AStarterThatBrakes", "stall_Nm >= 0 && slope_Nm_s >= 0",
     [] {
       use(Starter<double>{-1, 0, true}.torque_Nm(1));
     }},
    {"AWheelThatDoesNotBeginAtAnEdge", "wheel.edge_count >= 2 && wheel.edges[0] == 0",
     [] {
       const std::uint32_t edges[] = {7, 0x8000'0000u};
       use(edge_behind(half_moon(edges), 9));
     }},
    {"APartOfAWheelWithoutItsEdge", "low >= 1 && low <= wheel.edge_count && wheel.edges[low - 1] <= angle",
     [] {
       const std::uint32_t edges[] = {0, 0x8000'0000u};
       TriggerTrack wheel = half_moon(edges);
       wheel.edges_before[1] = wheel.edges_before[2] = 2;
       use(edge_behind(wheel, 1u << 25));
     }},
    {"MoreBytesThanTheField", "bytes >= 1 && bytes <= sizeof(T)",
     [] {
       unsigned char bytes[8];
       StateWriter(bytes).put(std::uint32_t{1}, 5);
     }},
    {"AFitThroughOnePointTwice", "u[i] > u[i - 1]",
     [] {
       const double u[] = {0, 0.5, 0.5};
       const double y[] = {0, 1, 1};
       use(through(u, y));
     }},
    {"AnIntegralBeyondItsCount", "units > -0x1p31 && units < 0x1p31 - 1", [] { use(base_of<float>(1e10, 1)); }},
    {"AnIntegralOfNoPanels", "panels >= 1", [] { use(integrate(0, 1, 0, [](double x) { return x; })); }},
    {"PointsThatGoBack", "h0 > 0 && h1 > 0",
     [] {
       use(monotone_slope({0, 0}, {1, 1}, {0.5, 2}));
     }},
};

const char* expected_condition = "";

class Assertion : public testing::TestWithParam<Asked> {};

TEST_P(Assertion, FiresAndSaysWhatDoesNotHold) {
  constexpr int kAsExpected = 77;
  expected_condition = GetParam().condition;
  assertion_handler = [](const char* condition, const char* file, int line) {
    if (std::strcmp(condition, expected_condition) == 0 && std::strstr(file, ".hpp") != nullptr && line > 0)
      _exit(kAsExpected);
  };
  EXPECT_EXIT(GetParam().ask(), testing::ExitedWithCode(kAsExpected), "");
}

TEST(Assertion, EndsTheProgramAndSaysWhere) {
  assertion_handler = print_assertion;
  EXPECT_DEATH(use(Phase::from_cycles(1.5)), "phase.hpp:[0-9]+: does not hold: cycles > -1 && cycles < 1");
}

INSTANTIATE_TEST_SUITE_P(Of, Assertion, testing::ValuesIn(kAsked),
                         [](const testing::TestParamInfo<Asked>& asked) { return asked.param.name; });

}  // namespace
}  // namespace crankloop::detail::assert_test
