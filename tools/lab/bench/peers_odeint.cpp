// Boost.odeint on the valve problem: only built where it is installed.
#include <array>

#include <boost/numeric/odeint.hpp>

#include "peers.hpp"

namespace crankloop::program::bench {
namespace {

namespace odeint = boost::numeric::odeint;
using State = std::array<double, 2>;

/// Its classical Runge-Kutta, a step per tick.
class Fixed final : public PeerValve {
 public:
  explicit Fixed(const ValveRun& run) : PeerValve{run} {}

 private:
  void advance(PlainState<double>& state) noexcept override {
    State x{state.lift_m, state.velocity_m_s};
    stepper_.do_step(
        [this](const State& at, State& slope, double t) {
          slope = {at[1], acceleration(at[0], at[1], t)};
        },
        x, 0.0, tick_s_);
    state = {x[0], x[1]};
  }
  odeint::runge_kutta4<State> stepper_;
};

/// Dormand-Prince with step control, within each tick.
class Controlled final : public PeerValve {
 public:
  Controlled(const ValveRun& run, double tolerance) : PeerValve{run}, tolerance_{tolerance}, first_s_{run.step_s} {}

 private:
  void advance(PlainState<double>& state) noexcept override {
    State x{state.lift_m, state.velocity_m_s};
    // An absolute tolerance would be far too wide for a lift in m: this one is relative to a millimetre and to a m/s.
    odeint::integrate_adaptive(
        odeint::make_controlled<odeint::runge_kutta_dopri5<State>>(tolerance_ * 1e-3, tolerance_),
        [this](const State& at, State& slope, double t) {
          slope = {at[1], acceleration(at[0], at[1], t)};
        },
        x, 0.0, tick_s_, first_s_);
    state = {x[0], x[1]};
  }
  double tolerance_;
  double first_s_;
};

}  // namespace

void add_odeint(std::vector<Peer>& peers) {
  peers.push_back({"odeint runge_kutta4", "", [](const ValveRun& run) { return std::make_shared<Fixed>(run); }});
  for (const double tolerance : {1e-3, 1e-6}) {
    peers.push_back({"odeint dopri5", tolerance > 1e-4 ? "tolerance 1e-3" : "tolerance 1e-6",
                     [tolerance](const ValveRun& run) { return std::make_shared<Controlled>(run, tolerance); }});
  }
}

}  // namespace crankloop::program::bench
