// What flows through both ports of a cylinder in a step of valve overlap. docs/model.md "Gas".
//
// As one port (port_flow.hpp), with one pressure p1 that both flows lead to: two steps of Newton's method from where
// the larger opening alone would take it, then a mean of all pressures with the conductances w / D as weights. Those
// are positive, so p1 lies between, for any step.
#pragma once

#include <crankloop/tick/gas/port_flow.hpp>

namespace crankloop::detail {

/// Flow through one of two at a pressure p1 of the cylinder, the manifold's own answer taken from the try before.
template <class T>
struct OverlapPort {
  using Real = NumberOf<T>;

  T out, in;            ///< A psi_c / sqrt(R T1)
  T out_Pa_s, in_Pa_s;  ///< how far a flow moves p1
  T far_Pa, far_Pa_s;
  T damping = spread<T>(1);
  T conductance{}, moves_Pa_s{}, flow_kg_s{}, slope{};

  [[gnu::always_inline]] void look(const T& p1, bool for_slope) noexcept {
    const T apart_Pa = far_Pa - p1;
    const T drop_Pa = magnitude(apart_Pa) * damping;
    const auto inwards = apart_Pa > Real{0};
    const T up_Pa = pick(inwards, far_Pa, p1);
    const T per_Pa = pick(inwards, in, out);
    moves_Pa_s = pick(inwards, in_Pa_s, out_Pa_s);
    const T s = drop_Pa / up_Pa * kPerChokedDrop<Real>;
    const T left = Real{2} - s;
    const auto chokes = s >= Real{1};
    // The flow per drop is `top` over `root`.
    const T by_s = per_Pa * kPerChokedDrop<Real>;
    const T top = either<T>(
        chokes, [&] { return per_Pa * up_Pa; }, [&] { return by_s * left; });
    const T root = either<T>(
        chokes, [&] { return drop_Pa; }, [&] { return square_root(s * left + static_cast<Real>(1e-10)); });
    const T per_both = Real{1} / (root + far_Pa_s * top);
    damping = root * per_both;
    conductance = top * per_both;
    if (!for_slope) return;
    // An ellipse: where it does not choke, the flow is `root` of the choked one.
    const T choked_kg_s = per_Pa * up_Pa;
    const T flow = either<T>(
        chokes, [&] { return choked_kg_s; }, [&] { return choked_kg_s * root; });
    flow_kg_s = pick(inwards, flow, -flow);
    slope = either<T>(
        chokes, [&] { return damping * pick(inwards, T{}, per_Pa); },
        [&] {
          const T held = root * static_cast<Real>(1 / 0.02);  // no slope is without bound
          return by_s * (Real{1} - s) * per_both * (held < Real{1} ? held : spread<T>(1));
        });
  }
};

/// Of both ports the implicit flow in kg/s over `time_s`, from what the larger alone would let through.
template <class T>
[[gnu::always_inline]] inline void implicit_flows(const Opening<T> (&at)[2], const GasNear<T>& near,
                                                  const T (&far_Pa)[2], const T& time_s, const T& alone_kg_s,
                                                  T (&flow_kg_s)[2]) noexcept {
  using Real = NumberOf<T>;
  const T pc = near.pressure_Pa;
  const T near_per_Pa = choked_per_Pa(near.temperature_K);
  const T low_far = far_Pa[0] < far_Pa[1] ? far_Pa[0] : far_Pa[1];
  const T high_far = far_Pa[0] < far_Pa[1] ? far_Pa[1] : far_Pa[0];
  const T low = pc < low_far ? pc : low_far;
  const T high = pc > high_far ? pc : high_far;
  const auto port = [&](int i) __attribute__((always_inline)) {
    OverlapPort<T> one;
    one.out = at[i].to_m2 * near_per_Pa, one.in = at[i].to_m2 * at[i].far.choked_per_Pa;
    one.out_Pa_s = time_s * near.per_kg_out_Pa, one.in_Pa_s = time_s * at[i].per_kg_in_Pa;
    one.far_Pa = far_Pa[i], one.far_Pa_s = time_s * at[i].far.response_Pa_kg;
    return one;
  };
  OverlapPort<T> a = port(0), b = port(1);
  T p1 = pc + time_s * alone_kg_s * pick(alone_kg_s > Real{0}, at[0].per_kg_in_Pa, near.per_kg_out_Pa);
  const auto look = [&](bool for_slope) __attribute__((always_inline)) {
    p1 = p1 < low ? low : p1;
    p1 = p1 > high ? high : p1;
    a.look(p1, for_slope), b.look(p1, for_slope);
  };
  for (int turn = 0; turn < 2; ++turn) {
    look(true);
    const T residual = p1 - pc - a.moves_Pa_s * a.flow_kg_s - b.moves_Pa_s * b.flow_kg_s;
    p1 -= residual / (Real{1} + a.moves_Pa_s * a.slope + b.moves_Pa_s * b.slope);
  }
  look(false);
  const T pull_a = a.moves_Pa_s * a.conductance, pull_b = b.moves_Pa_s * b.conductance;
  p1 = pc + (pull_a * (a.far_Pa - pc) + pull_b * (b.far_Pa - pc)) / (Real{1} + pull_a + pull_b);
  flow_kg_s[0] = a.conductance * (a.far_Pa - p1);
  flow_kg_s[1] = b.conductance * (b.far_Pa - p1);
}

/// `at[0]` is the larger port.
template <class T>
[[gnu::always_inline]] inline void two_port_flow(const Opening<T> (&at)[2], const GasPoint<T>& begin, GasNear<T> near,
                                                 NumberOf<T> step_s, PortFlow<T> (&flow)[2]) noexcept {
  const EarlyFlow<T> a = EarlyFlow<T>::of(at[0], begin, near, step_s), b = EarlyFlow<T>::of(at[1], begin, near, step_s);
  const T part_s = explicit_share(a.stiffness + b.stiffness) * step_s;
  const T all_a_kg = part_s * at[0].from_m2 * a.flow_kg_s_m2, all_b_kg = part_s * at[1].from_m2 * b.flow_kg_s_m2;
  const auto may =
      both_hold(a.may_be(all_a_kg, near.pressure_Pa, at[0].far), b.may_be(all_b_kg, near.pressure_Pa, at[1].far));
  const T a_kg = where(may, all_a_kg), b_kg = where(may, all_b_kg);
  const T time_s = step_s - where(may, part_s);
  near.move(a_kg * a.per_kg_Pa);
  near.move(b_kg * b.per_kg_Pa);
  const T far_Pa[2] = {left_Pa<T>(at[0].far, a_kg, may, step_s * at[0].from_m2 * a.flow_kg_s_m2),
                       left_Pa<T>(at[1].far, b_kg, may, step_s * at[1].from_m2 * b.flow_kg_s_m2)};
  T flow_kg_s[2];
  implicit_flows(at, near, far_Pa, time_s, implicit_flow(at[0], near, far_Pa[0], time_s), flow_kg_s);
  flow[0] = PortFlow<T>::of(a_kg + time_s * flow_kg_s[0], at[0], near);
  flow[1] = PortFlow<T>::of(b_kg + time_s * flow_kg_s[1], at[1], near);
}

}  // namespace crankloop::detail
