#include <crankloop/tabulate/first_design.hpp>

#include <crankloop/tabulate/elementary.hpp>

namespace crankloop {
namespace {

/// One row of the table: kg/m^2 of piston area per mm of bore, and shares of the rod's length.
struct Row {
  Interval piston;
  Interval rod;
  Interval pin_share_inline;
  Interval pin_share_v;
};

constexpr Row kSparkSlow{{1.08, 1.2}, {1.35, 1.45}, {0.26, 0.28}, {0.28, 0.30}};
constexpr Row kSparkFast{{1.2, 1.25}, {1.7, 2.0}, {0.26, 0.28}, {0.28, 0.30}};
constexpr Row kDieselSlow{{1.8, 2.0}, {2.1, 2.25}, {0.26, 0.30}, {0.30, 0.34}};
constexpr Row kDieselFast{{1.5, 1.7}, {1.6, 1.9}, {0.22, 0.23}, {0.22, 0.23}};
constexpr Row kTractor{{2.0, 2.2}, {2.3, 2.5}, {0.26, 0.30}, {0.30, 0.34}};

[[nodiscard]] const Row& row_for(EngineKind kind, double speed_rpm) noexcept {
  switch (kind) {
    case EngineKind::spark_ignition:
      return speed_rpm < 4500 ? kSparkSlow : kSparkFast;
    case EngineKind::diesel:
      return speed_rpm < 3000 ? kDieselSlow : kDieselFast;
    case EngineKind::tractor_diesel:
      break;
  }
  return kTractor;
}

}  // namespace

FirstDesign first_design(EngineKind kind, double bore_m, double speed_rpm) noexcept {
  const Row& row = row_for(kind, speed_rpm);
  const double per_unit_kg = bore_m * 1000 * (elementary::kPi / 4 * bore_m * bore_m);
  const auto scaled = [per_unit_kg](Interval i) { return Interval{i.least * per_unit_kg, i.most * per_unit_kg}; };
  return {scaled(row.piston), scaled(row.rod), row.pin_share_inline, row.pin_share_v};
}

}  // namespace crankloop
