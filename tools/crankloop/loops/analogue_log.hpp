// An engine's variable reluctance sensor and its comparator, sample by sample: `--analogue F.csv`, `--cranking F.svg`.
//
// What belongs here: the samples of a run, and their file. What does not: how a sample comes about
// (tick/trigger/reluctor.hpp), the drawing (commands/run/cranking_sheet.cpp).
#pragma once

#include <memory>
#include <optional>
#include <vector>

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

/// The samples of a run for a drawing, as long as it has room: one second at 100 us.
struct AnalogueTrace {
  static constexpr std::size_t kMost = 160000;

  std::vector<double> time_s, voltage_V, level;
  std::vector<double> arms_V;       ///< beyond this the comparator was armed at the end of the sample's tick
  std::vector<double> tick_end_s;   ///< and
  std::vector<double> speed_rad_s;  ///< there
  std::vector<double> edges_s;      ///< rising ones
};

/// Follows a crank that another scene turns: the samples are those of a scene that asks for them.
template <class Real>
class AnalogueLog {
 public:
  /// The engine has a sensor. Writes to `csv` and into `trace` where they are not null.
  AnalogueLog(Output* csv, AnalogueTrace* trace, const EngineFile& file, const EngineDefinition& definition,
              double tick_s);

  /// A tick that began at `begin` with one speed and ended with the other.
  void take(double begin_s, Phase begin, Phase end, Real begin_rad_s, Real end_rad_s);

 private:
  using S = SensorAlone;

  std::optional<CsvWriter> csv_;
  AnalogueTrace* trace_;
  std::unique_ptr<detail::ReluctorTable<Real>> table_ = std::make_unique<detail::ReluctorTable<Real>>();
  Real tick_s_;
  Real cycles_per_tick_per_rad_s_;
  State<Real, S> state_{};
  crankloop::Output<Real, S> out_{};
};

}  // namespace crankloop::program
