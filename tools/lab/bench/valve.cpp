// The group "valve": one valve over a cam's turn, by several methods and steps, from gentle contacts to float and
// bounce.
#include <algorithm>
#include <cmath>
#include <memory>

#include "crankloop/files/number.hpp"
#include "groups.hpp"
#include "peers.hpp"
#include "true_lift.hpp"
#include "valve_methods.hpp"

namespace crankloop::program::bench {
namespace {

/// The error depends on the position of the ticks on the cam: this many shifts of the grid are tried, and the worst
/// counts.
constexpr int kShifts = 6;
/// A lift error larger than a valve: the method is beyond its stability limit.
constexpr double kBlownUp_m = 20e-3;

template <class Valve>
double largest_error_um(Valve& valve, const ValveRun& run, const TrueLift& truth) {
  double largest_m = 0;
  const double full_lift_deg = ohc_125_train().cam.full_lift_deg;
  const double deg_per_step = 360 * run.step_s / run.cycle_s();
  for (int shift = 0; shift < kShifts; ++shift) {
    valve.start(phase_at_cam_deg(-180 + deg_per_step * (shift + 0.5) / kShifts, full_lift_deg));
    const int steps = truth.cycles() * run.steps_per_cycle() - 1;
    double cam_deg = cam_deg_from_full_lift(valve.phase().units(), full_lift_deg);
    for (int i = 0; i < steps; ++i) {
      const double before_deg = cam_deg_from_full_lift(valve.phase().units(), full_lift_deg);
      valve.step();
      const double moved_deg = cam_deg_from_full_lift(valve.phase().units(), full_lift_deg) - before_deg;
      cam_deg += moved_deg < 0 ? moved_deg + 360 : moved_deg;
      const double error_m = std::fabs(valve.lift_m() - truth.lift_m(cam_deg));
      if (!(error_m <= kBlownUp_m)) return std::numeric_limits<double>::quiet_NaN();
      largest_m = std::max(largest_m, error_m);
    }
  }
  return largest_m * 1e6;
}

class Group {
 public:
  explicit Group(double engine_rpm) : engine_rpm_{engine_rpm}, truth_{true_lift_of_ohc_125(engine_rpm)} {}

  /// Leaves out diverging settings, so that rows end at the stability limit.
  template <class Valve>
  void add(const char* contestant, const char* real, const ValveRun& run, const std::string& setting) {
    add(std::make_shared<Valve>(run), contestant, real, run, setting);
  }
  template <class Valve>
  void add(const std::shared_ptr<Valve>& valve, const std::string& contestant, const char* real, const ValveRun& run,
           const std::string& setting) {
    Row row;
    row.group = "valve";
    row.contestant = contestant;
    row.real = real;
    row.setting = brief(engine_rpm_) + " rpm, " + setting;
    row.per = "cam cycle";
    row.error = largest_error_um(*valve, run, truth_);
    row.error_unit = "um";
    if (std::isnan(row.error)) return;
    rows_.push_back(row);
    const int steps = run.steps_per_cycle();
    contestants_.push_back({[valve, steps] {
                              for (int i = 0; i < steps; ++i) valve->step();
                            },
                            steps * run.step_s / run.cycle_s()});
  }

  template <class Real>
  void add_all(const char* real) {
    for (const double step_us : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 60.0}) {
      const ValveRun run{engine_rpm_, step_us * 1e-6};
      const std::string setting = brief(step_us) + " us";
      add<TextbookValveLoop<Real, CurveCam<Real>>>("textbook RK4", real, run, setting);
      add<TextbookValveLoop<Real, LinearCam<Real>>>("textbook RK4, linear cam", real, run, setting);
      add<MatrixValveLoop<Real, CurveCam<Real>>>("matrix RK4, unlocated", real, run, setting);
    }
    for (const double tick_us : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0})
      add_library<Real>(real, tick_us, 0.1);
    for (const double accuracy_um : {0.01, 1.0, 10.0}) {
      for (const double tick_us : {10.0, 20.0, 100.0}) add_library<Real>(real, tick_us, accuracy_um);
    }
    for (const double tick_us : {10.0, 100.0}) {
      add<LibraryValve<Real, LoneFollowing>>("cam-following", real, {engine_rpm_, tick_us * 1e-6},
                                             brief(tick_us) + " us");
    }
  }

  /// Other solvers, if there are any.
  void add_peers() {
    for (const Peer& peer : peers()) {
      for (const double tick_us : {5.0, 10.0, 20.0}) {
        const ValveRun run{engine_rpm_, tick_us * 1e-6};
        add(peer.make(run), peer.contestant, "double", run,
            brief(tick_us) + " us" + (peer.setting.empty() ? "" : ", " + peer.setting));
      }
    }
  }

  void run(const Effort& effort, std::vector<Row>& all) {
    const std::vector<Timing> timings = race(contestants_, effort);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      rows_[i].ns_median = timings[i].median_ns;
      rows_[i].ns_spread = timings[i].spread_ns;
      all.push_back(std::move(rows_[i]));
    }
  }

 private:
  template <class Real>
  void add_library(const char* real, double tick_us, double accuracy_um) {
    std::string setting = brief(tick_us) + " us";
    if (accuracy_um != kUsualAccuracy_um) setting += ", class " + brief(accuracy_um) + " um";
    for (const Integrator integrator : {Integrator::rk4, Integrator::exponential}) {
      const ValveRun run{engine_rpm_, tick_us * 1e-6, {integrator, millionths(accuracy_um)}};
      add<LibraryValve<Real, LoneElastic>>(integrator == Integrator::rk4 ? "located RK4" : "located exponential", real,
                                           run, setting);
    }
  }

  static constexpr double kUsualAccuracy_um = 0.1;
  double engine_rpm_;
  const TrueLift& truth_;
  std::vector<Row> rows_;
  std::vector<Contestant> contestants_;
};

}  // namespace

std::vector<Row> valve_rows(const Effort& effort) {
  std::vector<Row> rows;
  for (const double engine_rpm : {kSmooth_rpm, kSwitching_rpm, kBouncing_rpm}) {
    Group group(engine_rpm);
    group.add_all<float>("float");
    group.add_all<double>("double");
    group.add_peers();
    group.run(effort, rows);
  }
  return rows;
}

}  // namespace crankloop::program::bench
