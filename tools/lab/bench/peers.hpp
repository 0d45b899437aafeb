// Other solvers on the valve problem, if they are installed: Boost.odeint (libboost-dev) and GSL (libgsl-dev). Both are
// optional.
//
// What belongs here: the equation and the tick, which all of them receive. What does not: the solvers
// (peers_odeint.cpp, peers_gsl.cpp).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "valve_methods.hpp"

namespace crankloop::program::bench {

/// The 125's valve from tick to tick, in double, with the library's cam. A solver chooses its steps within a tick, and
/// must end at the tick's end.
class PeerValve : public PlainLoop<double, CurveCam<double>> {
 public:
  virtual ~PeerValve() = default;

  void step() noexcept {
    advance(state_);
    phase_ += Phase{increment_};
    keep(state_);
  }

 protected:
  explicit PeerValve(const ValveRun& run)
      : PlainLoop{run},
        tick_s_{run.step_s},
        units_per_s_{static_cast<double>(increment_) / run.step_s},
        per_mass_{1 / body_.mass_kg} {}

  /// y'' at a time since the tick's start.
  [[nodiscard]] double acceleration(double y, double v, double since_s) const noexcept {
    const auto units = static_cast<std::uint64_t>(since_s * units_per_s_);
    return plain_acceleration(body_, per_mass_, y, v, cam_.at(phase_.units() + units, deg_per_s_));
  }

  double tick_s_;

 private:
  virtual void advance(PlainState<double>& state) noexcept = 0;

  double units_per_s_;
  double per_mass_;
};

struct Peer {
  std::string contestant;
  std::string setting;  ///< "tolerance 1e-6", or empty
  std::function<std::shared_ptr<PeerValve>(const ValveRun&)> make;
};

/// The solvers that this program was built with.
[[nodiscard]] std::vector<Peer> peers();

void add_odeint(std::vector<Peer>& peers);
void add_gsl(std::vector<Peer>& peers);

}  // namespace crankloop::program::bench
