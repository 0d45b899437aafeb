// The report's plots: what an engineer reads off them must be what the numbers say, whatever the numbers are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <locale>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "crankloop/report/plot.hpp"
#include "crankloop/report/thinning.hpp"
#include "support/drawing_geometry.hpp"
#include "support/markup.hpp"
#include "support/report_plots.hpp"
#include "support/units.hpp"

namespace crankloop::report::report_test {
namespace {

using support::Element;
using support::Markup;
using support::read;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
using support::kPi;

TEST(MarkupReader, RefusesWhatTheOtherTestsRelyOnItToRefuse) {
  EXPECT_EQ(read("<a b=\"1\"><c/>x &amp; y</a>").fault, "");
  for (const char* bad : {"<a>", "</a>", "<a></b>", "<a b=1></a>", "<a>x & y</a>", "<a>1 > 0</a>", "<a b=\"<\"></a>",
                          "<a b=\"1\" b=\"2\"/>"}) {
    EXPECT_NE(read(bad).fault, "") << bad;
  }
}

/// All points of a path, in order.
std::vector<Point> points_of(const std::string& d) {
  std::vector<Point> points;
  for (const Polyline& line : support::lines_of(d)) points.insert(points.end(), line.begin(), line.end());
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
          if (!x.empty() && !y.empty()) plot.markers = {{x[0], y[0], "first", 0}};
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

/// Loops within loops around zero, as bearing loads are: the label of the largest stands clear of all of them.
TEST(ReportPlot, KeepsLabelsOffCurvesAndZeroLines) {
  for (int turns = 1; turns <= 3; ++turns) {
    for (int at_deg = 0; at_deg < 360; at_deg += 15) {
      Series loop;
      loop.style.closed = true;
      for (int i = 0; i < 720; ++i) {
        const double a = i * kPi / 360;
        const double r = 3 + std::cos(turns * a);
        loop.x.push_back(r * std::cos(a));
        loop.y.push_back(r * std::sin(a));
      }
      Plot plot = plot_of({loop});
      plot.x.range = Range{-9.4, 9.4};
      plot.y.range = Range{-5.5, 5.5};
      const auto i = static_cast<std::size_t>(2 * at_deg);
      plot.markers = {{loop.x[i], loop.y[i], "23.5 kN", 0}};
      EXPECT_EQ(support::labels_in_the_way(read(to_svg(plot))), std::vector<std::string>{}) << turns << ' ' << at_deg;
    }
  }
}

/// z = x + 10 y over 4 by 3 points.
Plot plane() {
  Plot plot = plot_of({});
  plot.field = {"height", "m", {0, 1, 2, 3}, {0, 1, 2}, {}};
  for (const double x : plot.field.x) {
    for (const double y : plot.field.y) plot.field.values.push_back(x + 10 * y);
  }
  plot.x.range = Range{0, 3};
  plot.y.range = Range{0, 2};
  return plot;
}

TEST(ReportHeatMap, HasStepsOfColourAndContoursWhereTheValuesAre) {
  const Plot plot = plane();
  const std::string svg = to_svg(plot);
  expect_sound(svg);
  const Markup markup = read(svg);
  std::set<std::string> colours;
  for (const Element& area : markup.of_class("heat")) colours.insert(area.attributes.at("style"));
  EXPECT_GE(colours.size(), static_cast<std::size_t>(kHeatSteps));
  EXPECT_LE(colours.size(), 3u * kHeatSteps);

  // Contours at multiples of 5 (0 only touches a corner), straight, and where x + 10 y is theirs.
  const auto contours = markup.of_class("contour");
  ASSERT_EQ(contours.size(), 4u);
  std::istringstream scales(markup.elements[0].attributes.at("data-x") + ' ' +
                            markup.elements[0].attributes.at("data-y"));
  double n[8];
  for (double& one : n) scales >> one;
  for (std::size_t k = 0; k < contours.size(); ++k) {
    for (const Point& point : points_of(contours[k].attributes.at("d"))) {
      const double x = n[0] + (point.x - n[2]) / (n[3] - n[2]) * (n[1] - n[0]);
      const double y = n[4] + (point.y - n[6]) / (n[7] - n[6]) * (n[5] - n[4]);
      EXPECT_NEAR(x + 10 * y, 5 * static_cast<double>(k + 1), 0.01);
    }
  }
  const auto heights = markup.of_class("height");
  ASSERT_EQ(heights.size(), 4u);
  EXPECT_EQ(heights[1].text, "10");
  EXPECT_NE(markup.all("desc")[0].text.find("height: from 0 to 23.0 m"), std::string::npos)
      << markup.all("desc")[0].text;
}

TEST(ReportHeatMap, DrawsAnything) {
  for (const double value : {0.0, 7.0, -1e-9, 1e9, kNan, kInfinity}) {
    Plot plot = plane();
    plot.field.values.assign(12, value);
    expect_sound(to_svg(plot));
    plot.field.values[5] = 3;
    expect_sound(to_svg(plot));
    plot.field.values[6] = kNan;
    expect_sound(to_svg(plot));
  }
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
  plot.markers = {{8.3, 78.3, "78.3 bar at 8.3 deg", 0}};
  const std::string svg = to_svg(plot);
  EXPECT_EQ(svg, to_svg(plot));
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  const std::string elsewhere = to_svg(plot);
  std::locale::global(before);
  EXPECT_EQ(svg, elsewhere);
}

}  // namespace
}  // namespace crankloop::report::report_test
