#include "fingerprint.hpp"

#include <cstddef>
#include <initializer_list>

namespace crankloop::detail {

std::uint64_t fingerprint_of(const EngineDefinition& engine, const TickOptions& options, const TableReport& report,
                                           int scalar_bytes) noexcept {
  Fingerprint f;
  f.add(kTableFormat);
  f.add(scalar_bytes);
  f.add(options.tick_s);
  f.add(report.tolerance_doublings);

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
                           w.compression_exponent, w.expansion_exponent, w.exhaust_valve_opens_deg,
                           w.heat_given ? w.heat_J : w.net_mep_Pa}) {
      f.add(x);
    }
    f.add(static_cast<int>(w.heat_given));
  } else {
    f.add(p.point_count);
    for (int i = 0; i < p.point_count; ++i) f.add(p.points[i].at), f.add(p.points[i].pressure_Pa);
  }
  return f.value();
}

}  // namespace crankloop::detail
