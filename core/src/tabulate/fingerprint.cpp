#include "fingerprint.hpp"

#include <cstddef>
#include <initializer_list>

namespace crankloop::detail {

namespace {

void add(Fingerprint& f, const ValveTrain& train) noexcept {
  const Cam& c = train.cam;
  f.add(static_cast<int>(c.source));
  for (const double x : {c.full_lift_deg, c.phase_rate_deg_s}) f.add(x);
  if (c.source == CamSource::polynomial) {
    f.add(c.max_lift_m);
    f.add(c.half_angle_deg);
    f.add(c.exponent_count);
    for (int i = 0; i < c.exponent_count; ++i) f.add(c.exponents[i]);
  } else {
    f.add(c.smoothing_m);
    f.add(c.point_count);
    for (int i = 0; i < c.point_count; ++i) f.add(c.points[i].cam_deg), f.add(c.points[i].lift_m);
  }
  const Rocker& r = train.rocker;
  f.add(static_cast<int>(r.kind));
  f.add(static_cast<int>(r.cam_turns));
  for (const double x : {r.base_circle_m, r.clearance_m, r.ratio, r.pivot_to_pad_m, r.pivot_to_cam_m, r.pad_radius_m, r.pivot_to_screw_m,
                         r.screw_ball_m, r.stem_above_pivot_m}) {
    f.add(x);
  }
  const Valve& v = train.valve;
  for (const double x : {v.valve_kg, v.spring_kg, v.rocker_inertia_kg_m2, v.spring_N_m, v.spring_preload_N, v.train_N_m,
                         v.train_damping_ratio, v.guide_damping_ratio, v.seat_N_m, v.seat_damping_ratio, v.head_area_m2}) {
    f.add(x);
  }
}

}  // namespace

std::uint64_t fingerprint_of(const EngineDefinition& engine, const TickOptions& options, const TableReport& report,
                                           int scalar_bytes) noexcept {
  Fingerprint f;
  f.add(kTableFormat);
  f.add(scalar_bytes);
  f.add(options.tick_s);
  f.add(report.tolerance_doublings);
  f.add(report.torque_doublings);

  const Crank& c = engine.crank;
  for (const double x : {c.bore_m, c.crank_radius_m, c.rod_length_m, c.pin_offset_m, c.compression_ratio}) f.add(x);
  const Masses& m = engine.masses;
  for (const double x : {m.piston_kg, m.rod_small_end_kg, m.rod_big_end_kg, m.rod_inertia_correction_kg_m2, m.crank_pin_equivalent_kg,
                         m.crank_inertia_kg_m2}) {
    f.add(x);
  }
  const Layout& layout = engine.layout;
  f.add(layout.cylinders);
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    for (const double x : {layout.firing_deg[k], layout.bank_deg[k], layout.position_m[k]}) f.add(x);
    f.add(static_cast<int>(layout.pin[k]));
  }
  const Pressure& p = engine.pressure;
  f.add(static_cast<int>(p.source));
  f.add(p.crankcase_Pa);
  if (p.source == PressureSource::wiebe) {
    const WiebeDiagram& w = p.wiebe;
    for (const double x : {w.intake_Pa, w.exhaust_Pa, w.start_of_combustion_deg, w.combustion_duration_deg, w.wiebe_m,
                           w.compression_exponent, w.expansion_exponent, w.motored_exponent(), w.exhaust_valve_opens_deg,
                           w.heat_given ? w.heat_J : w.net_mep_Pa}) {
      f.add(x);
    }
    f.add(static_cast<int>(w.heat_given));
  } else {
    const int rows = p.source == PressureSource::none ? 0 : p.point_count;
    f.add(rows);
    for (int i = 0; i < rows; ++i) f.add(p.points[i].at), f.add(p.points[i].pressure_Pa);
  }
  if (engine.train_count > 0) {
    f.add(static_cast<int>(options.valves.integrator));
    f.add(options.valves.accuracy_m);
    for (int t = 0; t < engine.train_count; ++t) add(f, engine.trains[t]);
  }
  // What came later counts only where there is any of it: engines without have the fingerprint they always had.
  if (report.cut_doublings > 0) f.add(report.cut_doublings);
  const Friction& friction = engine.friction;
  const Load& load = engine.load;
  const Starter& starter = engine.starter;
  const double dynamics[] = {friction.constant_Pa, friction.linear_Pa_s, friction.quadratic_Pa_s2, load.constant_Nm,  load.linear_Nm_s,
                             load.quadratic_Nm_s2, load.inertia_kg_m2,   starter.stall_Nm,         starter.no_load_rad_s};
  bool any = false;
  for (const double x : dynamics) any = any || x != 0;
  if (any) {
    for (const double x : dynamics) f.add(x);
  }
  return f.value();
}

}  // namespace crankloop::detail
