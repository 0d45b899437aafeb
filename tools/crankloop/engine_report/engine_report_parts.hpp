// Shared parts of the engine report's sections: angle axis, strokes, curves, tables over the crank angle.
//
// What belongs here: building blocks of the page. What does not: what a section shows (engine_report_*.cpp).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "../engine_file/pressure_words.hpp"
#include "../report/page.hpp"
#include "engine_report.hpp"

namespace crankloop::program {

// The sections, in the order of the page. Those that need gas pressure are left out where there is none.
[[nodiscard]] report::Section torque_section(const ReportInput& input);
[[nodiscard]] report::Section pressure_section(const ReportInput& input);
[[nodiscard]] report::Section gas_section(const ReportInput& input);  ///< of an engine with gas exchange
[[nodiscard]] report::Section motion_section(const ReportInput& input);
[[nodiscard]] report::Section force_section(const ReportInput& input);
[[nodiscard]] report::Section force_per_area_section(const ReportInput& input);
[[nodiscard]] report::Section bearing_section(const ReportInput& input);
[[nodiscard]] report::Section speed_section(const ReportInput& input);
[[nodiscard]] report::Section balance_section(const ReportInput& input);
[[nodiscard]] report::Section valve_section(const ReportInput& input);       ///< where there are valve trains
void add_flow_area(const ReportInput& input, report::Section& section);      ///< to the valve trains
void add_cam_loads(const ReportInput& input, report::Section& section);      ///< to the valve trains
void add_surge(const ReportInput& input, report::Section& section);          ///< to the valve trains
[[nodiscard]] report::Section crankshaft_section(const ReportInput& input);  ///< of two cylinders or more
[[nodiscard]] report::Section accuracy_section(const ReportInput& input);
[[nodiscard]] report::Section definition_section(const ReportInput& input);

[[nodiscard]] inline bool has_gas(const ReportInput& input) {
  return input.exact.definition().pressure.source != PressureSource::none;
}

[[nodiscard]] inline bool breathes(const ReportInput& input) { return breathes(input.exact.definition()); }

/// The source of the pressure in words: synthesised, the name of a table, or none.
[[nodiscard]] inline std::string pressure_remark(const ReportInput& input) {
  return pressure_in_words(input.file, input.operation.load_ratio, input.operation.gas);
}

using report::axis_of;
using report::number_text;
using report::plot_of;

/// 0 to 720 deg, 0 = firing top dead centre of cylinder 1: the axis title states the convention.
[[nodiscard]] report::Axis crank_axis();

/// Power, exhaust, intake and compression of cylinder 1, between its true dead centres.
[[nodiscard]] std::vector<report::Band> strokes(const Crank& crank);

/// From each firing to the next, by cylinder; cylinders that fire together share a band.
[[nodiscard]] std::vector<report::Band> firings(const Layout& layout);

/// The values of a curve times a factor: from SI to the unit of a plot.
[[nodiscard]] std::vector<double> scaled(const std::vector<double>& values, double factor);

/// A curve over the crank angle.
[[nodiscard]] report::Series over_angle(const Trace& trace, const std::string& name, const std::vector<double>& values,
                                        double factor);

/// A plot over the crank angle with the strokes behind its curves.
[[nodiscard]] report::Plot plot_over_angle(const ReportInput& input, const std::string& title, const report::Axis& y,
                                           std::vector<report::Series> curves);

/// A loop over the piston's displacement or the cylinder's volume, in a colour for each stroke.
[[nodiscard]] std::vector<report::Series> loop_by_strokes(const ReportInput& input, const std::vector<double>& x,
                                                          const std::vector<double>& y);

/// "6960 kPa at 9.5 deg" on the point of a loop that belongs to entry i of the trace.
[[nodiscard]] report::Marker loop_marker(const Trace& trace, const std::vector<double>& x, const std::vector<double>& y,
                                         std::size_t i, const std::string& unit, std::size_t series);

/// Where a curve is largest. Of peaks that are equal but for rounding, the first: in a four-cylinder torque all four
/// are.
[[nodiscard]] std::size_t index_of_largest(const std::vector<double>& values);
[[nodiscard]] std::size_t index_of_smallest(const std::vector<double>& values);

/// "45.6 kN at 9.5 deg" on the largest or smallest value of a curve over the crank angle.
[[nodiscard]] report::Marker largest_marker(const report::Plot& plot, std::size_t series);
[[nodiscard]] report::Marker smallest_marker(const report::Plot& plot, std::size_t series);

/// Marks the largest and smallest value of every curve.
[[nodiscard]] report::Plot with_extremes(report::Plot plot);

/// Bars of a Fourier series' amplitudes in `unit` over the orders, the largest with its value.
[[nodiscard]] report::Plot plot_over_orders(const std::string& title, const std::string& order_title,
                                            const std::string& unit, std::vector<double> orders,
                                            std::vector<double> amplitudes);

/// A column of a table over the crank angle: values in SI, one for each entry of the trace.
struct AngleColumn {
  std::string title;
  std::string unit;
  const std::vector<double>* values;
  double factor = 1;
};

/// A folded table, one row each 10 deg up to last_deg; five digits of each column's largest magnitude.
[[nodiscard]] report::Table table_over_angle(const Trace& trace, const std::string& caption,
                                             const std::vector<AngleColumn>& columns, double last_deg = 720);

/// Sets both axes' ranges so that the data fill the drawing and a unit is equally long on either: for polar diagrams.
void use_equal_scales(report::Plot& plot);

/// A unit of engine file or CSV as it is printed: "kg mm\u00B2" for "kg_mm2", "m/s\u00B2" for "m/s^2".
[[nodiscard]] std::string pretty_unit(std::string unit);

/// "704.25 deg".
[[nodiscard]] std::string angle_text(double deg);

/// Decimals that give `digits` significant digits to a value of this size; 0 to 6.
[[nodiscard]] int decimals_for(double largest, int digits);

/// Largest and smallest of some values.
struct Span {
  double low = 0;
  double high = 0;
};
[[nodiscard]] Span span_of(const std::vector<double>& values);

}  // namespace crankloop::program
