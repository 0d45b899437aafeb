// The report's plots and pages: what an engineer reads off them must be what the numbers say, whatever the numbers are.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <locale>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "crankloop/report/page.hpp"
#include "crankloop/report/plot.hpp"
#include "crankloop/report/thinning.hpp"
#include "support/markup.hpp"

namespace crankloop::report {
namespace {

using support::Element;
using support::Markup;
using support::read;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.14159265358979323846;

TEST(MarkupReader, RefusesWhatTheOtherTestsRelyOnItToRefuse) {
  EXPECT_EQ(read("<a b=\"1\"><c/>x &amp; y</a>").fault, "");
  for (const char* bad : {"<a>", "</a>", "<a></b>", "<a b=1></a>", "<a>x & y</a>", "<a>1 > 0</a>", "<a b=\"<\"></a>",
                          "<a b=\"1\" b=\"2\"/>"}) {
    EXPECT_NE(read(bad).fault, "") << bad;
  }
}

/// All points of a path of absolute M and L, in order.
std::vector<Point> points_of(const std::string& d) {
  std::vector<Point> points;
  const char* at = d.c_str();
  while (*at != '\0') {
    if (*at == 'M' || *at == 'L' || *at == ' ') ++at;
    char* end = nullptr;
    const double x = std::strtod(at, &end);
    const double y = std::strtod(end, &end);
    if (end == at) break;
    points.push_back({x, y});
    at = end;
  }
  return points;
}

// Geometric attributes must be finite numbers inside the drawing (or not far off, for what a clip path cuts).
void expect_sound(const std::string& svg) {
  const Markup markup = read(svg);
  EXPECT_EQ(markup.fault, "");
  for (const Element& element : markup.elements) {
    for (const auto& [key, value] : element.attributes) {
      if (key == "x" || key == "y" || key == "width" || key == "height") {
        char* end = nullptr;
        const double number = std::strtod(value.c_str(), &end);
        EXPECT_EQ(*end, '\0') << key << '=' << value;
        EXPECT_TRUE(number >= -10 && number <= 1000) << element.name << ' ' << key << '=' << value;
      }
      if (key == "d") {
        EXPECT_EQ(value.find_first_not_of("MLHVZhv0123456789.- "), std::string::npos) << value;  // hence no nan, no inf
        EXPECT_FALSE(value.empty());
      }
    }
  }
}

// ---- Engines to draw ----

/// A cylinder pressure at 0.1 deg: a narrow peak 8.3 deg after firing TDC.
Series pressure_trace() {
  Series series;
  series.name = "pressure";
  for (int i = 0; i <= 7200; ++i) {
    const double deg = 0.1 * i;
    series.x.push_back(deg);
    series.y.push_back(1 + 77.3 * std::exp(-std::pow((deg - 8.3) / 14, 2)) +
                       40 * std::exp(-std::pow((deg - 720) / 30, 2)));
  }
  return series;
}

Plot plot_of(std::vector<Series> series) {
  Plot plot;
  plot.id = "p";
  plot.title = "Cylinder pressure";
  plot.x.title = "Crank angle";
  plot.x.unit = "deg";
  plot.y.title = "Pressure";
  plot.y.unit = "bar";
  plot.series = std::move(series);
  return plot;
}

// ---- Text ----

TEST(ReportText, EscapesWhatWouldBeMarkup) {
  EXPECT_EQ(escape("<b>\"Tom\" & 'Jerry'</b>"), "&lt;b&gt;&quot;Tom&quot; &amp; &#39;Jerry&#39;&lt;/b&gt;");
}

TEST(ReportText, KeepsUtf8AndReplacesWhatIsNone) {
  EXPECT_EQ(escape("\u03BB = 0.2738, 100 \u00B5s \U0001F527"), "\u03BB = 0.2738, 100 \u00B5s \U0001F527");
  EXPECT_EQ(escape("a\xFFz"), "a\uFFFDz");
  EXPECT_EQ(escape("a\xC3"), "a\uFFFD");                    // cut off
  EXPECT_EQ(escape("\xC0\xAF"), "\uFFFD\uFFFD");            // overlong '/'
  EXPECT_EQ(escape("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD");  // a surrogate
  EXPECT_EQ(escape(std::string_view("a\0b\x1B", 4)),
            "a\uFFFD"
            "b\uFFFD");
}

TEST(ReportText, WritesNumbersForReading) {
  EXPECT_EQ(format_number(168.0512, 4), "168.1");
  EXPECT_EQ(format_number(-0.2738, 3), "\u22120.274");
  EXPECT_EQ(format_number(9.996, 3), "10.0");
  EXPECT_EQ(format_number(12345.6, 3), "12\u202F346");  // no integer digit is rounded away
  EXPECT_EQ(format_number(1382, 4), "1382");
  EXPECT_EQ(format_number(3.2e-7, 2), "3.2\u00B710\u207B\u2077");
  EXPECT_EQ(format_number(0, 3), "0");
  EXPECT_EQ(format_number(-0.0, 3), "0");
  EXPECT_EQ(format_number(kNan, 3), "\u2013");
  EXPECT_EQ(format_fixed(-7.671, 2), "\u22127.67");
  EXPECT_EQ(format_fixed(-0.001, 2), "0.00");  // no negative zero
  EXPECT_EQ(format_fixed(-kInfinity, 2), "\u2013");
}

// ---- Scales ----

/// What a linear tick's label says.
double value_of(const Tick& tick, int exponent) {
  std::string digits = tick.label;
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"\u2212", "-"}, {"\u202F", ""}}) {
    for (std::size_t at = digits.find(from); at != std::string::npos; at = digits.find(from))
      digits.replace(at, from.size(), to);
  }
  return std::strtod(digits.c_str(), nullptr) * std::pow(10.0, exponent);
}

