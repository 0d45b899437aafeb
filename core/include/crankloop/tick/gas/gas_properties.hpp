// Air and burned gas: energy, temperature, pressure. docs/model.md "Gas".
//
// What belongs here: what holds of a gas at rest in a volume. What does not: how it flows (orifice.hpp) and what a step
// makes of it. T is a number, or lanes of several cylinders.
//
//     cv(T, x) = a(x) + b T,  a = 646 + 93 x,  b = 0.205,  R = 287.1 J/(kg K);   x: mass fraction of burned gas, 0 =
//     air e = a T + b T^2 / 2     specific internal energy, 0 at 0 K;     enthalpy h = e + R T;     p = m R T / V
//
// A straight line for cv, fitted to the GRI/NASA polynomials (air to 1.3 K over 270 to 1100 K, products of CH1.85 to 18
// K over 300 to 2600 K), so that temperature follows from energy by one root, exactly, and the first law is kept to
// rounding.
#pragma once

#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/lanes.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop::detail {

template <class Real>
inline constexpr Real kGasConstant = static_cast<Real>(287.1);  ///< R of air and of burned gas, J/(kg K)
template <class Real>
inline constexpr Real kPerGasConstant = static_cast<Real>(1 / 287.1);
template <class Real>
inline constexpr Real kHeatSlope = static_cast<Real>(0.205);  ///< b

/// Temperatures that a gas may have: beyond, it is put back.
inline constexpr double kLeastGas_K = 100;
inline constexpr double kMaxGas_K = 6000;

/// a(x)
template <class T>
[[nodiscard]] constexpr T heat_at_0_K(T burned_ratio) noexcept {
  using Real = NumberOf<T>;
  return Real{646} + Real{93} * burned_ratio;
}

/// e
template <class T>
[[nodiscard]] constexpr T energy_J_kg(T temperature_K, T burned_ratio) noexcept {
  return temperature_K * (heat_at_0_K(burned_ratio) + kHeatSlope<NumberOf<T>> / 2 * temperature_K);
}

/// A carried sum: what rounding leaves out of one addition is added with the next (as CrankState::reduced_rest).
template <class T>
constexpr void add_carried(T& sum, T& rest, const T& change) noexcept {
  const T with_rest = change + rest;
  const T next = sum + with_rest;
  rest = with_rest - (next - sum);
  sum = next;
}

/// What is in a cylinder or a manifold: sums, each with what rounding left out of it.
template <class Real>
struct GasContents {
  Real mass_kg, mass_rest_kg;
  Real energy_J, energy_rest_J;  ///< internal
  Real burned_kg, burned_rest_kg;

  constexpr void add(Real mass, Real energy, Real burned) noexcept {
    add_carried(mass_kg, mass_rest_kg, mass);
    add_carried(energy_J, energy_rest_J, energy);
    add_carried(burned_kg, burned_rest_kg, burned);
  }
};

/// What follows from contents and volume.
template <class Real>
struct GasPoint {
  Real pressure_Pa;  ///< absolute
  Real temperature_K;
  Real burned_ratio;  ///< x
  Real gas_ratio;     ///< G = R / cv; the ratio of specific heats is 1 + G
};

/// Gas at a temperature and pressure.
template <class Real>
[[nodiscard]] constexpr GasContents<Real> contents_of(Real pressure_Pa, Real temperature_K, Real burned_ratio,
                                                      Real volume_m3) noexcept {
  const Real mass_kg = pressure_Pa * volume_m3 / (kGasConstant<Real> * temperature_K);
  return {mass_kg, Real{0}, mass_kg * energy_J_kg(temperature_K, burned_ratio), Real{0}, mass_kg * burned_ratio,
          Real{0}};
}

/// T of a mean enthalpy h = a T + b T^2 / 2 + R T.
template <class Real>
[[nodiscard]] inline Real temperature_of_enthalpy_K(Real enthalpy_J_kg, Real burned_ratio) noexcept {
  const Real a = heat_at_0_K(burned_ratio) + kGasConstant<Real>;
  const Real square = a * a + 2 * kHeatSlope<Real> * enthalpy_J_kg;
  return 2 * enthalpy_J_kg / (a + square_root(square > 0 ? square : Real{0}));
}

