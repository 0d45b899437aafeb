// The groups "tick", "growth" and "skips": whole engines tick by tick.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "crankloop/files/number.hpp"
#include "groups.hpp"
#include "port/linux/stopwatch.hpp"
#include "tick_engines.hpp"

namespace crankloop::program::bench {
namespace {

/// An engine to be timed.
struct Case {
  Row row;
  std::function<void()> tick;
  std::function<void()> cycle;
  int ticks;
};

std::string counted(int count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}
std::string valves_of(int count) { return counted(count, "valve"); }

std::string setting_of(int cylinders, const std::string& valves, const Operation& operation) {
  return counted(cylinders, "cylinder") + ", " + valves + ", " + brief(operation.engine_rpm) + " rpm, " +
         brief(operation.tick_s * 1e6) + " us";
}

class Group {
 public:
  explicit Group(std::string name) : name_{std::move(name)} {}

  template <class Real, class S>
  void library(const std::string& contestant, const EngineDefinition& definition, const Operation& operation,
               const std::string& valves) {
    add<Real>(contestant, std::make_shared<LibraryEngine<Real, S>>(definition, operation), definition, operation,
              valves, S::valves != ValveModel::none);
  }

  template <class Real>
  void plain(const std::string& contestant, PlainPistons pistons, bool usual_flags, const EngineDefinition& definition,
             const Operation& operation, const std::string& valves) {
    const PlainEngineData data = plain_data(definition, operation);
    auto engine = usual_flags ? plain_engine_of_usual_flags<Real>(pistons, data) : plain_engine<Real>(pistons, data);
    add<Real>(contestant, std::make_shared<PlainEngineRun<Real>>(std::move(engine), definition.layout.cylinders),
              definition, operation, valves, definition.train_count > 0);
  }

  /// Means; with `each_tick` also the median, 99.9 % and worst tick of a cycle.
  void run(const Effort& effort, bool each_tick, std::vector<Row>& all) {
    std::vector<Contestant> contestants;
    for (const Case& one : cases_) contestants.push_back({one.cycle, static_cast<double>(one.ticks)});
    const std::vector<Timing> timings = race(contestants, effort);
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      Row row = cases_[i].row;
      row.ns_median = timings[i].median_ns;
      row.ns_spread = timings[i].spread_ns;
      all.push_back(row);
      if (each_tick && effort.rounds > 0) add_profile(cases_[i], effort, all);
    }
  }

 private:
  template <class Real, class Run>
  void add(const std::string& contestant, const std::shared_ptr<Run>& run, const EngineDefinition& definition,
           const Operation& operation, const std::string& valves, bool has_valves) {
    Case one;
    one.row.group = name_;
    one.row.contestant = contestant;
    one.row.real = sizeof(Real) == 4 ? "float" : "double";
    one.row.setting = setting_of(definition.layout.cylinders, valves, operation);
    one.row.per = "tick";
    one.ticks = operation.ticks_per_cycle();
    one.tick = [run] { run->tick(); };
    one.cycle = [run, ticks = one.ticks] {
      for (int i = 0; i < ticks; ++i) run->tick();
    };
    // The effect of the start ends with the first cycle; the valves then rest before every lobe, as in the reference.
    one.cycle();
    OutputCheck check(definition, operation.engine_rpm);
    for (int i = 0; i < one.ticks; ++i) {
      run->tick();
      run->check(definition, check);
    }
    one.row.error = has_valves ? check.largest_lift_error_um() : check.largest_torque_error();
    one.row.error_unit = has_valves ? "um of lift" : "of the largest torque";
    cases_.push_back(std::move(one));
  }

  /// Each tick of the cycle, from the middle half of repeated cycles, so that disturbance by another program does not
  /// count.
  static void add_profile(const Case& one, const Effort& effort, std::vector<Row>& all) {
    const double clock_ns = clock_cost_ns(port::now_ns);
    const int cycles = effort.rounds;
    std::vector<std::vector<double>> samples(static_cast<std::size_t>(one.ticks));
    for (int cycle = 0; cycle < cycles; ++cycle) {
      for (std::vector<double>& sample : samples) {
        const std::int64_t begin = port::now_ns();
        one.tick();
        sample.push_back(static_cast<double>(port::now_ns() - begin) - clock_ns);
      }
    }
    std::vector<Timing> ticks;
    for (std::vector<double>& sample : samples) ticks.push_back({middle_mean(sample), timing_of(sample).spread_ns});
    std::sort(ticks.begin(), ticks.end(), [](const Timing& a, const Timing& b) { return a.median_ns < b.median_ns; });
    const auto place = [&](const char* which, double part) {
      const Timing& tick = ticks[static_cast<std::size_t>(part * static_cast<double>(ticks.size() - 1))];
      Row row = one.row;
      row.contestant += std::string(", ") + which;
      row.ns_median = tick.median_ns;
      row.ns_spread = tick.spread_ns;
      all.push_back(row);
    };
    place("median tick", 0.5);
    place("99.9 % tick", 0.999);
    place("worst tick", 1);
  }

