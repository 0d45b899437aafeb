// The equations of docs/model.md "Gas", with pow() and libm: shares no code with the library. The one place that
// changes where the model does.
//
// What belongs here: laws of the gas, an orifice, walls, a burn. What does not: engines of them (gas_reference.hpp).
#pragma once

#include <cmath>

#include <crankloop/define/engine_definition.hpp>

#include "support/units.hpp"

namespace crankloop::support {

// ---- the gas --------------------------------------------------------------------------------------------------------

inline constexpr double kGasR = 287.1;  ///< J/(kg K), of air and of burned gas
inline constexpr double kGasB = 0.205;  ///< by how much cv rises per K

/// cv at 0 K.
[[nodiscard]] inline double gas_a(double burned_ratio) { return 646 + 93 * burned_ratio; }
[[nodiscard]] inline double gas_energy(double temperature_K, double burned_ratio) {
  return gas_a(burned_ratio) * temperature_K + kGasB / 2 * temperature_K * temperature_K;
}
[[nodiscard]] inline double gas_enthalpy(double temperature_K, double burned_ratio) {
  return gas_energy(temperature_K, burned_ratio) + kGasR * temperature_K;
}
/// Of a T + b T^2 / 2 = e.
[[nodiscard]] inline double gas_root(double a, double energy_J_kg) {
  return 2 * energy_J_kg / (a + std::sqrt(a * a + 2 * kGasB * energy_J_kg));
}
[[nodiscard]] inline double gas_temperature(double energy_J_kg, double burned_ratio) {
  return gas_root(gas_a(burned_ratio), energy_J_kg);
}
[[nodiscard]] inline double gas_temperature_of_enthalpy(double enthalpy_J_kg, double burned_ratio) {
  return gas_root(gas_a(burned_ratio) + kGasR, enthalpy_J_kg);
}

/// What a volume holds: mass, internal energy, burned mass.
struct GasVolume {
  double m, u, b;
};
[[nodiscard]] inline GasVolume gas_filled(double pressure_Pa, double temperature_K, double burned_ratio,
                                          double volume_m3) {
  const double m = pressure_Pa * volume_m3 / (kGasR * temperature_K);
  return {m, m * gas_energy(temperature_K, burned_ratio), m * burned_ratio};
}

/// A gas as others see it.
struct GasSeen {
  double p, t, x;
};
[[nodiscard]] inline GasSeen gas_seen(const GasVolume& gas, double volume_m3) {
  const double x = gas.b / gas.m, t = gas_temperature(gas.u / gas.m, x);
  return {gas.m * kGasR * t / volume_m3, t, x};
}

// ---- orifices -------------------------------------------------------------------------------------------------------

inline constexpr double kFlowG = 1.36;                                                 ///< ratio of specific heats
inline const double kChokedRatio = std::pow(2 / (kFlowG + 1), kFlowG / (kFlowG - 1));  ///< of pressures
inline const double kChokedPsi = std::sqrt(kFlowG) * std::pow(2 / (kFlowG + 1), (kFlowG + 1) / (2 * (kFlowG - 1)));

/// Saint-Venant and Wantzel: flow per area, kg/(s m2).
[[nodiscard]] inline double saint_venant(double up_Pa, double down_Pa, double up_K) {
  const double g = kFlowG, ratio = std::fmax(down_Pa / up_Pa, kChokedRatio);
  return up_Pa / std::sqrt(kGasR * up_K) *
         std::sqrt(2 * g / (g - 1) * (std::pow(ratio, 2 / g) - std::pow(ratio, (g + 1) / g)));
}
/// The ellipse of ISO 6358 through its choked flow.
[[nodiscard]] inline double ellipse(double up_Pa, double down_Pa, double up_K) {
  const double s = std::fmin(1, (up_Pa - down_Pa) / ((1 - kChokedRatio) * up_Pa));
  return up_Pa / std::sqrt(kGasR * up_K) * kChokedPsi * std::sqrt(s * (2 - s));
}

enum class OrificeLaw { ellipse, saint_venant };

/// From 1 to 2, kg/s; adds what it moves.
inline double gas_flow(OrificeLaw law, double area_m2, const GasSeen& one, const GasSeen& two, GasVolume& from,
                       GasVolume& to) {
  if (area_m2 == 0 || one.p == two.p) return 0;
  const bool forward = one.p > two.p;
  const GasSeen& up = forward ? one : two;
  const double down_Pa = forward ? two.p : one.p;
  const double per_m2 = law == OrificeLaw::ellipse ? ellipse(up.p, down_Pa, up.t) : saint_venant(up.p, down_Pa, up.t);
  const double w = (forward ? 1 : -1) * area_m2 * per_m2, h = gas_enthalpy(up.t, up.x);
  from.m -= w, from.u -= w * h, from.b -= w * up.x;
  to.m += w, to.u += w * h, to.b += w * up.x;
  return w;
}

// ---- walls and fuel -------------------------------------------------------------------------------------------------

/// Hohenberg's heat from a cylinder's gas to its walls, by the volume as it is.
class WallHeat {
 public:
  WallHeat(const EngineDefinition& engine, double speed_rad_s)
      : bore_m_{engine.crank.bore_m},
        area_m2_{kPi / 4 * bore_m_ * bore_m_},
        wall_K_{engine.gas.wall_K},
        factor_{130e-4 * engine.gas.wall_heat_ratio *
                std::pow(2 * engine.crank.crank_radius_m * std::fabs(speed_rad_s) / kPi + 1.4, 0.8)} {}

