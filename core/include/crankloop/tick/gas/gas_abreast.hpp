// Four cylinders in one register.
//
// What belongs here: getting them there and back. What does not: lanes themselves (lanes.hpp), a step
// (cylinder_gas.hpp).
#pragma once

#include <cstddef>
#include <cstring>

#include <crankloop/output.hpp>
#include <crankloop/tick/gas/gas_state.hpp>
#include <crankloop/tick/lanes.hpp>

namespace crankloop::detail {

[[nodiscard]] inline bool all_hold(bool holds) noexcept { return holds; }

/// What is shown of a cylinder's end of a step.
template <class Real>
inline void show(const CylinderGasNow<Real>& gas, CylinderGasOutput<Real>* shown) noexcept {
  shown->pressure_Pa = gas.point.pressure_Pa;
  shown->temperature_K = gas.point.temperature_K;
  shown->mass_kg = gas.contents.mass_kg;
  shown->burned_ratio = gas.point.burned_ratio;
}

#if CRANKLOOP_ABREAST
[[nodiscard, gnu::always_inline]] inline bool all_hold(const FourBits& holds) noexcept { return failing(holds) == 0; }

/// Four numbers of a record that has nothing but such, and back: by bytes, as no pointer to one member leads to the
/// next.
template <class Record>
[[nodiscard, gnu::always_inline]] inline Four numbers_of(const Record& record, int row) noexcept {
  Four x;
  std::memcpy(&x, reinterpret_cast<const unsigned char*>(&record) + row * static_cast<int>(sizeof x), sizeof x);
  return x;
}
template <class Record>
[[gnu::always_inline]] inline void put_numbers(const Four& x, int row, Record& record) noexcept {
  std::memcpy(reinterpret_cast<unsigned char*>(&record) + row * static_cast<int>(sizeof x), &x, sizeof x);
}

/// Number k of a lane's record is number k of the record of lanes.
inline constexpr int kNumbersOfGas = 12;
static_assert(sizeof(CylinderGasNow<float>) == kNumbersOfGas * sizeof(float));
static_assert(sizeof(CylinderGasNow<Four>) == kNumbersOfGas * sizeof(Four));

[[gnu::always_inline]] inline void load_abreast(const CylinderGas<float>* from, CylinderGasNow<Four>& now) noexcept {
  Four numbers[kNumbersOfGas];
  for (int row = 0; row < kNumbersOfGas / 4; ++row) {
    Four x[4];
    for (int i = 0; i < 4; ++i) x[i] = numbers_of<CylinderGasNow<float>>(from[i], row);
    transpose(x);
    for (int i = 0; i < 4; ++i) numbers[4 * row + i] = x[i];
  }
  std::memcpy(static_cast<void*>(&now), numbers, sizeof now);
}
[[gnu::always_inline]] inline void store_abreast(const CylinderGasNow<Four>& now, CylinderGas<float>* to) noexcept {
  Four numbers[kNumbersOfGas];
  std::memcpy(numbers, &now, sizeof now);
  for (int row = 0; row < kNumbersOfGas / 4; ++row) {
    Four x[4];
    for (int i = 0; i < 4; ++i) x[i] = numbers[4 * row + i];
    transpose(x);
    for (int i = 0; i < 4; ++i) put_numbers<CylinderGasNow<float>>(x[i], row, to[i]);
  }
}

// show() writes the first four numbers of what is shown, in their order.
static_assert(offsetof(CylinderGasOutput<float>, pressure_Pa) == 0 &&
              offsetof(CylinderGasOutput<float>, burned_ratio) == 3 * sizeof(float));
[[gnu::always_inline]] inline void show(const CylinderGasNow<Four>& now, CylinderGasOutput<float>* shown) noexcept {
  Four x[4] = {now.point.pressure_Pa, now.point.temperature_K, now.contents.mass_kg, now.point.burned_ratio};
  transpose(x);
  for (int i = 0; i < 4; ++i) put_numbers(x[i], 0, shown[i]);
}
#endif

}  // namespace crankloop::detail