  std::string name_;
  std::vector<Case> cases_;
};

EngineDefinition in_pairs(EngineDefinition definition) {
  for (int t = 0; t < definition.train_count; ++t) definition.trains[t].valve.per_cylinder = 2;
  return definition;
}

/// Four cylinders of which no two stand at the same crank angle.
EngineDefinition unevenly_firing(EngineDefinition definition) {
  for (std::size_t k = 0; k < 4; ++k) definition.layout.firing_deg[k] += 10.0 * static_cast<double>(k);
  return definition;
}

template <class Real>
void add_main(Group& group) {
  const Operation operation{kRated_rpm};
  const EngineDefinition pistons = engine_of(4, 0);
  const EngineDefinition eight = engine_of(4, 2);
  const EngineDefinition sixteen = engine_of(4, 4);
  group.library<Real, FourElastic<2>>("library", eight, operation, valves_of(8));
  group.plain<Real>("linear tables + textbook RK4", PlainPistons::linear_tables, false, eight, operation, valves_of(8));
  group.plain<Real>("libm + textbook RK4", PlainPistons::libm, false, eight, operation, valves_of(8));
  group.library<Real, FourElastic<4>>("library", sixteen, operation, valves_of(16));
  group.library<Real, FourElastic<2>>("library", in_pairs(eight), operation, "16 valves in pairs");
  group.plain<Real>("linear tables + textbook RK4", PlainPistons::linear_tables, false, sixteen, operation,
                    valves_of(16));
  group.plain<Real>("libm + textbook RK4", PlainPistons::libm, false, sixteen, operation, valves_of(16));
  group.plain<Real>("linear tables + textbook RK4, usual flags", PlainPistons::linear_tables, true, eight, operation,
                    valves_of(8));
  group.plain<Real>("libm + textbook RK4, usual flags", PlainPistons::libm, true, eight, operation, valves_of(8));
  group.library<Real, FourMotion>("library", pistons, operation, valves_of(0));
  group.plain<Real>("linear tables + textbook RK4", PlainPistons::linear_tables, false, pistons, operation,
                    valves_of(0));
  group.plain<Real>("libm + textbook RK4", PlainPistons::libm, false, pistons, operation, valves_of(0));
}

/// One valve from 50 deg of cam before full lift to 50 deg after it: in contact with its train throughout, so that no
/// contact change is near.
void add_held_valve(double tick_us, std::vector<Row>& rows, std::vector<Contestant>& contestants) {
  constexpr double kArc_deg = 50;
  const ValveRun run{kRated_rpm, tick_us * 1e-6};
  const TrueLift& truth = true_lift_of_ohc_125(kRated_rpm);
  const double full_lift_deg = ohc_125_train().cam.full_lift_deg;
  const auto valve = std::make_shared<LibraryValve<float, LoneElastic>>(run);
  const auto cam_deg = [&] { return cam_deg_from_full_lift(valve->phase().units(), full_lift_deg); };
  valve->start(phase_at_cam_deg(-180, full_lift_deg));
  do valve->step();
  while (cam_deg() < -kArc_deg);
  const auto before = valve->snapshot();
  Row row{"growth", "one valve held by its train", "float", brief(kRated_rpm) + " rpm, " + brief(tick_us) + " us",
          "tick"};
  row.error = 0;
  row.error_unit = "um";
  int ticks = 0;
  for (; cam_deg() < kArc_deg; ++ticks) {
    valve->step();
    row.error = std::max(row.error, 1e6 * std::fabs(valve->lift_m() - truth.lift_m(cam_deg())));
  }
  rows.push_back(std::move(row));
  contestants.push_back({[valve, before, ticks] {
                           valve->restore(before);
                           for (int i = 0; i < ticks; ++i) valve->step();
                         },
                         static_cast<double>(ticks)});
}

}  // namespace

