#include "run_gas.hpp"

#include <algorithm>
#include <cmath>

#include <crankloop/tabulate/mechanism.hpp>

namespace crankloop::program {

void add_gas_columns(std::vector<std::string>& columns, std::size_t cylinders) {
  for (std::size_t k = 1; k <= cylinders; ++k) {
    for (const GasQuantityKind& kind : kGasQuantityKinds)
      columns.push_back("c" + std::to_string(k) + "_" + kind.name + "_" + kind.suffix);
  }
  for (const char* manifold : {"intake", "exhaust"}) {
    for (const char* what : {"_manifold_kPa", "_manifold_K", "_manifold_burned_ratio"})
      columns.push_back(std::string(manifold) + what);
  }
  columns.insert(columns.end(), {"throttle_g_s", "outlet_g_s"});
}

void add_order(Summary& s, const GasOrder& order) {
  s.line("throttle", order.throttle_ratio);
  s.line("fuel", order.fuel_kg * 1e6, "mg", "per cylinder and cycle");
  s.line("burn_start", order.burn_start_deg, "deg");
}

void add_gas(Summary& s, const GasCycle<double>& cycle) {
  s.line("pumping_mep", cycle.pumping_mep_Pa / 1e3, "kPa", "from 180 to 540 deg; negative: a loss");
  s.line("volumetric_efficiency", cycle.volumetric_efficiency, "", "air through the intake, by the ambient's density");
  s.line("trapped_air", cycle.trapped_air_kg * 1e6, "mg", "in a cylinder when its intake closed");
  s.line("residual_ratio", cycle.residual_ratio, "", "burned gas of all that was trapped");
  s.line("excess_air_ratio", cycle.excess_air_ratio, "", "lambda; 0: no fuel");
  s.line("exhaust_temperature", cycle.exhaust_K, "K", "net enthalpy over net mass through the exhaust valve");
  s.line("heat", cycle.heat_J, "J", "of combustion, of a cylinder's cycle");
  s.line("wall_heat", cycle.wall_heat_J, "J");
}

int cycles_to_settle(const EngineDefinition& engine) noexcept {
  if (!breathes(engine)) return 1;
  // A cycle draws its swept volume out of a manifold, less what it leaves: with eight volumes of it drawn, 1e-3 of what
  // was there is left. Residual gas and walls follow within some cycles.
  constexpr double kChanges = 8;
  constexpr double kAfter = 6;
  constexpr double kMax = 500;
  const double volume_m3 = std::max(engine.gas.intake_m3, engine.gas.exhaust_m3);
  const double swept_m3 = swept_volume_m3(engine.crank) * engine.layout.cylinders;
  return static_cast<int>(std::min(kMax, std::ceil(kAfter + kChanges * volume_m3 / swept_m3)));
}

}  // namespace crankloop::program
