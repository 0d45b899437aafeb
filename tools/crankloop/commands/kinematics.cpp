// `crankloop kinematics FILE`: the motion of piston and rod over one turn.
#include <crankloop/tabulate/mechanism.hpp>

#include "../command_line/commands.hpp"
#include "../command_line/engine_argument.hpp"
#include "../command_line/operating_point.hpp"
#include "../command_line/with_real.hpp"
#include "../files/csv.hpp"
#include "../files/units.hpp"
#include "../loops/tick_probe.hpp"

namespace crankloop::program {
namespace {

/// Cylinder 1 alone: kinematics asks for no masses and no pressure.
EngineDefinition mechanism_alone(const Crank& crank) {
  EngineDefinition alone;
  alone.crank = crank;
  alone.masses.piston_kg = 1;
  return alone;
}

template <class Real>
void write_row(CsvWriter& csv, double crank_deg, double rod_angle_rad, double x_m, double v_m_s, double a_m_s2,
               double rod_speed, double rod_acceleration) {
  const auto real = [](double value) { return static_cast<Real>(value); };
  csv.row(crank_deg, real(rod_angle_rad / kRadPerDeg), real(x_m * 1000), real(v_m_s), real(a_m_s2), real(rod_speed),
          real(rod_acceleration));
}

template <class Real>
void write_by_table(CsvWriter& csv, const Crank& crank, double step_deg, double speed) {
  TickProbe<Real> probe(mechanism_alone(crank));
  for_each_angle(step_deg, 360, [&](double deg) {
    const auto& out = probe.at(deg, speed);
    const auto wide = [](Real value) { return static_cast<double>(value); };
    write_row<Real>(csv, deg, wide(out.rod_angle_rad[0]), wide(out.displacement_m[0]), wide(out.velocity_m_s[0]),
                    wide(out.acceleration_m_s2[0]), wide(out.rod_speed_rad_s[0]), wide(out.rod_acceleration_rad_s2[0]));
  });
}

template <class Real>
void write_by_formula(CsvWriter& csv, const Crank& crank, PoseFunction pose, double step_deg, double speed) {
  for_each_angle(step_deg, 360, [&](double deg) {
    const Pose<double> p = pose(crank, deg * kRadPerDeg);
    write_row<Real>(csv, deg, p.rod_angle_rad, p.displacement_m, p.slope_m * speed, p.acceleration_m * speed * speed,
                    p.rod_slope * speed, p.rod_curvature * speed * speed);
  });
}

template <class Real>
void write(CsvWriter& csv, const Crank& crank, const std::string& method, double step_deg, double speed) {
  if (method == "table") return write_by_table<Real>(csv, crank, step_deg, speed);
  write_by_formula<Real>(csv, crank, method == "exact" ? exact_pose : second_order_pose, step_deg, speed);
}

int run_kinematics(const Arguments& arguments) {
  const double step_deg = arguments.number("--step-deg");
  const std::string& method = arguments.text("--method");
  if (arguments.has("--rpm") && arguments.has("--speed-rad-s"))
    throw UsageError("--rpm and --speed-rad-s exclude each other; give one");
  const EngineFile engine = read_engine(arguments, {"engine", "crank"});
  const double speed =
      arguments.has("--speed-rad-s") ? arguments.number("--speed-rad-s") : speed_rpm(arguments, engine) * kRad_sPerRpm;
  const Crank& crank = engine.definition().crank;
  if (method == "approx" && crank.pin_offset_m != 0) {
    throw InputError(engine.path() +
                     ": the second-order approximations hold for pin_offset_mm = 0 only; use --method exact");
  }
  Output out(arguments.text_or_empty("--csv"));
  CsvWriter csv(out, {"crank_deg", "rod_angle_deg", "displacement_mm", "velocity_m_s", "acceleration_m_s2",
                      "rod_speed_rad_s", "rod_acceleration_rad_s2"});
  with_real(arguments.text("--real"), [&](auto zero) { write<decltype(zero)>(csv, crank, method, step_deg, speed); });
  out.finish();
  return kSuccess;
}

constexpr Option kOptions[] = {
    kSpeed,
    number("--speed-rad-s", "W", from(-10471).up_to(10471), "engine speed in rad/s, instead of --rpm"),
    number("--step-deg", "D", from(0.001).up_to(360), "crank degrees between rows", "1"),
    choice("--method", "table|exact|approx", "as the tick computes it, exactly, or by the second-order approximations",
           "table"),
    choice("--real", "float|double", "arithmetic of the tick, and digits of the result", "double"),
    text("--csv", "F", "file for the table; else standard output"),
};

}  // namespace

const Command kKinematics{"kinematics",
                          "motion of piston and rod over one turn",
                          "FILE [--rpm N | --speed-rad-s W] [--step-deg D] [--method M] [--real R] [--csv F]",
                          "crankloop kinematics diesel_495.ini --rpm 2000 --step-deg 10",
                          1,
                          kOptions,
                          run_kinematics};

}  // namespace crankloop::program
