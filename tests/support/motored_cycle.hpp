// What a cylinder without combustion does to the crank, from nothing but volumes: the second way to the motored
// diagram.
//
// What belongs here: pressures and work of the motored cycle by the words of docs/model.md "Load ratio". What does not:
// anything of the library's diagrams.
#pragma once

#include <cmath>

#include <crankloop/define/engine_definition.hpp>

#include "support/diagrams.hpp"

namespace crankloop::support {

/// Loop integral of p dV over 720 deg by the middle of each step. Pressures as function of the cylinder's own crank
/// angle.
template <class Function>
double loop_work_J(const Crank& crank, const Function& pressure_Pa, int steps = 72'000) {
  Wide work_J = 0;
  for (int i = 0; i < steps; ++i) {
    const double from_deg = 720.0 * i / steps;
    const double to_deg = 720.0 * (i + 1) / steps;
    work_J += wide(pressure_Pa((from_deg + to_deg) / 2)) * wide(volume_m3(crank, to_deg) - volume_m3(crank, from_deg));
  }
  return static_cast<double>(work_J);
}

/// Without pin offset, dead centres at 0, 180, 360, 540 deg: compressed by one exponent, expanded by another until the
/// exhaust valve opens, five e-foldings to the exhaust's pressure, gas exchange.
inline double motored_cycle_Pa(const Crank& crank, const WiebeDiagram& w, double expansion_exponent, double own_deg) {
  const double deg = own_deg - 720 * std::floor(own_deg / 720);
  const double bottom_m3 = volume_m3(crank, 180);
  const double top_m3 = volume_m3(crank, 0);
  const double top_Pa = w.intake_Pa * std::pow(bottom_m3 / top_m3, w.compression_exponent);
  const auto expanded_Pa = [&](double at_deg) {
    return top_Pa * std::pow(top_m3 / volume_m3(crank, at_deg), expansion_exponent);
  };
  const double opens_deg = w.exhaust_valve_opens_deg;
  if (deg < opens_deg) return expanded_Pa(deg);
  if (deg < 180) {
    const double course =
        (std::exp(-5 * (deg - opens_deg) / (180 - opens_deg)) - std::exp(-5.0)) / (1 - std::exp(-5.0));
    return w.exhaust_Pa + (expanded_Pa(opens_deg) - w.exhaust_Pa) * course;
  }
  if (deg < 360) return w.exhaust_Pa;
  if (deg < 361) return w.exhaust_Pa + (deg - 360) * (w.intake_Pa - w.exhaust_Pa);
  if (deg < 540) return w.intake_Pa;
  return w.intake_Pa * std::pow(bottom_m3 / volume_m3(crank, deg), w.compression_exponent);
}

}  // namespace crankloop::support
