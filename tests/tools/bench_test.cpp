// `crankloop bench`: its statistics, what it writes, and whether the errors it tells are true, by other ways than its
// own.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include <crankloop/tabulate/mechanism.hpp>

#include "crankloop/engine_file/engine_file.hpp"
#include "crankloop/files/error.hpp"
#include "lab/bench/bench_report.hpp"
#include "lab/bench/engines.hpp"
#include "lab/bench/groups.hpp"
#include "lab/bench/kernels.hpp"
#include "lab/bench/motion_methods.hpp"
#include "lab/bench/race.hpp"
#include "lab/bench/row.hpp"
#include "lab/bench/tick_engines.hpp"
#include "lab/bench/true_lift.hpp"
#include "support/files.hpp"
#include "support/random.hpp"
#include "support/status.hpp"

namespace crankloop::program::bench::bench_test {
namespace {

// ---- statistics -----------------------------------------------------------------------------------------------------

TEST(BenchStatistics, MedianAndQuartilesOfAKnownSample) {
  std::vector<double> sample{9, 1, 5, 3, 7};
  const Timing timing = timing_of(sample);
  EXPECT_EQ(timing.median_ns, 5);
  EXPECT_EQ(timing.spread_ns, 4);  // 7 - 3
  std::vector<double> even{4, 1, 3, 2};
  EXPECT_EQ(quantile(even, 0.5), 2.5);
  EXPECT_EQ(quantile(even, 0), 1);
  EXPECT_EQ(quantile(even, 1), 4);
  std::vector<double> one{6};
  EXPECT_EQ(timing_of(one).spread_ns, 0);
}

TEST(BenchStatistics, MiddleMeanForgetsTheTickThatAnotherProgramTook) {
  std::vector<double> sample{10, 20, 10, 20, 10, 20, 10, 1e6};
  EXPECT_EQ(middle_mean(sample), 15);  // of 10, 10, 20, 20
  std::vector<double> one{7};
  EXPECT_EQ(middle_mean(one), 7);
}

/// Dependent additions: they cannot overlap.
void add_up(int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    sum += 1;
    keep(sum);
  }
}

TEST(BenchRace, TellsAContestantOfFourTimesTheWorkFromOneOfOnce) {
  const Effort effort{15, 50e3};
  const std::vector<Timing> timings =
      race({{[] { add_up(1000); }, 1}, {[] { add_up(4000); }, 1}, {[] { add_up(4000); }, 4}}, effort);
  // Whatever else the machine does, it does to all of them: the margins are for rounds in which it did so unevenly.
  EXPECT_GT(timings[1].median_ns, 2 * timings[0].median_ns);
  EXPECT_LT(timings[1].median_ns, 8 * timings[0].median_ns);
  EXPECT_GT(timings[2].median_ns, 0.5 * timings[0].median_ns);
  EXPECT_LT(timings[2].median_ns, 2 * timings[0].median_ns);
}

TEST(BenchRace, EveryContestantHasItsTurnInEveryRound) {
  std::vector<int> turns(3);
  std::vector<Contestant> contestants;
  for (int& turn : turns) contestants.push_back({[&turn] { ++turn; }, 1});
  const Effort effort{20, 0};  // one batch a turn
  (void)race(contestants, effort);
  for (const int turn : turns) EXPECT_EQ(turn, 2 + effort.rounds);  // two to warm up
}

TEST(BenchRace, MeasuresNothingWhereOnlyErrorsAreAskedFor) {
  int calls = 0;
  const std::vector<Timing> timings = race({{[&calls] { ++calls; }, 1}}, kErrorsOnly);
  EXPECT_EQ(calls, 0);
  EXPECT_TRUE(std::isnan(timings.at(0).median_ns));
}

TEST(BenchFront, IsWhatNoOtherPointBeatsInBoth) {
  support::Random random;
  for (int draw = 0; draw < 200; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    std::vector<Work> points;
    for (int i = random.whole(1, 30); i > 0; --i) points.push_back({random.between(1, 9), random.between(1, 9)});
    const std::vector<Work> front = pareto_front(points);
    for (const Work& p : points) {
      const bool beaten = std::any_of(points.begin(), points.end(),
                                      [&](const Work& q) { return q.time < p.time && q.error < p.error; });
      const bool on_front = std::any_of(front.begin(), front.end(),
                                        [&](const Work& q) { return q.time == p.time && q.error == p.error; });
      EXPECT_EQ(on_front, !beaten);
    }
    EXPECT_TRUE(
        std::is_sorted(front.begin(), front.end(), [](const Work& a, const Work& b) { return a.time < b.time; }));
  }
}

// ---- what it writes -------------------------------------------------------------------------------------------------

/// Reads JSON as far as its grammar goes (RFC 8259); counts objects.
class JsonReader {
 public:
  explicit JsonReader(const std::string& text) : text_{text} {}

