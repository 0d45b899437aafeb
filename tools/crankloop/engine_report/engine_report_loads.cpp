// Sections of the engine report: bearings, free forces and moments.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "../files/units.hpp"
#include "../loops/free_forces.hpp"
#include "engine_report_parts.hpp"
#include "free_orders.hpp"

namespace crankloop::program {
namespace {

using report::Axis;
using report::Paragraph;
using report::Plot;
using report::Section;

constexpr std::size_t kMaxCurves = 6;  // colours there are

Axis force_axis(const std::string& title) { return axis_of(title, "kN"); }
Axis moment_axis() { return axis_of("Moment", "Nm"); }

double mean_of(const std::vector<double>& values) {  // without the last, which is the first of the next cycle
  return std::accumulate(values.begin(), values.end() - 1, 0.0) / static_cast<double>(values.size() - 1);
}

constexpr double kNoise = 1e-5;  // relative to one cylinder's first order: rounding errors of balanced forces

/// Distance from the first cylinder to the last, at least 1 m so that the moment of a single cylinder can be compared
/// with rounding.
double length_of(const Layout& layout) {
  const auto [low, high] = std::minmax_element(layout.position_m.begin(), layout.position_m.begin() + layout.cylinders);
  return std::max(*high - *low, 1.0);
}

void add_if_any(std::vector<report::Series>& curves, const Trace& trace, const std::string& name,
                const std::vector<double>& values, double factor, double noise) {
  const Span span = span_of(values);
  if (std::max(-span.low, span.high) > noise) curves.push_back(over_angle(trace, name, values, factor));
}

std::size_t most_loaded(const std::vector<std::vector<double>>& loads) {
  std::size_t most = 0;
  for (std::size_t i = 1; i < loads.size(); ++i) {
    if (span_of(loads[i]).high > span_of(loads[most]).high) most = i;
  }
  return most;
}

Plot polar(const std::string& title, const std::string& x, const std::string& y, const std::vector<double>& along,
           const std::vector<double>& across, const Trace& trace) {
  Plot plot = plot_of(title, force_axis(x), force_axis(y));
  report::Series loop;
  loop.x = scaled(along, kKilo);
  loop.y = scaled(across, kKilo);
  loop.style.closed = true;
  std::vector<double> load(along.size());
  for (std::size_t i = 0; i < load.size(); ++i) load[i] = std::hypot(along[i], across[i]);
  const std::size_t peak = index_of_largest(load);
  report::Series centre{"", {0}, {0}, {}};
  centre.style.draw = report::Draw::points;
  centre.style.colour = 6;
  const std::string largest = report::format_number(load[peak] * kKilo, 3) + " kN";
  plot.markers.push_back({loop.x[peak], loop.y[peak], largest, 0});
  plot.caption = "Largest " + largest + ", at " + angle_text(trace.crank_deg[peak]) + ".";
  plot.series = {std::move(loop), std::move(centre)};
  use_equal_scales(plot);
  return plot;
}

std::string numbered(const char* what, std::size_t index) {
  return std::string(what) + " " + std::to_string(index + 1);
}

/// The cylinders on a crank pin: "1" or "1, 2".
std::string rods_on(const Layout& layout, std::size_t pin) {
  std::string text;
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    if (layout.pin[k] == pin) text += (text.empty() ? "" : ", ") + std::to_string(k + 1);
  }
  return text;
}

void add_load_row(report::Table& table, const Trace& trace, const std::string& name, const std::vector<double>& load) {
  const std::size_t at = index_of_largest(load);
  table.rows.push_back({name, report::format_fixed(load[at], 0), report::format_fixed(trace.crank_deg[at], 2),
                        report::format_fixed(mean_of(load), 0)});
}

}  // namespace

