// Cylinder pressure over the 720 deg of a cycle, whatever the diagram was given as.
//
// What belongs here: p(a) at set-up time, exact to its definition. What does not: the tick's tables of it
// (tabulate/tabulate.hpp).
#pragma once

#include <crankloop/define/crank.hpp>
#include <crankloop/define/pressure.hpp>
#include <crankloop/status.hpp>
#include <crankloop/tabulate/elementary.hpp>

namespace crankloop {

/// p(a) = motored(a) + load ratio * heat(a), absolute pressures in Pa, a the cylinder's own crank angle in degrees,
/// |a| < 1e9.
///
/// Between given points the curve is a monotone cubic (Fritsch-Butland slopes): no value outside those of the two
/// points around it. 18 kB, and a pointer to the definition's points. Construction O(points), evaluation O(log points);
/// not for two threads at once.
class IndicatorDiagram {
 public:
  /// Refuses what validate() refuses, volumes that are no four-stroke loop or repeat from row to row ("pressure.points"
  /// with the row), an exhaust opening at or after bottom dead centre, a mean effective pressure below the motored one
  /// ("pressure.wiebe.net_mep_Pa"), and a pressure above kMaxPressure_Pa: "pressure.wiebe.heat_J" or
  /// "pressure.wiebe.net_mep_Pa", or "pressure.wiebe.intake_Pa" where compression alone exceeds it.
  Status init(const Crank& crank, const Pressure& pressure) noexcept;

  [[nodiscard]] double motored_Pa(double crank_deg) const noexcept;
  [[nodiscard]] double heat_Pa(double crank_deg) const noexcept;  ///< what full load adds
  [[nodiscard]] double full_Pa(double crank_deg) const noexcept;

  /// All three at once, for hardly more than one of them.
  struct Pressures {
    double full_Pa;
    double motored_Pa;
    double heat_Pa;
  };
  [[nodiscard]] Pressures pressures(double crank_deg) const noexcept;
  /// For who knows the piston's displacement there already.
  [[nodiscard]] Pressures pressures(double crank_deg, double displacement_m) const noexcept;

  /// Largest of full_Pa() at tenths of a degree.
  [[nodiscard]] double peak_Pa() const noexcept { return peak_Pa_; }

  /// Heat per cycle and cylinder of a synthesised diagram, as given or as found from the mean effective pressure; else
  /// 0, as where that is less than the polytropes alone do.
  [[nodiscard]] double heat_J() const noexcept { return heat_J_; }

 private:
  static constexpr int kBurnPanels = 256;
  static constexpr double kGasExchangeRampDeg = 1;  ///< exhaust to intake pressure after gas-exchange top dead centre
  struct Row {
    double at_deg;
    double pressure_Pa;
  };
  /// Between two rows.
  struct Interval {
    double from_deg = 0;
    double to_deg = 0;  ///< not beyond the former: nothing yet
    double c[4] = {};   ///< of the pressure's cubic by the part of the way
  };
  /// A synthesised cycle without heat: expansion by `exponent` from one angle on, until then compression by the
  /// definition's.
  struct Unfired {
    double from_deg;
    double from_m3;
    double from_Pa;
    double exponent;
    double exhaust_Pa;
    double opens_Pa;  ///< where the exhaust valve opens
    [[nodiscard]] double expanded_Pa(double volume_m3) const noexcept;
  };

  [[nodiscard]] bool is_table() const noexcept {
    return pressure_.source == PressureSource::angle_table || pressure_.source == PressureSource::volume_table;
  }
  Status init_source() noexcept;
  Status find_peak() noexcept;
  Status init_angles() noexcept;
  Status init_volumes() noexcept;
  Status init_wiebe() noexcept;
  void init_motored() noexcept;
  [[nodiscard]] Row row(int i) const noexcept;
  [[nodiscard]] double volume_row_deg(int i) const noexcept;
  [[nodiscard]] int row_before(double cycle_deg) const noexcept;
  [[nodiscard]] Interval interval_around(double at_deg) const noexcept;
  [[nodiscard]] double table_Pa(double cycle_deg) const noexcept;
  template <class Displacement>
  [[nodiscard]] Pressures pressures_where(double crank_deg, const Displacement& displacement_m) const noexcept;
  template <class Displacement>
  [[nodiscard]] double table_motored_Pa(double cycle_deg, const Displacement& displacement_m,
                                        double fired_Pa) const noexcept;
  [[nodiscard]] double motored_expansion_Pa(double crank_deg, double displacement_m) const noexcept;
  [[nodiscard]] double volume_m3(double crank_deg) const noexcept;
  [[nodiscard]] double slope_m(double crank_deg) const noexcept;
  [[nodiscard]] double burn_integral(double since_start_deg) const noexcept;
  [[nodiscard]] double burn_panel(double from_u, double to_u) const noexcept;
  [[nodiscard]] Unfired unfired(double from_deg, double exponent, double exhaust_Pa) const noexcept;
  [[nodiscard]] double unfired_Pa(const Unfired& unfired, double cycle_deg) const noexcept;
  [[nodiscard]] double released_Pa(double cycle_deg) const noexcept;  ///< what the heat adds to the polytropes
  [[nodiscard]] double wiebe_full_Pa(double cycle_deg) const noexcept;
  [[nodiscard]] double from_top_deg(double crank_deg) const noexcept;

  Crank crank_{};
  Pressure pressure_{};
  double tdc_deg_ = 0;
  double bdc_deg_ = 180;
  double clearance_m3_ = 0;
  double area_m2_ = 0;
  int rows_ = 0;                         ///< without a closing row
  int stroke_start_[5] = {};             ///< volume table: first row of each stroke, and rows_
  double exhaust_Pa_ = 0;                ///< table: mean over the second half of the exhaust stroke
  double intake_Pa_ = 0;                 ///< table: mean over the volume of the intake stroke
  elementary::FixedPower motored_loss_;  ///< table: of the volume in clearance volumes
  double motored_bottom_Pa_ = 0;         ///< table: at the end of the motored expansion
  double bottom_m3_ = 0;                 ///< Wiebe: volume at bottom dead centre
  Unfired polytropes_{};                 ///< Wiebe: the diagram as given, without its heat
  Unfired motored_{};                    ///< Wiebe
  double fired_ = 0;                     ///< Wiebe: share of the way from motored to polytropes; 1 where there is heat
  double heat_J_ = 0;
  double peak_Pa_ = 0;
  double burnt_[kBurnPanels + 1] =
      {};                 ///< Wiebe: integral of V^(n2 - 1) dx_b up to each panel of the cube root of the burn's part
  double first_deg_ = 0;  ///< table: angle of row 0
  // Angles of a volume table's rows, unless it has too many: then each is computed when it is needed.
  static constexpr int kMaxKeptRows = 1536;
  bool rows_kept_ = false;
  double row_deg_[kMaxKeptRows] = {};
  // The interval used last in each degree, modulo kIntervals, so that sweeps, also those of several cylinders in
  // turn, do not search for the same rows repeatedly.
  static constexpr unsigned kIntervals = 64;
  mutable Interval intervals_[kIntervals] = {};
};

}  // namespace crankloop
