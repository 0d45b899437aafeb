#include "kernels.hpp"

#include <memory>

#include "crankloop/files/error.hpp"
#include "crankloop/files/words.hpp"
#include "groups.hpp"
#include "tick_engines.hpp"

namespace crankloop::program::bench {
namespace {

template <class Real>
std::function<void(int)> motion() {
  const auto method = std::make_shared<const LibraryMotion<Real>>(diesel_495_crank());
  return [method](int ticks) {
    std::uint64_t phase = 0;
    for (int i = 0; i < ticks; ++i) keep(method->at(phase += 0x0123'4567'89AB'CDEFu));
  };
}

template <class Real>
std::function<void(int)> valve(double engine_rpm, double tick_s, Integrator integrator) {
  const auto one = std::make_shared<LibraryValve<Real, LoneElastic>>(ValveRun{engine_rpm, tick_s, {integrator}});
  one->start(Phase{});
  return [one](int ticks) {
    for (int i = 0; i < ticks; ++i) one->step();
  };
}

template <class Real, class S>
std::function<void(int)> engine(int trains, const Operation& operation) {
  const auto four = std::make_shared<LibraryEngine<Real, S>>(engine_of(4, trains), operation);
  return [four](int ticks) {
    for (int i = 0; i < ticks; ++i) four->tick();
  };
}

}  // namespace

const std::vector<Kernel>& kernels() {
  static const Operation rated{kRated_rpm};
  static const Operation rated_100{kRated_rpm, 100e-6};
  static const std::vector<Kernel> all{
      {"motion-float", [] { return motion<float>(); }},
      {"motion-double", [] { return motion<double>(); }},
      {"bouncing-valve-rk4-float", [] { return valve<float>(kBouncing_rpm, 10e-6, Integrator::rk4); }},
      {"bouncing-valve-exponential-float", [] { return valve<float>(kBouncing_rpm, 10e-6, Integrator::exponential); }},
      {"bouncing-valve-exponential-double",
       [] { return valve<double>(kBouncing_rpm, 10e-6, Integrator::exponential); }},
      {"smooth-valve-rk4-float", [] { return valve<float>(kSmooth_rpm, 20e-6, Integrator::rk4); }},
      {"torque-float", [] { return engine<float, FourTorque>(0, rated); }},
      {"torque-motion-float", [] { return engine<float, FourMotion>(0, rated); }},
      {"torque-motion-forces-float", [] { return engine<float, FourForces>(0, rated); }},
      {"8-following-valves-float", [] { return engine<float, FourFollowing<2>>(2, rated); }},
      {"8-valves-float", [] { return engine<float, FourElastic<2>>(2, rated); }},
      {"8-valves-100us-float", [] { return engine<float, FourElastic<2>>(2, rated_100); }},
      {"8-valves-double", [] { return engine<double, FourElastic<2>>(2, rated); }},
      {"16-valves-float", [] { return engine<float, FourElastic<4>>(4, rated); }},
      {"8-valves-forces-results-float", [] { return engine<float, FourElasticResults>(2, rated); }},
      {"8-valves-any-engine-float", [] { return engine<float, AnyElastic>(2, rated); }},
  };
  return all;
}

void run_kernel(const std::string& name, int ticks) {
  std::vector<std::string> names;
  for (const Kernel& kernel : kernels()) {
    if (kernel.name == name) return kernel.make()(ticks);
    names.emplace_back(kernel.name);
  }
  throw UsageError("unknown kernel " + in_quotes(name) + "; kernels: " + join(names));
}

}  // namespace crankloop::program::bench
