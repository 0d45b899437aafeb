// The report's pages and colours: legible, well formed, and of nothing but themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "crankloop/report/page.hpp"
#include "crankloop/report/read_out.hpp"
#include "support/files.hpp"
#include "support/markup.hpp"
#include "support/report_plots.hpp"

namespace crankloop::report::report_page_test {
namespace {

using support::Element;
using support::Markup;
using support::read;

// ---- Colours ----

using Rgb = std::array<double, 3>;

/// Of "#440154": sRGB to linear light, IEC 61966-2-1.
Rgb linear(const std::string& colour) {
  Rgb rgb{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = static_cast<double>(std::strtol(colour.substr(1 + 2 * i, 2).c_str(), nullptr, 16)) / 255;
    rgb[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return rgb;
}

/// The colour variables of one theme.
std::map<std::string, Rgb> colours(bool dark) {
  const std::string style{plot_style()};
  const std::size_t media = style.find("prefers-color-scheme: dark");
  std::map<std::string, Rgb> found;
  std::size_t at = dark ? media : 0;
  const std::size_t end = dark ? style.find("\n}", media) : media;
  while ((at = style.find("--", at)) < end) {
    const std::size_t colon = style.find(':', at);
    found[style.substr(at + 2, colon - at - 2)] = linear(style.substr(colon + 2, 7));
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

TEST(ReportColours, AShadeOfTheRampIsStrongerThanTheOneBefore) {
  for (const bool dark : {false, true}) {
    const auto theme = colours(dark);
    double before = 3;  // the faintest, by WCAG 2, 1.4.11
    for (int i = 1; i <= kRamp; ++i) {
      const double here = contrast(theme.at("ramp-" + std::to_string(i)), theme.at("paper"));
      EXPECT_GT(here, before) << (dark ? "dark " : "light ") << i;
      before = 1.12 * here;
    }
  }
}

/// In print without colour too: no two shades of the ramp have the same dashes.
TEST(ReportColours, AShadeOfTheRampHasDashesOfItsOwn) {
  const std::string style{plot_style()};
  std::set<std::string> dashes;
  for (int i = 1; i <= kRamp; ++i) {
    const std::string rule = ".plot .curve.r" + std::to_string(i) + " { stroke-dasharray: ";
    const std::size_t at = style.find(rule);
    dashes.insert(at == std::string::npos ? "none"
                                          : style.substr(at + rule.size(), style.find('}', at) - at - rule.size()));
  }
  EXPECT_EQ(dashes.size(), static_cast<std::size_t>(kRamp));
}

/// One palette for both themes: more is lighter, step by step.
TEST(ReportColours, AHeatMapGetsLighterWithItsValue) {
  double before = -1;
  for (int i = 0; i <= 40; ++i) {
    const Rgb here = linear(heat_colour(i / 40.0));
    const double luminance = 0.2126 * here[0] + 0.7152 * here[1] + 0.0722 * here[2];
    EXPECT_GT(luminance, before) << i;
    before = luminance;
  }
  EXPECT_EQ(heat_colour(-1), heat_colour(0));
  EXPECT_EQ(heat_colour(2), heat_colour(1));
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

TEST(ReportPage, IsWellFormedAndNeedsNoNetwork) {
  const std::string html = to_html(sample_page());
  EXPECT_EQ(read(html).fault, "");
  EXPECT_EQ(html.rfind("<!DOCTYPE html>", 0), 0u);
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

/// What holds in print alone.
std::string print_style(const std::string& html) {
  const std::size_t at = html.find("@media print {");
  return html.substr(at, html.find("\n}\n", at) - at);
}

/// The tables of a run over the crank angle fill dozens of pages: those that the reader has opened are printed.
TEST(ReportPage, PrintsOnlyTheTablesThatAreOpen) {
  const std::string html = to_html(sample_page());
  EXPECT_EQ(html.find("<details open"), std::string::npos);
  EXPECT_EQ(html.find("details-content"), std::string::npos);
  EXPECT_NE(print_style(html).find(".table:has(> details:not([open])) { display: none; }"), std::string::npos);
}

/// Key figures in N columns: where one would be left over, the first is two wide.
TEST(ReportPage, LeavesNoTileAloneInTheLastRow) {
  const std::string html = to_html(sample_page());
  const std::string columns = ".facts { grid-template-columns: repeat(";
  std::set<int> widths;
  for (std::size_t at = html.find(columns); at != std::string::npos; at = html.find(columns, at + 1)) {
    const int n = std::atoi(html.c_str() + at + columns.size());
    const std::string rule =
        ".facts > :first-child:nth-last-child(" + std::to_string(n) + "n + 1) { grid-column: span 2; }";
    EXPECT_LT(html.find(rule, at), html.find("@media", at)) << n;
    widths.insert(n);
  }
  EXPECT_EQ(widths, (std::set<int>{2, 4, 6}));
}

TEST(ReportPage, PutsATableBesideTheLastPlot) {
  Page page = sample_page();
  const Table narrow = std::get<Table>(page.sections[0].blocks[3]);
  page.sections[1].blocks = {plot_of({pressure_trace()}), narrow};
  const std::string html = to_html(page);
  const std::size_t row = html.find("<div class=\"row\">", html.find("id=\"forces\""));
  EXPECT_LT(row, html.find("<figure"));
  EXPECT_EQ(html.find("<div class=\"row\">", row + 1), std::string::npos);
  EXPECT_LT(html.find("<div class=\"table\">", row), html.find("</section>", row));
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
  EXPECT_EQ(html.find("<script"), html.rfind("<script"));  // the page's own
  EXPECT_EQ(read(html).all("script").at(0).text, read_out_script());
}

TEST(ReportPage, AnEmptyPageIsAPage) { EXPECT_EQ(read(to_html({})).fault, ""); }

TEST(ReportPage, SamePageGivesTheSameBytes) { EXPECT_EQ(to_html(sample_page()), to_html(sample_page())); }

// ---- The script ----

/// Base64 of the bytes that a hexadecimal number is.
std::string base64(const std::string& hex) {
  static const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < hex.size(); i += 6) {  // three bytes, four digits
    const std::string three = (hex + "0000").substr(i, 6);
    const long bits = std::strtol(three.c_str(), nullptr, 16);
    for (int shift = 18; shift >= 0; shift -= 6) text += kDigits[bits >> shift & 63];
  }
  const std::size_t surplus = (6 - hex.size() % 6) % 6 / 2;
  return text.replace(text.size() - surplus, surplus, surplus, '=');
}

TEST(ReportScript, IsTheOnlyOneThatThePolicyAllows) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "script.js", std::ios::binary) << read_out_script();
  ASSERT_EQ(std::system(("sha256sum '" + folder / "script.js" + "' >'" + folder / "sum" + "'").c_str()), 0);
  std::string hex;
  std::ifstream(folder / "sum") >> hex;
  ASSERT_EQ(hex.size(), 64u);
  EXPECT_EQ(base64(hex), kReadOutHash) << "after a change of read_out.cpp this is kReadOutHash of read_out.hpp";
  const std::string html = to_html(sample_page());
  EXPECT_NE(html.find("script-src 'sha256-" + base64(hex) + "'\""), std::string::npos);
}

TEST(ReportScript, IsShortAndPlainXml) {
  const std::string script{read_out_script()};
  EXPECT_LE(std::count(script.begin(), script.end(), '\n'), 130);
  EXPECT_EQ(script.find_first_of("<&"), std::string::npos);
}

/// What it reads of a drawing: the scales in user units, and each curve with its name and its legend.
TEST(ReportScript, FindsScalesAndCurvesInTheDrawing) {
  Series a{"gas", {0, 10}, {1, 3}, {}};
  Series b{"masses", {0, 10}, {2, 2}, {}};
  Plot plot = plot_of({a, b});
  plot.x = axis_of("Angle", "deg");
  plot.y = axis_of("Force", "kN");
  const Markup svg = read(to_svg(plot));
  const Element drawing = svg.all("svg").at(0);
  EXPECT_EQ(drawing.attributes.at("data-unit-x"), "deg");
  EXPECT_EQ(drawing.attributes.at("data-unit-y"), "kN");
  std::vector<std::string> names;
  for (const Element& group : svg.all("g")) {
    if (group.attributes.count("data-zero") != 0) names.push_back(group.attributes.at("data-name"));
  }
  EXPECT_EQ(names, (std::vector<std::string>{"gas", "masses"}));
  EXPECT_EQ(svg.of_class("key").size(), 2u);

  // The first curve ends at (10, 3): read back through the scales.
  const auto scale = [&](const char* name) {
    std::istringstream stream(drawing.attributes.at(name));
    std::array<double, 4> n{};
    for (double& one : n) stream >> one;
    return n;
  };
  const auto value = [](const std::array<double, 4>& n, double at) {
    return n[0] + (at - n[2]) / (n[3] - n[2]) * (n[1] - n[0]);
  };
  const std::string d = svg.of_class("curve").at(0).attributes.at("d");
  std::istringstream end(d.substr(d.rfind('L') + 1));
  double x = 0, y = 0;
  end >> x >> y;
  EXPECT_NEAR(value(scale("data-x"), x), 10, 0.02);
  EXPECT_NEAR(value(scale("data-y"), y), 3, 0.01);
}

}  // namespace
}  // namespace crankloop::report::report_page_test
