// Fault bits of a step: bad inputs, limits that the step reached, and what it did about them.
#pragma once

#include <cstdint>

namespace crankloop {

/// Bits of Output::faults, set in the tick in which the fault occurs; 0 = no fault. The output is defined and finite
/// with any fault.
enum Fault : std::uint32_t {
  kFaultNotReady = 1u << 0,   ///< no tables, or init refused them: outputs are zero
  kFaultSpeed = 1u << 1,      ///< speed not finite or beyond the limit: the last good one was used
  kFaultLoadRatio = 1u << 2,  ///< load ratio not finite or outside 0 to 2: the last good one was used
  kFaultPressure = 1u << 3,   ///< a pressure not finite or outside 0 to 1e8 Pa: that cylinder's last good one was used
  kFaultPhaseJump = 1u << 4,  ///< the measured phase jumped further than the speed limit allows: the speed is the last
                              ///< good one, the mean torque that at the tick
  kFaultCamPhase = 1u << 5,   ///< a cam phase target not finite or outside -180 to 180 deg: the last good one was used
  kFaultEventBudget =
      1u << 6,  ///< more contact changes in a tick than are located: the others were applied at the end of a fine step
  kFaultExternalTorque = 1u << 7,  ///< external torque not finite or outside +-1e8 Nm: the last good one was used
  kFaultOverspeed = 1u << 8,     ///< the torque would turn the crank faster than the speed limit: the speed was limited
  kFaultTriggerEdges = 1u << 9,  ///< more edges of a trigger wheel in a tick than the scene has room for: the first are
                                 ///< listed, all are counted
  kFaultGas =
      1u << 10,  ///< the gas of a cylinder or manifold had too little mass, or was too cold or too hot: it was limited
  kFaultManifold = 1u << 11,  ///< throttle, or pressure or temperature of a manifold, not finite or out of range: the
                              ///< last good one was used
  kFaultBurn = 1u << 12,  ///< fuel, burn start or duration not finite or out of range, or a burn that ends after 150
                          ///< deg: the last good ones were used
};

/// Faults of inputs: the scene's bad_input_count counts ticks with any of them.
inline constexpr std::uint32_t kInputFaults = kFaultSpeed | kFaultLoadRatio | kFaultPressure | kFaultPhaseJump |
                                              kFaultCamPhase | kFaultExternalTorque | kFaultManifold | kFaultBurn;

/// Fault bits in words, "speed, cam phase": plain data that needs no heap and no library.
struct FaultText {
  char text[192] = {};
};

/// Null if no fault has that bit. A switch, so that the compiler warns about a fault without a name.
[[nodiscard]] constexpr const char* name_of(Fault fault) noexcept {
  switch (fault) {
    case kFaultNotReady:
      return "not ready";
    case kFaultSpeed:
      return "speed";
    case kFaultLoadRatio:
      return "load ratio";
    case kFaultPressure:
      return "pressure";
    case kFaultPhaseJump:
      return "phase jump";
    case kFaultCamPhase:
      return "cam phase";
    case kFaultEventBudget:
      return "event budget";
    case kFaultExternalTorque:
      return "external torque";
    case kFaultOverspeed:
      return "overspeed";
    case kFaultTriggerEdges:
      return "trigger edges";
    case kFaultGas:
      return "gas";
    case kFaultManifold:
      return "manifold";
    case kFaultBurn:
      return "burn";
  }
  return nullptr;
}

/// Names each bit that is set; "none" for 0, "unknown" for bits of no fault.
[[nodiscard]] constexpr FaultText describe(std::uint32_t faults) noexcept {
  FaultText words;
  unsigned length = 0;
  const auto add = [&](const char* name) {
    for (const char* c = length == 0 ? "" : ", "; *c != '\0'; ++c) words.text[length++] = *c;
    for (const char* c = name; *c != '\0'; ++c) words.text[length++] = *c;
  };
  bool unknown = false;
  for (std::uint32_t bit = 1; bit != 0; bit <<= 1) {
    if ((faults & bit) == 0) continue;
    const char* name = name_of(static_cast<Fault>(bit));
    if (name != nullptr) add(name);
    unknown = unknown || name == nullptr;
  }
  if (unknown) add("unknown");
  if (faults == 0) add("none");
  return words;
}

}  // namespace crankloop
