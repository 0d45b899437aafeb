#include <crankloop/tabulate/cam_contact.hpp>

#include <crankloop/tabulate/elementary.hpp>
#include <crankloop/tick/one_instruction.hpp>

namespace crankloop {

double contact_modulus_Pa(const CamContact& contact) noexcept {
  const auto compliance = [](double young_Pa, double poisson) { return (1 - poisson * poisson) / young_Pa; };
  return 1 / (compliance(contact.cam_Pa, contact.cam_poisson_ratio) +
              compliance(contact.follower_Pa, contact.follower_poisson_ratio));
}

HertzContact hertz_contact(const CamContact& contact, double curvature_per_m, double force_N) noexcept {
  if (!(force_N > 0)) return {0, 0};
  const double per_m = contact.width_m * elementary::kPi;
  const double largest_Pa = detail::square_root(force_N * contact_modulus_Pa(contact) * curvature_per_m / per_m);
  return {largest_Pa, 2 * force_N / (per_m * largest_Pa)};
}

}  // namespace crankloop
