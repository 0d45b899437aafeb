// The <svg> element of a drawing after layout.
#include <algorithm>
#include <string>

#include "../files/number.hpp"
#include "drawing.hpp"

namespace crankloop::report {

namespace {

std::string move(double x, double y) { return 'M' + coordinate(x) + ' ' + coordinate(y); }

std::string path_of(const Polyline& line) {
  std::string d = move(line[0].x, line[0].y);
  for (std::size_t i = 1; i < line.size(); ++i)
    d += (i == 1 ? 'L' : ' ') + coordinate(line[i].x) + ' ' + coordinate(line[i].y);
  return d;
}

std::string colour_class(const Curve& curve) {
  const std::string ramp = curve.style.ramp > 0 ? " r" + std::to_string(std::min(curve.style.ramp, kRamp)) : "";
  return " c" + std::to_string(curve.colour) + ramp;
}

std::string line_class(const Curve& curve) {
  return std::string("curve") + (curve.dashed ? " dashed" : "") + (curve.style.bold ? " bold" : "") +
         colour_class(curve);
}

/// A scale for the page's script: "low high from to", the latter two in user units.
std::string scale_of(const char* name, const Mapping& map, const std::string& unit) {
  return std::string(" data-") + name + "=\"" + program::brief(map.range.low) + ' ' + program::brief(map.range.high) +
         ' ' + coordinate(map.from) + ' ' + coordinate(map.to) + (map.logarithmic ? " log" : "") + "\"" +
         (unit.empty() ? "" : std::string(" data-unit-") + name + "=\"" + escape(unit) + "\"");
}

}  // namespace

void Drawing::text(const char* what, Point at, Anchor anchor, const std::string& content, int colour) {
  out_ += std::string{"<text class=\""} + what;
  if (colour > 0) out_ += " c" + std::to_string(colour);
  out_ += "\" x=\"" + coordinate(at.x) + "\" y=\"" + coordinate(at.y) + '"';
  if (anchor != Anchor::start) out_ += anchor == Anchor::middle ? " text-anchor=\"middle\"" : " text-anchor=\"end\"";
  out_ += '>' + escape(content) + "</text>\n";
}

void Drawing::path(const std::string& what, const std::string& d) {
  out_ += "<path class=\"" + what + "\" d=\"" + d + "\"/>\n";
}

void Drawing::rectangle(const std::string& what, const Box& box) {
  out_ += "<rect class=\"" + what + "\" x=\"" + coordinate(box.left) + "\" y=\"" + coordinate(box.top) + "\" width=\"" +
          coordinate(box.right - box.left) + "\" height=\"" + coordinate(box.bottom - box.top) + "\"/>\n";
}

std::string Drawing::description() const {
  const auto interval = [](Range range, const std::string& unit) {
    return "from " + format_number(range.low, 3) + " to " + format_number(range.high, 3) +
           (unit.empty() ? "" : ' ' + unit);
  };
  std::string text = plot_.y.title + " over " + plot_.x.title + ' ' + interval(x_.range, plot_.x.unit) + '.';
  if (has_field()) {
    const auto [low, high] = std::minmax_element(plot_.field.values.begin(), plot_.field.values.end());
    text += ' ' + plot_.field.name + ": " + interval({*low, *high}, plot_.field.unit) + '.';
  }
  for (const Series& series : plot_.series) {
    Range range{kLargest, -kLargest};
    for (std::size_t i = 0; i < size_of(series); ++i) {
      if (!drawable(series.x[i], plot_.x) || !drawable(series.y[i], plot_.y)) continue;
      range = {std::min(range.low, series.y[i]), std::max(range.high, series.y[i])};
    }
    const std::string name = series.name.empty() ? "Values" : series.name;
    text += ' ' + name + (range.low > range.high ? ": no data." : ": " + interval(range, plot_.y.unit) + '.');
  }
  return text;
}

void Drawing::write() {
  const std::string id = escape(plot_.id);
  const bool clipped = plot_.x.range || plot_.y.range;
  // Some browsers take the size of an inner drawing from its attributes, some let the style sheet override them.
  const std::string size = "width=\"" + coordinate(kWidth) + "\" height=\"" + coordinate(height_) +
                           "\" style=\"width:" + coordinate(kWidth) + "px;height:" + coordinate(height_) + "px\" ";
  out_ = "<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + coordinate(kWidth) + ' ' +
         coordinate(height_) + "\" " +
         (fixed_ ? size : scale_of("x", to_x_, plot_.x.unit).substr(1) + scale_of("y", to_y_, plot_.y.unit) + ' ') +
         (has_field() ? "data-name-y=\"" + escape(plot_.y.title) + "\" " : "") + "role=\"img\" aria-labelledby=\"" +
         id + "-title " + id + "-desc\">\n";
  out_ += "<title id=\"" + id + "-title\">" + escape(plot_.title) + "</title>\n";
  out_ += "<desc id=\"" + id + "-desc\">" + escape(description()) + "</desc>\n";
  if (clipped) {
    out_ += "<clipPath id=\"" + id + "-clip\">";
    rectangle("clip", grown(frame_, 1.5));
    out_ += "</clipPath>\n";
  }
  write_bands();
  write_axes();
  if (has_field()) write_field();
  out_ += clipped ? "<g clip-path=\"url(#" + id + "-clip)\">\n" : "<g>\n";
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    out_ += "<g data-s=\"" + std::to_string(i) + "\" data-zero=\"" + coordinate(baseline()) + "\"" +
            (curves_[i].name.empty() ? "" : " data-name=\"" + escape(curves_[i].name) + "\"") + ">\n";
    write_curve(curves_[i]);
    out_ += "</g>\n";
  }
  out_ += "</g>\n";
  for (const Marker& marker : plot_.markers) {
    if (!visible(marker)) continue;
    path("dot c" + std::to_string(colour_of(marker.series)), move(to_x_(marker.x), to_y_(marker.y)) + "h0");
  }
  if (empty_)
    text("tick", {(frame_.left + frame_.right) / 2, (frame_.top + frame_.bottom) / 2}, Anchor::middle, "no data");
  for (const Polyline& leader : leaders_) path("leader", path_of(leader));
  for (const Label& label : labels_) {
    if (label.series >= 0) out_ += "<g class=\"key\" data-s=\"" + std::to_string(label.series) + "\">";
    text("name", label.at, label.anchor, label.text, label.colour);
    if (label.series >= 0) out_ += "</g>\n";
  }
  for (const auto& [at, index] : legend_) {
    const Curve& curve = curves_[index];
    const std::string colour = colour_class(curve);
    out_ += "<g class=\"key\" data-s=\"" + std::to_string(index) + "\">\n";
    const double middle = at.y - 0.33 * kTypeSize;
    if (curve.style.draw == Draw::bar)
      rectangle("bar" + colour, {at.x, middle - 6, at.x + 14, middle + 6});
    else if (curve.style.draw != Draw::points)
      path(line_class(curve), move(at.x, middle) + "h20");
    if (curve.style.draw == Draw::points || curve.style.draw == Draw::line_and_points)
      path("dot" + colour, move(at.x + 10, middle) + "h0");
    text("legend", {at.x + kSwatch, at.y}, Anchor::start, curve.name);
    out_ += "</g>\n";
  }
  out_ += "</svg>\n";
}

