// What the gas of an engine remembers from step to step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include <crankloop/tables/gas_tables.hpp>
#include <crankloop/tick/gas/gas_properties.hpp>

namespace crankloop::detail {

/// What a step of a cylinder, or of several abreast, starts from and leaves.
template <class T>
struct CylinderGas {
  GasContents<T> contents;
  GasPoint<T> point;
  T volume_m3;
  T wall_heat_W;      ///< at the begin of the last step
  T area_m2[kPorts];  ///< effective, of each port
};

// Row k of a column, or as many from there as T has lanes. By its index: by its address, GCC keeps a pointer into each
// column on the stack from load to store.
struct TakeRow {
  std::uint32_t k;
  template <class Real, std::size_t kRows, class T>
  [[gnu::always_inline]] void operator()(const Real (&column)[kRows], T& x) const noexcept {
    if constexpr (kLanesIn<T> == 1) {
      x = column[k];
    } else {
      std::memcpy(&x, column + k, sizeof x);
    }
  }
};
struct PutRow {
  std::uint32_t k;
  template <class Real, std::size_t kRows, class T>
  [[gnu::always_inline]] void operator()(Real (&column)[kRows], const T& x) const noexcept {
    if constexpr (kLanesIn<T> == 1) {
      column[k] = x;
    } else {
      std::memcpy(column + k, &x, sizeof x);
    }
  }
};

/// The cylinders of an engine, in columns: neighbours go abreast.
template <class Real, std::uint32_t kCylinders>
struct CylinderGases {
  Real mass_kg[kCylinders], mass_rest_kg[kCylinders];
  Real energy_J[kCylinders], energy_rest_J[kCylinders];
  Real burned_kg[kCylinders], burned_rest_kg[kCylinders];
  Real pressure_Pa[kCylinders], temperature_K[kCylinders], burned_ratio[kCylinders], gas_ratio[kCylinders];
  Real volume_m3[kCylinders], wall_heat_W[kCylinders];
  Real area_m2[kPorts][kCylinders];
  Real pressure_before_Pa[kCylinders];  ///< at the end of the tick before
  Real spare[kCylinders];

  /// Cylinder k, or as many from there as T has lanes.
  template <class T>
  [[nodiscard, gnu::always_inline]] CylinderGas<T> at(std::uint32_t k) const noexcept {
    CylinderGas<T> gas;
    each(*this, gas, TakeRow{k}), each_area(*this, gas, TakeRow{k});
    return gas;
  }
  template <class T>
  [[gnu::always_inline]] void put(std::uint32_t k, const CylinderGas<T>& gas) noexcept {
    each(*this, gas, PutRow{k});
  }

  void put(std::uint32_t k, const GasContents<Real>& contents, const GasPoint<Real>& point) noexcept {
    each_of_gas(*this, contents, point, PutRow{k});
  }

  /// Not among what a step always leaves: most ports are closed.
  template <class T>
  [[gnu::always_inline]] void put_areas(std::uint32_t k, const CylinderGas<T>& gas) noexcept {
    each_area(*this, gas, PutRow{k});
  }
  void copy(std::uint32_t from, std::uint32_t to) noexcept {
    put(to, at<Real>(from)), put_areas(to, at<Real>(from));
    pressure_before_Pa[to] = pressure_before_Pa[from], spare[to] = spare[from];
  }

 private:
  template <class Columns, class Gas, class Visit>
  [[gnu::always_inline]] static void each(Columns& column, Gas& gas, const Visit& visit) noexcept {
    each_of_gas(column, gas.contents, gas.point, visit);
    visit(column.volume_m3, gas.volume_m3), visit(column.wall_heat_W, gas.wall_heat_W);
  }
  template <class Columns, class Contents, class Point, class Visit>
  [[gnu::always_inline]] static void each_of_gas(Columns& column, Contents& contents, Point& point,
                                                 const Visit& visit) noexcept {
    visit(column.mass_kg, contents.mass_kg), visit(column.mass_rest_kg, contents.mass_rest_kg);
    visit(column.energy_J, contents.energy_J), visit(column.energy_rest_J, contents.energy_rest_J);
    visit(column.burned_kg, contents.burned_kg), visit(column.burned_rest_kg, contents.burned_rest_kg);
    visit(column.pressure_Pa, point.pressure_Pa), visit(column.temperature_K, point.temperature_K);
    visit(column.burned_ratio, point.burned_ratio), visit(column.gas_ratio, point.gas_ratio);
  }
  template <class Columns, class Gas, class Visit>
  [[gnu::always_inline]] static void each_area(Columns& column, Gas& gas, const Visit& visit) noexcept {
    visit(column.area_m2[kIntake], gas.area_m2[kIntake]), visit(column.area_m2[kExhaust], gas.area_m2[kExhaust]);
  }
};

/// What a cylinder's crevices hold, at the walls' temperature.
template <class T>
struct CreviceGas {
  T mass_kg, burned_kg;
};

/// The crevices of an engine's cylinders, in columns.
template <class Real, std::uint32_t kCylinders>
struct CreviceGases {
  Real mass_kg[kCylinders], burned_kg[kCylinders];

