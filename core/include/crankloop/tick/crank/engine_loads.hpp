// What the whole engine's parts add up to: loads of crank pins and journals, free forces and moments. docs/model.md
// "Forces", "Balance".
//
// What belongs here: sums over cylinders that no other output needs. What does not: the forces of a cylinder
// (cylinder_forces.hpp).
#pragma once

#include <crankloop/assert.hpp>
#include <crankloop/output.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tables/angle.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/checked.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop::detail {

template <class Real>
[[nodiscard]] Real length(Real x, Real y) noexcept {
  return square_root(x * x + y * y);
}

template <class Real>
[[nodiscard]] FreeForce<Real> turned_by(const RotatingVector<Real>& t, Real cosine, Real sine) noexcept {
  return {t.up_cos * cosine + t.up_sin * sine, t.lateral_cos * cosine + t.lateral_sin * sine,
          t.pitch_cos * cosine + t.pitch_sin * sine, t.yaw_cos * cosine + t.yaw_sin * sine};
}

template <class Real, class S>
void load_journal(Output<Real, S>& out, std::uint32_t j, Real along_N, Real across_N) noexcept {
  out.journal_along_N[j] = along_N;
  out.journal_across_N[j] = across_N;
  out.journal_load_N[j] = length(along_N, across_N);
}

/// From the forces of all cylinders, in the frame that turns with the crankshaft.
template <class Real, class S>
void load_bearings(const Tables<Real, S>& tables, const State<Real, S>& state, Output<Real, S>& out) noexcept {
  const Bearings<Real>& b = *tables.bearings;
  const Real w2 = state.speed_rad_s * state.speed_rad_s;
  // Each throw is simply supported between its two journals: half to either, turned from the throw's frame into that
  // of pin 0.
  Real along_before{};
  Real across_before{};
  const auto load_pin = [&](std::uint32_t i, Real radial, Real tangential) __attribute__((always_inline)) {
    const Real throw_outward = b.throw_kg_m[i] * w2 - radial;
    Real throw_tangential = tangential;
    radial -= b.rods_kg_m[i] * w2;
    if constexpr (Needs<S>::crank_dynamics) {  // what turns with the pin is accelerated by it
      throw_tangential -= b.throw_kg_m[i] * out.acceleration_rad_s2;
      tangential -= b.rods_kg_m[i] * out.acceleration_rad_s2;
    }
    out.pin_radial_N[i] = radial;
    out.pin_tangential_N[i] = tangential;
    out.pin_load_N[i] = length(radial, tangential);
    const Real half_along = (throw_outward * b.throw_cos[i] - throw_tangential * b.throw_sin[i]) / 2;
    const Real half_across = (throw_outward * b.throw_sin[i] + throw_tangential * b.throw_cos[i]) / 2;
    load_journal(out, i, along_before + half_along, across_before + half_across);
    along_before = half_along;
    across_before = half_across;
  };
  const std::uint8_t* k = b.by_pin.cylinder;
  if (b.pins == tables.drive->cylinders) {  // each has one rod: without the loop over a pin's rods
    for (std::uint32_t i = 0; i < b.pins; ++i) {
      const CylinderForces<Real>& rod = out.cylinder[k[i]];
      load_pin(i, rod.radial_force_N, rod.tangential_force_N);
    }
  } else {
    for (std::uint32_t i = 0; i < b.pins; ++i) {
      const std::uint8_t* const end = b.by_pin.cylinder + b.by_pin.end[i];
      CRANKLOOP_ASSERT(k != end);  // every pin has a rod
      Real radial = out.cylinder[*k].radial_force_N;
      Real tangential = out.cylinder[*k].tangential_force_N;
      while (++k != end) {
        radial += out.cylinder[*k].radial_force_N;
        tangential += out.cylinder[*k].tangential_force_N;
      }
      load_pin(i, radial, tangential);
    }
  }
  load_journal(out, b.pins, along_before, across_before);
}

/// Of the speed and the crank's angle alone, degree `degree` and fraction `u` of its turn.
template <class Real, class S>
void balance_engine(const Tables<Real, S>& tables, const State<Real, S>& state, Output<Real, S>& out,
                    std::uint32_t degree, Real u) noexcept {
  const Balance<Real>& b = *tables.balance;
  const Real w2 = state.speed_rad_s * state.speed_rad_s;
  const std::uint32_t quarter_back = degree >= 90 ? degree - 90 : degree + 270;
  const Real cosine = value(b.cosine.at[degree], u);
  const Real sine = value(b.cosine.at[quarter_back], u);
  out.first = turned_by(b.first, cosine * w2, sine * w2);
  out.rotating = turned_by(b.rotating, cosine * w2, sine * w2);
  out.second = turned_by(b.second, (2 * cosine * cosine - 1) * w2, 2 * sine * cosine * w2);
}

}  // namespace crankloop::detail