report::Section bearing_section(const ReportInput& input) {
  const Trace& trace = input.trace;
  const Layout& layout = input.exact.definition().layout;
  Section section{"bearings", "Crank pin and main journals", {}};
  section.blocks.push_back(Paragraph{
      "In the frame of the crankshaft, the loops show where pin and journal wear; in the frame of the block, where "
      "the bearing shells wear. The pin carries the rod force and the centrifugal force of the rod's big end; journals "
      "carry the throws beside them. Each throw is taken as simply supported between its two journals."});

  const std::size_t first_pin = layout.pin[0];
  Plot loop =
      polar("Crank pin load of cylinder 1, polar", "Radial, toward the crank centre", "Tangential, with the rotation",
            trace[Quantity::pin_radial], trace[Quantity::pin_tangential], trace);
  loop.caption += " The load as a vector; one unit is equally long on both axes. Grey dot: no load.";
  section.blocks.push_back(std::move(loop));
  Plot pin = with_extremes(plot_over_angle(input, "Crank pin load of cylinder 1", force_axis("Load"),
                                           {over_angle(trace, "", trace.pin_load_N[first_pin], kKilo)}));
  const std::string rods = rods_on(layout, first_pin);
  if (rods.find(',') != std::string::npos) pin.caption = "The pin is shared by the rods of cylinders " + rods + ".";
  section.blocks.push_back(std::move(pin));

  const std::size_t journal = most_loaded(trace.journal_load_N);
  Plot journal_loop = polar("Main " + numbered("journal", journal) + ", the most loaded, polar",
                            "Along the throw of the first pin, outward", "Across it, with the rotation",
                            trace.journal_along_N[journal], trace.journal_across_N[journal], trace);
  section.blocks.push_back(std::move(journal_loop));
  section.blocks.push_back(polar("Main " + numbered("bearing", journal) + ", the same load on the block, polar",
                                 "Lateral, 90 deg from up with the rotation", "Up", trace.journal_lateral_N[journal],
                                 trace.journal_up_N[journal], trace));
  std::vector<std::size_t> order(trace.journal_load_N.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return span_of(trace.journal_load_N[a]).high > span_of(trace.journal_load_N[b]).high;
  });
  const bool all = order.size() <= kMaxCurves;
  if (!all) order.resize(kMaxCurves);
  std::sort(order.begin(), order.end());
  std::vector<report::Series> curves;
  for (const std::size_t j : order)
    curves.push_back(over_angle(trace, numbered("journal", j), trace.journal_load_N[j], kKilo));
  Plot journals = plot_over_angle(input, "Main journal loads", force_axis("Load"), std::move(curves));
  if (has_gas(input) && layout.cylinders > 1) journals.bands = firings(layout);
  journals.caption = all ? "Numbered along the crankshaft." : "The six most loaded, numbered along the crankshaft.";
  section.blocks.push_back(std::move(journals));

  const std::vector<report::Column> columns{{"", "", false}, {"Largest load", "N"}, {"at", "deg"}, {"Mean load", "N"}};
  report::Table pins{"Crank pins", columns, {}, false};
  for (std::size_t i = 0; i < trace.pin_load_N.size(); ++i) {
    add_load_row(pins, trace, numbered("Pin", i) + " (cylinder " + rods_on(layout, i) + ")", trace.pin_load_N[i]);
  }
  section.blocks.push_back(std::move(pins));
  report::Table mains{"Main journals", columns, {}, false};
  for (std::size_t j = 0; j < trace.journal_load_N.size(); ++j)
    add_load_row(mains, trace, numbered("Journal", j), trace.journal_load_N[j]);
  section.blocks.push_back(std::move(mains));
  report::Table block{"Main bearings, in the frame of the block",
                      {{"", "", false},
                       {"Largest up", "N"},
                       {"Largest down", "N"},
                       {"Largest lateral", "N"},
                       {"Smallest lateral", "N"}},
                      {},
                      false};
  for (std::size_t j = 0; j < trace.journal_up_N.size(); ++j) {
    const Span up = span_of(trace.journal_up_N[j]);
    const Span lateral = span_of(trace.journal_lateral_N[j]);
    block.rows.push_back({numbered("Bearing", j), report::format_fixed(up.high, 0), report::format_fixed(-up.low, 0),
                          report::format_fixed(lateral.high, 0), report::format_fixed(lateral.low, 0)});
  }
  section.blocks.push_back(std::move(block));

  std::vector<AngleColumn> table{{"Pin radial", "N", &trace[Quantity::pin_radial]},
                                 {"Pin tangential", "N", &trace[Quantity::pin_tangential]},
                                 {"Pin load", "N", &trace.pin_load_N[first_pin]}};
  for (std::size_t j = 0; j < trace.journal_load_N.size(); ++j)
    table.push_back({numbered("Journal", j), "N", &trace.journal_load_N[j]});
  section.blocks.push_back(
      table_over_angle(trace, "Table: loads of the first crank pin and of the main journals", table));
  return section;
}

