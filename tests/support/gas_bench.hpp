// One cylinder of the gas by itself, for tests of its step: a volume, ports to given gas, heat or none.
#pragma once

#include <crankloop/tick/gas/cylinder_gas.hpp>

#include "support/gas_equations.hpp"

namespace crankloop::support {

template <class Real>
struct GasBench {
  double fuel_J_kg = 0, fuel_burned_kg_kg = 0;  ///< what a kilogram of fuel brings
  detail::GasWalls<Real> walls{};               // adiabatic
  detail::CylinderGas<Real> gas{};
  detail::GasBeyond<Real> beyond[2]{};
  detail::PortStep<Real> through[2]{};  ///< each port in the last step

  GasBench(double pressure_Pa, double temperature_K, double burned_ratio, double volume_m3) {
    gas.contents = detail::contents_of<Real>(static_cast<Real>(pressure_Pa), static_cast<Real>(temperature_K),
                                             static_cast<Real>(burned_ratio), static_cast<Real>(volume_m3));
    gas.volume_m3 = static_cast<Real>(volume_m3);
    gas.point = detail::point_of(gas.contents, 1 / gas.volume_m3);
    given(0, 1e5, 300, 0);
    given(1, 1e5, 300, 1);
  }
  /// Gas of a pressure that nothing changes behind a port.
  void given(int port, double pressure_Pa, double temperature_K, double burned_ratio) {
    const detail::GasPoint<Real> point{static_cast<Real>(pressure_Pa), static_cast<Real>(temperature_K),
                                       static_cast<Real>(burned_ratio), Real{}};
    beyond[port] = detail::beyond(point, Real{0});
  }
  /// A manifold of a volume behind a port, whose own pressure the step reckons with. `took_kg` is what the cylinder
  /// took of it in the step before.
  void manifold(int port, const GasSeen& seen, double volume_m3, double took_kg) {
    given(port, seen.p, seen.t, seen.x);
    const double g = kGasR / (gas_a(seen.x) + kGasB * seen.t);
    const double response_Pa_kg = (1 + g) * kGasR * seen.t / volume_m3;
    beyond[port].response_Pa_kg = static_cast<Real>(response_Pa_kg);
    beyond[port].as_was_Pa = static_cast<Real>(-response_Pa_kg * took_kg);
  }
  detail::CylinderStep<Real> step(double step_s, double volume_m3, double intake_m2 = 0, double exhaust_m2 = 0,
                                  double fuel_kg = 0) {
    const auto real = [](double x) { return static_cast<Real>(x); };
    const detail::GasDrive<Real> drive{real(step_s), real(1.4), detail::most_area_per_m3(real(step_s)), real(1e-12)};
    const Real to_m2[] = {real(intake_m2), real(exhaust_m2)};
    const detail::GasFuel<Real> fuel{real(fuel_kg), real(fuel_J_kg * fuel_kg), real(fuel_burned_kg_kg * fuel_kg)};
    return detail::step_gas<Real>(gas, real(volume_m3), fuel, walls, drive, to_m2, beyond, through);
  }
  [[nodiscard]] double pressure_Pa() const { return static_cast<double>(gas.point.pressure_Pa); }
  [[nodiscard]] double temperature_K() const { return static_cast<double>(gas.point.temperature_K); }
};

}  // namespace crankloop::support
