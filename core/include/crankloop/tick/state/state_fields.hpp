// The list of a state's fields. Size, saving and loading with range checks are all generated from it.
//
// What belongs here: the fields' order and their ranges. What does not: the format of the bytes
// (tick/state/saved_state.hpp).
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
    if constexpr (N::gas) visit_gas(s, v);
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
          v.number(*x, -kMaxNoted, kMaxNoted);
        for (auto& sample : sensor.sample) v.number(sample, -kMaxNoted, kMaxNoted);
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
  static constexpr Real kMaxNoted = static_cast<Real>(1e18);      ///< of numbers that are only compared, subtracted and
                                                                  ///< output
  static constexpr std::uint64_t kMaxCamPhase = std::uint64_t{1} << 62;  ///< 180 deg of 720
  static constexpr Real kMaxSensor_V = static_cast<Real>(1e9);
  static constexpr std::uint32_t kAny = ~std::uint32_t{0};
  static constexpr Real kMaxStress_Pa = static_cast<Real>(1e30);

  template <class AnIntegral, class Visitor>
  static constexpr void integral(AnIntegral& x, Visitor& v) noexcept {
    v.sum(x.base, static_cast<double>(kMaxWork));
    v.number(x.part, -kMaxWork, kMaxWork);
  }

  // Gas: no cylinder holds a thousand tons. tick/state/gas_agrees.hpp checks that these numbers agree with one another.

  static constexpr Real kMaxGas_kg = static_cast<Real>(1e6);
  static constexpr Real kMaxGas_J = static_cast<Real>(1e13);
  static constexpr Real kMaxGas_kg_s = static_cast<Real>(1e21);  ///< a step's bound, 12 times 1e12 kg, in 1/8 us
  static constexpr Real kLeastOfGas = static_cast<Real>(1e-36);  ///< kg and J

  template <class AReal, class Visitor>
  static constexpr void contents(AReal& kg, AReal& kg_rest, AReal& J, AReal& J_rest, AReal& burned_kg,
                                 AReal& burned_rest_kg, Visitor& v) noexcept {
    v.number(kg, kLeastOfGas, kMaxGas_kg);
    v.number(kg_rest, -kMaxGas_kg, kMaxGas_kg);
    v.number(J, kLeastOfGas, kMaxGas_J);
    v.number(J_rest, -kMaxGas_J, kMaxGas_J);
    v.number(burned_kg, Real{0}, kMaxGas_kg);
    v.number(burned_rest_kg, -kMaxGas_kg, kMaxGas_kg);
  }
  template <class AReal, class Visitor>
  static constexpr void point(AReal& pressure_Pa, AReal& temperature_K, AReal& burned_ratio, AReal& gas_ratio,
                              Visitor& v) noexcept {
    v.number(pressure_Pa, static_cast<Real>(1e-6), static_cast<Real>(1e12));
    v.number(temperature_K, static_cast<Real>(kLeastGas_K / 2), static_cast<Real>(kMaxGas_K * 2));
    v.number(burned_ratio, Real{0}, Real{1});
    v.number(gas_ratio, static_cast<Real>(0.14), static_cast<Real>(0.45));
  }
  template <class AState, class Visitor>
  static constexpr void visit_gas(AState& s, Visitor& v) noexcept {
    using N = Needs<S>;
    const auto numbers = [&v](Real most, auto&... x) { (v.number(x, -most, most), ...); };
    v.group("state.gas");
    for (std::uint32_t k = 0; k < S::cylinders.capacity; ++k) {
      auto& gas = s.cylinder_gas;
      contents(gas.mass_kg[k], gas.mass_rest_kg[k], gas.energy_J[k], gas.energy_rest_J[k], gas.burned_kg[k],
               gas.burned_rest_kg[k], v);
      point(gas.pressure_Pa[k], gas.temperature_K[k], gas.burned_ratio[k], gas.gas_ratio[k], v);
      v.number(gas.volume_m3[k], Real{0}, Real{100});
      for (auto& area : gas.area_m2) v.number(area[k], Real{0}, Real{100});
      numbers(kMaxGas_J, gas.wall_heat_W[k]);
      v.number(gas.pressure_before_Pa[k], Real{0}, static_cast<Real>(1e12));
      v.spare(gas.spare[k]);
    }
    if constexpr (S::crevice) {
      v.group("state.crevice");
      auto& gas = s.crevice_gas;
      for (std::uint32_t k = 0; k < sizeof gas.mass_kg / sizeof gas.mass_kg[0]; ++k) {
        v.number(gas.mass_kg[k], -kMaxGas_kg, kMaxGas_kg);  // below 0 by rounding alone: gas_agrees.hpp
        v.number(gas.burned_kg[k], -kMaxGas_kg, kMaxGas_kg);
        numbers(kMaxGas_kg, gas.mass_rest_kg[k], gas.burned_rest_kg[k]);
        if constexpr (S::gas_results) numbers(kMaxNoted, s.cycle_blow_by_kg[k]);
      }
      v.group("state.gas");
    }
    if constexpr (S::runners) {
      v.group("state.runner");  // all 0 of a port without one: gas_agrees.hpp
      for (auto& of_port : s.runner) {
        for (auto& r : of_port) {
          auto& c = r.contents;
          auto& p = r.point;
          numbers(kMaxGas_kg, c.mass_kg, c.mass_rest_kg);
          numbers(kMaxGas_J, c.energy_J, c.energy_rest_J);
          numbers(kMaxGas_kg, c.burned_kg, c.burned_rest_kg);
          v.number(p.pressure_Pa, Real{0}, static_cast<Real>(1e12));
          v.number(p.temperature_K, Real{0}, static_cast<Real>(kMaxGas_K * 2));
          v.number(p.burned_ratio, Real{0}, Real{1});
          v.number(p.gas_ratio, Real{0}, static_cast<Real>(0.45));
          numbers(static_cast<Real>(1e6), r.flow_kg_s, r.flow_rest_kg_s);
        }
      }
      v.group("state.gas");
    }
    if constexpr (S::walls) {
      v.group("state.walls");
      for (auto& wall : s.wall_K) v.number(wall, static_cast<Real>(kLeastGas_K), static_cast<Real>(kMaxGas_K));
      for (auto& rest : s.wall_rest_K) v.number(rest, Real{-1}, Real{1});
      v.group("state.gas");
    }
    if constexpr (N::manifolds) {
      for (auto& manifold : s.manifold) {
        auto& c = manifold.contents;
        auto& p = manifold.point;
        contents(c.mass_kg, c.mass_rest_kg, c.energy_J, c.energy_rest_J, c.burned_kg, c.burned_rest_kg, v);
        point(p.pressure_Pa, p.temperature_K, p.burned_ratio, p.gas_ratio, v);
      }
      numbers(kMaxGas_kg_s, s.taken_kg_s[kIntake], s.taken_kg_s[kExhaust]);
      v.number(s.outlet.temperature_K, static_cast<Real>(kLeastGas_K / 2), static_cast<Real>(kMaxGas_K * 2));
      v.number(s.outlet.burned_ratio, Real{0}, Real{1});
      v.number(s.throttle_ratio, Real{0}, Real{1});
      v.spare(s.spare_of_manifolds);
    }
    if constexpr (N::given_gas) {
      for (auto& given : s.given_gas) {
        v.number(given.pressure_Pa, static_cast<Real>(kLeastManifold_Pa), static_cast<Real>(kMaxManifold_Pa));
        v.number(given.temperature_K, static_cast<Real>(kLeastManifold_K), static_cast<Real>(kMaxManifold_K));
      }
    }
    if constexpr (N::burn) {
      v.group("state.burn");
      for (auto& burn : s.burn) {
        v.number(burn.fuel_kg, Real{0}, static_cast<Real>(kMaxFuel_kg));
        v.number(burn.burnt_ratio, Real{0}, Real{1});
        v.number(burn.start_deg, Real{-90}, N::charge_burn ? kLatestBurnEnd_deg<Real> : Real{60});
        v.number(burn.duration_deg, Real{5}, Real{150});
        v.number(burn.per_deg, Real{0}, Real{1});
        v.number(burn.excess_air_ratio, Real{0}, kMaxNoted);
        v.number(burn.asked_kg, Real{0}, static_cast<Real>(kMaxFuel_kg));
        v.number(burn.asked_excess_air_ratio, Real{0}, static_cast<Real>(kMaxExcessAir_ratio));
        v.word(burn.taken, 1u);
        v.spare(burn.spare);
      }
    }
    if constexpr (N::charge_burn) {
      v.group("state.charge_burn");
      for (auto& burn : s.charge_burn) {
        v.number(burn.spark_deg, Real{-90}, Real{60});
        v.number(burn.ratio, kLeastBurn_ratio<Real>, kMaxBurn_ratio<Real>);
        v.word(burn.due, 1u);
        v.spare(burn.spare);
      }
    }
    if constexpr (N::knock) {
      v.group("state.knock");
      for (auto& knock : s.knock) {
        v.number(knock.integral_ratio, Real{0}, static_cast<Real>(1e6));  // kMaxKnock
        v.number(knock.passes_deg, Real{-kDegreesPerCycle}, Real{kDegreesPerCycle});
        v.number(knock.unburned_K, static_cast<Real>(kLeastGas_K / 2), static_cast<Real>(kMaxGas_K * 2));
        v.number(knock.pressure_Pa, static_cast<Real>(1e-6), static_cast<Real>(1e12));
        v.number(knock.burned_ratio, Real{0}, Real{1});
        v.number(knock.burnt_ratio, Real{0}, Real{1});
      }
      constexpr std::uint32_t kAll = (std::uint32_t{1} << S::cylinders.capacity) - 1;
      v.word(s.knock_due, kAll), v.word(s.knock_in_burn, kAll);
    }
    if constexpr (N::lambda) {
      v.group("state.lambda");
      const auto fuel = [&v](auto& fuels) {
        for (auto& kg : fuels) v.number(kg, Real{0}, kMaxGas_kg);
      };
      fuel(s.unburned_kg), fuel(s.manifold_unburned_kg);
      if constexpr (S::runners) fuel(s.runner_unburned_kg[kIntake]), fuel(s.runner_unburned_kg[kExhaust]);
      if constexpr (S::gas_results) fuel(s.outflow_unburned_kg);
      constexpr Real kMost = static_cast<Real>(kMaxExcessAir_ratio);  // of 1 / lambda, too
      for (auto& ratio : s.pipe_ratio) v.number(ratio, Real{0}, kMost);
      v.number(s.filled_ratio, Real{0}, Real{1});
      v.number(s.filling_ratio, Real{0}, kMost);
      v.number(s.owed_ratio, Real{0}, Real{S::lambda_parcels});
      v.number(s.outlet_unburned_ratio, Real{0}, Real{1});
      v.number(s.sensor_ratio, Real{0}, kMost);
      v.number(s.sensor_rest_ratio, Real{-1}, Real{1});
      v.word(s.oldest_parcel, S::lambda_parcels - 1);
      v.word(s.any_unburned, 1u);
    }
    if constexpr (S::gas_results) {
      v.group("state.gas_record");
      for (auto& r : s.gas_record) {
        numbers(kMaxNoted, r.work_J, r.pumping_J, r.peak_Pa, r.peak_deg, r.trapped_kg, r.trapped_air_kg, r.air_kg,
                r.exhaust_kg, r.exhaust_J, r.exhaust_burned_kg, r.fuel_kg, r.wall_heat_J, r.begin_J, r.begin_rest_J,
                r.gained_J, r.gained_rest_J);
        v.word(r.whole, 1u);
        v.spare(r.spare);
      }
    }
  }

  template <class ARecord, class Visitor>
  static constexpr void record(ARecord& r, Visitor& v) noexcept {
    auto& c = r.cycle_;
    for (auto* x : {&c.largest_lift_m, &c.largest_speed_m_s, &c.largest_acceleration_m_s2, &c.opening_delay_deg,
                    &c.separation_clearance_m, &c.separation_start_deg, &c.separation_duration_deg,
                    &c.seating_speed_m_s, &c.bounce_height_m}) {
      v.number(*x, -kMaxNoted, kMaxNoted);
    }
    for (auto* count : {&c.separations, &c.bounces, &c.contact_changes, &c.off_seat_at_end}) v.word(*count, kAny);
    for (auto* x : {&r.theory_opened_deg_, &r.separated_at_deg_, &r.excursion_m_}) v.number(*x, -kMaxNoted, kMaxNoted);
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
