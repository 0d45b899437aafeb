// The scenes whose FMUs are tested, by name, and the engine that each must equal bit by bit.
#pragma once

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <crankloop/variables.hpp>

#include "bouncing_valve.hpp"
#include "breathing_free.hpp"
#include "four_pistons.hpp"
#include "free_running.hpp"
#include "measured_motion.hpp"
#include "torque_by_pressure.hpp"
#include "torque_by_table.hpp"
#include "trigger_wheels.hpp"
#include "whole.hpp"

namespace fmu {

/// NAME of crankloop_add_scene, its engine, its tick.
#define FMU_SCENE(NAME, TICK_US)                     \
  struct Of_##NAME {                                 \
    using Engine = NAME::Engine;                     \
    using Real = NAME::Real;                         \
    using Scene = NAME::Scene;                       \
    static constexpr const char* kName = #NAME;      \
    static constexpr double kTick_s = TICK_US / 1e6; \
  }
FMU_SCENE(whole, 100);
FMU_SCENE(free_running, 100);
FMU_SCENE(breathing_free, 50);
FMU_SCENE(measured_motion, 50);
FMU_SCENE(torque_by_table, 100);
FMU_SCENE(torque_by_pressure, 100);
FMU_SCENE(four_pistons, 62.5);
FMU_SCENE(trigger_wheels, 100);
FMU_SCENE(bouncing_valve, 20);
#undef FMU_SCENE

/// What the importer gives an input in its step `k`, a driver's hands: speed up and down through zero, valves that
/// bounce, a starter, cut cylinders, and bad numbers now and then.
inline double input_at(const std::string& name, long k, double step_s) {
  const bool bad = k % 997 == 996;
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const double second = static_cast<double>(k) * step_s;
  if (name == "speed_rad_s") return bad ? nothing : 900 * std::sin(second * 3);
  if (name == "crank_deg") return std::fmod(40 * second * 360 + (k % 5000 == 4999 ? 90 : 0), 720);
  if (name == "external_torque_Nm") return bad ? 1e300 : 20 * std::sin(second);
  if (name == "load_ratio") return k % 3 == 0 ? 1 : 0.25;
  if (name.compare(0, 8, "pressure") == 0)
    return k % 1001 == 1000 ? -1 : 1e5 * (1 + static_cast<double>((k + name[12]) % 40));
  if (name.compare(0, 9, "cam_phase") == 0) return bad ? 200 : 15 * std::sin(second * 5);
  if (name == "starter") return second < 0.3 ? 1 : 0;
  if (name == "cut_cylinders") return static_cast<double>(k / 100 % 4);
  if (name == "wheel_faults") return static_cast<double>(k / 70 % 4);
  if (name == "sensor_faults") return static_cast<double>(k / 90 % 4);
  if (name == "by_spark_advance") return static_cast<double>(k / 400 % 2);
  if (name.compare(0, 13, "spark_advance") == 0) return k % 900 == 899 ? 91 : 20 + 25 * std::sin(second);
  if (name == "throttle_ratio") return bad ? -1 : 0.5 - 0.5 * std::cos(second * 2);
  if (name.compare(0, 7, "fuel_kg") == 0) return bad ? nothing : 1e-5 * static_cast<double>(k / 50 % 4);
  if (name.compare(0, 16, "excess_air_ratio") == 0) return bad ? -1 : static_cast<double>(k / 80 % 3);
  if (name == "ambient_Pa" || name == "back_Pa") return bad ? 1 : k % 3 == 0 ? 0 : 1e5 + 2e4 * std::sin(second);
  if (name == "ambient_K") return bad ? nothing : k % 5 == 0 ? 0 : 290;
  if (name.compare(0, 10, "burn_start") == 0) return k % 700 == 699 ? 61 : -20 + 30 * std::sin(second);
  if (name.compare(0, 13, "burn_duration") == 0) return 50;
  ADD_FAILURE() << "no input " << name;
  return 0;
}

inline crankloop::Phase phase_at(double crank_deg) { return crankloop::Phase::from_cycles(crank_deg / 720); }

/// "valve[1,2].lift_m" for the variable that the list calls "valve[#,#].lift_m" at 0, 1.
inline std::string indexed(const crankloop::detail::Variable& variable) {
  std::string name = variable.name;
  for (const std::uint32_t index : {variable.first, variable.second}) {
    const auto at = name.find('#');
    if (at != std::string::npos) name.replace(at, 1, std::to_string(index + 1));
  }
  return name;
}

/// A scene's engine, driven directly.
template <class Of>
class Direct {
 public:
  using Real = typename Of::Real;
  using S = typename Of::Scene;

  explicit Direct(double start_deg = 0, double start_rad_s = 0) : engine(phase_at(start_deg)) {
    shape = crankloop::detail::shape_of<Real, S>(*engine.tables());
    if constexpr (crankloop::detail::Needs<S>::crank_dynamics) {
      EXPECT_TRUE(engine.restore(crankloop::turning_at<Real, S>(engine.state(), static_cast<Real>(start_rad_s))).ok());
    }
  }
  void step(long k, double step_s, int ticks) {
    typename Of::Engine::Input in;
    crankloop::detail::each_input<S>([&](const crankloop::detail::Variable& variable,
                                         auto& value) { give(value, input_at(indexed(variable), k, step_s)); },
                                     in, shape);
    faults = 0;
    for (int i = 0; i < ticks; ++i) {
      faults |= engine.step(in).faults;
      if (engine.output().faults != 0) ++fault_ticks;
    }
  }
  [[nodiscard]] std::map<std::string, double> outputs() const {
    std::map<std::string, double> all;
    crankloop::detail::each_output<S>(
        [&](const crankloop::detail::Variable& variable, const auto& value) {
          if constexpr (std::is_same_v<decltype(value), const crankloop::Phase&>) {
            // 53 bits of 64, by another way than the FMU's: compared to a billionth, not bit by bit
            all[indexed(variable)] = std::ldexp(static_cast<double>(value.units() >> 11), -53) * 720;
          } else {
            all[indexed(variable)] = static_cast<double>(value);
          }
        },
        engine.state(), engine.output(), shape);
    all["faults"] = faults;
    all["fault_ticks"] = fault_ticks;
    return all;
  }

  typename Of::Engine engine;
  crankloop::detail::EngineShape shape{};
  std::uint32_t faults = 0;
  std::uint32_t fault_ticks = 0;

 private:
  template <class Value>
  static void give(Value& to, double number) {
    if constexpr (std::is_same_v<Value, crankloop::Phase>) {
      to = phase_at(number);
    } else {
      to = static_cast<Value>(number);
    }
  }
};

/// The same bits; a NaN equals a NaN.
inline bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace fmu
