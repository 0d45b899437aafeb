// Drawings of a study: curves over one quantity, heat maps over two, and its page.
#include <algorithm>
#include <limits>

#include "../../files/number.hpp"
#include "../../files/words.hpp"
#include "study.hpp"

namespace crankloop::program {
namespace {

using report::Plot;
using report::Section;

constexpr std::size_t kMaxCurves = 12;
constexpr std::size_t kLeastFieldSide = 5;  // fewer values are read better as curves
constexpr std::size_t kMaxRows = 2000;      // of the table of all points

double number_at(const Study& study, std::size_t point, std::size_t figure) {
  return study.results[point].values[figure].value_or(std::numeric_limits<double>::quiet_NaN());
}

/// Words have the places 1, 2, 3 ...
double place(const Variation& axis, std::size_t i) {
  return axis.is_of_words() ? static_cast<double>(i + 1) : axis.numbers[i];
}

report::Axis axis_of(const Variation& axis) {
  report::Axis drawn = report::axis_of(axis.target.title(), axis.target.unit());
  if (!axis.is_of_words()) return drawn;
  drawn.tick_step = 1;
  drawn.range = report::Range{0.5, static_cast<double>(axis.values.size()) + 0.5};
  return drawn;
}

report::Axis figure_axis(const StudiedFigure& figure) { return report::axis_of(figure.title(), figure.unit); }

bool rises(const std::vector<double>& numbers) {
  return numbers.size() > 1 &&
         std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<double>()) == numbers.end();
}

Plot heat_map(const Study& study, std::size_t f) {
  const StudiedFigure& figure = study.figures[f];
  const Variation& x = study.axes[0];
  const Variation& y = study.axes[1];
  Plot plot = report::plot_of(study.title_of(figure), axis_of(x), axis_of(y));
  plot.field = {figure.title(), figure.unit, x.numbers, y.numbers, {}};
  for (std::size_t point = 0; point < study.points(); ++point) plot.field.values.push_back(number_at(study, point, f));
  plot.x.range = report::Range{x.numbers.front(), x.numbers.back()};
  plot.y.range = report::Range{y.numbers.front(), y.numbers.back()};
  if (x.own_number && y.own_number) plot.markers.push_back({*x.own_number, *y.own_number, "the file's own", 0});
  return plot;
}

/// A dashed line from the lowest to the highest value at the file's own x, and its value.
void mark_own(Plot& plot, const Study& study, const Variation& axis, std::size_t f) {
  if (!axis.own_number || study.axes.size() > 1 || !study.own.values[f]) return;
  const double own = *study.own.values[f];
  double low = own, high = own;
  for (const double y : plot.series[0].y) {
    if (y < low) low = y;
    if (y > high) high = y;
  }
  report::Series line;
  line.name = "the file's own";
  line.x = {*axis.own_number, *axis.own_number};
  line.y = {low, high};
  line.style.dashed = true;
  plot.series.push_back(std::move(line));
  plot.markers.push_back({*axis.own_number, own, report::number_text(own), 1});
  plot.caption = "Dashed: the file's own value.";
}

/// The axis along x, and the other one, of which each value has a curve: numbers lie along x before words, and many
/// before few.
struct Sides {
  std::size_t along;
  std::optional<std::size_t> across;
};
Sides sides_of(const Study& study) {
  if (study.axes.size() == 1) return {0, {}};
  const auto rank = [](const Variation& axis) { return axis.is_of_words() ? 0 : axis.values.size(); };
  const bool second = rank(study.axes[1]) > rank(study.axes[0]);
  return {second ? 1u : 0u, second ? 0u : 1u};
}

/// "250 mm", "a.csv".
std::string value_in_words(const Variation& axis, std::size_t i) {
  const std::string unit = axis.is_of_words() ? "" : axis.target.unit();
  return axis.values[i] + (unit.empty() ? "" : " " + unit);
}

Plot curves(const Study& study, std::size_t f) {
  const Sides sides = sides_of(study);
  const Variation& x = study.axes[sides.along];
  Plot plot = report::plot_of(study.title_of(study.figures[f]), axis_of(x), figure_axis(study.figures[f]));
  const std::size_t count = sides.across ? study.axes[*sides.across].values.size() : 1;
  plot.series.resize(std::min(count, kMaxCurves));
  if (x.numbers.size() > 1) {  // also where there are gaps
    const auto ends = std::minmax_element(x.numbers.begin(), x.numbers.end());
    const double own = sides.across ? *ends.first : x.own_number.value_or(*ends.first);
    plot.x.range = report::Range{std::min(*ends.first, own), std::max(*ends.second, own)};
  }
  for (std::size_t c = 0; c < plot.series.size(); ++c) {
    plot.series[c].style.draw = x.is_of_words() ? report::Draw::points : report::Draw::line_and_points;
    if (sides.across) plot.series[c].name = value_in_words(study.axes[*sides.across], c);
  }
  for (std::size_t point = 0; point < study.points(); ++point) {
    const std::size_t c = sides.across ? study.index(point, *sides.across) : 0;
    if (c >= plot.series.size()) continue;
    plot.series[c].x.push_back(place(x, study.index(point, sides.along)));
    plot.series[c].y.push_back(number_at(study, point, f));
  }
  if (count > kMaxCurves)
    plot.caption = "The first " + std::to_string(kMaxCurves) + " of " + std::to_string(count) + " curves.";
  if (sides.across && plot.caption.empty())
    plot.caption = "Each curve: " + study.axes[*sides.across].target.title() + ".";
  mark_own(plot, study, x, f);
  return plot;
}

Plot plot_of(const Study& study, std::size_t f) { return study.is_field() ? heat_map(study, f) : curves(study, f); }

/// What the places of words are: "1 a.csv, 2 b.csv".
std::string places_in_words(const Study& study) {
  std::vector<std::string> all;
  for (const Variation& axis : study.axes) {
    if (!axis.is_of_words()) continue;
    std::vector<std::string> words;
    for (std::size_t i = 0; i < axis.values.size(); ++i) words.push_back(std::to_string(i + 1) + " " + axis.values[i]);
    all.push_back(axis.target.title() + ": " + join(words));
  }
  return join(all, "; ");
}

std::string over_what(const Study& study) {
  std::vector<std::string> words;
  for (const Variation& axis : study.axes) words.push_back(axis.target.title());
  return join(words, " and ");
}

report::Table table_of(const Study& study) {
  report::Table table{"Table: all points", {}, {}, true};
  for (const Variation& axis : study.axes) table.columns.push_back({axis.target.title(), axis.target.unit()});
  for (const StudiedFigure& figure : study.figures) table.columns.push_back({study.title_of(figure), figure.unit});
  table.columns.push_back({"Gap", "", false});
  for (std::size_t point = 0; point < std::min(study.points(), kMaxRows); ++point) {
    std::vector<std::string> row;
    for (std::size_t a = 0; a < study.axes.size(); ++a) {
      const Variation& axis = study.axes[a];
      const std::size_t i = study.index(point, a);
      row.push_back(axis.is_of_words() ? axis.values[i] : report::number_text(axis.numbers[i], 6));
    }
    for (std::size_t f = 0; f < study.figures.size(); ++f)
      row.push_back(report::format_number(number_at(study, point, f), 5));
    row.push_back(study.results[point].refused);
    table.rows.push_back(std::move(row));
  }
  if (study.points() > kMaxRows)
    table.caption =
        "Table: the first " + std::to_string(kMaxRows) + " of " + std::to_string(study.points()) + " points";
  return table;
}

}  // namespace