TEST(ReportScale, CoversAnyDataWithStepsOfOneTwoOrFiveAndLabelsThatSayTheValue) {
  constexpr unsigned kSeed = 495;
  RecordProperty("seed", static_cast<int>(kSeed));
  std::mt19937 random{kSeed};
  std::uniform_real_distribution<double> decade{-8, 8};
  std::uniform_real_distribution<double> part{-1, 1};
  for (int i = 0; i < 20'000; ++i) {
    const double size = std::pow(10.0, decade(random));
    const double a = size * part(random);
    const double b = size * part(random);
    const Range data{std::min(a, b), std::max(a, b)};
    const Scale scale = make_scale({}, data, 6);
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ": " + std::to_string(data.low) + " to " +
                 std::to_string(data.high));
    const double step = scale.ticks[1].value - scale.ticks[0].value;
    const double slack = 1e-9 * step;
    ASSERT_LE(scale.range.low, data.low + slack);
    ASSERT_GE(scale.range.high, data.high - slack);
    ASSERT_LT(data.low - scale.range.low, step);
    ASSERT_LT(scale.range.high - data.high, step);
    ASSERT_EQ(scale.ticks.front().value, scale.range.low);
    ASSERT_EQ(scale.ticks.back().value, scale.range.high);
    // 6 intervals of the next larger nice step, one more where the data straddle ticks; at least 6 / 2.5 (from 2 to 5).
    ASSERT_GE(scale.ticks.size(), 3u);
    ASSERT_LE(scale.ticks.size(), 8u);
    const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-6));
    ASSERT_TRUE(std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 || std::abs(mantissa - 5) < 1e-6)
        << step;
    for (const Tick& tick : scale.ticks)
      ASSERT_NEAR(value_of(tick, scale.exponent), tick.value, 1e-6 * step) << tick.label;
  }
}

TEST(ReportScale, CountsACycleInQuartersOfATurn) {
  Axis axis;
  axis.tick_step = 90;
  const Scale scale = make_scale(axis, {0, 720}, 7);
  EXPECT_EQ(scale.range.low, 0);
  EXPECT_EQ(scale.range.high, 720);
  ASSERT_EQ(scale.ticks.size(), 9u);
  EXPECT_EQ(scale.ticks[3].label, "270");
}

TEST(ReportScale, NamesThePowerOfTenThatItsLabelsLeaveOut) {
  const Scale small = make_scale({}, {0, 3e-8}, 6);
  EXPECT_EQ(small.exponent, -9);
  EXPECT_EQ(small.ticks.back().label, "30");
  const Scale large = make_scale({}, {0, 2e6}, 4);
  EXPECT_EQ(large.exponent, 6);
  EXPECT_EQ(make_scale({}, {-20'000, 40'000}, 6).ticks.front().label, "\u221220\u202F000");
}