namespace {

/// Order by order, what counterweights and balance shafts leave.
void add_residual(const ReportInput& input, double w2, Section& section) {
  const EngineDefinition& definition = input.exact.definition();
  report::Table table{
      "With counterweights and balance shafts, largest over a turn",
      {{"", "", false}, {"Force alone", "N"}, {"Force left", "N"}, {"Moment alone", "Nm"}, {"Moment left", "Nm"}},
      {},
      false};
  for (const FreeOrder& order : free_orders(definition.crank)) {
    const TurningForce bare = free_force(definition, {}, order.order);
    const TurningForce left = free_force(definition, input.file.balancers(), order.order);
    std::string name = order.name;
    name[0] = static_cast<char>(name[0] - 'a' + 'A');
    table.rows.push_back({name + " order", report::format_fixed(peak_force_kg_m(bare) * w2, 1),
                          report::format_fixed(peak_force_kg_m(left) * w2, 1),
                          report::format_fixed(peak_moment_kg_m2(bare) * w2, 1),
                          report::format_fixed(peak_moment_kg_m2(left) * w2, 1)});
  }
  section.blocks.push_back(std::move(table));
  std::string list;
  for (const Balancer& balancer : input.file.balancers()) list += (list.empty() ? "" : ", ") + balancer.title;
  section.blocks.push_back(Paragraph{"The first order with the rotating masses. " + list +
                                     " of the file; they act on the mounts and are "
                                     "no part of the bearing loads above."});
}

}  // namespace