  [[nodiscard]] bool valid() {
    const bool good = value();
    skip();
    return good && at_ == text_.size();
  }
  [[nodiscard]] int objects() const { return objects_; }

 private:
  void skip() {
    while (at_ < text_.size() && std::string(" \n\r\t").find(text_[at_]) != std::string::npos) ++at_;
  }
  [[nodiscard]] bool take(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  [[nodiscard]] bool word(const std::string& w) {
    skip();
    if (text_.compare(at_, w.size(), w) != 0) return false;
    at_ += w.size();
    return true;
  }
  [[nodiscard]] bool list(char end, bool named) {
    if (take(end)) return true;
    do {
      if (named && !(string() && take(':'))) return false;
      if (!value()) return false;
    } while (take(','));
    return take(end);
  }
  [[nodiscard]] bool string() {
    if (!take('"')) return false;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '"') return ++at_, true;
      if (static_cast<unsigned char>(c) < 0x20) return false;
      if (c != '\\') continue;
      ++at_;
      if (at_ < text_.size() && text_[at_] == 'u') {
        for (int i = 0; i < 4; ++i) {
          if (++at_ >= text_.size() || std::isxdigit(static_cast<unsigned char>(text_[at_])) == 0) return false;
        }
      } else if (at_ >= text_.size() || std::string("\"\\/bfnrt").find(text_[at_]) == std::string::npos) {
        return false;
      }
    }
    return false;
  }
  [[nodiscard]] bool digits() {
    const std::size_t first = at_;
    while (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    return at_ > first;
  }
  [[nodiscard]] bool number() {
    skip();
    if (at_ < text_.size() && text_[at_] == '-') ++at_;
    if (!digits()) return false;
    if (at_ < text_.size() && text_[at_] == '.' && (++at_, !digits())) return false;
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      ++at_;
      if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) ++at_;
      return digits();
    }
    return true;
  }
  [[nodiscard]] bool value() {
    skip();
    if (at_ >= text_.size()) return false;
    if (text_[at_] == '{') return ++objects_, ++at_, list('}', true);
    if (text_[at_] == '[') return ++at_, list(']', false);
    if (text_[at_] == '"') return string();
    return word("null") || word("true") || word("false") || number();
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int objects_ = 0;
};

std::vector<Row> awkward_rows() {
  Row plain{"valve", "located RK4", "float", "12000 rpm, 10 us", "cam cycle", 123.4, 5.6, 1e-9, "um"};
  Row hostile{"a \"group\"", "back\\slash", "double", "line\nand\ttab", "tick"};
  hostile.ns_median = std::numeric_limits<double>::infinity();
  Row ratio = plain;
  ratio.ratio = 7.5;
  return {plain, hostile, ratio};
}

TEST(BenchJson, IsAnArrayOfObjectsWhateverTheRowsSay) {
  const std::string json = to_json(awkward_rows());
  JsonReader reader(json);
  EXPECT_TRUE(reader.valid()) << json;
  EXPECT_EQ(reader.objects(), 3);
  for (const char* field :
       {"group", "contestant", "real", "setting", "ns_median", "ns_spread", "error", "error_unit"}) {
    EXPECT_NE(json.find(std::string("\"") + field + "\": "), std::string::npos) << field;
  }
  EXPECT_NE(json.find("\"ns_median\": null"), std::string::npos);
  EXPECT_NE(json.find("\"ratio\": 7.5"), std::string::npos);

  const std::string empty = to_json({});
  EXPECT_TRUE(JsonReader(empty).valid());
}

TEST(BenchJson, TheReaderOfThisTestRefusesWhatIsNone) {
  for (const std::string text : {"[", "[1,]", "{\"a\" 1}", "{\"a\": nan}", "[\"\n\"]", "[1] 2", "[1.]"})
    EXPECT_FALSE(JsonReader(text).valid()) << text;
}

