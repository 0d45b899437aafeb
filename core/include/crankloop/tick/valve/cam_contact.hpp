// The contact of each cam and its follower at the end of a tick, and the torque that the cams take: docs/model.md
// "Cam contact" and "Camshaft torque".
//
// What belongs here: what follows from a valve's state once it is stepped, so that valves in lanes and one by one have
// the same bits. What does not: the step (plain_steps.hpp, event_location.hpp), the geometry (tabulate/valve_lift.hpp).
#pragma once

#include <cstdint>

#include <crankloop/assert.hpp>
#include <crankloop/tables/angle.hpp>
#include <crankloop/tick/one_instruction.hpp>
#include <crankloop/tick/valve/cam_ticks.hpp>
#include <crankloop/tick/valve/valve_access.hpp>

namespace crankloop::detail {

template <class Real, class S>
class CamsUnderLoad {
  using Valves = ValveAccess<Real, S>;
  using Bits = typename Valves::Bits;

 public:
  CamsUnderLoad(Valves& valves, const CamTicks<Real, S>& cams) noexcept : valves_{valves}, cams_{cams} {}

  /// Of all active valves: the cams of others carry nothing, and their outputs are 0 since they came to rest.
  /// O(active valves).
  void run() noexcept {
    Real camshaft_Nm{};
    for (Bits left = valves_.work.active; left != 0; left &= left - 1) {
      const std::uint32_t v = trailing_zeros(left);
      const Real torque_Nm = show(v);
      if constexpr (S::cam_torque) camshaft_Nm += torque_Nm * valves_.tables.cam_torques[valves_.train(v)].cams;
    }
    if constexpr (S::cam_torque) valves_.out.camshaft_Nm = camshaft_Nm;
    if constexpr (S::cam_drag) valves_.state.cam_drag_Nm = camshaft_Nm / 2;  // the crank turns twice as fast
    CRANKLOOP_ASSERT(is_finite(camshaft_Nm));
  }

 private:
  static constexpr Real kPerRad = static_cast<Real>(1 / kRadPerDegree);

  /// Returns the torque of the valve's cam, where the scene has it.
  [[nodiscard]] Real show(std::uint32_t v) noexcept {
    const Lift<Real> cam = valves_.cam(v);
    const CamTick<Real>& tick = cams_[valves_.train(v)];
    const Real train_N = force_N(v, cam, tick);
    if (!(train_N > 0)) {
      if constexpr (S::cam_contact) (&valves_.out.cam_contact[0][0])[v] = {};
      if constexpr (S::cam_torque) (&valves_.out.cam_torque[0][0])[v] = {};
      return Real{0};
    }
    const Cell cell = valves_.cell(v, tick.phase);
    const LiftCurve<Real>& curve = valves_.curve(v);
    const Place place{cell.degree < curve.segments ? cell.degree : curve.segments, fraction<Real>(cell)};
    if constexpr (S::cam_contact) show_contact(v, place, train_N * value(curve.rocker_ratio[place.row], place.u), tick);
    if constexpr (S::cam_torque) return show_torque(v, place, train_N, cam, tick);
    return Real{0};
  }

  [[nodiscard]] Real force_N(std::uint32_t v, const Lift<Real>& cam, const CamTick<Real>& tick) const noexcept {
    if constexpr (S::valve_forces) {
      return (&valves_.out.valve_forces[0][0])[v].train_N;
    } else {
      const ValveState<Real> s = valves_.state_of(v);
      return train_force_N(valves_.motion(v).body, contacts_of(valves_.state.valve_regime[v]), cam.lift_m - s.lift_m,
                           tick.cam.deg_per_s * cam.per_deg_m - s.velocity_m_s);
    }
  }

  /// Where a cam stands: the row of its curves, and how far into it.
  struct Place {
    std::uint32_t row;
    Real u;
  };

  void show_contact(std::uint32_t v, const Place& place, Real cam_N, const CamTick<Real>& tick) noexcept {
    const CamContactCurve<Real>& curve = valves_.tables.cam_contacts[valves_.train(v)];
    const Real cam_rad_s = tick.cam.deg_per_s * static_cast<Real>(kRadPerDegree);
    CamContactOutput<Real>& shown = (&valves_.out.cam_contact[0][0])[v];
    const Real stress_Pa = value(curve.at[place.row].stress, place.u) * square_root(cam_N > 0 ? cam_N : Real{0});
    const bool pressed = stress_Pa > 0;  // a curve's fit may fall below 0 where the geometry all but jams
    shown.stress_Pa = pressed ? stress_Pa : Real{0};
    shown.half_width_m = pressed ? curve.per_width_m * (cam_N / stress_Pa) : Real{0};
    shown.sliding_m_s = cam_rad_s * value(curve.sliding_m[place.row], place.u);
    shown.entrainment_m_s = cam_rad_s * value(curve.at[place.row].entrainment_m, place.u);
    CamContactCycle<Real>& record = (&valves_.state.contact_record[0][0])[v];
    if (stress_Pa > record.largest_Pa)
      record = {stress_Pa, valves_.curve(v).degrees(tick.phase - valves_.curve(v).opens[valves_.cylinder(v)])};
  }

  [[nodiscard]] Real show_torque(std::uint32_t v, const Place& place, Real train_N, const Lift<Real>& cam,
                                 const CamTick<Real>& tick) noexcept {
    const CamTorqueTable<Real>& table = valves_.tables.cam_torques[valves_.train(v)];
    Real friction_Nm{};
    if (table.friction_ratio > 0 && tick.cam.deg != 0) {
      const Real ratio = value(valves_.curve(v).rocker_ratio[place.row], place.u);
      const Real size_Nm =
          table.friction_ratio * (train_N * ratio) * magnitude(value(table.sliding_m[place.row], place.u));
      friction_Nm = tick.cam.deg > 0 ? size_Nm : -size_Nm;
    }
    const Real torque_Nm = train_N * (cam.per_deg_m * kPerRad) + friction_Nm;
    (&valves_.out.cam_torque[0][0])[v] = {torque_Nm, friction_Nm};
    return torque_Nm;
  }

  Valves& valves_;
  const CamTicks<Real, S>& cams_;
};

}  // namespace crankloop::detail
