// Largest errors of the tick against exact equations, as rows of the README's table: the same on every machine.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

#include <crankloop/crankloop.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tabulate/summary.hpp>

#include "crankloop/engine_file/engine_file.hpp"
#include "support/pressure_traces.hpp"
#include "support/random.hpp"
#include "support/units.hpp"
#include "tabulate/quadrature.hpp"

namespace {

using namespace crankloop;

using crankloop::support::kRadPerDeg;
constexpr double kDegPerUnit = 720.0 / 18446744073709551616.0;

[[nodiscard]] double deg_of(Phase phase) { return static_cast<double>(phase.units()) * kDegPerUnit; }

/// A candidate that is no number is kept: it must not pass for a small one.
void keep_larger(double& largest, double candidate) {
  if (!(std::fabs(candidate) <= largest)) largest = std::fabs(candidate);
}

[[nodiscard]] bool said(const Status& status) {
  if (!status.ok()) std::fprintf(stderr, "%s %s\n", status.field, describe(status.reason));
  return status.ok();
}

// ---- motion of piston and rod ---------------------------------------------------------------------------------------

/// Of r, r w and r w^2.
struct MotionErrors {
  double displacement = 0;
  double velocity = 0;
  double acceleration = 0;

  [[nodiscard]] double largest() const { return std::max({displacement, velocity, acceleration}); }
};

template <class Real>
class MotionTable {
 public:
  explicit MotionTable(const Crank& crank) : crank_{crank} {
    EngineDefinition engine;
    engine.crank = crank;
    engine.masses.piston_kg = 1;
    if (!said(tables_->build(engine, {100e-6}))) std::exit(1);
  }

  void compare_at(Phase here, MotionErrors& errors) {
    typename Engine<Real, scenes::MeasuredMotion>::Input in;
    if (!said(engine_.init(tables_->tables()))) std::exit(1);
    in.crank = here - Phase{std::uint64_t{1} << 54};
    engine_.step(in);  // the first angle says nothing of the speed
    in.crank = here;
    const auto& out = engine_.step(in);
    const double w = static_cast<double>(engine_.state().speed_rad_s);
    const double r = crank_.crank_radius_m;
    const Pose<double> exact =
        exact_pose(crank_, static_cast<double>(here.units() & ~(std::uint64_t{1} << 63)) * kDegPerUnit * kRadPerDeg);
    keep_larger(errors.displacement, (static_cast<double>(out.displacement_m[0]) - exact.displacement_m) / r);
    keep_larger(errors.velocity, (static_cast<double>(out.velocity_m_s[0]) / w - exact.slope_m) / r);
    keep_larger(errors.acceleration,
                (static_cast<double>(out.acceleration_m_s2[0]) / (w * w) - exact.acceleration_m) / r);
  }