TEST(BenchCsv, HasARowForEach) {
  const support::TemporaryFolder folder;
  {
    Output out(folder / "bench.csv");
    write_csv(out, {awkward_rows()[0], awkward_rows()[2]});
    out.finish();
  }
  std::ifstream file(folder / "bench.csv");
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[1], "valve,located RK4,float,12000 rpm; 10 us,cam cycle,123.400002,5.5999999,9.99999972e-10,um,");
  EXPECT_EQ(lines[2], "valve,located RK4,float,12000 rpm; 10 us,cam cycle,123.400002,5.5999999,9.99999972e-10,um,7.5");
}

TEST(BenchRow, ANameThatIsNotThereIsADefect) {
  EXPECT_THROW((void)find(awkward_rows(), "valve", "located RK4", "double", "12000 rpm, 10 us"), std::logic_error);
  EXPECT_EQ(find(awkward_rows(), "valve", "located RK4", "float", "12000 rpm, 10 us").ns_median, 123.4);
}

TEST(BenchKernel, EachRunsAndAnUnknownOneIsTheUsersError) {
  for (const Kernel& kernel : kernels()) EXPECT_NO_THROW(run_kernel(kernel.name, 10)) << kernel.name;
  EXPECT_THROW(run_kernel("no such kernel", 10), UsageError);
}

// ---- whether its errors are true ------------------------------------------------------------------------------------

TEST(BenchEngines, AreThoseOfTheSampleFiles) {
  const EngineFile file = read_engine_file(CRANKLOOP_SOURCE_DIR "/tools/engines/ohc_125.ini", {"crank", "masses"});
  const ValveTrain theirs = file.train("intake").definition;
  const ValveTrain ours = ohc_125_train();
  EXPECT_EQ(ours.cam.max_lift_m, theirs.cam.max_lift_m);
  EXPECT_EQ(ours.cam.half_angle_deg, theirs.cam.half_angle_deg);
  EXPECT_EQ(ours.cam.full_lift_deg, theirs.cam.full_lift_deg);
  ASSERT_EQ(ours.cam.exponent_count, theirs.cam.exponent_count);
  for (int i = 0; i < ours.cam.exponent_count; ++i) EXPECT_EQ(ours.cam.exponents[i], theirs.cam.exponents[i]);
  const auto rocker = [](const Rocker& r) {
    return std::vector<double>{r.base_circle_m, r.clearance_m,      r.pivot_to_pad_m, r.pivot_to_cam_m,
                               r.pad_radius_m,  r.pivot_to_screw_m, r.screw_ball_m,   r.stem_above_pivot_m};
  };
  const auto valve = [](const Valve& v) {
    return std::vector<double>{v.valve_kg,           v.spring_kg,           v.rocker_inertia_kg_m2,
                               v.spring_N_m,         v.spring_preload_N,    v.train_N_m,
                               v.seat_N_m,           v.train_damping_ratio, v.guide_damping_ratio,
                               v.seat_damping_ratio, v.head_area_m2};
  };
  constexpr double kRounding = 1e-14;  // of units: millimetres there, metres here
  for (std::size_t i = 0; i < rocker(ours.rocker).size(); ++i)
    EXPECT_NEAR(rocker(ours.rocker)[i], rocker(theirs.rocker)[i], kRounding) << i;
  for (std::size_t i = 0; i < valve(ours.valve).size(); ++i) {
    EXPECT_NEAR(valve(ours.valve)[i], valve(theirs.valve)[i], kRounding * valve(theirs.valve)[i]) << i;
  }
  const EngineDefinition engine = engine_of(4, 2);
  EXPECT_NEAR(engine.crank.crank_radius_m, file.definition().crank.crank_radius_m, kRounding);
  EXPECT_NEAR(engine.crank.rod_length_m, file.definition().crank.rod_length_m, kRounding);
  EXPECT_NEAR(engine.masses.reciprocating_kg(), file.definition().masses.reciprocating_kg(), kRounding);

  const EngineFile diesel = read_engine_file(CRANKLOOP_SOURCE_DIR "/tools/engines/diesel_495.ini", {"crank"});
  EXPECT_NEAR(diesel_495_crank().crank_radius_m, diesel.definition().crank.crank_radius_m, kRounding);
  EXPECT_NEAR(diesel_495_crank().rod_length_m, diesel.definition().crank.rod_length_m, kRounding);
}

