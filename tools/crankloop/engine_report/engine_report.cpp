#include "engine_report.hpp"

#include <algorithm>
#include <cmath>

#include <crankloop/tabulate/mechanism.hpp>

#include "engine_report_parts.hpp"

namespace crankloop::program {
namespace {

constexpr double kCloseUpTicks = 40;
constexpr double kCloseUpFromDegPerTick = 0.1;

report::Fact peak_fact(const std::string& name, const Trace& trace, const std::vector<double>& values, double factor,
                       const std::string& unit) {
  const std::size_t at = index_of_largest(values);
  return {name, report::format_number(values[at] * factor, 4), unit, "at " + angle_text(trace.crank_deg[at])};
}

/// The largest magnitude.
report::Fact magnitude_fact(const std::string& name, const Trace& trace, const std::vector<double>& values,
                            double factor, const std::string& unit) {
  const Span span = span_of(values);
  const std::size_t at = -span.low > span.high ? index_of_smallest(values) : index_of_largest(values);
  return {name, report::format_number(values[at] * factor, 4), unit, "at " + angle_text(trace.crank_deg[at])};
}

std::vector<report::Fact> facts(const ReportInput& input) {
  const Trace& trace = input.trace;
  std::vector<report::Fact> list;
  if (has_gas(input)) {
    list.push_back(
        {"Mean torque", report::format_number(input.figures.mean_torque_Nm, 4), "Nm", "all cylinders, indicated"});
    list.push_back({"Power", report::format_number(input.figures.power_W / 1e3, 4), "kW", "indicated"});
    if (input.exact.definition().friction.any()) {
      const BrakeFigures brake =
          brake_figures(input.exact.definition(), input.figures.mean_torque_Nm, input.operation.speed_rad_s());
      const std::string efficiency =
          brake.efficiency_ratio > 0
              ? "mechanical efficiency " + report::format_fixed(100 * brake.efficiency_ratio, 1) + " %"
              : "the engine is driven";
      list.push_back({"Brake power", report::format_number(brake.power_W / 1e3, 4), "kW",
                      report::format_number(brake.torque_Nm, 4) + " Nm, " + efficiency});
    }
    list.push_back({"Net IMEP", report::format_number(input.figures.net_mep_Pa / 1e3, 4), "kPa",
                    "gross " + report::format_number(input.summary.gross_mep_Pa / 1e3, 4) + " kPa"});
  }
  if (breathes(input)) {
    const GasCycle<double>& cycle = input.figures.gas.cycle;
    list.push_back({"Air charge", report::format_number(cycle.trapped_air_kg * 1e6, 4), "mg",
                    "volumetric efficiency " + report::format_fixed(100 * cycle.volumetric_efficiency, 1) + " %"});
    list.push_back({"Pumping loss", report::format_number(-cycle.pumping_mep_Pa / 1e3, 3), "kPa",
                    "intake manifold at " + report::format_number(input.figures.gas.intake_Pa / 1e3, 3) + " kPa"});
  }
  list.push_back(peak_fact("Largest torque", trace, trace.torque_Nm, 1, "Nm"));
  if (has_gas(input)) list.push_back(peak_fact("Peak pressure", trace, trace[Quantity::pressure], 1e-3, "kPa"));
  list.push_back(magnitude_fact("Largest side force", trace, trace[Quantity::side_force], 1e-3, "kN"));
  list.push_back(magnitude_fact("Largest rod force", trace, trace[Quantity::rod_force], 1e-3, "kN"));
  list.push_back(peak_fact("Largest crank pin load", trace, trace[Quantity::crank_pin_load], 1e-3, "kN"));
  const Span velocity = span_of(trace[Quantity::velocity]);
  list.push_back(
      {"Mean piston speed",
       report::format_number(mean_piston_speed_m_s(input.exact.definition().crank, input.operation.speed_rad_s()), 4),
       "m/s", "largest " + report::format_number(std::max(velocity.high, -velocity.low), 4) + " m/s"});
  list.push_back({"Time per tick", number_text(input.wall_time_per_tick_ns, 3), "ns",
                  "of " + number_text(input.operation.tick_s * 1e6) + " \u00B5s, " + input.real + ", on this machine"});
  return list;
}

std::string subtitle(const ReportInput& input) {
  const EngineDefinition& d = input.exact.definition();
  std::string text = "At " + number_text(input.operation.speed_rpm, 6) + " rpm";
  if (!has_gas(input)) {
    text += ", without gas pressure: inertia only";
  } else if (breathes(input)) {
    text += ", throttle " + number_text(input.operation.gas.throttle_ratio);
  } else if (input.operation.load_ratio == 0) {
    text += ", motored";
  } else {
    text += input.operation.load_ratio == 1 ? ", full load" : ", load ratio " + number_text(input.operation.load_ratio);
  }
  text += ". " + std::to_string(d.layout.cylinders) + (d.layout.cylinders == 1 ? " cylinder" : " cylinders") +
          ", bore " + number_text(d.crank.bore_m * 1e3) + " mm, stroke " +
          number_text(dead_centres(d.crank).stroke_m * 1e3) + " mm, " +
          number_text(swept_volume_m3(d.crank) * d.layout.cylinders * 1e3) + "\u00A0L.";
  return text;
}

}  // namespace

CloseUpWindow close_up_window(double largest_torque_deg, double deg_per_tick) noexcept {
  if (deg_per_tick < kCloseUpFromDegPerTick) return {};
  const double width = std::min(720.0, kCloseUpTicks * deg_per_tick);
  const double from = std::clamp(largest_torque_deg - width / 2, 0.0, 720 - width);
  return {from, from + width};
}

report::Page engine_report(const ReportInput& input) {
  report::Page page;
  page.title = input.file.name();
  page.subtitle = subtitle(input);
  page.facts = facts(input);
  page.sections.push_back(torque_section(input));
  if (has_gas(input)) page.sections.push_back(pressure_section(input));
  if (breathes(input)) page.sections.push_back(gas_section(input));
  page.sections.push_back(motion_section(input));
  page.sections.push_back(force_section(input));
  if (!breathes(input))
    page.sections.push_back(force_per_area_section(input));  // the page has enough sections without it
  page.sections.push_back(bearing_section(input));
  if (!breathes(input)) page.sections.push_back(speed_section(input));
  page.sections.push_back(balance_section(input));
  if (!input.trace.valves.empty()) page.sections.push_back(valve_section(input));
  if (input.exact.definition().layout.cylinders > 1) page.sections.push_back(crankshaft_section(input));
  page.sections.push_back(accuracy_section(input));
  page.sections.push_back(definition_section(input));

  // Notes and warnings come before the first curve.
  std::vector<report::Block>& first = page.sections.front().blocks;
  first.insert(
      first.begin(),
      report::Paragraph{"Crank angles count from the firing top dead centre of cylinder 1 (0) over a four-stroke cycle "
                        "of 720 deg; displacement, velocity and axial forces are positive toward the crankshaft."});
  first.insert(first.begin(), report::Paragraph{pressure_remark(input), true});
  report::put_first(page, input.warnings);
  page.footer = "Made by crankloop from " + input.file.path() + ".";
  return page;
}

}  // namespace crankloop::program
