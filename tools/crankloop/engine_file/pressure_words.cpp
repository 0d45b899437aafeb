#include "pressure_words.hpp"

#include "../files/units.hpp"
#include "../report/text.hpp"

namespace crankloop::program {
namespace {

using report::number_text;

bool is_motored(const GasOrder& gas) { return gas.excess_air_ratio <= 0 && gas.fuel_kg <= 0; }

std::string fuel_in_words(const GasOrder& gas, bool varied) {
  if (varied) return "varied fuel";
  if (is_motored(gas)) return "no fuel";
  if (gas.excess_air_ratio > 0)
    return "fuel by the air in each cylinder at lambda " + number_text(gas.excess_air_ratio);
  return number_text(gas.fuel_kg * 1e6) + " mg of fuel per cylinder and cycle";
}

bool has_runners(const Gas& gas) { return gas.intake_runner.any() || gas.exhaust_runner.any(); }

/// What the engine's pressures lack.
std::string not_modelled(const Gas& gas) {
  return std::string(" Not modelled: pressure waves in pipes") +
         (has_runners(gas) ? " beyond the first mode of the runners" : " and the tuning they bring") +
         ", fuel evaporation, two zones, dissociation" + (gas.crevice.any() ? "" : ", crevices and blow-by") +
         ", swirl, cycle-to-cycle variation, turbochargers, layers of backflow in a port.";
}

std::string burn_in_words(const Gas& definition, const GasOrder& gas) {
  const std::string duration = number_text(gas.burn_duration_deg * definition.span_ratio());
  if (!definition.charge_burn.in_use)
    return "from " + number_text(gas.burn_start_deg) + " deg for " + duration + " deg";
  return "from a spark at " + number_text(gas.burn_start_deg) + " deg for as long as the charge makes it, " + duration +
         " deg in the state of reference";
}

}  // namespace

std::string pressure_in_words(const EngineFile& file, double load_ratio, const GasOrder& gas,
                              double GasOrder::*varied) {
  const Pressure& p = file.definition().pressure;
  const std::string load = load_ratio == 1 ? ""
                                           : " Load ratio " + number_text(load_ratio) +
                                                 ": that share of what combustion adds to the motored pressure.";
  const auto from_file = [&](const char* over) {
    return "The cylinder pressure is the table " + file.section("pressure").text("file") + ", given over the " + over +
           "." + load;
  };
  const bool fuel_varies = varied == &GasOrder::fuel_kg;
  switch (p.source) {
    case PressureSource::gas:
      return "The cylinder pressure is not given: it follows from what the cylinders hold, by gas exchange through the "
             "valves as they move, compression, heat release and wall heat. Throttle " +
             (varied == &GasOrder::throttle_ratio ? "varied" : number_text(gas.throttle_ratio)) + ", " +
             fuel_in_words(gas, fuel_varies) +
             (is_motored(gas) && !fuel_varies ? "" : ", burning " + burn_in_words(file.definition().gas, gas)) + "." +
             not_modelled(file.definition().gas);
    case PressureSource::none:
      return "There is no pressure source: gas forces are zero, and all forces and torques are those of the masses "
             "alone.";
    case PressureSource::angle_table:
      return from_file("crank angle");
    case PressureSource::volume_table:
      return from_file("cylinder volume");
    case PressureSource::wiebe:
      break;
  }
  const WiebeDiagram& w = p.wiebe;
  const std::string heat = w.heat_given ? "a heat of " + number_text(w.heat_J, 5) + " J per cycle and cylinder"
                                        : "a net IMEP of " + number_text(w.net_mep_Pa * kKilo, 6) + " kPa";
  return "The cylinder pressure is not measured: it is synthesised with " + heat +
         ", by a Wiebe heat release of form exponent " + number_text(w.wiebe_m) + " over " +
         number_text(w.combustion_duration_deg) + " deg from " + number_text(w.start_of_combustion_deg) +
         " deg, between polytropes of exponents " + number_text(w.compression_exponent) + " and " +
         number_text(w.expansion_exponent) + "; without combustion it would expand by " +
         number_text(w.motored_exponent()) + "." + load;
}

std::string pressure_in_short(const EngineFile& file) {
  switch (file.definition().pressure.source) {
    case PressureSource::none:
      return "no cylinder pressure: masses alone";
    case PressureSource::gas:
      return std::string("cylinder pressure: by gas exchange, one zone; ") +
             (has_runners(file.definition().gas) ? "pressure waves: the first mode of runners" : "no pressure waves");
    case PressureSource::wiebe:
      return "cylinder pressure: synthesised, not measured";
    default:
      return "cylinder pressure: the table " + file.section("pressure").text("file");
  }
}

}  // namespace crankloop::program
