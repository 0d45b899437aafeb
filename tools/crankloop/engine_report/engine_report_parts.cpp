#include "engine_report_parts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include <crankloop/tabulate/mechanism.hpp>

namespace crankloop::program {
namespace {

constexpr double kRowDeg = 10;
constexpr int kTableDigits = 5;

// Approximate ratio of width to height of plot.hpp's frame without legend and bands; the exact ratio depends on the
// labels.
constexpr double kFrameRatio = 1.7;

constexpr double kEqualPeaks =
    1e-5;  // of a curve's span: float's rounding and the table's error, much less than a visible difference

report::Marker marker_at(const report::Plot& plot, std::size_t series, std::size_t i) {
  const double value = plot.series[series].y[i];
  const Span span = span_of(plot.series[series].y);
  const bool is_rounding = std::abs(value) < kEqualPeaks * (span.high - span.low);
  return {plot.series[series].x[i], value,
          (is_rounding ? "0" : report::format_number(value, 3)) + " " + plot.y.unit + " at " +
              angle_text(plot.series[series].x[i]),
          series};
}

/// Part of a curve between two crank angles, across the end of the cycle if need be.
report::Series piece(const Trace& trace, const std::string& name, const std::vector<double>& x,
                     const std::vector<double>& y, double from_deg, double to_deg) {
  report::Series series;
  series.name = name;
  const auto count = static_cast<long>(trace.crank_deg.size()) - 1;  // the last point is the first of the next cycle
  const auto at = [&](double deg) { return std::lround(deg / trace.spacing_deg); };
  for (long i = at(from_deg); i <= at(to_deg); ++i) {
    const auto k = static_cast<std::size_t>((i % count + count) % count);
    series.x.push_back(x[k]);
    series.y.push_back(y[k]);
  }
  return series;
}

}  // namespace

report::Axis crank_axis() {
  report::Axis axis = axis_of("Crank angle from cylinder 1's firing TDC", "deg");
  axis.tick_step = 90;
  axis.range = report::Range{0, 720};
  return axis;
}

std::vector<report::Band> strokes(const Crank& crank) {
  const DeadCentres centres = dead_centres(crank);
  const double tdc = centres.tdc_rad * kDegPerRad;
  const double bdc = centres.bdc_rad * kDegPerRad;
  return {{std::max(0.0, tdc), bdc, "power"},
          {bdc, tdc + 360, "exhaust"},
          {tdc + 360, bdc + 360, "intake"},
          {bdc + 360, std::min(720.0, tdc + 720), "compression"}};
}

std::vector<report::Band> firings(const Layout& layout) {
  std::map<double, std::string> at;
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    const double after_first = layout.firing_deg[k] - layout.firing_deg[0];
    std::string& label = at[after_first < 0 ? after_first + 720 : after_first];
    label += (label.empty() ? "" : "+") + std::to_string(k + 1);
  }
  std::vector<report::Band> bands;
  for (auto one = at.begin(); one != at.end(); ++one) {
    const auto next = std::next(one);
    bands.push_back({one->first, next == at.end() ? 720 : next->first, "cyl. " + one->second});
  }
  return bands;
}

std::vector<double> scaled(const std::vector<double>& values, double factor) {
  std::vector<double> result(values.size());
  std::transform(values.begin(), values.end(), result.begin(), [factor](double value) { return value * factor; });
  return result;
}

report::Series over_angle(const Trace& trace, const std::string& name, const std::vector<double>& values,
                          double factor) {
  report::Series series;
  series.name = name;
  series.x = trace.crank_deg;
  series.y = scaled(values, factor);
  return series;
}

report::Plot plot_over_angle(const ReportInput& input, const std::string& title, const report::Axis& y,
                             std::vector<report::Series> curves) {
  report::Plot plot = plot_of(title, crank_axis(), y);
  plot.series = std::move(curves);
  if (has_gas(input)) plot.bands = strokes(input.exact.definition().crank);
  return plot;
}

std::vector<report::Series> loop_by_strokes(const ReportInput& input, const std::vector<double>& x,
                                            const std::vector<double>& y) {
  const DeadCentres centres = dead_centres(input.exact.definition().crank);
  const double tdc = centres.tdc_rad * kDegPerRad;
  const double bdc = centres.bdc_rad * kDegPerRad;
  if (!has_gas(input))
    return {piece(input.trace, "down", x, y, tdc, bdc), piece(input.trace, "up", x, y, bdc, tdc + 360)};
  return {piece(input.trace, "power", x, y, tdc, bdc), piece(input.trace, "exhaust", x, y, bdc, tdc + 360),
          piece(input.trace, "intake", x, y, tdc + 360, bdc + 360),
          piece(input.trace, "compression", x, y, bdc + 360, tdc + 720)};
}

report::Plot with_extremes(report::Plot plot) {
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    plot.markers.push_back(largest_marker(plot, i));
    plot.markers.push_back(smallest_marker(plot, i));
  }
  return plot;
}

