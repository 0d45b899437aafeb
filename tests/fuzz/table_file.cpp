// Any bytes as a diagram's or a cam's table: refused with one line, or rows that are finite and in range, and lead to a
// refusal or to a finite diagram.
#include "crankloop/files/table_file.hpp"

#include <cmath>
#include <vector>

#include <crankloop/define/valve_train.hpp>
#include <crankloop/tabulate/cam_profile.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>

#include "crankloop/files/error.hpp"
#include "fuzz.hpp"

using namespace crankloop;
using namespace crankloop::program;

namespace {

const TableFormat kFormat{"crank_deg", "pressure_kPa", from(-1e6).up_to(1e6), from(0).up_to(1e5)};

Crank some_crank() {
  Crank crank;
  crank.bore_m = 0.095;
  crank.crank_radius_m = 0.0575;
  crank.rod_length_m = 0.21;
  crank.compression_ratio = 19;
  return crank;
}

void read_as_diagram(const std::vector<TableRow>& rows, PressureSource source, double per_unit) {
  std::vector<DiagramPoint> points;
  for (const TableRow& row : rows) points.push_back({row.at * per_unit, row.value * 1e3});
  Pressure pressure;
  pressure.source = source;
  pressure.points = points.data();
  pressure.point_count = static_cast<int>(points.size());
  IndicatorDiagram diagram;
  if (!diagram.init(some_crank(), pressure).ok()) return;
  for (double deg = -400; deg < 400; deg += 7.3) {
    fuzz::must(std::isfinite(diagram.full_Pa(deg)) && std::isfinite(diagram.motored_Pa(deg)),
               "an accepted diagram is finite");
  }
}

void read_as_cam(const std::vector<TableRow>& rows) {
  std::vector<CamPoint> points;
  for (const TableRow& row : rows) points.push_back({row.at, row.value * 1e-3});
  Cam cam;
  cam.source = CamSource::table;
  cam.points = points.data();
  cam.point_count = static_cast<int>(points.size());
  cam.smoothing_m = 10e-6;
  CamProfile profile;
  if (!profile.init(cam).ok()) return;
  for (double rad = -7; rad < 7; rad += 0.13) {
    fuzz::must(std::isfinite(profile.at(rad).lift_m), "an accepted cam is finite");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::TextFile file("table.csv");
  file.write(data, size);
  try {
    const std::vector<TableRow> rows = read_table(file.path(), kFormat, "engine.ini", 1);
    for (const TableRow& row : rows) {
      fuzz::must(kFormat.range_first.contains(row.at) && kFormat.range_second.contains(row.value), "rows are in range");
    }
    read_as_diagram(rows, PressureSource::angle_table, 1);
    read_as_diagram(rows, PressureSource::volume_table, 1e-6);
    read_as_cam(rows);
  } catch (const InputError& refusal) {
    const std::string message = refusal.what();
    fuzz::must(!message.empty() && message.find('\n') == std::string::npos, "a refusal is one line");
  }
  return 0;
}