 private:
  using Tables = TableStorage<Real, scenes::MeasuredMotion>;
  Crank crank_;
  std::unique_ptr<Tables> tables_ = std::make_unique<Tables>();
  Engine<Real, scenes::MeasuredMotion> engine_;
};

/// lambda 0.15 to 0.45 and offsets to a fifth of the crank radius; every border of a degree and its neighbours, and a
/// million phases between.
template <class Real>
MotionErrors motion_errors() {
  MotionErrors errors;
  support::Random random(495);
  for (int i = 0; i <= 6; ++i) {
    for (const double offset_ratio : {-0.2, -0.1, 0.0, 0.1, 0.2}) {
      Crank crank;
      crank.bore_m = 0.095;
      crank.crank_radius_m = 0.0575;
      crank.rod_length_m = crank.crank_radius_m / (0.15 + 0.05 * i);
      crank.pin_offset_m = offset_ratio * crank.crank_radius_m;
      MotionTable<Real> table(crank);
      for (std::uint64_t degree = 0; degree < 720; ++degree) {
        const std::uint64_t border = ((degree << 32) / 720) << 32;
        for (const std::uint64_t unit : {border - 1, border, border + (std::uint64_t{1} << 32)})
          table.compare_at(Phase{unit}, errors);
      }
      for (int k = 0; k < 1000000 / 35; ++k) table.compare_at(Phase{random.bits()}, errors);
    }
  }
  return errors;
}

// ---- pressure and torque --------------------------------------------------------------------------------------------

/// Largest error of the tick's pressure, in Pa, over the cycle of cylinder 1.
template <class Real>
double pressure_error_Pa(const EngineDefinition& definition) {
  using Scene = scenes::Whole;
  const auto tables = std::make_unique<TableStorage<Real, Scene, kMaxGasSegments>>();
  IndicatorDiagram diagram;
  Engine<Real, Scene> engine;
  if (!said(tables->build(definition, {10e-6})) || !said(diagram.init(definition.crank, definition.pressure)) ||
      !said(engine.init(tables->tables()))) {
    std::exit(1);
  }
  typename Engine<Real, Scene>::Input in;
  in.speed_rad_s = static_cast<Real>(7);  // 0.004 deg a tick: 180 000 angles
  double error_Pa = 0;
  for (int tick = 0; tick < 180000; ++tick) {
    const auto& out = engine.step(in);
    keep_larger(error_Pa,
                static_cast<double>(out.cylinder[0].pressure_Pa) - diagram.full_Pa(deg_of(engine.state().phase)));
  }
  return error_Pa;
}

/// Of the largest torque: torque at the tick, and its mean over a 100 us tick, against the exact engine's.
struct TorqueErrors {
  double at_tick = 0;
  double mean = 0;
};
template <class Real>
TorqueErrors torque_errors(const EngineDefinition& definition) {
  constexpr double kTick_s = 100e-6;
  using Scene = scenes::Whole;
  const auto tables = std::make_unique<TableStorage<Real, Scene, kMaxGasSegments>>();
  ExactEngine exact;
  Engine<Real, Scene> engine;
  if (!said(tables->build(definition, {kTick_s})) || !said(exact.init(definition)) ||
      !said(engine.init(tables->tables())))
    std::exit(1);
  typename Engine<Real, Scene>::Input in;
  in.speed_rad_s = static_cast<Real>(209.44);
  const double w = static_cast<double>(in.speed_rad_s);
  TorqueErrors errors;
  double largest_Nm = 0;
  double before_deg = 0;
  Phase before;
  for (int tick = 0; tick < 600; ++tick) {  // one cycle
    const auto& out = engine.step(in);
    const double now_deg = before_deg + 720 * (engine.state().phase - before).template signed_cycles<double>();
    const double torque_Nm = exact.torque_Nm(now_deg, w);
    const auto at = [&](double deg) { return exact.torque_Nm(deg, w); };
    const double mean_Nm = detail::integrate(before_deg, now_deg, 24, at) / (now_deg - before_deg);
    keep_larger(largest_Nm, torque_Nm);
    keep_larger(errors.at_tick, static_cast<double>(out.torque_Nm) - torque_Nm);
    keep_larger(errors.mean, static_cast<double>(out.mean_torque_Nm) - mean_Nm);
    before_deg = now_deg;
    before = engine.state().phase;
  }
  return {errors.at_tick / largest_Nm, errors.mean / largest_Nm};
}

void row(const char* what, double in_float, double in_double, const char* unit = "") {
  std::printf("| %s | %.1e%s | %.1e%s |\n", what, in_float, unit, in_double, unit);
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) return 2;
  const auto file = program::read_engine_file(words[1], {"crank", "masses"});
  const EngineDefinition& diesel = file.definition();
  EngineDefinition steep = diesel;
  const std::vector<DiagramPoint> rows = tick_test::rows_of(tick_test::SmoothTrace{}, tick_test::evenly_deg(7200));
  steep.pressure.source = PressureSource::angle_table;
  steep.pressure.points = rows.data();
  steep.pressure.point_count = static_cast<int>(rows.size());

  std::printf("| largest error | float | double |\n| --- | --- | --- |\n");
  row("piston displacement, velocity, acceleration; of r, r w, r w^2", motion_errors<float>().largest(),
      motion_errors<double>().largest());
  row("pressure of the 495 diesel", pressure_error_Pa<float>(diesel) / 1e3, pressure_error_Pa<double>(diesel) / 1e3,
      " kPa");
  row("pressure of a trace that rises 1160 kPa per degree", pressure_error_Pa<float>(steep) / 1e3,
      pressure_error_Pa<double>(steep) / 1e3, " kPa");
  const TorqueErrors in_float = torque_errors<float>(diesel);
  const TorqueErrors in_double = torque_errors<double>(diesel);
  row("torque of the 495 diesel at the tick; of its largest", in_float.at_tick, in_double.at_tick);
  row("torque of the 495 diesel over a tick of 100 us; of its largest", in_float.mean, in_double.mean);
  return 0;
}