TEST(BenchMotion, TheReferenceIsTheExactPoseOfTheLibrarysSetUp) {
  const Crank crank = diesel_495_crank();
  const ExactMotion<long double> reference(crank);
  for (int degree = 0; degree < 720; ++degree) {
    const auto phase = (static_cast<std::uint64_t>(degree) << 32) / 720 << 32;
    const Motion<long double> m = true_motion(reference, phase);
    const Pose<double> pose = exact_pose(crank, static_cast<double>(phase) * (4 * kPi / 0x1p64));
    constexpr double kRounding_m = 1e-16;  // of lengths of some centimetres
    EXPECT_NEAR(static_cast<double>(m.x), pose.displacement_m, 10 * kRounding_m);
    EXPECT_NEAR(static_cast<double>(m.v), pose.slope_m, 10 * kRounding_m);
    EXPECT_NEAR(static_cast<double>(m.a), pose.acceleration_m, 10 * kRounding_m);
  }
}

/// A chord misses its curve by f'' h^2 / 8; the acceleration bends the most of the three.
TEST(BenchMotion, LinearTablesErrAsTheirChordsDo) {
  const Crank crank = diesel_495_crank();
  double most_bent_m = 0;
  constexpr double kStep_rad = 1e-3;
  for (double a = 0; a < 2 * kPi; a += kStep_rad) {
    const auto acceleration = [&](double at) { return exact_pose(crank, at).acceleration_m; };
    most_bent_m = std::max(most_bent_m,
                           std::fabs(acceleration(a - kStep_rad) - 2 * acceleration(a) + acceleration(a + kStep_rad)) /
                               (kStep_rad * kStep_rad));
  }
  const double width_rad = kPi / 180;
  const double expected = most_bent_m * width_rad * width_rad / 8 / crank.crank_radius_m;

  const std::vector<Row> rows = kinematics_rows(kErrorsOnly);
  constexpr double kSampling = 0.01;  // of the error: the worst of 200 000 phases against the worst there is
  EXPECT_NEAR(find(rows, "kinematics", "linear", "double", "1 deg").error, expected, kSampling * expected);
  EXPECT_NEAR(find(rows, "kinematics", "linear", "double", "0.5 deg").error, expected / 4, kSampling * expected / 4);
  // The README's largest errors are of all cranks; the 495 is one of them.
  EXPECT_LT(find(rows, "kinematics", "library", "float", "1 deg").error, 2.6e-7);
  EXPECT_LT(find(rows, "kinematics", "library", "double", "1 deg").error, 7.1e-10);
  EXPECT_GT(find(rows, "kinematics", "library", "float", "1 deg").error, 1e-8);  // it was measured
}

