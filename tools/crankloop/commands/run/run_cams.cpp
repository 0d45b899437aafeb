#include "run_cams.hpp"

#include "../../files/units.hpp"
#include "../../loops/run_valves.hpp"

namespace crankloop::program {

CamColumns::CamColumns(const EngineFile& file)
    : layout_{file.definition().layout}, cylinders_{static_cast<std::size_t>(layout_.cylinders)} {
  const EngineDefinition& definition = file.definition();
  const std::vector<std::string> names = names_of_trains(file);
  for (std::size_t t = 0; t < names.size(); ++t) {
    const ValveTrain& train = definition.trains[t];
    auto lift = std::make_unique<ValveLift>();
    static_cast<void>(lift->init(train.cam, train.rocker));  // the loop refuses what this does
    const bool shown = definition.contacts[t].width_m > 0;
    trains_.push_back(
        {names[t], std::move(lift), definition.contacts[t], train.cam.full_lift_deg, train.valve.per_cylinder, shown});
    any_ = any_ || shown;
  }
}

void CamColumns::add_names(std::vector<std::string>& header) const {
  for (std::size_t k = 1; k <= cylinders_; ++k) {
    for (const Train& train : trains_) {
      if (!train.shown) continue;
      for (const char* name : {"contact_stress_MPa", "sliding_m_s", "entrainment_m_s", "cam_torque_Nm"})
        header.push_back("c" + std::to_string(k) + "_" + train.name + "_" + name);
    }
  }
  header.push_back("camshaft_torque_Nm");
}

CamLoads CamColumns::loads_at(std::size_t train, std::size_t cylinder, double crank_deg, double cam_rad_s,
                              double train_N) const {
  const Train& of = trains_[train];
  const double cam_deg = (crank_deg - layout_.firing_deg[cylinder] - of.full_lift_deg) / 2;
  return cam_loads_at(*of.lift, of.contact, cam_deg * kRadPerDeg, cam_rad_s, train_N);
}

}  // namespace crankloop::program