TEST(ReportScale, SurvivesDataThatHaveNoExtent) {
  const double largest = std::numeric_limits<double>::max();
  const double tiny = std::numeric_limits<double>::denorm_min();
  for (const Range data :
       {Range{7, 7}, Range{0, 0}, Range{-2000, -2000}, Range{1, -1}, Range{kNan, kNan}, Range{-kInfinity, kInfinity},
        Range{-largest, largest}, Range{0, tiny}, Range{2000, 2000 + 1e-12}, Range{1e15, 1e15 + 1}}) {
    for (const bool logarithmic : {false, true}) {
      Axis axis;
      axis.logarithmic = logarithmic;
      const Scale scale = make_scale(axis, data, 6);
      SCOPED_TRACE(std::to_string(data.low) + " to " + std::to_string(data.high) +
                   (logarithmic ? ", logarithmic" : ""));
      EXPECT_TRUE(std::isfinite(scale.range.low) && std::isfinite(scale.range.high));
      EXPECT_LT(scale.range.low, scale.range.high);
      EXPECT_GE(scale.ticks.size(), 2u);
      EXPECT_LE(scale.ticks.size(), 4000u);
      if (data.low <= data.high && std::abs(data.low) < 1e100 && (!logarithmic || data.low > 0)) {
        EXPECT_LE(scale.range.low, data.low);
        EXPECT_GE(scale.range.high, data.high);
      }
    }
  }
}

TEST(ReportScale, IgnoresAStepThatWouldBlackenTheAxis) {
  Axis axis;
  axis.tick_step = 0.001;
  EXPECT_LE(make_scale(axis, {0, 720}, 7).ticks.size(), 9u);
}

TEST(ReportScale, KeepsAGivenRangeAndTicksInsideIt) {
  Axis axis;
  axis.range = Range{-10, 55};
  axis.tick_step = 90;  // none would lie inside
  const Scale scale = make_scale(axis, {0, 720}, 7);
  EXPECT_EQ(scale.range.low, -10);
  EXPECT_EQ(scale.range.high, 55);
  EXPECT_EQ(scale.ticks.front().label, "\u221210");
  EXPECT_EQ(scale.ticks.back().label, "50");
}

TEST(ReportScale, LogarithmicRoundsOutToOneTwoFiveAndLabelsDecades) {
  Axis axis;
  axis.logarithmic = true;
  const Scale volume = make_scale(axis, {45.3, 860}, 7);  // cm^3 of one cylinder of the 495
  EXPECT_NEAR(volume.range.low, 20, 1e-9);
  EXPECT_NEAR(volume.range.high, 1000, 1e-9);
  std::vector<std::string> labels;
  for (const Tick& tick : volume.ticks) {
    if (!tick.label.empty()) labels.push_back(tick.label);
  }
  EXPECT_EQ(labels, (std::vector<std::string>{"20", "50", "100", "200", "500", "1000"}));

  const Scale error = make_scale(axis, {3e-12, 2e-6}, 7);
  for (const Tick& tick : error.ticks) {
    if (tick.label.empty()) continue;
    EXPECT_NEAR(std::log10(tick.value), std::round(std::log10(tick.value)), 1e-9) << tick.label;
  }
  EXPECT_LE(error.range.low, 3e-12);
  EXPECT_GE(error.range.high, 2e-6 * (1 - 1e-9));
}

// ---- Thinning ----

double distance_to(const std::vector<Point>& line, Point p) {
  double nearest = kInfinity;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double dx = line[i].x - line[i - 1].x;
    const double dy = line[i].y - line[i - 1].y;
    const double squared = dx * dx + dy * dy;
    const double t =
        squared > 0 ? std::clamp(((p.x - line[i - 1].x) * dx + (p.y - line[i - 1].y) * dy) / squared, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, std::hypot(p.x - line[i - 1].x - t * dx, p.y - line[i - 1].y - t * dy));
  }
  return nearest;
}

bool contains(const std::vector<Point>& line, Point p) {
  return std::any_of(line.begin(), line.end(), [&](const Point& q) { return q.x == p.x && q.y == p.y; });
}

void expect_faithful(const std::vector<Point>& all, const std::vector<Point>& kept, double tolerance) {
  const auto by_x = [](const Point& a, const Point& b) { return a.x < b.x; };
  const auto by_y = [](const Point& a, const Point& b) { return a.y < b.y; };
  EXPECT_TRUE(contains(kept, all.front()) && contains(kept, all.back()));
  EXPECT_TRUE(contains(kept, *std::min_element(all.begin(), all.end(), by_x)));
  EXPECT_TRUE(contains(kept, *std::max_element(all.begin(), all.end(), by_x)));
  EXPECT_TRUE(contains(kept, *std::min_element(all.begin(), all.end(), by_y)));
  EXPECT_TRUE(contains(kept, *std::max_element(all.begin(), all.end(), by_y)));
  double worst = 0;
  for (const Point& point : all) worst = std::max(worst, distance_to(kept, point));
  EXPECT_LE(worst, 2 * tolerance * (1 + 1e-12));
}

