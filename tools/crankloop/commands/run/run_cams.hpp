// Columns of `run --csv` of what the cams bear, where the engine file has the width of a contact.
//
// What belongs here: names and values of the columns. What does not: the loads themselves (loops/cam_loads.hpp).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <crankloop/tabulate/valve_lift.hpp>

#include "../../engine_file/engine_file.hpp"
#include "../../files/csv.hpp"
#include "../../loops/cam_loads.hpp"
#include "../../loops/run_quantities.hpp"

namespace crankloop::program {

class CamColumns {
 public:
  explicit CamColumns(const EngineFile& file);

  [[nodiscard]] bool any() const noexcept { return any_; }

  /// Of each cylinder's cams, of the trains that have a width, and of the camshaft.
  void add_names(std::vector<std::string>& header) const;

  /// At an engine angle and a speed of the cams.
  template <class Real, class S>
  void write(CsvWriter& csv, double crank_deg, double cam_rad_s, const WholeOutput<Real, S>& out) const {
    double camshaft_Nm = 0;
    for (std::size_t k = 0; k < cylinders_; ++k) {
      for (std::size_t t = 0; t < trains_.size(); ++t) {
        const CamLoads loads =
            loads_at(t, k, crank_deg, cam_rad_s, static_cast<double>(out.valve_forces[t][k].train_N));
        camshaft_Nm += loads.torque_Nm * trains_[t].cams;
        if (!trains_[t].shown) continue;
        for (const double value : {loads.stress_Pa / 1e6, loads.sliding_m_s, loads.entrainment_m_s, loads.torque_Nm})
          csv.cell(static_cast<Real>(value));
      }
    }
    csv.cell(static_cast<Real>(camshaft_Nm));
  }

 private:
  struct Train {
    std::string name;
    std::unique_ptr<ValveLift> lift;
    CamContact contact;
    double full_lift_deg;
    int cams;  ///< alike in a cylinder
    bool shown;
  };

  [[nodiscard]] CamLoads loads_at(std::size_t train, std::size_t cylinder, double crank_deg, double cam_rad_s,
                                  double train_N) const;

  const Layout& layout_;
  std::size_t cylinders_;
  std::vector<Train> trains_;
  bool any_ = false;
};

}  // namespace crankloop::program
