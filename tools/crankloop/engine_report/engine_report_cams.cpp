// What the cams bear, in the report's section of the valve trains: stress of their contacts, torque of the camshaft.
#include <cmath>
#include <memory>
#include <utility>

#include <crankloop/tabulate/valve_lift.hpp>

#include "../loops/cam_loads.hpp"
#include "../loops/harmonics.hpp"
#include "engine_report_parts.hpp"

namespace crankloop::program {
namespace {

using report::Plot;
using report::Series;

constexpr double kMPaPerPa = 1e-6;

/// The cam of one train in cylinder 1, over the trace's angles.
struct TrainLoads {
  const TrainOfFile& train;
  std::size_t number;  ///< among all complete trains, for its colour
  std::vector<double> stress_Pa{};
  std::vector<double> torque_Nm{};
  StaticStress at_rest{};
  CamLoadsOfCycle cycle;
  double full_lift_deg = 0;
};

std::vector<TrainLoads> loads_of(const ReportInput& input) {
  const EngineDefinition& definition = input.exact.definition();
  const std::vector<std::string> names = names_of_trains(input.file);
  const double cam_rad_s = input.operation.speed_rad_s() / 2;
  std::vector<TrainLoads> all;
  const auto lift = std::make_unique<ValveLift>();
  for (std::size_t t = 0; t < input.trace.valves.size(); ++t) {
    const TrainOfFile& train = input.file.train(names[t]);
    if (!lift->init(definition.trains[t].cam, definition.trains[t].rocker).ok()) continue;  // the loop has accepted it
    TrainLoads loads{train,
                     t,
                     {},
                     {},
                     static_stress(*lift, definition.trains[t], train.contact),
                     CamLoadsOfCycle(train.stress_limit_Pa),
                     definition.trains[t].cam.full_lift_deg};
    const std::vector<double>& force_N = input.trace.valves[t][ValveQuantity::train_force];
    for (std::size_t i = 0; i < force_N.size(); ++i) {
      const double cam_deg = (input.trace.crank_deg[i] - loads.full_lift_deg) / 2;
      const CamLoads here = cam_loads_at(*lift, train.contact, cam_deg * kRadPerDeg, cam_rad_s, force_N[i]);
      loads.cycle.add(cam_deg, here);
      loads.stress_Pa.push_back(here.stress_Pa);
      loads.torque_Nm.push_back(here.torque_Nm);
    }
    all.push_back(std::move(loads));
  }
  return all;
}

/// Of all cylinders, which run alike one after another, over cylinder 1's angle.
std::vector<double> camshaft_Nm(const ReportInput& input, const std::vector<TrainLoads>& all) {
  const Layout& layout = input.exact.definition().layout;
  const std::size_t count = input.trace.crank_deg.size() - 1;  // the last is the first of the next cycle
  std::vector<double> sum_Nm(count + 1, 0);
  for (int k = 0; k < layout.cylinders; ++k) {
    const double behind_deg = layout.firing_deg[static_cast<std::size_t>(k)] - layout.firing_deg[0];
    for (std::size_t i = 0; i <= count; ++i) {
      double place = std::fmod((input.trace.crank_deg[i] - behind_deg + 1440) / input.trace.spacing_deg,
                               static_cast<double>(count));
      const auto before = static_cast<std::size_t>(place);
      place -= static_cast<double>(before);
      for (const TrainLoads& loads : all) {
        const double one_Nm =
            loads.torque_Nm[before % count] * (1 - place) + loads.torque_Nm[(before + 1) % count] * place;
        sum_Nm[i] += one_Nm * loads.train.definition.valve.per_cylinder;
      }
    }
  }
  return sum_Nm;
}

Plot stress_plot(const ReportInput& input, const std::vector<TrainLoads>& all) {
  std::vector<Series> curves;
  std::string limits;
  for (const TrainLoads& loads : all) {
    if (!(loads.train.contact.width_m > 0)) continue;
    curves.push_back(over_angle(input.trace, loads.train.name, loads.stress_Pa, kMPaPerPa));
    curves.back().style.colour = static_cast<int>(loads.number) + 1;
    if (loads.train.stress_limit_Pa > 0) limits += " " + loads.train.name + loads.cycle.limit_in_words() + ".";
  }
  Plot plot =
      plot_over_angle(input, "Stress between cam and follower", axis_of("Largest pressure", "MPa"), std::move(curves));
  for (std::size_t i = 0; i < plot.series.size(); ++i) plot.markers.push_back(largest_marker(plot, i));
  plot.caption = "Largest pressure of a line of contact, by Hertz, of the cams of cylinder 1." + limits;
  return plot;
}

Plot torque_plot(const ReportInput& input, const std::vector<TrainLoads>& all, const std::vector<double>& shaft_Nm) {
  std::vector<Series> curves{over_angle(input.trace, "camshaft", shaft_Nm, 1)};
  curves[0].style.colour = kMaxTrains + 1;  // beside those of the trains
  for (const TrainLoads& loads : all) {
    curves.push_back(over_angle(input.trace, loads.train.name, loads.torque_Nm, 1));
    curves.back().style.colour = static_cast<int>(loads.number) + 1;
  }
  Plot plot = plot_over_angle(input, "Torque of the camshaft", axis_of("Torque", "Nm"), std::move(curves));
  plot.caption =
      "Against the rotation above zero: of one cam of each train in cylinder 1, and of all cams of the engine.";
  return plot;
}

/// What a chain, a belt or gears on the camshaft are excited by.
Plot orders_plot(const std::vector<double>& shaft_Nm) {
  constexpr int kOrders = 24;
  const std::vector<double> one_turn(shaft_Nm.begin(), shaft_Nm.end() - 1);
  std::vector<double> orders;
  for (int n = 1; n <= kOrders; ++n) orders.push_back(n);
  Plot plot = plot_over_orders("Orders of the camshaft's torque", "Order per camshaft revolution", "Nm",
                               std::move(orders), harmonic_amplitudes(one_turn, kOrders));
  plot.x.tick_step = 2;
  plot.caption = "Amplitudes of the torque of all cams: what excites the camshaft's drive.";
  return plot;
}

report::Table loads_table(const std::vector<TrainLoads>& all, const std::vector<double>& shaft_Nm, double cam_rad_s) {
  report::Table table{"Loads of the cams", {{"", "", false}, {"Unit", "", false}}, {}, false};
  for (const TrainLoads& loads : all) table.columns.push_back({loads.train.name, ""});
  const auto row = [&](const char* name, const char* unit, const auto& value) {
    std::vector<std::string> cells{name, unit};
    for (const TrainLoads& loads : all) cells.push_back(value(loads));
    table.rows.push_back(std::move(cells));
  };
  using Loads = TrainLoads;
  const auto crank_deg = [](const Loads& l, double cam_deg) {
    return report::format_fixed(std::fmod(l.full_lift_deg + 2 * cam_deg + 1440, 720), 1);
  };
  const auto of_width = [](const Loads& l, const std::string& text) {
    return l.train.contact.width_m > 0 ? text : std::string("\u2013");
  };
  row("Largest stress of the contact", "MPa",
      [&](const Loads& l) { return of_width(l, number_text(l.cycle.stress().value * kMPaPerPa, 4)); });
  row("its place, crank angle", "deg",
      [&](const Loads& l) { return of_width(l, crank_deg(l, l.cycle.stress().cam_deg)); });
  row("Stress at standstill, rigid parts", "MPa",
      [&](const Loads& l) { return of_width(l, number_text(l.at_rest.largest_Pa * kMPaPerPa, 4)); });
  row("Limit of the stress", "MPa", [](const Loads& l) {
    return l.train.stress_limit_Pa > 0 ? number_text(l.train.stress_limit_Pa * kMPaPerPa, 4) : std::string("\u2013");
  });
  row("Fastest sliding", "m/s", [](const Loads& l) { return number_text(l.cycle.sliding().value, 4); });
  row("Least entrainment", "m/s", [](const Loads& l) { return number_text(l.cycle.least_entrainment().value, 3); });
  row("Largest entrainment", "m/s", [](const Loads& l) { return number_text(l.cycle.largest_entrainment().value, 3); });
  row("Largest torque of one cam", "Nm", [](const Loads& l) { return number_text(l.cycle.largest_torque().value, 4); });
  row("Least torque of one cam", "Nm", [](const Loads& l) { return number_text(l.cycle.least_torque().value, 4); });
  row("Mean power of one cam", "W",
      [&](const Loads& l) { return number_text(l.cycle.mean_torque_Nm() * cam_rad_s, 4); });
  double mean_Nm = 0;
  for (std::size_t i = 0; i + 1 < shaft_Nm.size(); ++i)
    mean_Nm += shaft_Nm[i] / static_cast<double>(shaft_Nm.size() - 1);
  table.rows.push_back({"Mean power of all cams", "W", number_text(mean_Nm * cam_rad_s, 4)});
  while (table.rows.back().size() < table.columns.size()) table.rows.back().push_back("");
  return table;
}

}  // namespace

void add_cam_loads(const ReportInput& input, report::Section& section) {
  const std::vector<TrainLoads> all = loads_of(input);
  bool any = false;
  for (const TrainLoads& loads : all) any = any || loads.train.contact.width_m > 0;
  if (!any) return;
  const std::vector<double> shaft_Nm = camshaft_Nm(input, all);
  section.blocks.push_back(stress_plot(input, all));
  section.blocks.push_back(torque_plot(input, all, shaft_Nm));
  section.blocks.push_back(orders_plot(shaft_Nm));
  section.blocks.push_back(loads_table(all, shaft_Nm, std::abs(input.operation.speed_rad_s()) / 2));
}

}  // namespace crankloop::program