template <class T>
[[nodiscard]] constexpr T pressure_of(T mass_kg, T temperature_K, T per_volume_m3) noexcept {
  return mass_kg * kGasConstant<NumberOf<T>> * temperature_K * per_volume_m3;
}

/// T = 2 e / (a + sqrt(a^2 + 2 b e)); the root is cv.
template <class T>
[[nodiscard, gnu::always_inline]] inline GasPoint<T> point_of(const GasContents<T>& gas,
                                                              const T& per_volume_m3) noexcept {
  using Real = NumberOf<T>;
  const T per_mass = Real{1} / gas.mass_kg;
  const T twice_e = Real{2} * gas.energy_J * per_mass;
  const T x = gas.burned_kg * per_mass;
  const T a = heat_at_0_K(x);
  const T cv = square_root(a * a + kHeatSlope<Real> * twice_e);
  const T sum = a + cv;
  const T per_both = Real{1} / (sum * cv);
  const T temperature_K = twice_e * cv * per_both;
  return {pressure_of(gas.mass_kg, temperature_K, per_volume_m3), temperature_K, x,
          kGasConstant<Real> * sum * per_both};
}

/// Whether gas is within what any engine holds: not too little, not too cold, not too hot.
template <class T>
[[nodiscard, gnu::always_inline]] inline auto is_well(const GasPoint<T>& point, const T& mass_kg,
                                                      const T& least_kg) noexcept {
  using Real = NumberOf<T>;
  constexpr Real kLeast_K = static_cast<Real>(kLeastGas_K);
  constexpr Real kMax_K = static_cast<Real>(kMaxGas_K);
  if constexpr (kLanesIn<T> == 1) {
    return mass_kg >= least_kg && within_positive(point.burned_ratio, Real{1}) &&
           within_positive(point.temperature_K - kLeast_K, kMax_K - kLeast_K);
  } else {
    return (mass_kg >= least_kg) & (point.burned_ratio >= Real{0}) & (point.burned_ratio <= Real{1}) &
           (point.temperature_K >= kLeast_K) & (point.temperature_K <= kMax_K);
  }
}

/// Puts contents that are not well back there, and their point; answers false where they were off by rounding alone.
template <class Real>
[[nodiscard, gnu::always_inline]] inline bool put_right(GasContents<Real>& gas, GasPoint<Real>& point,
                                                        Real per_volume_m3, Real least_kg) noexcept {
  constexpr Real kLeast_K = static_cast<Real>(kLeastGas_K);
  constexpr Real kMax_K = static_cast<Real>(kMaxGas_K);
  const auto held = [](Real x, Real least, Real most) {
    return x >= least ? (x <= most ? x : most) : least;
  };  // what is not a number: least
  const Real kelvin = held(point.temperature_K, kLeast_K, kMax_K);
  const Real ratio = held(point.burned_ratio, Real{0}, Real{1});
  constexpr Real kMax_kg = static_cast<Real>(1e6);
  const Real mass_kg = held(gas.mass_kg, least_kg, kMax_kg);
  // A ratio off by rounding alone is no fault: gas that is all burned, or all air, flows in and out.
  constexpr Real kRounding = static_cast<Real>(1e-5);
  const bool off = !(gas.mass_kg >= least_kg && point.burned_ratio >= -kRounding &&
                     point.burned_ratio <= 1 + kRounding && kelvin == point.temperature_K);
  if (off) {
    gas = {mass_kg, Real{0}, mass_kg * energy_J_kg(kelvin, ratio), Real{0}, mass_kg * ratio, Real{0}};
  } else {
    gas.burned_kg = ratio > Real{0} ? gas.mass_kg : Real{0};
    gas.burned_rest_kg = Real{0};
  }
  point = point_of(gas, per_volume_m3);
  return off;
}

}  // namespace crankloop::detail
