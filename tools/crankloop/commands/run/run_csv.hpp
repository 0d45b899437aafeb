// The rows of `run --csv`: a line per tick.
//
// What belongs here: names and values of the columns. What does not: the loop (run.cpp), columns of gas and cams
// (loops/run_gas.hpp, run_cams.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "../../files/csv.hpp"
#include "../../loops/run_gas.hpp"
#include "../../loops/run_loop.hpp"
#include "../../loops/run_quantities.hpp"
#include "run_cams.hpp"

namespace crankloop::program {

inline std::vector<std::string> csv_header(const EngineDefinition& engine, const std::vector<std::string>& trains,
                                           const CamColumns& cams) {
  const int cylinders = engine.layout.cylinders;
  std::vector<std::string> header{"time_s", "crank_deg", "speed_rpm", "torque_Nm", "mean_torque_Nm"};
  for (int k = 1; k <= cylinders; ++k) {
    for (std::size_t i = 0; i < kCsvQuantities; ++i) {
      header.push_back("c" + std::to_string(k) + "_" + kQuantityKinds[i].name + "_" + kQuantityKinds[i].suffix);
    }
  }
  for (int k = 1; k <= cylinders; ++k) {
    for (const std::string& train : trains) {
      const std::string valve = "c" + std::to_string(k) + "_" + train + "_";
      for (const ValveQuantityKind& kind : kValveQuantityKinds) header.push_back(valve + kind.name + "_" + kind.suffix);
      header.push_back(valve + "regime");
    }
  }
  if (breathes(engine)) add_gas_columns(header, engine);
  if (cams.any()) cams.add_names(header);
  return header;
}

template <class Real, class S>
void write_row(CsvWriter& csv, const EngineDefinition& definition, const Operation& operation, std::uint64_t tick,
               double crank_deg, const WholeOutput<Real, S>& out, const CamColumns& cams) {
  const Layout& layout = definition.layout;
  csv.cell(static_cast<double>(tick) * operation.tick_s);
  csv.cell(crank_deg);
  csv.cell(operation.speed_rpm);
  csv.cell(out.torque_Nm);
  csv.cell(out.mean_torque_Nm);
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    const QuantityValues<Real> values = values_of(out, layout, k);
    for (std::size_t i = 0; i < kCsvQuantities; ++i) csv.cell(values[i] * static_cast<Real>(kQuantityKinds[i].per_si));
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(layout.cylinders); ++k) {
    for (std::size_t t = 0; t < static_cast<std::size_t>(definition.train_count); ++t) {
      const auto values = values_of(out, t, k);
      for (std::size_t i = 0; i < kValveQuantities; ++i)
        csv.cell(values[i] * static_cast<Real>(kValveQuantityKinds[i].per_si));
      csv.cell(static_cast<int>(out.valve_forces[t][k].regime));
    }
  }
  if constexpr (detail::Needs<S>::gas) write_gas(csv, out, definition);
  if (cams.any()) cams.write<Real, S>(csv, crank_deg, operation.speed_rad_s() / 2, out);
  csv.end_row();
}

}  // namespace crankloop::program
