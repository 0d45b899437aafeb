// The list of a state's fields. Size, saving and loading with range checks are all generated from it.
//
// What belongs here: the fields' order and their ranges. What does not: those of gas exchange (gas_fields.hpp), the
// format of the bytes (saved_state.hpp).
//
// The ranges are wider than those of any engine: they exclude numbers that a step could not compute with. Within them
// no index leaves its table, no conversion overflows, and no number becomes infinite.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include <crankloop/faults.hpp>
#include <crankloop/input.hpp>
#include <crankloop/state.hpp>
#include <crankloop/tick/state/gas_fields.hpp>

namespace crankloop::detail {

/// visit(state, v) calls, for every field in its order,
///
///     v.group(name)               name of the fields that follow in a Status
///     v.number(x, least, most)    a Real
///     v.sum(x, most)              counted part of an integral: an integer that may wrap, or a double up to `most`
///     v.wide(x), v.phase(x)       any 64 bits
///     v.signed_wide(x, most)      64 bits that hold a signed number of at most this magnitude
///     v.word(x, most)             a 32-bit number, 0 to most
///     v.spare(x)                  not in use
template <class Real, class S>
struct StateFields {
  template <class AState, class Visitor>
  static constexpr void visit(AState& s, Visitor& v) noexcept {
    using N = Needs<S>;
    v.group("state.drive");
    v.wide(s.fingerprint);
    v.phase(s.phase);
    v.wide(s.ticks);
    v.number(s.speed_rad_s, Real{-20000}, Real{20000});  // load_state() checks the tables' own limit
    v.number(s.load_ratio, Real{0}, Real{2});
    if constexpr (N::input_pressure) {
      v.group("state.pressure");
      for (auto& pressure : s.pressure_Pa) v.number(pressure, Real{0}, kMaxPressure_Pa);
    }
    if constexpr (N::work) {
      v.group("state.work");
      integral(s.inertia, v);
      for (auto& gas : s.gas) integral(gas, v);
      for (auto& stroke : s.stroke) integral(stroke, v);
      v.number(s.torque_Nm, -kMaxWork, kMaxWork);
      v.spare(s.spare);
    }
    if constexpr (N::crank_dynamics) {
      v.group("state.crank");
      v.number(s.reduced_speed, -kMaxReducedSpeed, kMaxReducedSpeed);
      v.number(s.reduced_rest, -kMaxReducedSpeed, kMaxReducedSpeed);
      v.number(s.per_root_inertia, kLeastPerRoot, kMaxPerRoot);
      v.number(s.inertia_slope_kg_m2, -kMaxInertia_kg_m2, kMaxInertia_kg_m2);
      for (auto& torque : s.gas_Nm) v.number(torque, -kMaxWork, kMaxWork);
      v.number(s.lag_rad_s, -kMaxLag_rad_s, kMaxLag_rad_s);
      v.number(s.external_torque_Nm, -kMaxExternalTorque_Nm, kMaxExternalTorque_Nm);
    }
    if constexpr (N::elastic_valves) {
      v.group("state.valve");
      for (auto& lift : s.valve_lift_m) v.number(lift, -kMaxLift_m, kMaxLift_m);
      for (auto& velocity : s.valve_velocity_m_s) v.number(velocity, -kMaxSpeed_m_s, kMaxSpeed_m_s);
      for (auto& regime : s.valve_regime) v.word(regime, kQuiet);
      for (auto& turned : s.cam_turned_deg) v.number(turned, Real{-360}, Real{360});
    }
    if constexpr (N::valve_gas_held) {
      for (auto& gas : s.valve_gas_N) v.number(gas, -kMaxGas_N, kMaxGas_N);
    }
    if constexpr (N::surge) {
      v.group("state.spring");
      for (auto& mode : s.spring_mode_m)
        for (auto& q : mode) v.number(q, -kMaxMode_m, kMaxMode_m);
      for (auto& mode : s.spring_mode_m_s)
        for (auto& speed : mode) v.number(speed, -kMaxSpeed_m_s, kMaxSpeed_m_s);
      for (auto& mean : s.valve_mean_m_s2) v.number(mean, -kMaxMean_m_s2, kMaxMean_m_s2);
    }
    if constexpr (S::cam_phasing) {
      v.group("state.cam_phase");
      for (auto& phase : s.cam_phase) v.signed_wide(phase, kMaxCamPhase);
      for (auto& target : s.cam_phase_target_deg) v.number(target, Real{-180}, Real{180});
    }
    if constexpr (S::valve_results) {
      v.group("state.record");
      for (auto& train : s.record) {
        for (auto& one : train) record(one, v);
      }
    }
    if constexpr (S::cam_contact) {
      v.group("state.contact");
      for (auto& train : s.contact_record) {
        for (auto& one : train) {
          v.number(one.largest_Pa, Real{0}, kMaxStress_Pa);
          v.number(one.largest_deg, Real{-360}, Real{360});
        }
      }
    }
    if constexpr (S::cam_drag) {
      v.group("state.cam_drag");
      v.number(s.cam_drag_Nm, -kMaxWork, kMaxWork);
      v.spare(s.spare_of_cam_drag);
    }
    if constexpr (N::gas) GasFields<Real, S>::visit(s, v);
    if constexpr (S::misfire) {
      v.group("state.misfire");
      for (auto& record : s.misfire) {
        for (auto& word : record.history) v.word(word, kAny);
        v.word(record.cycles, kAny);
        v.word(record.misfires, kAny);
        v.spare(record.in_200_turns);  // follow from the history
        v.spare(record.in_1000_turns);
        v.word(record.random, kAny);
        v.word(record.taken, 1u);
      }
      if constexpr (N::misfire_of_table) {
        for (auto& ratio : s.burning_ratio) v.number(ratio, Real{0}, Real{1});
        v.spare(s.cycles_go_on_from);  // follow from phase and shares
        v.spare(s.cycles_go_on);
        v.spare(s.lacking_heat);
        v.spare(s.spare_of_burning);
      }
    }
    if constexpr (N::faulty_wheels) {
      v.group("state.wire");
      v.word(s.wires_differ, (1u << S::triggers.capacity) - 1);
      for (auto& random : s.noise_random) v.word(random, kAny);
    }
    if constexpr (N::reluctor) {
      v.group("state.comparator");
      v.number(s.sensor_V, -kMaxSensor_V, kMaxSensor_V);
      v.number(s.sensor_peak_V, Real{0}, kMaxSensor_V);
      v.number(s.sensor_last_peak_V, Real{0}, kMaxSensor_V);
      v.spare(s.spare_of_sensor);
      v.word(s.comparator_level, 1u);
      v.word(s.comparator_armed, 1u);
      v.word(s.comparator_quiet_ticks, kAny);
      for (auto& late : s.late_edge_s) v.number(late, Real{0}, Real{1});
      v.word(s.late_edges, S::reluctor_samples);
    }
    if constexpr (S::sensor_faults) {
      v.group("state.sensor");
      for (auto& sensor : s.sensor) {
        for (auto* x : {&sensor.held, &sensor.late, &sensor.lagged, &sensor.lagged_rest})
          v.number(*x, -kMaxNoted<Real>, kMaxNoted<Real>);
        for (auto& sample : sensor.sample) v.number(sample, -kMaxNoted<Real>, kMaxNoted<Real>);
        v.word(sensor.oldest, detail::kDelayedSamples - 1);
        v.word(sensor.ticks_left, kAny);
        v.word(sensor.random, kAny);
        v.word(sensor.fault, std::uint32_t{kMaxSensorFaults});
      }
    }
    if constexpr (S::bad_input_count) {
      v.group("state.bad_input");
      v.word(s.bad_input_ticks, kAny);
      v.word(s.bad_input_kinds, kInputFaults);
    }
  }

