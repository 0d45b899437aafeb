// What the report of a run shows beside its curves, worked out by hand for the 495: heat release, valve timing, loads
// over the speed, the engine file's remarks.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/drawing_geometry.hpp"
#include "support/markup.hpp"
#include "support/run_command.hpp"
#include "support/units.hpp"

namespace crankloop::program::report_figures_test {
namespace {

class ReportOfThe495 : public RunCommand {
 protected:
  ReportOfThe495() { summary_ = run({kSample, "--cycles", "1", "--report", path("report.html")}); }

  /// The description of a drawing: "... NAME: from LOW to HIGH UNIT."
  std::string description(const std::string& title) const {
    const auto titles = page().all("title");
    const auto descriptions = page().all("desc");
    for (std::size_t i = 0; i < descriptions.size(); ++i) {
      if (titles[i + 1].text == title) return descriptions[i].text;  // the first is the page's
    }
    ADD_FAILURE() << "no drawing " << title;
    return "";
  }
  support::Markup page() const { return support::read(contents(path("report.html"))); }

  std::string summary_;
};

/// The Wiebe heat comes back from pressure and volume: the table of what follows has it.
TEST_F(ReportOfThe495, FindsTheHeatThatItsDiagramWasMadeOf) {
  const std::string page = contents(path("report.html"));
  const std::string row = "Heat per cycle and cylinder at full load</th><td class=\"number\">";
  const std::size_t at = page.find(row);
  ASSERT_NE(at, std::string::npos);
  std::string digits;
  for (const char c : page.substr(at + row.size(), 20)) {
    if (c == '<') break;
    if ((c >= '0' && c <= '9') || c == '.') digits += c;
  }
  const double heat_J = std::stod(digits);
  EXPECT_GT(heat_J, 1000);  // 660 J of work at an efficiency of about a half
  std::string released = description("Heat released");
  released = released.substr(released.rfind(" to ") + 4);
  EXPECT_NEAR(std::stod(released), heat_J, 0.01 * heat_J) << released;
}

/// 1 mm of valve lift is (1 + 0.3 mm of clearance) / 1.5 of the follower's, which the polynomial has at u of its half
/// angle of 78 cam degrees, twice as many of the crank, from full lift at 466 and 266 deg (exhaust: 80 cam degrees).
TEST_F(ReportOfThe495, TimesItsValvesAtAMillimetre) {
  const auto half_width_deg = [](double half_angle_deg) {
    double low = 0, high = 1;
    for (int i = 0; i < 50; ++i) {
      const double u = (low + high) / 2;
      const double y = 7.2 * (1 - 2.1875 * std::pow(u, 2) + 2.1875 * std::pow(u, 6) - 1.3125 * std::pow(u, 10) +
                              0.3125 * std::pow(u, 14));
      (y > 1.3 / 1.5 ? low : high) = u;
    }
    return 2 * half_angle_deg * low;
  };
  std::string caption;
  for (const support::Element& one : page().all("figcaption")) {
    if (one.text.find("intake opens") != std::string::npos) caption = one.text;
  }
  const auto told_deg = [&](const std::string& before) {
    const std::size_t at = caption.find(before);
    EXPECT_NE(at, std::string::npos) << caption;
    return at == std::string::npos ? -1 : std::stod(caption.substr(at + before.size()));
  };
  constexpr double kTold = 0.5;                                                                // whole degrees
  EXPECT_NEAR(told_deg("intake opens "), 360 - (466 - half_width_deg(78)), kTold) << caption;  // before TDC
  EXPECT_NEAR(told_deg("closes "), 466 + half_width_deg(78) - 540, kTold);                     // after BDC
  EXPECT_NEAR(told_deg("exhaust opens "), 180 - (266 - half_width_deg(80)), kTold);            // before BDC
}

/// (P_s0 + k_s h) / (-M h'') of the intake's polynomial, ratio 1.5, by its second derivative: 320 N, 25 N/mm, 480 g and
/// a third of 90 g. The run is at 2000 rpm.
TEST_F(ReportOfThe495, HasTheSpringMarginOfItsTrains) {
  constexpr double kHalfAngle_rad = 78 * support::kRadPerDeg;
  double static_rpm = 1e9;
  double place_deg = 0;
  for (double u = 0; u < 1; u += 1e-4) {
    const double lift_m = 1.5 * 7.2e-3 *
                              (1 - 2.1875 * std::pow(u, 2) + 2.1875 * std::pow(u, 6) - 1.3125 * std::pow(u, 10) +
                               0.3125 * std::pow(u, 14)) -
                          0.3e-3;
    const double curvature_m = 1.5 * 7.2e-3 / (kHalfAngle_rad * kHalfAngle_rad) *
                               (-4.375 + 65.625 * std::pow(u, 4) - 118.125 * std::pow(u, 8) + 56.875 * std::pow(u, 12));
    if (!(lift_m >= 0 && curvature_m < 0)) continue;
    const double rpm = 2 * std::sqrt((320 + 25e3 * lift_m) / (0.51 * -curvature_m)) * 30 / support::kPi;
    if (rpm < static_rpm) static_rpm = rpm, place_deg = 466 - 2 * 78 * u;
  }
  const std::string page = contents(path("report.html"));
  const auto shown = [&page](const std::string& row) {
    std::size_t at = page.find(">" + row + "<");
    EXPECT_NE(at, std::string::npos) << row;
    if (at == std::string::npos) return -1.0;
    at = page.find("class=\"number\">", at);
    return std::stod(page.substr(at + 15, 20));
  };
  EXPECT_NEAR(shown("Static redline"), static_rpm, 0.5);
  EXPECT_NEAR(shown("Least spring margin, rigid parts"), std::pow(static_rpm / 2000, 2), 0.005);
  EXPECT_NEAR(shown("its place, crank angle"), place_deg, 0.1);
}

/// One diagram at every speed has one mean torque: 809.7 kPa on 3.2605 L over 4 pi. The masses' share has no mean.
TEST_F(ReportOfThe495, HasOneMeanTorqueAtEverySpeed) {
  const std::string torque = description("Torque of the engine");
  EXPECT_NE(torque.find("mean: from 210 to 210 Nm"), std::string::npos) << torque;

  // At 2400 rpm the rod is pulled most at the top dead centre of gas exchange: m_j r w^2 (1 + lambda) of 1.315 kg and
  // 57.5 mm, and an intake of 2 kPa below the crankcase on 70.9 cm^2.
  const double w = 2400 * support::kPi / 30;
  const double pulled_kN = (1.315 * 0.0575 * w * w * 1.2738 + 2e3 * 70.88e-4) / 1e3;
  std::string loads = description("Largest loads");
  loads = loads.substr(loads.find("rod, pulled"));
  EXPECT_NEAR(std::stod(loads.substr(loads.find(" to ") + 4)), pulled_kN, 0.005 * pulled_kN) << loads;
}

TEST_F(ReportOfThe495, PutsNoLabelAcrossACurveOrAnAxis) {
  EXPECT_EQ(support::labels_in_the_way(page()), std::vector<std::string>{});
}

TEST_F(ReportOfThe495, GivesSharesAsPerCent) {
  const std::string page = contents(path("report.html"));
  EXPECT_NE(page.find("mechanical efficiency 80.0 %"), std::string::npos);
}

TEST_F(ReportOfThe495, GivesADrivenEngineNoEfficiency) {
  run({kSample, "--cycles", "1", "--load-ratio", "0", "--report", path("driven.html")});
  const std::string page = contents(path("driven.html"));
  EXPECT_NE(page.find(" Nm, the engine is driven"), std::string::npos);
  EXPECT_EQ(page.find(" Nm, mechanical efficiency"), std::string::npos);
}

TEST_F(ReportOfThe495, PutsRemarksUnderTheSectionThatFollowsThem) {
  const std::string page = contents(path("report.html"));
  EXPECT_NE(page.find("[friction]: What turns and brakes the crankshaft besides the gas"), std::string::npos);
  EXPECT_NE(page.find("[cam intake]: Valve trains: nothing of them is in the sheet."), std::string::npos);
  EXPECT_NE(page.find("[pressure]: The sheet&#39;s indicator diagram is not printed."), std::string::npos);
  EXPECT_NE(page.find("From the engine file: The 495 diesel: four-cylinder"), std::string::npos);
  for (const char* folded : {"<summary>[crank]</summary>", "<summary>[valve exhaust]</summary>"})
    EXPECT_NE(page.find(folded), std::string::npos) << folded;
}

/// The motion of rigid parts is 1.5 times the derivatives of the polynomial over its half angle of 78 deg, at 1000 rpm
/// of the cam, where the lift is above the clearance.
TEST_F(ReportOfThe495, ShowsTheTheoreticalMotionOfItsValves) {
  constexpr double kHalf_rad = 78 * support::kRadPerDeg;
  constexpr double kCam_rad_s = 1000 * support::kPi / 30;
  const double c[] = {-2.1875, 2.1875, -1.3125, 0.3125};
  const int p[] = {2, 6, 10, 14};
  double fastest = 0, hardest = 0, slowest = 0, jerk = 0;
  for (double u = 0; u < 1; u += 1e-5) {
    double y[4] = {1, 0, 0, 0};  // and its derivatives by u
    for (int i = 0; i < 4; ++i) {
      double factor = c[i];
      for (int order = 0; order < 4; factor *= p[i] - order, ++order) {
        if (p[i] >= order) y[order] += factor * std::pow(u, p[i] - order);
      }
    }
    if (1.5 * 7.2 * y[0] <= 0.3) break;
    const double lift_m = 1.5 * 7.2e-3;
    const double per_s = kCam_rad_s / kHalf_rad;
    fastest = std::max(fastest, std::abs(lift_m * y[1] * per_s));
    hardest = std::max(hardest, lift_m * y[2] * per_s * per_s);
    slowest = std::min(slowest, lift_m * y[2] * per_s * per_s);
    jerk = std::max(jerk, std::abs(lift_m * y[3] * per_s * per_s * per_s));
  }
  const auto span = [this](const std::string& title, const std::string& name) {
    std::string text = description(title);
    const std::size_t at = text.find(name + ": from ");
    EXPECT_NE(at, std::string::npos) << text;
    if (at == std::string::npos) return std::pair(0.0, 0.0);
    text = text.substr(at + name.size() + 7);
    for (std::size_t minus; (minus = text.find("\u2212")) != std::string::npos;) text.replace(minus, 3, "-");
    return std::pair(std::stod(text), std::stod(text.substr(text.find(" to ") + 4)));
  };
  constexpr double kThreeDigits = 0.005;
  EXPECT_NEAR(span("Valve velocity", "theory").second, fastest, kThreeDigits * fastest);
  EXPECT_NEAR(span("Valve velocity", "theory").first, -fastest, kThreeDigits * fastest);
  EXPECT_NEAR(span("Valve acceleration", "theory").second * 1e3, hardest, kThreeDigits * hardest);
  EXPECT_NEAR(span("Valve acceleration", "theory").first * 1e3, slowest, kThreeDigits * hardest);
  EXPECT_NEAR(span("Jerk of the theoretical lift", "intake").second * 1e6, jerk, 0.02 * jerk);  // steep
  EXPECT_NEAR(span("Jerk of the theoretical lift", "intake").first * 1e6, -jerk, 0.02 * jerk);
}

/// As wide as it is high.
TEST_F(ReportOfThe495, DrawsTheTimingAsACircle) {
  report::Box widest{1e9, 1e9, -1e9, -1e9};
  const std::string html = contents(path("report.html"));
  const std::size_t from = html.find("<h3>Valve timing</h3>");
  ASSERT_NE(from, std::string::npos);
  const support::Markup figure = support::read("<figure>" + html.substr(from, html.find("</figure>", from) + 9 - from));
  for (const support::Element& curve : figure.of_class("c6")) {  // the crank's circle
    for (const report::Polyline& line : support::lines_of(curve.attributes.at("d"))) {
      for (const report::Point& point : line) {
        widest = {std::min(widest.left, point.x), std::min(widest.top, point.y), std::max(widest.right, point.x),
                  std::max(widest.bottom, point.y)};
      }
    }
  }
  EXPECT_NEAR(widest.right - widest.left, widest.bottom - widest.top, 0.3);
  EXPECT_GT(widest.right - widest.left, 100);
}

TEST_F(ReportOfThe495, SaysOnStandardOutputTooThatItsPressureIsNotMeasured) {
  EXPECT_NE(summary_.find("\n# cylinder pressure: synthesised, not measured\n"), std::string::npos) << summary_;
  EXPECT_LT(contents(path("report.html")).size(), 600'000u);
}

}  // namespace
}  // namespace crankloop::program::report_figures_test