  template <class T>
  [[nodiscard, gnu::always_inline]] CreviceGas<T> at(std::uint32_t k) const noexcept {
    CreviceGas<T> gas;
    each(*this, gas, TakeRow{k});
    return gas;
  }
  template <class T>
  [[gnu::always_inline]] void put(std::uint32_t k, const CreviceGas<T>& gas) noexcept {
    each(*this, gas, PutRow{k});
  }

 private:
  template <class Columns, class Gas, class Visit>
  [[gnu::always_inline]] static void each(Columns& column, Gas& gas, const Visit& visit) noexcept {
    visit(column.mass_kg, gas.mass_kg), visit(column.burned_kg, gas.burned_kg);
  }
};

/// A runner: the flow through it and the gas of its port.
template <class Real>
struct RunnerGas {
  GasContents<Real> contents;
  GasPoint<Real> point;
  Real flow_kg_s, flow_rest_kg_s;  ///< toward the cylinder
};

/// Runners of as many cylinders as T has lanes, from the first on.
template <class T>
[[nodiscard, gnu::always_inline]] inline decltype(auto) take_runners(const RunnerGas<NumberOf<T>>* first) noexcept {
  if constexpr (kLanesIn<T> == 1) {
    return (*first);
  } else {
    constexpr std::size_t kNumbers = sizeof(RunnerGas<float>) / sizeof(float);
    static_assert(kNumbers % 4 == 0 && sizeof(RunnerGas<T>) == kNumbers * sizeof(T), "numbers alone, four by four");
    T column[kNumbers];
    for (std::size_t n = 0; n < kNumbers; n += 4) {
      T row[4];
      for (std::size_t i = 0; i < 4; ++i) row[i] = load<T>(reinterpret_cast<const float*>(first + i) + n);
      transpose(row);
      for (std::size_t i = 0; i < 4; ++i) column[n + i] = row[i];
    }
    RunnerGas<T> runners;
    std::memcpy(&runners, column, sizeof runners);
    return runners;
  }
}
template <class T>
[[gnu::always_inline]] inline void put_runners(RunnerGas<NumberOf<T>>* first, const RunnerGas<T>& runners) noexcept {
  if constexpr (kLanesIn<T> == 1) {
    *first = runners;
  } else {
    constexpr std::size_t kNumbers = sizeof(RunnerGas<float>) / sizeof(float);
    T column[kNumbers];
    std::memcpy(column, &runners, sizeof runners);
    for (std::size_t n = 0; n < kNumbers; n += 4) {
      T row[4] = {column[n], column[n + 1], column[n + 2], column[n + 3]};
      transpose(row);
      for (std::size_t i = 0; i < 4; ++i) store<T>(reinterpret_cast<float*>(first + i) + n, row[i]);
    }
  }
}

/// A manifold.
template <class Real>
struct ManifoldGas {
  GasContents<Real> contents;
  GasPoint<Real> point;
};

/// What last flowed out of the exhaust: what flows back. Air, before anything has.
template <class Real>
struct OutletGas {
  Real temperature_K, burned_ratio;
};

/// A cylinder's fuel and burn.
template <class Real>
struct CylinderBurn {
  Real fuel_kg;      ///< of this cycle that burns; 0: nothing, or all has
  Real burnt_ratio;  ///< of it
  Real start_deg, duration_deg;
  Real per_deg;  ///< 1 / the whole burn's duration
  Real excess_air_ratio;
  Real asked_kg;                ///< fuel: last good
  Real asked_excess_air_ratio;  ///< the same; above 0, it says how much fuel
  std::uint32_t taken;          ///< 1: this cycle has its fuel
  std::uint32_t spare;
};

/// Where a burn must have ended, and rounding.
template <class Real>
inline constexpr Real kLatestBurnEnd_deg = static_cast<Real>(150.001);

template <class Real>
inline constexpr Real kLeastBurn_ratio = static_cast<Real>(0.5);  ///< duration of a burn by charge over the one ordered
template <class Real>
inline constexpr Real kMaxBurn_ratio = static_cast<Real>(3);

/// A burn that follows the charge: CylinderBurn::start_deg is then where it starts, after the spark.
template <class Real>
struct BurnStart {
  Real spark_deg;     ///< last good
  Real ratio;         ///< duration of the last burn over the one ordered
  std::uint32_t due;  ///< 1: this cycle's burn has not begun
  std::uint32_t spare;
};

/// How far a cycle's unburned gas has come to knock.
template <class Real>
struct KnockRecord {
  Real integral_ratio;
  Real passes_deg;    ///< where it passed 1; 0: it has not
  Real unburned_K;    ///< temperature of the unburned gas
  Real pressure_Pa;   ///< of the cylinder, at the end of the last step
  Real burned_ratio;  ///< of the unburned gas: residual
  Real burnt_ratio;   ///< of the fuel, at the end of the last step
};

/// A cycle's fuel and burn, as asked for.
template <class Real>
struct BurnOrder {
  Real fuel_kg, excess_air_ratio;  ///< above 0, this says how much fuel
  Real start_deg, duration_deg;
};

/// What is given of a manifold: last good.
template <class Real>
struct GivenGas {
  Real pressure_Pa, temperature_K;
};

}  // namespace crankloop::detail
