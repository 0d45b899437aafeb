// `crankloop forces FILE`: forces and moments of one cylinder over its cycle.
#include <string>
#include <vector>

#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tabulate/summary.hpp>

#include "../command_line/commands.hpp"
#include "../command_line/engine_argument.hpp"
#include "../command_line/operating_point.hpp"
#include "../command_line/with_real.hpp"
#include "../engine_file/plausibility.hpp"
#include "../files/csv.hpp"
#include "../files/units.hpp"
#include "../loops/tick_probe.hpp"

namespace crankloop::program {
namespace {

/// Cylinder and operating point.
struct Point {
  int cylinder;
  double speed_rad_s;
  double load_ratio;
};

/// Everything of one row but the angle.
struct Row {
  double displacement_m;
  CylinderForces<double> forces;
  InertiaOrders orders;
  double crank_pin_load_N;
  double engine_torque_Nm;
};

/// How forces are shown: in N, or per piston area in MPa.
struct Scale {
  double forces;
  const char* suffix;
};

template <class Real>
void write_row(CsvWriter& csv, const Crank& crank, double deg, const Row& row, Scale scale) {
  const auto real = [](double value) { return static_cast<Real>(value); };
  const auto force = [&](double newtons) { return static_cast<Real>(newtons * scale.forces); };
  const CylinderForces<double>& f = row.forces;
  const double volume_m3 = clearance_volume_m3(crank) + bore_area_m2(crank) * row.displacement_m;
  csv.row(deg, real(row.displacement_m * 1e3), real(volume_m3 * 1e6), real(f.pressure_Pa / 1000), force(f.gas_force_N),
          force(f.inertia_force_N), force(row.orders.first_N), force(row.orders.second_N), force(f.total_force_N),
          force(f.side_force_N), force(f.rod_force_N), force(f.radial_force_N), force(f.tangential_force_N),
          real(f.torque_Nm), real(f.tilting_moment_Nm), force(row.crank_pin_load_N), real(row.engine_torque_Nm));
}

std::vector<std::string> header(Scale scale) {
  std::vector<std::string> names{"crank_deg", "displacement_mm", "volume_cm3", "pressure_kPa"};
  for (const char* force : {"gas_force", "inertia_force", "inertia_first", "inertia_second", "total_force",
                            "side_force", "rod_force", "radial_force", "tangential_force"}) {
    names.push_back(std::string(force) + scale.suffix);
  }
  names.insert(names.end(),
               {"torque_Nm", "tilting_moment_Nm", std::string("crank_pin_load") + scale.suffix, "engine_torque_Nm"});
  return names;
}

/// Cylinder k's own angle on the engine's circle, 0 to 720.
double engine_angle(const EngineDefinition& definition, int cylinder, double own_deg) {
  const double deg = own_deg + definition.layout.firing_deg[static_cast<std::size_t>(cylinder)];
  return deg >= 720 ? deg - 720 : deg;
}

template <class Real>
CylinderForces<double> widened(const CylinderForces<Real>& f) {
  const auto wide = [](Real value) { return static_cast<double>(value); };
  return {wide(f.pressure_Pa),  wide(f.gas_force_N),      wide(f.inertia_force_N), wide(f.total_force_N),
          wide(f.side_force_N), wide(f.rod_force_N),      wide(f.radial_force_N),  wide(f.tangential_force_N),
          wide(f.torque_Nm),    wide(f.tilting_moment_Nm)};
}

template <class Real>
Row by_table(TickProbe<Real>& probe, const EngineDefinition& definition, const Point& point, double deg) {
  const auto k = static_cast<std::size_t>(point.cylinder);
  const auto& out = probe.at(engine_angle(definition, point.cylinder, deg), point.speed_rad_s, point.load_ratio);
  return {static_cast<double>(out.displacement_m[k]), widened(out.cylinder[k]),
          inertia_orders(definition, deg * kRadPerDeg, point.speed_rad_s),
          static_cast<double>(out.pin_load_N[definition.layout.pin[k]]), static_cast<double>(out.torque_Nm)};
}

Row by_formula(const ExactEngine& engine, const Point& point, double deg) {
  const auto [cylinder, speed, load_ratio] = point;
  const double at = engine_angle(engine.definition(), cylinder, deg);
  const PinLoad pin = engine.pin_load(cylinder, at, speed, load_ratio);
  return {exact_pose(engine.definition().crank, deg * kRadPerDeg).displacement_m,
          engine.forces(cylinder, at, speed, load_ratio), inertia_orders(engine.definition(), deg * kRadPerDeg, speed),
          detail::square_root(pin.radial_N * pin.radial_N + pin.tangential_N * pin.tangential_N),
          engine.torque_Nm(at, speed, load_ratio)};
}

template <class Real>
void write(CsvWriter& csv, const EngineFile& engine, const Arguments& arguments, const Point& point, Scale scale) {
  const Crank& crank = engine.definition().crank;
  const double step_deg = arguments.number("--step-deg");
  ExactEngine exact;
  if (const Status refused = exact.init(engine.definition()); !refused.ok()) throw engine.explain(refused);
  if (arguments.text("--method") == "table") {
    TickProbe<Real> probe(engine.definition());
    for_each_angle(step_deg, 720, [&](double deg) {
      write_row<Real>(csv, crank, deg, by_table(probe, engine.definition(), point, deg), scale);
    });
    return;
  }
  for_each_angle(step_deg, 720,
                 [&](double deg) { write_row<Real>(csv, crank, deg, by_formula(exact, point, deg), scale); });
}

int run_forces(const Arguments& arguments) {
  const EngineFile engine = read_engine_for_scenes(arguments, {"engine", "crank", "masses"});
  demand_a_diagram(engine);
  const EngineDefinition& definition = engine.definition();
  require_heat_to_scale(arguments, engine);
  const int cylinder = arguments.whole_number("--cylinder") - 1;
  if (cylinder >= definition.layout.cylinders) {
    throw InputError(engine.path() + ": the engine has " + std::to_string(definition.layout.cylinders) +
                     " cylinders, --cylinder " + std::to_string(cylinder + 1) + " is none of them");
  }
  const Scale scale =
      arguments.has("--per-area") ? Scale{1e-6 / bore_area_m2(definition.crank), "_MPa"} : Scale{1, "_N"};
  const Point point{cylinder, speed_rpm(arguments, engine) * kRad_sPerRpm, arguments.number("--load-ratio")};
  Output out(arguments.text_or_empty("--csv"));
  CsvWriter csv(out, header(scale));
  with_real(arguments.text("--real"), [&](auto zero) { write<decltype(zero)>(csv, engine, arguments, point, scale); });
  out.finish();
  return kSuccess;
}

constexpr Option kForcesOptions[] = {
    kSpeed,
    whole_number("--cylinder", "K", from(1).up_to(16), "cylinder; crank_deg is its own crank angle", "1"),
    kLoadRatio,
    number("--step-deg", "D", from(0.001).up_to(720), "crank degrees between rows", "1"),
    choice("--method", "table|exact", "as the tick computes it, or exactly", "table"),
    choice("--real", "float|double", "arithmetic of the tick, and digits of the result", "double"),
    flag("--per-area", "forces per piston area, in MPa"),
    text("--csv", "F", "file for the table; default standard output"),
};

}  // namespace

const Command kForces{
    "forces",
    "forces and moments of one cylinder over its cycle",
    "FILE [--rpm N] [--cylinder K] [--load-ratio Q] [--step-deg D] [--method M] [--real R] [--per-area] [--csv F]",
    "crankloop forces diesel_495.ini --rpm 2000 --cylinder 1 --csv forces.csv",
    1,
    kForcesOptions,
    run_forces};

}  // namespace crankloop::program
