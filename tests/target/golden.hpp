// Golden runs: 2000 ticks of an engine's life, and the hash of every bit that came out.
//
// What belongs here: how a run goes. What does not: which engines run (golden.cpp), what comes out (golden_hashes.inc).
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

#include <crankloop/engine.hpp>

#include "bits.hpp"
#include "output_numbers.hpp"

namespace target_check {

inline constexpr int kGoldenTicks = 2000;

/// One tick's input: from standstill up to the top speed, down through zero, backwards, a crawl; load steps, a moving
/// cam; now and then what no sensor should say. All numbers are sums of a few powers of two, so they are the same in
/// float and double.
template <class Real, class S>
void golden_input(crankloop::Input<Real, S>& in, int tick, int top_rad_s) noexcept {
  const auto real = [](int x) { return static_cast<Real>(x); };
  const int up = tick < 1200 ? tick : 2100 - tick * 3 / 4;  // 0 to 1199, 1200 down to 600
  Real speed = real(up * top_rad_s / 1200);
  if (tick >= 1700) speed = -speed;
  if (tick >= 1900) speed = real(tick - 1950) / 1024;
  if constexpr (S::crank == crankloop::CrankGiven::speed) {
    in.speed_rad_s = tick % 97 == 50 ? std::numeric_limits<Real>::quiet_NaN() : speed;
  } else if constexpr (S::crank == crankloop::CrankGiven::torque) {
    in.external_torque_Nm = tick % 97 == 50 ? std::numeric_limits<Real>::quiet_NaN()
                                            : real(tick < 1000 ? -256 : 512);  // up, and down through zero
  } else {
    in.crank += crankloop::Phase{static_cast<std::uint64_t>(static_cast<std::int64_t>(up) << 43)};
    if (tick % 397 == 50) in.crank += crankloop::Phase{std::uint64_t{1} << 63};
  }
  if constexpr (S::starter) in.starter = tick < 300 ? 1 : 0;
  if constexpr (crankloop::detail::Needs<S>::cut) in.cut_cylinders = tick / 150 % 3 == 2 ? 1 : 0;
  if constexpr (crankloop::detail::Needs<S>::load)
    in.load_ratio = tick % 89 == 80 ? std::numeric_limits<Real>::infinity() : real(tick / 100 % 7) * Real{0.1875};
  if constexpr (crankloop::detail::Needs<S>::input_pressure) {
    int k = 0;
    for (Real& pressure : in.pressure_Pa) pressure = real(100'000 + 1'000 * ((7 * tick + 311 * k++) % 5'000));
  }
  if constexpr (crankloop::detail::Needs<S>::gas_cut) in.cut_cylinders = tick / 150 % 3 == 2 ? 1 : 0;
  if constexpr (crankloop::detail::Needs<S>::manifolds) {
    in.throttle_ratio = tick % 83 == 40 ? std::numeric_limits<Real>::quiet_NaN() : real(tick / 100 % 5) / 4;
  } else if constexpr (crankloop::detail::Needs<S>::gas) {
    in.intake_Pa = real(40'000 + 1'000 * (tick / 50 % 80)), in.exhaust_K = real(600 + tick / 4);
  }
  if constexpr (crankloop::detail::Needs<S>::burn_input) {
    for (Real& fuel : in.fuel_kg) fuel = real(tick / 200 % 5) / 131072;  // up to 31 mg
  }
  if constexpr (S::cam_phasing) {
    for (Real& target : in.cam_phase_deg) target = tick / 500 % 2 == 0 ? Real{0} : Real{-20};
  }
}

/// Hash of all outputs, and of where the crank stood.
template <class Real, class S>
std::uint64_t golden_hash(crankloop::Engine<Real, S>& engine, int top_rad_s) noexcept {
  Hash hash;
  crankloop::Input<Real, S> in;
  for (int tick = 0; tick < kGoldenTicks; ++tick) {
    golden_input<Real, S>(in, tick, top_rad_s);
    each_number(hash, engine.step(in));
    hash.add(engine.state().phase.units());
  }
  return hash.value();
}

}  // namespace target_check
