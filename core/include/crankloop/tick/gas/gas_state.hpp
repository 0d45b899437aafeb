// What the gas of an engine remembers from step to step.
#pragma once

#include <cstdint>

#include <crankloop/tables/gas_tables.hpp>
#include <crankloop/tick/gas/gas_properties.hpp>

namespace crankloop::detail {

/// What a step of a cylinder, or of several abreast, starts from and leaves: twelve numbers.
template <class T>
struct CylinderGasNow {
  GasContents<T> contents;
  GasPoint<T> point;
  T volume_m3;
  T wall_heat_W;  ///< at the begin of the last step
};

/// One cylinder, at the end of the last step. Sixteen numbers: no padding.
template <class Real>
struct CylinderGas : CylinderGasNow<Real> {
  Real area_m2[kPorts];     ///< effective, of each port
  Real pressure_before_Pa;  ///< at the end of the tick before
  Real spare;
};

/// A manifold.
template <class Real>
struct ManifoldGas {
  GasContents<Real> contents;
  GasPoint<Real> point;
};

/// A cylinder's fuel and burn.
template <class Real>
struct CylinderBurn {
  Real fuel_kg;      ///< of this cycle that burns; 0: nothing, or all has
  Real burnt_ratio;  ///< of it
  Real start_deg, duration_deg;
  Real per_deg;  ///< 1 / the whole burn's duration
  Real excess_air_ratio;
  Real asked_kg;  ///< fuel: last good
  Real spare_number;
  std::uint32_t taken;  ///< 1: this cycle has its fuel
  std::uint32_t spare;
};

/// A cycle's fuel and burn, as asked for.
template <class Real>
struct BurnOrder {
  Real fuel_kg, start_deg, duration_deg;
};

/// What is given of a manifold: last good.
template <class Real>
struct GivenGas {
  Real pressure_Pa, temperature_K;
};

}  // namespace crankloop::detail
