// The engine file that `crankloop new` writes: lines with their reason, and its sections.
//
// What belongs here: what a line looks like, and one function a section or group of them. What does not: usual values
// and their sources (usual_engine.hpp), the format of engine files (engine_file/).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include <crankloop/define/layout.hpp>
#include <crankloop/tabulate/indicator_diagram.hpp>

#include "../../command_line/arguments.hpp"
#include "../../files/number.hpp"
#include "usual_engine.hpp"

namespace crankloop::program {

/// What an assumption is rounded to.
[[nodiscard]] inline double to_three_digits(double value) {
  const double place = last_place(value, 3);
  return parse_number(brief(std::round(value / place) * place)).value;
}

/// Writes the file: each line states the source of its value.
class Draft {
 public:
  explicit Draft(const Arguments& arguments) : arguments_{arguments} {}

  void section(const char* title) { text_ += std::string("\n[") + title + "]\n"; }
  void line(const char* key, const std::string& value, const std::string& remark) {
    std::string line = std::string(key) + " = " + value;
    line.resize(std::max(line.size() + 2, kRemarkColumn), ' ');
    text_ += line + "# " + remark + "\n";
  }
  void assume(const char* key, double value, const std::string& why) { line(key, shortest(value), "assumed: " + why); }

  /// The option's value if it is given; else the assumed one, to three digits.
  double number(const char* key, const char* option, double usual, const std::string& why) {
    if (!arguments_.has(option)) {
      usual = to_three_digits(usual);
      assume(key, usual, why);
      return usual;
    }
    line(key, shortest(arguments_.number(option)), "given");
    return arguments_.number(option);
  }

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  static constexpr std::size_t kRemarkColumn = 36;
  const Arguments& arguments_;
  std::string text_;
};

/// Values that several sections use.
struct Numbers {
  EngineDesign design;
  int cylinders = 0;
  double bore_mm = 0;
  double stroke_mm = 0;
  double rated_rpm = 0;
  double displacement_L = 0;  ///< of all cylinders
  double compression_ratio = 0;
  double net_mep_kPa = 0;
  double brake_Nm = 0;
  std::optional<GasExchange> gas{};  ///< where the pressure follows from it

  [[nodiscard]] double piston_speed_m_s() const noexcept { return stroke_mm * rated_rpm / 30e3; }
  [[nodiscard]] bool is_boosted() const noexcept { return design.pressure_ratio > 1; }
};

// ---- the crankshaft: draft_crankshaft.cpp

/// [engine] and [crank].
void add_crank(Draft& draft, const Arguments& arguments, Numbers& n);
void add_masses_and_layout(Draft& draft, const Arguments& arguments, const Numbers& n);

/// The places of the cylinders of such a layout, behind it.
void add_places(Draft& draft, const Layout& layout, const Numbers& n);

/// [friction], [machine] and [starter]; `diagram` follows from the sections above.
void add_what_turns_it(Draft& draft, const IndicatorDiagram& diagram, Numbers& n);

// ---- the cylinder: draft_pressure.cpp

/// [pressure] of an engine with a synthesised diagram.
void add_pressure(Draft& draft, Numbers& n);

/// [pressure] and [gas] of an engine whose pressure follows from its gas exchange, in place of add_pressure's.
void add_gas_exchange(Draft& draft, const Numbers& n);

// ---- the valves: draft_trains.cpp

/// A direct train: a bucket between cam and valve. The spring has a usual preload, or more where it needs that to keep
/// them in contact up to about 1.3 times the rated speed, from the inertia force at the nose.
void add_train(Draft& draft, const char* name, double full_lift_deg, const Numbers& n);
void add_triggers(Draft& draft);

}  // namespace crankloop::program
