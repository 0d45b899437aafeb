// Inputs that no sensor should give: random bits, NaN, infinities, denormal numbers, limits.
#pragma once

#include <cstdint>

#include <crankloop/engine.hpp>

#include "bits.hpp"

namespace target_check {

/// A number to hurt with: random bits, so all magnitudes and some NaN; a special value; or one within its range.
template <class Real>
[[nodiscard]] Real hostile(Random& random, Real largest) noexcept {
  const std::uint64_t bits = random.next();
  const std::uint64_t choice = bits & 3;
  if (choice == 0) return from_bits<Real>(random.next());
  if (choice == 1) {
    const Real infinity = from_bits<Real>(sizeof(Real) == 4 ? 0x7F80'0000'0000'0000u : 0x7FF0'0000'0000'0000u);
    const Real least = from_bits<Real>(sizeof(Real) == 4 ? std::uint64_t{1} << 32 : 1);  // denormal
    const Real special[] = {infinity, -infinity, infinity - infinity, least,      -least, Real{0}, -Real{0},
                            largest,  -largest,  -largest * 2,        2 * largest};
    return special[bits / 4 % (sizeof special / sizeof special[0])];
  }
  return largest * (static_cast<Real>(static_cast<std::int32_t>(bits >> 40) - (1 << 23)) / static_cast<Real>(1 << 23));
}

/// Every number of the input at once. A faster crank than `fastest_rad_s` is refused.
template <class Real, class S>
void hurt(crankloop::Input<Real, S>& in, Random& random, Real fastest_rad_s = Real{10'000}) noexcept {
  (void)fastest_rad_s;
  if constexpr (S::crank == crankloop::CrankGiven::speed) {
    in.speed_rad_s = hostile<Real>(random, fastest_rad_s);
  } else if constexpr (S::crank == crankloop::CrankGiven::torque) {
    in.external_torque_Nm = hostile<Real>(random, static_cast<Real>(crankloop::kMaxExternalTorque_Nm));
  } else {
    in.crank = crankloop::Phase{random.next()};
  }
  if constexpr (S::starter) in.starter = static_cast<std::uint32_t>(random.next() >> 63);
  if constexpr (crankloop::detail::Needs<S>::cut) in.cut_cylinders = static_cast<std::uint32_t>(random.next() >> 32);
  if constexpr (crankloop::detail::Needs<S>::load) in.load_ratio = hostile<Real>(random, 2);
  if constexpr (crankloop::detail::Needs<S>::input_pressure) {
    for (Real& pressure : in.pressure_Pa) pressure = hostile<Real>(random, static_cast<Real>(1e8));
  }
  if constexpr (S::cam_phasing) {
    for (Real& target : in.cam_phase_deg) target = hostile<Real>(random, 180);
  }
  if constexpr (crankloop::detail::Needs<S>::manifolds) {
    in.throttle_ratio = hostile<Real>(random, 1);
  } else if constexpr (crankloop::detail::Needs<S>::gas) {
    for (Real* pressure : {&in.intake_Pa, &in.exhaust_Pa}) *pressure = hostile<Real>(random, static_cast<Real>(1e7));
    for (Real* temperature : {&in.intake_K, &in.exhaust_K}) *temperature = hostile<Real>(random, 3000);
  }
  if constexpr (crankloop::detail::Needs<S>::burn_input) {
    for (Real& fuel : in.fuel_kg) fuel = hostile<Real>(random, static_cast<Real>(0.01));
    for (Real& start : in.burn_start_deg) start = hostile<Real>(random, 60);
    for (Real& duration : in.burn_duration_deg) duration = hostile<Real>(random, 150);
  }
}

}  // namespace target_check