  [[nodiscard]] double W(const GasSeen& gas, double volume_m3) const { return W(gas, volume_m3, wall_K_); }
  [[nodiscard]] double W(const GasSeen& gas, double volume_m3, double wall_K) const {
    return factor_ * std::pow(volume_m3, -0.06) * std::pow(gas.p, 0.8) * std::pow(gas.t, -0.4) *
           (2 * area_m2_ + 4 * volume_m3 / bore_m_) * (gas.t - wall_K);
  }

 private:
  double bore_m_, area_m2_, wall_K_, factor_;
};

/// What a kilogram of fuel adds to the internal energy, counted from 0 K; heating values are measured at 298.15 K.
[[nodiscard]] inline double fuel_energy_J_kg(const Gas& gas) {
  const double l = gas.air_fuel_ratio;
  return gas.combustion_efficiency * gas.heating_value_J_kg + (1 + l) * gas_energy(298.15, 1) -
         l * gas_energy(298.15, 0);
}

/// Laminar flame of gasoline and air, m/s; phi = 1 / lambda 0.7 to 1.4, burned share to 0.3. Metghalchi and Keck 1982,
/// Rhodes and Keck, SAE 850047.
[[nodiscard]] inline double flame_m_s(const GasSeen& gas, double lambda) {
  const double phi = 1 / lambda;
  return (0.305 - 0.549 * (phi - 1.21) * (phi - 1.21)) * std::pow(gas.t / 298, 2.4 - 0.271 * std::pow(phi, 3.51)) *
         std::pow(gas.p / 101325, -0.357 + 0.14 * std::pow(phi, 2.77)) * (1 - 2.06 * std::pow(gas.x, 0.77));
}

/// Ignition delay of Douaud and Eyzat, SAE 780080, s.
[[nodiscard]] inline double knock_delay_s(double octane_number, double pressure_Pa, double unburned_K) {
  return 17.68e-3 * std::pow(octane_number / 100, 3.402) * std::pow(pressure_Pa / 101325, -1.7) *
         std::exp(3800 / unburned_K);
}

/// Share of the fuel that has burned by a part s of the burn.
[[nodiscard]] inline double wiebe(double s, double m) {
  if (s <= 0) return 0;
  if (s >= 1) return 1;
  return (1 - std::exp(-6.908 * std::pow(s, m + 1))) / (1 - std::exp(-6.908));
}
[[nodiscard]] inline double wiebe_slope(double s, double m) {
  if (s <= 0 || s >= 1) return 0;
  return 6.908 * (m + 1) * std::pow(s, m) * std::exp(-6.908 * std::pow(s, m + 1)) / (1 - std::exp(-6.908));
}

}  // namespace crankloop::support
