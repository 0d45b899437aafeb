// All elastic or cam-following valves of an engine over one tick.
//
// What belongs here: phasers, then valves of either kind; those that follow their cams. What does not: elastic ones
// (elastic_valves.hpp).
#pragma once

#include <cstdint>

#include <crankloop/input.hpp>
#include <crankloop/output.hpp>
#include <crankloop/tables/tables.hpp>
#include <crankloop/tick/valve/cam_ticks.hpp>
#include <crankloop/tick/valve/elastic_valves.hpp>
#include <crankloop/tick/valve/valves_work.hpp>

namespace crankloop::detail {

/// A valve that follows its cam, less the clearance.
template <class Real, class S>
[[nodiscard, gnu::always_inline]] constexpr ValveMotionOutput<Real, S> following(const LiftCurve<Real>& curve,
                                                                                 const Cell& cell,
                                                                                 const CamTurn<Real>& cam) noexcept {
  ValveMotionOutput<Real, S> shown{};
  const Lift<Real> lift = curve.read(cell);
  if (!(lift.lift_m > 0)) return shown;
  shown.lift_m = lift.lift_m;
  shown.velocity_m_s = lift.per_deg_m * cam.deg_per_s;
  if constexpr (S::theoretical_lift) shown.theoretical_lift_m = lift.lift_m;
  if constexpr (S::valve_acceleration)
    shown.acceleration_m_s2 = curve.curvature(cell) * (cam.deg_per_s * cam.deg_per_s);
  return shown;
}

/// One tick, in which the engine turned; `jumped`: a measured phase jumped, so valves start again where their cams
/// stand. Pressures are those of each cylinder, where the scene has valve_gas. Returns fault bits.
template <class Real, class S>
[[nodiscard, gnu::always_inline]] inline std::uint32_t run_valves(const Tables<Real, S>& tables, State<Real, S>& state,
                                                                  ValvesWorkOf<Real, S>& work, Output<Real, S>& out,
                                                                  const Input<Real, S>& input, Phase turned,
                                                                  bool jumped, const Real* pressure_Pa) noexcept {
  std::uint32_t faults = 0;
  const std::uint32_t trains = S::trains.exact ? S::trains.capacity : tables.drive->trains;
  CamTicks<Real, S> cams(tables, state, turned, jumped);
  if constexpr (S::cam_phasing) {
    for (std::uint32_t t = 0; t < trains; ++t)
      cams.move(tables.lift_curves[t], state, t, input.cam_phase_deg[t], faults);
  }
  if (trains == 0) return faults;
  if constexpr (Needs<S>::elastic_valves) {
    faults |= ElasticValves<Real, S>(tables, state, work, out, pressure_Pa).run(cams, jumped);
  } else {
    for (std::uint32_t t = 0; t < trains; ++t) {
      const LiftCurve<Real>& curve = tables.lift_curves[t];
      for (std::uint32_t k = 0; k < count<S>(tables.drive->cylinders); ++k) {
        out.valve[t][k] = following<Real, S>(curve, curve.cell(cams[t].phase, k), cams[t].cam);
      }
    }
  }
  (void)input, (void)work, (void)pressure_Pa;
  return faults;
}

}  // namespace crankloop::detail
