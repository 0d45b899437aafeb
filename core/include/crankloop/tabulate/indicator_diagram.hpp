// Cylinder pressure over the 720 deg of a cycle, from a table or a synthesised diagram.
//
// What belongs here: p(a) at set-up time, exactly as defined. What does not: its tables for the tick
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
/// points around it. Size 18 kB; it keeps a pointer to the definition's points. Construction O(points), evaluation
/// O(log points); not thread-safe.
class IndicatorDiagram {
 public:
  /// Refuses what validate() refuses, volumes that do not form a four-stroke loop or are equal in successive rows
  /// ("pressure.points" with the row), an exhaust opening at or after bottom dead centre, a mean effective pressure
  /// below the motored one ("pressure.wiebe.net_mep_Pa"), and a pressure above kMaxPressure_Pa: "pressure.wiebe.heat_J"
  /// or "pressure.wiebe.net_mep_Pa", or "pressure.wiebe.intake_Pa" where compression alone exceeds it.
  Status init(const Crank& crank, const Pressure& pressure) noexcept;

  [[nodiscard]] double motored_Pa(double crank_deg) const noexcept;
  [[nodiscard]] double heat_Pa(double crank_deg) const noexcept;  ///< added at full load
  [[nodiscard]] double full_Pa(double crank_deg) const noexcept;

  /// All three pressures, at little more than the cost of one.
  struct Pressures {
    double full_Pa;
    double motored_Pa;
    double heat_Pa;
  };
  [[nodiscard]] Pressures pressures(double crank_deg) const noexcept;
  /// For callers that already have the piston's displacement at this angle.
  [[nodiscard]] Pressures pressures(double crank_deg, double displacement_m) const noexcept;

  /// Largest full_Pa() at steps of 0.1 deg.
  [[nodiscard]] double peak_Pa() const noexcept { return peak_Pa_; }

  /// Heat per cycle and cylinder of a synthesised diagram, given or computed from the mean effective pressure. 0 for
  /// other diagrams, and for a mean effective pressure below that of the polytropes alone.
  [[nodiscard]] double heat_J() const noexcept { return heat_J_; }

 private:
  static constexpr int kBurnPanels = 256;
  static constexpr double kGasExchangeRampDeg = 1;  ///< exhaust to intake pressure after gas-exchange top dead centre
  struct Row {
    double at_deg;
    double pressure_Pa;
  };
  /// The curve between two rows.
  struct Interval {
    double from_deg = 0;
    double to_deg = 0;  ///< not above from_deg: the interval is not set
    double c[4] = {};   ///< the pressure's cubic over the fraction of the interval
  };
  /// A synthesised cycle without heat: compression with the definition's exponent up to from_deg, then expansion with
  /// `exponent`.
  struct Unfired {
    double from_deg;
    double from_m3;
    double from_Pa;
    double exponent;
    double exhaust_Pa;
    double opens_Pa;  ///< at exhaust valve opening
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
  [[nodiscard]] double released_Pa(double cycle_deg) const noexcept;  ///< pressure that the heat adds to the polytropes
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
  elementary::FixedPower motored_loss_;  ///< table: loss factor over volume / clearance volume
  double motored_bottom_Pa_ = 0;         ///< table: at the end of the motored expansion
  double bottom_m3_ = 0;                 ///< Wiebe: volume at bottom dead centre
  Unfired polytropes_{};                 ///< Wiebe: the diagram as given, without its heat
  Unfired motored_{};                    ///< Wiebe
  double fired_ = 0;                     ///< Wiebe: position between motored (0) and polytropes (1); 1 with heat
  double heat_J_ = 0;
  double peak_Pa_ = 0;
  double burnt_[kBurnPanels + 1] = {};  ///< Wiebe: integral of V^(n2 - 1) dx_b up to each panel, panels equal in the
                                        ///< cube root of the burn duration's fraction
  double first_deg_ = 0;                ///< table: angle of row 0
  // Angles of a volume table's rows. A table with more rows computes an angle when it needs it.
  static constexpr int kMaxKeptRows = 1536;
  bool rows_kept_ = false;
  double row_deg_[kMaxKeptRows] = {};
  // Cache of the last interval used in each degree, modulo kIntervals: a sweep over the angle, also one of several
  // cylinders, does not search for the same rows repeatedly.
  static constexpr unsigned kIntervals = 64;
  mutable Interval intervals_[kIntervals] = {};
};

}  // namespace crankloop
