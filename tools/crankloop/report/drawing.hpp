// Builds the <svg> element of one plot: scales, frame, curves, labels, in this order, then its text.
//
// What belongs here: data that the steps share. What does not: their rules (drawing_layout.cpp, drawing_field.cpp,
// drawing_labels.cpp, drawing_svg.cpp), scales (scale.hpp), thinning (thinning.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry.hpp"
#include "plot.hpp"
#include "scale.hpp"
#include "text.hpp"

namespace crankloop::report {

inline constexpr double kWidth = 520;   // user units
inline constexpr double kSwatch = 26;   // a legend's line and the gap behind it
inline constexpr double kHeatKey = 42;  // from the frame to the numbers of a heat map's key

enum class Anchor : std::uint8_t { start, middle, end };

struct Label {
  Point at{};  // on the baseline
  Anchor anchor = Anchor::start;
  std::string text{};
  int colour = 0;   // 0: ink
  int series = -1;  // whose name it is
};

[[nodiscard]] Box box_of(const Label& label);

/// The drawn part of one series, in user units.
struct Curve {
  std::string name{};
  Style style{};
  int colour = 1;
  bool dashed = false;
  std::vector<Polyline> lines{};  // thinned, one per unbroken piece
  Polyline points{};              // marks, and points that stand alone
  std::vector<Box> bars{};
};

[[nodiscard]] inline std::size_t size_of(const Series& series) { return std::min(series.x.size(), series.y.size()); }

[[nodiscard]] inline bool is_bar(const Series& series) { return series.style.draw == Draw::bar; }

class Drawing {
 public:
  /// Fixed: of its own size in user units, instead of its column's width.
  Drawing(const Plot& plot, bool fixed) : plot_{plot}, fixed_{fixed} {}

  Drawn draw();

 private:
  // drawing_layout.cpp
  void make_scales();
  void make_layout(bool legend);
  void make_headroom();
  void make_equal();
  void make_legend();
  void make_zero_lines();
  void make_curves();
  void make_bars(const Series& series, std::size_t position, std::size_t of, Curve& curve) const;
  void make_lines(const Series& series, Curve& curve) const;
  int colour_of(std::size_t index) const;
  double baseline() const;
  bool visible(const Marker& marker) const;

  // drawing_field.cpp
  bool has_field() const { return !plot_.field.values.empty(); }
  void make_levels();
  void write_field();
  void write_contour(double level, const Polyline& ends);
  void write_heat_key();
  struct HeatCorner {
    Point at;
    double value;
  };
  using HeatCell = std::array<HeatCorner, 4>;
  HeatCell heat_cell(std::size_t i, std::size_t j) const;
  static Polyline area_of_cell(double level, const HeatCell& cell, Polyline& contour);
  std::string area_above(double level, Polyline& contour) const;
  std::string heat_at(double level) const;

  // drawing_labels.cpp
  double hidden_by(const Box& box) const;
  double outside_frame(const Box& box) const;
  void place_beside(Point dot, Label label);
  void place_markers();
  Point end_of(const Polyline& line) const;
  void place_ends();
  bool end_together() const;
  bool place_names();
  double clarity(const Label& label, std::size_t own) const;

  // drawing_svg.cpp
  void text(const char* what, Point at, Anchor anchor, const std::string& content, int colour = 0);
  void path(const std::string& what, const std::string& d);
  void rectangle(const std::string& what, const Box& box);
  std::string description() const;
  void write();
  void write_bands();
  void write_axes();
  void write_curve(const Curve& curve);

  struct LegendEntry {
    Point at;
    std::size_t series;
  };

  const Plot& plot_;
  const bool fixed_;
  Scale x_{};
  Scale y_{};
  Scale y_of_data_{};  // before room for labels
  bool empty_ = true;
  double bar_pitch_ = 1;  // in units of x
  double height_ = 0;
  double band_top_ = 0;
  Box frame_{};
  Mapping to_x_{};
  Mapping to_y_{};
  std::vector<Curve> curves_{};
  std::vector<Polyline> zero_lines_{};
  Scale levels_{};        // of the field: contours at its ticks
  double heat_step_ = 1;  // of colours
  std::vector<LegendEntry> legend_{};
  std::vector<Label> labels_{};
  std::vector<Box> taken_{};
  std::vector<Polyline> leaders_{};  // from the end of a curve or from a dot to its label
  bool ends_together_ = false;       // the curves': within a quarter of the frame's width
  std::string out_{};
};

}  // namespace crankloop::report