std::vector<Row> tick_rows(const Effort& effort) {
  std::vector<Row> rows;
  Group main("tick");
  add_main<float>(main);
  add_main<double>(main);
  main.run(effort, true, rows);

  Group any("tick");
  for (const double engine_rpm : {kIdle_rpm, kRated_rpm, kRedline_rpm}) {
    const Operation operation{engine_rpm};
    for (const int cylinders : {1, 4, 6, 8, 12}) {
      any.library<float, AnyMotion>("library, any engine", engine_of(cylinders, 0), operation, valves_of(0));
      for (const int trains : {1, 2, 4}) {
        any.library<float, AnyElastic>("library, any engine", engine_of(cylinders, trains), operation,
                                       valves_of(cylinders * trains));
      }
    }
  }
  any.run(effort, true, rows);
  return rows;
}

std::vector<Row> growth_rows(const Effort& effort) {
  Group group("growth");
  const EngineDefinition eight = engine_of(4, 2);
  for (const Integrator integrator : {Integrator::rk4, Integrator::exponential}) {
    const std::string contestant = integrator == Integrator::rk4 ? "located RK4" : "located exponential";
    for (const double tick_us : {5.0, 10.0, 20.0, 50.0, 100.0, 200.0}) {
      group.library<float, FourElastic<2>>(contestant, eight, {kRated_rpm, tick_us * 1e-6, {integrator}}, valves_of(8));
    }
    for (const double accuracy_um : {0.01, 1.0, 10.0}) {
      group.library<float, FourElastic<2>>(contestant + ", class " + brief(accuracy_um) + " um", eight,
                                           {kRated_rpm, 100e-6, {integrator, millionths(accuracy_um)}}, valves_of(8));
    }
  }
  std::vector<Row> rows;
  group.run(effort, false, rows);

  std::vector<Row> held;
  std::vector<Contestant> contestants;
  for (const double tick_us : {5.0, 10.0, 20.0, 50.0, 100.0, 200.0}) add_held_valve(tick_us, held, contestants);
  const std::vector<Timing> timings = race(contestants, effort);
  for (std::size_t i = 0; i < held.size(); ++i) {
    held[i].ns_median = timings[i].median_ns;
    held[i].ns_spread = timings[i].spread_ns;
    rows.push_back(std::move(held[i]));
  }
  return rows;
}

std::vector<Row> skip_rows(const Effort& effort) {
  Group group("skips");
  const Operation operation{kRated_rpm};
  const EngineDefinition pistons = engine_of(4, 0);
  const EngineDefinition eight = engine_of(4, 2);
  group.library<float, FourTorque>("torque", pistons, operation, valves_of(0));
  group.library<float, FourMotion>("torque, motion", pistons, operation, valves_of(0));
  group.library<float, AnyMotion>("torque, motion; counts from the tables", pistons, operation, valves_of(0));
  group.library<float, FourMotion>("torque, motion; no two cylinders at one crank angle", unevenly_firing(pistons),
                                   operation, valves_of(0));
  group.library<float, FourForces>("torque, motion, forces", pistons, operation, valves_of(0));
  group.library<float, FourFollowing<2>>("torque, motion, cam-following valves", eight, operation, valves_of(8));
  group.library<float, FourTorqueElastic>("torque, elastic valves", eight, operation, valves_of(8));
  group.library<float, FourElastic<2>>("torque, motion, elastic valves", eight, operation, valves_of(8));
  group.library<float, AnyElastic>("torque, motion, elastic valves; counts from the tables", eight, operation,
                                   valves_of(8));
  group.library<float, FourElastic<2>>("torque, motion, elastic valves; in identical pairs", in_pairs(eight), operation,
                                       "16 valves in pairs");
  group.library<float, FourElastic<4>>("torque, motion, elastic valves; no two alike", engine_of(4, 4), operation,
                                       valves_of(16));
  group.library<float, FourElasticForces>("torque, motion, elastic valves and their forces", eight, operation,
                                          valves_of(8));
  group.library<float, FourElasticResults>("torque, motion, elastic valves, forces, results", eight, operation,
                                           valves_of(8));
  std::vector<Row> rows;
  group.run(effort, false, rows);
  return rows;
}

}  // namespace crankloop::program::bench