TEST(ReportThinning, KeepsThePressurePeakAndDropsWhatNobodySees) {
  const Series trace = pressure_trace();
  std::vector<Point> all;
  for (std::size_t i = 0; i < trace.x.size(); ++i) all.push_back({trace.x[i] * 0.6, trace.y[i] * 3});
  const std::vector<Point> kept = decimate(all, 0.1);
  expect_faithful(all, kept, 0.1);
  EXPECT_LT(kept.size(), 200u);
}

TEST(ReportThinning, KeepsTheShapeOfALoop) {
  std::vector<Point> loop;  // side force over displacement: x there and back, the ends the same
  for (int i = 0; i <= 5000; ++i) {
    const double a = 2 * kPi * i / 5000;
    loop.push_back({200 - 200 * std::cos(a), 100 * std::sin(a) + 30 * std::sin(2 * a)});
  }
  const std::vector<Point> kept = decimate(loop, 0.1);
  expect_faithful(loop, kept, 0.1);
  EXPECT_LT(kept.size(), 200u);
}

TEST(ReportThinning, BoundsNoiseByTheWidthOfTheDrawingNotByItsLength) {
  constexpr unsigned kSeed = 2000;
  std::mt19937 random{kSeed};
  std::normal_distribution<double> noise{100, 20};
  std::vector<Point> all;
  for (int i = 0; i < 300'000; ++i) all.push_back({440.0 * i / 300'000, noise(random)});
  const std::vector<Point> kept = decimate(all, 0.5);
  EXPECT_LE(kept.size(), 4u * 881u) << "seed " << kSeed;
  std::vector<Point> sample;
  for (std::size_t i = 0; i < all.size(); i += 997) sample.push_back(all[i]);
  for (const Point& point : sample) EXPECT_LE(distance_to(kept, point), 1.0);
}

TEST(ReportThinning, LeavesShortAndCoincidentLinesAlone) {
  EXPECT_TRUE(decimate({}, 0.1).empty());
  EXPECT_EQ(decimate({{1, 1}}, 0.1).size(), 1u);
  EXPECT_EQ(decimate({{1, 1}, {1, 1}}, 0.1).size(), 2u);
  const std::vector<Point> same(100, Point{3, 4});
  EXPECT_LE(decimate(same, 0.1).size(), 2u);
}

// ---- Plots ----

TEST(ReportPlot, SaysItsQuantitiesUnitsAndRanges) {
  const Markup svg = read(to_svg(plot_of({pressure_trace()})));
  ASSERT_EQ(svg.fault, "");
  const auto titles = svg.of_class("axis-title");
  ASSERT_EQ(titles.size(), 2u);
  EXPECT_EQ(titles[0].text, "Pressure, bar");
  EXPECT_EQ(titles[1].text, "Crank angle, deg");
  ASSERT_EQ(svg.all("title").size(), 1u);
  EXPECT_EQ(svg.all("title")[0].text, "Cylinder pressure");
  EXPECT_NE(svg.all("desc")[0].text.find("pressure: from 1.00 to 78.3 bar"), std::string::npos)
      << svg.all("desc")[0].text;
  EXPECT_EQ(svg.elements[0].attributes.at("role"), "img");
  EXPECT_EQ(svg.elements[0].attributes.at("aria-labelledby"), "p-title p-desc");
}

