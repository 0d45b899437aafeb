// What a train's cam bears: stress, sliding and rolling of its contact, torque. Exact, from the force that a tick
// shows.
//
// What belongs here: loads at a cam angle, their extremes over a cycle, their lines of a summary. What does not: the
// tick's own (tick/valve/cam_contact.hpp), drawings.
#pragma once

#include <string>
#include <vector>

#include <crankloop/tabulate/cam_contact.hpp>
#include <crankloop/tabulate/valve_lift.hpp>

#include "../command_line/summary.hpp"
#include "../engine_file/engine_file.hpp"

namespace crankloop::program {

/// Of one cam, in SI: docs/model.md "Cam contact" and "Camshaft torque". All 0 where the train carries nothing.
struct CamLoads {
  double stress_Pa = 0;  ///< 0 too where the width is not known, as is the half width
  double half_width_m = 0;
  double sliding_m_s = 0;
  double entrainment_m_s = 0;
  double torque_Nm = 0;  ///< positive against forward rotation, friction included
};

[[nodiscard]] CamLoads cam_loads_at(const ValveLift& lift, const CamContact& contact, double cam_rad, double cam_rad_s,
                                    double train_N);

/// Stress of rigid parts at standstill, under the spring alone: its largest, and where. All 0 where the width is not
/// known.
struct StaticStress {
  double largest_Pa = 0;
  double cam_deg = 0;  ///< from full lift
};
[[nodiscard]] StaticStress static_stress(const ValveLift& lift, const ValveTrain& train, const CamContact& contact);

/// Extremes over a cycle, each with its cam angle from full lift, and the mean power.
class CamLoadsOfCycle {
 public:
  struct At {
    double value = 0;
    double cam_deg = 0;
  };

  /// `limit_Pa` of the stress; 0: none.
  explicit CamLoadsOfCycle(double limit_Pa) : limit_Pa_{limit_Pa} {}

  /// In the order of time.
  void add(double cam_deg, const CamLoads& loads);

  [[nodiscard]] const At& stress() const noexcept { return stress_; }
  [[nodiscard]] const At& half_width() const noexcept { return half_width_; }
  [[nodiscard]] const At& sliding() const noexcept { return sliding_; }  ///< fastest in contact, with its sign
  [[nodiscard]] const At& least_entrainment() const noexcept { return least_entrainment_; }  ///< in contact
  [[nodiscard]] const At& largest_entrainment() const noexcept { return largest_entrainment_; }
  [[nodiscard]] const At& largest_torque() const noexcept { return largest_torque_; }
  [[nodiscard]] const At& least_torque() const noexcept { return least_torque_; }
  [[nodiscard]] double mean_torque_Nm() const noexcept;
  [[nodiscard]] bool passes_limit() const noexcept { return passed_; }
  /// ", below limit_MPa = 1200" or ", passes limit_MPa = 900 from -20 to 31 deg"; "" without a limit.
  [[nodiscard]] std::string limit_in_words() const;

 private:
  double limit_Pa_;
  At stress_, half_width_, sliding_, least_entrainment_, largest_entrainment_, largest_torque_, least_torque_;
  bool in_contact_ = false;  ///< in any tick so far
  bool passed_ = false;
  double passed_from_deg_ = 0, passed_to_deg_ = 0;
  double work_deg_ = 0;  ///< integral of the torque
  double turned_deg_ = 0;
  bool began_ = false;
  double last_deg_ = 0, last_Nm_ = 0;
};

/// Lines of a summary.
void add_cam_loads(Summary& s, const TrainOfFile& train, const StaticStress& at_rest, const CamLoadsOfCycle& cycle,
                   double cam_rad_s);

}  // namespace crankloop::program
