#include "balancer.hpp"

namespace crankloop::program {

std::vector<Balancer> build_balancers(const std::vector<SectionValues>& sections, const Layout& layout) {
  std::vector<Balancer> balancers;
  for (const SectionValues& section : sections) {
    const bool on_crank = section.kind == "counterweight";
    if (!on_crank && section.kind != "balance_shaft") continue;
    Balancer balancer;
    balancer.title = section.title();
    balancer.unbalance_kg_m = section.si("mass_g") * section.si("radius_mm");
    balancer.position_m = section.si("position_mm");
    balancer.angle_deg = section.si("angle_deg");
    if (on_crank) {
      balancer.angle_deg += layout.throw_deg(0);
    } else {
      const int turns = static_cast<int>(section.number("turns"));
      balancer.turns = section.text("direction") == "with" ? turns : -turns;
    }
    balancers.push_back(balancer);
  }
  return balancers;
}

}  // namespace crankloop::program