void Drawing::write_bands() {
  int count = 0;
  for (const Band& band : plot_.bands) {
    if (!drawable(band.from, plot_.x) || !drawable(band.to, plot_.x)) continue;
    const double left = std::clamp(to_x_(band.from), frame_.left, frame_.right);
    const double right = std::clamp(to_x_(band.to), frame_.left, frame_.right);
    if (right <= left) continue;
    if (count++ % 2 == 0)
      rectangle("band", {left, band_top_, right, frame_.bottom});  // every other one, so that they are distinguishable
    if (0.8 * text_width(band.label) > right - left) continue;    // the font is smaller by this factor
    text("band-name", {(left + right) / 2, band_top_ + 18}, Anchor::middle, band.label);
  }
}

void Drawing::write_axes() {
  const std::string width = 'h' + coordinate(frame_.right - frame_.left);
  const std::string height = 'v' + coordinate(frame_.bottom - frame_.top);
  std::string grid;
  std::string fine;
  std::string marks;
  for (const Tick& tick : y_.ticks)
    (plot_.y.logarithmic && tick.label.empty() ? fine : grid) += move(frame_.left, to_y_(tick.value)) + width;
  for (const Tick& tick : x_.ticks) {
    const double x = to_x_(tick.value);
    (plot_.x.logarithmic && tick.label.empty() ? fine : grid) += move(x, frame_.top) + height;
    marks += move(x, frame_.bottom) + (tick.label.empty() ? "v3" : "v6");
  }
  if (!fine.empty()) path("grid fine", fine);
  path("grid", grid);
  if (!plot_.x.bare) path("axis", move(frame_.left, frame_.bottom) + width + marks);
  std::string zero;
  for (const Polyline& line : zero_lines_) zero += path_of(line);
  if (!zero.empty()) path("zero", zero);

  for (const Tick& tick : y_.ticks) {
    if (!tick.label.empty())
      text("tick", {frame_.left - 8, to_y_(tick.value) + 0.34 * kTypeSize}, Anchor::end, tick.label);
  }
  for (const Tick& tick : x_.ticks) {
    if (!tick.label.empty()) text("tick", {to_x_(tick.value), frame_.bottom + 23}, Anchor::middle, tick.label);
  }
  text("axis-title", {0, 17}, Anchor::start, with_unit(plot_.y.title, plot_.y.unit, y_.exponent));
  text("axis-title", {frame_.right, height_ - 6}, Anchor::end, with_unit(plot_.x.title, plot_.x.unit, x_.exponent));
}

void Drawing::write_curve(const Curve& curve) {
  const std::string colour = colour_class(curve);
  std::string d;
  std::string area;
  for (const Polyline& line : curve.lines) {
    d += path_of(line);
    if (!curve.style.filled) continue;
    area += path_of(line);
    if (!curve.style.closed)
      area += 'L' + coordinate(line.back().x) + ' ' + coordinate(baseline()) + 'H' + coordinate(line.front().x);
    area += 'Z';
  }
  std::string dots;
  for (const Point& point : curve.points) dots += move(point.x, point.y) + "h0";
  if (!area.empty()) path("area" + colour, area);
  if (!d.empty()) path(line_class(curve), d);
  if (!dots.empty()) path("dot" + colour, dots);
  for (const Box& bar : curve.bars) rectangle("bar" + colour, bar);
}

}  // namespace crankloop::report
