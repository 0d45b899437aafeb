// The pressure of the cylinders: a diagram, or gas exchange.
#include "draft.hpp"

#include <crankloop/scenes.hpp>

#include "../../files/error.hpp"

namespace crankloop::program {

void add_pressure(Draft& draft, Numbers& n) {
  const Combustion& usual = usual_combustion(n.design);
  const std::string breathes =
      n.is_boosted() ? "boosted, " + shortest(n.design.pressure_ratio) + " times ambient" : "naturally aspirated";
  draft.section("pressure");
  draft.line("source", "wiebe", "assumed: synthesised until there is a measured diagram (angle_table)");
  draft.assume("crankcase_kPa", 100, "ambient");
  const double intake_kPa = to_three_digits(98 * n.design.pressure_ratio);
  draft.assume("intake_kPa", intake_kPa, breathes + ", full load");
  draft.assume("exhaust_kPa", n.is_boosted() ? intake_kPa : 105,
               n.is_boosted() ? "before the turbine: that of the intake" : "a free exhaust");
  draft.assume("start_of_combustion_deg", usual.start_deg, "usual for this kind");
  draft.assume("combustion_duration_deg", usual.duration_deg, "usual for this kind");
  draft.assume("wiebe_m", usual.wiebe_m, "usual for this kind");
  draft.assume("compression_exponent", usual.compression_exponent, "usual for this kind");
  draft.assume("expansion_exponent", usual.expansion_exponent, "usual for this kind");
  draft.assume("exhaust_valve_opens_deg", usual.exhaust_opens_deg, "usual for this kind");
  n.net_mep_kPa = draft.number("net_mep_kPa", "--net-mep-kPa", usual_net_mep_kPa(n.design, n.piston_speed_m_s()),
                               breathes + ", full load, " + (n.design.four_valves ? "four" : "two") +
                                   " valves; pumping is subtracted, friction is not");
}

void add_gas_exchange(Draft& draft, const Numbers& n) {
  const Combustion& burn = usual_combustion(n.design);
  const GasExchange& usual = *n.gas;
  const bool spark = n.design.type == EngineType::spark_ignition;
  const bool has_runners = usual.intake_runner_mm > 0;
  const auto rounded = [&](const char* key, double value, const std::string& why) {
    draft.assume(key, to_three_digits(value), why);
  };
  draft.section("pressure");
  draft.line("source", "gas", "given");
  draft.assume("crankcase_kPa", 100, "ambient");
  draft.section("gas");
  const std::string volumes = shortest(kManifoldVolumes) + " times the displacement" +
                              (has_runners ? ", five volumes of a runner or more" : "");
  rounded("intake_volume_cm3", usual.intake_volume_cm3, volumes);
  rounded("exhaust_volume_cm3", usual.exhaust_volume_cm3, volumes);
  if (has_runners) {
    rounded("intake_runner_mm", usual.intake_runner_mm, "tuned to 0.8 of the rated speed");
    rounded("intake_runner_diameter_mm", usual.intake_runner_diameter_mm, "0.44 bores");
    rounded("exhaust_runner_mm", usual.exhaust_runner_mm, "1.4 times the intake runner");
    rounded("exhaust_runner_diameter_mm", usual.exhaust_runner_diameter_mm, "0.4 bores");
  }
  rounded("throttle_mm2", usual.throttle_mm2,
          spark ? "effective area: " + shortest(kThrottleSpeed_m_s) + " m/s at rated speed"
                : "effective area of air filter and duct: " + shortest(kDuctSpeed_m_s) + " m/s at rated speed");
  rounded("throttle_closed_mm2", usual.throttle_closed_mm2, spark ? "leakage, for idling" : "a diesel has no throttle");
  rounded("outlet_mm2", usual.outlet_mm2,
          "the exhaust system as one orifice: " + shortest(kOutletPerInlet) + " of throttle_mm2");
  rounded("ambient_kPa", 100 * n.design.pressure_ratio,
          n.is_boosted() ? "behind the compressor at full load, and here at standstill too" : "sea level");
  if (n.is_boosted()) rounded("back_kPa", 100 * n.design.pressure_ratio, "before the turbine: that of the intake");
  draft.assume("ambient_C", n.is_boosted() ? 50 : 25,
               n.is_boosted() ? "behind the charge cooler" : "of the air it draws in");
  draft.assume("wall_C", usual.wall_C, "mean of head, piston and liner, at full load");
  draft.assume("crevice_share", kCreviceShare, "top land, ring pack, gasket and plug by the clearance volume");
  rounded("blow_by_mm2", usual.blow_by_mm2, "sound piston rings");
  if (spark) {
    draft.assume("excess_air_ratio", 1, "fuel by the air in each cylinder");
    draft.assume("burn_start_deg", burn.start_deg, "usual for this kind");
    draft.assume("burn_duration_deg", burn.duration_deg, "usual for this kind");
    draft.assume("wiebe_m", burn.wiebe_m, "usual for this kind");
    return;
  }
  constexpr double kHeatingValue_MJ_kg = 42.5;
  const double work_J = n.net_mep_kPa * n.displacement_L / n.cylinders;
  const double fuel_mg = work_J / (kDieselEfficiency * kHeatingValue_MJ_kg);
  if (fuel_mg > kMaxFuel_kg * 1e6) {
    throw UsageError("--gas: full load takes " + brief(to_three_digits(fuel_mg)) +
                     " mg of fuel in each of such cylinders; gas exchange takes up to " + brief(kMaxFuel_kg * 1e6) +
                     " mg: a smaller bore, stroke, --boost or --net-mep-kPa, or no --gas");
  }
  rounded("fuel_mg", fuel_mg,
          "full load, a net mean effective pressure of " + brief(to_three_digits(n.net_mep_kPa)) +
              " kPa at an efficiency of " + shortest(kDieselEfficiency));
  draft.assume("heating_value_MJ_per_kg", kHeatingValue_MJ_kg, "diesel fuel");
  draft.assume("air_fuel_ratio", 14.5, "diesel fuel");
  draft.assume("burn_start_deg", burn.start_deg, "usual for this kind");
  draft.assume("burn_duration_deg", 20, "of what has mixed by then; the rest burns as it mixes");
  draft.assume("wiebe_m", 1, "usual for this kind");
  draft.assume("second_share", 0.7, "usual for this kind");
  draft.assume("second_m", 0.9, "usual for this kind");
  draft.assume("second_duration_ratio", 3.5, "usual for this kind");
}

}  // namespace crankloop::program
