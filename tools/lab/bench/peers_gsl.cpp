// The GNU Scientific Library on the valve problem: only built where it is installed.
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include "peers.hpp"

namespace crankloop::program::bench {
namespace {

/// Step control within each tick.
class Driven final : public PeerValve {
 public:
  Driven(const ValveRun& run, const gsl_odeiv2_step_type* type, double tolerance)
      : PeerValve{run},
        driver_{gsl_odeiv2_driver_alloc_y_new(&system_, type, run.step_s, tolerance * 1e-3, tolerance),
                gsl_odeiv2_driver_free} {}

 private:
  static int slopes(double t, const double* x, double* slope, void* self) {
    slope[0] = x[1];
    slope[1] = static_cast<const Driven*>(self)->acceleration(x[0], x[1], t);
    return GSL_SUCCESS;
  }

  void advance(PlainState<double>& state) noexcept override {
    double x[2] = {state.lift_m, state.velocity_m_s};
    double t = 0;
    gsl_odeiv2_driver_reset(driver_.get());
    gsl_odeiv2_driver_apply(driver_.get(), &t, tick_s_, x);
    state = {x[0], x[1]};
  }

  gsl_odeiv2_system system_{slopes, nullptr, 2, this};
  std::unique_ptr<gsl_odeiv2_driver, void (*)(gsl_odeiv2_driver*)> driver_;
};

}  // namespace

void add_gsl(std::vector<Peer>& peers) {
  const struct {
    const char* name;
    const gsl_odeiv2_step_type* type;
  } steppers[] = {{"GSL rkf45", gsl_odeiv2_step_rkf45}, {"GSL rk8pd", gsl_odeiv2_step_rk8pd}};
  for (const auto& stepper : steppers) {
    peers.push_back({stepper.name, "tolerance 1e-6",
                     [type = stepper.type](const ValveRun& run) { return std::make_shared<Driven>(run, type, 1e-6); }});
  }
}

}  // namespace crankloop::program::bench