TEST(ReportPlot, ACycleOfSevenThousandPointsStaysSmall) {
  const std::string svg = to_svg(plot_of({pressure_trace()}));
  expect_sound(svg);
  EXPECT_LT(svg.size(), 8'000u);
}

TEST(ReportPlot, BreaksTheLineWhereDataAreMissing) {
  Series series = pressure_trace();
  for (std::size_t i = 1000; i < 1100; ++i) series.y[i] = kNan;
  series.y[3000] = kInfinity;
  series.x[5000] = -kInfinity;
  const std::string svg = to_svg(plot_of({series}));
  expect_sound(svg);
  const std::string d = read(svg).of_class("curve").at(0).attributes.at("d");
  EXPECT_EQ(std::count(d.begin(), d.end(), 'M'), 4);
}

TEST(ReportPlot, DrawsAnythingItIsGivenWithoutANumberGoingAstray) {
  const double largest = std::numeric_limits<double>::max();
  const double tiny = std::numeric_limits<double>::denorm_min();
  const std::vector<std::vector<double>> data{{},
                                              {5},
                                              {2000, 2000, 2000},
                                              {0, 0, 0},
                                              {kNan, kNan},
                                              {kNan, 3, kNan},
                                              {-largest, largest, 0},
                                              {tiny, 2 * tiny, 0},
                                              {-1, 0, 1, 1e-300},
                                              {1e9, 1e9 + 1e-7, 1e9},
                                              {kInfinity, -kInfinity, 1}};
  for (const auto& x : data) {
    for (const auto& y : data) {
      for (const Draw draw : {Draw::line, Draw::step, Draw::bar, Draw::points, Draw::line_and_points}) {
        for (const bool logarithmic : {false, true}) {
          Series series{"a", x, y, {}};
          series.style.draw = draw;
          series.style.filled = series.style.closed = true;
          Series other{"b", y, x, {}};
          Plot plot = plot_of({series, other});
          plot.x.logarithmic = plot.y.logarithmic = logarithmic;
          plot.bands = {{-kInfinity, 5, "a"}, {5, kNan, "b"}, {720, 0, "c"}, {1, 3, "d"}};
          plot.markers = mark_extremes(plot, 0);
          plot.markers.push_back({kNan, 1, "nowhere", 0});
          plot.markers.push_back({1e9, -1e9, "far", 99});
          expect_sound(to_svg(plot));
          if (HasFailure()) return;
        }
      }
    }
  }
}

TEST(ReportPlot, ShowsALonePointAsADotAndNoDataAsWords) {
  const Markup one = read(to_svg(plot_of({{"", {5}, {7}, {}}})));
  EXPECT_EQ(one.of_class("dot").size(), 1u);
  EXPECT_TRUE(one.of_class("curve").empty());
  EXPECT_NE(to_svg(plot_of({})).find("no data"), std::string::npos);
}

TEST(ReportPlot, AConstantRunsThroughTheMiddle) {
  const Markup svg = read(to_svg(plot_of({{"", {0, 1, 2}, {2000, 2000, 2000}, {}}})));
  const std::vector<Point> line = points_of(svg.of_class("curve").at(0).attributes.at("d"));
  const std::vector<Point> axis = points_of(svg.of_class("axis").at(0).attributes.at("d"));
  ASSERT_EQ(line.size(), 2u);
  EXPECT_EQ(line[0].y, line[1].y);
  EXPECT_LT(line[0].y, axis.at(0).y - 50);  // y counts downward: well above the axis
}

TEST(ReportPlot, LeavesOutWhatALogarithmCannotShow) {
  Plot plot = plot_of({{"", {-1, 0, 1, 10, 100}, {1, 1, 1e-6, 1e-3, 1}, {}}});
  plot.x.logarithmic = plot.y.logarithmic = true;
  const std::string svg = to_svg(plot);
  expect_sound(svg);
  const std::vector<Point> line = points_of(read(svg).of_class("curve").at(0).attributes.at("d"));
  ASSERT_EQ(line.size(), 2u);  // a power law is straight on log-log axes: the point in the middle is not needed
  EXPECT_GT(line[0].y, line[1].y);
}

TEST(ReportPlot, CutsOffWhatLiesOutsideAGivenRange) {
  Plot plot = plot_of({pressure_trace()});
  plot.x.range = Range{-10, 30};  // around combustion
  const std::string svg = to_svg(plot);
  const Markup markup = read(svg);
  const std::string id = markup.all("clipPath").at(0).attributes.at("id");
  EXPECT_EQ(markup.all("g").at(0).attributes.at("clip-path"), "url(#" + id + ")");
  const std::vector<Point> line = points_of(markup.of_class("curve").at(0).attributes.at("d"));
  EXPECT_GT(line.back().x, 520.0);  // 720 deg lies off the drawing, in its true direction
}

TEST(ReportPlot, ClosesALoopAndTintsItsInside) {
  Series loop{"", {1, 2, 2, 1}, {1, 1, 2, 2}, {}};
  loop.style.closed = loop.style.filled = true;
  const Markup svg = read(to_svg(plot_of({loop})));
  const std::vector<Point> line = points_of(svg.of_class("curve").at(0).attributes.at("d"));
  ASSERT_EQ(line.size(), 5u);
  EXPECT_EQ(line.front().x, line.back().x);
  EXPECT_EQ(line.front().y, line.back().y);
  EXPECT_EQ(svg.of_class("area").at(0).attributes.at("d").back(), 'Z');
}

TEST(ReportPlot, BarsStandOnZeroBesideEachOther) {
  Series one{"one cylinder", {0.5, 1, 1.5}, {100, 160, -40}, {}};
  one.style.draw = Draw::bar;
  Series four = one;
  four.name = "four cylinders";
  const Markup svg = read(to_svg(plot_of({one, four})));
  const auto bars = svg.of_class("bar");
  ASSERT_EQ(bars.size(), 8u);  // 6, and 2 in the legend
  const auto number = [&](std::size_t i, const char* key) {
    return std::strtod(bars[i].attributes.at(key).c_str(), nullptr);
  };
  const double zero = points_of(svg.of_class("zero").at(0).attributes.at("d")).at(0).y;
  constexpr double kRounding = 0.01 + 1e-9;  // two coordinates of two decimals
  for (const std::size_t i : {0u, 1u, 3u, 4u}) EXPECT_NEAR(number(i, "y") + number(i, "height"), zero, kRounding);
  for (const std::size_t i : {2u, 5u}) EXPECT_NEAR(number(i, "y"), zero, kRounding);
  EXPECT_NEAR(number(1, "height") / number(0, "height"), 1.6, 1e-3);
  EXPECT_NEAR(number(0, "x") + number(0, "width"), number(3, "x"), kRounding);  // side by side, not over each other
  EXPECT_LT(number(3, "x") + number(3, "width"), number(1, "x"));
}

TEST(ReportPlot, StepsHoldTheirValueUntilTheNext) {
  Series steps{"", {0, 1, 2}, {1, 3, 2}, {}};
  steps.style.draw = Draw::step;
  const std::vector<Point> line = points_of(read(to_svg(plot_of({steps}))).of_class("curve").at(0).attributes.at("d"));
  ASSERT_EQ(line.size(), 5u);
  EXPECT_EQ(line[0].y, line[1].y);
  EXPECT_EQ(line[1].x, line[2].x);
  EXPECT_EQ(line[2].y, line[3].y);
}

TEST(ReportPlot, NamesStandBesideCurvesThatLeaveRoomAndInALegendOtherwise) {
  Series gas{"gas", {}, {}, {}};
  Series inertia{"inertia", {}, {}, {}};
  for (int deg = 0; deg <= 720; deg += 5) {
    gas.x.push_back(deg);
    gas.y.push_back(30 + 10 * std::sin(deg * kPi / 180));
    inertia.x.push_back(deg);
    inertia.y.push_back(-10 * std::cos(deg * kPi / 180));
  }
  const Markup apart = read(to_svg(plot_of({gas, inertia})));
  EXPECT_EQ(apart.of_class("name").size(), 2u);
  EXPECT_TRUE(apart.of_class("legend").empty());

  Series sum = gas;
  sum.name = "sum";
  const Markup on_top = read(to_svg(plot_of({gas, sum})));
  EXPECT_EQ(on_top.of_class("legend").size(), 2u);
}

TEST(ReportPlot, MarksExtremesWithTheirValueAndPlace) {
  const Plot plot = plot_of({pressure_trace()});
  const std::vector<Marker> marks = mark_extremes(plot, 0);
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_EQ(marks[0].label, "78.3 bar at 8.3 deg");
  EXPECT_EQ(mark_extremes(plot_of({{"", {1, 2}, {5, 5}, {}}}), 0).size(), 1u);
  EXPECT_TRUE(mark_extremes(plot_of({{"", {1}, {kNan}, {}}}), 0).empty());
  EXPECT_TRUE(mark_extremes(plot, 7).empty());
  // sin(180 deg) in double is 1.2e-16: rounding, which nobody wants to read.
  EXPECT_EQ(mark_extremes(plot_of({{"", {90, 180}, {1, std::sin(kPi)}, {}}}), 0).at(1).label, "0 bar at 180 deg");
}

TEST(ReportPlot, EscapesEveryTextItIsGiven) {
  const std::string evil = "<script>\"&'";
  Plot plot = plot_of({pressure_trace(), {evil, {0, 720}, {9, 9}, {}}});
  plot.id = plot.title = plot.x.title = plot.x.unit = plot.y.title = plot.y.unit = evil;
  plot.bands = {{0, 720, evil}};
  plot.markers = {{360, 20, evil, 0}};
  const std::string svg = to_svg(plot);
  EXPECT_EQ(read(svg).fault, "");
  EXPECT_EQ(svg.find("<script"), std::string::npos);
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(ReportPlot, SameDataGiveTheSameBytesInAnyLocale) {
  Plot plot = plot_of({pressure_trace()});
  plot.markers = mark_extremes(plot, 0);
  const std::string svg = to_svg(plot);
  EXPECT_EQ(svg, to_svg(plot));
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  const std::string elsewhere = to_svg(plot);
  std::locale::global(before);
  EXPECT_EQ(svg, elsewhere);
}

// ---- Colours ----

using Rgb = std::array<double, 3>;

/// The colour variables of one theme.
std::map<std::string, Rgb> colours(bool dark) {
  const std::string style{plot_style()};
  const std::size_t media = style.find("prefers-color-scheme: dark");
  std::map<std::string, Rgb> found;
  std::size_t at = dark ? media : 0;
  const std::size_t end = dark ? style.find("\n}", media) : media;
  while ((at = style.find("--", at)) < end) {
    const std::size_t colon = style.find(':', at);
    const std::string value = style.substr(colon + 2, 7);
    Rgb rgb{};
    for (std::size_t i = 0; i < 3; ++i) {  // sRGB to linear light, IEC 61966-2-1
      const double c = static_cast<double>(std::strtol(value.substr(1 + 2 * i, 2).c_str(), nullptr, 16)) / 255;
      rgb[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    }
    found[style.substr(at + 2, colon - at - 2)] = rgb;
    at = colon;
  }
  return found;
}

/// Contrast ratio of WCAG 2.
double contrast(const Rgb& a, const Rgb& b) {
  const auto luminance = [](const Rgb& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; };
  const auto [darker, lighter] = std::minmax({luminance(a), luminance(b)});
  return (lighter + 0.05) / (darker + 0.05);
}

TEST(ReportColours, TextIsLegibleInBothThemes) {
  constexpr double kAa = 4.5;      // WCAG 2, 1.4.3: text
  constexpr double kGraphics = 3;  // 1.4.11: parts of a graphic needed to understand it
  for (const bool dark : {false, true}) {
    const auto theme = colours(dark);
    SCOPED_TRACE(dark ? "dark" : "light");
    for (const char* ground : {"paper", "band"}) {
      for (const char* text :
           {"ink", "muted", "accent", "series-1", "series-2", "series-3", "series-4", "series-5", "series-6"}) {
        EXPECT_GE(contrast(theme.at(text), theme.at(ground)), kAa) << text << " on " << ground;
      }
      for (const char* line : {"axis", "zero"})
        EXPECT_GE(contrast(theme.at(line), theme.at(ground)), kGraphics) << line;
    }
  }
}

TEST(ReportColours, CurvesDifferForColourBlindReadersToo) {
  // Dichromats' view of linear sRGB: Machado, Oliveira, Fernandes 2009, severity 1. Difference: CIE 1976 L*a*b*.
  using Matrix = std::array<Rgb, 3>;
  const std::map<std::string, Matrix> views{
      {"normal", {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
      {"protan", {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}}},
      {"deutan", {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}}},
      {"tritan",
       {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}}};
  const auto lab = [](const Matrix& view, const Rgb& colour) {
    Rgb seen{};
    for (std::size_t i = 0; i < 3; ++i) {
      seen[i] = std::clamp(view[i][0] * colour[0] + view[i][1] * colour[1] + view[i][2] * colour[2], 0.0, 1.0);
    }
    const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
    const double x = f((0.4124 * seen[0] + 0.3576 * seen[1] + 0.1805 * seen[2]) / 0.9505);
    const double y = f(0.2126 * seen[0] + 0.7152 * seen[1] + 0.0722 * seen[2]);
    const double z = f((0.0193 * seen[0] + 0.1192 * seen[1] + 0.9505 * seen[2]) / 1.089);
    return Rgb{116 * y - 16, 500 * (x - y), 200 * (y - z)};
  };
  constexpr double kClearlyDifferent = 10;  // about 2.3 is just noticeable side by side
  for (const bool dark : {false, true}) {
    const auto theme = colours(dark);
    for (const auto& [name, view] : views) {
      for (int i = 1; i <= kColours; ++i) {
        for (int k = i + 1; k <= kColours; ++k) {
          const Rgb a = lab(view, theme.at("series-" + std::to_string(i)));
          const Rgb b = lab(view, theme.at("series-" + std::to_string(k)));
          EXPECT_GE(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]), kClearlyDifferent)
              << name << (dark ? ", dark " : ", light ") << i << k;
        }
      }
    }
  }
}

// ---- Pages ----

Page sample_page() {
  Page page;
  page.title = "495 diesel at 2000 rpm";
  page.subtitle = "Crank mechanism";
  page.facts = {{"Mean torque", "168.1", "Nm", "four cylinders"}, {"Power", "35.2", "kW", ""}};
  Table narrow{"Geometry", {{"Quantity", "", false}, {"Value", "", true}}, {{"Bore", "95 mm"}, {"Stroke"}}, false};
  Table wide{"Forces",
             {{"a", "deg"}, {"b", "N"}, {"c", "N"}, {"d", "N"}, {"e", "N"}},
             {{"0", "1", "2", "3", "4", "surplus"}},
             true};
  Plot plot = plot_of({pressure_trace()});
  plot.caption = "Synthesised.";
  page.sections = {{"",
                    "Definition",
                    {Paragraph{"Even firing.", false}, Paragraph{"Pressure is synthesised.", true},
                     List{{"No offset."}}, narrow, narrow}},
                   {"forces", "Forces", {plot, plot, wide}}};
  page.footer = "Made by a test.";
  return page;
}

TEST(ReportPage, IsWellFormedAndNeedsNoNetworkAndNoScript) {
  const std::string html = to_html(sample_page());
  EXPECT_EQ(read(html).fault, "");
  EXPECT_EQ(html.rfind("<!DOCTYPE html>", 0), 0u);
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("@import"), std::string::npos);
  EXPECT_EQ(html.find("src=\""), std::string::npos);
  for (std::size_t at = html.find("url("); at != std::string::npos; at = html.find("url(", at + 1))
    EXPECT_EQ(html[at + 4], '#');
  for (std::size_t at = html.find("http"); at != std::string::npos; at = html.find("http", at + 1)) {
    const bool name_space = html.compare(at, 26, "http://www.w3.org/2000/svg") == 0;  // a name, which nobody fetches
    EXPECT_TRUE(name_space || html.compare(at, 10, "http-equiv") == 0) << html.substr(at, 40);
  }
}

