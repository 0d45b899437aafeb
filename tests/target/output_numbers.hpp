// Every number of an output, one after the other, without the padding between them: to hash it and to see whether it is
// finite.
//
// What belongs here: the members of each output group. Groups are bound member by member, so one that is added cannot
// be forgotten here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include <crankloop/output.hpp>

namespace target_check {

template <class Sink, class Real, std::size_t N>
void each(Sink& sink, const Real (&row)[N]) {
  for (const Real& x : row) each(sink, x);
}
template <class Sink>
void each(Sink& sink, const float& x) {
  sink.add(x);
}
template <class Sink>
void each(Sink& sink, const double& x) {
  sink.add(x);
}
template <class Sink>
void each(Sink& sink, const std::uint32_t& x) {
  sink.add(x);
}
template <class Sink, class Real>
void each(Sink& sink, const crankloop::CylinderForces<Real>& forces) {
  const auto& [pressure, gas, inertia, total, side, rod, radial, tangential, torque, tilting] = forces;
  for (const Real x : {pressure, gas, inertia, total, side, rod, radial, tangential, torque, tilting}) sink.add(x);
}
template <class Sink, class Real>
void each(Sink& sink, const crankloop::FreeForce<Real>& force) {
  const auto& [up, lateral, pitch, yaw] = force;
  for (const Real x : {up, lateral, pitch, yaw}) sink.add(x);
}
template <class Sink, class Real, class S>
void each(Sink& sink, const crankloop::ValveMotionOutput<Real, S>& motion) {
  if constexpr (S::theoretical_lift) sink.add(motion.theoretical_lift_m);
  const auto& [lift, velocity] = static_cast<const crankloop::group::LiftAndVelocity<Real>&>(motion);
  sink.add(lift), sink.add(velocity);
  if constexpr (S::valve_acceleration) sink.add(motion.acceleration_m_s2);
}
template <class Sink, class Real>
void each(Sink& sink, const crankloop::ValveForcesOutput<Real>& forces) {
  const auto& [train, seat, tip, cam, gap, regime] = forces;
  for (const Real x : {train, seat, tip, cam, gap}) sink.add(x);
  sink.add(regime);
}
template <class Sink, class Real>
void each(Sink& sink, const crankloop::ValveSpringOutput<Real>& spring) {
  const auto& [surge, moving, fixed] = spring;
  for (const Real x : {surge, moving, fixed}) sink.add(x);
}
template <class Sink, class Real>
void each(Sink& sink, const crankloop::ValveCycle<Real>& cycle) {
  const auto& [lift, speed, acceleration, delay, gap, start, duration, seating, bounce, separations, bounces, changes,
               off_seat] = cycle;
  for (const Real x : {lift, speed, acceleration, delay, gap, start, duration, seating, bounce}) sink.add(x);
  for (const std::uint32_t x : {separations, bounces, changes, off_seat}) sink.add(x);
}

template <class Sink, class Real>
void each(Sink& sink, const crankloop::CylinderGasOutput<Real>& gas) {
  const auto& [pressure, temperature, mass, burned, flow, wall_heat] = gas;
  for (const Real x : {pressure, temperature, mass, burned, flow[0], flow[1], wall_heat}) sink.add(x);
}
template <class Sink, class Real>
void each(Sink& sink, const crankloop::GasCycle<Real>& cycle) {
  const auto& [net, pumping, peak, peak_deg, trapped, air, residual, volumetric, exhaust, fuel, excess, heat, wall,
               defect] = cycle;
  for (const Real x :
       {net, pumping, peak, peak_deg, trapped, air, residual, volumetric, exhaust, fuel, excess, heat, wall, defect}) {
    sink.add(x);
  }
}

/// Edges beyond those listed have no meaning.
template <class Sink, class Real, class S>
void each(Sink& sink, const crankloop::TriggerSignal<Real, S>& signal) {
  const auto& [level, edge_count, edge] = signal;
  sink.add(level), sink.add(edge_count);
  for (std::uint32_t i = 0; i < edge_count && i < S::trigger_edges; ++i)
    sink.add(edge[i].time_s), sink.add(edge[i].level);
}

/// sink.add(x) for each number of the output, the fault bits last.
template <class Sink, class Real, class S>
void each_number(Sink& sink, const crankloop::Output<Real, S>& out) {
  if constexpr (crankloop::detail::Needs<S>::crank_dynamics) {
    const auto& [crank, speed, acceleration, friction] = static_cast<const crankloop::group::CrankMotion<Real>&>(out);
    sink.add(static_cast<std::uint32_t>(crank.units() >> 32)), sink.add(static_cast<std::uint32_t>(crank.units()));
    for (const Real x : {speed, acceleration, friction}) sink.add(x);
  }
  if constexpr (S::starter) each(sink, out.starter_Nm);
  if constexpr (S::kinematics) {
    const auto& [displacement, velocity, acceleration] = static_cast<const crankloop::group::Kinematics<Real, S>&>(out);
    each(sink, displacement), each(sink, velocity), each(sink, acceleration);
  }
  if constexpr (S::rod_motion) {
    const auto& [angle, speed, acceleration] = static_cast<const crankloop::group::RodMotion<Real, S>&>(out);
    each(sink, angle), each(sink, speed), each(sink, acceleration);
  }
  if constexpr (S::torque) each(sink, out.torque_Nm);
  if constexpr (S::mean_torque) each(sink, out.mean_torque_Nm);
  if constexpr (S::forces) {
    for (const auto& forces : out.cylinder) each(sink, forces);
  }
  if constexpr (S::bearing_loads) {
    const auto& [radial, tangential, load, along, across, journal] =
        static_cast<const crankloop::group::BearingLoads<Real, S>&>(out);
    each(sink, radial), each(sink, tangential), each(sink, load), each(sink, along), each(sink, across),
        each(sink, journal);
  }
  if constexpr (S::free_forces) each(sink, out.first), each(sink, out.second), each(sink, out.rotating);
  if constexpr (crankloop::detail::Needs<S>::any_valves) {
    for (const auto& train : out.valve) {
      for (const auto& valve : train) each(sink, valve);
    }
  }
  if constexpr (S::valve_forces) {
    for (const auto& train : out.valve_forces) {
      for (const auto& forces : train) each(sink, forces);
    }
  }
  if constexpr (crankloop::detail::Needs<S>::spring_forces) {
    for (const auto& train : out.valve_spring) {
      for (const auto& spring : train) each(sink, spring);
    }
  }
  if constexpr (S::valve_results) {
    for (const auto& train : out.valve_cycle) {
      for (const auto& cycle : train) each(sink, cycle);
    }
  }
  if constexpr (S::cam_contact) {
    for (const auto& train : out.cam_contact) {
      for (const auto& [stress, half_width, sliding, entrainment] : train)
        each(sink, stress), each(sink, half_width), each(sink, sliding), each(sink, entrainment);
    }
    for (const auto& train : out.cam_contact_cycle) {
      for (const auto& [largest, at] : train) each(sink, largest), each(sink, at);
    }
  }
  if constexpr (S::cam_torque) {
    for (const auto& train : out.cam_torque) {
      for (const auto& [torque, friction] : train) each(sink, torque), each(sink, friction);
    }
    each(sink, out.camshaft_Nm);
  }
  if constexpr (crankloop::detail::Needs<S>::gas) {
    for (const auto& gas : out.cylinder_gas) each(sink, gas);
  }
  if constexpr (crankloop::detail::Needs<S>::manifolds) {
    const auto& [manifolds, throttle, outlet] = static_cast<const crankloop::group::Manifolds<Real>&>(out);
    for (const auto& [pressure, temperature, burned] : manifolds) {
      for (const Real x : {pressure, temperature, burned}) sink.add(x);
    }
    sink.add(throttle), sink.add(outlet);
  }
  if constexpr (S::gas_results) {
    for (const auto& cycle : out.gas_cycle) each(sink, cycle);
  }
  if constexpr (crankloop::detail::Needs<S>::any_triggers) {
    for (const auto& signal : out.trigger) each(sink, signal);
  }
  sink.add(out.faults);
}

}  // namespace target_check
