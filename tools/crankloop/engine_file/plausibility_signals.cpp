// Of trigger wheels and the faults of their signals: keys that do nothing.
#include <string>

#include "plausibility_parts.hpp"

namespace crankloop::program {
namespace {

/// Which key acts only beside which other.
struct Together {
  const char* key;
  const char* other;
};
constexpr Together kTogether[] = {{"moved_tooth", "moved_deg"},
                                  {"moved_deg", "moved_tooth"},
                                  {"extra_tooth_deg", "extra_width_deg"},
                                  {"runout_at_deg", "runout_deg"},
                                  {"noise_pulse_us", "noise_Hz"}};

void look_at_fault(const SectionValues& section, const WheelFault& fault, Warnings& warnings) {
  bool told = false;
  for (const Together& pair : kTogether) {
    if (section.number(pair.key) == 0 || section.number(pair.other) != 0) continue;
    warnings.add(section.line_of(pair.key), std::string(pair.key) + " does nothing without " + pair.other);
    told = true;
  }
  if (told || fault.changes_wheel() || fault.inverted || fault.stuck != StuckSignal::no || fault.noise_Hz > 0) return;
  warnings.add(section.line, section.title() + " says when, and not what: the signal stays healthy");
}

}  // namespace

void look_at_signals(const EngineFile& engine, Warnings& warnings) {
  std::size_t wheel = 0;
  std::size_t fault = 0;
  for (const SectionValues& section : engine.sections()) {
    if (section.kind == "fault") look_at_fault(section, engine.definition().wheel_faults[fault++], warnings);
    if (section.kind != "trigger") continue;
    const bool has_own_widths = !engine.triggers()[wheel++].edges_deg.empty();
    const Value* const ratio = section.find("tooth_ratio");
    if (has_own_widths && ratio != nullptr && ratio->line > 0)
      warnings.add(ratio->line, "tooth_ratio does nothing: pattern = " + section.text("pattern") +
                                    " has its own widths, `crankloop help patterns` lists them");
  }
}

}  // namespace crankloop::program
