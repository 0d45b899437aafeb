// Every field of a state, named once: how many bytes it takes, how it is written, what it may be when it is read back.
//
// What belongs here: the fields' order and their ranges. What does not: the form of the bytes (tick/state/saved_state.hpp).
//
// The ranges are wider than any engine's: they keep out what a step could not compute with. Within them no index leaves its table, no
// conversion its integer, and no number becomes infinite.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include <crankloop/faults.hpp>
#include <crankloop/input.hpp>
#include <crankloop/state.hpp>

namespace crankloop::detail {

/// visit(state, v) calls, for every field in its order,
///
///     v.group(name)               what the fields that follow are called in a Status
///     v.number(x, least, most)    a Real
///     v.sum(x, most)              the counted part of an integral: an integer that may wrap, or a double of at most this magnitude
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
    v.number(s.speed_rad_s, Real{-20000}, Real{20000});  // the tables know their own limit
    v.number(s.load_ratio, Real{0}, Real{2});
    if constexpr (N::input_pressure) {
      v.group("state.pressure");
      for (auto& pressure : s.pressure_Pa) v.number(pressure, Real{0}, kMostPressure_Pa);
    }
    if constexpr (N::work) {
      v.group("state.work");
      integral(s.inertia, v);
      for (auto& gas : s.gas) integral(gas, v);
      for (auto& stroke : s.stroke) integral(stroke, v);
      v.number(s.torque_Nm, -kMostWork, kMostWork);
      v.spare(s.spare);
    }
    if constexpr (N::crank_dynamics) {
      v.group("state.crank");
      v.number(s.reduced_speed, -kMostReducedSpeed, kMostReducedSpeed);
      v.number(s.reduced_rest, -kMostReducedSpeed, kMostReducedSpeed);
      v.number(s.per_root_inertia, kLeastPerRoot, kMostPerRoot);
      v.number(s.inertia_slope_kg_m2, -kMostInertia_kg_m2, kMostInertia_kg_m2);
      for (auto& torque : s.gas_Nm) v.number(torque, -kMostWork, kMostWork);
      v.number(s.lag_rad_s, -kMostLag_rad_s, kMostLag_rad_s);
      v.number(s.load_Nm, -kMostLoad_Nm, kMostLoad_Nm);
    }
    if constexpr (N::elastic_valves) {
      v.group("state.valve");
      for (auto& lift : s.valve_lift_m) v.number(lift, -kMostLift_m, kMostLift_m);
      for (auto& velocity : s.valve_velocity_m_s) v.number(velocity, -kMostSpeed_m_s, kMostSpeed_m_s);
      for (auto& regime : s.valve_regime) v.word(regime, kQuiet);
      for (auto& turned : s.cam_turned_deg) v.number(turned, Real{-360}, Real{360});
    }
    if constexpr (S::valve_gas) {
      for (auto& gas : s.valve_gas_N) v.number(gas, -kMostGas_N, kMostGas_N);
    }
    if constexpr (S::cam_phasing) {
      v.group("state.cam_phase");
      for (auto& phase : s.cam_phase) v.signed_wide(phase, kMostCamPhase);
      for (auto& target : s.cam_phase_target_deg) v.number(target, Real{-180}, Real{180});
    }
    if constexpr (S::valve_results) {
      v.group("state.record");
      for (auto& train : s.record) {
        for (auto& one : train) record(one, v);
      }
    }
    if constexpr (S::bad_input_count) {
      v.group("state.bad_input");
      v.word(s.bad_input_ticks, kAny);
      v.word(s.bad_input_kinds, kInputFaults);
    }
  }

 private:
  static constexpr Real kMostPressure_Pa = static_cast<Real>(crankloop::kMostPressure_Pa);
  static constexpr Real kMostWork = static_cast<Real>(1e15);    ///< J and Nm; the largest engine that can be defined has 1e10
  static constexpr Real kMostLag_rad_s = static_cast<Real>(1e5);  ///< some speed limits
  static constexpr Real kMostLoad_Nm = static_cast<Real>(crankloop::kMostLoad_Nm);
  static constexpr Real kMostInertia_kg_m2 = static_cast<Real>(1e9);  ///< J_eff of the largest engine that can be defined has 1e8
  static constexpr Real kMostReducedSpeed = static_cast<Real>(1e9);   ///< sqrt(J): that times the speed limit
  static constexpr Real kLeastPerRoot = static_cast<Real>(1e-5);      ///< 1/sqrt(kg m^2): of that inertia, and of kLeastInertia_kg_m2
  static constexpr Real kMostPerRoot = static_cast<Real>(1e5);
  static constexpr Real kMostLift_m = static_cast<Real>(1e6);
  static constexpr Real kMostSpeed_m_s = static_cast<Real>(1e6);
  static constexpr Real kMostGas_N = static_cast<Real>(1e9);    ///< 1e8 Pa on a bore of 2 m
  static constexpr Real kMostNoted = static_cast<Real>(1e18);   ///< of what is only compared, subtracted and shown
  static constexpr std::uint64_t kMostCamPhase = std::uint64_t{1} << 62;  ///< 180 deg of 720
  static constexpr std::uint32_t kAny = ~std::uint32_t{0};

  template <class AnIntegral, class Visitor>
  static constexpr void integral(AnIntegral& x, Visitor& v) noexcept {
    v.sum(x.base, static_cast<double>(kMostWork));
    v.number(x.part, -kMostWork, kMostWork);
  }

  template <class ARecord, class Visitor>
  static constexpr void record(ARecord& r, Visitor& v) noexcept {
    auto& c = r.cycle_;
    for (auto* x : {&c.largest_lift_m, &c.largest_speed_m_s, &c.largest_acceleration_m_s2, &c.opening_delay_deg, &c.separation_gap_m,
                    &c.separation_start_deg, &c.separation_duration_deg, &c.seating_speed_m_s, &c.bounce_height_m}) {
      v.number(*x, -kMostNoted, kMostNoted);
    }
    for (auto* count : {&c.separations, &c.bounces, &c.contact_changes, &c.off_seat_at_end}) v.word(*count, kAny);
    for (auto* x : {&r.theory_opened_deg_, &r.separated_at_deg_, &r.excursion_m_}) v.number(*x, -kMostNoted, kMostNoted);
    v.word(r.stage_, 2u);
    v.word(r.flags_, 7u);
  }
};

/// Bytes that the visited fields take in memory, spare ones included, and in a file, without them.
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
