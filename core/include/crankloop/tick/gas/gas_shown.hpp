// What an engine shows of the gas in its cylinders.
//
// What belongs here: after a step, over the steps of a tick, where cylinders were filled anew. What does not: what a
// cycle shows (gas_cycle.hpp), manifolds (engine_manifolds.hpp), runners (engine_runners.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/gas/gas_start.hpp>
#include <crankloop/tick/lanes.hpp>

namespace crankloop::detail {

/// The numbers of CylinderGasOutput in their order.
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

/// Cylinders that fill_cylinders() filled: nothing flows.
template <class Real, class S>
void show_filled(const Tables<Real, S>& tables, const State<Real, S>& state, Output<Real, S>& out) noexcept {
  const auto& gases = state.cylinder_gas;
  for (std::uint32_t k = 0; k < count<S>(tables.drive->cylinders); ++k) {
    const Real shown[7] = {gases.pressure_Pa[k], gases.temperature_K[k], gases.mass_kg[k], gases.burned_ratio[k]};
    show(shown, &out.cylinder_gas[k]);
    if constexpr (S::walls) out.wall_K[k] = state.wall_K[k];
    if constexpr (S::crevice) out.crevice[k].mass_kg = state.crevice_gas.mass_kg[k];
    if constexpr (S::runners) {
      for (int port = 0; port < kPorts; ++port) {
        out.runner[k].port_pressure_Pa[port] = manifold_of(state, port).pressure_Pa;
        out.runner[k].flow_kg_s[port] = Real{0};
      }
    }
  }
}

/// What a tick of several steps shows of flow and heat: means over the tick, each step's a part of it.
template <class Real, std::uint32_t kCylinders>
struct ShownOfSteps {
  Real flow_kg_s[kCylinders][kPorts], wall_heat_W[kCylinders];

  void add(const CylinderGasOutput<Real> (&last)[kCylinders], std::uint32_t cylinders) noexcept {
    for (std::uint32_t k = 0; k < cylinders; ++k) {
      for (int port = 0; port < kPorts; ++port) flow_kg_s[k][port] += last[k].flow_kg_s[port];
      wall_heat_W[k] += last[k].wall_heat_W;
    }
  }
  void show(CylinderGasOutput<Real> (&out)[kCylinders], std::uint32_t cylinders) const noexcept {
    for (std::uint32_t k = 0; k < cylinders; ++k) {
      for (int port = 0; port < kPorts; ++port) out[k].flow_kg_s[port] = flow_kg_s[k][port];
      out[k].wall_heat_W = wall_heat_W[k];
    }
  }
};

}  // namespace crankloop::detail
