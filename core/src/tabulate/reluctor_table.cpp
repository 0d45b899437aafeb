#include "reluctor_table.hpp"

#include <crankloop/tabulate/elementary.hpp>

#include "phase_units.hpp"

namespace crankloop::detail {
namespace {

constexpr double kTwoPi = 6.283185307179586;

/// A tooth's lobe from its centre outward: docs/model.md "Analogue crank signal". 1 at the tooth's edge, 0 at its
/// centre and, with its slope, at `end`. Lengths in turns of the wheel.
struct Lobe {
  double edge;
  double end;

  [[nodiscard]] double value(double x) const noexcept {
    if (x <= edge) return x / edge * (2 - x / edge);
    const double t = (x - edge) / (end - edge);
    return t < 1 ? 1 - t * t * (3 - 2 * t) : 0;
  }
  /// Its integral from the centre to x.
  [[nodiscard]] double area(double x) const noexcept {
    const double s = x < edge ? x / edge : 1;
    double area = edge * s * s * (1 - s / 3);
    if (x > edge) {
      const double t = x < end ? (x - edge) / (end - edge) : 1;
      area += (end - edge) * t * (1 - t * t * (1 - t / 2));
    }
    return area;
  }
};

/// Flux and its derivative by the wheel's angle in turns, from the centre of its first tooth.
struct Flux {
  double flux;
  double slope;
};

/// A wheel's flux, counted from that in a gap, with lobes of height 1.
class WheelFlux {
 public:
  WheelFlux(const TriggerWheel& wheel, const Reluctor& sensor) noexcept
      : wheel_{wheel},
        sensor_{sensor},
        lobe_{wheel.tooth_ratio / wheel.places / 2, sensor.reach_ratio / wheel.places / 2} {
    int place = 0;
    for (int i = 0; i < wheel.gap_count; ++i) {
      for (int tooth = 0; tooth < wheel.gaps[i].teeth; ++tooth) there_[place++] = true;
      place += wheel.gaps[i].missing;
    }
    for (; place < wheel.places; ++place) there_[place] = true;
    for (int tooth = wheel.places - 1; tooth >= 0; --tooth) {
      if (there_[tooth] && !there_[(tooth + wheel.places - 1) % wheel.places]) first_ = tooth;
    }
  }

  /// Without run-out, 0 to 1 turn. O(places).
  [[nodiscard]] Flux still(double turns) const noexcept {
    double behind_gap = turns - static_cast<double>(first_) / wheel_.places;
    if (behind_gap < 0) behind_gap += 1;
    Flux sum{};
    for (int i = 0; i < wheel_.places; ++i) {
      const int place = (first_ + i) % wheel_.places;
      if (!there_[place]) continue;
      const double x = behind_gap - static_cast<double>(i) / wheel_.places;
      add_tooth(place, x, sum);
      if (x > 1 - lobe_.end) add_tooth(place, x - 1, sum);  // comes again
    }
    return sum;
  }

  /// With run-out.
  [[nodiscard]] Flux at(double turns) const noexcept {
    const Flux flux = still(turns);
    const double r = sensor_.runout_ratio;
    const double first_edge = -wheel_.tooth_ratio / wheel_.places / 2;
    const double angle = kTwoPi * (turns - first_edge - sensor_.runout_at_deg / 360);
    const double swing = 1 + r * elementary::cos(angle);
    return {swing * flux.flux, swing * flux.slope - kTwoPi * r * elementary::sin(angle) * flux.flux};
  }

 private:
  /// Beside a gap lobes are higher.
  [[nodiscard]] double height_beside(int place) const noexcept {
    return there_[(place + wheel_.places) % wheel_.places] ? 1 : sensor_.gap_lobe_ratio;
  }
  /// At a distance x behind its centre.
  void add_tooth(int place, double x, Flux& sum) const noexcept {
    const double whole = lobe_.area(lobe_.end);
    const double before = height_beside(place - 1), behind = height_beside(place + 1);
    if (x < 0) {
      sum.slope += before * lobe_.value(-x);
      sum.flux += before * (whole - lobe_.area(-x));
    } else {
      sum.slope -= behind * lobe_.value(x);
      sum.flux += before * whole - behind * lobe_.area(x);
    }
  }

  const TriggerWheel& wheel_;
  const Reluctor& sensor_;
  Lobe lobe_;
  bool there_[kMaxToothPlaces] = {};
  int first_ = 0;  ///< tooth behind a gap, from which flux is counted; of a wheel without gaps any
};

}  // namespace

template <class Real>
void fill_reluctor(const EngineDefinition& engine, const TickOptions& options,
                   const TableTargets<Real>& targets) noexcept {
  if (targets.reluctor == nullptr) return;
  ReluctorTable<Real>& table = *targets.reluctor;
  table = {};
  const Reluctor& sensor = engine.reluctor;
  if (sensor.wheel < 0) return;
  const TriggerWheel& wheel = engine.triggers[sensor.wheel];
  const bool on_crank = wheel.shaft == TriggerShaft::crank;
  const double half_tooth = wheel.tooth_ratio / wheel.places / 2;  // turns
  table.starts = phase_units(wheel.first_tooth_deg) +
                 static_cast<std::uint64_t>(half_tooth * 4294967296.0) * (std::uint64_t{1} << (on_crank ? 31 : 32));
  table.cells = static_cast<std::uint32_t>(kReluctorCells / wheel.places * wheel.places);
  table.on_crank = on_crank ? 1 : 0;
  table.in_use = 1;
  table.arm_ratio = static_cast<Real>(sensor.arm_ratio);
  table.least_V = static_cast<Real>(sensor.least_V);
  table.hysteresis_V = static_cast<Real>(sensor.hysteresis_V);
  table.delay_s = static_cast<Real>(sensor.delay_s);
  table.watchdog_ticks = static_cast<std::uint32_t>(sensor.watchdog_s / options.tick_s) + 1;

  const WheelFlux wheel_flux(wheel, sensor);
  const double gain_V_s = (sensor.reversed ? -1 : 1) * sensor.gain_V_s * (on_crank ? 1 : 0.5);
  const Flux first = wheel_flux.at(0);
  Flux from = first;
  for (std::uint32_t cell = 0; cell < table.cells; ++cell) {
    const bool last = cell + 1 == table.cells;
    const Flux to = last ? first : wheel_flux.at((cell + 1.0) / table.cells);
    const double mean = (to.flux - from.flux) * table.cells;
    table.at[cell] = {{static_cast<Real>(gain_V_s * from.slope),
                       static_cast<Real>(gain_V_s * (6 * mean - 4 * from.slope - 2 * to.slope)),
                       static_cast<Real>(gain_V_s * 3 * (from.slope + to.slope - 2 * mean))}};
    from = to;
  }
}

template void fill_reluctor(const EngineDefinition&, const TickOptions&, const TableTargets<float>&) noexcept;
template void fill_reluctor(const EngineDefinition&, const TickOptions&, const TableTargets<double>&) noexcept;

}  // namespace crankloop::detail