/// The benchmark's worth: errors.csv, which tests/contract/bench/bench.sh holds to what the program says, shows the
/// library accurate where plain methods are not.
TEST(BenchErrors, OfTheLibraryAreFarBelowThoseOfPlainMethods) {
  std::ifstream file(CRANKLOOP_SOURCE_DIR "/tests/contract/bench/errors.csv");
  const auto error_of = [&](const std::string& row) {
    file.clear();
    file.seekg(0);
    for (std::string line; std::getline(file, line);) {
      if (line.rfind(row + ",", 0) == 0) return std::strtod(line.c_str() + row.size() + 1, nullptr);
    }
    ADD_FAILURE() << "no row " << row;
    return std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_GE(error_of("kinematics,linear,float,1 deg"), 100 * error_of("kinematics,library,float,1 deg"));
  EXPECT_LE(error_of("valve,located exponential,float,12000 rpm; 10 us"), 0.2);
  EXPECT_LE(error_of("valve,located RK4,float,12000 rpm; 10 us"), 1);
  EXPECT_GE(error_of("valve,textbook RK4,float,12000 rpm; 10 us"), 10);
}

/// The kept motion answers between its moments as the reference does when it is stepped there.
TEST(BenchTrueLift, IsTheReferencesMotionAtAnyAngle) {
  const ValveTrain train = ohc_125_train();
  ValveLift lift;
  ASSERT_TRUE(accepted(lift.init(train.cam, train.rocker)));
  for (const double rpm : {kSwitching_rpm, kBouncing_rpm}) {
    const TrueLift truth(train, rpm);
    const double deg_per_s = rpm * 3;
    support::Random random;
    for (int draw = 0; draw < 8; ++draw) {
      SCOPED_TRACE(random.trace(draw));
      const double cam_deg = random.between(-80, 180);
      valve_reference::Reference reference(
          valve_reference::SingleMass(train.valve, train.rocker, lift.largest_lift_m()),
          valve_reference::TurnedCam(lift));
      reference.advance((cam_deg + 180) / deg_per_s, -180, cam_deg);
      constexpr double kConverged_m = 1e-11;  // both: their steps differ
      EXPECT_NEAR(truth.lift_m(cam_deg), reference.y, kConverged_m);
    }
  }
}

/// A valve that floats has not come to rest when its cam comes again: the error of the first cycle is not all.
TEST(BenchTrueLift, GoesOnUntilTheErrorOfABouncingValveHasSettled) {
  const ValveTrain train = ohc_125_train();
  EXPECT_EQ(TrueLift(train, kSmooth_rpm).cycles(), 1);
  EXPECT_EQ(TrueLift(train, kSwitching_rpm).cycles(), 1);
  const TrueLift truth(train, kBouncing_rpm);
  EXPECT_EQ(truth.cycles(), 12);
  ValveLift lift;
  ASSERT_TRUE(accepted(lift.init(train.cam, train.rocker)));
  valve_reference::Reference reference(valve_reference::SingleMass(train.valve, train.rocker, lift.largest_lift_m()),
                                       valve_reference::TurnedCam(lift));
  const double later_deg = 20 + 5 * 360.0;  // the sixth cycle
  reference.advance((later_deg + 180) / (kBouncing_rpm * 3), -180, later_deg);
  EXPECT_NEAR(truth.lift_m(later_deg), reference.y, 1e-10);
  EXPECT_GT(std::fabs(truth.lift_m(later_deg) - truth.lift_m(20)), 1e-6) << "the first cycle is another";
}

TEST(BenchPlainValve, ItsMatrixIsItsTextbookStepInTheRegimeThatItWasMadeFor) {
  const LibraryValve<double, LoneElastic> valve(ValveRun{kSmooth_rpm, 10e-6});
  const PlainBody<double> body = plain_body(valve.tables().valve_motions[0].body);
  support::Random random;
  for (int draw = 0; draw < 1000; ++draw) {
    SCOPED_TRACE(random.trace(draw));
    const double h = random.between(1e-6, 30e-6);
    const PlainState<double> state{random.between(1e-3, 7e-3), random.between(-1, 1)};
    const double gap = 50e-6;  // presses throughout: train on, seat off
    const PlainCam<double> from{state.lift_m + gap, state.velocity_m_s};
    const PlainCam<double> to{from.lift_m + h * from.speed_m_s, from.speed_m_s};
    const PlainCam<double> middle{(from.lift_m + to.lift_m) / 2, from.speed_m_s};
    const auto f = [&](double y, double v, PlainCam<double> cam) {
      return plain_acceleration(body, 1 / body.mass_kg, y, v, cam);
    };
    const PlainState<double> textbook =
        textbook_step(f, h, state, f(state.lift_m, state.velocity_m_s, from), middle, to);
    const PlainState<double> matrix = plain_matrix<double>(body, kPlainTrain, h).step(state, from, to);
    constexpr double kRounding = 1e-11;  // a lift times the train's stiffness is a hundred thousand N
    EXPECT_NEAR(matrix.lift_m, textbook.lift_m, kRounding * 1e-3);
    EXPECT_NEAR(matrix.velocity_m_s, textbook.velocity_m_s, kRounding);
  }
}

/// Two codes that share nothing but the equations.
TEST(BenchPlainEngine, GivesTheOutputsOfTheLibrarysScene) {
  const EngineDefinition definition = engine_of(4, 2);
  const Operation operation{kRated_rpm};
  LibraryEngine<double, FourElastic<2>> library(definition, operation);
  PlainEngineRun<double> plain(plain_engine<double>(PlainPistons::libm, plain_data(definition, operation)), 4);
  OutputCheck of_library(definition, operation.engine_rpm);
  OutputCheck of_plain(definition, operation.engine_rpm);
  for (int tick = 0; tick < 2 * operation.ticks_per_cycle(); ++tick) {
    library.tick();
    plain.tick();
    if (tick < operation.ticks_per_cycle()) continue;  // the start settles
    library.check(definition, of_library);
    plain.check(definition, of_plain);
  }
  EXPECT_LT(of_library.largest_torque_error(), 1e-8);
  EXPECT_LT(of_plain.largest_torque_error(), 1e-14);
  EXPECT_LT(of_library.largest_lift_error_um(), 0.1);  // the class that is asked for
  EXPECT_LT(of_plain.largest_lift_error_um(), 3);      // of the cam's linear table 1 um, of unlocated contacts as much
  EXPECT_GT(of_plain.largest_lift_error_um(), 0.1);
}

}  // namespace
}  // namespace crankloop::program::bench::bench_test
