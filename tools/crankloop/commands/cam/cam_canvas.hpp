// What a picture of a mechanism is drawn on: outlines in mm, labels beside places, a column of figures, a bar of scale.
//
// What belongs here: outlines, and how they fit the picture. What does not: what is drawn (cam_picture.cpp).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "../../report/sheet.hpp"

namespace crankloop::program {

/// In the picture, mm, y upward.
struct Place {
  double x;
  double y;
};
using Outline = std::vector<Place>;

inline Place operator+(const Place& a, const Place& b) { return {a.x + b.x, a.y + b.y}; }
inline Place operator-(const Place& a, const Place& b) { return {a.x - b.x, a.y - b.y}; }
[[nodiscard]] Place toward(double length, double rad);
[[nodiscard]] double direction(const Place& a);
[[nodiscard]] double length(const Place& a);

void add_arc(Outline& outline, const Place& centre, double radius, double from_rad, double to_rad);

/// The convex outline around some points.
[[nodiscard]] Outline around(Outline points);

/// Names and values beside the drawing.
using Figures = std::vector<std::pair<std::string, std::string>>;

/// Elements of the drawing, in mm until they are written.
class Canvas {
 public:
  void path(const char* what, const Outline& outline, bool closed) { paths_.push_back({what, outline, closed}); }
  void line(const char* what, const Place& a, const Place& b) { path(what, {a, b}, false); }
  void circle(const char* what, const Place& centre, double radius);
  void cross(const Place& at, double half);
  /// Text beside a place, `right` and `down` in user units.
  void label(const Place& at, double right, double down, const std::string& text) {
    labels_.push_back({at, right, down, text});
  }

  /// The whole, as large as it fits.
  [[nodiscard]] report::Picture picture(const Figures& figures) const;

 private:
  struct Path {
    std::string what;
    Outline outline;
    bool closed;
  };
  struct Label {
    Place at;
    double right;
    double down;
    std::string text;
  };

  [[nodiscard]] std::string drawing() const;

  std::vector<Path> paths_{};
  std::vector<Label> labels_{};
};

}  // namespace crankloop::program
