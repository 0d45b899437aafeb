// Ways to keep a pressure trace, and ways to join its given points (docs/decisions/0004-pressure.md).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/tabulate.hpp>

#include "support/diagrams.hpp"
#include "support/pressure_traces.hpp"
#include "tabulate/monotone_cubic.hpp"

namespace {

using namespace crankloop;
using namespace crankloop::detail;

constexpr double kBar = 1e5;

EngineDefinition engine_with(const std::vector<DiagramPoint>& rows) {
  EngineDefinition engine;
  engine.crank = {0.095, 0.0575, 0.210, 0, 19};
  engine.masses.piston_kg = 1;
  engine.pressure = support::table_pressure(PressureSource::angle_table, rows);
  return engine;
}

/// Angles between which every way is compared with the diagram: a hundred in a degree.
template <class Pressure>
double largest_error_bar(const IndicatorDiagram& diagram, const Pressure& pressure) {
  double worst = 0;
  for (int i = 0; i < 72000; ++i) worst = std::max(worst, std::fabs(pressure(i / 100.0) - diagram.full_Pa(i / 100.0)));
  return worst / kBar;
}

/// Float values at equal steps, straight between them.
double linear_error_bar(const IndicatorDiagram& diagram, int per_degree) {
  std::vector<float> at;
  for (int i = 0; i <= 720 * per_degree; ++i)
    at.push_back(static_cast<float>(diagram.full_Pa(static_cast<double>(i) / per_degree)));
  return largest_error_bar(diagram, [&](double deg) {
    const auto i = static_cast<std::size_t>(deg * per_degree);
    const auto u = static_cast<float>(deg * per_degree - static_cast<double>(i));
    return static_cast<double>(at[i] + u * (at[i + 1] - at[i]));
  });
}

void compare(const char* trace, const std::vector<DiagramPoint>& rows) {
  const EngineDefinition engine = engine_with(rows);
  IndicatorDiagram diagram;
  if (!diagram.init(engine.crank, engine.pressure).ok()) std::exit(1);
  std::printf("\n| %s | segments | float bytes | largest error, bar |\n| --- | --- | --- | --- |\n", trace);
  for (const int per_degree : {1, 5, 10}) {
    std::printf("| linear, %d per degree | %d | %d | %.2g |\n", per_degree, 720 * per_degree, 2880 * per_degree,
                linear_error_bar(diagram, per_degree));
  }
  for (const int capacity : {720, 1500, 4096, static_cast<int>(kMaxGasSegments)}) {
    std::vector<Segment<float>> segments(static_cast<std::size_t>(capacity));
    GasGrid grid{};
    TableTargets<float> targets;
    targets.gas_grid = &grid;
    targets.gas_capacity = capacity;
    targets.pressure_full = segments.data();
    TableReport report;
    if (!tabulate(engine, {}, targets, &report).ok()) std::exit(1);
    const double worst = largest_error_bar(diagram, [&](double deg) {
      const auto degree = static_cast<std::uint32_t>(deg);
      const double u = deg - degree;
      const std::uint32_t segment = grid.segment({degree, static_cast<std::uint32_t>(u * 4294967296.0), 0});
      return static_cast<double>(value(segments[segment], static_cast<float>(u)));
    });
    std::printf("| crankloop, room for %d | %d | %zu | %.2g |\n", capacity, report.gas_segments,
                static_cast<std::size_t>(report.gas_segments) * sizeof(Segment<float>) + sizeof(GasGrid), worst);
  }
}

/// A cubic by the slopes of the chords of the points on either side.
double catmull_rom(detail::Point p0, detail::Point p1, detail::Point p2, detail::Point p3, double x) {
  const double h = p2.x - p1.x;
  const double t = (x - p1.x) / h;
  const double m1 = h * (p2.y - p0.y) / (p2.x - p0.x);
  const double m2 = h * (p3.y - p1.y) / (p3.x - p1.x);
  const double rise = p2.y - p1.y;
  return p1.y + t * (m1 + t * ((3 * rise - 2 * m1 - m2) + t * (m1 + m2 - 2 * rise)));
}

double monotone(detail::Point p0, detail::Point p1, detail::Point p2, detail::Point p3, double x) {
  double c[4];
  detail::monotone_cubic(p0, p1, p2, p3, c);
  return detail::cubic_value(c, (x - p1.x) / (p2.x - p1.x));
}

/// How far a cubic leaves the range of the two given points around it, and how far it is from the trace that the points
/// were read from.
template <class Trace, class Cubic>
void join(const char* how, const Trace& trace, const Cubic& cubic, int rows) {
  const auto at = [&](int i) {
    const double deg = 720.0 * i / rows;
    return detail::Point{deg, trace(deg) / kBar};
  };
  double overshoot = 0;
  double error = 0;
  for (int i = 0; i < rows; ++i) {
    for (int k = 1; k < 20; ++k) {
      const double x = at(i).x + (at(i + 1).x - at(i).x) * k / 20;
      const double y = cubic(at(i - 1), at(i), at(i + 1), at(i + 2), x);
      overshoot = std::max({overshoot, y - std::max(at(i).y, at(i + 1).y), std::min(at(i).y, at(i + 1).y) - y});
      error = std::max(error, std::fabs(y - trace(x) / kBar));
    }
  }
  std::printf("| %s, %g deg from row to row | %.2g | %.2g |\n", how, 720.0 / rows, overshoot, error);
}

}  // namespace

int main() {
  tick_test::SmoothTrace trace;
  compare("rises 11.6 bar/deg, 0.1 deg rows", tick_test::rows_of(trace, tick_test::evenly_deg(7200)));
  tick_test::SmoothTrace ringing;
  ringing.ringing_Pa = 2 * kBar;
  compare("the same with 2 bar of 6 kHz ringing", tick_test::rows_of(ringing, tick_test::evenly_deg(7200)));

  std::printf("\n| given points joined by | overshoot, bar | error against the trace, bar |\n| --- | --- | --- |\n");
  for (const int rows : {720, 1440, 7200}) {
    join("monotone cubic", trace, monotone, rows);
    join("Catmull-Rom", trace, catmull_rom, rows);
  }
  return 0;
}