std::size_t index_of_largest(const std::vector<double>& values) {
  const Span span = span_of(values);
  const double enough = span.high - kEqualPeaks * (span.high - span.low);
  std::size_t i = 0;
  while (i + 1 < values.size() && values[i] < enough) ++i;
  while (i + 1 < values.size() && values[i + 1] > values[i]) ++i;  // the top of this peak
  return i;
}

std::size_t index_of_smallest(const std::vector<double>& values) { return index_of_largest(scaled(values, -1)); }

report::Marker largest_marker(const report::Plot& plot, std::size_t series) {
  return marker_at(plot, series, index_of_largest(plot.series[series].y));
}

report::Marker smallest_marker(const report::Plot& plot, std::size_t series) {
  return marker_at(plot, series, index_of_smallest(plot.series[series].y));
}

report::Plot plot_over_orders(const std::string& title, const std::string& order_title, const std::string& unit,
                              std::vector<double> orders, std::vector<double> amplitudes) {
  report::Plot plot = plot_of(title, axis_of(order_title, ""), axis_of("Amplitude", unit));
  plot.x.tick_step = 1;
  const std::size_t most = index_of_largest(amplitudes);
  plot.markers.push_back(
      {orders[most], amplitudes[most],
       report::format_number(amplitudes[most], 3) + " " + unit + " at order " + number_text(orders[most]), 0});
  report::Series bars{"", std::move(orders), std::move(amplitudes)};
  bars.style.draw = report::Draw::bar;
  plot.series.push_back(std::move(bars));
  return plot;
}

report::Table table_over_angle(const Trace& trace, const std::string& caption, const std::vector<AngleColumn>& columns,
                               double last_deg) {
  report::Table table;
  table.caption = caption;
  table.folded = true;
  table.columns.push_back({"Crank", "deg"});
  std::vector<int> decimals;
  for (const AngleColumn& column : columns) {
    table.columns.push_back({column.title, column.unit});
    const Span span = span_of(*column.values);
    decimals.push_back(decimals_for(std::max(-span.low, span.high) * column.factor, kTableDigits));
  }
  const auto stride = static_cast<std::size_t>(std::lround(kRowDeg / trace.spacing_deg));
  for (std::size_t i = 0; i < trace.crank_deg.size() && trace.crank_deg[i] <= last_deg; i += stride) {
    std::vector<std::string> row{report::format_fixed(trace.crank_deg[i], 0)};
    for (std::size_t c = 0; c < columns.size(); ++c) {
      row.push_back(report::format_fixed((*columns[c].values)[i] * columns[c].factor, decimals[c]));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Marker loop_marker(const Trace& trace, const std::vector<double>& x, const std::vector<double>& y,
                           std::size_t i, const std::string& unit, std::size_t series) {
  return {x[i], y[i], report::format_number(y[i], 3) + " " + unit + " at " + angle_text(trace.crank_deg[i]), series};
}

void use_equal_scales(report::Plot& plot) {
  report::Range x{0, 0};  // the origin belongs to a polar diagram
  report::Range y{0, 0};
  for (const report::Series& series : plot.series) {
    for (const double value : series.x) x = {std::min(x.low, value), std::max(x.high, value)};
    for (const double value : series.y) y = {std::min(y.low, value), std::max(y.high, value)};
  }
  constexpr double kMargin = 1.35;  // room for a label beside the loop
  const double height = kMargin * std::max({y.high - y.low, (x.high - x.low) / kFrameRatio, 1e-9});
  const double width = height * kFrameRatio;
  const auto around = [](report::Range range, double span) {
    const double middle = (range.low + range.high) / 2;
    return report::Range{middle - span / 2, middle + span / 2};
  };
  plot.equal_scales = true;
  plot.x.range = around(x, width);
  plot.y.range = around(y, height);
  const double decade = std::pow(10, std::floor(std::log10(height / 3)));
  const double step = height / 3 / decade;
  plot.x.tick_step = plot.y.tick_step = decade * (step >= 5 ? 5 : step >= 2 ? 2 : 1);
}

std::string pretty_unit(std::string unit) {
  const auto replace = [&unit](const std::string& what, const std::string& by) {
    for (std::size_t at = unit.find(what); at != std::string::npos; at = unit.find(what))
      unit.replace(at, what.size(), by);
  };
  replace("_per_", "/");
  replace("_", " ");
  replace("^", "");
  replace("2", "\u00B2");
  replace("3", "\u00B3");
  return unit;
}

std::string angle_text(double deg) { return number_text(deg, 5) + " deg"; }

int decimals_for(double largest, int digits) {
  if (!(largest > 0)) return 0;
  return std::clamp(digits - 1 - static_cast<int>(std::floor(std::log10(largest))), 0, 6);
}

Span span_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, *high};
}

}  // namespace crankloop::program
