// Counterweights and balance shafts of the engine file: what balances the engine's free forces beside its own parts.
//
// What belongs here: one as an unbalance that turns. What does not: its force (loops/free_forces.hpp).
#pragma once

#include <string>
#include <vector>

#include <crankloop/define/layout.hpp>

#include "engine_file_values.hpp"

namespace crankloop::program {

/// An unbalance whose direction, from up in the crankshaft's sense of rotation, is angle_deg + turns A at engine angle
/// A.
struct Balancer {
  std::string title{};        ///< of its section: "[counterweight 1]"
  double unbalance_kg_m = 0;  ///< mass times radius
  int turns = 1;              ///< per turn of the crankshaft; negative: against it
  double angle_deg = 0;
  double position_m = 0;  ///< along the crankshaft, as Layout::position_m
};

/// Of every [counterweight NAME] and [balance_shaft NAME], in the order of the sections.
[[nodiscard]] std::vector<Balancer> build_balancers(const std::vector<SectionValues>& sections, const Layout& layout);

}  // namespace crankloop::program
