// What flows through both ports of a cylinder in a step of valve overlap. docs/model.md "Gas".
//
// As one port (port_flow.hpp), with one pressure p1 that both flows lead to: two steps of Newton's method from where
// the larger opening alone would take it, then a mean of all pressures with the conductances w / D as weights. Those
// are positive, so p1 lies between, for any step.
#pragma once

#include <crankloop/tick/gas/port_flow.hpp>

namespace crankloop::detail {

/// Flow through one of them at a pressure p1 of the cylinder, the manifold's own answer taken from the try before.
template <class Real>
class OverlapPort {
 public:
  OverlapPort(Real area_m2, Real near_choked_per_Pa, Real near_Pa_kg, Real in_Pa_kg, const GasBeyond<Real>& far,
              Real far_Pa, Real time_s) noexcept
      : out_{area_m2 * near_choked_per_Pa},
        in_{area_m2 * far.choked_per_Pa},
        out_Pa_kg_{near_Pa_kg},
        in_Pa_kg_{in_Pa_kg},
        far_Pa_{far_Pa},
        far_time_{far.response_Pa_kg * time_s} {}

  void look(Real p1) noexcept {
    const Real apart_Pa = far_Pa_ - p1;
    const Real drop_Pa = magnitude(apart_Pa) * damping_;
    const bool in = apart_Pa > 0;
    const Real up_Pa = in ? far_Pa_ : p1;
    const Real per_Pa = in ? in_ : out_;
    const Real s = drop_Pa / up_Pa * kPerChokedDrop<Real>;
    per_kg_Pa_ = in ? in_Pa_kg_ : out_Pa_kg_;
    Real conductance, slope;
    if (s < 1) {
      const Real left = Real{2} - s;
      const Real f = s * left;
      const Real by_s = per_Pa * kPerChokedDrop<Real>;
      conductance = by_s * left / square_root(f + static_cast<Real>(1e-10));
      slope = by_s * (Real{1} - s) / square_root(f + static_cast<Real>(4.3e-4));  // no slope is without bound
    } else {
      conductance = per_Pa * up_Pa / drop_Pa;
      slope = in ? Real{0} : per_Pa;
    }
    flow_ = conductance * (in ? drop_Pa : -drop_Pa);
    damping_ = Real{1} / (Real{1} + far_time_ * conductance);
    conductance_ = conductance * damping_;
    slope_ = slope * damping_;
  }

  [[nodiscard]] Real flow_kg_s() const noexcept { return flow_; }
  [[nodiscard]] Real slope() const noexcept { return slope_; }
  [[nodiscard]] Real conductance() const noexcept { return conductance_; }
  [[nodiscard]] Real per_kg_Pa() const noexcept { return per_kg_Pa_; }
  [[nodiscard]] Real far_Pa() const noexcept { return far_Pa_; }

 private:
  Real out_, in_, out_Pa_kg_, in_Pa_kg_, far_Pa_, far_time_;
  Real damping_ = Real{1}, flow_{}, slope_{}, conductance_{}, per_kg_Pa_{};
};

/// Both ports. Kept apart: few ticks have an overlap.
template <class Real>
[[gnu::noinline]] void two_port_flow(const PortAreas<Real> (&area)[2], const GasPoint<Real>& begin, GasNear<Real> near,
                                     const Real (&in_Pa_kg)[2], const GasBeyond<Real> (&far)[2], Real step_s,
                                     PortFlow<Real> (&flow)[2]) noexcept {
  Orifice<Real> at[2];
  Real per_kg_Pa[2], stiffness{};
  bool both = true;
  for (int i = 0; i < 2; ++i) {
    at[i] = Orifice<Real>::at(begin.pressure_Pa, begin.temperature_K, far[i]);
    per_kg_Pa[i] = at[i].flow_kg_s_m2 > 0 ? in_Pa_kg[i] : near.per_kg_out_Pa;
    const Real mean_flow = (area[i].from_m2 + area[i].to_m2) / 2 * magnitude(at[i].flow_kg_s_m2);
    both = both && mean_flow > 0;
    stiffness += step_s * per_kg_Pa[i] * mean_flow * at[i].share_per_Pa;
  }
  Real theta = both ? implicit_share(stiffness) : Real{1};
  Real explicit_kg[2] = {};
  for (int i = 0; i < 2; ++i) {
    explicit_kg[i] = (Real{1} - theta) * step_s * area[i].from_m2 * at[i].flow_kg_s_m2;
    both = both && may_be_explicit(explicit_kg[i], per_kg_Pa[i], near.pressure_Pa, far[i]);
  }
  if (!both) theta = Real{1}, explicit_kg[0] = explicit_kg[1] = Real{0};
  Real far_Pa[2];
  for (int i = 0; i < 2; ++i) {
    near.pressure_Pa += explicit_kg[i] * per_kg_Pa[i];
    far_Pa[i] = far[i].pressure_Pa - explicit_kg[i] * far[i].response_Pa_kg;
  }
  const Real time_s = theta * step_s;
  const int larger = area[1].to_m2 > area[0].to_m2 ? 1 : 0;
  const Real alone = implicit_flow(area[larger].to_m2, near, in_Pa_kg[larger], far[larger], far_Pa[larger], time_s);
  const Real pc = near.pressure_Pa;
  Real p1 = pc + time_s * alone * (alone > 0 ? in_Pa_kg[larger] : near.per_kg_out_Pa);
  const Real low_far = far_Pa[0] < far_Pa[1] ? far_Pa[0] : far_Pa[1];
  const Real high_far = far_Pa[0] < far_Pa[1] ? far_Pa[1] : far_Pa[0];
  const Real low = pc < low_far ? pc : low_far;
  const Real high = pc > high_far ? pc : high_far;
  const Real near_per_Pa = choked_per_Pa(near.temperature_K);
  OverlapPort<Real> port[2] = {
      {area[0].to_m2, near_per_Pa, near.per_kg_out_Pa, in_Pa_kg[0], far[0], far_Pa[0], time_s},
      {area[1].to_m2, near_per_Pa, near.per_kg_out_Pa, in_Pa_kg[1], far[1], far_Pa[1], time_s}};
  for (int turn = 0; turn < 3; ++turn) {
    p1 = p1 < low ? low : p1 > high ? high : p1;
    Real pull_Pa{}, weight = Real{1}, residual = p1 - pc, slope = Real{1};
    for (OverlapPort<Real>& one : port) {
      one.look(p1);
      const Real k = time_s * one.per_kg_Pa();
      pull_Pa += k * one.conductance() * (one.far_Pa() - pc);
      weight += k * one.conductance();
      residual -= k * one.flow_kg_s();
      slope += k * one.slope();
    }
    p1 = turn < 2 ? p1 - residual / slope : pc + pull_Pa / weight;
  }
  for (int i = 0; i < 2; ++i) {
    const Real mass_kg = explicit_kg[i] + time_s * port[i].conductance() * (port[i].far_Pa() - p1);
    flow[i] = {mass_kg, mass_kg > 0 ? in_Pa_kg[i] : near.per_kg_out_Pa};
  }
}

}  // namespace crankloop::detail
