// What is shown of the gas of cylinders.
#pragma once

#include <cstddef>
#include <cstring>

#include <crankloop/output.hpp>
#include <crankloop/tick/lanes.hpp>

namespace crankloop::detail {

template <class Real>
[[gnu::always_inline]] inline void show(const Real (&x)[7], CylinderGasOutput<Real>* shown) noexcept {
  *shown = {x[0], x[1], x[2], x[3], {x[4], x[5]}, x[6]};
}

#if CRANKLOOP_ABREAST
static_assert(offsetof(CylinderGasOutput<float>, flow_kg_s) == 4 * sizeof(float) &&
              offsetof(CylinderGasOutput<float>, wall_heat_W) == 6 * sizeof(float));
[[gnu::always_inline]] inline void show(const Four (&x)[7], CylinderGasOutput<float>* shown) noexcept {
  Four first[4] = {x[0], x[1], x[2], x[3]}, second[4] = {x[4], x[5], x[6], x[6]};
  transpose(first), transpose(second);
#pragma GCC unroll 4
  for (int i = 0; i < 4; ++i) {
    auto* const to = reinterpret_cast<unsigned char*>(shown + i);
    std::memcpy(to, &first[i], 4 * sizeof(float));
    std::memcpy(to + 4 * sizeof(float), &second[i], 3 * sizeof(float));
  }
}
#endif

}  // namespace crankloop::detail
