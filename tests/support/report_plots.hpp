// Plots for the tests of the report.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "crankloop/report/plot.hpp"

namespace crankloop::report {

/// A cylinder pressure at 0.1 deg: a narrow peak 8.3 deg after firing TDC.
inline Series pressure_trace() {
  Series series;
  series.name = "pressure";
  for (int i = 0; i <= 7200; ++i) {
    const double deg = 0.1 * i;
    series.x.push_back(deg);
    series.y.push_back(1 + 77.3 * std::exp(-std::pow((deg - 8.3) / 14, 2)) +
                       40 * std::exp(-std::pow((deg - 720) / 30, 2)));
  }
  return series;
}

inline Plot plot_of(std::vector<Series> series) {
  Plot plot;
  plot.id = "p";
  plot.title = "Cylinder pressure";
  plot.x.title = "Crank angle";
  plot.x.unit = "deg";
  plot.y.title = "Pressure";
  plot.y.unit = "bar";
  plot.series = std::move(series);
  return plot;
}

}  // namespace crankloop::report
