#include "tick_engines.hpp"

namespace crankloop::program::bench {
namespace {

std::uint64_t firing_units(const EngineDefinition& definition, int cylinder) {
  const double deg = definition.layout.firing_deg[static_cast<std::size_t>(cylinder)];
  return static_cast<std::uint64_t>(deg / 720 * 0x1p63) << 1;
}

}  // namespace

OutputCheck::OutputCheck(const EngineDefinition& definition, double engine_rpm)
    : definition_{definition}, speed_rad_s_{rad_s_of(engine_rpm)}, truth_{true_lift_of_ohc_125(engine_rpm)} {}

void OutputCheck::torque(std::uint64_t phase, double torque_Nm) noexcept {
  const ExactMotion<long double> exact(definition_.crank);
  double sum_Nm = 0;
  for (int k = 0; k < definition_.layout.cylinders; ++k) {
    const Motion<long double> m = true_motion(exact, phase - firing_units(definition_, k));
    const double gas_N = (pressure_Pa(k) - definition_.pressure.crankcase_Pa) * bore_area_m2(definition_.crank);
    const double inertia_N =
        -definition_.masses.reciprocating_kg() * static_cast<double>(m.a) * speed_rad_s_ * speed_rad_s_;
    const double one_Nm = (gas_N + inertia_N) * static_cast<double>(m.v);
    largest_torque_Nm_ = std::max(largest_torque_Nm_, std::fabs(one_Nm));
    sum_Nm += one_Nm;
  }
  torque_error_Nm_ = std::max(torque_error_Nm_, std::fabs(torque_Nm - sum_Nm));
}

void OutputCheck::lift(std::uint64_t phase, int cylinder, int train, double lift_m) noexcept {
  const double cam_deg =
      cam_deg_from_full_lift(phase - firing_units(definition_, cylinder), definition_.trains[train].cam.full_lift_deg);
  lift_error_m_ = std::max(lift_error_m_, std::fabs(lift_m - truth_.lift_m(cam_deg)));
}

PlainEngineData plain_data(const EngineDefinition& definition, const Operation& operation) {
  PlainEngineData d{};
  d.crank_radius_m = definition.crank.crank_radius_m;
  d.rod_length_m = definition.crank.rod_length_m;
  d.bore_area_m2 = bore_area_m2(definition.crank);
  d.crankcase_Pa = definition.pressure.crankcase_Pa;
  d.reciprocating_kg = definition.masses.reciprocating_kg();
  d.tick_s = operation.tick_s;
  d.speed_rad_s = rad_s_of(operation.engine_rpm);
  for (int k = 0; k < definition.layout.cylinders; ++k)
    d.firing_deg.push_back(definition.layout.firing_deg[static_cast<std::size_t>(k)]);
  const LibraryValve<double, LoneElastic> one(ValveRun{operation.engine_rpm, operation.tick_s});
  const detail::LiftCurve<double>& curve = one.tables().lift_curves[0];
  for (std::uint32_t degree = 0; degree <= 360; ++degree) {
    const detail::Lift<double> lift = curve.read(detail::Cell{degree % 360, 0, 0});
    d.lift_m.push_back(lift.lift_m);
    d.lift_per_deg_m.push_back(lift.per_deg_m);
  }
  const double opens_before_full_lift_deg =
      definition.trains[0].cam.full_lift_deg - static_cast<double>(curve.opens[0]) * (720 / 0x1p64);
  for (int t = 0; t < definition.train_count; ++t)
    d.lobe_opens_deg.push_back(definition.trains[t].cam.full_lift_deg - opens_before_full_lift_deg);
  d.valve = plain_body(one.tables().valve_motions[0].body);
  return d;
}

}  // namespace crankloop::program::bench
