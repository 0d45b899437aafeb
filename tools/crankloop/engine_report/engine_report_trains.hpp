// The valve trains of cylinder 1 as the report shows them: data for its plots and tables.
//
// What belongs here: curves and figures of a train. What does not: how they are drawn (engine_report_valves.cpp) or set
// in a table (engine_report_valve_results.cpp).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <crankloop/tabulate/spring_margin.hpp>

#include "engine_report_parts.hpp"

namespace crankloop::program {

/// Motion of rigid parts at the speed of the run, over the trace's angles; 0 while the lash is open.
struct RigidMotion {
  std::vector<double> velocity_m_s{};
  std::vector<double> acceleration_m_s2{};
  std::vector<double> jerk_m_s3{};
};

/// The data of one train of cylinder 1.
struct ShownTrain {
  std::string name;
  const ValveTrace& trace;
  std::size_t full_lift;  ///< entry of the trace with the largest theoretical lift
  double lobe_begin_deg;  ///< crank angle at which the lobe begins, in [0, 720)
  double largest_theory_m;
  double seat_contact_m;  ///< lift at which the valve touches its seat
  double open_Hz;
  double seated_Hz;
  StaticRedline rigid;
  double spring_margin;  ///< least, at the speed of the run
  double margin_at_deg;  ///< its crank angle
  RigidMotion theory;
  double cam_rad_s;
  double least_radius_m;  ///< of the cam's curvature
};

/// Those that are complete, in the file's order.
[[nodiscard]] std::vector<ShownTrain> trains_of(const ReportInput& input);

/// Converts cam degrees from the start of the lobe, as the tick counts them, to the crank angle of cylinder 1.
[[nodiscard]] double crank_deg(const ShownTrain& train, double since_opening_deg);

/// Entries of a cycle in the order of a lobe: from the base circle before full lift to that behind it.
[[nodiscard]] std::vector<std::size_t> entries_of_lobe(const ShownTrain& train);

/// Index in entries_of_lobe() at which the valve first touches its seat after full lift; their count if it does not.
[[nodiscard]] std::size_t seating_place(const ShownTrain& train, const std::vector<std::size_t>& entries);

/// Results of the cycle, a column for each train.
[[nodiscard]] report::Table results_table(const std::vector<ShownTrain>& trains);

/// A train's curves over the crank angle.
[[nodiscard]] report::Table table_of_train(const ReportInput& input, const ShownTrain& train);

}  // namespace crankloop::program