TEST(ReportPage, CanBeReadByEar) {
  const Markup html = read(to_html(sample_page()));
  EXPECT_EQ(html.all("html").at(0).attributes.at("lang"), "en");
  int level = 0;
  for (const Element& element : html.elements) {
    if (element.name.size() != 2 || element.name[0] != 'h' || element.name[1] < '1' || element.name[1] > '6') continue;
    EXPECT_LE(element.name[1] - '0', level + 1) << "heading skips a level: " << element.text;
    level = element.name[1] - '0';
  }
  EXPECT_EQ(html.all("h1").size(), 1u);
  EXPECT_EQ(html.all("figure").size(), html.all("svg").size());
  EXPECT_EQ(html.all("figcaption").size(), 2u);
  EXPECT_EQ(html.all("table").size(), html.all("caption").size());
  for (const Element& heading : html.all("th")) EXPECT_EQ(heading.attributes.count("scope"), 1u);
}

TEST(ReportPage, GivesEveryIdOnceAndEveryReferenceAnId) {
  Page page = sample_page();
  page.sections[0].title = "Forces";  // as the other one
  page.sections[1].id = "p-title";    // as a part of the plot "p"
  const Markup html = read(to_html(page));
  std::set<std::string> ids;
  for (const Element& element : html.elements) {
    const auto it = element.attributes.find("id");
    if (it == element.attributes.end()) continue;
    EXPECT_TRUE(ids.insert(it->second).second) << it->second;
    EXPECT_EQ(it->second.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string::npos) << it->second;
  }
  for (const Element& element : html.elements) {
    for (const char* key : {"href", "aria-labelledby"}) {
      const auto it = element.attributes.find(key);
      if (it == element.attributes.end() || it->second == "data:,") continue;
      std::string names = it->second + ' ';
      for (std::size_t at = names.find(' '); at != std::string::npos; names.erase(0, at + 1), at = names.find(' ')) {
        const std::string name = names.substr(names[0] == '#' ? 1 : 0, names[0] == '#' ? at - 1 : at);
        EXPECT_EQ(ids.count(name), 1u) << name;
      }
    }
  }
}

