// setup_cost CASE: tabulates an engine of 16 cylinders whose measured trace is as hard on set-up as can be. Its
// instructions are counted from outside (setup_cost.sh). Without a case: their names.
//
// What makes a set-up slow, all at once: every degree divided as finely as there is room for, cylinders that fire at
// fractions of a degree, so that none has a place in common with another, an offset piston pin, every section that a
// trace has part in, double.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include <crankloop/tabulate/mechanism.hpp>
#include <crankloop/tabulate/tabulate.hpp>

#include "support/engines.hpp"
#include "support/random.hpp"
#include "support/units.hpp"

namespace {

using namespace crankloop;

using crankloop::support::kPi;
constexpr double kBar = 1e5;

struct Case {
  const char* name;
  PressureSource source;
  int rows;
  bool jumps;        // between 1 and 60 bar, from row to row; else a compression with 0.3 bar of noise
  bool uneven;       // rows at any distance
  int room;          // for segments
  double apart_deg;  // how far one cylinder fires after the other
};
constexpr int kRoomForAll = static_cast<int>(kMaxGasSegments);
constexpr PressureSource kAngle = PressureSource::angle_table;
constexpr PressureSource kVolume = PressureSource::volume_table;
constexpr Case kCases[] = {
    {"noise", kAngle, 1440, false, false, 4096, 45.0617},
    {"jumps", kAngle, 1440, true, false, kRoomForAll, 45.0617},
    {"jumps_nearly_all", kAngle, 1440, true, false, 14000, 45.0617},
    {"uneven_rows", kAngle, 1536, true, true, kRoomForAll, 45.0617},
    {"volume", kVolume, 1536, true, true, kRoomForAll,
     64.0617},  // 64 deg: the cylinders take turns in the diagram's intervals
    {"million_angles", kAngle, 1 << 20, true, false, kRoomForAll, 45.0617},
    {"million_volumes", kVolume, 1 << 20, true, false, kRoomForAll, 45.0617},
};

double random_part(support::Random& random, const Case& c) { return c.uneven ? random.between(0.01, 0.99) : 0.01; }

std::vector<DiagramPoint> rows_of(const Case& c, const Crank& crank) {
  support::Random random(3);
  const double top_deg = c.source == kVolume ? dead_centres(crank).tdc_rad * 180 / kPi : 0;
  std::vector<DiagramPoint> rows;
  for (int i = 0; i < c.rows; ++i) {
    const double deg = top_deg + 720 * (i + random_part(random, c)) / c.rows;
    const double compression_Pa = kBar + 60 * kBar * std::exp(30 * (std::cos(deg * kPi / 360) - 1));
    const double jumping_Pa = (i % 2 == 0 ? 60 * kBar : kBar) * random.between(0.5, 1);
    const double volume_m3 =
        clearance_volume_m3(crank) + bore_area_m2(crank) * exact_stroke(crank, deg * kPi / 180).displacement_m;
    rows.push_back({c.source == kVolume ? volume_m3 : deg,
                    c.jumps ? jumping_Pa : compression_Pa + random.between(-0.3 * kBar, 0.3 * kBar)});
  }
  return rows;
}

int tabulated(const Case& c) {
  EngineDefinition engine = support::single_495();
  engine.crank.pin_offset_m = 0.005;
  engine.layout.cylinders = kMaxCylinders;
  for (std::size_t k = 0; k < std::size_t{kMaxCylinders}; ++k) {
    engine.layout.firing_deg[k] = std::fmod(c.apart_deg * static_cast<double>(k), 720);
    engine.layout.pin[k] = static_cast<std::uint8_t>(k);
  }
  const std::vector<DiagramPoint> rows = rows_of(c, engine.crank);
  engine.pressure.source = c.source;
  engine.pressure.points = rows.data();
  engine.pressure.point_count = c.rows;
  const auto stores = std::make_unique<detail::part::Stores<double, detail::part::RoomForAll>>();
  TableTargets<double> targets = stores->targets();
  targets.gas_capacity = c.room;
  TableReport report;
  const Status status = tabulate(engine, {100e-6, {}}, targets, &report);
  if (!status.ok()) {
    std::fprintf(stderr, "%s: %s, row %d: %s\n", c.name, status.field, status.index, describe(status.reason));
    return 1;
  }
  std::printf("%d %d %d segments\n", report.gas_segments, report.torque_segments, report.cut_segments);
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  for (const Case& c : kCases) {
    if (count == 1) std::printf("%s\n", c.name);
    if (count == 2 && std::strcmp(arguments[1], c.name) == 0) return tabulated(c);
  }
  return count == 1 ? 0 : 2;
}
