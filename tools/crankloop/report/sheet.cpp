#include "sheet.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>

namespace crankloop::report {
namespace {

// User units, as those of the drawings.
constexpr double kMargin = 24;
constexpr double kBetweenColumns = 40;
constexpr double kBetweenRows = 30;
constexpr double kTitle = 34;  // line heights
constexpr double kRemark = 24;
constexpr double kName = 30;  // of a plot, above it

constexpr const char* kSheetStyle = R"css(
:root { max-width: 100%; height: auto; color-scheme: light dark; font-family: system-ui, -apple-system, "Segoe UI",
  Roboto, "Helvetica Neue", "Noto Sans", "Liberation Sans", Arial, sans-serif; }
.paper { fill: var(--paper); }
.sheet-title { fill: var(--ink); font-size: 25px; font-weight: 600; }
.remark { fill: var(--muted); font-size: 16px; }
.plot-name { fill: var(--ink); font-size: 18px; font-weight: 600; }
)css";

std::string units(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%d",
                static_cast<int>(value));  // whole units: no decimal sign, whatever the locale
  return digits;
}

std::string text(const char* what, double x, double y, const std::string& content) {
  return std::string("<text class=\"") + what + "\" x=\"" + units(x) + "\" y=\"" + units(y) + "\">" + escape(content) +
         "</text>\n";
}

}  // namespace

std::string to_svg_file(const Sheet& sheet) {
  const auto columns = static_cast<std::size_t>(std::max(1, sheet.columns));
  std::string body;
  double y = kMargin + kTitle;
  body += text("sheet-title", kMargin, y, sheet.title);
  for (const std::string& remark : sheet.remarks) body += text("remark", kMargin, y += kRemark, remark);
  y += kBetweenRows + 12;
  double right = 0;
  if (!sheet.picture.svg.empty()) {
    body +=
        "<g transform=\"translate(" + units(kMargin) + ' ' + units(y - kName) + ")\">\n" + sheet.picture.svg + "</g>\n";
    right = kMargin + sheet.picture.width;
    y += sheet.picture.height + kBetweenRows;
  }
  for (std::size_t first = 0; first < sheet.plots.size(); first += columns) {
    double x = kMargin;
    double highest = 0;
    for (std::size_t i = first; i < std::min(first + columns, sheet.plots.size()); ++i) {
      Plot plot = sheet.plots[i];
      plot.id = "plot-" + std::to_string(i + 1);
      const Drawn drawn = draw(plot);
      body += text("plot-name", x, y, plot.title);
      body += "<g transform=\"translate(" + units(x) + ' ' + units(y + kName - 18) + ")\">\n" + drawn.svg + "</g>\n";
      right = std::max(right, x + drawn.width);
      highest = std::max(highest, drawn.height);
      x += drawn.width + kBetweenColumns;
    }
    y += kName + highest + kBetweenRows;
  }
  const std::string width = units(right + kMargin);
  const std::string height = units(y - kBetweenRows + kMargin);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
                    "\" viewBox=\"0 0 " + width + ' ' + height + "\" role=\"group\" aria-labelledby=\"sheet-title\">\n";
  svg += "<title id=\"sheet-title\">" + escape(sheet.title) + "</title>\n<style>\n";
  svg += plot_style();
  svg += kSheetStyle;
  svg += sheet.picture.style;
  svg += "</style>\n<rect class=\"paper\" width=\"" + width + "\" height=\"" + height + "\"/>\n";
  return svg + body + "</svg>\n";
}

}  // namespace crankloop::report
