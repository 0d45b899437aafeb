// `crankloop kinematics FILE`: the motion of piston and rod over one turn.
#include <string>
#include <vector>

#include <crankloop/tabulate/mechanism.hpp>

#include "../../command_line/commands.hpp"
#include "../../command_line/engine_argument.hpp"
#include "../../command_line/operating_point.hpp"
#include "../../command_line/results.hpp"
#include "../../command_line/with_real.hpp"
#include "../../files/csv.hpp"
#include "../../files/units.hpp"
#include "../../loops/tick_probe.hpp"
#include "motion_plot.hpp"
#include "motion_summary.hpp"

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

struct Column {
  const char* name;
  const char* unit;
  PoseMember member;
  int speeds;     ///< power of the crank's speed in it
  double factor;  ///< from SI
};
constexpr Column kColumns[] = {
    {"rod_angle", "deg", &Pose<double>::rod_angle_rad, 0, kDegPerRad},
    {"displacement", "mm", &Pose<double>::displacement_m, 0, 1e3},
    {"velocity", "m_s", &Pose<double>::slope_m, 1, 1},
    {"acceleration", "m_s2", &Pose<double>::acceleration_m, 2, 1},
    {"rod_speed", "rad_s", &Pose<double>::rod_slope, 1, 1},
    {"rod_acceleration", "rad_s2", &Pose<double>::rod_curvature, 2, 1},
};

/// Of each quantity the exact value, the approximation, and how far it is from that.
std::vector<std::string> columns_of(bool beside) {
  std::vector<std::string> columns{"crank_deg"};
  for (const Column& column : kColumns) {
    const std::string name = column.name;
    columns.push_back(name + "_" + column.unit);
    if (!beside) continue;
    columns.push_back(name + "_approx_" + column.unit);
    columns.push_back(name + "_error_" + column.unit);
  }
  return columns;
}

template <class Real>
void write_beside(CsvWriter& csv, const Crank& crank, double step_deg, double speed) {
  for_each_angle(step_deg, 360, [&](double deg) {
    const Pose<double> exact = exact_pose(crank, deg * kRadPerDeg);
    const Pose<double> approximation = second_order_pose(crank, deg * kRadPerDeg);
    csv.cell(deg);
    for (const Column& column : kColumns) {
      const double factor = column.factor * (column.speeds > 0 ? speed : 1) * (column.speeds > 1 ? speed : 1);
      const double values[] = {exact.*column.member, approximation.*column.member,
                               approximation.*column.member - exact.*column.member};
      for (const double value : values) csv.cell(static_cast<Real>(value * factor));
    }
    csv.end_row();
  });
}

template <class Real>
void write(CsvWriter& csv, const Crank& crank, const std::string& method, double step_deg, double speed) {
  if (method == "both") return write_beside<Real>(csv, crank, step_deg, speed);
  if (method == "table") return write_by_table<Real>(csv, crank, step_deg, speed);
  write_by_formula<Real>(csv, crank, method == "exact" ? exact_pose : second_order_pose, step_deg, speed);
}

std::vector<std::string> needed_sections() { return {"engine", "crank"}; }

/// What the user asked for, but for the files.
struct Request {
  const Crank& crank;
  double speed_rad_s;
  PoseFunction pose;
  bool beside;  ///< both methods
};

Request request_of(const Arguments& arguments, const EngineFile& engine) {
  const std::string& method = arguments.text("--method");
  const double speed_rad_s =
      arguments.has("--speed-rad-s") ? arguments.number("--speed-rad-s") : speed_rpm(arguments, engine) * kRad_sPerRpm;
  const Crank& crank = engine.definition().crank;
  const bool beside = method == "both";
  if ((method == "approx" || beside) && crank.pin_offset_m != 0) {
    throw InputError(engine.path() +
                     ": the second-order approximations hold for pin_offset_mm = 0 only; use --method exact");
  }
  return {crank, speed_rad_s, method == "approx" ? second_order_pose : exact_pose, beside};
}

Summary summary_of(const Request& request) {
  return motion_summary(request.crank, request.pose, request.speed_rad_s, request.beside);
}

int run_kinematics(const Arguments& arguments) {
  arguments.refuse_with("--rpm", {"--speed-rad-s"});
  const EngineFile engine = read_engine(arguments, needed_sections());
  const Request request = request_of(arguments, engine);
  const auto write_table = [&](Output& out) {
    CsvWriter csv(out, columns_of(request.beside));
    with_real(arguments.text("--real"), [&](auto zero) {
      write<decltype(zero)>(csv, request.crank, arguments.text("--method"), arguments.number("--step-deg"),
                            request.speed_rad_s);
    });
  };
  if (!arguments.has("--csv") && !arguments.has("--plot")) {
    Output out("");
    write_table(out);
    out.finish();
    return kSuccess;
  }
  Results results(arguments, {"--csv", "--plot"});
  if (Output* csv = results["--csv"]) write_table(*csv);
  if (Output* plot = results["--plot"])
    plot->write(motion_picture(engine.has("engine") ? engine.name() : "", request.crank, request.pose,
                               request.speed_rad_s, request.beside));
  results.finish(summary_of(request).text());
  return kSuccess;
}

Summary figures_of_kinematics(const Arguments& arguments, const EngineFile& engine) {
  arguments.refuse_with("--rpm", {"--speed-rad-s"});
  engine.require(needed_sections());
  return summary_of(request_of(arguments, engine));
}

constexpr Option kKinematicsOptions[] = {
    kSpeed,
    number("--speed-rad-s", "W", from(-10471).up_to(10471), "engine speed in rad/s, instead of --rpm"),
    number("--step-deg", "D", from(0.001).up_to(360), "crank degrees between rows", "1"),
    choice("--method", "table|exact|approx|both",
           "as the tick computes it, exactly, by the second-order approximations, or exactly and by these with their "
           "error",
           "table"),
    choice("--real", "float|double", "arithmetic of the tick, and digits of the result", "double"),
    text("--csv", "F", "file for the table; standard output then shows extremes and series instead of it"),
    text("--plot", "F.svg", "SVG file with a picture of the turn, and the summary; opens in any browser"),
};

}  // namespace

const Command kKinematics{
    "kinematics",
    "motion of piston and rod over one turn",
    "FILE [--rpm N | --speed-rad-s W] [--step-deg D] [--method M] [--real R] [--csv F] [--plot F.svg]",
    "crankloop kinematics diesel_495.ini --rpm 2000 --step-deg 10",
    1,
    kKinematicsOptions,
    run_kinematics,
    false,
    figures_of_kinematics};

}  // namespace crankloop::program
