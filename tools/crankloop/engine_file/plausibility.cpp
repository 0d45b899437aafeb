#include "plausibility.hpp"

#include <initializer_list>
#include <optional>
#include <string_view>

#include "../files/words.hpp"
#include "plausibility_parts.hpp"

namespace crankloop::program {
namespace {

void look_at_value(const Value& value, const EngineSize& size, Warnings& warnings) {
  const UsualRange* const range = usual_range_of(*value.key);
  if (range == nullptr || value.line == 0 || !value.used) return;
  const std::optional<double> per = size.of(range->per);
  const double given = value.numbers.at(0);
  if (!per || (range->zero && given == 0) || within(range->usual, given / *per)) return;
  const std::string unit = unit_in_words(value.key->unit.name);
  warnings.add(value.line, std::string(value.key->name) + " = " + brief(given) + " is unusual; usual: " +
                               about(range->usual.least * *per) + " to " + about(range->usual.most * *per) +
                               (unit.empty() ? "" : " " + unit) + in_words(range->per));
}

/// Compares each value with engines of this size.
void look_at_values(const EngineFile& engine, EngineSize size, bool metres, Warnings& warnings) {
  if (engine.has("engine") && size.stroke_mm) {
    const double piston_m_s = engine.rated_rpm() / *size.of(Per::piston_speed);
    const Value* const rated = engine.section("engine").find("rated_rpm");
    if (within(usual_range_of(*rated->key)->usual, piston_m_s)) size.rated_krpm = engine.rated_rpm() / 1e3;
  }
  for (const SectionValues& section : engine.sections()) {
    for (const Value& value : section.values) {
      if (!metres || value.key->unit.name != std::string_view("mm")) look_at_value(value, size, warnings);
    }
  }
}

}  // namespace

std::vector<std::string> warnings_about(const EngineFile& engine) {
  Warnings warnings(engine);
  EngineSize size;
  bool metres = false;
  if (engine.has("crank")) {
    metres = lengths_look_like_metres(engine.section("crank"));
    size = look_at_crank(engine, warnings);
    if (engine.has("masses") && engine.has("engine") && size.bore_mm && !metres) look_at_piston(engine, warnings);
    look_at_diagram(engine, warnings);
  }
  look_at_values(engine, size, metres, warnings);
  if (!metres) look_at_spacing(engine, size, warnings);
  look_at_trains(engine, size, warnings);
  look_at_gas(engine, size, warnings);
  look_at_signals(engine, warnings);
  return warnings.lines();
}

std::vector<std::string> warnings_about_running_free(const EngineFile& engine, const EngineDefinition& definition) {
  Warnings warnings(engine);
  const DrivenMachine& machine = definition.machine;
  const bool held =
      definition.friction.any() || machine.constant_Nm != 0 || machine.linear_Nm_s != 0 || machine.quadratic_Nm_s2 != 0;
  if (!held) warnings.add(0, "a free-running engine without [friction] and [machine] has nothing to limit its speed");
  return warnings.lines();
}

namespace {

struct LeftOut {
  const char* section;
  const char* instead;
  const char* taken;
};
constexpr LeftOut kMisfiresLeftOut{
    "misfire", "every cycle fires",
    "`crankloop run --free`, `crankloop live` and FMUs whose crank forces turn take misfires"};
constexpr LeftOut kFault{"fault", "every signal is healthy",
                         "`crankloop run --free`, `crankloop live` and FMUs whose crank forces turn take faults"};
constexpr LeftOut kSensorFault{"sensor_fault", "no sensor is read",
                               "`crankloop live` and FMUs whose crank forces turn take faults of sensors"};

std::vector<std::string> warnings_about_each(std::initializer_list<LeftOut> left_out, const EngineFile& engine) {
  Warnings warnings(engine);
  for (const SectionValues& section : engine.sections()) {
    for (const LeftOut& kind : left_out) {
      if (section.kind == kind.section)
        warnings.add(section.line, section.title() + ": " + kind.instead + " in this command; " + kind.taken);
    }
  }
  return warnings.lines();
}

}  // namespace

std::vector<std::string> warnings_about_misfires_left_out(const EngineFile& engine) {
  return warnings_about_each({kMisfiresLeftOut, kFault, kSensorFault}, engine);
}
std::vector<std::string> warnings_about_sensor_faults_left_out(const EngineFile& engine) {
  return warnings_about_each({kSensorFault}, engine);
}

void demand_a_diagram(const EngineFile& engine) {
  if (engine.definition().pressure.source != PressureSource::gas) return;
  throw InputError(
      engine.path(), engine.section("pressure").line_of("source"),
      "source: this command takes the pressure from a diagram, and gas has none; `crankloop run --csv` has "
      "the forces of an engine with gas exchange");
}

}  // namespace crankloop::program