TEST(ReportPage, FillsShortRowsAndDropsSurplusCells) {
  const Markup html = read(to_html(sample_page()));
  EXPECT_EQ(html.all("td").size() + html.all("th").size(),
            2u * (2 + 2 * 2) + (5 + 5));  // two narrow tables of two rows, a wide one of one row, each with its head
}

TEST(ReportPage, EscapesEveryTextItIsGiven) {
  const std::string evil = "</style><script>\"&'";
  Page page;
  page.title = page.subtitle = page.footer = page.language = evil;
  page.facts = {{evil, evil, evil, evil}};
  Plot plot = plot_of({});
  plot.id = plot.title = plot.caption = evil;
  page.sections = {
      {evil, evil, {Paragraph{evil, true}, List{{evil}}, Table{evil, {{evil, evil, true}}, {{evil}}, true}, plot}},
      {"", "", {}}};
  const std::string html = to_html(page);
  EXPECT_EQ(read(html).fault, "");
  EXPECT_EQ(html.find("<script"), std::string::npos);
}

TEST(ReportPage, AnEmptyPageIsAPage) { EXPECT_EQ(read(to_html({})).fault, ""); }

TEST(ReportPage, SamePageGivesTheSameBytes) { EXPECT_EQ(to_html(sample_page()), to_html(sample_page())); }

}  // namespace
}  // namespace crankloop::report