report::Section balance_section(const ReportInput& input) {
  const Trace& trace = input.trace;
  const EngineDefinition& definition = input.exact.definition();
  const double w2 = input.operation.speed_rad_s() * input.operation.speed_rad_s();
  const double unit_N =
      input.exact.definition().masses.reciprocating_kg() * input.exact.definition().crank.crank_radius_m * w2;
  Section section{"balance", "Free forces and moments", {}};
  section.blocks.push_back(Paragraph{
      "Forces and moments of the moving masses on the mounts; gas forces balance inside the engine. Moments are about "
      "the middle of the crankshaft. They are the engine's without counterweights and balance shafts" +
      std::string(input.file.balancers().empty() ? ", of which the file has none." : "; a table below has these.")});
  report::Table table{
      "Largest over a turn", {{"", "", false}, {"Force", "N"}, {"Relative", "%"}, {"Moment", "Nm"}}, {}, false};
  const auto row = [&](const std::string& name, const detail::RotatingVector<double>& t) {
    const double force = peak_force_kg_m(t) * w2;
    table.rows.push_back({name, report::format_fixed(force, 1), report::format_fixed(100 * force / unit_N, 1),
                          report::format_fixed(peak_moment_kg_m2(t) * w2, 1)});
  };
  const double noise_N = kNoise * unit_N;
  const double noise_Nm = noise_N * length_of(definition.layout);
  report::Table waves{"Amplitudes and phases", {{"", "", false}, {"Amplitude", "N, Nm"}, {"Phase", "deg"}}, {}, true};
  const auto wave = [&](const std::string& name, double cosine, double sine, double noise) {
    const Wave w = wave_of(cosine * w2, sine * w2);
    if (w.amplitude > noise)
      waves.rows.push_back({name, report::format_fixed(w.amplitude, 1), report::format_fixed(w.phase_deg, 1)});
  };
  const auto rows = [&](std::string name, const detail::RotatingVector<double>& t) {
    name[0] = static_cast<char>(name[0] - 'a' + 'A');
    row(name, t);
    wave(name + ", up", t.up_cos, t.up_sin, noise_N);
    wave(name + ", lateral", t.lateral_cos, t.lateral_sin, noise_N);
    wave(name + ", pitch", t.pitch_cos, t.pitch_sin, noise_Nm);
    wave(name + ", yaw", t.yaw_cos, t.yaw_sin, noise_Nm);
  };
  for (const FreeOrder& order : free_orders(definition.crank)) {
    rows(std::string(order.name) + " order", reciprocating_order(definition, order.order));
  }
  rows("rotating", balance_of(definition).rotating);
  section.blocks.push_back(std::move(table));
  section.blocks.push_back(
      Paragraph{"Relative to the first order of one cylinder: reciprocating mass times r \u03C9\u00B2, " +
                number_text(unit_N, 5) + " N. Orders are per crank turn: harmonics of the exact motion."});
  if (!input.file.balancers().empty()) add_residual(input, w2, section);
  if (!waves.rows.empty()) {
    section.blocks.push_back(std::move(waves));
    section.blocks.push_back(
        Paragraph{"Each is amplitude cos(order times engine angle - phase), rotating of order 1."});
  }

  std::vector<report::Series> forces;
  std::vector<report::Series> moments;
  const auto add = [&](const std::string& order, const FreeForceTrace& of) {
    add_if_any(forces, trace, order + ", up", of.up_N, kKilo, noise_N);
    add_if_any(forces, trace, order + ", lateral", of.lateral_N, kKilo, noise_N);
    add_if_any(moments, trace, order + ", pitch", of.pitch_Nm, 1, noise_Nm);
    add_if_any(moments, trace, order + ", yaw", of.yaw_Nm, 1, noise_Nm);
  };
  add("first order", trace.first);
  add("second order", trace.second);
  add("rotating", trace.rotating);
  section.blocks.push_back(Paragraph{forces.empty() && moments.empty() ? "All of these balance."
                                     : forces.empty()  ? "The forces of these orders balance, the moments do not."
                                     : moments.empty() ? "The moments of these orders balance."
                                                       : "Forces and moments that balance are not drawn."});
  const auto plot = [&](const std::string& title, const Axis& axis, std::vector<report::Series> curves,
                        const std::string& caption) {
    if (curves.empty()) return;
    const std::string of_one = curves.size() > 1 ? "" : ", " + curves[0].name;
    Plot drawn = plot_over_angle(input, title + of_one, axis, std::move(curves));
    drawn.bands.clear();
    drawn.caption = caption;
    section.blocks.push_back(std::move(drawn));
  };
  plot("Free forces", force_axis("Force"), std::move(forces),
       "Up is bank angle 0, lateral a quarter turn on in the sense of rotation.");
  plot("Free moments", moment_axis(), std::move(moments), "Pitch is of the forces up, yaw of the lateral ones.");
  Plot tilting = with_extremes(plot_over_angle(input, "Moment on the engine block about the crank axis", moment_axis(),
                                               {over_angle(trace, "", trace.tilting_moment_Nm, 1)}));
  tilting.bands.clear();
  tilting.caption =
      "Tilting moment of all cylinders, positive in the sense of rotation: what the mounts hold against the torque.";
  section.blocks.push_back(std::move(tilting));
  return section;
}

}  // namespace crankloop::program