std::string StudiedFigure::title() const {
  std::string title = name;
  std::replace(title.begin(), title.end(), '_', ' ');
  return title;
}

std::string Study::title_of(const StudiedFigure& figure) const {
  return std::string(commands[figure.command]->name) + ": " + figure.title();
}

std::string Study::column_of(const StudiedFigure& figure) const {
  std::string unit = figure.unit;
  std::replace(unit.begin(), unit.end(), '/', '_');
  std::replace(unit.begin(), unit.end(), ' ', '_');
  unit.erase(std::remove(unit.begin(), unit.end(), '^'), unit.end());
  return std::string(commands[figure.command]->name) + "." + figure.name + (unit.empty() ? "" : "_" + unit);
}

bool Study::is_field() const {
  const auto spans = [](const Variation& axis) { return rises(axis.numbers) && axis.values.size() >= kLeastFieldSide; };
  return axes.size() == 2 && spans(axes[0]) && spans(axes[1]);
}

report::Sheet study_sheet(const Study& study) {
  report::Sheet sheet;
  sheet.title = study.file.name();
  sheet.remarks = {"Study over " + over_what(study), study.file.path()};
  if (const std::string places = places_in_words(study); !places.empty()) sheet.remarks.push_back(places);
  for (std::size_t f = 0; f < study.figures.size(); ++f) sheet.plots.push_back(plot_of(study, f));
  sheet.columns = sheet.plots.size() > 1 ? 2 : 1;
  return sheet;
}

report::Page study_page(const Study& study) {
  report::Page page;
  page.title = "Study over " + over_what(study);
  page.subtitle = std::to_string(study.points()) + " points, from " + study.file.path() + ".";
  for (std::size_t f = 0; f < study.figures.size(); ++f) {
    const StudiedFigure& figure = study.figures[f];
    const std::optional<double>& own = study.own.values[f];
    page.facts.push_back({study.title_of(figure), own ? report::number_text(*own, 5) : "none", own ? figure.unit : "",
                          "of the file's own values"});
  }
  Section results{"results", "Results", {}};
  if (const std::string places = places_in_words(study); !places.empty())
    results.blocks.push_back(report::Paragraph{places + "."});
  for (std::size_t f = 0; f < study.figures.size(); ++f) results.blocks.push_back(plot_of(study, f));
  results.blocks.push_back(table_of(study));
  Section method{"method", "Method", {}};
  method.blocks.push_back(report::Paragraph{"Command: " + study.command_line});
  method.blocks.push_back(report::List{
      {"Each point is the engine file with other values, run through the commands of its figures; all else is as the "
       "file and the commands' defaults have it.",
       "Where a number is missing, a curve or a map has a gap, and the table the reason.",
       "The warnings of a command about its accuracy are not told for each point: run the command itself there."}});
  page.sections = {std::move(results), std::move(method)};
  page.footer = "Made by crankloop from " + study.file.path() + ".";
  return page;
}

}  // namespace crankloop::program
