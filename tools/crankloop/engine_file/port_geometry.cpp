#include "port_geometry.hpp"

#include "../files/units.hpp"
#include "engine_file_parts.hpp"

namespace crankloop::program {
namespace {

/// What is neither given nor derived is assumed, and told.
void assume(PortGeometry& port, const char* key, double value) {
  port.assumed += (port.assumed.empty() ? "" : ", ") + std::string(key) + " = " + brief(value);
}

/// Two of D_v, D and s give the third. With one of the diameters alone, s is assumed.
void size_seat(const SectionValues& valve, PortGeometry& port) {
  const bool has_head = valve.has("head_diameter_mm");
  const bool has_seat = valve.has("seat_diameter_mm");
  if (has_head) port.head_m = valve.si("head_diameter_mm");
  if (has_seat) port.seat_m = valve.si("seat_diameter_mm");
  if (valve.has("seat_width_mm")) {
    port.seat_width_m = valve.si("seat_width_mm");
  } else if (has_head && has_seat) {
    port.seat_width_m = (port.head_m - port.seat_m) / 2;
  } else {
    port.seat_width_m = kUsualSeatWidth * (has_seat ? port.seat_m : port.head_m / (1 + 2 * kUsualSeatWidth));
    assume(port, "seat_width_mm", port.seat_width_m * kMilli);
  }
  if (!has_head) port.head_m = port.seat_m + 2 * port.seat_width_m;
  if (!has_seat) port.seat_m = port.head_m - 2 * port.seat_width_m;
}

void refuse_contradictions(const SectionValues& valve, const PortGeometry& port, const std::string& path) {
  const auto mm = [](double metres) { return brief(metres * kMilli); };
  if (valve.has("head_diameter_mm") && valve.has("seat_diameter_mm") && !(port.head_m > port.seat_m)) {
    refuse(valve, "head_diameter_mm",
           mm(port.head_m) + " must be more than seat_diameter_mm = " + mm(port.seat_m) + ", the seat's inner diameter",
           path);
  }
  if (!(port.head_m > 2 * port.seat_width_m)) {
    refuse(valve, "seat_width_mm",
           mm(port.seat_width_m) + " must be less than half of head_diameter_mm = " + mm(port.head_m), path);
  }
  if (!(port.stem_m < port.port_m)) {
    refuse(valve, valve.has("stem_diameter_mm") ? "stem_diameter_mm" : "port_diameter_mm",
           "the stem of " + mm(port.stem_m) + " mm must be thinner than the port of " + mm(port.port_m) + " mm", path);
  }
}

}  // namespace

std::optional<PortGeometry> build_port_geometry(const SectionValues& valve, const std::string& path) {
  if (!valve.has("head_diameter_mm") && !valve.has("seat_diameter_mm")) {
    for (const char* key : {"seat_width_mm", "seat_angle_deg", "port_diameter_mm", "stem_diameter_mm"}) {
      if (valve.has(key)) refuse(valve, key, "needs head_diameter_mm or seat_diameter_mm beside it", path);
    }
    return {};
  }
  PortGeometry port;
  size_seat(valve, port);
  const auto given_or = [&valve, &port](const char* key, double usual_m) {
    if (valve.has(key)) return valve.si(key);
    assume(port, key, usual_m * kMilli);
    return usual_m;
  };
  if (valve.has("seat_angle_deg")) {
    port.seat_angle_deg = valve.number("seat_angle_deg");
  } else {
    port.seat_angle_deg = kUsualSeatAngle_deg;
    assume(port, "seat_angle_deg", kUsualSeatAngle_deg);
  }
  port.port_m = given_or("port_diameter_mm", kUsualPort * port.seat_m);
  port.stem_m = given_or("stem_diameter_mm", kUsualStem * port.seat_m);
  refuse_contradictions(valve, port, path);
  return port;
}

}  // namespace crankloop::program
