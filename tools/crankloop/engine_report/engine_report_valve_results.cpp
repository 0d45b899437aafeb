// Tables of the valve trains: results of the cycle, and curves over the crank angle.
#include <algorithm>
#include <cmath>
#include <utility>

#include "../files/units.hpp"
#include "engine_report_trains.hpp"

namespace crankloop::program {

report::Table results_table(const std::vector<ShownTrain>& trains) {
  report::Table table{"Results of the cycle", {{"", "", false}, {"Unit", "", false}}, {}, false};
  for (const ShownTrain& train : trains) table.columns.push_back({train.name, ""});
  const auto row = [&](const char* name, const char* unit, const auto& value) {
    std::vector<std::string> cells{name, unit};
    for (const ShownTrain& train : trains) cells.push_back(value(train, train.trace.cycle));
    table.rows.push_back(std::move(cells));
  };
  using Cycle = ValveCycle<double>;
  const auto largest = [](const ShownTrain& train, ValveQuantity quantity) {
    return number_text(span_of(train.trace[quantity]).high, 4);
  };
  row("Largest theoretical lift", "mm",
      [](const ShownTrain& t, const Cycle&) { return number_text(t.largest_theory_m * kMilli, 5); });
  row("Largest lift", "mm",
      [](const ShownTrain&, const Cycle& c) { return number_text(c.largest_lift_m * kMilli, 5); });
  row("Largest speed", "m/s", [](const ShownTrain&, const Cycle& c) { return number_text(c.largest_speed_m_s, 4); });
  row("Largest acceleration", "m/s\u00B2",
      [](const ShownTrain&, const Cycle& c) { return number_text(c.largest_acceleration_m_s2, 4); });
  const auto theory = [&](const char* name, const char* unit, const char* unit_per_rad, int order, const auto& value) {
    row(name, unit, [&](const ShownTrain& t, const Cycle&) { return number_text(value(t.theory), 4); });
    row("per cam angle", unit_per_rad, [&](const ShownTrain& t, const Cycle&) {
      return number_text(value(t.theory) / std::pow(t.cam_rad_s, order) * kMilli, 4);
    });
  };
  theory("Largest theoretical speed", "m/s", "mm/rad", 1,
         [](const RigidMotion& t) { return std::max(span_of(t.velocity_m_s).high, -span_of(t.velocity_m_s).low); });
  theory("Largest theoretical acceleration", "m/s\u00B2", "mm/rad\u00B2", 2,
         [](const RigidMotion& t) { return span_of(t.acceleration_m_s2).high; });
  theory("Least theoretical acceleration", "m/s\u00B2", "mm/rad\u00B2", 2,
         [](const RigidMotion& t) { return span_of(t.acceleration_m_s2).low; });
  row("Least radius of the cam's curvature", "mm",
      [](const ShownTrain& t, const Cycle&) { return number_text(t.least_radius_m * kMilli, 4); });
  row("Opening delay at 0.1 mm, cam angle", "deg", [](const ShownTrain&, const Cycle& c) {
    return has_opening_delay(c) ? number_text(c.opening_delay_deg, 3) : std::string("\u2013");
  });
  row("Separations", "", [](const ShownTrain&, const Cycle& c) { return std::to_string(c.separations); });
  row("Largest gap", "\u00B5m",
      [](const ShownTrain&, const Cycle& c) { return number_text(c.separation_clearance_m * kMicro, 3); });
  row("its start, crank angle", "deg", [](const ShownTrain& t, const Cycle& c) {
    return c.separations > 0 ? report::format_fixed(crank_deg(t, c.separation_start_deg), 1) : std::string("\u2013");
  });
  row("its duration, crank angle", "deg", [](const ShownTrain&, const Cycle& c) {
    return c.separations > 0 ? report::format_fixed(2 * c.separation_duration_deg, 1) : std::string("\u2013");
  });
  row("Seating speed", "m/s", [](const ShownTrain&, const Cycle& c) { return number_text(c.seating_speed_m_s, 3); });
  row("Bounces", "", [](const ShownTrain&, const Cycle& c) { return std::to_string(c.bounces); });
  row("Largest bounce", "\u00B5m",
      [](const ShownTrain&, const Cycle& c) { return number_text(c.bounce_height_m * kMicro, 3); });
  row("Largest force between cam and follower", "N",
      [&](const ShownTrain& t, const Cycle&) { return largest(t, ValveQuantity::cam_force); });
  row("Largest force of the train", "N",
      [&](const ShownTrain& t, const Cycle&) { return largest(t, ValveQuantity::train_force); });
  row("Largest force of the seat", "N",
      [&](const ShownTrain& t, const Cycle&) { return largest(t, ValveQuantity::seat_force); });
  row("Least spring margin, rigid parts", "", [](const ShownTrain& t, const Cycle&) {
    return std::isfinite(t.spring_margin) ? number_text(t.spring_margin, 3) : std::string("\u2013");
  });
  row("its place, crank angle", "deg", [](const ShownTrain& t, const Cycle&) {
    return std::isfinite(t.spring_margin) ? report::format_fixed(t.margin_at_deg, 1) : std::string("\u2013");
  });
  row("Static redline", "rpm", [](const ShownTrain& t, const Cycle&) {
    return t.rigid.crank_rad_s > 0 ? number_text(t.rigid.crank_rad_s * kRpmPerRad_s, 4) : std::string("\u2013");
  });
  row("Natural frequency, open", "Hz", [](const ShownTrain& t, const Cycle&) { return number_text(t.open_Hz, 4); });
  row("Natural frequency, on the seat", "Hz",
      [](const ShownTrain& t, const Cycle&) { return number_text(t.seated_Hz, 4); });
  return table;
}

report::Table table_of_train(const ReportInput& input, const ShownTrain& train) {
  const auto column = [&](const char* title, const char* unit, ValveQuantity quantity, double factor) {
    return AngleColumn{title, unit, &train.trace[quantity], factor};
  };
  return table_over_angle(
      input.trace, "Table: " + train.name + " valve",
      {column("Theoretical lift", "mm", ValveQuantity::theoretical_lift, kMilli),
       column("Lift", "mm", ValveQuantity::lift, kMilli), column("Velocity", "m/s", ValveQuantity::velocity, 1),
       column("Acceleration", "m/s\u00B2", ValveQuantity::acceleration, 1),
       column("Train force", "N", ValveQuantity::train_force, 1),
       column("Seat force", "N", ValveQuantity::seat_force, 1), column("Cam force", "N", ValveQuantity::cam_force, 1)});
}

}  // namespace crankloop::program
