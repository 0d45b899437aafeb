#include "spring_wire.hpp"

#include "engine_file_parts.hpp"

namespace crankloop::program {
namespace {

constexpr const char* kDependent[] = {"coil_mm", "active_coils", "shear_GPa", "shear_endurance_MPa",
                                      "shear_ultimate_MPa"};

}  // namespace

std::optional<SpringWire> build_spring_wire(const SectionValues& valve, const std::string& path) {
  if (!valve.has("wire_mm")) {
    for (const char* key : kDependent)
      if (valve.has(key)) refuse(valve, key, "needs wire_mm beside it", path);
    return {};
  }
  for (const char* key : {"coil_mm", "active_coils"})
    if (!valve.has(key)) refuse(valve, "wire_mm", std::string("needs ") + key + " beside it", path);
  if (valve.has("inner_spring_N_per_mm"))
    refuse(valve, "wire_mm", "is of one spring, and inner_spring_N_per_mm tells of two", path);
  SpringWire wire;
  wire.wire_m = valve.si("wire_mm");
  wire.coil_m = valve.si("coil_mm");
  wire.active_coils = valve.number("active_coils");
  wire.shear_assumed = !valve.has("shear_GPa");
  wire.shear_Pa = wire.shear_assumed ? kUsualShear_Pa : valve.si("shear_GPa");
  if (wire.coil_m < kLeastCoilIndex * wire.wire_m) {
    refuse(valve, "coil_mm", brief(wire.coil_m * 1e3) + " must be at least twice wire_mm = " + brief(wire.wire_m * 1e3),
           path);
  }
  for (const auto& [key, other] : {std::pair{"shear_endurance_MPa", "shear_ultimate_MPa"},
                                   std::pair{"shear_ultimate_MPa", "shear_endurance_MPa"}}) {
    if (valve.has(key) && !valve.has(other)) refuse(valve, key, std::string("needs ") + other + " beside it", path);
  }
  if (valve.has("shear_endurance_MPa")) {
    wire.endurance_Pa = valve.si("shear_endurance_MPa");
    wire.ultimate_Pa = valve.si("shear_ultimate_MPa");
  }
  return wire;
}

}  // namespace crankloop::program