 private:
  static constexpr Real kMaxPressure_Pa = static_cast<Real>(crankloop::kMaxPressure_Pa);
  static constexpr Real kMaxWork = static_cast<Real>(1e15);  ///< J and Nm; the largest engine that can be defined has
                                                             ///< 1e10
  static constexpr Real kMaxLag_rad_s = static_cast<Real>(1e5);  ///< several times the speed limit
  static constexpr Real kMaxExternalTorque_Nm = static_cast<Real>(crankloop::kMaxExternalTorque_Nm);
  static constexpr Real kMaxInertia_kg_m2 = static_cast<Real>(1e9);  ///< J_eff of the largest engine that can be
                                                                     ///< defined has 1e8
  static constexpr Real kMaxReducedSpeed = static_cast<Real>(1e9);   ///< sqrt(J) times the speed limit
  static constexpr Real kLeastPerRoot = static_cast<Real>(1e-5);     ///< 1/sqrt(kg m^2), for kMaxInertia_kg_m2;
                                                                     ///< kMaxPerRoot for kLeastInertia_kg_m2
  static constexpr Real kMaxPerRoot = static_cast<Real>(1e5);
  static constexpr Real kMaxLift_m = static_cast<Real>(1e6);
  static constexpr Real kMaxSpeed_m_s = static_cast<Real>(1e6);
  static constexpr Real kMaxMode_m = static_cast<Real>(1e3);
  static constexpr Real kMaxMean_m_s2 = static_cast<Real>(1e13);  ///< twice the largest speed, in the shortest tick
  static constexpr Real kMaxGas_N = static_cast<Real>(1e9);       ///< 1e8 Pa on a bore of 2 m
  static constexpr std::uint64_t kMaxCamPhase = std::uint64_t{1} << 62;  ///< 180 deg of 720
  static constexpr Real kMaxSensor_V = static_cast<Real>(1e9);
  static constexpr std::uint32_t kAny = ~std::uint32_t{0};
  static constexpr Real kMaxStress_Pa = static_cast<Real>(1e30);

