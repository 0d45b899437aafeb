// An indicator diagram made from polytropes and a Wiebe heat release.
#include <crankloop/assert.hpp>
#include <crankloop/phase.hpp>
#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>
#include <crankloop/tabulate/mechanism.hpp>

#include "quadrature.hpp"

namespace crankloop {
namespace {

constexpr double kWiebeEfficiency = 6.908;  // a_w: 1 - exp(-6.908) = 99.9 % burnt at the end
constexpr double kBlowDown = 5;             // e-foldings of the blow-down from exhaust opening to bottom dead centre

/// Wiebe's burnt fraction at s = (a - a0)/da in [0, 1], and its derivative by s.
[[nodiscard]] double burn_rate(double s, double m) noexcept {
  if (s <= 0) return m > 0 ? 0 : kWiebeEfficiency;
  const double s_m = elementary::pow(s, m);
  return kWiebeEfficiency * (m + 1) * s_m * elementary::exp(-kWiebeEfficiency * s_m * s);
}

/// Relative pressure in the blow-down: 1 at exhaust opening, 0 at bottom dead centre.
[[nodiscard]] double blow_down(double from_opening_ratio) noexcept {
  const double rest = elementary::exp(-kBlowDown);
  return (elementary::exp(-kBlowDown * from_opening_ratio) - rest) / (1 - rest);
}

}  // namespace

Status IndicatorDiagram::init_wiebe() noexcept {
  const WiebeDiagram& w = pressure_.wiebe;
  if (w.exhaust_valve_opens_deg >= bdc_deg_)
    return refuse("pressure.wiebe.exhaust_valve_opens_deg", Reason::inconsistent);
  // dp = ((n2 - 1)/V) dQ - n2 p dV/V has the solution p V^n2 = const + (n2 - 1) * integral of V^(n2 - 1) dQ.
  burnt_[0] = 0;
  for (int i = 0; i < kBurnPanels; ++i) {
    burnt_[i + 1] =
        burnt_[i] + burn_panel(static_cast<double>(i) / kBurnPanels, static_cast<double>(i + 1) / kBurnPanels);
  }
  bottom_m3_ = volume_m3(bdc_deg_);
  polytropes_ = unfired(w.start_of_combustion_deg, w.expansion_exponent, w.exhaust_Pa);
  motored_ = unfired(tdc_deg_, w.motored_exponent(), w.exhaust_Pa < w.intake_Pa ? w.intake_Pa : w.exhaust_Pa);
  if (w.heat_given) {
    heat_J_ = w.heat_J;
    fired_ = heat_J_ > 0 ? 1 : 0;
    return {};
  }
  // The loop integral is linear in the heat: two integrals give the heat for the mean effective pressure.
  const auto loop_J = [this](const auto& pressure_Pa) {
    return detail::integrate(
        0, 720, 7200, [&](double deg) { return pressure_Pa(deg) * area_m2_ * slope_m(deg) * detail::kRadPerDegree; });
  };
  const double asked_J = w.net_mep_Pa * swept_volume_m3(crank_);
  const double polytropes_J = loop_J([this](double deg) { return unfired_Pa(polytropes_, deg); });
  heat_J_ = 1;
  heat_J_ = (asked_J - polytropes_J) / loop_J([this](double deg) { return released_Pa(deg); });
  fired_ = 1;
  if (heat_J_ >= 0) return {};
  // The polytropes alone give more: the requested value lies between them and the motored diagram.
  const double motored_J = loop_J([this](double deg) { return unfired_Pa(motored_, deg); });
  heat_J_ = 0;
  fired_ = (asked_J - motored_J) / (polytropes_J - motored_J);
  if (!(fired_ >= 0 && fired_ <= 1)) return refuse("pressure.wiebe.net_mep_Pa", Reason::no_solution);
  return {};
}

IndicatorDiagram::Unfired IndicatorDiagram::unfired(double from_deg, double exponent,
                                                    double exhaust_Pa) const noexcept {
  const WiebeDiagram& w = pressure_.wiebe;
  Unfired u{from_deg, volume_m3(from_deg), 0, exponent, exhaust_Pa, 0};
  u.from_Pa = w.intake_Pa * elementary::pow(bottom_m3_ / u.from_m3, w.compression_exponent);
  u.opens_Pa = u.expanded_Pa(volume_m3(w.exhaust_valve_opens_deg - 1e-9));
  return u;
}

double IndicatorDiagram::Unfired::expanded_Pa(double volume_m3) const noexcept {
  return from_Pa * elementary::pow(from_m3 / volume_m3, exponent);
}

/// Integral of V^(n2 - 1) dx_b from the start of combustion. Panels are equal in the cube root u of the fraction s of
/// the duration: s^m ds is smooth in u for any m.
double IndicatorDiagram::burn_integral(double since_start_deg) const noexcept {
  const double part = since_start_deg / pressure_.wiebe.combustion_duration_deg;
  if (part <= 0) return 0;
  if (part >= 1) return burnt_[kBurnPanels];
  const double u = elementary::pow(part, 1.0 / 3);
  const int panel = static_cast<int>(u * kBurnPanels);
  CRANKLOOP_ASSERT(panel >= 0 && panel <= kBurnPanels);  // if the root rounds to 1, the last panel has no width
  return burnt_[panel] + burn_panel(static_cast<double>(panel) / kBurnPanels, u);
}

double IndicatorDiagram::burn_panel(double from_u, double to_u) const noexcept {
  const WiebeDiagram& w = pressure_.wiebe;
  return detail::gauss5(from_u, to_u, [&](double u) {
    const double s = u * u * u;
    const double volume = volume_m3(w.start_of_combustion_deg + s * w.combustion_duration_deg);
    return 3 * u * u * burn_rate(s, w.wiebe_m) * elementary::pow(volume, w.expansion_exponent - 1);
  });
}

double IndicatorDiagram::unfired_Pa(const Unfired& unfired, double crank_deg) const noexcept {
  const WiebeDiagram& w = pressure_.wiebe;
  const double since_top = from_top_deg(crank_deg);
  const double deg = since_top + tdc_deg_;  // tdc to tdc + 720
  const double closed_deg =
      deg >= bdc_deg_ + 360 ? deg - 720 : deg;  // compression and expansion without a break at 720
  const double opens_deg = w.exhaust_valve_opens_deg;
  if (closed_deg < opens_deg) {
    const double volume = volume_m3(closed_deg);
    if (closed_deg > unfired.from_deg) return unfired.expanded_Pa(volume);
    return w.intake_Pa * elementary::pow(bottom_m3_ / volume, w.compression_exponent);
  }
  if (deg < bdc_deg_) {
    return unfired.exhaust_Pa +
           (unfired.opens_Pa - unfired.exhaust_Pa) * blow_down((deg - opens_deg) / (bdc_deg_ - opens_deg));
  }
  if (since_top < 360) return unfired.exhaust_Pa;
  const double ramp = (since_top - 360) / kGasExchangeRampDeg;
  return ramp < 1 ? unfired.exhaust_Pa + ramp * (w.intake_Pa - unfired.exhaust_Pa) : w.intake_Pa;
}

double IndicatorDiagram::released_Pa(double crank_deg) const noexcept {
  const WiebeDiagram& w = pressure_.wiebe;
  const double deg = from_top_deg(crank_deg) + tdc_deg_;
  const double closed_deg = deg >= bdc_deg_ + 360 ? deg - 720 : deg;
  if (closed_deg <= w.start_of_combustion_deg || closed_deg >= bdc_deg_) return 0;
  const double opens_deg = w.exhaust_valve_opens_deg;
  const double at_deg = closed_deg < opens_deg ? closed_deg : opens_deg;
  const double burnt = burn_integral(at_deg - w.start_of_combustion_deg);
  const double p =
      heat_J_ * (w.expansion_exponent - 1) * burnt * elementary::pow(volume_m3(at_deg), -w.expansion_exponent);
  return closed_deg < opens_deg ? p : p * blow_down((closed_deg - opens_deg) / (bdc_deg_ - opens_deg));
}

double IndicatorDiagram::wiebe_full_Pa(double crank_deg) const noexcept {
  if (fired_ < 1) {
    const double motored = unfired_Pa(motored_, crank_deg);
    return motored + fired_ * (unfired_Pa(polytropes_, crank_deg) - motored);
  }
  return unfired_Pa(polytropes_, crank_deg) + released_Pa(crank_deg);
}

}  // namespace crankloop
