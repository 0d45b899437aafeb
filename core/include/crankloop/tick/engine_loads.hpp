// What the whole engine's parts add up to: loads of crank pins and journals, free forces and moments. docs/model.md "Forces", "Balance".
//
// What belongs here: sums over cylinders that no other output needs. What does not: the forces of a cylinder (cylinder_forces.hpp).
#pragma once

#include <crankloop/tick/angle.hpp>
#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/io.hpp>
#include <crankloop/tick/one_instruction.hpp>
#include <crankloop/tick/tables.hpp>

namespace crankloop::detail {

template <class Real>
[[nodiscard]] Real length(Real x, Real y) noexcept { return square_root(x * x + y * y); }

template <class Real>
[[nodiscard]] FreeForce<Real> turned_by(const Turning<Real>& t, Real cosine, Real sine) noexcept {
  return {t.up_cos * cosine + t.up_sin * sine, t.lateral_cos * cosine + t.lateral_sin * sine,
          t.pitch_cos * cosine + t.pitch_sin * sine, t.yaw_cos * cosine + t.yaw_sin * sine};
}

/// From the forces of all cylinders, in the frame that turns with the crankshaft.
template <class Real, class S>
void load_bearings([[maybe_unused]] const Tables<Real, S>& tables, [[maybe_unused]] const State<Real, S>& state, [[maybe_unused]] Output<Real, S>& out) noexcept {
  if constexpr (S::bearing_loads) {
    const Bearings<Real>& b = *tables.bearings;
    const Real w2 = state.speed_rad_s * state.speed_rad_s;
    for (std::uint32_t i = 0; i < b.pins; ++i) out.pin_radial_N[i] = out.pin_tangential_N[i] = Real{0};
    for (std::uint32_t k = 0; k < count<S>(tables.drive->cylinders); ++k) {
      out.pin_radial_N[b.pin_of[k]] += out.cylinder[k].radial_force_N;
      out.pin_tangential_N[b.pin_of[k]] += out.cylinder[k].tangential_force_N;
    }
    for (std::uint32_t j = 0; j <= b.pins; ++j) out.journal_along_N[j] = out.journal_across_N[j] = Real{0};
    for (std::uint32_t i = 0; i < b.pins; ++i) {
      const Real throw_outward = b.throw_kg_m[i] * w2 - out.pin_radial_N[i];
      Real tangential = out.pin_tangential_N[i];
      out.pin_radial_N[i] -= b.rods_kg_m[i] * w2;
      if constexpr (Needs<S>::crank_dynamics) {  // what turns with the pin is accelerated by it
        tangential -= b.throw_kg_m[i] * out.acceleration_rad_s2;
        out.pin_tangential_N[i] -= b.rods_kg_m[i] * out.acceleration_rad_s2;
      }
      out.pin_load_N[i] = length(out.pin_radial_N[i], out.pin_tangential_N[i]);
      // Each throw is simply supported between its two journals: half to either, turned from the throw's frame into that of pin 0.
      const Real half_along = (throw_outward * b.throw_cos[i] - tangential * b.throw_sin[i]) / 2;
      const Real half_across = (throw_outward * b.throw_sin[i] + tangential * b.throw_cos[i]) / 2;
      out.journal_along_N[i] += half_along;
      out.journal_across_N[i] += half_across;
      out.journal_along_N[i + 1] += half_along;
      out.journal_across_N[i + 1] += half_across;
    }
    for (std::uint32_t j = 0; j <= b.pins; ++j) out.journal_load_N[j] = length(out.journal_along_N[j], out.journal_across_N[j]);
  }
}

/// Of the speed and the angle alone.
template <class Real, class S>
void balance_engine([[maybe_unused]] const Tables<Real, S>& tables, [[maybe_unused]] const State<Real, S>& state, [[maybe_unused]] Output<Real, S>& out) noexcept {
  if constexpr (S::free_forces) {
    const Balance<Real>& b = *tables.balance;
    const Real w2 = state.speed_rad_s * state.speed_rad_s;
    const Angle<Real> a = angle_of<Real>(state.phase.units(), 0);
    const std::uint32_t degree = a.turn_degree();
    const std::uint32_t quarter_back = degree >= 90 ? degree - 90 : degree + 270;
    const Real cosine = value(b.cosine.at[degree], a.u);
    const Real sine = value(b.cosine.at[quarter_back], a.u);
    out.first = turned_by(b.first, cosine * w2, sine * w2);
    out.rotating = turned_by(b.rotating, cosine * w2, sine * w2);
    out.second = turned_by(b.second, (2 * cosine * cosine - 1) * w2, 2 * sine * cosine * w2);
  }
}

}  // namespace crankloop::detail