  template <class AnIntegral, class Visitor>
  static constexpr void integral(AnIntegral& x, Visitor& v) noexcept {
    v.sum(x.base, static_cast<double>(kMaxWork));
    v.number(x.part, -kMaxWork, kMaxWork);
  }

  template <class ARecord, class Visitor>
  static constexpr void record(ARecord& r, Visitor& v) noexcept {
    auto& c = r.cycle_;
    for (auto* x : {&c.largest_lift_m, &c.largest_speed_m_s, &c.largest_acceleration_m_s2, &c.opening_delay_deg,
                    &c.separation_clearance_m, &c.separation_start_deg, &c.separation_duration_deg,
                    &c.seating_speed_m_s, &c.bounce_height_m}) {
      v.number(*x, -kMaxNoted<Real>, kMaxNoted<Real>);
    }
    for (auto* count : {&c.separations, &c.bounces, &c.contact_changes, &c.off_seat_at_end}) v.word(*count, kAny);
    for (auto* x : {&r.theory_opened_deg_, &r.separated_at_deg_, &r.excursion_m_})
      v.number(*x, -kMaxNoted<Real>, kMaxNoted<Real>);
    v.word(r.stage_, 2u);
    v.word(r.flags_, 7u);
  }
};

/// Bytes of the visited fields: in memory with the spare ones, in a file without them.
struct CountFields {
  std::size_t in_memory = 0;
  std::size_t in_bytes = 0;

  constexpr void group(const char*) noexcept {}
  template <class T>
  constexpr void any(const T&) noexcept {
    in_memory += sizeof(T);
    in_bytes += sizeof(T);
  }
  template <class Real>
  constexpr void number(const Real& x, Real, Real) noexcept {
    any(x);
  }
  template <class Base>
  constexpr void sum(const Base& x, double) noexcept {
    any(x);
  }
  constexpr void wide(const std::uint64_t& x) noexcept { any(x); }
  constexpr void phase(const Phase& x) noexcept { any(x); }
  constexpr void signed_wide(const std::uint64_t& x, std::uint64_t) noexcept { any(x); }
  template <class Word>
  constexpr void word(const Word& x, std::uint32_t) noexcept {
    any(x);
  }
  template <class T>
  constexpr void spare(const T&) noexcept {
    in_memory += sizeof(T);
  }
};

template <class Real, class S>
[[nodiscard]] constexpr CountFields count_fields() noexcept {
  CountFields count;
  const State<Real, S> state{};
  StateFields<Real, S>::visit(state, count);
  return count;
}

}  // namespace crankloop::detail
