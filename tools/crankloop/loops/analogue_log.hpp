// `--analogue F.csv`: the voltage of the engine's variable reluctance sensor and its comparator, sample by sample.
//
// What belongs here: that file. What does not: how a sample comes about (tick/trigger/reluctor.hpp).
#pragma once

#include <memory>

#include <crankloop/tabulate/tabulate.hpp>
#include <crankloop/tick/trigger/triggers_step.hpp>

#include "../engine_file/engine_file.hpp"
#include "../files/csv.hpp"
#include "../files/output_file.hpp"

namespace crankloop::program {

/// What a scene asks for that shows the sensor alone.
struct SensorAlone : Scene {
  static constexpr CrankGiven crank = CrankGiven::torque;
  static constexpr Count cylinders = up_to<kMaxCylinders>;
  static constexpr Count triggers = up_to<kMaxTriggerWheels>;
  static constexpr std::uint32_t reluctor_samples = 16;
  static constexpr std::uint32_t trigger_edges = 16;  // no more edges than samples
};

/// Follows a crank that another scene turns: the samples are those of a scene that asks for them.
template <class Real>
class AnalogueLog {
 public:
  /// The engine has a sensor.
  AnalogueLog(Output& out, const EngineFile& file, const EngineDefinition& definition, double tick_s);

  /// A tick that began at `begin` with one speed and ended with the other.
  void take(double begin_s, Phase begin, Phase end, Real begin_rad_s, Real end_rad_s);

 private:
  using S = SensorAlone;

  CsvWriter csv_;
  std::unique_ptr<detail::ReluctorTable<Real>> table_ = std::make_unique<detail::ReluctorTable<Real>>();
  Real tick_s_;
  Real cycles_per_tick_per_rad_s_;
  State<Real, S> state_{};
  crankloop::Output<Real, S> out_{};
};

}  // namespace crankloop::program
