#include <crankloop/assert.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>

#include <cstdint>

#include <crankloop/phase.hpp>
#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tabulate/mechanism.hpp>

#include "monotone_cubic.hpp"
#include "quadrature.hpp"

namespace crankloop {

using elementary::kPi;

namespace {

constexpr double kDegPerRad = 180 / kPi;
constexpr double kMotoredExhaustRampDeg = 10;

/// An angle reduced to [0, 720); 0 for angles beyond 1e9 deg and NaN.
[[nodiscard]] inline double into_cycle(double deg) noexcept {
  if (deg >= 0 && deg < 720) return deg;
  if (!(deg > -1e9 && deg < 1e9)) return 0;
  const double rest = deg - 720 * static_cast<double>(static_cast<std::int64_t>(deg / 720));
  const double positive = rest < 0 ? rest + 720 : rest;
  return positive >= 720 ? 0 : positive;  // -1e-20 + 720 rounds to 720
}

[[nodiscard]] double at_least(double least, double x) noexcept { return x < least ? least : x; }

}  // namespace

Status IndicatorDiagram::init(const Crank& crank, const Pressure& pressure) noexcept {
  *this = IndicatorDiagram{};
  if (const Status refused = validate(crank); !refused.ok()) return refused;
  if (const Status refused = validate(pressure, crank); !refused.ok()) return refused;
  crank_ = crank;
  pressure_ = pressure;
  const DeadCentres centres = dead_centres(crank);
  tdc_deg_ = centres.tdc_rad * kDegPerRad;
  bdc_deg_ = centres.bdc_rad * kDegPerRad;
  clearance_m3_ = clearance_volume_m3(crank);
  area_m2_ = bore_area_m2(crank);
  if (const Status refused = init_source(); !refused.ok()) return refused;
  return find_peak();
}

Status IndicatorDiagram::init_source() noexcept {
  switch (pressure_.source) {
    case PressureSource::none:
    case PressureSource::gas:
      return {};
    case PressureSource::wiebe:
      return init_wiebe();
    case PressureSource::angle_table:
      return init_angles();
    case PressureSource::volume_table:
      return init_volumes();
  }
  return {};
}

/// Rows are checked and the curve stays within their range, so only a synthesised diagram can be refused here.
Status IndicatorDiagram::find_peak() noexcept {
  const auto too_high = [](double p) { return !(p <= kMaxPressure_Pa); };  // true for NaN too
  for (int i = 0; i < 10 * 720; ++i) {
    const double deg = i / 10.0;
    const double p = full_Pa(deg);
    if (p > peak_Pa_) peak_Pa_ = p;
    if (!too_high(p)) continue;
    if (too_high(motored_Pa(deg))) return refuse("pressure.wiebe.intake_Pa", Reason::pressure_too_high);
    return refuse(pressure_.wiebe.heat_given ? "pressure.wiebe.heat_J" : "pressure.wiebe.net_mep_Pa",
                  Reason::pressure_too_high);
  }
  return {};
}

double IndicatorDiagram::volume_m3(double crank_deg) const noexcept {
  return clearance_m3_ + area_m2_ * exact_stroke(crank_, crank_deg * detail::kRadPerDegree).displacement_m;
}

double IndicatorDiagram::slope_m(double crank_deg) const noexcept {
  return exact_stroke(crank_, crank_deg * detail::kRadPerDegree).slope_m;
}

/// Degrees since firing top dead centre, 0 to 720.
double IndicatorDiagram::from_top_deg(double crank_deg) const noexcept { return into_cycle(crank_deg - tdc_deg_); }

IndicatorDiagram::Pressures IndicatorDiagram::pressures(double crank_deg) const noexcept {
  return pressures_where(crank_deg,
                         [&] { return exact_stroke(crank_, crank_deg * detail::kRadPerDegree).displacement_m; });
}
IndicatorDiagram::Pressures IndicatorDiagram::pressures(double crank_deg, double displacement_m) const noexcept {
  return pressures_where(crank_deg, [&] { return displacement_m; });
}

/// Computes the piston's displacement only where it is needed.
template <class Displacement>
IndicatorDiagram::Pressures IndicatorDiagram::pressures_where(double crank_deg,
                                                              const Displacement& displacement_m) const noexcept {
  switch (pressure_.source) {
    case PressureSource::none:
    case PressureSource::gas:
      break;
    case PressureSource::wiebe: {
      const double full = wiebe_full_Pa(crank_deg);
      const double motored = unfired_Pa(motored_, crank_deg);
      return {full, motored, full - motored};
    }
    case PressureSource::angle_table:
    case PressureSource::volume_table: {
      const double full = table_Pa(crank_deg);
      const double motored = table_motored_Pa(crank_deg, displacement_m, full);
      return {full, motored, full - motored};
    }
  }
  return {pressure_.crankcase_Pa, pressure_.crankcase_Pa, 0};
}

double IndicatorDiagram::motored_Pa(double crank_deg) const noexcept { return pressures(crank_deg).motored_Pa; }
double IndicatorDiagram::heat_Pa(double crank_deg) const noexcept { return pressures(crank_deg).heat_Pa; }
double IndicatorDiagram::full_Pa(double crank_deg) const noexcept {
  return is_table() ? table_Pa(crank_deg) : pressures(crank_deg).full_Pa;
}

// ---- tables ---------------------------------------------------------------------------------------------------------

Status IndicatorDiagram::init_angles() noexcept {
  rows_ = pressure_.point_count;
  if (pressure_.points[rows_ - 1].at - pressure_.points[0].at > 720 - 1e-9) --rows_;  // a closing row repeats the first
  first_deg_ = row(0).at_deg;
  init_motored();
  return {};
}

Status IndicatorDiagram::init_volumes() noexcept {
  const auto refused = [](Reason reason, int row) { return refuse("pressure.points", reason, row); };
  const double swept = swept_volume_m3(crank_);
  const double volume_tolerance = 0.02 * swept;
  rows_ = pressure_.point_count;
  const DiagramPoint* points = pressure_.points;
  if (points[rows_ - 1].at == points[0].at) --rows_;  // a closing row
  int stroke = 0;
  for (int i = 0; i < rows_; ++i) {
    if (points[i].at < clearance_m3_ - volume_tolerance || points[i].at > clearance_m3_ + swept + volume_tolerance) {
      return refused(Reason::out_of_range, i);
    }
    if (i == 0) continue;
    if (points[i].at == points[i - 1].at) return refused(Reason::not_a_cycle, i);
    const bool rising = points[i].at > points[i - 1].at;
    if (rising == (stroke % 2 == 0)) continue;
    // The volume reverses: that must be at a dead centre.
    const double turn = clearance_m3_ + (stroke % 2 == 0 ? swept : 0);
    const double off = points[i - 1].at - turn;
    if (++stroke > 3 || off > volume_tolerance || off < -volume_tolerance) return refused(Reason::not_a_cycle, i);
    stroke_start_[stroke] = i;
  }
  const double first_off = points[0].at - clearance_m3_;
  if (stroke != 3 || first_off > volume_tolerance) return refused(Reason::not_a_cycle, 0);
  stroke_start_[4] = rows_;
  first_deg_ = row(0).at_deg;
  rows_kept_ = rows_ <= kMaxKeptRows;
  if (rows_kept_) row_deg_[0] = first_deg_;
  double before_deg = first_deg_;
  for (int i = 1; i < rows_; ++i) {
    const double at_deg = volume_row_deg(i);
    if (rows_kept_) row_deg_[i] = at_deg;
    if (at_deg <= before_deg) return refused(Reason::not_a_cycle, i);
    before_deg = at_deg;
  }
  if (before_deg >= first_deg_ + 720) return refused(Reason::not_a_cycle, rows_ - 1);
  init_motored();
  return {};
}

void IndicatorDiagram::init_motored() noexcept {
  exhaust_Pa_ =
      detail::integrate(tdc_deg_ + 270, tdc_deg_ + 360, 90, [this](double deg) { return table_Pa(deg); }) / 90;
  const double stroke_m =
      detail::integrate(tdc_deg_ + 360, bdc_deg_ + 360, 180, [this](double deg) { return slope_m(deg); });
  intake_Pa_ = detail::integrate(tdc_deg_ + 360, bdc_deg_ + 360, 180,
                                 [this](double deg) { return table_Pa(deg) * slope_m(deg); }) /
               stroke_m;
  motored_loss_ = elementary::FixedPower(-kMotoredLoss);
  motored_bottom_Pa_ =
      motored_expansion_Pa(bdc_deg_, exact_stroke(crank_, bdc_deg_ * detail::kRadPerDegree).displacement_m);
}

/// Row i with its angle. Rows are periodic: row(-1) is the last row, a cycle earlier.
IndicatorDiagram::Row IndicatorDiagram::row(int i) const noexcept {
  double turn_deg = 0;
  if (i < 0) i += rows_, turn_deg = -720;
  if (i >= rows_) i -= rows_, turn_deg = 720;
  const DiagramPoint& point = pressure_.points[i];
  if (pressure_.source == PressureSource::angle_table) return {point.at + turn_deg, point.pressure_Pa};
  return {(rows_kept_ ? row_deg_[i] : volume_row_deg(i)) + turn_deg, point.pressure_Pa};
}

double IndicatorDiagram::volume_row_deg(int i) const noexcept {
  int stroke = 0;
  while (stroke < 3 && i >= stroke_start_[stroke + 1]) ++stroke;
  const double displacement_m = (pressure_.points[i].at - clearance_m3_) / area_m2_;
  return crank_angle_rad(crank_, displacement_m, stroke % 2 == 0) * kDegPerRad + (stroke >= 2 ? 360 : 0);
}

/// The last row at or before an angle that lies in [first row, first row + 720).
int IndicatorDiagram::row_before(double at_deg) const noexcept {
  const auto last_in = [](int low, int high,
                          const auto& is_before) {  // the last of low to high - 1 that is before, else low
    CRANKLOOP_ASSERT(low >= 0);
    while (high - low > 1) {
      const int middle = low + (high - low) / 2;
      (is_before(middle) ? low : high) = middle;
    }
    return low;
  };
  const DiagramPoint* points = pressure_.points;
  if (pressure_.source == PressureSource::angle_table)
    return last_in(0, rows_, [&](int i) { return points[i].at <= at_deg; });
  if (rows_kept_) return last_in(0, rows_, [&](int i) { return row_deg_[i] <= at_deg; });
  // Within a stroke volumes are monotone, and one volume costs far less than an angle for each row of the search.
  const double turns_deg[] = {bdc_deg_, tdc_deg_ + 360, bdc_deg_ + 360};
  int stroke = 0;
  while (stroke < 3 && at_deg >= turns_deg[stroke]) ++stroke;
  const double volume = volume_m3(at_deg);
  const bool rising = stroke % 2 == 0;
  const int begin = stroke_start_[stroke] > 0 ? stroke_start_[stroke] - 1 : 0;
  return last_in(begin, stroke_start_[stroke + 1],
                 [&](int i) { return rising ? points[i].at <= volume : points[i].at >= volume; });
}

IndicatorDiagram::Interval IndicatorDiagram::interval_around(double at_deg) const noexcept {
  const auto point = [this](int i) {
    const Row there = row(i);
    return detail::Point{there.at_deg, there.pressure_Pa};
  };
  int before = row_before(at_deg);
  detail::Point from = point(before);
  detail::Point to = point(before + 1);
  // Correct the search by angles: rounding of the volume may have chosen a neighbouring row.
  while (before > 0 && from.x > at_deg) to = from, from = point(--before);
  while (before + 1 < rows_ && to.x <= at_deg) from = to, to = point(++before + 1);
  Interval interval{from.x, to.x, {}};
  detail::monotone_cubic(point(before - 1), from, to, point(before + 2), interval.c);
  return interval;
}

double IndicatorDiagram::table_Pa(double crank_deg) const noexcept {
  const double since_first_deg = into_cycle(crank_deg - first_deg_);
  const double at_deg = first_deg_ + since_first_deg;
  Interval& interval = intervals_[static_cast<unsigned>(static_cast<int>(since_first_deg)) % kIntervals];
  if (!(interval.from_deg <= at_deg && at_deg < interval.to_deg)) interval = interval_around(at_deg);
  return detail::cubic_value(interval.c, (at_deg - interval.from_deg) / (interval.to_deg - interval.from_deg));
}

/// Without combustion the expansion has the compression's pressure at equal volume, less the loss, and the exhaust
/// stroke has no blow-down. `fired_Pa` is the table's pressure at the angle.
template <class Displacement>
double IndicatorDiagram::table_motored_Pa(double crank_deg, const Displacement& displacement_m,
                                          double fired_Pa) const noexcept {
  const double since_top = from_top_deg(crank_deg);
  const double expansion_deg = bdc_deg_ - tdc_deg_;
  if (since_top < expansion_deg) return motored_expansion_Pa(tdc_deg_ + since_top, displacement_m());
  if (since_top >= 360) return fired_Pa;
  const double exhaust = at_least(intake_Pa_, fired_Pa < exhaust_Pa_ ? fired_Pa : exhaust_Pa_);
  const double left = (360 - since_top) / kGasExchangeRampDeg;
  if (left < 1) return fired_Pa + left * (exhaust - fired_Pa);
  const double ramp = (since_top - expansion_deg) / kMotoredExhaustRampDeg;
  if (ramp >= 1) return exhaust;
  return motored_bottom_Pa_ + ramp * (exhaust - motored_bottom_Pa_);
}

/// Motored pressure in the expansion stroke.
double IndicatorDiagram::motored_expansion_Pa(double crank_deg, double displacement_m) const noexcept {
  const double compression_deg =
      crank_angle_up_rad(crank_, crank_deg * detail::kRadPerDegree, displacement_m) * kDegPerRad + 360;
  return motored_loss_(at_least(1, 1 + area_m2_ * displacement_m / clearance_m3_)) * table_Pa(compression_deg);
}

}  // namespace crankloop
