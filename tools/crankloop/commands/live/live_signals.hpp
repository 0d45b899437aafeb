// The signals of the block by name: what a controller's sensors see, and what a test bench wants to know beside.
//
// What belongs here: the one list, from which names and numbers are written. What does not: the block (port/linux).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <crankloop/fmi/name.hpp>
#include <crankloop/variable_values.hpp>

#include "../../files/units.hpp"
#include "live_scenes.hpp"
#include "port/linux/locked_numbers.hpp"

namespace crankloop::program {

/// Calls visit(variable, number) for each, as they are at the end of a tick. Names that the list of variables has are
/// that list's.
template <class Real, class S, class Visit>
void each_signal(Visit&& visit, const crankloop::Output<Real, S>& out, const State<Real, S>& state,
                 const detail::EngineShape& shape) {
  using detail::real;
  const double crank_deg = detail::degrees_of(state.phase);
  visit(real("crank_deg", "0 to below 720, from cylinder 1's firing top dead centre"), crank_deg);
  visit(real("cam_deg", "0 to below 360: half the crank's, without phasers"), crank_deg / 2);
  for (std::uint32_t w = 0; w < shape.wheels; ++w)
    visit(detail::truth("trigger[#].level", "Level of the signal").at(w), static_cast<double>(out.trigger[w].level));
  for (std::uint32_t w = 0; w < shape.wheels; ++w)
    visit(detail::truth("faulty_trigger[#].level", "As a controller sees it").at(w),
          static_cast<double>(out.faulty_trigger[w].level));
  visit(detail::whole("wheel_faults_on", "Bit i-1: fault i of the wheels is on"),
        static_cast<double>(out.wheel_faults_on));
  for (std::uint32_t k = 0; k < shape.cylinders; ++k) {
    if constexpr (detail::Needs<S>::gas) {
      visit(real("cylinder_gas[#].pressure_Pa", "Absolute pressure").at(k),
            static_cast<double>(out.cylinder_gas[k].pressure_Pa));
    } else {
      visit(real("cylinder[#].pressure_Pa", "Absolute pressure").at(k),
            static_cast<double>(out.cylinder[k].pressure_Pa));
    }
  }
  for (std::uint32_t t = 0; t < shape.trains; ++t) {
    for (std::uint32_t k = 0; k < shape.cylinders; ++k)
      visit(real("valve[#,#].lift_m", "Lift of train and cylinder").at(t, k),
            static_cast<double>(out.valve[t][k].lift_m));
  }
  for (std::uint32_t t = 0; t < shape.trains; ++t)
    visit(real("cam_phase_deg[#]", "Of a train's phaser, crank degrees later than defined").at(t),
          static_cast<double>(static_cast<std::int64_t>(state.cam_phase[t])) * kDegPerUnit);
  if constexpr (detail::Needs<S>::manifolds) {
    visit(real("intake.pressure_Pa", "In the intake manifold"), static_cast<double>(out.manifold[kIntake].pressure_Pa));
    visit(real("exhaust.pressure_Pa", "In the exhaust manifold"),
          static_cast<double>(out.manifold[kExhaust].pressure_Pa));
  }
  if constexpr (S::controller_names) {
    visit(real("map_Pa", "In the intake manifold"), static_cast<double>(out.manifold[kIntake].pressure_Pa));
    visit(real("intake_air_K", "In the intake manifold"), static_cast<double>(out.manifold[kIntake].temperature_K));
    visit(real("tps_ratio", "Throttle"), static_cast<double>(state.throttle_ratio));
    for (std::uint32_t k = 0; k < shape.cylinders; ++k)
      visit(real("lambda[#]", "Of a cylinder's last cycle").at(k),
            static_cast<double>(out.gas_cycle[k].excess_air_ratio));
    visit(real("sensor_lambda", "At the lambda sensor; 100: air; 0: no sensor"),
          static_cast<double>(out.sensor_excess_air_ratio));
    visit(real("coolant_K", "0: none"), static_cast<double>(out.coolant_K));
    const char* const faulty[] = {"faulty_map_Pa", "faulty_intake_air_K", "faulty_tps_ratio", "faulty_sensor_lambda",
                                  "faulty_coolant_K"};
    for (int i = 0; i < kControllerSensors; ++i)
      visit(real(faulty[i], "As a controller reads it"), static_cast<double>(out.faulty_sensor[i]));
    visit(detail::whole("sensor_faults_on", "Bit i-1: fault i of the sensors is on"),
          static_cast<double>(out.sensor_faults_on));
  }
  visit(detail::whole("faults", "The tick's fault bits"), static_cast<double>(out.faults));
}

/// Wheels twice, cylinders twice, valves, phasers, and eighteen more.
static_assert(2 * kMaxTriggerWheels + 2 * kMaxCylinders + kMaxTrains * kMaxCylinders + kMaxTrains + 18 <=
              port::kMaxLiveNumbers);

template <class Real, class S>
[[nodiscard]] std::vector<std::string> signal_names(const detail::EngineShape& shape) {
  std::vector<std::string> names;
  each_signal([&names](const detail::Variable& variable, double) { names.push_back(fmi::name_of(variable)); },
              crankloop::Output<Real, S>{}, State<Real, S>{}, shape);
  return names;
}

template <class Real, class S>
void write_signals(const crankloop::Output<Real, S>& out, const State<Real, S>& state, const detail::EngineShape& shape,
                   port::LiveNumbers& numbers) noexcept {
  std::size_t i = 0;
  each_signal([&](const detail::Variable&, double number) { numbers[i++] = number; }, out, state, shape);
}

}  // namespace crankloop::program
